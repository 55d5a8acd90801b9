"""Plots a margin over time with block characters (eighths) above and below the line at which the rule is just kept."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, NamedTuple

from drivelint.result.text import seconds

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.explain.model import Step

_EIGHTHS: Final = " ▁▂▃▄▅▆▇█"
_UNKNOWN: Final = "?"


class _Column(NamedTuple):
    """The steps in one column: the least margin, whether any step failed or was unknown, and whether there is any step."""

    margin: float | None
    failed: bool
    unknown: bool
    has_step: bool


def plot_lines(steps: Sequence[Step], width: int, height: int, drive_start_ns: int, unit: str) -> list[str]:
    """Return the lines of a plot with margins as bars from the zero line, and `?` for unknown steps. `steps` are in time order.

    The plot of a rule that measures nothing is one line: `█` broken, `·` kept, `?` unknown.
    """
    if len(steps) < 2:
        return []
    columns = [column for column in _columns(steps, width) for _ in range(max(1, width // len(steps)))]
    is_measured = any(column.margin is not None for column in columns)
    label_width = max(9, len(unit) + 8)
    strip = "".join("█" if c.failed else _UNKNOWN if c.unknown else "·" if c.has_step else " " for c in columns)
    body = _bar_lines(columns, height, label_width, unit) if is_measured else [" " * label_width + " " + strip]
    first, last = (seconds(step.t_ns, drive_start_ns) for step in (steps[0], steps[-1]))
    axis = " " * label_width + " " + first + last.rjust(max(len(last) + 1, len(columns) - len(first)))
    return [*body, axis]


def _columns(steps: Sequence[Step], width: int) -> list[_Column]:
    t0, t1 = steps[0].t_ns, steps[-1].t_ns
    n = min(width, max(len(steps), 2))
    cells: list[list[Step]] = [[] for _ in range(n)]
    for step in steps:
        cells[min(n - 1, (step.t_ns - t0) * n // max(1, t1 - t0))].append(step)
    return [
        _Column(
            min((s.margin for s in cell if s.margin is not None), default=None),
            any(s.holds is False for s in cell),
            any(s.holds is None for s in cell),
            bool(cell),
        )
        for cell in cells
    ]


def _bar_lines(columns: Sequence[_Column], height: int, label_width: int, unit: str) -> list[str]:
    margins = [c.margin for c in columns if c.margin is not None]
    top, bottom = max(0.0, *margins), min(0.0, *margins)
    size = (top - bottom) / height or 1.0
    above, below = math.ceil(top / size - 1e-9), math.ceil(-bottom / size - 1e-9)
    heads = {above: f"{top:+.3g} {unit}", -below: f"{bottom:+.3g} {unit}", 0: "limit"}
    lines = []
    for row in range(above, -below - 1, -1):
        if row:
            cells = "┤" + "".join(_bar_character(c.margin, row, size) for c in columns)
        else:
            cells = "┼" + "".join(
                _UNKNOWN if c.unknown and not c.failed else "─" if c.has_step else " " for c in columns
            )
        lines.append(f"{heads.get(row, ''):>{label_width}}{cells}")
    return lines


def _bar_character(margin: float | None, row: int, row_height: float) -> str:
    """Return the character of a column in a row above (1, 2, ...) or below (-1, -2, ...) the zero line."""
    part = 0.0 if margin is None else ((margin if row > 0 else -margin) - (abs(row) - 1) * row_height) / row_height
    if part <= 0:
        return " "
    if row > 0:
        return _EIGHTHS[min(8, max(1, round(part * 8)))]
    # of blocks at the top of a cell, Unicode has only these
    return "█" if part >= 0.75 else "▀" if part >= 0.25 else "▔"
