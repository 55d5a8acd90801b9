"""The four roads of the comparison: a motorway, a rural road with overtaking, a town, and a main road of two lanes each way.

On each, some of SUMO's drivers press: they follow closely, exceed the limit and change lanes into small gaps, so that rules are broken.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from tests.false_alarms import worlds
from tests.sumo.world import ORDINARY, Files, run, simulate

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

_PRESSING: Final = (
    'length="4.4" width="1.8" tau="0.35" minGap="0.8" sigma="0.9" speedFactor="normc(1.25,0.1,1.1,1.5)" lcAssertive="4"'
)
_KINDS: Final = {name: (said, 0.75 * share) for name, (said, share) in worlds.KINDS.items()} | {
    "pressing": (_PRESSING, 0.25)
}
_RURAL: Final = {**ORDINARY, "pressing": (f'{_PRESSING} maxSpeed="36" lcOpposite="20"', 1 / 120)}
_LIMIT_MPS: Final = 17.88  # 40 mph
_JUNCTIONS: Final = ((0.0, 0.0), (900.0, 0.0), (1500.0, 140.0), (2300.0, 0.0), (3200.0, -120.0))
_SIDES: Final = {1: (900.0, -350.0), 2: (1500.0, 500.0), 3: (2300.0, -350.0)}


def motorway(folder: Path, *, seconds: int, seed: int) -> Files:
    """Drive so many seconds on the motorway of `tests.false_alarms`."""
    return worlds.motorway(folder, seconds=seconds, seed=seed, kinds=_KINDS)


def rural(folder: Path, *, seconds: int, seed: int) -> Files:
    """Drive so many seconds on the two-way road of `tests.sumo`."""
    return simulate(folder, seconds=seconds, seed=seed, kinds=_RURAL)


def town(folder: Path, *, seconds: int, seed: int) -> Files:
    """Drive so many seconds in the town of `tests.false_alarms`."""
    return worlds.town(folder, seconds=seconds, seed=seed, kinds=_KINDS)


def main_road(folder: Path, *, seconds: int, seed: int) -> Files:
    """Drive so many seconds on 3.2 km with bends, two lanes each way and three side roads, one of them signalled; 800 vehicles an hour."""
    folder.mkdir(parents=True, exist_ok=True)
    places = {f"m{k}": at for k, at in enumerate(_JUNCTIONS)} | {f"s{k}": at for k, at in _SIDES.items()}
    signalled = {name: ' type="traffic_light"' if name == "m2" else "" for name in places}
    nodes = "".join(f'<node id="{name}" x="{x}" y="{y}"{signalled[name]}/>' for name, (x, y) in places.items())
    main = [(f"m{k}", f"m{k + 1}") for k in range(len(_JUNCTIONS) - 1)]
    side = [(f"s{k}", f"m{k}") for k in _SIDES]
    edges = "".join(_edge(a, b, places, 2) + _edge(b, a, places, 2) for a, b in main)
    edges += "".join(_edge(a, b, places, 1) + _edge(b, a, places, 1) for a, b in side)
    (folder / "m.nod.xml").write_text(f"<nodes>{nodes}</nodes>\n", "utf-8")
    (folder / "m.edg.xml").write_text(f"<edges>{edges}</edges>\n", "utf-8")
    run(
        "netconvert", "--node-files", "m.nod.xml", "--edge-files", "m.edg.xml", "--output-file", "road.net.xml",
        "--opendrive-output", "road.xodr", "--no-turnarounds", "--offset.disable-normalization", cwd=folder,
    )  # fmt: skip
    ends = [("m0", "m1"), (f"m{len(_JUNCTIONS) - 1}", f"m{len(_JUNCTIONS) - 2}"), *side]
    rng = np.random.default_rng(seed)
    ways = []
    for _ in range(worlds.count(seconds, 800)):
        start, end = (ends[k] for k in rng.choice(len(ends), size=2, replace=False, p=(0.3, 0.3, 0.14, 0.13, 0.13)))
        ways.append(("".join(start), "".join(reversed(end))))
    return worlds.drive_ways(folder, ways, seconds, rng, seed, _KINDS)


def _edge(a: str, b: str, places: dict[str, tuple[float, float]], lanes: int) -> str:
    """Return an edge; the main road leaves the straight line between two junctions by up to 30 m."""
    (ax, ay), (bx, by) = places[a], places[b]
    share = np.linspace(0.0, 1.0, 60)
    aside = (30.0 if lanes == 2 else 0.0) * (1.0 - np.cos(2 * np.pi * share)) / 2
    if a > b:  # the same line from the other end
        aside = -aside
    length = np.hypot(bx - ax, by - ay)
    x, y = ax + share * (bx - ax) - aside * (by - ay) / length, ay + share * (by - ay) + aside * (bx - ax) / length
    shape = " ".join(f"{px:.3f},{py:.3f}" for px, py in zip(x, y, strict=True))
    speed = _LIMIT_MPS if lanes == 2 else 13.41
    return (
        f'<edge id="{a}{b}" from="{a}" to="{b}" numLanes="{lanes}" speed="{speed}" shape="{shape}" priority="{lanes}"/>'
    )


ROADS: Final[dict[str, tuple[Callable[..., Files], str]]] = {
    "motorway": (motorway, "rht"),
    "rural": (rural, "lht"),
    "town": (town, "rht"),
    "main": (main_road, "rht"),
}
"""Who drives them, and the hand."""
