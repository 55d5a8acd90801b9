"""Annotated logs: the verdicts, and what they stand on, in an MCAP file that viewers open without an extension."""

from drivelint.annotate.annotator import Annotator

__all__ = ["Annotator"]
