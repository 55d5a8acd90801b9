"""Writes a road of the scenes as OpenDRIVE 1.7."""

from __future__ import annotations

from functools import singledispatch
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from tests.demo.road import LANE_WIDTH_M, SIDE_LANE_WIDTH_M, Road

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from tests.demo.line import Line
    from tests.demo.road import Sign

T = TypeVar("T")
GENERATOR = "drivelint demo"
"""Stands in every file that is written here: what carries it may be overwritten."""

_SIGNS = {  # country, code, name
    "exit": ("GB", "-1", "exit sign"),
    "give_way": ("GB", "602", "give way"),
    "no_overtaking": ("GB", "632", "no overtaking"),
    "stop": ("GB", "601.1", "stop"),
    "stop_line": ("DE", "294", "stop line"),
}


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
    return "\n".join([
        '<?xml version="1.0" encoding="UTF-8"?>',
        "<OpenDRIVE>",
        f'  <header revMajor="1" revMinor="7" name="{name}" version="1.00" vendor="{GENERATOR}"/>',
        *road_elements(road),
        "</OpenDRIVE>",
        "",
    ])  # fmt: skip


@singledispatch
def road_elements(road: Road) -> list[str]:
    """Return the OpenDRIVE elements of a road: one `<road>`; other kinds of road have others."""
    return [_element(road, road.line, [_section(road, 0.0, _lanes(road))])]


def _n(value: float) -> str:
    """Return a number with at most six decimals and no sign on zero."""
    return repr(round(value, 6) + 0.0)


def _from(station_values: Iterable[tuple[float, T]], start: float, end: float) -> list[tuple[float, T]]:
    """Return what holds between two stations, counted from the first of them."""
    held = {max(s - start, 0.0): value for s, value in station_values if s < end}
    return list(held.items())


def _element(
    road: Road,
    line: Line,
    sections: Sequence[str],
    number: str = "1",
    *,
    link: str = "",
    start: float = 0.0,
    offset: str = "",
    junction: str = "-1",
) -> str:
    """Return one `<road>`, which begins at the station `start` of the scene's road; in a `junction` it has no signs."""
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
    signs = [sign for sign in road.signs if junction == "-1" and start <= sign.at < end]
    signals = [_signal(road, 100 * int(number) + i, sign, sign.at - start) for i, sign in enumerate(signs, 1)]
    rule = "LHT" if road.hand == "left" else "RHT"
    return "\n".join([
        f'  <road name="{number}" length="{_n(line.length_m)}" id="{number}" junction="{junction}" rule="{rule}">',
        *([f"    <link>{link}</link>"] if link else []),
        *limits,
        "    <planView>", *geometry, "    </planView>",
        *_elevation(road),
        f"    <lanes>{offset}", *sections, "    </lanes>",
        *(["    <signals>", *signals, "    </signals>"] if signals else []),
        "  </road>",
    ])  # fmt: skip


def _elevation(road: Road) -> list[str]:
    """Return the heights of a road, straight from each station to the next."""
    if not road.heights:
        return []
    ends = [*road.heights[1:], (road.line.length_m + road.heights[-1][0], road.heights[-1][1])]
    return [
        "    <elevationProfile>",
        *(
            f'      <elevation s="{_n(s)}" a="{_n(z)}" b="{(z1 - z) / (s1 - s)!r}" c="0" d="0"/>'
            for (s, z), (s1, z1) in zip(road.heights, ends, strict=True)
        ),
        "    </elevationProfile>",
    ]


def _numbers(road: Road) -> list[int]:
    return [*range(1, road.lanes + 1), *(-k for k in range(1, road.oncoming + 1))]


def _lanes(road: Road) -> list[_Lane]:
    n, m = road.lanes, road.oncoming
    edge = "curb" if road.beside == "sidewalk" else "solid"
    driving = [_Lane(k, mark=edge if k in {n, -m} else "broken") for k in _numbers(road)]
    width = f'<width sOffset="0" a="{SIDE_LANE_WIDTH_M}" b="0" c="0" d="0"/>'
    return [*driving, *(_Lane(k, road.beside, width, "none") for k in (n + 1, -m - 1))]


def _section(road: Road, s: float, lanes: Sequence[_Lane], start: float = 0.0, end: float = 1e9) -> str:
    """Return a lane section at `s` of its road, which begins at the station `start` of the scene's road."""
    side = road.nearside_factor
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
        f'      <signal id="{number}" name="{name}" s="{_n(s)}" t="{_n(t * road.nearside_factor)}" zOffset="{0.0 if painted else 2.0}"'
        f' dynamic="no" orientation="+" country="{country}" type="{code}" subtype="-1" height="0.6"{width}/>'
    )
