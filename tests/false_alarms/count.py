"""What drivelint finds in traffic that nobody planted a breach in: findings of stable rules, and how far and how long was driven."""

from __future__ import annotations

import os
import subprocess
import sys
from typing import TYPE_CHECKING, NamedTuple

import duckdb

from tests.shared_data import DATA

from . import worlds

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

_CAV = ("--mapping", str(DATA / "cav_loop/mapping.toml"), "--handedness", "lht")
REAL: dict[str, tuple[str, str | None, tuple[str, ...]]] = {
    "case study, safe": ("overtake_case_study/safe.csv", "overtake_case_study/t_junction.xodr", ()),
    "case study, near miss": ("overtake_case_study/near_miss.csv", "overtake_case_study/t_junction.xodr", ()),
    "case study, collision": ("overtake_case_study/collision.csv", "overtake_case_study/t_junction.xodr", ()),
    "case study, video": ("video_case_study/detections.csv", None, ("--mapping", "video-detections")),
    "cav loop": ("cav_loop/TEST003.csv", "cav_loop/loop_geo_RHD.xodr", _CAV),
    "osi acc-test": ("osi/acc-test.osi", "osi/straight_500m.xodr", ()),
    "osi alks cut-in": ("osi/alks_cut-in.osi", None, ()),
    "osi highway merge": ("osi/highway_merge.osi", "osi/soderleden.xodr", ("--handedness", "rht")),
    "osi centerline": ("osi/osi_centerline_example.mcap", None, ()),
    "osi stop lines": ("osi/MovingHostWithStopLineVariations.mcap", None, ()),
    "osi pedestrian": ("osi/pedestrian.osi", "osi/fabriksgatan.xodr", ()),
    "esmini two plus one": ("esmini/two_plus_one_road.csv", "maps/two_plus_one.xodr", ()),
    "esmini left-hand": ("esmini/left-hand-traffic_using_road_rule.csv", "maps/e6mini-lht.xodr", ()),
    "esmini pedestrian collision": ("esmini/pedestrian_collision.csv", "osi/fabriksgatan.xodr", ()),
    "esmini cut-in": ("esmini/cut-in.csv", "osi/e6mini.xodr", ()),
    "esmini slow lead": ("esmini/slow-lead-vehicle.csv", "maps/straight_500m_signs.xodr", ()),
    "esmini light state": ("esmini/light_state.csv", "maps/circle_300m.xodr", ()),
    **{
        f"commonroad {path.stem}": (f"commonroad/{path.name}", None, ())
        for path in sorted((DATA / "commonroad").glob("*.xml"))
    },
}
"""Log, map (None: the log brings its own) and options of every log that others recorded or simulated; paths below the reference data."""
SUMO = {"motorway": (worlds.motorway, "rht"), "rural": (worlds.rural, "lht"), "town": (worlds.town, "rht")}
"""The three roads of SUMO's traffic: who drives them, and the hand."""


class Count(NamedTuple):
    """One log, or one road of simulated traffic. `findings`: how many, by severity and rule."""

    name: str
    km: float
    hours: float
    findings: dict[tuple[str, str], int]
    problem: str | None = None


def simulated(name: str, folder: Path, pieces: int, seconds: int) -> Count:
    """Drive one of the roads of `SUMO`, every vehicle as ego, several times: seeds 1, 2, ..."""
    drive, hand = SUMO[name]
    counts = []
    for seed in range(1, pieces + 1):
        files = drive(folder / f"log{seed}", seconds=seconds, seed=seed)
        options = ("--mapping", str(files.routes), "--handedness", hand)
        counts.append(_count_alarms(name, folder / f"out{seed}", str(files.log), str(files.map), *options))
    return together(name, counts)


def together(name: str, counts: Sequence[Count]) -> Count:
    """Add up several counts."""
    found: dict[tuple[str, str], int] = {}
    for count in counts:
        for key, n in count.findings.items():
            found[key] = found.get(key, 0) + n
    problems = [count.problem for count in counts if count.problem]
    return Count(name, sum(c.km for c in counts), sum(c.hours for c in counts), found, "; ".join(problems) or None)


def real(folder: Path) -> Iterator[Count]:
    """Check every log of `REAL` that is there, every vehicle as ego."""
    for number, (name, (log, road, options)) in enumerate(REAL.items()):
        if (DATA / log).exists():
            yield _count_alarms(
                name, folder / str(number), str(DATA / log), str(DATA / road) if road else None, *options
            )


def _count_alarms(name: str, out: Path, log: str, road: str | None, *options: str) -> Count:
    command = [sys.executable, "-m", "drivelint", "check", log, *(("--map", road) if road else ()), *options]
    command += ["--rules", "all", "--ego", "all", "--fail-on", "never", "--no-annotate", "--quiet", "--out", str(out)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=os.environ)
    if not (out / "drives.parquet").exists():
        return Count(name, 0.0, 0.0, {}, f"exit {done.returncode}: {done.stderr.strip().splitlines()[-1:]}")
    with duckdb.connect() as con:
        km, hours = con.execute(
            "SELECT coalesce(sum(e.km), 0), coalesce(sum(e.hours), 0) FROM (SELECT unnest(exposure) AS e FROM read_parquet(?))",
            [str(out / "drives.parquet")],
        ).fetchall()[0]
        rows = con.execute(
            """
            SELECT f.severity, f.rule_id, count(*) FROM read_parquet($findings) f JOIN read_parquet($rules) r USING (rule_id)
            WHERE r.status = 'stable' AND coalesce(f.profile, 'nominal') IN ('nominal', 'observed') GROUP BY ALL
            """,
            {name: str(out / f"{name}.parquet") for name in ("findings", "rules")},
        ).fetchall()
    return Count(name, km, hours, {(severity, rule): n for severity, rule, n in rows})
