"""The words over a strip do not lie over each other."""

from __future__ import annotations

from typing import Any

import pytest
from jinja2 import Environment, PackageLoader

from drivelint.report.html.moment_charts import LEFT, RIGHT, ChartLine, _chart_of_quantity, charts_below_plan_view
from drivelint.report.html.svg import Axis
from tests.report.synthetic import SECOND


@pytest.mark.parametrize(
    ("title", "name", "apart"),
    [
        ("speed", "object 3", True),
        ("offset from the lane's centre, left positive", "object 3", True),
        ("offset from the lane's centre, left positive", "object 5f0d8a52-pedestrian-crossing-17", False),
    ],
)
def test_numbers_go_below_a_title_that_leaves_no_room(title: str, name: str, *, apart: bool) -> None:
    t = [n * SECOND for n in range(4)]
    lines = [ChartLine("met", name, t, [1.0, 2.0, 3.0, 4.0]), ChartLine("ego", "ego 1", t, [4.0, 3.0, 2.0, 1.0])]
    drawn = _chart_of_quantity(0, title, "m", lines, t[2], x=Axis(t[0], t[-1], LEFT, RIGHT), course=None)
    assert drawn["at_worst"] == f"ego 1 2.00, {name} 3.00"
    top = float(drawn["top"])
    if apart:
        assert drawn["value_y"] == drawn["label_y"]
    else:
        assert float(drawn["label_y"]) + 12 < float(drawn["value_y"]) < top, (
            "on a line of its own above the strip's lines"
        )


def test_a_cut_takes_room_too() -> None:
    t = [n * SECOND for n in range(60)]
    values = [900.0, *([1.0] * 58), -900.0]
    course = {"t_ns": t, "required": [0.5] * 60, "holds": [True] * 60}
    lines = [ChartLine("limit", "required", t, [0.5] * 60), ChartLine("ego", "observed", t, list(values))]
    x = Axis(t[0], t[-1], LEFT, RIGHT)
    drawn = _chart_of_quantity(0, "overlap of the danger spaces of both", "m", lines, t[30], x=x, course=course)
    assert drawn["cut"]
    assert drawn["value_y"] != drawn["label_y"]


def test_no_line_lies_over_the_words() -> None:
    environment = Environment(loader=PackageLoader("drivelint.report.html"), autoescape=True)
    environment.filters["measure"] = str
    ends = [("limit", 900.0), ("ego", -900.0)]
    t = [n * SECOND for n in range(60)]
    lines = [ChartLine(kind, "a long name of a line", t, [end, *([1.0] * 59)]) for kind, end in ends]
    x = Axis(t[0], t[-1], LEFT, RIGHT)
    course = {"t_ns": t, "required": [0.5] * 60, "holds": [True] * 60}
    upper = _chart_of_quantity(0, "overlap of the danger spaces of both", "m", lines, t[30], x=x, course=course)
    lower = _chart_of_quantity(float(upper["bottom"]), "speed", "m", lines, t[30], x=x, course=None)
    assert float(upper["bottom"]) + 8 < float(lower["label_y"])
    strips = {"height": "200", "bottom": "180", "strips": [upper, lower], "t_ticks": [], "at": "300"}
    macros: Any = environment.get_template("macros.html.j2").module
    drawn = macros.strips(strips)
    last_line = max(drawn.index("moment-line"), drawn.rindex("strip-line"), drawn.rindex('class="grid"'))
    assert min(drawn.index("strip-name"), drawn.index("strip-value")) > last_line


def test_nothing_has_no_sign_but_of_a_measure_that_may_break_a_rule() -> None:
    t = [n * SECOND for n in range(4)]
    x = Axis(t[0], t[-1], LEFT, RIGHT)
    lines = [ChartLine("ego", "ego 1", t, [-0.001] * 4)]
    assert _chart_of_quantity(0, "speed", "m/s", lines, t[2], x=x, course=None)["at_worst"] == "ego 1 0.00"
    course = {"t_ns": t, "required": [0.0] * 4, "holds": [False] * 4}
    lines = [ChartLine("limit", "required", t, [0.0] * 4), ChartLine("ego", "observed", t, [-0.001] * 4)]
    assert (
        _chart_of_quantity(0, "gap", "m", lines, t[2], x=x, course=course)["at_worst"]
        == "observed -0.00, required 0.00"
    )


def actor(name: str, y_m: float, d_m: float | None) -> dict[str, Any]:
    way = [
        {
            "t_ns": n * SECOND,
            "x_m": 5.0 * n,
            "y_m": y_m,
            "yaw_rad": 0.0,
            "speed_mps": 5.0,
            "accel_mps2": 0.0,
            "d_m": d_m,
        }
        for n in range(5)
    ]
    return {"actor_id": name, "length_m": 4.0, "width_m": 2.0, "path": way}


@pytest.mark.parametrize(("ego", "name"), [("ego", "ego"), ("7", "ego 7")])
def test_an_ego_is_named_once_and_a_long_id_in_short(ego: str, name: str) -> None:
    long = "5f0d8a52-83b8-4b5c-9f6e-0d2a0a6ff001"
    found = charts_below_plan_view(
        {"actors": [actor(ego, 0.0, 0.1), actor(long, 3.5, 3.6)]},
        {"object_id": long, "t_worst_ns": 2 * SECOND, "unit": "s"}, None, None, 0,
    )  # fmt: skip
    assert found is not None
    assert found["ego"] == name
    assert found["strips"][0]["at_worst"] == f"{name} 5.00, object 5f0d8a52… 5.00"


def test_without_offsets_from_a_lane_there_is_no_strip_of_them() -> None:
    finding = {"object_id": None, "t_worst_ns": 2 * SECOND, "unit": "s"}
    for d_m, there in ((0.1, True), (None, False)):
        found = charts_below_plan_view({"actors": [actor("ego", 0.0, d_m)]}, finding, None, None, 0)
        assert found is not None
        assert any("lane's centre" in strip["title"] for strip in found["strips"]) == there
