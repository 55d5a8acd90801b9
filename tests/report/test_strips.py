"""The words over a strip do not lie over each other."""

from __future__ import annotations

import pytest

from drivelint.report.html.strips import LEFT, RIGHT, Series, _strip
from drivelint.report.html.svg import Axis
from tests.report.synthetic import SECOND


@pytest.mark.parametrize(
    ("title", "who", "apart"),
    [
        ("speed", "object 3", True),
        ("offset from the lane's centre, left positive", "object 3", True),
        ("offset from the lane's centre, left positive", "object 5f0d8a52-pedestrian-crossing-17", False),
    ],
)
def test_numbers_go_below_a_title_that_leaves_no_room(title: str, who: str, *, apart: bool) -> None:
    t = [n * SECOND for n in range(4)]
    lines = [Series("met", who, t, [1.0, 2.0, 3.0, 4.0]), Series("ego", "ego 1", t, [4.0, 3.0, 2.0, 1.0])]
    drawn = _strip(0, title, "m", lines, t[2], x=Axis(t[0], t[-1], LEFT, RIGHT), course=None)
    assert drawn["at_worst"] == f"ego 1 2.00, {who} 3.00"
    top, height = float(drawn["top"]), float(drawn["height"])
    if apart:
        assert drawn["value_y"] == drawn["label_y"]
    else:
        assert top + 8 < float(drawn["value_y"]) < top + height, "in the frame of the strip"


def test_a_cut_takes_room_too() -> None:
    t = [n * SECOND for n in range(60)]
    values = [900.0, *([1.0] * 58), -900.0]
    course = {"t_ns": t, "required": [0.5] * 60, "holds": [True] * 60}
    lines = [Series("limit", "required", t, [0.5] * 60), Series("ego", "observed", t, list(values))]
    x = Axis(t[0], t[-1], LEFT, RIGHT)
    drawn = _strip(0, "overlap of the danger spaces of both", "m", lines, t[30], x=x, course=course)
    assert drawn["cut"]
    assert drawn["value_y"] != drawn["label_y"]


def test_nothing_has_no_sign_but_of_a_measure_that_may_break_a_rule() -> None:
    t = [n * SECOND for n in range(4)]
    x = Axis(t[0], t[-1], LEFT, RIGHT)
    lines = [Series("ego", "ego 1", t, [-0.001] * 4)]
    assert _strip(0, "speed", "m/s", lines, t[2], x=x, course=None)["at_worst"] == "ego 1 0.00"
    course = {"t_ns": t, "required": [0.0] * 4, "holds": [False] * 4}
    lines = [Series("limit", "required", t, [0.0] * 4), Series("ego", "observed", t, [-0.001] * 4)]
    assert _strip(0, "gap", "m", lines, t[2], x=x, course=course)["at_worst"] == "observed -0.00, required 0.00"
