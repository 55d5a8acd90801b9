"""The plot of a margin in characters."""

from __future__ import annotations

from drivelint.explain.model import Step
from drivelint.explain.plot import plot_lines


def steps(*margins: float | None) -> list[Step]:
    return [
        Step(n * 100_000_000, None, None, margin, None if margin is None else margin >= 0)
        for n, margin in enumerate(margins)
    ]


def bars(*margins: float | None, width: int = 4, height: int = 2) -> list[str]:
    return [
        line.partition("┤")[2] or line.partition("┼")[2]
        for line in plot_lines(steps(*margins), width, height, 0, "m")[:-1]
    ]


def test_what_is_kept_stands_above_the_limit_and_what_is_broken_hangs_below() -> None:
    assert bars(1.0, 1.0, -1.0, -1.0) == ["██  ", "────", "  ██"]


def test_a_step_that_is_not_known_is_a_question_mark_on_the_limit() -> None:
    assert bars(1.0, None, 0.5, 1.0) == ["█  █", "█ ██", "─?──"]


def test_of_several_steps_in_a_column_the_worst_shows() -> None:
    assert bars(1.0, -1.0, 1.0, 1.0, width=2) == [" █", "──", "█ "]


def test_few_steps_are_drawn_broad() -> None:
    assert bars(1.0, 2.0, width=6, height=2) == ["   ███", "██████", "──────"]


def test_a_margin_is_marked_with_its_extremes_and_times() -> None:
    lines = plot_lines(steps(2.0, -1.0), 40, 3, 0, "m/s")
    assert "+2 m/s" in lines[0]
    assert any("-1 m/s" in line for line in lines)
    assert lines[-1].split() == ["0.00", "s", "0.10", "s"]


def test_a_rule_that_measures_nothing_is_a_strip() -> None:
    told = [Step(n * 100_000_000, None, None, None, holds) for n, holds in enumerate((True, False, None, True))]
    assert plot_lines(told, 4, 8, 0, "")[0].strip() == "·█?·"


def test_one_step_is_no_plot() -> None:
    assert plot_lines(steps(1.0), 40, 8, 0, "m") == []
