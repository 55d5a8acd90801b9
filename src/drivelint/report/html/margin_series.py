"""The margin of a rule over time around a finding: a chart of observed and required values, and the steps."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final

from drivelint.report.html.svg import Axis, axis_for_deciding_values, svg_number
from drivelint.result.text import number

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.result.text import Row

WIDTH: Final = 420
HEIGHT: Final = 132
_LEFT, _RIGHT, _TOP, _BOTTOM = 42.0, WIDTH - 8.0, 8.0, HEIGHT - 20.0
_MOST_SHOWN_STEPS: Final = 9
_LEAST_STEPS_FOR_CHART: Final = 3
"""The least number of steps for which a chart is drawn."""


def margin_series(row: Row, worst_ns: int, unit: str | None, start_ns: int) -> dict[str, Any]:
    """Return the margin of a finding over time from its row of the table `course`, in `unit`.

    `chart`: None if there are too few steps or no measured values; `steps`: the steps around the worst step.
    """
    t: list[int] = row["t_ns"]
    worst = min(range(len(t)), key=lambda i: abs(t[i] - worst_ns))
    first = max(0, min(worst - _MOST_SHOWN_STEPS // 2, len(t) - _MOST_SHOWN_STEPS))
    steps = [
        {
            "time": f"{(t[i] - start_ns) / 1e9:.2f}",
            **{name: row[name][i] for name in ("observed", "required", "margin", "holds")},
            "worst": i == worst,
        }
        for i in range(first, min(first + _MOST_SHOWN_STEPS, len(t)))
    ]
    has_chart = len(t) >= _LEAST_STEPS_FOR_CHART and any(value is not None for value in row["observed"])
    return {
        "chart": _chart(row, worst, unit, start_ns) if has_chart else None,
        "unit": unit or "",
        "steps": steps,
        "n_steps": len(t),
    }


def _chart(row: Row, worst: int, unit: str | None, start_ns: int) -> dict[str, Any]:
    """Return the chart's lines in a frame of 420 by 132.

    `t0`, `t1`: the time at its left and right end in hundredths of a second; `cut`: the extreme values that the frame cuts off.
    """
    t = [(t_ns - start_ns) / 1e9 for t_ns in row["t_ns"]]
    x = Axis(t[0], t[-1], _LEFT, _RIGHT)
    values = [v for name in ("observed", "required") for v in row[name] if v is not None]
    worst_value = row["observed"][worst]
    limits = [v for v, is_kept in zip(row["required"], row["holds"], strict=True) if is_kept is False]
    deciding = [v for v in (worst_value, row["required"][worst], *limits) if v is not None]
    y, cut_values = axis_for_deciding_values(values, deciding, _BOTTOM, _TOP)
    return {
        "observed": _line_path(t, row["observed"], x, y),
        "required": _line_path(t, row["required"], x, y),
        "spans": _spans_not_kept(t, row["holds"], x),
        "worst": (
            svg_number(x.at(t[worst])),
            svg_number((_TOP + _BOTTOM) / 2 if worst_value is None else y.at(worst_value)),
        ),
        "t_ticks": x.ticks(6),
        "v_ticks": y.ticks(4),
        "unit": unit or "",
        "cut": " and ".join(number(v, unit) for v in cut_values),
        "t0": round(t[0] * 100),
        "t1": round(t[-1] * 100),
        "words": _chart_words(row, t, unit),
    }


def _line_path(t: Sequence[float], values: Sequence[float | None], x: Axis, y: Axis) -> str:
    """Return the SVG path through the values, interrupted where a value is None or steps are missing."""
    gap = 3 * _typical_step_s(t)
    parts, last = [], None
    for at, value in zip(t, values, strict=True):
        if value is None:
            last = None
            continue
        parts.append(
            f"{'M' if last is None or at - last > gap else 'L'}{svg_number(x.at(at))},{svg_number(y.at(value))}"
        )
        last = at
    return "".join(parts)


def _typical_step_s(t: Sequence[float]) -> float:
    steps = sorted(b - a for a, b in pairwise(t))
    return steps[len(steps) // 2] if steps else math.inf


def _spans_not_kept(t: Sequence[float], holds: Sequence[bool | None], x: Axis) -> list[dict[str, str]]:
    """Return the periods in which the rule is not kept or unknown; each extends by half a step on both sides."""
    half, gap = _typical_step_s(t) / 2, 3 * _typical_step_s(t)
    runs: list[tuple[str, float, float]] = []
    for at, is_kept in zip(t, holds, strict=True):
        kind = {True: "", False: "fail", None: "unknown"}[is_kept]
        if runs and runs[-1][0] == kind and at - runs[-1][2] <= gap:
            runs[-1] = kind, runs[-1][1], at
        else:
            runs.append((kind, at, at))
    spans = []
    for kind, a, b in runs:
        if kind:
            left, right = max(x.at(a - half), _LEFT), min(x.at(b + half), _RIGHT)
            spans.append({"kind": kind, "x": svg_number(left), "w": svg_number(max(right - left, 1.5))})
    return spans


def _chart_words(row: Row, t: Sequence[float], unit: str | None) -> str:
    values = [v for v in row["observed"] if v is not None]
    between = f"observed between {number(min(values), unit)} and {number(max(values), unit)}, "
    failed = sum(is_kept is False for is_kept in row["holds"])
    last = next((v for v in reversed(row["required"]) if v is not None), None)
    required = "" if last is None else f"required {number(last, unit)} at the end, "
    return f"From {t[0]:.1f} s to {t[-1]:.1f} s: {between}{required}not kept at {failed} of {len(t)} steps"
