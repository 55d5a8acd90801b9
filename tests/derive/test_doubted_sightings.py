"""A sighting that is in doubt bounds nothing: what is known of a hidden actor rests on the other sightings, or is not known."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pytest

from tests.scenes import Actor, derived, drive, judged, moving, road, rows, standing, times

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive

T = times(8.0)
HALVES = math.hypot(4.8, 1.8)
"""The half diagonals of both boxes."""
HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])
PLACES = pytest.mark.parametrize(
    ("quantity", "code"), [("position", "position_step"), ("existence", "held_track"), ("identity", "same_body")]
)


def doubted(told: Drive, actor: str, quantity: str, code: str, span: tuple[float, float] = (0.0, 8.0)) -> Drive:
    """Return the drive with a doubt about a quantity of an actor in this span."""
    table = told.trace.tables["doubt"]
    row = {
        "drive_id": told.trace.drive_id,
        "actor_id": actor,
        "quantity": quantity,
        "code": code,
        "t_from_ns": round(span[0] * 1e9),
        "t_to_ns": round(span[1] * 1e9),
    }
    told.trace.tables["doubt"] = pa.concat_tables([table, pa.Table.from_pylist([row], schema=table.schema)])
    return told


def hidden(told: Drive) -> dict[float, dict[str, Any]]:
    found = rows(derived(told, tables=["hidden"]), "FROM hidden WHERE object_id = 'x' ORDER BY t_ns")
    return {row["t_ns"] / 1e9: row for row in found}


def parted(hand: str, speed: float = 20.0, *, velocity: bool = True) -> Drive:
    """Return an ego that stands at 100 m, and a car that drives from 120 m on at this speed and is not seen from 2.5 to 5.5 s."""
    way = road(((2000.0, 0.0),), hand)
    other = moving("x", way, T, 120 + speed * T, way.own)
    if not velocity:
        nothing = np.full(len(T), np.nan)
        other = Actor("x", T, other.x, other.y, other.yaw, nothing, nothing)
    ego = moving("ego", way, T, np.full(len(T), 100.0), way.own)
    return drive([ego, other.lost((T > 2.45) & (T < 5.55))], way.environment)


@HANDS
@PLACES
@pytest.mark.parametrize("whose", ["x", "ego"])
def test_a_sighting_whose_position_is_in_doubt_is_none(hand: str, quantity: str, code: str, whose: str) -> None:
    """Without its last and next ones, the bound is that of the sightings before and after them; without any, there is none."""
    whole = hidden(parted(hand, velocity=False))
    assert whole[4.0]["least_m"] > 80
    told = doubted(parted(hand, velocity=False), whose, quantity, code, (1.05, 2.45))
    told = doubted(told, whose, quantity, code, (5.55, 6.95))
    some = hidden(told)
    # the last credible sighting is at 1.0 s, the next at 7.0 s: the line between them bends by 5 * 3 * 3 m at most
    assert some[4.0]["least_m"] == pytest.approx(20 + 20 * 4 - 0.1 - 45 - HALVES, abs=1e-6)
    assert some[4.0]["least_m"] < whole[4.0]["least_m"] - 10
    none = hidden(doubted(parted(hand, velocity=False), whose, quantity, code))
    assert {row["least_m"] for row in none.values()} == {0.0}
    assert {row["ahead"] for row in none.values()} == {None}
    assert not any(row["along"] or row["beside_lane"] for row in none.values())


@HANDS
@PLACES
def test_the_doubt_about_one_is_none_about_another(hand: str, quantity: str, code: str) -> None:
    """Both are not seen from 2.5 to 5.5 s; all sightings of the other are in doubt."""
    way = road(((2000.0, 0.0),), hand)
    gone = (T > 2.45) & (T < 5.55)
    actors = [
        moving("ego", way, T, np.full(len(T), 100.0), way.own),
        moving("x", way, T, 120 + 20 * T, way.own).lost(gone),
        moving("y", way, T, 150 + 20 * T, way.own).lost(gone),
    ]
    whole = hidden(drive(actors, way.environment))
    assert whole
    assert hidden(doubted(drive(actors, way.environment), "y", quantity, code)) == whole


@HANDS
@PLACES
def test_no_line_leads_through_a_sighting_in_doubt(hand: str, quantity: str, code: str) -> None:
    """It stands 30 m ahead; its last three samples, and only they, have it drive off."""
    way = road(hand=hand)
    s = np.full(len(T), 130.0)
    s[23:26] += 15 * np.arange(1, 4)
    other = moving("x", way, T, s, way.own)
    other.vx[:], other.vy[:] = np.nan, np.nan
    told = drive([moving("ego", way, T, np.full(len(T), 100.0), way.own), other.keep(T < 2.55)], way.environment)
    told = doubted(told, "x", quantity, code, (2.25, 2.55))
    found = hidden(told)
    assert found
    assert all(row["least_m"] <= 30 - 4.8 + 1e-6 for row in found.values())


@HANDS
@pytest.mark.parametrize("quantity", ["velocity", "heading"])
def test_a_velocity_in_doubt_leads_nowhere(hand: str, quantity: str) -> None:
    """It stands 30 m ahead; its last velocity says that it drives off at 40 m/s."""
    way = road(hand=hand)
    other = standing("x", way, T, 130, way.own)
    last = round(2.5 / 0.1)
    other.vx[last] = 40.0
    other = other.keep((T > 2.45) & (T < 2.55))
    told = drive([moving("ego", way, T, np.full(len(T), 100.0), way.own), other], way.environment)
    code = {"velocity": "velocity_jolt", "heading": "heading_spin"}[quantity]
    before, after = hidden(told), hidden(doubted(told, "x", quantity, code, (2.45, 2.55)))
    at = 3.5
    assert before[at]["least_m"] > 30
    assert before[at]["along"]
    assert (after[at]["least_m"], after[at]["along"], after[at]["ahead"]) == (0.0, False, None)
    # its position still bounds it: it comes nearer at 60 m/s at most
    assert after[2.6]["least_m"] == pytest.approx(30 - 6 - HALVES, abs=1e-6)


@HANDS
@pytest.mark.parametrize("quantity", ["velocity", "heading", "size", "position"])
def test_what_is_beside_the_lane_by_a_doubt_may_be_in_it(hand: str, quantity: str) -> None:
    """12 m beside the lane, driving along it: half a second later it is not in the lane, unless it drives across at its speed."""
    way = road(hand=hand)
    speed = 30.0 if quantity in {"velocity", "heading"} else 5.0
    aside = {"size": 3.2}.get(quantity, 12.0)
    other = moving("x", way, T, 60 + speed * T, way.own - way.over * aside).lost((T > 2.45) & (T < 3.55))
    told = drive([moving("ego", way, T, np.full(len(T), 100.0), way.own), other], way.environment)
    at = 2.5 if quantity == "size" else 2.9
    code = {
        "velocity": "velocity_jolt",
        "heading": "heading_spin",
        "size": "size_implausible",
        "position": "held_track",
    }
    assert hidden(told)[at]["beside_lane"]
    found = hidden(doubted(told, "x", quantity, code[quantity]))
    assert not found[at]["beside_lane"]


@HANDS
def test_no_other_velocity_stands_for_one_in_doubt(hand: str) -> None:
    """Only the velocities of the last sighting and the next are in doubt: those before and after do not say what it did in between."""
    way = road(hand=hand)
    other = moving("x", way, T, 60 + 30 * T, way.own - way.over * 12).lost((T > 2.45) & (T < 3.55))
    told = drive([moving("ego", way, T, np.full(len(T), 100.0), way.own), other], way.environment)
    assert hidden(told)[2.9]["beside_lane"]
    told = doubted(told, "x", "velocity", "velocity_jolt", (2.35, 2.45))
    assert hidden(told)[2.9]["beside_lane"]  # by the next sighting
    told = doubted(told, "x", "velocity", "velocity_jolt", (3.55, 3.65))
    assert not hidden(told)[2.9]["beside_lane"]


@HANDS
def test_a_box_whose_size_is_in_doubt_is_as_large_as_any(hand: str) -> None:
    way = road(hand=hand)
    other = standing("x", way, T, 130, way.own).keep(T < 2.55)
    told = drive([moving("ego", way, T, np.full(len(T), 100.0), way.own), other], way.environment)
    before, after = hidden(told), hidden(doubted(told, "x", "size", "size_implausible"))
    assert before[2.7]["least_m"] > after[2.7]["least_m"] >= 30 - 0.2 - 6 - HALVES / 2 - 0.5


@HANDS
@PLACES
@pytest.mark.parametrize("appears", [False, True])
def test_a_track_that_ends_or_begins_in_doubt_may_be_near(hand: str, quantity: str, code: str, appears: bool) -> None:
    """It is on the road 400 m ahead, too far to matter; if that position is in doubt, it may be anywhere."""
    way = road(((1500.0, 0.0),), hand)
    other = moving("x", way, T, 510 + 10 * T, way.own).keep(T > 4.95 if appears else T < 3.05)
    told = drive([moving("ego", way, T, 100 + 10 * T, way.own), other], way.environment)
    assert not rows(derived(told, tables=["_unseen"]), "FROM _unseen WHERE near")
    told = doubted(told, "x", quantity, code, (4.95, 5.45) if appears else (2.55, 3.05))
    found = rows(derived(told, tables=["_unseen", "hidden"]), "FROM _unseen WHERE object_id = 'x'")
    assert found
    assert all(row["near"] for row in found)


@HANDS
@PLACES
@pytest.mark.parametrize("whose", ["x", "ego"])
def test_a_track_that_ends_in_doubt_at_an_end_of_the_map_may_have_stayed_on_it(
    hand: str, quantity: str, code: str, whose: str
) -> None:
    """It drives off the map ahead: in its last half second it, or the ego, is in doubt."""
    way = road(((500.0, 0.0),), hand)
    t = times(35.0)
    other = moving("x", way, t, 120 + 14 * t, way.own).keep(t < 26.95)
    told = drive([moving("ego", way, t, 50 + 12 * t, way.own), other], way.environment)
    ends = ("ahead_m", "behind_m", "off_ahead_m", "off_behind_m")
    whole = rows(derived(told, tables=["_unseen"]), "FROM _unseen WHERE object_id = 'x'")
    assert any(row[name] is not None for row in whole for name in ends)
    found = rows(
        derived(doubted(told, whose, quantity, code, (26.45, 27.0)), tables=["_unseen"]),
        "FROM _unseen WHERE object_id = 'x'",
    )
    assert len(found) >= len(whole) > 0
    assert {row[name] for row in found for name in ends} == {None}
    assert all(row["near"] for row in found)


@HANDS
@pytest.mark.parametrize(("quantity", "code"), [("position", "position_step"), ("identity", "same_body")])
def test_a_rule_does_not_pass_by_a_sighting_in_doubt(hand: str, quantity: str, code: str) -> None:
    """The car ahead is lost; only samples that are in doubt say that it had driven off before."""
    way = road(((1500.0, 0.0),), hand)
    s = 140 + 10 * T
    s[T > 1.95] += 20 * (T[T > 1.95] - 1.9) * 10
    other = moving("x", way, T, s, way.own).keep(T < 2.55)
    ego = moving("ego", way, T, 100 + 10 * T, way.own)
    rule = "ukhc.r126.stopping-gap"

    def late(told: Drive) -> set[str]:
        return {
            row["verdict"] for row in judged([told], rules=[rule]) if row["t_end_ns"] is None or row["t_end_ns"] > 3e9
        }

    told = drive([ego, other], way.environment)
    told = doubted(told, "x", quantity, code, (1.95, 2.55))
    assert "unknown" in late(told)
    assert "pass" not in {row["verdict"] for row in judged([told], rules=[rule]) if (row["t_start_ns"] or 0) > 2.6e9}


@HANDS
@PLACES
def test_a_breach_that_rests_on_credible_samples_is_found(hand: str, quantity: str, code: str) -> None:
    """5 m behind a car at 10 m/s; another car's sightings are in doubt, and so are those of the first car later."""
    way = road(((1500.0, 0.0),), hand)
    lead = moving("x", way, T, 109.8 + 10 * T, way.own).keep(T < 5.05)
    far = moving("y", way, T, 400 + 10 * T, way.own).keep(T < 3.05)
    told = drive([moving("ego", way, T, 100 + 10 * T, way.own), lead, far], way.environment)
    told = doubted(doubted(told, "y", quantity, code), "x", quantity, code, (4.05, 5.05))
    found = judged([told], rules=["ukhc.r126.stopping-gap"])
    assert "fail" in {row["verdict"] for row in found}


@HANDS
@PLACES
def test_a_doubt_makes_no_lost_track_one_that_is_out_of_sight(hand: str, quantity: str, code: str) -> None:
    """A recorder may lose a car in plain view for 2.5 s, whatever is in doubt of its samples; after that the car is out of sight."""
    way = road(hand=hand)
    ego = moving("ego", way, T, np.full(len(T), 100.0), way.own)
    told = drive([ego, standing("x", way, T, 130, way.own).keep(T < 3.05)], way.environment, in_sight=True)
    lateness = {t: row["late"] for t, row in hidden(told).items()}
    assert next(t for t, late in lateness.items() if late) == pytest.approx(5.6)
    some = hidden(doubted(told, "x", quantity, code, (2.05, 3.05)))
    assert {t: row["late"] for t, row in some.items()} == lateness
    every = hidden(doubted(told, "x", quantity, code))
    assert {t: row["late"] for t, row in every.items()} == lateness


@HANDS
@PLACES
def test_a_sample_in_doubt_does_not_lead_behind_a_box(hand: str, quantity: str, code: str) -> None:
    """Its last sample is behind the box of a van, so that it is out of sight at once; if that sample is in doubt, it may not be."""
    way = road(hand=hand)
    ego = moving("ego", way, T, np.full(len(T), 100.0), way.own)
    van = standing("van", way, T, 112, way.own)
    told = drive([ego, van, standing("x", way, T, 130, way.own).keep(T < 3.05)], way.environment, in_sight=True)
    assert min(t for t, row in hidden(told).items() if row["late"]) == pytest.approx(3.1)
    found = hidden(doubted(told, "x", quantity, code, (2.95, 3.05)))
    assert min(t for t, row in found.items() if row["late"]) == pytest.approx(5.6)
