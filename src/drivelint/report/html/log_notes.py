"""Notes on published logs for which this report differs from what their authors say.

Each file of `known_logs/` is about some logs, which it knows by the sha256 of their bytes: what it says is true of no other log.
"""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.result.text import Row


@cache
def _known() -> dict[str, dict[str, Any]]:
    """Return sha256 of a log -> its note."""
    known: dict[str, dict[str, Any]] = {}
    for file in sorted((Path(__file__).parent / "known_logs").glob("*.toml")):
        said = tomllib.loads(file.read_text(encoding="utf-8"))
        known |= dict.fromkeys(said["logs"], said)
    return known


def notes_on_logs(drives: Sequence[Row]) -> list[dict[str, Any]]:
    """Return the notes on the published logs that are among the drives.

    `title`, and per `row` the subject (`what`), the authors' value (`theirs`), the value here (`ours`) and the reason (`why`).
    """
    found = (_known().get(row["sha256"]) for row in drives)
    return list({note["title"]: note for note in found if note is not None}.values())
