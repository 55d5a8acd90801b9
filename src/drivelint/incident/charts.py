"""Charts below the plan view on one time axis: speeds, gap, and the rule's observed and required values."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from drivelint.catalogue.header import CONTACT_TAG
from drivelint.incident.case import PARTY_LETTERS
from drivelint.incident.conduct import text_with_party_names
from drivelint.incident.words import profile_text, unit_text
from drivelint.report.html.svg import Axis, axis_around, svg_number

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.incident.case import Case
    from drivelint.incident.motion import MotionOfParties
    from drivelint.result.text import Row

CHART_WIDTH_PX: Final = 700
_LEFT, _RIGHT = 46.0, CHART_WIDTH_PX - 8.0
_TOP, _BOTTOM = 8.0, 97.0
"""Top and bottom of the drawn area in percent of a chart's height; that height depends on the free space on the page."""
_FROM_S, _TO_S = -15.0, 7.0
_LEAST_STEPS_OF_LINE_BREAK: Final = 3
"""A line is interrupted where two values are more than this many steps apart."""
_LEAST_POINTS_OF_VISIBLE_LINE: Final = 3
"""A line with fewer points is drawn as dots."""
_MOST_LINES_OF_REQUIRED_GAPS: Final = 3
"""A chart of gaps has at most this many lines of required gaps."""


class _ChartLine(NamedTuple):
    """One line of a chart: its times in seconds from the moment, and its values, NaN if not known."""

    kind: str
    name: str
    t: list[float]
    values: list[float]
    title: str = ""
    """The text of a legend entry that several lines share; '': `name` is the entry."""
    label: str = ""


def charts_over_time(
    motion: MotionOfParties,
    party_names: Sequence[str],
    gap_courses: Sequence[Row],
    finding_course: Row | None,
    moment_ns: int,
) -> list[dict[str, Any]]:
    """Return the charts from 15 s before to 7 s after the moment, within the drive.

    `gap_courses`: rows of the table `course` of rules that require a distance between the two parties, each with its `title`;
    `finding_course`: the finding's own row of `course` if it measures another quantity.
    """
    steps = [i for i, t in enumerate(motion.t) if _FROM_S - 1e-9 <= t <= _TO_S + 1e-9]
    t = [float(motion.t[i]) for i in steps]
    x = Axis(t[0], t[-1], _LEFT, _RIGHT)
    speeds = [
        _ChartLine(kind, name, t, [float(v[i]) for i in steps])
        for kind, name, v in zip(("ego", "met"), party_names, motion.speed, strict=False)
    ]
    charts = [_chart_values("Speed, m/s", speeds, x, from_zero=True)]
    if len(party_names) > 1:
        lines = [_ChartLine("gap", "gap", t, [float(motion.gap[i]) for i in steps])]
        lines += [
            _course_line(row, "required", f"required: {row['title']}{row['planned']}", moment_ns, t)._replace(
                title=f"required: {row['title']}",
                label="as driven" if row["profile"] == "observed" else row["profile"] or "",
            )
            for row in gap_courses[:_MOST_LINES_OF_REQUIRED_GAPS]
        ]
        charts.append(_chart_values("Gap from box to box, m", lines, x, from_zero=True))
    if finding_course is not None:
        lines = [_course_line(finding_course, name, name, moment_ns, t) for name in ("observed", "required")]
        charts.append(_chart_values(finding_course["title"][:1].upper() + finding_course["title"][1:], lines, x))
    return [chart for chart in charts if chart["lines"]]


def gap_and_finding_courses(case: Case) -> tuple[list[dict[str, Any]], dict[str, Any] | None]:
    """Return the distances that rules required between the two parties over time, and the finding's own measured values.

    The measured values are None if the rule requires a distance or measures a contact in metres: the gap is always drawn.
    """
    rules = {rule["rule_id"]: rule for rule in case.result.rules.to_pylist()}
    units = {row["finding_id"]: row["unit"] for row in case.result.findings.to_pylist()}
    about, near_miss_keys = case.finding.row, ("rule_id", "profile", "occurrence")
    if case.finding.is_near_miss:
        units[None] = about["unit"]  # the courses of near misses have no finding
    gaps, own_course = [], None
    for row in case.result.courses.to_pylist():
        rule, unit = rules[row["rule_id"]], units.get(row["finding_id"])
        if row["finding_id"] is None and any(row[key] != about[key] for key in near_miss_keys):
            continue
        if unit is None or any(row[key] != about[key] for key in ("drive_id", "ego_id", "object_id")):
            continue
        title = f"\u201c{rule['title']}\u201d"
        if unit == "m" and any((value or 0.0) > 0.0 for value in row["required"]):
            gaps.append({**row, "title": title, "planned": profile_text(row["profile"])})
        elif row["finding_id"] in {None, about["finding_id"]} and not (unit == "m" and CONTACT_TAG in rule["tags"]):
            own_course = {
                **row,
                "title": f"{text_with_party_names(rule['observes'] or title, PARTY_LETTERS[0])}, {unit_text(unit)}",
            }
    return gaps, own_course if own_course and any(value is not None for value in own_course["observed"]) else None


def _course_line(course_row: Row, column: str, name: str, moment_ns: int, t: Sequence[float]) -> _ChartLine:
    """Return a column of a row of `course` as a line, within the time range of `t`."""
    at = [(t_ns - moment_ns) / 1e9 for t_ns in course_row["t_ns"]]
    inside = [i for i, s in enumerate(at) if t[0] <= s <= t[-1]]
    values = [math.nan if course_row[column][i] is None else float(course_row[column][i]) for i in inside]
    return _ChartLine("limit" if column == "required" else "gap", name, [at[i] for i in inside], values)


def _chart_values(title: str, lines: Sequence[_ChartLine], x: Axis, *, from_zero: bool = False) -> dict[str, Any]:
    finite_values = [v for line in lines for v in line.values if math.isfinite(v)]
    finite_values += [0.0] if from_zero and finite_values else []
    y = axis_around(finite_values or [0.0], _BOTTOM, _TOP)
    visible_lines = [line for line in lines if any(math.isfinite(v) for v in line.values)]
    drawn_lines = [
        {
            "kind": line.kind,
            "name": line.name,
            "legend": ""
            if line.title and line.title in {earlier_line.title for earlier_line in visible_lines[:i]}
            else line.title or line.name,
            "d": _svg_path(line, x, y),
            "dots": _dots_of_short_line(line, x, y),
            "label": line.label,
            "labels": _label_positions(line, x, y, i),
        }
        for i, line in enumerate(visible_lines)
    ]
    return {
        "title": title,
        "lines": drawn_lines,
        "x_ticks": x.ticks(12),
        "y_ticks": y.ticks(4),
        "zero": svg_number(x.at(0.0)),
    }


def _dots_of_short_line(line: _ChartLine, x: Axis, y: Axis) -> list[tuple[str, str]]:
    """Return the points of a line that has too few steps to be visible; [] for other lines."""
    points = [
        (svg_number(x.at(at)), svg_number(y.at(v)))
        for at, v in zip(line.t, line.values, strict=True)
        if math.isfinite(v)
    ]
    return points if len(points) < _LEAST_POINTS_OF_VISIBLE_LINE else []


def _label_positions(line: _ChartLine, x: Axis, y: Axis, line_no: int) -> list[tuple[str, str, bool]]:
    """Return the positions of a line's label, beside its last point: left of it for odd `line_no`, because lines may be close together."""
    points = [(at, v) for at, v in zip(line.t, line.values, strict=True) if math.isfinite(v)][-1:] if line.label else []
    left = bool(line_no % 2)
    return [(svg_number(x.at(at) + (-6 if left else 6)), svg_number(y.at(v)), left) for at, v in points]


def _svg_path(line: _ChartLine, x: Axis, y: Axis) -> str:
    """Return the SVG path through the values, interrupted where a value is not known or steps are missing."""
    steps = sorted(b - a for a, b in pairwise(line.t))
    hole = _LEAST_STEPS_OF_LINE_BREAK * steps[len(steps) // 2] if steps else math.inf
    parts, last = [], None
    for at, v in zip(line.t, line.values, strict=True):
        if not math.isfinite(v):
            last = None
            continue
        parts.append(f"{'M' if last is None or at - last > hole else 'L'}{svg_number(x.at(at))},{svg_number(y.at(v))}")
        last = at
    return "".join(parts)
