"""Says where the sizes of the parties come from, if it is not the log."""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.formats.tables import mapping

if TYPE_CHECKING:
    from drivelint.result.request import RunRequest


def size_source(asked: RunRequest, *, ego: bool) -> str:
    """Return, in words, what gave a party its size; '' where the log did."""
    if ego and asked.ego_size is not None:
        return "size as --ego-size says, not the log"
    if asked.mapping is not None:
        name, found = mapping.load(asked.mapping)
        given = mapping.fields(found)
        if any(side in given and given[side].value is not None for side in ("length", "width")):
            return f"size as the mapping {name} says, not the log"
    return ""
