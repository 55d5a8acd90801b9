"""Huge logs and maps that are well-formed: a crowd at two moments, and a road network with as many lanes as a city.

`python -m tests.hostile.huge [NAME…]`: check each of them in a process of its own, and print its size, what was said, and what it took.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet as pq

from tests.bench.traffic import ring
from tests.formats.logs import LONG
from tests.formats.osi import osi_log

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

ACTORS, ROADS, LANES = 100_000, 2000, 50
"""Actors of a log; roads of a map, and lanes of each road."""
_WIDTH, _LENGTH, _APART = 3.0, 100.0, 200.0
"""Of a lane, and the metres between the beginnings of two roads, which stand in rows of 50."""


def crowd(n: int = ACTORS) -> pa.Table:
    """Return the states of so many cars at two moments, 0.1 s apart, on a grid of 6 m: car 0 is the ego."""
    side = round(n**0.5) + 1
    number = np.tile(np.arange(n), 2)
    t = np.repeat([0.0, 0.1], n)
    return pa.table(
        {
            "t": t,
            "id": number.astype(str),
            "x": number % side * 6.0 + 10 * t,
            "y": number // side * 6.0,
            "yaw": 0 * t,
            "vx": 10 + 0 * t,
            "vy": 0 * t,
        }
    )


def csv_log(folder: Path, n: int = ACTORS) -> list[str]:
    """Write the crowd as CSV, and return the arguments of a check of it."""
    pa.csv.write_csv(crowd(n), folder / "crowd.csv")
    (folder / "mapping.toml").write_text(LONG.replace('["a"]', '["0"]'), encoding="utf-8")
    return [str(folder / "crowd.csv"), "--mapping", str(folder / "mapping.toml")]


def parquet_log(folder: Path, n: int = ACTORS) -> list[str]:
    """Write the crowd as a folder of tables, and return the arguments of a check of it."""
    rows = crowd(n)
    columns = {"x": "x_m", "y": "y_m", "yaw": "yaw_rad", "vx": "vx_mps", "vy": "vy_mps"}
    t_ns = pa.array(np.round(rows["t"].to_numpy() * 1e9).astype(np.int64))
    states = {"actor_id": rows["id"], "t_ns": t_ns, **{name: rows[old] for old, name in columns.items()}}
    sizes = {"length_m": [4.5] * n, "width_m": [1.8] * n}
    actors = {"actor_id": rows["id"][:n], "actor_class": ["car"] * n, "is_ego": np.arange(n) == 0, **sizes}
    (folder / "crowd").mkdir()
    pq.write_table(pa.table(states), folder / "crowd" / "actor_state.parquet")
    pq.write_table(pa.table(actors), folder / "crowd" / "actor.parquet")
    return [str(folder / "crowd")]


def osi_mcap(folder: Path, n: int = ACTORS) -> list[str]:
    """Write the crowd as OSI in MCAP, and return the arguments of a check of it."""
    messages = []
    rows = crowd(n).to_pydict()
    for frame in range(2):
        truth = osi_log.frame(frame * 100_000_000)
        for i in range(frame * n, frame * n + n):
            osi_log.moving(truth, int(rows["id"][i]), rows["x"][i], rows["y"][i], v=(10.0, 0.0))
        messages.append(osi_log.Out("osi3.GroundTruth", "ground_truth", frame * 100_000_000, truth.SerializeToString()))
    return [str(osi_log.write(folder / "crowd.mcap", messages))]


def fcd_log(folder: Path, n: int = ACTORS) -> list[str]:
    """Write the crowd as SUMO's floating car data, and return the arguments of a check of it."""
    rows = crowd(n).to_pydict()
    steps = []
    for frame in range(2):
        cars = "".join(
            f'<vehicle id="{rows["id"][i]}" x="{rows["x"][i]}" y="{rows["y"][i]}" angle="90" type="car" speed="10"/>\n'
            for i in range(frame * n, frame * n + n)
        )
        steps.append(f'<timestep time="{frame / 10}">{cars}</timestep>')
    (folder / "crowd.xml").write_text(f"<fcd-export>{''.join(steps)}</fcd-export>", encoding="utf-8")
    return [str(folder / "crowd.xml"), "--ego", "0"]


def _places(roads: int, *, apart: bool) -> Iterator[tuple[float, float]]:
    """Yield where roads begin; not apart: all at one place."""
    for i in range(roads):
        yield (i % 50 * _APART, i // 50 * _APART) if apart else (0.0, 0.0)


def opendrive(roads: int = ROADS, lanes: int = LANES, *, apart: bool = True) -> str:
    """Return straight roads of so many lanes."""

    def lane(number: int) -> str:
        width = f'<width sOffset="0" a="{_WIDTH}" b="0" c="0" d="0"/>' if number else ""
        return f'<lane id="{number}" type="driving" level="false">{width}</lane>'

    found = ['<?xml version="1.0"?><OpenDRIVE><header revMajor="1" revMinor="6" name="huge"/>']
    right = "".join(lane(-number) for number in range(1, lanes + 1))
    for i, (x, y) in enumerate(_places(roads, apart=apart)):
        found.append(
            f'<road name="" length="{_LENGTH}" id="{i}" junction="-1"><planView>'
            f'<geometry s="0" x="{x}" y="{y}" hdg="0" length="{_LENGTH}"><line/></geometry></planView>'
            f'<lanes><laneSection s="0"><center>{lane(0)}</center><right>{right}</right></laneSection></lanes></road>'
        )
    return "\n".join([*found, "</OpenDRIVE>"])


def lanelet2(roads: int = ROADS, lanes: int = LANES, *, apart: bool = True) -> str:
    """Return the same roads as lanelets that share their bounds."""
    nodes: list[str] = []
    ways: list[str] = []
    relations: list[str] = []
    for x, y in _places(roads, apart=apart):
        for line in range(lanes + 1):
            ends = ((x, y - line * _WIDTH), (x + _LENGTH, y - line * _WIDTH))
            for px, py in ends:
                nodes.append(
                    f'<node id="{len(nodes) + 1}" lat="{49 + py / 111_000:.9f}" lon="{8.4 + px / 73_000:.9f}">'
                    f'<tag k="local_x" v="{px}"/><tag k="local_y" v="{py}"/></node>'
                )
            number = 1_000_000 + len(ways)
            ways.append(
                f'<way id="{number}"><nd ref="{len(nodes) - 1}"/><nd ref="{len(nodes)}"/>'
                '<tag k="type" v="line_thin"/><tag k="subtype" v="dashed"/></way>'
            )
            if line:
                relations.append(
                    f'<relation id="{2_000_000 + len(relations)}"><member type="way" ref="{number - 1}" role="left"/>'
                    f'<member type="way" ref="{number}" role="right"/><tag k="type" v="lanelet"/><tag k="subtype" v="road"/>'
                    '<tag k="location" v="urban"/><tag k="one_way" v="yes"/></relation>'
                )
    return "<?xml version='1.0'?>\n<osm version='0.6'>\n" + "\n".join([*nodes, *ways, *relations]) + "\n</osm>\n"


def commonroad(roads: int = ROADS, lanes: int = LANES, *, apart: bool = True) -> str:
    """Return the same roads as lanelets with neighbours."""

    def bound(name: str, x: float, y: float) -> str:
        points = "".join(f"<point><x>{px}</x><y>{y}</y></point>" for px in (x, x + _LENGTH))
        return f"<{name}>{points}<lineMarking>dashed</lineMarking></{name}>"

    found = ['<commonRoad benchmarkID="DEU_Huge-1_1_T-1" commonRoadVersion="2020a" timeStepSize="0.1">']
    number = 0
    for x, y in _places(roads, apart=apart):
        for i in range(lanes):
            number += 1
            left = f'<adjacentLeft ref="{number - 1}" drivingDir="same"/>' if i else ""
            right = f'<adjacentRight ref="{number + 1}" drivingDir="same"/>' if i < lanes - 1 else ""
            found.append(
                f'<lanelet id="{number}">{bound("leftBound", x, y - i * _WIDTH)}{bound("rightBound", x, y - (i + 1) * _WIDTH)}'
                f"{left}{right}<laneletType>urban</laneletType></lanelet>"
            )
    return "\n".join([*found, "</commonRoad>"])


def sumo(roads: int = ROADS, lanes: int = LANES, *, apart: bool = True) -> str:
    """Return the same roads as edges of a SUMO network."""
    found = ['<?xml version="1.0"?>\n<net version="1.20">']
    for i, (x, y) in enumerate(_places(roads, apart=apart)):
        shapes = (y - (lanes - k - 0.5) * _WIDTH for k in range(lanes))
        text = "".join(
            f'<lane id="e{i}_{k}" index="{k}" speed="13.89" length="{_LENGTH}" width="{_WIDTH}" shape="{x},{at} {x + _LENGTH},{at}"/>'
            for k, at in enumerate(shapes)
        )
        found.append(f'<edge id="e{i}" from="a{i}" to="b{i}">{text}</edge>')
    return "\n".join([*found, "</net>"])


LOGS: Final[dict[str, Callable[..., list[str]]]] = {
    "csv": csv_log,
    "parquet": parquet_log,
    "osi": osi_mcap,
    "fcd": fcd_log,
}
MAPS: Final[dict[str, tuple[str, Callable[..., str]]]] = {
    "opendrive": ("xodr", opendrive),
    "lanelet2": ("osm", lanelet2),
    "commonroad": ("xml", commonroad),
    "sumo": ("net.xml", sumo),
}
NAMES: Final = (*LOGS, *(name + more for name in MAPS for more in ("", "-at-one-place")))


def write(folder: Path, name: str) -> list[str]:
    """Write the files of one case, and return the arguments of `check` that read them."""
    if name in LOGS:
        (folder / "ring.xodr").write_text(ring(), encoding="utf-8")
        return [*LOGS[name](folder), "--map", str(folder / "ring.xodr")]
    suffix, made = MAPS[name.removesuffix("-at-one-place")]
    road = folder / f"huge.{suffix}"
    road.write_text(made(apart=not name.endswith("-at-one-place")), encoding="utf-8")
    return [*csv_log(folder, 3), "--map", str(road)]


def main(names: Sequence[str], more: Sequence[str] = ()) -> None:
    """Check each case, and print a line and what was said."""
    for name in names:
        with TemporaryDirectory(prefix="drivelint-huge-") as home:
            words = write(Path(home), name)
            size = sum(file.stat().st_size for file in Path(home).rglob("*") if file.is_file())
            command = [sys.executable, "-m", "drivelint", "check", *words, "--no-cache", "-q", *more]
            begin = time.monotonic()
            with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as running:
                assert running.stdout is not None
                said = running.stdout.read()
                _, status, used = os.wait4(running.pid, 0)
                running.returncode = os.waitstatus_to_exitcode(status)
        print(
            f"{name}: {size / 1e6:.1f} MB, exit {running.returncode}, {time.monotonic() - begin:.0f} s, "
            f"CPU {used.ru_utime + used.ru_stime:.0f} s, memory {used.ru_maxrss / 1024:.0f} MiB\n  {said.strip()[-1500:]}",
            flush=True,
        )


if __name__ == "__main__":
    asked = sys.argv[1:]
    apart_at = asked.index("--") if "--" in asked else len(asked)
    main(asked[:apart_at] or NAMES, asked[apart_at + 1 :])
