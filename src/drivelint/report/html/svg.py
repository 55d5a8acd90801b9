"""Numbers and paths in SVG's notation, as short as possible; axes with round numbers as ticks."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable

    import numpy as np
    from numpy.typing import NDArray

_MARGIN_SHARE: Final = 0.06
"""The margin of an axis on each side, as a share of the range of its values."""
_AXIS_UNCUT_UP_TO_N_DECIDING_SPANS: Final = 6.0
"""An axis that is longer than this many times the distance between the deciding values is cut."""
_CUT_AXIS_SPANS_BEYOND_DECIDING_VALUES: Final = 1.5
"""A cut axis extends beyond the deciding values by this many times the distance between them."""
_LEAST_DECIDING_SPAN_SHARE: Final = 0.01
"""The distance between the deciding values counts as at least this share of the axis."""


def svg_number(value: float) -> str:
    """Return a number with at most one decimal."""
    if value == (whole := int(value)):
        return str(whole)
    text = f"{value:.1f}".removesuffix(".0")
    return "0" if text == "-0" else text


def polyline_path(points: NDArray[np.float64]) -> str:
    """Return the path data of an open line through points of shape (n, 2)."""
    return "M" + " ".join([f"{svg_number(x)},{svg_number(y)}" for x, y in points.tolist()])


def polygon_path(points: NDArray[np.float64]) -> str:
    """Return the path data of a closed ring through points of shape (n, 2)."""
    return polyline_path(points) + "Z"


def percent(value: float) -> str:
    """Return a value in percent as text with at most two decimals: `12.5%` for 12.5."""
    return f"{value:.2f}".rstrip("0").rstrip(".") + "%"


class Axis(NamedTuple):
    """An axis: values from `low` to `high`, drawn from `start` to `end`. If `low` equals `high`, values are drawn in the middle."""

    low: float
    high: float
    start: float
    end: float

    def at(self, value: float) -> float:
        """Return the position of a value on the drawn axis."""
        if self.high == self.low:
            return (self.start + self.end) / 2
        return self.start + (value - self.low) / (self.high - self.low) * (self.end - self.start)

    def ticks(self, max_ticks: int) -> list[tuple[str, str]]:
        """Return positions and labels of about `max_ticks` round values at most."""
        step = round_step((self.high - self.low) / max_ticks) if self.high > self.low else 1.0
        first, last = math.ceil(self.low / step - 1e-9), math.floor(self.high / step + 1e-9)
        digits = max(0, -math.floor(math.log10(step) + 1e-9))
        return [(svg_number(self.at(k * step)), f"{k * step:.{digits}f}") for k in range(first, last + 1)]


def axis_around(values: Iterable[float], drawn_start: float, drawn_end: float) -> Axis:
    """Return an axis that shows all values, with a margin on both sides. It is drawn from `drawn_start` to `drawn_end`."""
    numbers = list(values)
    low, high = min(numbers), max(numbers)
    pad = (high - low) * _MARGIN_SHARE or max(abs(high) * 0.1, 0.5)
    return Axis(low - pad, high + pad, drawn_start, drawn_end)


def axis_for_deciding_values(
    values: Iterable[float], deciding: Iterable[float], drawn_start: float, drawn_end: float
) -> tuple[Axis, list[float]]:
    """Return an axis on which the `deciding` values are distinguishable, and the least and greatest value if the axis cuts them off.

    The axis shows all values, unless their range is so wide that the deciding values would be drawn on top of each other.
    """
    numbers, core = list(values), list(deciding)
    whole = axis_around([*numbers, *core], drawn_start, drawn_end)
    if not core:
        return whole, []
    span = max(max(core) - min(core), _LEAST_DECIDING_SPAN_SHARE * (whole.high - whole.low))
    if whole.high - whole.low <= _AXIS_UNCUT_UP_TO_N_DECIDING_SPANS * span:
        return whole, []
    low, high = (
        max(whole.low, min(core) - _CUT_AXIS_SPANS_BEYOND_DECIDING_VALUES * span),
        min(whole.high, max(core) + _CUT_AXIS_SPANS_BEYOND_DECIDING_VALUES * span),
    )
    return Axis(low, high, drawn_start, drawn_end), [v for v in (min(numbers), max(numbers)) if not low <= v <= high]


def round_step(value: float) -> float:
    """Return the least number that is 1, 2 or 5 times a power of ten and not less than `value`."""
    power = 10.0 ** math.floor(math.log10(value)) if value > 0 else 1.0
    return next(k * power for k in (1, 2, 5, 10) if k * power >= value * (1 - 1e-9))
