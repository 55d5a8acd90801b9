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
from tests.shared_data import ROOT, shared

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


CONTACT_RULES = ("ukhc.no-collision", "ukhc.contact-signature")


def nearing(log: Log, object_id: str, ego: Sample) -> tuple[float, float]:
    """Return the gap of the boxes at a step of the ego, and how fast the centres come nearer, by moving both on for a moment."""
    moment_s = 1e-5
    last = [s for s in log[object_id] if s.t_ns <= ego.t_ns][-1]
    age_s = (ego.t_ns - last.t_ns) / 1e9
    apart = outline(ego.x, ego.y, ego.yaw_deg).distance(outline(*last.after(age_s), last.yaw_deg))
    before = math.dist(ego.after(0), last.after(age_s))
    return apart, (before - math.dist(ego.after(moment_s), last.after(age_s + moment_s))) / moment_s


def closing(log: Log, row: dict[str, Any]) -> float:
    """Return the closing speed of a contact, at the step before it, or of another finding; of boxes that touch, before they did."""
    if row["rule_id"] in CONTACT_RULES:
        return nearing(log, row["object_id"], [s for s in log["ego"] if s.t_ns < row["t_start_ns"]][-1])[1]
    steps = [s for s in log["ego"] if s.t_ns <= row["t_worst_ns"]]
    assert steps[-1].t_ns == row["t_worst_ns"]
    return next(speed for gap, speed in (nearing(log, row["object_id"], ego) for ego in reversed(steps)) if gap > 0)


@pytest.fixture(scope="module", params=["safe", "near_miss", "collision"])
def drive(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> tuple[drivelint.CheckResult, Log]:
    path, log = shifted(request.param, tmp_path_factory.mktemp(request.param))
    return drivelint.check(
        path,
        map=FIXTURE / "road.xodr",
        mapping=FIXTURE / "mapping.toml",
        rules="ukhc",
        profile=["relaxed", "nominal"],
        robustness=False,
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
            assert row["closing_mps"] == pytest.approx(closing(log, row), abs=1e-3), row["rule_id"]


@pytest.mark.ci
def test_a_contact_has_the_speed_before_it(tmp_path: Path) -> None:
    path, log = shifted("collision", tmp_path)
    found = drivelint.check(
        path, map=FIXTURE / "road.xodr", mapping=FIXTURE / "mapping.toml", rules="ukhc.no-collision", robustness=False
    )
    (row,) = found.findings.rows()
    speeds = [max(math.hypot(s.vx, s.vy) for s in log[who]) for who in ("ego", "oncoming")]
    assert 0.9 * sum(speeds) < row["closing_mps"] <= sum(speeds)


@pytest.mark.ci
def test_a_contact_that_only_the_speeds_tell_has_the_speed_before_it() -> None:
    """No box overlaps in this log. Both vehicles have lost their speeds at the first failing step; the ones before it are in the log."""
    log = shared("overtake_case_study/collision.csv")
    road = shared("overtake_case_study/t_junction.xodr")
    (row,) = drivelint.check(
        log, map=road, mapping="carla-testbench", rules="ukhc.contact-signature", robustness=False
    ).findings.rows()
    with log.open(encoding="utf-8") as file:
        names = [name.strip() for name in next(file).split(",")]
        rows = [row for row in csv.DictReader(file, names) if (row["time"] or "").strip()]
    ways = {
        who: [
            {k: float(r[k]) for k in ("time", "x", "y", "vel_x", "vel_y")} for r in rows if r["agentNo"].strip() == who
        ]
        for who in "13"
    }
    i = round(row["t_start_s"] / 0.1) - 1
    ego, met = ways["1"][i], ways["3"][i]
    dx, dy = met["x"] - ego["x"], met["y"] - ego["y"]
    expected = (dx * (ego["vel_x"] - met["vel_x"]) + dy * (ego["vel_y"] - met["vel_y"])) / math.hypot(dx, dy)
    assert 10 < expected < 11
    assert row["closing_mps"] == pytest.approx(expected, abs=0.02)
