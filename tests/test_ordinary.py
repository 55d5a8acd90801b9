"""What a careful and competent driver does, and no rule may call a breach; beside each the breach that is like it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from drivelint.engine.batch import Drive
from tests.blinding import renamed
from tests.derive.junction_scenes import cross, crosswalk
from tests.formats.logs import LONG, mapping, put, read
from tests.scenes import LANE, Actor, drive, moving, road, standing, times, verdict_rows

if TYPE_CHECKING:
    from pathlib import Path

    from tests.scenes import Row

HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])


def of(scene: Drive, rule: str) -> list[Row]:
    return verdict_rows([scene], rules=[rule])


def verdicts(scene: Drive, rule: str) -> set[str]:
    return {row["verdict"] for row in of(scene, rule)}


# ---- a row of cones


def by_the_works(hand: str, kind: str | None, cones: list[float], **more: Any) -> Drive:
    """Return an ego that drives 220 m at 10 m/s in the opposing lane, and what stands in its own."""
    way = road(((1000.0, 0.0),), hand=hand)
    t = times(50.0)
    s = 100 + 10 * t
    d = way.ego_d + (way.oncoming_d - way.ego_d) * (np.clip((s - 180) / 30, 0, 1) - np.clip((s - 440) / 30, 0, 1))
    row = [
        replace(standing(f"c{k}", way, t, at, way.ego_d), length=0.4, width=0.4, kind=kind, **more)
        for k, at in enumerate(cones)
    ]
    return drive([moving("ego", way, t, s, d), *row], way.environment)


@pytest.mark.slow
@HANDS
@pytest.mark.parametrize("kind", ["object", None, "car"])
def test_past_a_row_of_cones_the_ego_is_not_on_the_wrong_side(hand: str, kind: str | None) -> None:
    cones = list(np.arange(220.0, 431.0, 15.0))
    assert "fail" not in verdicts(by_the_works(hand, kind, cones), "ukhc.r143.direction")
    assert "fail" in verdicts(by_the_works(hand, kind, []), "ukhc.r143.direction")
    # past two cones, or two parked cars, nothing closes the lane for 200 m
    assert "fail" in verdicts(by_the_works(hand, kind, [220.0, 230.0]), "ukhc.r143.direction")


# ---- slowly, for a little or for long


def slowly(hand: str, behaviour: str) -> Drive:
    """Return an ego at 3 m/s among four others that keep to their lanes: what it does against its lane, for how long."""
    way = road(((1500.0, 0.0),), hand=hand)
    t = times(60.0)
    out = way.oncoming_d - way.ego_d
    s, d = 300 + 3 * t, np.full(t.shape, way.ego_d)
    if behaviour == "out":  # 75 m in the opposing lane
        d = way.ego_d + out * (np.clip((t - 10) / 3, 0, 1) - np.clip((t - 38) / 3, 0, 1))
    elif behaviour == "all along":
        d = np.full(t.shape, way.oncoming_d)
    elif behaviour == "parks":  # across the road to the other edge, and stands there
        s = 300 + 3 * np.clip(t, 0, 20)
        d = way.ego_d + 1.2 * out * np.clip((t - 14) / 4, 0, 1)
    elif behaviour == "turned round":
        s = 300 - 3 * t
    elif behaviour in {"backs", "backs a little"}:
        s = 300 - 3 * np.clip(t - 10, 0, 40 if behaviour == "backs" else 5)
    ego = moving("ego", way, t, s, d)
    if behaviour.startswith("backs"):
        ego = replace(ego, yaw=np.full(t.shape, 0.0))
    starts = ((20.0, 1), (400.0, 1), (900.0, -1), (1100.0, -1))
    rest = [
        moving(f"o{k}", way, t, at + 8 * ahead * t, way.ego_d if ahead > 0 else way.oncoming_d)
        for k, (at, ahead) in enumerate(starts)
    ]
    return drive([ego, *rest], way.environment)


@pytest.mark.sample(1)
@HANDS
@pytest.mark.parametrize("behaviour", ["out", "all along", "turned round", "backs"])
def test_a_slow_drive_on_the_wrong_side_is_one(hand: str, behaviour: str) -> None:
    assert "fail" in verdicts(slowly(hand, behaviour), "ukhc.r143.direction")


@pytest.mark.sample(1)
@HANDS
@pytest.mark.parametrize("behaviour", ["keeps", "parks", "backs a little"])
def test_parking_and_reversing_a_little_is_not_driving_on_the_wrong_side(hand: str, behaviour: str) -> None:
    assert "fail" not in verdicts(slowly(hand, behaviour), "ukhc.r143.direction")


# ---- a parked car before a zebra


def before_the_zebra(hand: str, *, came: bool, walker: bool, beside: float = 0.0, moves: float = 0.0) -> Drive:
    """Return an ego that gets past a car shortly before a zebra crossing, 100 m along its way."""
    way = cross(hand, (), (("1", crosswalk("x", 100.0, label="zebra")),))["we"]
    t = times(24.0)
    d = way.ego_d
    side = math.copysign(1, way.ego_d)
    s = 20 + 6 * np.clip(t - 6, 0, None)
    away = (np.clip((s - 50) / 20, 0, 1) - np.clip((s - 104) / 20, 0, 1)) * -2.6 * side
    stands = 91.0 + moves * (t - 16) - (np.clip(6 - t, 0, None) * 8 if came else 0.0)
    car = moving("car", way, t, stands, d + side * beside)
    _, _, heading = way.at(np.full(t.shape, 90.0), np.full(t.shape, d))
    car = replace(car, yaw=heading)
    people = []
    if walker:
        x = np.full(t.shape, -200.0 + 101.5)
        y = (1 if hand == "lht" else -1) * np.clip(-8 + 0.6 * t, -8, 8)  # on the ego's half when the ego is there
        people = [Actor("w", t, x, y, np.full(t.shape, math.pi / 2), 0 * t, np.gradient(y, t), 0.5, 0.5, "pedestrian")]
    return drive([moving("ego", way, t, s, d + away), car, *people], way.environment)


@HANDS
def test_a_parked_car_before_a_zebra_may_be_passed(hand: str) -> None:
    rule = "ukhc.r191.crossing-overtake"
    scenes = {
        "it parks": before_the_zebra(hand, came=False, walker=False),
        "it stopped for somebody": before_the_zebra(hand, came=True, walker=True),
        "it moves": before_the_zebra(hand, came=False, walker=False, moves=1.0),
        "it parks and somebody walks": before_the_zebra(hand, came=False, walker=True),
        "it stopped and nobody walks": before_the_zebra(hand, came=True, walker=False),
    }
    found: dict[str, set[str]] = {name: set() for name in scenes}
    for row in verdict_rows([renamed(scene, name) for name, scene in scenes.items()], rules=[rule]):
        found[row["drive_id"]].add(row["verdict"])
    # stopped for somebody on the crossing, it may not; nor one that moves; nor may one be passed of which nobody knows why it stands
    assert found == {
        "it parks": {"pass"},
        "it stopped for somebody": {"fail"},
        "it moves": {"fail"},
        "it parks and somebody walks": {"unknown"},
        "it stopped and nobody walks": {"unknown"},
    }


# ---- a response in time


@pytest.mark.sample(1)
@HANDS
@pytest.mark.parametrize(("after", "verdict"), [(0.75, "pass"), (0.95, "pass"), (1.6, "fail")])
def test_a_response_in_time_is_one(hand: str, after: float, verdict: str) -> None:
    """Somebody cuts in at 5 s, 20 m ahead; the ego brakes with 5 m/s2 so much later."""
    way = road(((2000.0, 0.0),), hand=hand, lanes=(0, 2) if hand == "rht" else (2, 0))
    sign = -1 if hand == "rht" else 1
    t = times(12.0, period=0.05)
    begin = 5.0 + after
    v = 20 - 5 * np.clip(t - begin, 0, 3.0)
    s = 100 + np.concatenate([[0.0], np.cumsum((v[1:] + v[:-1]) / 2 * np.diff(t))])
    own, other = 1.5 * LANE * sign, 0.5 * LANE * sign
    # there at once, as far as its place goes: the moment of the danger is known
    cut = np.where(t < 5.0, other, own)
    lead = moving("v", way, t, 100 + 20 * t + 25.0, cut)
    lead = replace(lead, vx=np.full(t.shape, 20.0), vy=0 * t, yaw=0 * t)
    ego = moving("ego", way, t, s, own)
    ego = replace(ego, vx=v, vy=0 * t, yaw=0 * t)
    found = [
        row
        for row in of(drive([ego, lead], way.environment), "rss.proper-response")
        if row["verdict"] != "not_applicable"
    ]
    assert [row["verdict"] for row in found] == [verdict], found


# ---- trembling positions


@pytest.mark.sample(1)
@pytest.mark.parametrize("hertz", [10, 20])
def test_standing_with_trembling_positions_is_standing(tmp_path: Path, hertz: int) -> None:
    """Two cars in a queue, five centimetres of noise, no velocities in the log: no time to collision, no jolts, no contact, and no pass."""
    rng = np.random.default_rng(3)
    lines = ["t,id,x,y,yaw"]
    for k in range(30 * hertz):
        for name, x in (("a", 10.0), ("b", 14.8)):
            dx, dy = rng.normal(0.0, 0.05, 2)
            lines.append(f"{k / hertz:.3f},{name},{x + dx:.4f},{-1.75 + dy:.4f},0.0")
    trace = read(
        put(tmp_path / "d.csv", "\n".join(lines)), mapping=mapping(tmp_path, LONG.replace('vx = "vx"\nvy = "vy"\n', ""))
    )
    way = road()
    rules = ("criticality.*", "comfort.*", "ukhc.contact-signature", "rss.*", "stvo.rg2")
    found = verdict_rows([Drive(trace, way.environment)], rules=rules)
    assert not [(row["rule_id"], row["reason"]) for row in found if row["verdict"] == "fail"]
    contact = [row["verdict"] for row in found if row["rule_id"] == "ukhc.contact-signature"]
    assert contact == ["unknown"]
    assert "pass" not in {row["verdict"] for row in found if row["rule_id"].startswith("comfort.")}


# ---- a gap that somebody else took


def behind_a_cut(hand: str, *, cutter_id: str, faster: float = 0.0, stays: bool = False) -> Drive:
    """Return two lanes; at 5 s `cutter_id` comes from the other one into that of the other vehicle, 12 m apart; then the ego drops back."""
    way = road(((2000.0, 0.0),), hand=hand, lanes=(0, 2) if hand == "rht" else (2, 0))
    sign = -1 if hand == "rht" else 1
    t = times(20.0)
    own, other = 1.5 * LANE * sign, 0.5 * LANE * sign
    change = np.where(t < 5.0, 0.0, np.clip((t - 5.0) / 2.0, 0.0, 1.0))
    comes = other + (own - other) * change
    slower = 0.0 if stays or faster else -4.0 * np.clip((t - 6.0) / 1.0, 0, 1)
    v = 20 + faster * np.clip(t - 6.0, 0, 1) + slower
    s = 100 + np.concatenate([[0.0], np.cumsum((v[1:] + v[:-1]) / 2 * np.diff(t))])
    lead = moving("v", way, t, 100 + 20 * t + 4.8 + 12.0, comes if cutter_id == "v" else own)
    return drive([moving("ego", way, t, s, own if cutter_id == "v" else comes), lead], way.environment)


@pytest.mark.slow
@HANDS
def test_the_headway_that_another_took_is_made_anew(hand: str) -> None:
    rule = "criticality.thw"
    assert verdicts(behind_a_cut(hand, cutter_id="v"), rule) == {"pass"}

    def too_near_from(scene: Drive) -> float:
        return min(float(row["t_start_ns"]) for row in of(scene, rule) if row["verdict"] == "fail") / 1e9

    # the ego that comes in so near itself, or speeds up behind the other, follows too near at once
    assert too_near_from(behind_a_cut(hand, cutter_id="ego")) < 6.5
    assert too_near_from(behind_a_cut(hand, cutter_id="v", faster=0.8)) < 7.0
    # if it never drops back, 5 s after the other came in
    assert 10.0 < too_near_from(behind_a_cut(hand, cutter_id="v", stays=True)) < 11.5
