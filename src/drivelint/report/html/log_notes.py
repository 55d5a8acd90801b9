"""Notes on published logs for which this report differs from what their authors say.

Each file of `known_logs/` is about some logs, which it knows by the sha256 of their bytes: what it says is true of no other log.
"""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.result.text import Row


class LogNote(NamedTuple):
    """A note on a published log: its title and, per row, the subject, the authors' value, the value here and the reason."""

    title: str
    rows: list[tuple[str, str, str, str]]


@cache
def _known() -> dict[str, LogNote]:
    known: dict[str, LogNote] = {}
    for file in sorted((Path(__file__).parent / "known_logs").glob("*.toml")):
        said = tomllib.loads(file.read_text(encoding="utf-8"))
        note = LogNote(said["title"], [(row["what"], row["theirs"], row["ours"], row["why"]) for row in said["row"]])
        known |= dict.fromkeys(said["logs"], note)
    return known


def notes_on_logs(drives: Sequence[Row]) -> list[LogNote]:
    """Return the notes on the published logs that are among the drives."""
    found = (_known().get(row["sha256"]) for row in drives)
    return list({note.title: note for note in found if note is not None}.values())
