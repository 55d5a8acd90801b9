"""Describes the source of a party's size if it is not the log."""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.drive.trace import ASSUMED_SIZE_CHECK

if TYPE_CHECKING:
    from drivelint.drive.trace import Trace


def size_source_text(trace: Trace, actor_id: str) -> str:
    """Return in words the source of an actor's size; '' if it is the log. A clip keeps the source from its log."""
    rows = trace.tables["quality"].to_pylist()
    size_rows = [row for row in rows if row["check_id"] == ASSUMED_SIZE_CHECK and row["actor_id"] in {None, actor_id}]
    return "; ".join(row["message"] for row in size_rows)
