"""An ego that turns at a junction cuts the corner or swings wide: it did not pull out for a vehicle that is parked beyond the turn."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tests import scenes
from tests.derive.junction_scenes import ARM, TURN, R, cross
from tests.scenes import Actor, Road, derived, drive, moving, rows, standing, times


def over_line(way: Road, s: Any, places: list[tuple[float, float]]) -> Any:
    """Offsets along s, from the own lane's centre towards the oncoming lane by so many metres at each place."""
    stations, metres = zip(*places, strict=True)
    return way.own + way.over * np.interp(s, stations, metres)


def truck(way: Road, places: list[tuple[float, float]], start: float = 150.0) -> Actor:
    t = times(12.0)
    s = start + 8 * t
    return moving("ego", way, t, s, over_line(way, s, places), length=9.5, width=2.5, kind="truck")


def judged_rules(way: Road, *actors: Actor) -> tuple[list[tuple[Any, ...]], dict[str, set[str]]]:
    """Whom the ego overtakes, as (who, sure, begin seen), and the verdicts about that vehicle by rule."""
    told = drive(actors, way.environment)
    found = rows(derived(told, tables=["overtake"]), "FROM overtake ORDER BY ALL")
    verdicts: dict[str, set[str]] = {}
    for row in scenes.judged([told], rules=["ukhc.r126.ds-vbp-out-of-av", "ukhc.r163.pull-out-separation"]):
        verdicts.setdefault(row["rule_id"].split(".")[-1], set()).add(row["verdict"])
    return [(row["vbp_id"], row["sure"], row["begin_seen"]) for row in found], verdicts


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize("start", [150.0, ARM + 6.0])
def test_an_ego_that_turns_in_does_not_surely_overtake_who_is_parked_there(hand: str, start: float) -> None:
    """It cuts the corner by 2 m and is still 0.4 m over the line beside the parked car, whether the log shows the begin or not."""
    way = cross(hand)["wn" if hand == "rht" else "ws"]
    parked_s = ARM + TURN + 14
    parked = standing("p", way, times(12.0), parked_s, way.own - 1.3 * way.over)
    ego = truck(
        way,
        [
            (ARM, 0),
            (ARM + 6, 2.0),
            (ARM + TURN - 4, 2.0),
            (parked_s - 9, 0.7),
            (parked_s - 4, 1.0),
            (parked_s + 4, 1.0),
            (parked_s + 10, 0),
        ],
        start,
    )
    found, verdicts = judged_rules(way, ego, parked)
    assert found == [("p", False, False)]
    assert "fail" not in set.union(*verdicts.values())
    assert "unknown" in verdicts["ds-vbp-out-of-av"]


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(("leads", "pull_out"), [("wn", ARM + TURN + 20), ("we", ARM + 6), ("we", ARM + 60)])
def test_an_ego_that_pulls_out_after_the_turn_or_where_the_road_leads_straight_on_overtakes(
    hand: str, leads: str, pull_out: float
) -> None:
    way = cross(hand)["ws" if hand == "lht" and leads == "wn" else leads]
    parked = standing("p", way, times(12.0), pull_out + 14, way.own - 1.3 * way.over)
    ego = truck(way, [(pull_out - 4, 0), (pull_out + 10, 2.0), (pull_out + 24, 2.0), (pull_out + 34, 0)], pull_out - 40)
    found, verdicts = judged_rules(way, ego, parked)
    assert found == [("p", True, True)]
    assert "fail" in verdicts["ds-vbp-out-of-av"]


@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_a_log_that_begins_out_of_the_lane_in_a_junction_may_begin_in_a_turn(hand: str) -> None:
    way = cross(hand)["we"]
    parked = standing("p", way, times(12.0), ARM + 2 * R, way.own - 1.3 * way.over)
    ego = truck(
        way,
        [(ARM, 2.0), (ARM + 2 * R - 12, 2.0), (ARM + 2 * R - 8, 0.7), (ARM + 2 * R - 4, 1.0), (ARM + 2 * R + 14, 0)],
        ARM + 6,
    )
    found, verdicts = judged_rules(way, ego, parked)
    assert found == [("p", False, False)]
    assert "fail" not in set.union(*verdicts.values())
