"""A road whose lanes are cut into several lanelets."""

from __future__ import annotations

import math

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests.formats.opendrive import xodr
from tests.scenes import (
    Road,
    limited,
    linked,
    plan,
)


def jointed(hand: str) -> Road:
    """Return a two-way road of 420 m, each direction in two roads that join in 20 m of a junction, where nothing else meets."""
    side = 1 if hand == "lht" else -1

    def numbered_road(number: str, x: float, length: float, link: str, junction: str = "-1") -> str:
        pose = (x, 0.0, 0.0) if number in "123" else (420.0 - x, 0.0, math.pi)
        lanes, rule = xodr.section(0, linked(side)), f'rule="{hand.upper()}"'
        return xodr.road(number, plan(((length, 0.0),), pose), lanes, length, link, rule, limited(60), junction)

    def to(direction: str, kind: str, number: str, contact: str = "") -> str:
        return f'<{direction} elementType="{kind}" elementId="{number}" {contact}/>'

    parts = []
    for a, through, b in ("132", "465"):
        both = to("predecessor", "road", a, 'contactPoint="end"') + to("successor", "road", b, 'contactPoint="start"')
        parts += [
            numbered_road(a, 0.0, 200.0, to("successor", "junction", "9")),
            numbered_road(through, 200.0, 20.0, both, "9"),
            numbered_road(b, 220.0, 200.0, to("predecessor", "junction", "9")),
        ]
    lanes = f'contactPoint="start"><laneLink from="{side}" to="{side}"/>'
    links = "".join(
        f'<connection id="{a}" incomingRoad="{a}" connectingRoad="{through}" {lanes}</connection>'
        for a, through in ("13", "46")
    )
    text = xodr.xodr(*parts, f'<junction id="9">{links}</junction>')
    return Road(load_map(MapSource(f"jointed-{hand}.xodr", text.encode())), ((420.0, 0.0),))
