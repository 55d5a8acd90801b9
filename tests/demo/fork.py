"""Roads with a fork: an exit or a side road."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

from tests.demo.line import Line, Piece, Pose
from tests.demo.opendrive import _element, _Lane, _lanes, _n, _numbers, _section, road_elements
from tests.demo.road import LANE_WIDTH_M, Road

if TYPE_CHECKING:
    from collections.abc import Sequence

_BEFORE, _AFTER, _BRANCH, _JUNCTION = "1", "2", "3", "100"
_THROUGH, _OFF, _ON = "10", "11", "12"
_Connection = tuple[str, str, str, list[tuple[int, int]]]


class Fork(NamedTuple):
    """Where a branch leaves the road: by a lane of its own (`exit_m` long, opening over `taper_m`), or as a side road.

    The junction begins at station `at` and is `through_m` long; `turn` leads through it to the pieces of the branch.
    """

    at: float
    through_m: float
    turn: Piece
    branch: tuple[Piece, ...]
    exit_m: float = 0.0
    taper_m: float = 40.0

    @property
    def is_exit(self) -> bool:
        """Tell an exit from a side road."""
        return self.exit_m > 0.0


@dataclass(frozen=True, kw_only=True)
class ForkedRoad(Road):
    """A road with a fork."""

    fork: Fork

    def path(self, *, branch: bool) -> Line:
        """Return the line that traffic along the road follows: on, or into the branch."""
        if not branch:
            return self.line
        return self.line.cut(0.0, self.fork.at).then(self.fork.turn, *self.fork.branch)


def _lanes_before_exit(road: Road) -> list[_Lane]:
    """Return the lanes that go on where an exit lane begins, between the driving lanes and what lies beside them."""
    return [lane._replace(after=lane.number + (lane.number > road.lanes)) for lane in _lanes(road)]


def _lanes_beside_exit(road: ForkedRoad) -> list[_Lane]:
    """Return the lanes where there is an exit lane."""
    n, lanes = road.lanes, {lane.number: lane for lane in _lanes(road)}
    exit_lane = _Lane(n + 1, "exit", _opening(road.fork), lanes[n].mark)
    lanes[n] = lanes[n]._replace(mark="broken")
    lanes[n + 1] = lanes[n + 1]._replace(number=n + 2)
    return [*lanes.values(), exit_lane]


def _opening(fork: Fork) -> str:
    """Return the width of an exit lane: smoothly from nothing to a lane's."""
    taper = fork.taper_m
    cubic = f'<width sOffset="0" a="0" b="0" c="{3 * LANE_WIDTH_M / taper**2!r}" d="{-2 * LANE_WIDTH_M / taper**3!r}"/>'
    return f'{cubic}<width sOffset="{_n(taper)}" a="{LANE_WIDTH_M}" b="0" c="0" d="0"/>'


@road_elements.register
def _forked(road: ForkedRoad) -> list[str]:
    """Return the roads before, after and off the fork, those that connect them, and the junction."""
    line, fork = road.line, road.fork
    end = fork.at + fork.through_m
    before, through, after = line.cut(0.0, fork.at), line.cut(fork.at, end), line.cut(end, line.length_m)
    off = Line((fork.turn,), line.pose(fork.at))
    branch = before.then(fork.turn, *fork.branch).cut(fork.at + fork.turn.length_m, fork.at + 1e6)
    plain = _lanes(road)
    inside = [_Lane(k, mark="none", before=k, after=k) for k in _numbers(road)]
    at_junction = f'elementType="junction" elementId="{_JUNCTION}"'
    first = [_section(road, 0.0, plain, 0.0, fork.at)]
    if fork.is_exit:
        begin = fork.at - fork.exit_m
        first = [
            _section(road, 0.0, _lanes_before_exit(road), 0.0, begin),
            _section(road, begin, _lanes_beside_exit(road), 0.0, fork.at),
        ]
    parts = [
        _element(road, before, first, _BEFORE, link=f"<successor {at_junction}/>"),
        _element(road, after, [_section(road, 0.0, plain, end)], _AFTER, link=f"<predecessor {at_junction}/>", start=end),
        _element(
            road, through, [_section(road, 0.0, inside, fork.at, end)], _THROUGH,
            link=_ends(_BEFORE, "end", _AFTER, "start"), start=fork.at, junction=_JUNCTION,
        ),
    ]  # fmt: skip
    return [*parts, *(_exit(road, off, branch) if fork.is_exit else _side_road(road, off, branch, inside))]


def _ends(before: str, at_before: str, after: str, at_after: str) -> str:
    return (
        f'<predecessor elementType="road" elementId="{before}" contactPoint="{at_before}"/>'
        f'<successor elementType="road" elementId="{after}" contactPoint="{at_after}"/>'
    )


def _exit(road: ForkedRoad, off: Line, branch: Line) -> list[str]:
    """Return the ramp of an exit lane, one way, and the junction: its lane lies beside the through lanes' line."""
    shift = f'<laneOffset s="0" a="{_n(LANE_WIDTH_M * road.lanes * road.nearside_factor)}" b="0" c="0" d="0"/>'
    number = road.lanes + 1
    link = f'<predecessor elementType="junction" elementId="{_JUNCTION}"/>'
    bare = replace(road, centre=((0.0, "solid"),), signs=())  # a ramp has no centre line
    return [
        _element(
            bare, off, [_section(bare, 0.0, [_Lane(1, before=number, after=1)])], _OFF,
            link=_ends(_BEFORE, "end", _BRANCH, "start"), start=1.0, offset=shift, junction=_JUNCTION,
        ),
        _element(bare, branch, [_section(bare, 0.0, [_Lane(1)])], _BRANCH, link=link, start=1.0, offset=shift),
        _junction([*_through(road), (_BEFORE, _OFF, "start", [(number * road.nearside_factor, road.nearside_factor)])]),
    ]  # fmt: skip


def _side_road(road: ForkedRoad, off: Line, branch: Line, inside: Sequence[_Lane]) -> list[str]:
    """Return the side road, the two ways round its corners, and the junction."""
    side = road.nearside_factor
    mouth = branch.start
    on = Line(off.pieces, Pose(mouth.x, mouth.y, mouth.heading + math.pi))
    turned = [_Lane(lane.number, mark="none", before=-lane.number, after=lane.number) for lane in inside]
    link = f'<predecessor elementType="junction" elementId="{_JUNCTION}"/>'
    bare = replace(road, signs=())
    round_off = [_section(road, 0.0, inside)]
    round_on = [_section(road, 0.0, turned)]
    return [
        _element(road, off, round_off, _OFF, link=_ends(_BEFORE, "end", _BRANCH, "start"), start=1.0, junction=_JUNCTION),
        _element(road, on, round_on, _ON, link=_ends(_BRANCH, "start", _AFTER, "start"), start=1.0, junction=_JUNCTION),
        _element(bare, branch, [_section(bare, 0.0, _lanes(bare))], _BRANCH, link=link, start=1.0),
        _junction([
            *_through(road),
            (_BEFORE, _OFF, "start", [(side, side)]),
            (_BRANCH, _OFF, "end", [(-side, -side)]),
            (_BRANCH, _ON, "start", [(-side, side)]),
            (_AFTER, _ON, "end", [(-side, -side)]),
        ]),
    ]  # fmt: skip


def _through(road: Road) -> list[_Connection]:
    links = [(k * road.nearside_factor, k * road.nearside_factor) for k in _numbers(road)]
    along, against = links[: road.lanes], links[road.lanes :]
    return [(_BEFORE, _THROUGH, "start", along), (_AFTER, _THROUGH, "end", against)]


def _junction(connections: Sequence[_Connection]) -> str:
    lines = []
    for i, (incoming, connecting, contact, lanes) in enumerate(connections):
        links = "".join(f'<laneLink from="{a}" to="{b}"/>' for a, b in lanes)
        if links:
            head = f'<connection id="{i}" incomingRoad="{incoming}" connectingRoad="{connecting}" contactPoint="{contact}">'
            lines.append(f"    {head}{links}</connection>")
    return "\n".join([f'  <junction id="{_JUNCTION}" name="fork">', *lines, "  </junction>"])
