"""Seconds of the drive and closing speeds in verdicts and findings, against the log's own numbers."""

from __future__ import annotations

import csv
import math
import re
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from shapely import affinity
from shapely.geometry import Polygon, box

import drivelint
from tests.shared_data import ROOT

FIXTURE = ROOT / "fixtures" / "overtake"
SINCE_1970_S = 1_700_000_000
"""When the log begins, on its own clock."""


class Sample(NamedTuple):
    """One row of the log."""

    t_ns: int
    x: float
    y: float
    yaw_deg: float
    vx: float
    vy: float

    def after(self, seconds: float) -> tuple[float, float]:
        return self.x + self.vx * seconds, self.y + self.vy * seconds


Log = dict[str, list[Sample]]


def shifted(name: str, folder: Path) -> tuple[Path, Log]:
    """Write a drive with another clock and without every fifth sample of the oncoming vehicle; return it and its samples."""
    with (FIXTURE / f"{name}.csv").open(encoding="utf-8") as file:
        head, *rows = list(csv.reader(file))
    samples: Log = {}
    kept = [row for row in rows if row[1] != "oncoming" or round(float(row[0]) * 10) % 5 != 2]
    for row in kept:
        t_ns = SINCE_1970_S * 10**9 + round(float(row[0]) * 1e9)
        row[0] = f"{t_ns // 10**9}.{t_ns % 10**9:09}"
        samples.setdefault(row[1], []).append(Sample(t_ns, *map(float, row[3:8])))
    path = folder / f"{name}.csv"
    path.write_text("\n".join(map(",".join, [head, *kept])) + "\n", encoding="utf-8")
    return path, samples


def outline(x: float, y: float, yaw_deg: float) -> Polygon:
    return affinity.translate(affinity.rotate(box(-2.4, -0.9, 2.4, 0.9), yaw_deg, origin=(0, 0)), x, y)


def closing(log: Log, other: str, t_ns: int) -> float:
    """Return how fast the centres come nearer, by moving both on for a moment; of boxes that touch, before they did."""
    steps = [s for s in log["ego"] if s.t_ns <= t_ns]
    assert steps[-1].t_ns == t_ns
    moment_s = 1e-5
    for ego in reversed(steps):
        last = [s for s in log[other] if s.t_ns <= ego.t_ns][-1]
        age_s = (ego.t_ns - last.t_ns) / 1e9
        apart = outline(ego.x, ego.y, ego.yaw_deg).distance(outline(*last.after(age_s), last.yaw_deg))
        if apart > 0:
            before = math.dist(ego.after(0), last.after(age_s))
            return (before - math.dist(ego.after(moment_s), last.after(age_s + moment_s))) / moment_s
    raise AssertionError


@pytest.fixture(scope="module", params=["safe", "near_miss", "collision"])
def drive(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> tuple[drivelint.CheckResult, Log]:
    path, log = shifted(request.param, tmp_path_factory.mktemp(request.param))
    return drivelint.check(
        path, map=FIXTURE / "road.xodr", mapping=FIXTURE / "mapping.toml", rules="ukhc", profile=["relaxed", "nominal"]
    ), log


def test_seconds_are_those_of_the_reasons(drive: tuple[drivelint.CheckResult, Log]) -> None:
    found, log = drive
    first = min(sample.t_ns for samples in log.values() for sample in samples)
    told = 0
    rows: list[dict[str, Any]] = [*found.verdicts.rows(), *found.findings.rows()]
    for row in rows:
        for name in ("t_start", "t_worst"):
            t_ns = row[f"{name}_ns"]
            assert row[f"{name}_s"] == (None if t_ns is None else (t_ns - first) / 1e9)
        if row["reason_measures"] and (at := re.search(r" at (\d+\.\d{3}) s where", row["reason"])):
            assert f"{row['t_worst_s']:.3f}" == at[1]
            told += 1
    assert told


def test_closing_speeds_are_those_of_the_log(drive: tuple[drivelint.CheckResult, Log]) -> None:
    found, log = drive
    rows = found.findings.rows()
    assert {row["object_id"] for row in rows} & {"oncoming"}
    for row in rows:
        if row["object_id"] is None:
            assert row["closing_mps"] is None
        else:
            expected = closing(log, row["object_id"], row["t_worst_ns"])
            assert row["closing_mps"] == pytest.approx(expected, abs=1e-3), row["rule_id"]


def test_a_contact_has_the_speed_before_it(tmp_path: Path) -> None:
    path, log = shifted("collision", tmp_path)
    found = drivelint.check(
        path, map=FIXTURE / "road.xodr", mapping=FIXTURE / "mapping.toml", rules="ukhc.no-collision"
    )
    (row,) = found.findings.rows()
    speeds = [max(math.hypot(s.vx, s.vy) for s in log[who]) for who in ("ego", "oncoming")]
    assert 0.9 * sum(speeds) < row["closing_mps"] <= sum(speeds)
