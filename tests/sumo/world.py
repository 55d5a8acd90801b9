"""A two-way two-lane road, as OpenDRIVE, as a SUMO net of the same line and as SUMO writes that as OpenDRIVE, and the traffic on it.

Left-hand traffic unless it is asked otherwise; straights and bends. Slow and fast vehicles in both directions make SUMO overtake on the
opposite lane.
SUMO (PyPI: eclipse-sumo) is no dependency: it is looked for in `$SUMO_HOME/bin`, on PATH and beside this interpreter.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tests.demo.line import left, right, straight
from tests.demo.opendrive import opendrive
from tests.demo.road import LANE_WIDTH_M, MPH, Handedness, Road

if TYPE_CHECKING:
    from collections.abc import Mapping

LIMIT_MPH = 60.0
CHORD_M = 2.0  # of the net's polyline in a bend: 1 mm off the arc at most
ROAD = Road(
    pieces=(
        straight(1100.0),
        right(450.0, radius=600.0),
        straight(700.0),
        left(500.0, radius=500.0),
        straight(1250.0),
    ),
    hand="left",
    kind="rural",
    limits_mph=((0.0, LIMIT_MPH),),
    beside="shoulder",
)
NET, ROUTES, LOG, MAP = "road.net.xml", "road.rou.xml", "traffic.fcd.xml", "road.xodr"
ONE_WAY_MAP = "sumo.xodr"
"""What SUMO writes of its net: a road for each direction, and not a word on the side that is driven on."""
_KINDS = {
    # id: (what SUMO is told, share of the traffic in vehicles per second and direction)
    "lorry": ('vClass="truck" length="9.5" width="2.4" maxSpeed="13"', 1 / 150),
    "tractor": ('vClass="truck" length="6.2" width="2.1" maxSpeed="9"', 1 / 400),
    "slow": ('length="4.2" width="1.7" maxSpeed="17"', 1 / 200),
    "quick": ('length="4.6" width="1.8" maxSpeed="32" speedFactor="normc(1.0,0.08,0.8,1.2)" lcOpposite="2"', 1 / 55),
    "sporty": ('length="4.1" width="1.9" maxSpeed="36" speedFactor="1.15" lcOpposite="20" lcAssertive="3"', 1 / 240),
}


ORDINARY = {
    "lorry": ('vClass="truck" length="9.5" width="2.4" maxSpeed="20"', 1 / 200),
    "tractor": ('vClass="truck" length="6.2" width="2.1" maxSpeed="9"', 1 / 400),
    "car": ('length="4.6" width="1.8"', 1 / 25),
}
"""SUMO's default drivers, whose every parameter but size and top speed is SUMO's own."""


class Files(NamedTuple):
    """Where one simulation lies."""

    log: Path
    net: Path
    routes: Path
    map: Path


def tool(name: str) -> str | None:
    """Return the path of one of SUMO's programs, None: it is not installed here."""
    home = os.environ.get("SUMO_HOME")
    places = [str(Path(home) / "bin")] if home else []
    return shutil.which(
        name, path=os.pathsep.join([*places, os.environ.get("PATH", ""), str(Path(sys.executable).parent)])
    )


def simulate(
    folder: Path,
    *,
    seconds: int,
    seed: int = 1,
    kinds: Mapping[str, tuple[str, float]] = MappingProxyType(_KINDS),
    hand: Handedness = "left",
) -> Files:
    """Drive so many seconds of traffic, 10 Hz, into `folder`. The same seed gives the same log."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / MAP).write_text(opendrive(replace(ROAD, hand=hand), "road"), "utf-8")
    (folder / ROUTES).write_text(_routes(seconds, kinds), "utf-8")
    (folder / "road.nod.xml").write_text(_nodes(), "utf-8")
    (folder / "road.edg.xml").write_text(_edges(), "utf-8")
    run(
        "netconvert", "--node-files", "road.nod.xml", "--edge-files", "road.edg.xml", "--output-file", NET,
        *(("--lefthand",) if hand == "left" else ()), "--opendrive-output", ONE_WAY_MAP, "--opposites.guess",
        "--no-turnarounds", "--offset.disable-normalization", "--precision", "4", cwd=folder,
    )  # fmt: skip
    run(
        "sumo", "--net-file", NET, "--route-files", ROUTES, "--step-length", "0.1", "--end", str(seconds), "--seed", str(seed),
        "--collision.mingap-factor", "0", "--collision.action", "warn", "--lanechange.duration", "3", "--precision", "3", "--no-step-log",
        "--fcd-output", LOG, "--fcd-output.signals", "--fcd-output.acceleration", "--time-to-teleport", "-1", cwd=folder,
    )  # fmt: skip
    return Files(*(folder / name for name in (LOG, NET, ROUTES, MAP)))


def _stations() -> list[float]:
    """Return the stations of the net's vertices: the ends of the pieces, and every few metres of a bend."""
    found = [0.0]
    for start, _, piece in ROAD.line.placed_pieces():
        parts = int(np.ceil(piece.length_m / CHORD_M)) if piece.curvature else 1
        found += [start + piece.length_m * k / parts for k in range(1, parts + 1)]
    return found


def _nodes() -> str:
    ends = [ROAD.line.pose(s) for s in (0.0, ROAD.line.length_m)]
    nodes = "".join(f'<node id="{name}" x="{p.x:.4f}" y="{p.y:.4f}"/>' for name, p in zip("ab", ends, strict=True))
    return f"<nodes>{nodes}</nodes>\n"


def _edges() -> str:
    x, y, _ = ROAD.line.at(_stations())
    points = [f"{px:.4f},{py:.4f}" for px, py in zip(x, y, strict=True)]

    def edge(start: str, end: str, shape: list[str]) -> str:
        lanes = f'numLanes="1" width="{LANE_WIDTH_M}" speed="{LIMIT_MPH * MPH:.4f}"'
        return f'<edge id="{start}{end}" from="{start}" to="{end}" {lanes} shape="{" ".join(shape)}"/>'

    return f"<edges>{edge('a', 'b', points)}{edge('b', 'a', points[::-1])}</edges>\n"


def _routes(seconds: int, kinds: Mapping[str, tuple[str, float]]) -> str:
    types = [f'<vType id="{name}" {said}/>' for name, (said, _) in kinds.items()]
    flows = [
        f'<flow id="{name}-{way}" type="{name}" from="{way}" to="{way}" begin="0" end="{seconds}" period="exp({rate:.6f})"'
        ' departSpeed="max"/>'
        for way in ("ab", "ba")
        for name, (_, rate) in kinds.items()
    ]
    return "\n".join(["<routes>", *types, *flows, "</routes>", ""])


def run(name: str, *arguments: str, cwd: Path) -> None:
    """Run one of SUMO's programs in `cwd`. Errors: `FileNotFoundError` without SUMO, `RuntimeError` with what it said."""
    program = tool(name)
    if program is None:
        raise FileNotFoundError(f"{name} is not installed (pip install eclipse-sumo, or set SUMO_HOME)")
    done = subprocess.run([program, *arguments], cwd=cwd, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{name} failed:\n{done.stderr}")
