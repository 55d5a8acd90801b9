"""The paper's Table 1 from the recorded logs, end to end through the command line, and what an independent script says of the same logs."""

from __future__ import annotations

import csv
import math
import subprocess
import sys
from functools import cache
from typing import TYPE_CHECKING, Any

import duckdb
import pytest
from shapely import affinity
from shapely.geometry import box

from tests.shared_data import shared

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from shapely.geometry import Polygon

# quick tests hold the same table against the fixture's logs (test_cli), and these logs against what nobody saw (test_honesty)
pytestmark = pytest.mark.ci

RUNS = ("safe", "near_miss", "collision")
PAPER_REQUIRED = {"relaxed": 101.39, "nominal": 63.73, "aggressive": 40.02}
PAPER_AHEAD = {"safe": 76.43, "near_miss": 58.33, "collision": 35.63}
TABLE_1 = {
    "safe": {"relaxed": "fail", "nominal": "pass", "aggressive": "pass"},
    "near_miss": {"relaxed": "fail", "nominal": "fail", "aggressive": "pass"},
    "collision": {"relaxed": "fail", "nominal": "fail", "aggressive": "fail"},
}
T0_NS = 8_300_000_000
Row = dict[str, Any]


class Study:
    """The kept database of one run of `check` over the three logs, and its exit code."""

    def __init__(self, con: duckdb.DuckDBPyConnection, exit_code: int) -> None:
        self.con = con
        self.exit_code = exit_code

    def rows(self, sql: str, run: str) -> list[Row]:
        """Return the rows of a query for one run; `drive_id` is the placeholder's."""
        result = self.con.execute(sql, {"drive": f"{run}-%"})
        names = [column[0] for column in result.description or ()]
        return [dict(zip(names, row, strict=True)) for row in result.fetchall()]


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Study]:
    logs = [str(shared(f"overtake_case_study/{run}.csv")) for run in RUNS]
    road = str(shared("overtake_case_study/t_junction.xodr"))
    out = tmp_path_factory.mktemp("study")
    profiles = [word for name in PAPER_REQUIRED for word in ("--profile", name)]
    command = [sys.executable, "-m", "drivelint", "check", *logs, "--mapping", "carla-testbench", "--map", road]
    done = subprocess.run(
        [*command, "--rules", "ukhc", *profiles, "--keep-db", "--no-robustness", "--no-annotate", "--out", str(out)],
        capture_output=True,
        check=False,
    )
    with duckdb.connect(str(out / "drivelint.duckdb"), read_only=True) as con:
        yield Study(con, done.returncode)


@cache
def boxes(run: str) -> dict[str, list[tuple[float, Polygon]]]:
    """Read a log with nothing of the package: per agent its time and box, CARLA's left-handed frame turned over."""
    found: dict[str, list[tuple[float, Polygon]]] = {}
    path: Path = shared(f"overtake_case_study/{run}.csv")
    with path.open(encoding="utf-8") as file:
        for line in csv.DictReader(file, skipinitialspace=True):
            row = {key.strip(): (value or "").strip() for key, value in line.items() if key}
            if not row["agentNo"]:
                continue
            upright = box(-2.4, -0.9, 2.4, 0.9)
            turned = affinity.rotate(upright, -float(row["yaw"]), origin=(0, 0), use_radians=True)
            placed = affinity.translate(turned, float(row["x"]), -float(row["y"]))
            found.setdefault(row["agentNo"], []).append((float(row["time"]), placed))
    return found


@pytest.mark.parametrize("run", RUNS)
def test_the_verdicts_of_table_1(study: Study, run: str) -> None:
    rows = study.rows("FROM verdict WHERE rule_id = 'ukhc.r162.safe-distance-ahead' AND drive_id LIKE $drive", run)
    assert {row["profile"]: row["verdict"] for row in rows} == TABLE_1[run]
    for row in rows:
        assert row["observed"] == pytest.approx(PAPER_AHEAD[run], abs=2.5)
        assert row["required"] == pytest.approx(PAPER_REQUIRED[row["profile"]], abs=0.5)
        assert (row["t_ref_ns"], row["object_id"]) == (T0_NS, "3")


def test_a_failed_critical_rule_is_exit_code_1(study: Study) -> None:
    assert study.exit_code == 1


@pytest.mark.parametrize("run", RUNS)
def test_distance_ahead_is_the_way_between_the_boxes(study: Study, run: str) -> None:
    """The road bends by little: along it and straight across differ by centimetres."""
    (row,) = study.rows("FROM overtake WHERE drive_id LIKE $drive", run)
    apart = [
        ego.distance(ov) for (t, ego), (_, ov) in zip(boxes(run)["1"], boxes(run)["3"], strict=True) if t == T0_NS / 1e9
    ]
    assert row["t0_ns"] == T0_NS
    assert row["da_m"] == pytest.approx(apart[0], abs=0.25)


@pytest.mark.parametrize(("run", "least"), [("safe", 1.84), ("near_miss", 0.34), ("collision", 0.14)])
def test_least_distances(study: Study, run: str, least: float) -> None:
    rows = study.rows("FROM verdict WHERE rule_id = 'ukhc.no-collision' AND drive_id LIKE $drive", run)
    # The speeds of the ego and the oncoming vehicle jump in these two runs while the boxes stay apart: their distances tell no more.
    assert {row["object_id"]: row["verdict"] for row in rows} == {
        "2": "pass",
        "3": "pass" if run == "safe" else "unknown",
    }
    nearest = {
        row["object_id"]: row["least_m"]
        for row in study.rows(
            "SELECT object_id, min(clearance_m) AS least_m FROM pair WHERE drive_id LIKE $drive GROUP BY ALL", run
        )
    }
    assert nearest["3"] == pytest.approx(least, abs=0.01)
    for other in ("2", "3"):
        ours = [(t, ego.distance(o)) for (t, ego), (_, o) in zip(boxes(run)["1"], boxes(run)[other], strict=True)]
        t_least, distance = min(ours, key=lambda pair: (pair[1], pair[0]))
        (row,) = [row for row in rows if row["object_id"] == other]
        assert nearest[other] == pytest.approx(distance, abs=1e-6)
        if row["verdict"] == "unknown":
            continue
        assert row["observed"] == pytest.approx(distance, abs=1e-6)
        if not math.isclose(ours[-1][1], distance, abs_tol=1e-9):  # where it comes to rest, every later step ties
            assert row["t_worst_ns"] / 1e9 == pytest.approx(t_least)


@pytest.mark.parametrize("run", RUNS)
def test_every_clearance_is_that_of_an_independent_script(study: Study, run: str) -> None:
    own = {
        (row["object_id"], round(row["t_ns"] / 1e9, 3)): row
        for row in study.rows("FROM pair WHERE drive_id LIKE $drive", run)
    }
    for other in ("2", "3"):
        for (t, ego), (_, o) in zip(boxes(run)["1"], boxes(run)[other], strict=True):
            row = own.pop((other, round(t, 3)))
            if row["clearance_is_bound"]:
                assert 30.0 < row["clearance_m"] <= ego.distance(o) + 1e-6
            else:
                assert row["clearance_m"] == pytest.approx(ego.distance(o), abs=1e-6)
    assert not own


@pytest.mark.parametrize(("run", "expected"), [("safe", []), ("near_miss", [14.2]), ("collision", [11.6])])
def test_contacts_show_in_the_speeds(study: Study, run: str, expected: list[float]) -> None:
    findings = study.rows("FROM finding WHERE rule_id = 'ukhc.contact-signature' AND drive_id LIKE $drive", run)
    assert [row["t_worst_ns"] / 1e9 for row in findings] == expected
    assert [(row["t_start_ns"], row["t_end_ns"]) for row in findings] == [(round(t * 1e9),) * 2 for t in expected]
    verdicts = study.rows("FROM verdict WHERE rule_id = 'ukhc.contact-signature' AND drive_id LIKE $drive", run)
    assert {row["verdict"] for row in verdicts} == ({"fail"} if expected else {"not_applicable"})


@pytest.mark.parametrize("run", RUNS)
def test_the_ego_leaves_its_lane_at_t0_and_comes_back_at_t3(study: Study, run: str) -> None:
    over = {row["t_ns"]: row["right_out_m"] for row in study.rows("FROM ego_corridor WHERE drive_id LIKE $drive", run)}
    (overtake,) = study.rows("FROM overtake WHERE drive_id LIKE $drive", run)
    assert over[8_200_000_000] == pytest.approx(0.03, abs=0.005)
    assert over[T0_NS] == pytest.approx(0.30, abs=0.005)
    assert overtake["t0_ns"] == T0_NS
    assert all(out <= 0.05 for t, out in over.items() if t < T0_NS)
    assert all(out < 0 for t, out in over.items() if t <= T0_NS - 500_000_000)
    if run == "collision":
        assert (overtake["t3_ns"], overtake["status"]) == (None, "truncated")
        assert all(out > 0.05 for t, out in over.items() if t >= T0_NS)
    else:
        t3 = overtake["t3_ns"]
        assert all(out > 0.05 for t, out in over.items() if T0_NS <= t < t3)
        assert over[t3] <= 0.05
        assert all(out <= 0.05 for t, out in over.items() if t >= t3)
        assert T0_NS < overtake["t1_ns"] < overtake["t2_ns"] < t3 < 20_000_000_000


@pytest.mark.parametrize("run", ["safe", "near_miss"])
def test_entering_the_junction_is_no_departure(study: Study, run: str) -> None:
    state = {row["t_ns"]: row for row in study.rows("FROM ego_state WHERE drive_id LIKE $drive", run)}
    entered = min(t for t, row in state.items() if row["in_junction"])
    assert entered / 1e9 == pytest.approx(20.2, abs=0.5)
    assert max(state) > entered + 10_000_000_000
    for table, time in (("excursion", "t_end_ns"), ("lane_departure", "t_ns"), ("overtake", "t_end_ns")):
        times = [row[time] for row in study.rows(f"FROM {table} WHERE drive_id LIKE $drive", run)]
        assert times
        assert max(times) < 15_000_000_000
    assert {row["chain_id"] for row in state.values()} == {0}
