"""Roads of the scenes: pieces, lanes, handedness, markings, limits and signs.

A road's line is its centre line. Actors and signs are placed by the station `s` along it and the offset `d` from it,
**positive towards the nearside** (the side of the road that is driven on), so that a scene reads the same for left-hand
and right-hand traffic.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from tests.demo.line import ORIGIN, Line, Piece, Pose

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

LANE_WIDTH_M = 3.5
SIDE_LANE_WIDTH_M = 2.0  # a footway's or a shoulder's width
MPH = 0.44704  # m/s

Handedness = Literal["left", "right"]
SignKind = Literal["exit", "give_way", "no_overtaking", "stop", "stop_line"]


class Sign(NamedTuple):
    """A sign beside the road, or a line painted across it, for traffic along the road."""

    kind: SignKind
    at: float


@dataclass(frozen=True)
class Road:
    """A two-way road. `lanes` and `oncoming` count driving lanes along and against its line.

    `limits_mph` and `centre` (the centre line's marking) hold from their stations on; `beside` lies beside the carriageway.
    `heights`: the road's height (m) at some stations, even between them; none: the map does not say it, and the road lies at 0.
    """

    pieces: tuple[Piece, ...]
    hand: Handedness = "left"
    lanes: int = 1
    oncoming: int = 1
    kind: str = "town"
    limits_mph: tuple[tuple[float, float], ...] = ((0.0, 30.0),)
    centre: tuple[tuple[float, str], ...] = ((0.0, "broken"),)
    beside: Literal["sidewalk", "shoulder"] = "sidewalk"
    signs: tuple[Sign, ...] = ()
    start: Pose = ORIGIN
    heights: tuple[tuple[float, float], ...] = ()

    @property
    def line(self) -> Line:
        """Return the centre line."""
        return Line(self.pieces, self.start)

    @property
    def nearside_factor(self) -> int:
        """Return 1 where the nearside is the left, -1 where it is the right."""
        return 1 if self.hand == "left" else -1

    def lane_offset(self, number: int) -> float:
        """Return the offset of a lane's middle: 1, 2, ... from the centre line to the nearside; -1, -2, ... oncoming."""
        return (abs(number) - 0.5) * (LANE_WIDTH_M if number > 0 else -LANE_WIDTH_M)

    def path(self, *, branch: bool) -> Line:
        """Return the line that traffic along the road follows: on, or into the branch. Errors: `ValueError` where there is none."""
        if branch:
            raise ValueError("this road has no fork to leave by")
        return self.line

    def height_m(self, station: ArrayLike, *, branch: bool) -> NDArray[np.float64]:
        """Return the road's height at stations of the path."""
        del branch  # a branch begins on the road's level and stays there
        at, height = zip(*(self.heights or ((0.0, 0.0),)), strict=True)
        found: NDArray[np.float64] = np.interp(np.asarray(station, np.float64), at, height)
        return found

    def driven_on_the(self, hand: Handedness) -> Road:
        """Return the same road driven on the other side."""
        return replace(self, hand=hand)
