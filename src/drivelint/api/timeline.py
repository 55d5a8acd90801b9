"""The timeline of a finding: a table for computing, and charts for people."""

from __future__ import annotations

from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pyarrow as pa
import pyarrow.compute as pc

from drivelint.api.tables import Table
from drivelint.incident.finding import named_finding
from drivelint.report.html.environment import page_environment
from drivelint.report.html.moment_charts import box_distance_line, charts_below_plan_view
from drivelint.report.html.worst_moment import finding_key

if TYPE_CHECKING:
    from collections.abc import Mapping

    from drivelint.options.types import AnyPath
    from drivelint.result.model import Result
    from drivelint.result.text import Row

_VALUE_COLUMNS = (
    "gap_m", "ego_speed_mps", "ego_accel_mps2", "object_speed_mps", "object_accel_mps2", "observed", "required", "margin",
)  # fmt: skip
_PAGE = """{% import 'macros.html.j2' as m with context %}<!doctype html><html lang="en"><head><meta charset="utf-8">
<title>{{ title }}</title><style>{{ style }}</style></head><body><figure class="scene">{{ m.strips(s) }}</figure></body></html>"""


class Figure:
    """A drawing that a notebook shows, and that can be saved as an HTML page."""

    def __init__(self, page: str, height: int) -> None:
        self._page, self._height = page, height

    def save(self, path: AnyPath) -> Path:
        """Write the drawing as an HTML page that opens offline, and return its path."""
        file = Path(path)
        file.write_text(self._page, encoding="utf-8")
        return file

    def _repr_html_(self) -> str:
        """Return the drawing in an iframe, so that its style and the notebook's style do not affect each other."""
        return f'<iframe srcdoc="{escape(self._page)}" width="640" height="{self._height}" style="border: 0"></iframe>'


class Timeline(Table):
    """One row per time stamp from 5 s before to 5 s after the worst step of a finding, and one row per judged step.

    `t_ns`: time on the log's clock; `t_s`: seconds since the drive's first time stamp. `gap_m`: distance of the boxes, 0 if they touch.
    Speeds and accelerations are in m/s and m/s2, at most five values per second. `observed`, `required` and `margin`: values of the rule,
    in its unit, at the steps that it judged. NULL: unknown, or no value at this time stamp.
    """

    __slots__ = ("_chart_data", "_title")

    def __init__(self, rows: pa.Table, chart_data: dict[str, Any] | None, title: str) -> None:
        super().__init__(rows)
        self._chart_data, self._title = chart_data, title

    def plot(self) -> Figure | None:
        """Return the charts of the report: speeds, gap, and the rule's measured value; None if the ego's path is unknown."""
        if self._chart_data is None:
            return None
        template = page_environment(()).from_string(_PAGE)
        return Figure(
            template.render(s=self._chart_data, title=self._title), round(float(self._chart_data["height"]) * 1.1) + 60
        )


def timeline(result: Result, name: str) -> Timeline:
    """Return the timeline of a finding. `name`: as in `CheckResult.timeline`. Errors: `UsageError` for an unknown finding."""
    finding = named_finding(result, name)
    row, start_ns = finding.row, finding.drive_start_ns
    at = {"drive_id": row["drive_id"], "ego_id": row["ego_id"], "t_ns": row["t_worst_ns"]}
    scene = next(iter(_matching_rows(result.scenes, at)), None)
    courses = _matching_rows(result.courses, {"finding_id": row["finding_id"]})
    course = next((candidate for candidate in courses if finding_key(candidate) == finding_key(row)), None)
    values: dict[int, dict[str, float | None]] = {}
    if scene is not None:
        _add_motion(values, scene, row["object_id"])
    if course is not None:
        for t_ns, *numbers in zip(*(course[key] for key in ("t_ns", "observed", "required", "margin")), strict=True):
            values.setdefault(t_ns, {}).update(zip(("observed", "required", "margin"), numbers, strict=True))
    times = sorted(values)
    table = pa.table(
        {
            "t_ns": pa.array(times, pa.int64()),
            "t_s": pa.array([(t_ns - start_ns) / 1e9 for t_ns in times], pa.float64()),
            **{name: pa.array([values[t_ns].get(name) for t_ns in times], pa.float64()) for name in _VALUE_COLUMNS},
        }
    )
    charts = None if scene is None else charts_below_plan_view(scene, row, course, finding.rule["observes"], start_ns)
    return Timeline(table, charts, f"{row['rule_id']} in {row['drive_id']}")


def _matching_rows(table: pa.Table, values_by_column: Mapping[str, object]) -> list[Row]:
    """Return the rows that have these values."""
    for column, value in values_by_column.items():
        table = table.filter(pc.equal(table[column], value))
    rows: list[Row] = table.to_pylist()
    return rows


def _add_motion(values: dict[int, dict[str, float | None]], scene: Row, object_id: str | None) -> None:
    """Add the speeds and accelerations of ego and object, and the gap between them, to `values`."""
    ego = scene["actors"][0]
    met = next((actor for actor in scene["actors"][1:] if actor["actor_id"] == object_id), None)
    for role, actor in (("ego", ego), ("object", met)):
        for point in (actor and actor["path"]) or ():
            columns = {f"{role}_speed_mps": point["speed_mps"], f"{role}_accel_mps2": point["accel_mps2"]}
            values.setdefault(point["t_ns"], {}).update(columns)
    gap = box_distance_line(ego, met) if met is not None and ego["path"] and met["path"] else None
    for t_ns, distance in zip(gap.t_ns, gap.values, strict=True) if gap is not None else ():
        values[t_ns]["gap_m"] = distance
