"""Writes a road of the scenes as OpenDRIVE 1.7."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from drivelint.demo.line import Line, Pose
from drivelint.demo.road import LANE_WIDTH_M, SIDE_LANE_WIDTH_M

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from drivelint.demo.road import Fork, Road, Sign

T = TypeVar("T")
MAKER = "drivelint demo"
"""Stands in every file that is written here: what carries it may be overwritten."""

_SIGNS = {  # country, code, name
    "exit": ("GB", "-1", "exit sign"),
    "give_way": ("GB", "602", "give way"),
    "no_overtaking": ("GB", "632", "no overtaking"),
    "stop": ("GB", "601.1", "stop"),
    "stop_line": ("DE", "294", "stop line"),
}
_BEFORE, _AFTER, _BRANCH, _JUNCTION = "1", "2", "3", "100"
_THROUGH, _OFF, _ON = "10", "11", "12"


class _Lane(NamedTuple):
    """One lane; numbers count from the centre line, positive on the nearside, None: no such link."""

    number: int
    kind: str = "driving"
    width: str = f'<width sOffset="0" a="{LANE_WIDTH_M}" b="0" c="0" d="0"/>'
    mark: str = "solid"
    before: int | None = None
    after: int | None = None


def opendrive(road: Road, name: str) -> str:
    """Return the road's OpenDRIVE text, the same for the same road."""
    parts = _forked(road, road.fork) if road.fork else [_whole(road)]
    return "\n".join([
        '<?xml version="1.0" encoding="UTF-8"?>',
        "<OpenDRIVE>",
        f'  <header revMajor="1" revMinor="7" name="{name}" version="1.00" vendor="{MAKER}"/>',
        *parts,
        "</OpenDRIVE>",
        "",
    ])  # fmt: skip


def _whole(road: Road) -> str:
    return _element(road, _BEFORE, road.line, [_section(road, 0.0, _lanes(road))])


def _n(value: float) -> str:
    """Return a number with at most six decimals and no sign on zero."""
    return repr(round(value, 6) + 0.0)


def _from(said: Iterable[tuple[float, T]], start: float, end: float) -> list[tuple[float, T]]:
    """Return what holds between two stations, counted from the first of them."""
    held = {max(s - start, 0.0): value for s, value in said if s < end}
    return list(held.items())


def _element(
    road: Road, number: str, line: Line, sections: Sequence[str], *, link: str = "", start: float = 0.0, more: str = ""
) -> str:
    """Return one `<road>`, which begins at the station `start` of the scene's road."""
    end = start + line.length_m
    geometry = [
        f'      <geometry s="{_n(s)}" x="{_n(p.x)}" y="{_n(p.y)}" hdg="{_n(p.heading)}" length="{_n(piece.length_m)}">'
        + (f'<arc curvature="{piece.curvature!r}"/>' if piece.curvature else "<line/>")
        + "</geometry>"
        for s, p, piece in line.placed_pieces()
    ]
    limits = [
        f'    <type s="{_n(s)}" type="{road.kind}"><speed max="{mph:g}" unit="mph"/></type>'
        for s, mph in _from(road.limits_mph, start, end)
    ]
    signs = [sign for sign in road.signs if number in {_BEFORE, _AFTER} and start <= sign.at < end]
    signals = [_signal(road, 100 * int(number) + i, sign, sign.at - start) for i, sign in enumerate(signs, 1)]
    junction = _JUNCTION if len(number) > 1 else "-1"
    rule = "LHT" if road.hand == "left" else "RHT"
    return "\n".join([
        f'  <road name="{number}" length="{_n(line.length_m)}" id="{number}" junction="{junction}" rule="{rule}">',
        *([f"    <link>{link}</link>"] if link else []),
        *limits,
        "    <planView>", *geometry, "    </planView>",
        f"    <lanes>{more}", *sections, "    </lanes>",
        *(["    <signals>", *signals, "    </signals>"] if signals else []),
        "  </road>",
    ])  # fmt: skip


def _numbers(road: Road) -> list[int]:
    return [*range(1, road.lanes + 1), *(-k for k in range(1, road.oncoming + 1))]


def _lanes(road: Road, *, exit_lane: bool = False, ahead: bool = False) -> list[_Lane]:
    """Return the road's lanes; `exit_lane`: with one more on the nearside, `ahead`: that one begins where these end."""
    n, m = road.lanes, road.oncoming
    edge = "curb" if road.beside == "sidewalk" else "solid"
    lanes = []
    for k in _numbers(road):
        outermost = k in {n, -m}
        mark = "broken" if not outermost or (exit_lane and k == n) else edge
        lanes.append(_Lane(k, mark=mark, after=k if ahead else None))
    if exit_lane and road.fork:
        lanes.append(_Lane(n + 1, "exit", _opening(road.fork), edge))
    width = f'<width sOffset="0" a="{SIDE_LANE_WIDTH_M}" b="0" c="0" d="0"/>'
    near = n + 2 if exit_lane else n + 1
    lanes.append(_Lane(near, road.beside, width, "none", after=n + 2 if ahead else None))
    lanes.append(_Lane(-m - 1, road.beside, width, "none", after=-m - 1 if ahead else None))
    return lanes


def _opening(fork: Fork) -> str:
    """Return the width of an exit lane: smoothly from nothing to a lane's."""
    taper = fork.taper_m
    cubic = f'<width sOffset="0" a="0" b="0" c="{3 * LANE_WIDTH_M / taper**2!r}" d="{-2 * LANE_WIDTH_M / taper**3!r}"/>'
    return f'{cubic}<width sOffset="{_n(taper)}" a="{LANE_WIDTH_M}" b="0" c="0" d="0"/>'


def _section(road: Road, s: float, lanes: Sequence[_Lane], start: float = 0.0, end: float = 1e9) -> str:
    """Return a lane section at `s` of its road, which begins at the station `start` of the scene's road."""
    side = road.nearside_sign
    ordered = sorted(lanes, key=lambda lane: -lane.number * side)
    centre = "".join(_mark(marking, at) for at, marking in _from(road.centre, start + s, end))
    left = [_lane(lane, side) for lane in ordered if lane.number * side > 0]
    right = [_lane(lane, side) for lane in ordered if lane.number * side < 0]
    return "\n".join([
        f'      <laneSection s="{_n(s)}">',
        *(["        <left>", *left, "        </left>"] if left else []),
        f'        <center><lane id="0" type="none" level="false">{centre}</lane></center>',
        *(["        <right>", *right, "        </right>"] if right else []),
        "      </laneSection>",
    ])  # fmt: skip


def _lane(lane: _Lane, side: int) -> str:
    ends = "".join(
        f'<{name} id="{number * side}"/>'
        for name, number in (("predecessor", lane.before), ("successor", lane.after))
        if number is not None
    )
    link = f"<link>{ends}</link>" if ends else ""
    head = f'<lane id="{lane.number * side}" type="{lane.kind}" level="false">'
    return f"          {head}{link}{lane.width}{_mark(lane.mark, 0.0)}</lane>"


def _mark(kind: str, offset: float) -> str:
    allowed = "both" if kind == "broken" else "none"
    return f'<roadMark sOffset="{_n(offset)}" type="{kind}" weight="standard" color="white" width="0.12" laneChange="{allowed}"/>'


def _signal(road: Road, number: int, sign: Sign, s: float) -> str:
    country, code, name = _SIGNS[sign.kind]
    painted = sign.kind == "stop_line"
    t = (0.5 if painted else 1.0) * LANE_WIDTH_M * road.lanes + (0.0 if painted else 3.0)
    width = f' width="{_n(LANE_WIDTH_M * road.lanes)}"' if painted else ' width="0.6"'
    return (
        f'      <signal id="{number}" name="{name}" s="{_n(s)}" t="{_n(t * road.nearside_sign)}" zOffset="{0.0 if painted else 2.0}"'
        f' dynamic="no" orientation="+" country="{country}" type="{code}" subtype="-1" height="0.6"{width}/>'
    )


def _forked(road: Road, fork: Fork) -> list[str]:
    """Return the roads before, after and off the fork, those that connect them, and the junction."""
    line = road.line
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
            _section(road, 0.0, _lanes(road, ahead=True), 0.0, begin),
            _section(road, begin, _lanes(road, exit_lane=True), 0.0, fork.at),
        ]
    parts = [
        _element(road, _BEFORE, before, first, link=f"<successor {at_junction}/>"),
        _element(road, _AFTER, after, [_section(road, 0.0, plain, end)], link=f"<predecessor {at_junction}/>", start=end),
        _element(
            road, _THROUGH, through, [_section(road, 0.0, inside, fork.at, end)],
            link=_ends(_BEFORE, "end", _AFTER, "start"), start=fork.at,
        ),
    ]  # fmt: skip
    return [*parts, *(_exit(road, off, branch) if fork.is_exit else _side_road(road, off, branch, inside))]


def _ends(before: str, at_before: str, after: str, at_after: str) -> str:
    return (
        f'<predecessor elementType="road" elementId="{before}" contactPoint="{at_before}"/>'
        f'<successor elementType="road" elementId="{after}" contactPoint="{at_after}"/>'
    )


def _exit(road: Road, off: Line, branch: Line) -> list[str]:
    """Return the ramp of an exit lane, one way, and the junction: its lane lies beside the through lanes' line."""
    shift = f'<laneOffset s="0" a="{_n(LANE_WIDTH_M * road.lanes * road.nearside_sign)}" b="0" c="0" d="0"/>'
    number = road.lanes + 1
    link = f'<predecessor elementType="junction" elementId="{_JUNCTION}"/>'
    bare = _bare(road)
    return [
        _element(
            bare, _OFF, off, [_section(bare, 0.0, [_Lane(1, before=number, after=1)])],
            link=_ends(_BEFORE, "end", _BRANCH, "start"), start=1.0, more=shift,
        ),
        _element(bare, _BRANCH, branch, [_section(bare, 0.0, [_Lane(1)])], link=link, start=1.0, more=shift),
        _junction([*_through(road), (_BEFORE, _OFF, "start", [(number * road.nearside_sign, road.nearside_sign)])]),
    ]  # fmt: skip


def _bare(road: Road) -> Road:
    """Return what a ramp has of its road: no centre line."""
    return replace(road, centre=((0.0, "solid"),), signs=())


def _side_road(road: Road, off: Line, branch: Line, inside: Sequence[_Lane]) -> list[str]:
    """Return the side road, the two ways round its corners, and the junction."""
    side = road.nearside_sign
    mouth = branch.start
    on = Line(off.pieces, Pose(mouth.x, mouth.y, mouth.heading + math.pi))
    turned = [_Lane(lane.number, mark="none", before=-lane.number, after=lane.number) for lane in inside]
    link = f'<predecessor elementType="junction" elementId="{_JUNCTION}"/>'
    round_off = [_section(road, 0.0, inside)]
    round_on = [_section(road, 0.0, turned)]
    return [
        _element(road, _OFF, off, round_off, link=_ends(_BEFORE, "end", _BRANCH, "start"), start=1.0),
        _element(road, _ON, on, round_on, link=_ends(_BRANCH, "start", _AFTER, "start"), start=1.0),
        _element(road, _BRANCH, branch, [_section(road, 0.0, _lanes(road))], link=link, start=1.0),
        _junction([
            *_through(road),
            (_BEFORE, _OFF, "start", [(side, side)]),
            (_BRANCH, _OFF, "end", [(-side, -side)]),
            (_BRANCH, _ON, "start", [(-side, side)]),
            (_AFTER, _ON, "end", [(-side, -side)]),
        ]),
    ]  # fmt: skip


_Connection = tuple[str, str, str, list[tuple[int, int]]]


def _through(road: Road) -> list[_Connection]:
    links = [(k * road.nearside_sign, k * road.nearside_sign) for k in _numbers(road)]
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
