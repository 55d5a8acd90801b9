"""Numbers and paths as SVG writes them, as short as they can be, and axes: round numbers and where they lie."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable

    import numpy as np
    from numpy.typing import NDArray

_MOST_AROUND: Final = 6.0
"""An axis is cut if it is longer than this many times the distance between the values that decide."""
_AROUND: Final = 1.5
"""A cut axis goes so many times this distance beyond them."""
_LEAST_CORE: Final = 0.01


def num(value: float) -> str:
    """Return a number with at most one decimal."""
    if value == (whole := int(value)):
        return str(whole)
    text = f"{value:.1f}".removesuffix(".0")
    return "0" if text == "-0" else text


def polyline(points: NDArray[np.float64]) -> str:
    """Return the path data of an open line through points of shape (n, 2)."""
    return "M" + " ".join([f"{num(x)},{num(y)}" for x, y in points.tolist()])


def polygon(points: NDArray[np.float64]) -> str:
    """Return the path data of a closed ring through points of shape (n, 2)."""
    return polyline(points) + "Z"


def percent(value: float) -> str:
    """Return a share with at most two decimals."""
    return f"{value:.2f}".rstrip("0").rstrip(".") + "%"


class Axis(NamedTuple):
    """Values from `low` to `high` laid from `start` to `end` in drawn units; a value without extent is in the middle."""

    low: float
    high: float
    start: float
    end: float

    def at(self, value: float) -> float:
        """Return where a value lies."""
        if self.high == self.low:
            return (self.start + self.end) / 2
        return self.start + (value - self.low) / (self.high - self.low) * (self.end - self.start)

    def ticks(self, max_ticks: int) -> list[tuple[str, str]]:
        """Return places and labels of at most about `max_ticks` round values."""
        step = round_step((self.high - self.low) / max_ticks) if self.high > self.low else 1.0
        first, last = math.ceil(self.low / step - 1e-9), math.floor(self.high / step + 1e-9)
        digits = max(0, -math.floor(math.log10(step) + 1e-9))
        return [(num(self.at(k * step)), f"{k * step:.{digits}f}") for k in range(first, last + 1)]


def axis_around(values: Iterable[float], start: float, end: float, room: float = 0.06) -> Axis:
    """Return the axis that shows these values with some room on both sides."""
    found = list(values)
    low, high = min(found), max(found)
    pad = (high - low) * room or max(abs(high) * 0.1, 0.5)
    return Axis(low - pad, high + pad, start, end)


def axis_that_decides(
    values: Iterable[float], deciding: Iterable[float], start: float, end: float
) -> tuple[Axis, list[float]]:
    """Return an axis on which the distance between the `deciding` values is seen, and the ends of the values that it cuts off.

    It shows all values, unless they reach so far that the deciding ones would lie on each other.
    """
    found, core = list(values), list(deciding)
    whole = axis_around([*found, *core], start, end)
    if not core:
        return whole, []
    span = max(max(core) - min(core), _LEAST_CORE * (whole.high - whole.low))
    if whole.high - whole.low <= _MOST_AROUND * span:
        return whole, []
    low, high = max(whole.low, min(core) - _AROUND * span), min(whole.high, max(core) + _AROUND * span)
    return Axis(low, high, start, end), [v for v in (min(found), max(found)) if not low <= v <= high]


def round_step(value: float) -> float:
    """Return the least 1, 2 or 5 times a power of ten that is not less."""
    power = 10.0 ** math.floor(math.log10(value)) if value > 0 else 1.0
    return next(k * power for k in (1, 2, 5, 10) if k * power >= value * (1 - 1e-9))
