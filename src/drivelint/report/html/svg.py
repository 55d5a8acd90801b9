"""Numbers and paths as SVG writes them, as short as they can be."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


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
