"""The SELECTs of the files beside this one, one a line; what follows an arrow is what a test expects of it."""

from __future__ import annotations

from pathlib import Path


def lines(name: str) -> list[str]:
    """Return the lines of a file that are no comments."""
    text = Path(__file__).with_name(f"{name}.sql").read_text(encoding="utf-8")
    return [line for line in text.splitlines() if not line.startswith("--")]


def expected_by_select(name: str) -> dict[str, set[str]]:
    """Return SELECT -> the words behind its arrow; `nothing` is none."""
    pairs = (line.split(" -- ")[0].split(" --> ") for line in lines(name))
    return {sql: set(words.split()) - {"nothing"} for sql, words in pairs}
