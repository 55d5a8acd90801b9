"""The evidence says what the log says: who was where around each finding, and the lanes there."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import shapely

from drivelint.engine import batch
from drivelint.report.progress import Silent
from drivelint.result import evidence
from drivelint.result.model import Result
from drivelint.result.names import TABLE_OF_FILE
from drivelint.run import CheckOptions, check
from tests.result.fixture_result import FIXTURE, NAMES, run


@pytest.fixture(scope="module")
def result(overtakes: Result) -> Result:
    return overtakes


@pytest.fixture(scope="module")
def scenes(result: Result) -> dict[tuple[str, int], dict[str, Any]]:
    return {(row["drive_id"], row["t_ns"]): row for row in result.scenes.to_pylist()}


def polygon(actor: dict[str, Any]) -> shapely.Polygon:
    c, s, hl, hw = math.cos(actor["yaw_rad"]), math.sin(actor["yaw_rad"]), actor["length_m"] / 2, actor["width_m"] / 2
    corners = [(hl, hw), (-hl, hw), (-hl, -hw), (hl, -hw)]
    return shapely.Polygon([(actor["x_m"] + c * u - s * v, actor["y_m"] + s * u + c * v) for u, v in corners])


def test_every_finding_and_near_miss_has_a_scene_with_whom_it_is_about(
    result: Result, scenes: dict[tuple[str, int], dict[str, Any]]
) -> None:
    near = result.verdicts.filter(result.verdicts["near_miss"])
    rows = result.findings.to_pylist() + near.to_pylist()
    assert len(rows) > 10
    for row in rows:
        actors = scenes[row["drive_id"], row["t_worst_ns"]]["actors"]
        assert actors[0]["actor_id"] == row["ego_id"]
        assert (actors[0]["x_m"], actors[0]["y_m"]) == pytest.approx((row["x_m"], row["y_m"]), abs=0.001)
        assert row["object_id"] is None or row["object_id"] in {a["actor_id"] for a in actors}
    assert len(scenes) == result.scenes.num_rows == len({(r["drive_id"], r["t_worst_ns"]) for r in rows})


def test_boxes_of_a_scene_are_as_far_apart_as_the_rule_saw(
    result: Result, scenes: dict[tuple[str, int], dict[str, Any]]
) -> None:
    rows = [row for row in result.verdicts.to_pylist() if row["rule_id"] == "ukhc.no-collision" and row["near_miss"]]
    assert rows
    for row in rows:
        actors = {a["actor_id"]: a for a in scenes[row["drive_id"], row["t_worst_ns"]]["actors"]}
        apart = polygon(actors[row["ego_id"]]).distance(polygon(actors[row["object_id"]]))
        assert apart == pytest.approx(row["observed"], abs=0.01)


def test_ways_are_the_logs_positions(scenes: dict[tuple[str, int], dict[str, Any]]) -> None:
    (_, t_ns), scene = next(iter(scenes.items()))
    ego = scene["actors"][0]
    t = np.array([p["t_ns"] for p in ego["path"]])
    assert (np.diff(t) > 0).all()
    assert t_ns in t
    assert -5e9 <= t.min() - t_ns < -4e9
    assert 4e9 < t.max() - t_ns <= 5e9
    at = next(p for p in ego["path"] if p["t_ns"] == t_ns)
    assert (at["x_m"], at["y_m"]) == pytest.approx((ego["x_m"], ego["y_m"]), abs=0.006)
    speeds = (
        np.hypot(np.diff([p["x_m"] for p in ego["path"]]), np.diff([p["y_m"] for p in ego["path"]])) / np.diff(t) * 1e9
    )
    assert np.median(speeds) == pytest.approx(ego["speed_mps"], rel=0.35)


def test_a_danger_space_is_as_long_as_the_stopping_distance_and_as_wide_as_its_vehicle(
    result: Result, scenes: dict[tuple[str, int], dict[str, Any]]
) -> None:
    seen = 0
    spaces = result.spaces.to_pylist()
    for at, scene in scenes.items():
        actors = {a["actor_id"]: a for a in scene["actors"]}
        for space in (row for row in spaces if (row["drive_id"], row["t_ns"]) == at):
            actor = actors.get(space["actor_id"])
            if actor is None or space["length_m"] < 1:
                continue
            mph = actor["speed_mps"] / 0.44704
            assert space["length_m"] == pytest.approx(0.3 * mph + 0.058 - 0.011 * mph + 0.015 * mph**2, abs=0.01)
            ring = shapely.Polygon(list(zip(space["x_m"], space["y_m"], strict=True)))
            assert ring.is_valid
            width = ring.area / space["length_m"]
            assert (
                actor["width_m"] - 0.05 < width < actor["width_m"] + actor["length_m"] * 0.5
            )  # wider where it is slanted
            assert ring.distance(polygon(actor)) < 0.1
            seen += 1
    assert seen > 5


def test_lanes_near_a_scene_are_kept_once_and_true_to_a_decimetre(
    result: Result, scenes: dict[tuple[str, int], dict[str, Any]]
) -> None:
    lanes = {(row["environment_id"], row["lanelet_id"]): row for row in result.lanes.to_pylist()}
    assert len(lanes) == result.lanes.num_rows > 0
    for scene in scenes.values():
        assert scene["lanelets"]
        for lanelet in scene["lanelets"]:
            lane = lanes[scene["environment_id"], lanelet]
            assert len(lane["left_x_m"]) == len(lane["left_y_m"]) >= 2
        ego = shapely.Point(scene["actors"][0]["x_m"], scene["actors"][0]["y_m"])
        road = [
            shapely.Polygon(
                list(
                    zip(
                        lane["left_x_m"] + lane["right_x_m"][::-1],
                        lane["left_y_m"] + lane["right_y_m"][::-1],
                        strict=True,
                    )
                )
            )
            for lane in (lanes[scene["environment_id"], name] for name in scene["lanelets"])
            if lane["drivable"]
        ]
        assert min(area.distance(ego) for area in road) == 0


@pytest.mark.slow
def test_batches_do_not_change_the_evidence(result: Result, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(batch, "MAX_BATCH_STATES", 1)
    single = run(tmp_path)
    for name in list(TABLE_OF_FILE)[4:]:
        assert getattr(single, name).equals(getattr(result, name)), name


def test_danger_spaces_are_kept_along_the_ways(result: Result) -> None:
    at: dict[tuple[str, str], list[int]] = {}
    for row in result.spaces.to_pylist():
        at.setdefault((row["drive_id"], row["actor_id"]), []).append(row["t_ns"])
    assert len(at) == 6  # ego and oncoming vehicle of each
    for (drive_id, _), times in at.items():
        (overtake,) = [row for row in result.overtakes.to_pylist() if row["drive_id"] == drive_id]
        assert len(times) == len(set(times)) > 5
        assert overtake["t0_ns"] <= min(times) <= max(times) <= overtake["t_end_ns"]
        # five a second, and the moments of findings between them
        assert max(np.diff(sorted(times))) < 1.5 * 200_000_000


@pytest.mark.ci
def test_every_finding_has_its_course_and_the_steps_are_the_margins(tmp_path: Path) -> None:
    settings = CheckOptions(
        (str(FIXTURE / "collision.csv"),),
        map=FIXTURE / "road.xodr",
        mapping=str(FIXTURE / "mapping.toml"),
        out=tmp_path,
        margins=True,
        rules=("ukhc", "rss"),
        robustness=False,
    )
    result = check(settings, Silent())
    assert result.margins_file is not None
    margins = {
        (row["rule_id"], row["profile"], row["object_id"], row["t_ns"]): row
        for row in pq.read_table(result.margins_file).to_pylist()
    }
    courses = {row["finding_id"]: row for row in result.courses.to_pylist() if row["finding_id"] is not None}
    assert courses.keys() == {row["finding_id"] for row in result.findings.to_pylist()}
    compared = 0
    for row in result.findings.to_pylist():
        course = courses[row["finding_id"]]
        assert course["t_ns"] == sorted(set(course["t_ns"]))
        assert len(course["t_ns"]) <= 152
        steps = zip(
            course["t_ns"], course["observed"], course["required"], course["margin"], course["holds"], strict=True
        )
        for t_ns, *values in steps:
            if step := margins.get((row["rule_id"], row["profile"], row["object_id"], t_ns)):
                assert values == [step["observed"], step["required"], step["margin"], step["holds"]]
                compared += 1
    assert compared > 100


def _verdict_key(row: dict[str, Any]) -> tuple[Any, ...]:
    return tuple(row[name] for name in ("drive_id", "ego_id", "rule_id", "profile", "object_id", "occurrence"))


@pytest.mark.slow
@pytest.mark.parametrize("margins", [False, True], ids=["settled in the first pass", "every step"])
def test_every_near_miss_has_its_course_and_its_worst_step_is_in_it(margins: bool, tmp_path: Path) -> None:
    settings = CheckOptions(
        tuple(str(FIXTURE / f"{name}.csv") for name in NAMES),
        map=FIXTURE / "road.xodr",
        mapping=str(FIXTURE / "mapping.toml"),
        out=tmp_path,
        margins=margins,
        rules=("ukhc", "criticality"),
        robustness=False,
    )
    result = check(settings, Silent())
    near = {_verdict_key(row): row for row in result.verdicts.to_pylist() if row["near_miss"]}
    courses = {_verdict_key(row): row for row in result.courses.to_pylist() if row["finding_id"] is None}
    assert near.keys() == courses.keys()
    assert len({row["rule_id"] for row in near.values()}) > 1
    for key, row in near.items():
        course = courses[key]
        at = course["t_ns"].index(row["t_worst_ns"])
        seen = course["observed"][at], course["required"][at], course["margin"][at], course["holds"][at]
        assert seen == (row["observed"], row["required"], row["margin"], True)
        assert row["margin"] == min(value for value in course["margin"] if value is not None)
        assert course["t_ns"] == sorted(set(course["t_ns"]))
        assert max(abs(t_ns - row["t_worst_ns"]) for t_ns in course["t_ns"]) <= 5 * 10**9


def test_an_overtake_is_recorded_with_its_profiles_and_stages(result: Result) -> None:
    rows = result.overtakes.to_pylist()
    assert [row["drive_id"].split("-")[0] for row in rows] == ["collision", "near_miss", "safe"]
    for row in rows:
        assert [p["profile"] for p in row["profiles"]] == ["relaxed", "nominal", "aggressive", "observed"]
        runs = row["stretches"]
        assert row["t0_ns"] == runs[0]["t_start_ns"]
        assert runs[-1]["t_end_ns"] <= row["t_end_ns"]
        assert all(a["t_end_ns"] < b["t_start_ns"] for a, b in pairwise(runs))
        assert all((a["stage"], a["said"]) != (b["stage"], b["said"]) for a, b in pairwise(runs))
        for run_ in runs:
            for said, worst in zip(run_["said"], run_["worst_m"], strict=True):
                assert said == ("nobody" if worst is None else "fail" if worst >= 0 else "pass")


@pytest.mark.slow
def test_without_an_output_folder_no_evidence_is_gathered() -> None:
    bare = run(None)
    assert bare.scenes.num_rows == bare.lanes.num_rows == 0
    assert bare.findings.num_rows > 0


def test_the_tables_can_be_read_by_column(result: Result) -> None:
    frame = pl.from_arrow(pa.table(result.scenes))
    assert isinstance(frame, pl.DataFrame)
    assert frame.explode("actors").unnest("actors").height > frame.height


@pytest.mark.parametrize("max_scenes", [1, 5, 7, 100])
def test_moments_are_cut_between_egos(max_scenes: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(evidence, "SCENES_PER_STATEMENT", max_scenes)
    counts = [(1, 3), (2, 2), (3, 9), (4, 1), (5, 1)]
    runs = list(evidence._groups_of_egos(counts))
    assert [ego for first, end in runs for ego in range(first, end)] == [1, 2, 3, 4, 5]
    assert all(
        end - first == 1 or sum(n for ego, n in counts if first <= ego < end) <= max_scenes for first, end in runs
    )
    assert list(evidence._groups_of_egos([])) == []
