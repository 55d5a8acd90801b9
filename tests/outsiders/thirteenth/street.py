"""Streets and carriageways: one road, and those who drive along it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tests.outsiders.thirteenth.motion import Across, Actor, Speeds, along
from tests.outsiders.thirteenth.road import Frame, Lane, Map, Road, Section

N, AWAY = 1.75, -1.75  # the own lane of a road of two lanes, and the opposing one
Middle = str | Sequence[tuple[float, str]]


class Street:
    """A road from the origin along x, with n lanes on the near side and opposing ones on the other."""

    def __init__(self, lht: bool, lanes: Sequence[Lane], opposing: Sequence[Lane], **more: Any) -> None:
        middle: Middle = more.get("middle", "broken")
        self.road = Road(
            1,
            [(more["length"], more.get("curve", 0.0))],
            (0.0, 0.0, 0.0),
            lht,
            more["kind"],
            more["limit"],
            [Section(0.0, lanes, opposing)],
            [(0.0, middle)] if isinstance(middle, str) else middle,
        )
        self.frame: Frame = more.get("frame", (0.0, 0.0, 0.0))
        self.side, self.lanes = self.road.side, sum(lane.kind == "driving" for lane in lanes)
        self.with_it, self.against_it = along(self.road), along(self.road, back=True)

    @property
    def map(self) -> Map:
        """The map of it."""
        return Map([self.road], frame=self.frame)

    def go(self, name: str, cls: str | None, s: float, speeds: Speeds, across: float | Across, **more: Any) -> Actor:
        """Somebody who goes along it."""
        return Actor(name, cls, self.with_it, s + 100, speeds, _across(across), self.side, **more)

    def come(self, name: str, cls: str | None, s: float, speeds: Speeds, across: float | Across, **more: Any) -> Actor:
        """Somebody who comes the other way; across: to that one's near side."""
        start = self.road.length + 100 - 0.25 - s
        return Actor(name, cls, self.against_it, start, speeds, _across(across), self.side, **more)


def two_way(lht: bool = True, n: int = 1, opposing: int = 1, walk: float = 0.0, **more: Any) -> Street:
    """A road of both directions; rural, 60 mph and 1500 m long if nothing else is said."""

    def lanes(count: int) -> list[Lane]:
        drawn = [Lane() for _ in range(count - 1)] + [Lane(mark="solid")]
        return [*drawn, Lane("sidewalk", walk, "none")] if walk else drawn

    wanted = {"length": 1500.0, "kind": "rural", "limit": 26.82, **more}
    return Street(lht, lanes(n), lanes(opposing), **wanted)


def motorway(lht: bool, n: int = 3, limit: float | None = None, **more: Any) -> Street:
    """One carriageway of a motorway, with a hard shoulder, and a strip by the middle."""
    shoulder = Lane("shoulder", 3.0, "none")
    lanes = [Lane(width=3.75) for _ in range(n - 1)] + [Lane(width=3.75, mark="solid"), shoulder]
    return Street(lht, lanes, [shoulder], kind="motorway", limit=limit, middle="solid", **{"length": 2500.0, **more})


def in_lane(lane: int, n: int = 3) -> float:
    """Return u of a lane of a carriageway of n lanes; 1: the one by the hard shoulder."""
    return (n - lane + 0.5) * 3.75


def change(before: int, after: int, t: float, lasts: float = 4.0) -> Across:
    """From one lane of three to another."""
    return [(0, in_lane(before)), (t, in_lane(before)), (t + lasts, in_lane(after))]


def _across(across: float | Across) -> Across:
    return across if isinstance(across, Sequence) else ((0.0, across),)
