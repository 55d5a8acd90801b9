"""Roads on which SUMO's default drivers drive: a motorway and a town, each as a SUMO net and as the OpenDRIVE that SUMO writes of it.

Right-hand traffic; the rural road of `tests.sumo.world` is left-hand. The drivers are SUMO's own (Krauss, LC2013, no parameter
changed but sizes and top speeds of lorries and slow cars), so they keep a gap of a second and do not crash.
"""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from tests.sumo.world import ORDINARY, Files, run, simulate

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    Kinds = Mapping[str, tuple[str, float]]

STEP_S = 0.1
KINDS = {
    "car": ('length="4.6" width="1.8"', 0.75),
    "slow": ('length="4.2" width="1.7" speedFactor="normc(0.8,0.05,0.6,0.9)"', 0.13),
    "lorry": ('vClass="truck" length="9.5" width="2.4" maxSpeed="24.6"', 0.12),
}
"""SUMO's default drivers: what SUMO is told of each kind, and its share of the traffic."""
_LIMIT_MPS = 31.29  # 70 mph
_NODES = {
    "a": (0, 0), "b": (2500, 0), "c": (2800, 0), "d": (4300, 0), "e": (4600, 0), "f": (6500, 0), "r": (2000, -120), "q": (5100, -120),
}  # fmt: skip
_EDGES = {"ab": 3, "bc": 4, "cd": 3, "de": 4, "ef": 3, "rb": 1, "eq": 1}
_WAYS = {("ab", "ef"): 0.7, ("rb", "ef"): 0.15, ("ab", "eq"): 0.15}


def motorway(folder: Path, *, seconds: int, seed: int = 1, kinds: Kinds = MappingProxyType(KINDS)) -> Files:
    """Drive so many seconds on 6.5 km of three lanes with a way in and a way out, 500 vehicles an hour, 10 Hz."""
    folder.mkdir(parents=True, exist_ok=True)
    nodes = "".join(f'<node id="{name}" x="{x}" y="{y}"/>' for name, (x, y) in _NODES.items())
    edges = "".join(
        f'<edge id="{name}" from="{name[0]}" to="{name[1]}" numLanes="{n}" speed="{_LIMIT_MPS if n > 1 else 25}"/>'
        for name, n in _EDGES.items()
    )
    (folder / "m.nod.xml").write_text(f"<nodes>{nodes}</nodes>\n", "utf-8")
    (folder / "m.edg.xml").write_text(f"<edges>{edges}</edges>\n", "utf-8")
    run(
        "netconvert", "--node-files", "m.nod.xml", "--edge-files", "m.edg.xml", "--output-file", "road.net.xml",
        "--opendrive-output", "road.xodr", "--no-turnarounds", "--offset.disable-normalization", "--default.lanewidth", "3.6",
        cwd=folder,
    )  # fmt: skip
    # SUMO calls every road a town's, and does not say which side is driven on, which one carriageway does not show
    xodr = (folder / "road.xodr").read_text("utf-8").replace('type="town"', 'type="motorway"')
    xodr = xodr.replace("<road ", '<road rule="RHT" ')
    (folder / "road.xodr").write_text(xodr, "utf-8")
    rng = np.random.default_rng(seed)
    pick = rng.choice(len(_WAYS), size=count(seconds, 500), p=list(_WAYS.values()))
    return drive_ways(folder, [list(_WAYS)[k] for k in pick], seconds, rng, seed, kinds)


def town(folder: Path, *, seconds: int, seed: int = 1, kinds: Kinds = MappingProxyType(KINDS)) -> Files:
    """Drive so many seconds in a grid of sixteen junctions, two of them signalled, the rest with priority roads; 900 vehicles an hour."""
    folder.mkdir(parents=True, exist_ok=True)
    run(
        "netgenerate", "--grid", "--grid.number", "4", "--grid.length", "180", "--grid.attach-length", "150",
        "--default-junction-type", "priority", "--tls.set", "B1,C2", "--default.speed", "13.41", "--default.lanenumber", "1",
        "--no-turnarounds", "--output-file", "road.net.xml", "--opendrive-output", "road.xodr",
        "--offset.disable-normalization", cwd=folder,
    )  # fmt: skip
    inner = "ABCD"
    ends = [(f"{side}{k}", f"{at}{k}") for k in range(4) for side, at in (("left", "A"), ("right", "D"))]
    ends += [(f"{side}{k}", f"{inner[k]}{at}") for k in range(4) for side, at in (("bottom", 0), ("top", 3))]
    rng = np.random.default_rng(seed)
    ways = []
    for _ in range(count(seconds, 900)):
        (a, at), (b, to) = (ends[k] for k in rng.choice(len(ends), size=2, replace=False))
        ways.append((a + at, to + b))
    return drive_ways(folder, ways, seconds, rng, seed, kinds)


def rural(folder: Path, *, seconds: int, seed: int = 1) -> Files:
    """Drive so many seconds on the two-way road of `tests.sumo`, 320 vehicles an hour in total that overtake on the opposing lane."""
    return simulate(folder, seconds=seconds, seed=seed, kinds=ORDINARY)


def count(seconds: int, per_hour: int) -> int:
    return round(seconds * per_hour / 3600)


def drive_ways(  # noqa: PLR0917
    folder: Path, ways: Sequence[tuple[str, str]], seconds: int, rng: np.random.Generator, seed: int, kinds: Kinds
) -> Files:
    """Drive these ways, each from its first edge to its last, on the net `road.net.xml` of `folder`."""
    departs = np.sort(rng.uniform(0.0, seconds, len(ways)))
    drawn = rng.choice(list(kinds), size=len(ways), p=[share for _, share in kinds.values()])
    types = [f'<vType id="{name}" {said}/>' for name, (said, _) in kinds.items()]
    trips = [
        f'<trip id="{n}" type="{kind}" depart="{depart:.1f}" from="{a}" to="{b}" departSpeed="max" departLane="best"/>'
        for n, ((a, b), depart, kind) in enumerate(zip(ways, departs, drawn, strict=True))
    ]
    (folder / "road.rou.xml").write_text("\n".join(["<routes>", *types, *trips, "</routes>", ""]), "utf-8")
    run(
        "sumo", "--net-file", "road.net.xml", "--route-files", "road.rou.xml", "--step-length", str(STEP_S), "--end", str(seconds),
        "--seed", str(seed), "--lanechange.duration", "3", "--precision", "3", "--no-step-log", "--fcd-output", "traffic.fcd.xml",
        "--fcd-output.signals", "--fcd-output.acceleration", "--time-to-teleport", "-1", cwd=folder,
    )  # fmt: skip
    return Files(*(folder / name for name in ("traffic.fcd.xml", "road.net.xml", "road.rou.xml", "road.xodr")))
