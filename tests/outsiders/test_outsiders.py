"""What outsiders say of the drives that they drew, drivelint says of them too."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

import pytest

from drivelint import catalogue
from tests.outsiders.judging import FAILS, PERSONS, Judged, drives, judge

KNOWN: Final = {
    "gb_left_turn_wide_j ukhc.r183.keep-in": "off its lane's middle for half of the time, the ego does not vouch for the map",
    "gb_bridge_crossing_j ukhc.no-collision": "how far one level is above another is not measured: unknown while the boxes overlap in plan",
    "gb_parked_facing_night_j ukhc.r239.parked-with-traffic": "nobody else is there: a map of the other hand looks the same",
    "gb_parked_facing_night_j ukhc.r248.parked-at-night": "the same",
    "de_stop_halts_j stvo.rin1": "it stands 1.16 m before the line, and at the line is within a metre of it (our default)",
    "de_map_ends_j stvo.rg1": "beyond the map for half of the time, the ego does not vouch for it",
    "de_frozen_lead_speed_j ukhc.no-collision": "the lead's track contradicts its speed: where it was for a second is not known",
    "gb_roundabout_wrong_j ukhc.r143.direction": "nobody else is there: a map of the other hand looks the same",
    "gb_roundabout_wrong_way_k ukhc.r143.direction": "the log ends on the ring: the ego vouches for the map before that only",
    "gb_ghost_driver_k rss.opposite": "the ego is against its lane: who of those that come is in the wrong one is not known",
    "gb_map_ends_soon_in_town_l ukhc.r124.speed-limit": "beyond the map for most of the time, the ego does not vouch for it",
    "gb_dual_astride_two_lanes_l ukhc.r131.keep-in-lane": "between two lanes for so long, the ego does not vouch for the map",
    "gb_town_twenty_at_twenty_six_heading_turned_l ukhc.r124.speed-limit": "the ego's heading is turned round: the log is refused",
    "gb_wrong_way_m ukhc.r143.direction": "against its lane all the time, and the one other vehicle there does not keep to its own",
    "gb_ring_wrong_way_m ukhc.r143.direction": "the log ends on the ring: the ego vouches for the map before that only",
    "de_ring_wrong_way_m ukhc.r143.direction": "the log ends on the ring: the ego vouches for the map before that only",
    "gb_green_blocked_m ukhc.r176.green-exit-clear": "which way out the ego was to take, and whether that one was full, is not known",
    "gb_teleport_m ukhc.no-collision": "where a track that jumps was meanwhile is not known",
    "de_queue_on_the_right_m stvo.rg4": "a slow vehicle in the lane beside is a reason from 30 m on (our default)",
    "de_139_in_120_short_map_n stvo.rg3": "beyond the map for much of the time, the ego does not vouch for it",
    "de_crawler_night_n stvo.rg4": "a map's `no limit` is read as none given: a sign may stand there that the map lacks",
    "bike_cut_back_o criticality.thw": "its front is clear of the cyclist already, the tail of its turned box is not",
    "obst_wait_o criticality.thw": "its front is clear of the van already, the tail of its turned box is not",
    "wrong_side_turn_o ukhc.r180.corner-cut": "it comes to the junction on the wrong side: where it entered that is not known",
}
"""Where product and outsider still differ, as `scene rule`, and why; never a breach that passes."""
BY_CI: Final = PERSONS[-1:]
"""Whose scenes .ci/run judges; each takes half a minute."""


def marks(person: str) -> list[pytest.MarkDecorator]:
    return [pytest.mark.ci if person in BY_CI else pytest.mark.slow]


by_person = pytest.mark.parametrize("person", [pytest.param(p, marks=marks(p)) for p in PERSONS])


@cache
def judged(person: str) -> Judged:
    with TemporaryDirectory() as folder:
        return judge(person, Path(folder))


@by_person
def test_the_verdicts_are_those_that_the_outsider_expected(person: str) -> None:
    scenes = {scene.name: scene.what for scene in judged(person).scenes}
    differs = {f"{name} {rule}": f"{scenes[name]}: {what}" for (name, rule), what in judged(person).differing().items()}
    known = {key for key in KNOWN if key.partition(" ")[0] in scenes}
    assert known <= differs.keys(), "no longer differs: take it out of KNOWN"
    assert not {key: what for key, what in differs.items() if key not in known}


@by_person
def test_no_breach_passes(person: str) -> None:
    """Not even one that is known."""
    passed = {
        (scene.name, rule): scene.what
        for scene in judged(person).scenes
        for rule, expected in scene.expect.items()
        if expected in {"fail", "not pass"} and judged(person).verdict((scene.name, rule)) == "pass"
    }
    assert not passed


@by_person
def test_the_grave_fails_are_those_on_record(person: str) -> None:
    """A new false alarm shows as a new line; who has looked at each writes the file anew: python -m tests.outsiders."""
    names = {scene.name for scene in judged(person).scenes}
    recorded = [line for line in FAILS.read_text(encoding="utf-8").splitlines() if line.partition(" ")[0] in names]
    assert judged(person).fails() == recorded


@pytest.mark.slow
def test_every_scene_has_a_name_of_its_own_and_asks_for_rules_that_there_are() -> None:
    drawn = [drive.scene for person in PERSONS for drive in drives(person)]
    names = {scene.name for scene in drawn}
    assert len(names) == len(drawn)
    assert {rule for scene in drawn for rule in scene.expect} <= catalogue.load_rules().keys()
    assert {f"{scene.name} {rule}" for scene in drawn for rule in scene.expect} >= KNOWN.keys()
    assert {line.partition(" ")[0] for line in FAILS.read_text(encoding="utf-8").splitlines()} <= names
