"""Roads over each other, and drives under a bridge, on a bridge, on a road with two decks, and in a tunnel."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from tests.demo.actors import car, lorry
from tests.demo.line import Line, Pose, straight
from tests.demo.opendrive import _element, _lanes, _section, road_elements
from tests.demo.road import LANE_WIDTH_M, MPH, Road
from tests.demo.scene import Scene

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

NEARSIDE_M: Final = LANE_WIDTH_M / 2
BRIDGE_AT, TUNNEL_AT, SECOND_AT = 300.0, 350.0, 200.0  # where the roads cross: stations of the first, and of the second


@dataclass(frozen=True, kw_only=True)
class TwoLevelRoad(Road):
    """A road, and another one over or under it; no junction joins the two."""

    second: Road

    def path(self, *, branch: bool) -> Line:
        """Return the line that traffic follows: that of the first road, or that of the second."""
        return self.second.line if branch else self.line

    def height_m(self, station: ArrayLike, *, branch: bool) -> NDArray[np.float64]:
        """Return the height of the first road, or of the second."""
        return self.second.height_m(station, branch=False) if branch else super().height_m(station, branch=False)


@road_elements.register
def _two_levels(road: TwoLevelRoad) -> list[str]:
    """Return both roads, each driven on the first one's side."""
    second = road.second.driven_on_the(road.hand)
    return [
        _element(one, one.line, [_section(one, 0.0, _lanes(one))], number)
        for one, number in ((road, "1"), (second, "2"))
    ]


def _crossing(at: float, heights: tuple[tuple[float, float], ...]) -> Road:
    """Return a road that crosses the first one's line at a right angle at a station, with its middle there."""
    return Road((straight(2 * SECOND_AT),), start=Pose(at, -SECOND_AT, math.pi / 2), heights=heights)


BRIDGE: Final = TwoLevelRoad(
    (straight(600.0),), heights=((0.0, 0.0), (600.0, 3.0)), second=_crossing(BRIDGE_AT, ((0.0, 7.5), (400.0, 8.5)))
)
DECKS: Final = TwoLevelRoad(
    (straight(800.0),),
    lanes=2,
    oncoming=0,
    kind="motorway",
    limits_mph=((0.0, 70.0),),
    beside="shoulder",
    heights=((0.0, 0.0), (400.0, 2.0), (800.0, 0.0)),
    second=Road(
        (straight(800.0),),
        lanes=2,
        oncoming=0,
        kind="motorway",
        limits_mph=((0.0, 70.0),),
        beside="shoulder",
        heights=((0.0, 6.5), (400.0, 8.5), (800.0, 6.5)),
    ),
)
TUNNEL: Final = TwoLevelRoad(
    (straight(700.0),),
    limits_mph=((0.0, 40.0),),
    heights=((0.0, 0.0), (160.0, -8.0), (540.0, -8.0), (700.0, 0.0)),
    second=_crossing(TUNNEL_AT, ((0.0, 0.0), (400.0, 0.4))),
)


def level_scenes() -> list[Scene]:
    """Return the drives; in each of them an actor of the other level is in the ego's place in plan."""
    # In left-hand traffic the first road's lane lies north of its line, the second one's west of its own.
    speed = 30 * MPH
    along = car().starts(BRIDGE_AT - NEARSIDE_M - 8.0 * speed).drives(speed)
    across = car().starts(SECOND_AT + NEARSIDE_M - 8.0 * speed).drives(speed)
    ego_below = car().starts(60.0).drives(15.0)
    meet_s = (TUNNEL_AT - NEARSIDE_M - 60.0) / 15.0
    above = car().starts(SECOND_AT + NEARSIDE_M - meet_s * 10.0).drives(10.0)
    stands = car().starts(SECOND_AT + NEARSIDE_M, lane=-1)
    return [
        Scene(
            "bridge-under", "The ego drives under a bridge; in the same moment a car crosses above it.",
            BRIDGE, along, (across.on_the_other_level(),), 16.0, "bridge",
        ),
        Scene(
            "bridge-over", "The ego drives over a bridge; in the same moment a car crosses below it.",
            BRIDGE, across.on_the_other_level(), (along,), 14.0, "bridge",
        ),
        Scene(
            "deck", "The ego drives on the lower of two decks; in plan it drives through a slower lorry on the upper one.",
            DECKS, car().starts(60.0).drives(25.0), (lorry().starts(130.0).drives(20.0).on_the_other_level(),), 26.0, "deck",
        ),
        Scene(
            "tunnel", "The ego drives in a tunnel; on the street above, one car crosses its way and another one stands over it.",
            TUNNEL, ego_below, (above.on_the_other_level(), stands.on_the_other_level()), 36.0, "tunnel",
        ),
    ]  # fmt: skip
