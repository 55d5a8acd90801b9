"""The changelog is read by users: versions, headings, and entries of one short line."""

from __future__ import annotations

import re
from datetime import date

import drivelint
from tests.shared_data import ROOT

LINES = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8").splitlines()
HEADINGS = ("Added", "Changed", "Deprecated", "Removed", "Fixed", "Security", "Rules", "Formats")
"""What entries are about, in this order within a version."""
MOST_WORDS = 20
MOST_LINES_OF_THE_FIRST = 40
UNRELEASED = "Unreleased"


def versions() -> dict[str, list[str]]:
    """Return the heading of each version -> its lines, the newest first."""
    found: dict[str, list[str]] = {}
    for line in LINES:
        if line.startswith("## "):
            assert line[3:] not in found
            found[line[3:]] = []
        elif found:
            found[list(found)[-1]].append(line)
    return found


def test_versions_are_numbered_dated_and_the_newest_is_ours() -> None:
    names = [name for name in versions() if name != UNRELEASED]
    assert UNRELEASED not in list(versions())[1:], "what is not released stands first"
    told = [re.fullmatch(r"(\d+)\.(\d+)\.(\d+) \((\d{4}-\d\d-\d\d)\)", name) for name in names]
    assert all(told), names
    order = [(*map(int, each.groups()[:3]), date.fromisoformat(each[4])) for each in told if each]
    assert order == sorted(order, reverse=True)
    assert names[0].partition(" ")[0] == drivelint.__version__


def test_lines_are_headings_or_entries_of_at_most_twenty_words() -> None:
    for name, lines in versions().items():
        topics = [line[4:] for line in lines if line.startswith("### ")]
        assert topics == [topic for topic in HEADINGS if topic in topics], (
            f"{name}: unknown, twice, or in another order"
        )
        assert next(line for line in lines if line).startswith("### ")
        for line in lines:
            assert line == "" or line.startswith(("### ", "* ")), f"{name}: more than a line: {line}"
            if line.startswith("* "):
                assert len(line[2:].split()) <= MOST_WORDS, line
                assert line.endswith(".")


def test_how_entries_are_written_stands_at_the_head() -> None:
    head = "\n".join(LINES).partition("\n## ")[0]
    assert f"one line of at most {MOST_WORDS} words" in head
    assert "*Rules*" in head


def test_the_first_version_fits_on_a_screen_and_has_rules() -> None:
    (*_, lines) = versions().values()
    assert len([line for line in lines if line]) <= MOST_LINES_OF_THE_FIRST
    assert "### Rules" in lines
