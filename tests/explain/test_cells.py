"""A value that is NULL is told with what that means, however long the comment of its column is before."""

from __future__ import annotations

from drivelint.explain.text import _column_comment, _cut_line
from drivelint.sql import declarations


def test_a_null_says_what_it_means() -> None:
    text = declarations.column_comments()["following"]["joined_ns"]
    assert _column_comment(text, None) == "NULL: the vehicle was ahead before, or its arrival was not seen"
    assert _column_comment(text, 7_000_000_000).startswith("see vehicle_ahead: the time since which the gap is new")
    assert len(_column_comment(text, 7_000_000_000)) <= 70


def test_a_comment_that_says_nothing_of_null_stays() -> None:
    assert _column_comment("the step", None) == "the step"


def test_a_row_is_cut_to_the_width_of_the_terminal() -> None:
    assert _cut_line("gap_m  12.5  " + "x" * 70, 40) == "gap_m  12.5  " + "x" * 24 + "..."
    assert _cut_line("gap_m  12.5", 40) == "gap_m  12.5"
