"""The maps on which the drives go: streets and carriageways."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from tests.outsiders.seventh.road import Kind, Lane, Line, Road, Section
from tests.outsiders.seventh.ways import along, chain

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tests.outsiders.seventh.road import Marks, Piece
    from tests.outsiders.seventh.ways import Way

Nation = Literal["gb", "de"]
Span = tuple[float, float]
ORIGIN = (0, 0, 0)
HEADER = (
    '<header revMajor="1" revMinor="6" name="i" version="1" date="2026-11-23T00:00:00" '
    'north="0" south="0" east="0" west="0"/>'
)


class Map:
    """Roads and the ways through their junctions; `hand` is 1 where the left is driven on, else -1."""

    def __init__(self, nation: Nation, width: float) -> None:
        self.hand = 1 if nation == "gb" else -1
        self.width = width
        self.own = self.hand * width / 2  # t of the lane next to the middle, of those who go along a road
        self.roads: list[Road] = []
        self.links: dict[int, list[tuple[int, int, int, int]]] = {}  # of a junction: road, way through, lanes

    def kind(self, name: str, limit: float) -> Kind:
        """Return a road's kind, with a limit in the nation's unit."""
        return Kind(name, limit, *(("mph", "LHT") if self.hand == 1 else ("km/h", "RHT")))

    def xml(self) -> str:
        """Return the map as OpenDRIVE."""
        out = ['<?xml version="1.0" encoding="UTF-8"?>', "<OpenDRIVE>", HEADER]
        out += [road.xml() for road in self.roads]
        for junction, links in self.links.items():
            out.append(f'<junction name="j{junction}" id="{junction}">')
            for n, (road, through, a, b) in enumerate(links):
                out.append(
                    f'<connection id="{n}" incomingRoad="{road}" connectingRoad="{through}" contactPoint="start">'
                    f'<laneLink from="{a}" to="{b}"/></connection>'
                )
            out.append("</junction>")
        return "\n".join([*out, "</OpenDRIVE>"])


class Street(Map):
    """A road with one lane each way."""

    def __init__(  # noqa: PLR0917
        self,
        nation: Nation = "gb",
        length: float = 600,
        pieces: Sequence[Piece] = (),
        kind: str = "rural",
        limit: float | None = None,
        width: float = 3.5,
        centre: str | Marks = "broken",
        footway: bool = False,
        z: tuple[float, float, float] | None = None,
    ) -> None:
        super().__init__(nation, width)
        side = [Lane("driving", width)] + [Lane("sidewalk", 2.0, "none")] * footway
        marks = ((0, centre),) if isinstance(centre, str) else centre
        if limit is None:
            limit = 60 if nation == "gb" else 100
        section = Section(0, side, side, marks)
        self.road = Road(1, ORIGIN, pieces or [Line(length)], [section], self.kind(kind, limit), z=z)
        self.roads.append(self.road)
        self.way = along(self.road, self.own)

    def back(self) -> Way:
        """The way of those who come towards the ego."""
        return chain([(self.road, -self.own, self.road.length, 0.0)])

    def zebra(self, s: float, name: str = "zebra", length: float = 3.0, outline: bool = True) -> None:
        """Lay a crossing over the road."""
        self.road.area("crosswalk", name, s, 0, length, 2 * self.width, outline)

    def pelican(self, s: float) -> None:
        """Lay a signalled crossing over the road, with a stop line and a light 4 m before it."""
        self.zebra(s, "signal crossing")
        self.road.area("stopLine", "stopline", s - 4, self.own, 0.3, self.width)
        self.road.sign("P1", s - 4, self.hand * 4.2, "1000001", "traffic_light", lane=self.hand)


def town(length: float = 500, zebra: float | None = None, **more: Any) -> Street:
    """A British street with footways."""
    drawn = Street("gb", length, kind="town", limit=30, footway=True)
    if zebra is not None:
        drawn.zebra(zebra, **more)
    return drawn


def german_town(length: float = 500) -> Street:
    """A German street with footways."""
    return Street("de", length, kind="town", limit=50, footway=True)


class Carriageway(Map):
    """Lanes in one direction, counted from the middle; a lane beside them from one s to another."""

    def __init__(  # noqa: PLR0917
        self,
        nation: Nation = "gb",
        lanes: int = 3,
        length: float = 1200,
        kind: str = "motorway",
        limit: float | None = None,
        width: float = 3.65,
        shoulder: bool = True,
        entry: Span | None = None,
        exit_: Span | None = None,
        pieces: Sequence[Piece] = (),
        both: bool = False,
    ) -> None:
        super().__init__(nation, width)
        cuts: list[tuple[float, str]] = [(0, "")]
        for span, beside in ((entry, "entry"), (exit_, "exit")):
            if span:
                cuts += [(span[0], beside), (span[1], "")]
        sections = []
        for s, beside in cuts:
            mine, other = self._lanes(lanes, beside, shoulder), self._lanes(lanes, "", shoulder) if both else []
            left, right = (mine, other) if self.hand == 1 else (other, mine)
            sections.append(Section(s, left, right, ((0, "solid"),)))
        if limit is None:
            limit = 70 if nation == "gb" else 130
        self.road = Road(1, ORIGIN, pieces or [Line(length)], sections, self.kind(kind, limit))
        self.roads.append(self.road)

    def lane(self, number: int) -> float:
        """Return t of a lane: 1 is next to the middle."""
        return self.hand * (number - 0.5) * self.width

    def on(self, number: int) -> Way:
        """The way along a lane."""
        return along(self.road, self.lane(number))

    def against(self, number: int) -> Way:
        """The way along a lane against its traffic."""
        return chain([(self.road, self.lane(number), self.road.length, 0.0)])

    def exit_sign(self, ident: str, s: float, kind: str) -> None:
        """Put up a sign for an exit."""
        self.road.sign(ident, s, self.hand * 15, kind, "exit", lane=3)

    def _lanes(self, count: int, beside: str, shoulder: bool) -> list[Lane]:
        out = [Lane("driving", self.width, "broken")] * (count - 1)
        out.append(Lane("driving", self.width, "broken" if beside else "solid"))
        if beside:
            out.append(Lane(beside, self.width))
        return out + [Lane("shoulder", 3.0, "none")] * shoulder


def dual(**more: Any) -> Carriageway:
    """A British dual carriageway of two lanes."""
    return Carriageway(**{"lanes": 2, "shoulder": False, "kind": "rural", "limit": 70, **more})


def city(length: float = 500, width: float = 3.4) -> Carriageway:
    """A British one-way street of two lanes."""
    return Carriageway(lanes=2, length=length, kind="town", limit=30, width=width, shoulder=False)


def autobahn(lanes: int = 3) -> Carriageway:
    """A carriageway of a German motorway."""
    return Carriageway("de", lanes)
