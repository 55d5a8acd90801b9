"""Explanations on the page: technical words, and published logs for which the verdicts differ from those of their authors."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from drivelint.facts import toml_beside

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from drivelint.result.text import Row


def glossary_entries(texts: Iterable[str]) -> list[tuple[str, str]]:
    """Return the words of `glossary.toml` that occur in any of the texts, each with its meaning."""
    said = " ".join(texts).lower()
    entries = toml_beside(__file__, "glossary.toml")["word"]
    return [(entry["word"], entry["means"]) for entry in entries if entry["sign"] in said]


def notes_on_logs(drives: Sequence[Row]) -> list[dict[str, Any]]:
    """Return the notes on the published logs that are among the drives.

    Each file of `known_logs/` is about some logs, which it knows by the sha256 of their bytes: what it says is true of no other log.
    `title`, and per `row` the subject (`what`), the authors' value (`theirs`), the value here (`ours`) and the reason (`why`).
    """
    notes = [
        toml_beside(str(file), file.name) for file in sorted((Path(__file__).parent / "known_logs").glob("*.toml"))
    ]
    known = {sha256: note for note in notes for sha256 in note["logs"]}
    found = [known[row["sha256"]] for row in drives if row["sha256"] in known]
    return list({note["title"]: note for note in found}.values())
