"""Annotated logs: the verdicts and their evidence in an MCAP file that viewers open without an extension."""

from drivelint.annotate.annotator import Annotator

__all__ = ["Annotator"]
