"""A motorway with an exit, and a vehicle that leaves by it."""

from __future__ import annotations

from functools import cache

import numpy as np

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests.formats.opendrive import xodr
from tests.scenes import LANE, Actor, Road, linked, moving, plan, times


@cache
def exit_road(hand: str = "rht", signs: tuple[float, ...] = (100.0, 220.0)) -> Road:
    """Return a one-way road of two lanes; the outer one leaves it gently at s = 400; signs stand at these stations.

    The line is that between the two lanes, on into the exit: d = `own` is the through lane, d = `other` the exit lane.
    """
    side = -1 if hand == "rht" else 1
    one, two = (linked(side), linked(2 * side))
    pose = (MAIN, side * LANE, 0.0)
    bend = (FORK, side * 0.01)
    after = (float(v) for v in Road(None, (bend,), pose).at(FORK))  # type: ignore[arg-type]
    signals = "".join(
        f'<signal id="exit{n}" s="{s}" t="0" orientation="+" type="332" country="DE" dynamic="no"/>'
        for n, s in enumerate(signs)
    )
    rule = f'rule="{hand.upper()}"'

    def end(kind: str, number: str, contact: str) -> str:
        return f'<{kind} elementType="road" elementId="{number}" contactPoint="{contact}"/>'

    joins = end("predecessor", "1", "end")
    leaves = xodr.lane(
        side, f'<link><predecessor id="{2 * side}"/><successor id="{side}"/></link><width sOffset="0" a="{LANE}"/>'
    )
    lane_link = '<laneLink from="{}" to="{}"/></connection>'
    connections = [
        f'<connection id="{n}" incomingRoad="1" connectingRoad="{road}" contactPoint="start">'
        + lane_link.format(start * side, side)
        for n, (road, start) in enumerate((("10", 1), ("11", 2)))
    ]
    text = xodr.xodr(
        xodr.road(
            "1", plan(((MAIN, 0.0),)), xodr.section(0, one, two), MAIN,
            '<successor elementType="junction" elementId="5"/>', rule, f"<signals>{signals}</signals>",
        ),
        xodr.road("2", plan(((200.0, 0.0),), (MAIN + FORK, 0.0, 0.0)), xodr.section(0, one), 200.0, "", rule),
        xodr.road("3", plan(((200.0, 0.0),), tuple(after)), xodr.section(0, one), 200.0, "", rule),  # type: ignore[arg-type]
        xodr.road(
            "10", plan(((FORK, 0.0),), (MAIN, 0.0, 0.0)), xodr.section(0, one), FORK, joins + end("successor", "2", "start"),
            rule, junction="5",
        ),
        xodr.road(
            "11", plan((bend,), pose), xodr.section(0, leaves), FORK, joins + end("successor", "3", "start"), rule,
            junction="5",
        ),
        f'<junction id="5" name="exit">{"".join(connections)}</junction>',
    )  # fmt: skip
    environment = load_map(MapSource("exit.xodr", text.encode()))
    return Road(environment, ((MAIN, 0.0), bend, (200.0, 0.0)), (0.0, side * LANE, 0.0))


MAIN, FORK = 400.0, 30.0


def leaver(way: Road, *, change_at: float = 250.0) -> Actor:
    """Drive at 20 m/s, over into the exit lane within 60 m and out by it."""
    t = times(30.0)
    s = 20 + 20 * t
    through = LANE / 2 * (1 if way.environment.handedness == "rht" else -1)
    return moving("ego", way, t, s, through - 2 * through * np.clip((s - change_at) / 60, 0, 1))
