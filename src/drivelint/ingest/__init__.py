"""From trace files to the tables of `schemas/model.sql`: `expand` finds the files, `read_trace` reads one."""

from __future__ import annotations

from drivelint.ingest.files import expand
from drivelint.ingest.finish import with_finding
from drivelint.ingest.registry import read_trace
from drivelint.ingest.trace import Finding, IngestOptions, Trace

__all__ = ["Finding", "IngestOptions", "Trace", "expand", "read_trace", "with_finding"]
