"""Drives under, on and over other roads: whoever is on another level is not met, and without heights nobody knows."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa
import pytest

from drivelint.formats import load_map
from drivelint.report.progress import Silent
from drivelint.road.map_reader import MapSource
from drivelint.run import CheckOptions, check
from tests.blinding import change_table, renamed
from tests.demo.actors import car, lorry
from tests.demo.levels import TwoLevelRoad, level_scenes
from tests.demo.motion import separation
from tests.demo.opendrive import opendrive
from tests.demo.scene_drive import drive_of_scene
from tests.scenes import derived, rows, verdict_rows
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterable

    from drivelint.engine.batch import Drive
    from tests.demo.motion import Track
    from tests.demo.scene import Scene
    from tests.scenes import Row

PACKS = ("alks-r157", "comfort", "criticality", "declared", "performance", "rss", "stvo", "ukhc")
SCENES = {scene.name: scene for scene in level_scenes()}
EACH_SCENE = pytest.mark.parametrize("name", SCENES)
CONTACT = "ukhc.no-collision"
Verdicts = dict[tuple[str, str | None], set[str]]


def road_of(scene: Scene) -> TwoLevelRoad:
    assert isinstance(scene.road, TwoLevelRoad)
    return scene.road


def on_flat_map(drive: Drive, scene: Scene) -> Drive:
    """Return the drive on the same map without its heights."""
    road = road_of(scene)
    flat = replace(road, heights=(), second=replace(road.second, heights=()))
    return replace(drive, environment=load_map(MapSource("flat.xodr", opendrive(flat, scene.map_name).encode())))


def without_heights(drive: Drive) -> Drive:
    """Return the drive as a log without heights has it."""

    def change(states: pa.Table) -> pa.Table:
        nothing = pa.nulls(states.num_rows, pa.float64())
        return states.set_column(states.schema.get_field_index("z_m"), "z_m", nothing)

    return change_table(drive, "actor_state", change)


def second_at(scene: Scene, *heights: tuple[float, float]) -> Scene:
    """Return the scene with the second road at other heights."""
    road = road_of(scene)
    return replace(scene, road=replace(road, second=replace(road.second, heights=heights)))


def by_rule(rows: Iterable[Row], *, without: str | None = None) -> Verdicts:
    """Return the verdicts of each rule and profile."""
    verdicts: Verdicts = {}
    for row in rows:
        if row["rule_id"] != without:
            verdicts.setdefault((row["rule_id"], row["profile"]), set()).add(row["verdict"])
    return verdicts


def plan_gap(a: Track, b: Track) -> float:
    """Return the least gap in plan: as if both were on one level."""
    return float(separation(replace(a, ground=b.ground), b).min())


@EACH_SCENE
def test_the_boxes_meet_in_plan_and_not_in_height(name: str) -> None:
    ego, *others = SCENES[name].tracks
    assert all(plan_gap(ego, other) < -1.0 for other in others)
    assert all(separation(ego, other).min() > 3.0 for other in others)


@cache
def scene_rows(*variants: str) -> dict[str, list[Row]]:
    """Return what all rules say of every scene, and of its ego alone, with and without the heights of log and map, in one run."""
    drives = []
    for scene in SCENES.values():
        for company, one in (("met", scene), ("alone", replace(scene, other_actors=()))):
            drive = drive_of_scene(one)
            flat = on_flat_map(drive, one)
            versions = {
                "both": drive,
                "log": flat,
                "map": without_heights(drive),
                "none": without_heights(flat),
            }
            drives += [renamed(versions[variant], f"{scene.name} {company} {variant}") for variant in variants]
    found: dict[str, list[Row]] = {drive.trace.drive_id: [] for drive in drives}
    for row in verdict_rows(drives, rules=PACKS):
        found[row["drive_id"]].append(row)
    return found


@pytest.mark.sample(0, ci=6)
@EACH_SCENE
@pytest.mark.parametrize("variant", ["both", "log"])
def test_with_heights_the_other_level_changes_no_verdict(name: str, variant: str) -> None:
    """What the rules say is what they say of the ego alone, but that whoever is near, and not over or under it, is not touched."""
    all_said = scene_rows("both", "log")
    found, expected = all_said[f"{name} met {variant}"], all_said[f"{name} alone {variant}"]
    assert expected
    assert by_rule(found, without=CONTACT) == by_rule(expected, without=CONTACT)
    assert {row["verdict"] for row in found if row["rule_id"] == CONTACT} <= {"pass", "not_applicable"}
    assert {row["rule_id"] for row in found if row["object_id"] is not None} <= {CONTACT}


@pytest.mark.ci
@EACH_SCENE
@pytest.mark.parametrize("variant", ["map", "none"])
def test_without_the_heights_of_the_log_what_depends_on_them_is_unknown(name: str, variant: str) -> None:
    all_said = scene_rows("map", "none")
    found = all_said[f"{name} met {variant}"]
    contacts = [row for row in found if row["rule_id"] == CONTACT]
    assert {row["verdict"] for row in contacts} == {"unknown"}
    assert {row["object_id"] for row in contacts} == {str(n) for n, _ in enumerate(SCENES[name].other_actors, 2)}
    now, expected = by_rule(found), by_rule(all_said[f"{name} alone {variant}"])
    assert now.keys() == expected.keys()
    assert all(now[key] <= {*expected[key], "unknown"} for key in now)
    assert not any(row["verdict"] in {"pass", "fail"} and row["object_id"] is not None for row in found)


@pytest.mark.ci
@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("name", "heights"),
    [
        ("bridge-under", [(0.0, 1.4), (400.0, 1.6)]),
        ("bridge-over", [(0.0, 1.4), (400.0, 1.6)]),
        ("deck", [(0.0, 0.0), (400.0, 2.0), (800.0, 0.0)]),
        ("tunnel", [(0.0, -8.1), (400.0, -7.9)]),
    ],
)
def test_at_the_same_place_on_the_ego_s_level_it_is_a_contact(name: str, heights: list[tuple[float, float]]) -> None:
    scene = second_at(SCENES[name], *heights)
    ego, *others = scene.tracks
    hit = {str(number) for number, other in enumerate(others, 2) if separation(ego, other).min() < 0.0}
    drive = drive_of_scene(scene)
    assert hit
    for one in (drive, on_flat_map(drive, scene)):
        failed = [row for row in verdict_rows([one], rules=[CONTACT]) if row["verdict"] == "fail"]
        assert {row["object_id"] for row in failed} == hit


@pytest.mark.slow
@pytest.mark.parametrize("deck_m", [3.0, 4.2])
def test_bodies_as_high_as_the_deck_are_not_taken_to_be_apart(deck_m: float) -> None:
    """Under a deck that a car passes, the lorry on the lower one may touch the lorry on the upper one."""
    scene = second_at(SCENES["deck"], (0.0, deck_m), (400.0, 2.0 + deck_m), (800.0, deck_m))
    lorries = replace(scene, ego=replace(scene.ego, body=lorry().body._replace(height_m=4.5)))
    cars = replace(scene, other_actors=tuple(replace(other, body=car().body) for other in scene.other_actors))
    for one, apart in ((lorries, False), (cars, True)):
        ego, other = one.tracks
        assert (separation(ego, other).min() > 0.0) == apart
        for drive in (drive_of_scene(one), on_flat_map(drive_of_scene(one), one)):
            verdicts = {row["verdict"] for row in verdict_rows([drive], rules=[CONTACT])}
            assert verdicts <= ({"not_applicable"} if apart else {"fail", "unknown"})


@pytest.mark.parametrize("upper", [False, True])
def test_the_ego_is_on_the_deck_at_its_height(upper: bool) -> None:
    scene = SCENES["deck"]
    if upper:
        scene = replace(scene, ego=scene.ego.on_the_other_level(), other_actors=())
    drive = drive_of_scene(scene)
    assert {row["lanelet_id"] for row in rows(derived(drive, tables=["ego_lane"]), "FROM ego_lane")} == {
        "2.0.1" if upper else "1.0.1"
    }


@pytest.mark.ci
@pytest.mark.sample(2)
@EACH_SCENE
@pytest.mark.parametrize("height", [0.0, 0.75])
def test_a_height_that_the_log_does_not_have_rules_nothing_out(name: str, height: float) -> None:
    """Others at 0, or at half their box, while the ego has a height: the heights are not those of one log."""
    scene = SCENES[name]

    def change(states: pa.Table) -> pa.Table:
        is_ego = np.array(states["actor_id"].to_pylist()) == "1"
        z = np.where(is_ego, states["z_m"].to_numpy() + 40.0, height if name != "deck" else 8 * height / 3)
        return states.set_column(states.schema.get_field_index("z_m"), "z_m", pa.array(z))

    drive = change_table(on_flat_map(drive_of_scene(scene), scene), "actor_state", change)
    verdicts = {row["verdict"] for row in verdict_rows([drive], rules=[CONTACT])}
    assert verdicts == {"unknown"}


@pytest.mark.slow
@pytest.mark.parametrize("road", sorted({scene.map_name for scene in SCENES.values()}))
def test_check_of_the_files_finds_nobody_on_the_other_level(road: str) -> None:
    folder = ROOT / "fixtures" / "scenes"
    traces = tuple(str(folder / f"{s.name}.mcap") for s in SCENES.values() if s.map_name == road)
    result = check(CheckOptions(traces, map=folder / f"{road}.xodr", rules=PACKS, robustness=False), Silent())
    met = [row for row in result.verdicts.to_pylist() if row["object_id"] is not None]
    assert {(row["rule_id"], row["verdict"]) for row in met} <= {(CONTACT, "pass")}
    assert not any(row["object_id"] is not None for row in result.findings.to_pylist())
