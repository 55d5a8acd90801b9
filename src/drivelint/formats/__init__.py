"""Trace and map formats, one folder each. `registry` and `map_registry` recognise a file by its content."""

from __future__ import annotations

from drivelint.formats.files import expand_traces
from drivelint.formats.map_registry import load_map, read_source
from drivelint.formats.registry import read_trace

__all__ = ["expand_traces", "load_map", "read_source", "read_trace"]
