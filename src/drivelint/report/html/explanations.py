"""Explanations on the page: of technical words, and of published logs whose authors came to other verdicts."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from drivelint.facts import toml_beside

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from drivelint.result.text import Row


def glossary_entries(texts: Iterable[str]) -> list[tuple[str, str]]:
    """Return the words of `glossary.toml` that occur in at least one of the texts, each with its meaning."""
    text = " ".join(texts).lower()
    entries = toml_beside(__file__, "glossary.toml")["word"]
    return [(entry["word"], entry["means"]) for entry in entries if entry["sign"] in text]


def notes_on_published_logs(drives: Sequence[Row]) -> list[dict[str, Any]]:
    """Return the notes on those published logs that are among the drives.

    Each file of `known_logs/` lists the sha256 of the logs that its note is about. A note has a `title` and, in each `row`,
    the subject (`what`), the value of the log's authors (`theirs`), drivelint's value (`ours`) and the reason of the difference (`why`).
    """
    notes = [
        toml_beside(str(file), file.name) for file in sorted((Path(__file__).parent / "known_logs").glob("*.toml"))
    ]
    notes_by_sha256 = {sha256: note for note in notes for sha256 in note["logs"]}
    drive_notes = [notes_by_sha256[row["sha256"]] for row in drives if row["sha256"] in notes_by_sha256]
    return list({note["title"]: note for note in drive_notes}.values())
