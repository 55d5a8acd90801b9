"""A crossroads for tiny scenes: four roads, every way through, signals and crossings where a test wants them."""

from __future__ import annotations

import math
from functools import cache
from typing import TYPE_CHECKING

import pyarrow as pa

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests.formats.opendrive import xodr
from tests.scenes import LANE, Road, limited, linked, plan

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive

R = 15.0  # the junction is a square of +-15 m around the origin
ARM = 185.0
TURN = R * math.pi / 2
_ARC = 1 / R
_BOTH_LANES = xodr.section(0, linked(1), linked(-1))
_FLIPPED = xodr.section(0, linked(1, before=-1), linked(-1, before=1))


def signal(name: str, s: float, code: str, *, t: float = 5.0, orientation: str = "+", more: str = "") -> str:
    """Return a signal; codes are German ones or those of OpenDRIVE (205 give way, 206 stop, 294 line, 1000001 light)."""
    head = f'<signal id="{name}" s="{s}" t="{t}" orientation="{orientation}" type="{code}" country="DE"'
    return f'{head} dynamic="{"yes" if code == "1000001" else "no"}" {more}/>'


def stop_line(name: str, s: float, t: float) -> str:
    """Return a painted stop line one lane wide."""
    return signal(name, s, "294", t=t, more=f'width="{LANE}"')


def crosswalk(name: str, s: float, width: float = 3.0, label: str = "") -> str:
    """Return a crossing over both lanes, from s to s + width."""
    corners = [(s, LANE), (s, -LANE), (s + width, -LANE), (s + width, LANE)]
    outline = "".join(f'<cornerRoad s="{a}" t="{b}" dz="0" height="0" id="{i}"/>' for i, (a, b) in enumerate(corners))
    return f'<object type="crosswalk" id="{name}" name="{label}" s="{s}" t="0"><outline id="0">{outline}</outline></object>'


@cache
def cross(
    hand: str = "rht", signals: tuple[tuple[str, str], ...] = (), objects: tuple[tuple[str, str], ...] = ()
) -> dict[str, Road]:
    """Return ways through a crossroads, each 400 m long with the junction from 185 m on (turns: 23.6 m, straight: 30 m).

    Road 1 comes from the west, roads 2, 3 and 4 begin at the junction and lead east, south and north. `signals` and
    `objects`: (road, element) pairs. Ways are named by where they come from and lead to: `we`, `ws`, `wn`, `ew`, ...
    """
    rule = f'rule="{hand.upper()}"'

    def extra(number: str) -> str:
        own = "".join(e for road, e in signals if road == number)
        put = "".join(e for road, e in objects if road == number)
        return f"{limited(30)}<signals>{own}</signals><objects>{put}</objects>"

    def part(
        number: str, piece: tuple[float, float], pose: tuple[float, float, float], link: str, lanes: str = _BOTH_LANES
    ) -> str:
        junction = "9" if len(number) > 1 else "-1"
        return xodr.road(number, plan((piece,), pose), lanes, piece[0], link, rule, extra(number), junction)

    def road_links(before: tuple[str, str], after: str) -> str:
        return (
            f'<predecessor elementType="road" elementId="{before[0]}" contactPoint="{before[1]}"/>'
            f'<successor elementType="road" elementId="{after}" contactPoint="start"/>'
        )

    end, start = (
        '<successor elementType="junction" elementId="9"/>',
        '<predecessor elementType="junction" elementId="9"/>',
    )
    west, south, north = (-R, 0.0, 0.0), (0.0, -R, math.pi / 2), (0.0, R, -math.pi / 2)
    inside = [
        ("10", (2 * R, 0.0), west, ("1", "end"), "2"),
        ("11", (TURN, -_ARC), west, ("1", "end"), "3"),
        ("12", (TURN, _ARC), west, ("1", "end"), "4"),
        ("13", (TURN, -_ARC), south, ("3", "start"), "2"),
        ("14", (2 * R, 0.0), south, ("3", "start"), "4"),
        ("15", (TURN, _ARC), north, ("4", "start"), "2"),
    ]
    same = '<laneLink from="-1" to="-1"/><laneLink from="1" to="1"/>'
    turned = '<laneLink from="1" to="-1"/><laneLink from="-1" to="1"/>'
    connections = "".join(
        f'<connection id="{i}" incomingRoad="{before[0]}" connectingRoad="{number}" contactPoint="start">'
        f"{same if before[1] == 'end' else turned}</connection>"
        for i, (number, _, _, before, _) in enumerate(inside)
    )
    text = xodr.xodr(
        part("1", (ARM, 0.0), (-R - ARM, 0.0, 0.0), end),
        part("2", (ARM, 0.0), (R, 0.0, 0.0), start),
        part("3", (ARM, 0.0), (0.0, -R, -math.pi / 2), start),
        part("4", (ARM, 0.0), (0.0, R, math.pi / 2), start),
        *(
            part(number, piece, pose, road_links(before, after), _BOTH_LANES if before[1] == "end" else _FLIPPED)
            for number, piece, pose, before, after in inside
        ),
        f'<junction id="9" name="crossroads">{connections}</junction>',
    )
    environment = load_map(MapSource("cross.xodr", text.encode()))
    far = R + ARM
    heading = {"w": 0.0, "s": math.pi / 2, "e": math.pi, "n": -math.pi / 2}
    begin = {"w": (-far, 0.0), "s": (0.0, -far), "e": (far, 0.0), "n": (0.0, far)}
    ways = {}
    for a in "wsen":
        for b in "wsen".replace(a, ""):
            # counter-clockwise w, s, e, n: the next one is to the right of who comes from a
            hops = ("wsen".index(b) - "wsen".index(a)) % 4
            piece = {1: (TURN, -_ARC), 2: (2 * R, 0.0), 3: (TURN, _ARC)}[hops]
            ways[a + b] = Road(environment, ((ARM, 0.0), piece, (ARM, 0.0)), (*begin[a], heading[a]))
    return ways


def lit(scene: Drive, signal_id: str, *states: tuple[float, str | None]) -> Drive:
    """Return the drive with a light that shows each state from its time in seconds on."""
    table = scene.trace.tables["signal_state"]
    new = [
        {"drive_id": scene.trace.drive_id, "signal_id": signal_id, "t_ns": round(t * 1e9), "state": state}
        for t, state in states
    ]
    scene.trace.tables["signal_state"] = pa.concat_tables([table, pa.Table.from_pylist(new, schema=table.schema)])
    return scene
