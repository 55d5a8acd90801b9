"""Charts below the plan view of the worst moment, one per recorded quantity, on a common time axis."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
import shapely

from drivelint.report.html.plan_view import box_corners_m
from drivelint.report.html.svg import Axis, axis_for_deciding_values, svg_number
from drivelint.result.text import brief_id, ego_name, number

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.result.text import Row

WIDTH: Final = 600
LEFT, RIGHT = 46.0, WIDTH - 8.0
_HEIGHT, _HEAD, _FOOT = 46.0, 17.0, 18.0  # of a chart, of the text above it, of the time axis
_LINE = 14.0  # of a second line of the text above a chart
_LONGEST_JOINED_GAP_NS: Final = 1_000_000_000
_LEAST_VALUES_FOR_CHART: Final = 3
"""The least number of values for which a chart is drawn."""
_CHAR_WIDTH: Final = 6.6
"""The greatest average width of a character above a chart, over all fonts of the page."""


class ChartLine(NamedTuple):
    """One line of a chart; `kind`: ego, met (the other actor) or limit. At a value of None the line is interrupted."""

    kind: str
    name: str
    t_ns: Sequence[int]
    values: Sequence[float | None]


def charts_below_plan_view(
    scene: Row, finding: Row, course: Row | None, observes: str | None, start_ns: int
) -> dict[str, Any] | None:
    """Return the charts for a finding from its row of the table `scene`; None if the scene has too few points of the ego's path.

    `course`: the finding's row of the table `course`; `observes`: the quantity that the rule measures.
    Coordinates are units of a viewBox that is 600 wide.
    """
    ego = scene["actors"][0]
    way = ego["path"] or []
    met = next((a for a in scene["actors"][1:] if a["actor_id"] == finding["object_id"] and a["path"]), None)
    if len(way) < _LEAST_VALUES_FOR_CHART:
        return None
    t = [point["t_ns"] for point in way]
    x = Axis(t[0], t[-1], LEFT, RIGHT)
    actors = ([("met", met)] if met else []) + [("ego", ego)]  # drawn in this order
    quantities: list[tuple[str, str, list[ChartLine]]] = [
        (title, unit, [_line_of_actor(kind, actor, column) for kind, actor in actors])
        for title, unit, column in (
            ("speed", "m/s", "speed_mps"),
            ("acceleration", "m/s2", "accel_mps2"),
            ("offset from the lane's centre, left positive", "m", "d_m"),
        )
    ]
    is_measured = (
        course is not None and sum(value is not None for value in course["observed"]) >= _LEAST_VALUES_FOR_CHART
    )
    is_gap = is_measured and finding["unit"] == "m"
    if met and not is_gap and (gap := box_distance_line(ego, met)) is not None:
        quantities.append(("distance from box to box", "m", [gap]))
    if is_measured and course is not None:
        lines = [
            ChartLine("limit", "required", course["t_ns"], course["required"]),
            ChartLine("ego", "observed", course["t_ns"], course["observed"]),
        ]
        quantities.append((observes or "what the rule measures", finding["unit"] or "", lines))
    shown_quantities = [
        quantity
        for quantity in quantities
        if any(sum(v is not None for v in line.values) >= _LEAST_VALUES_FOR_CHART for line in quantity[2])
    ]
    charts: list[dict[str, Any]] = []
    end = 0.0
    for quantity in shown_quantities:
        of_rule = course if quantity[2][0].kind == "limit" else None
        charts.append(_chart_of_quantity(end, *quantity, finding["t_worst_ns"], x=x, course=of_rule))
        end = float(charts[-1]["bottom"])
    height = end + _FOOT
    return {
        "height": svg_number(height),
        "bottom": svg_number(height - _FOOT),
        "strips": charts,
        "t_ticks": _axis_in_seconds(x, start_ns).ticks(9),
        "at": svg_number(x.at(finding["t_worst_ns"])),
        "t0": round((t[0] - start_ns) / 1e7),
        "t1": round((t[-1] - start_ns) / 1e7),
        "words": "; ".join(f"{chart['title']} {chart['range']}" for chart in charts),
        "met": met["actor_id"] if met else None,
        "ego": ego_name(ego["actor_id"]),
    }


def _axis_in_seconds(x: Axis, start_ns: int) -> Axis:
    return Axis((x.low - start_ns) / 1e9, (x.high - start_ns) / 1e9, x.start, x.end)


def _line_of_actor(kind: str, actor: Row, column: str) -> ChartLine:
    short = brief_id(actor["actor_id"])
    name = ego_name(short) if kind == "ego" else f"object {short}"
    return ChartLine(kind, name, [point["t_ns"] for point in actor["path"]], [point[column] for point in actor["path"]])


def box_distance_line(ego: Row, met: Row) -> ChartLine | None:
    """Return the distance between two boxes at the times that both paths contain; None if a box's size is unknown."""
    if any(actor[side] is None for actor in (ego, met) for side in ("length_m", "width_m")):
        return None
    ways = [{point["t_ns"]: actor | point for point in actor["path"]} for actor in (ego, met)]
    t = sorted(ways[0].keys() & ways[1].keys())
    a, b = (shapely.polygons(np.array([box_corners_m(way[at]) for at in t])) if t else np.array([]) for way in ways)
    return ChartLine("ego", "distance", t, shapely.distance(a, b).tolist())


def _chart_of_quantity(
    begin: float, title: str, unit: str, lines: Sequence[ChartLine], worst_ns: int, *, x: Axis, course: Row | None
) -> dict[str, Any]:
    """Return one chart: its frame, the axis of values, the lines, and the extreme values that the frame cuts off.

    `begin`: the bottom of the chart above. If the title's line has no room for the values, they are on a second line.
    """
    inside = [
        v for line in lines for t, v in zip(line.t_ns, line.values, strict=True) if v is not None and _is_on_axis(x, t)
    ]
    inside = inside or [v for line in lines for v in line.values if v is not None]
    deciding = _values_deciding_verdict(lines, course, worst_ns)
    _, cut_values = axis_for_deciding_values(inside, deciding, _HEIGHT, 0.0)
    cut_off = (
        f"line cut off: the value goes {' and '.join(f'to {number(v, unit)}' for v in cut_values)}"
        if cut_values
        else ""
    )
    at_worst = _values_at_worst_text(lines, worst_ns)
    words = f"{title}, {unit} {f'({cut_off}) ' if cut_values else ''}{at_worst}"
    label_y = begin + _HEAD - 5
    value_y = label_y if len(words) * _CHAR_WIDTH <= RIGHT - LEFT else label_y + _LINE
    top = value_y + 5
    y, _ = axis_for_deciding_values(inside, deciding, top + _HEIGHT, top)
    return {
        "title": title,
        "unit": unit,
        "top": svg_number(top),
        "label_y": svg_number(label_y),
        "value_y": svg_number(value_y),
        "height": svg_number(_HEIGHT),
        "bottom": svg_number(top + _HEIGHT),
        "zero": svg_number(y.at(0.0)) if y.low < 0 < y.high else "",
        "ticks": y.ticks(4),
        "lines": [(line.kind, _line_path(line, x, y)) for line in lines],
        "at_worst": at_worst,
        "cut": cut_off,
        "range": f"from {number(min(inside), unit)} to {number(max(inside), unit)}",
        "spans": [] if course is None else _failing_spans(course, x),
    }


def _is_on_axis(x: Axis, t_ns: int) -> bool:
    return x.low <= t_ns <= x.high


def _values_deciding_verdict(lines: Sequence[ChartLine], course: Row | None, worst_ns: int) -> list[float]:
    """Return the values that decide whether a rule was kept: the values at the worst step, and the required values that were not met."""
    if course is None:
        return []
    at = min(range(len(course["t_ns"])), key=lambda i: abs(course["t_ns"][i] - worst_ns))
    limits = [value for value, is_kept in zip(course["required"], course["holds"], strict=True) if is_kept is False]
    return [value for value in (*(line.values[at] for line in lines), *limits) if value is not None]


def _values_at_worst_text(lines: Sequence[ChartLine], worst_ns: int) -> str:
    """Return the values at the worst step in words, without the unit, which the chart's title contains."""
    texts = []
    for line in lines:
        value = dict(zip(line.t_ns, line.values, strict=True)).get(worst_ns)
        if value is not None:
            # unrounded: -0.001 may break a rule
            shown_value = value if lines[0].kind == "limit" else round(value, 2) + 0.0
            texts.append(f"{line.name} {number(shown_value)}")
    return ", ".join(reversed(texts))


def _failing_spans(course: Row, x: Axis) -> list[tuple[str, str]]:
    """Return the periods in which the rule was not kept, each as position and width."""
    runs: list[list[int]] = []
    for t, is_kept in zip(course["t_ns"], course["holds"], strict=True):
        if is_kept is False and runs and t - runs[-1][1] <= _LONGEST_JOINED_GAP_NS and runs[-1][2]:
            runs[-1][1] = t
        elif is_kept is False:
            runs.append([t, t, 1])
        elif runs:
            runs[-1][2] = 0
    spans = [(max(x.at(a), LEFT), min(x.at(b), RIGHT)) for a, b, _ in runs if a <= x.high and b >= x.low]
    return [(svg_number(a), svg_number(max(b - a, 2.0))) for a, b in spans]


def _line_path(line: ChartLine, x: Axis, y: Axis) -> str:
    """Return the SVG path through the values, interrupted where a value is None or more than a second is missing."""
    parts, last = [], None
    for t, value in zip(line.t_ns, line.values, strict=True):
        if value is not None:
            parts.append(
                f"{'M' if last is None or t - last > _LONGEST_JOINED_GAP_NS else 'L'}{svg_number(x.at(t))},{svg_number(y.at(value))}"
            )
        last = t if value is not None else None
    return "".join(parts)
