"""The plan view and the place of a contact are those of its first step."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pyarrow.compute as pc
import pytest

from drivelint.incident.place import place_at_moment
from drivelint.incident.scene import scene_at
from drivelint.incident.sheet import template_values

if TYPE_CHECKING:
    from tests.incident.conftest import CaseOf

S = 1_000_000_000


@pytest.mark.ci
def test_actors_are_drawn_where_they_are_at_the_moment(case_of: CaseOf) -> None:
    case = case_of("no-collision@collision")
    row, states = case.finding.row, case.drive.trace.tables["actor_state"]
    (scene,) = [
        each
        for each in case.result.scenes.to_pylist()
        if (each["drive_id"], each["t_ns"]) == (row["drive_id"], row["t_worst_ns"])
    ]
    assert scene_at(scene, states, row["t_worst_ns"]) is scene
    samples = {(each["actor_id"], each["t_ns"]): each for each in states.to_pylist()}
    before = row["t_worst_ns"] - 2 * S
    moved = scene_at(scene, states, before)
    assert moved["t_ns"] == before
    assert {actor["actor_id"] for actor in moved["actors"]} == {actor["actor_id"] for actor in scene["actors"]}
    for actor in moved["actors"]:
        there = samples[actor["actor_id"], before]
        assert (actor["x_m"], actor["y_m"]) == pytest.approx((there["x_m"], there["y_m"]), abs=1e-6)
    between = scene_at(scene, states, before + S // 20)
    for actor in between["actors"]:
        ends = [samples[actor["actor_id"], before + t]["x_m"] for t in (0, S // 10)]
        assert actor["x_m"] == pytest.approx(sum(ends) / 2, abs=1e-6)
    assert scene_at(scene, states, case.finding.drive_start_ns - 1)["actors"] == []
    seldom = states.filter(pc.equal(pc.bit_wise_and(pc.divide(states["t_ns"], S), 1), 0))  # the even seconds
    assert scene_at(scene, seldom, 345 * S // 100)["actors"] == []


@pytest.mark.ci
def test_the_place_of_a_contact_is_that_of_its_first_step(case_of: CaseOf) -> None:
    case = case_of("no-collision@collision")
    row, first = case.finding.row, case.finding.row["t_start_ns"]
    deeper = replace(case, finding=replace(case.finding, row={**row, "t_worst_ns": first + S, "x_m": 0.0, "lat": 1.0}))
    step = next(each for each in case.ego_rows.steps.to_pylist() if each["t_ns"] == first)
    found = place_at_moment(deeper)
    assert (found.t_ns, found.x_m, found.y_m, found.lanelet_id) == (first, step["x_m"], step["y_m"], step["lanelet_id"])
    whole = place_at_moment(case)
    assert whole.t_ns == row["t_worst_ns"]
    if row["t_worst_ns"] == first:
        assert (found.lat, found.lon) == (whole.lat, whole.lon) or found.lat == pytest.approx(whole.lat, abs=1e-7)
    told = template_values(deeper)
    assert told["placed"] == told["when"] == told["drawn_at"]
