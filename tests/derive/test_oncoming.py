"""Who comes towards the ego, from where, and how far that nobody does can be told."""

from __future__ import annotations

import math

import numpy as np
import pytest

from drivelint.reasons.reason_text import sentence
from tests import blinding
from tests.scenes import LANE, Road, derived, drive, moving, road, rows, standing, tee, times


@pytest.mark.parametrize(
    ("lanes", "d", "counts"),
    [
        ((1, 1), 1.75, True),
        ((1, 1), -1.75, True),  # towards the ego in its own lane
        ((2, 1), 1.75, True),
        ((2, 1), 1.75 + LANE, False),  # the second lane over is not the one to overtake in
        ((2, 1), 1.75 + LANE - 0.9, True),  # but a corner in the first one is
        ((1, 1), 3.5 + 1.5, False),  # beside the road
    ],
)
@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_who_is_oncoming(hand: str, lanes: tuple[int, int], d: float, counts: bool) -> None:
    way = road(hand=hand, lanes=lanes if hand == "rht" else lanes[::-1])
    t = times(1.0)
    ego = moving("ego", way, t, 100 + 10 * t, way.own)
    other = moving("ov", way, t, 400 - 10 * t, d * way.over)
    found = rows(derived(drive([ego, other], way.environment), tables=["oncoming"]), "FROM oncoming ORDER BY t_ns")
    assert {row["object_id"] for row in found} == ({"ov"} if counts else {None})
    if counts:
        assert [row["da_m"] for row in found] == pytest.approx(list(300 - 4.8 - 20 * t), abs=1e-6)
        assert {row["on_its_way"] for row in found} == {False}
    assert {row["n_unplaced"] for row in found} == ({1} if d == 5.0 else {0})


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(
    ("until_s", "from_s", "jitter_m", "seen_s", "counts"),
    [
        (0.0, 9.0, 0.0, 6.0, False),  # parked at the other kerb of a narrow street
        (0.0, 9.0, 0.3, 6.0, False),  # its place and velocity jitter
        (2.0, 9.0, 0.0, 6.0, True),  # it came, and waits for the ego
        (0.0, 5.0, 0.0, 6.0, True),  # it waits, and then comes
        (0.0, 9.0, 0.0, 0.1, False),  # it stands, and is seen for a moment only
        (9.0, 9.0, 0.0, 0.1, True),  # it is seen for a moment only, but moves
    ],
)
def test_one_that_never_moves_is_parked_and_not_oncoming(  # noqa: PLR0917
    hand: str, until_s: float, from_s: float, jitter_m: float, seen_s: float, counts: bool
) -> None:
    """It stands from `until_s` to `from_s`."""
    way, t = road(hand=hand), times(6.0)
    ego = moving("ego", way, t, 100 + 2 * t, way.own)
    driven = 5.0 * (np.minimum(t, until_s) + np.maximum(t - from_s, 0.0))
    s = 250 - driven + jitter_m * np.sin(9.0 * t)
    other = moving("x", way, t, s, way.other + 0.5 * way.over)
    other.yaw[:] = way.at(s, np.zeros(len(t)))[2] + math.pi
    con = derived(drive([ego, other.keep(t <= seen_s + 0.05)], way.environment), tables=["oncoming"])
    found = rows(con, f"FROM oncoming WHERE t_ns <= {seen_s * 1e9:.0f}")
    assert {row["object_id"] for row in found} == ({"x"} if counts else {None})
    assert {row["n_unplaced"] for row in found} == {0}


def test_one_of_unknown_kind_as_long_as_a_car_is_a_vehicle() -> None:
    way = road()
    t = times(0.3)
    ego, other = moving("ego", way, t, 100 + 10 * t, way.own), moving("x", way, t, 300 - 9 * t, way.other, kind=None)
    con = derived(drive([ego, other], way.environment), tables=["oncoming"])
    assert {row["object_id"] for row in rows(con, "FROM oncoming")} == {"x"}


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize("kind", [None, "object"])
def test_who_comes_and_may_be_on_foot_or_a_vehicle_is_unplaced(hand: str, kind: str | None) -> None:
    way = road(hand=hand)
    t = times(0.3)
    ego = moving("ego", way, t, 100 + 10 * t, way.own)
    other = moving("x", way, t, 300 - 3 * t, way.other, kind=kind, length=1.8, width=0.6)
    found = rows(derived(drive([ego, other], way.environment), tables=["oncoming"]), "FROM oncoming")
    assert {(row["object_id"], row["n_unplaced"]) for row in found} == {(None, 1)}
    assert {sentence(row["unplaced_reason"]) for row in found} == {"actor x comes, but its class is not known"}


@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_one_that_turns_in_from_a_side_road_counts_at_the_way_it_makes(hand: str) -> None:
    """It comes up road 3 and turns towards the ego: from 15 s before it is on the corridor, its own way counts."""
    ways = tee(hand)
    straight, home = ways["straight"], ways["home"]
    t = times(24.0)
    ego = moving("ego", straight, t, 20 + 3 * t, straight.own)
    offset = -LANE / 2 if hand == "rht" else LANE / 2
    ov = moving("ov", home, t, 20 + 8 * t, offset)
    con = derived(drive([ego, ov], straight.environment), tables=["oncoming"])
    found = rows(con, "FROM oncoming ORDER BY t_ns")
    placed = [k for k, row in enumerate(found) if row["object_id"] and not row["on_its_way"]]
    on_its_way = [k for k, row in enumerate(found) if row["on_its_way"]]
    assert placed
    assert on_its_way == list(range(max(0, placed[0] - 150), placed[0]))
    speed = np.hypot(ov.vx, ov.vy)
    for k in on_its_way:
        went = np.hypot(np.diff(ov.x[k : placed[0] + 1]), np.diff(ov.y[k : placed[0] + 1])).sum()
        moved = ego.x[placed[0]] - ego.x[k]
        assert found[k]["da_m"] == pytest.approx(found[placed[0]]["da_m"] + moved + went, abs=1e-6)
        assert found[k]["speed_mps"] == pytest.approx(speed[k])
    # it meets the corridor in the turn, heading at least 120 degrees against it
    turned = abs(math.remainder(ov.yaw[placed[0]] - ego.yaw[placed[0]], 2 * math.pi))
    assert 2 * math.pi / 3 < turned < 2 * math.pi / 3 + 0.15


def test_one_that_crosses_or_turns_away_does_not_count() -> None:
    """Out of the side road to the east: it never comes towards the ego."""
    ways = tee()
    t = times(20.0)
    ego = moving("ego", ways["straight"], t, 20 + 3 * t, -LANE / 2)
    other = moving("x", ways["north"], t, 20 + 8 * t, -LANE / 2)
    con = derived(drive([ego, other], ego_map := ways["straight"].environment), tables=["oncoming"])
    assert ego_map
    assert {row["object_id"] for row in rows(con, "FROM oncoming")} == {None}


def cut_road() -> Road:
    """Return 600 m of road whose lanes have no link at 300 m."""
    way = road(cuts=(300.0,))
    return Road(blinding.without_links(way.environment, "cut"), way.pieces)


@pytest.mark.ci
def test_behind_a_missing_link_nothing_is_claimed() -> None:
    """The corridor ends at 300 m: with nobody there, only what is left of it is free."""
    way = cut_road()
    t = times(10.0)
    con = derived(drive([moving("ego", way, t, 100 + 10 * t, way.own)], way.environment), tables=["oncoming"])
    found = rows(con, "FROM oncoming ORDER BY t_ns")
    assert [row["free_m"] for row in found] == pytest.approx(list(300 - 2.4 - 100 - 10 * t), abs=1e-6)
    assert {row["free_reason"] for row in found} == {"map_end"}
    assert {row["object_id"] for row in found} == {None}


@pytest.mark.ci
def test_behind_a_missing_link_an_oncoming_vehicle_is_met_where_it_comes_in() -> None:
    way = cut_road()
    t = times(10.0)
    ego = moving("ego", way, t, 100 + 10 * t, way.own)
    ov = moving("ov", way, t, 350 - 10 * t, way.other)
    con = derived(drive([ego, ov], way.environment), tables=["oncoming"])
    found = rows(con, "FROM oncoming ORDER BY t_ns")
    assert [row["da_m"] for row in found] == pytest.approx(list(250 - 4.8 - 20 * t), abs=1e-6)
    assert [row["on_its_way"] for row in found] == [s > 300.05 for s in 350 - 10 * t]


def test_where_the_road_goes_on_the_corridor_ends() -> None:
    """1,000 m ahead of the lanelet that the ego is on, whole lanelets: what lies beyond is not looked at."""
    way = road(((3000.0, 0.0),), cuts=tuple(float(s) for s in range(200, 3000, 200)))
    ego = standing("ego", way, times(0.2), 100, way.own)
    con = derived(drive([ego], way.environment), tables=["oncoming"])
    row = rows(con, "FROM oncoming")[0]
    assert row["free_reason"] == "corridor_end"
    assert 1000 - 100 <= row["free_m"] <= 1400


DOUBTS = [
    ("lost ahead, towards the ego", 400.0, "other", -8.0, (0.0, 5.0), "lost", range(51, 201)),
    ("lost far away, on its own way", 500.0, "own", 8.0, (0.0, 5.0), None, range(0)),
    ("began ahead, towards the ego", 450.0, "other", -8.0, (12.0, 20.0), "appeared", range(120)),
    ("behind, driving away, lost", 20.0, "other", -1.0, (0.0, 5.0), None, range(0)),
]


@pytest.mark.parametrize(("what", "s", "lane", "v", "span", "code", "steps"), DOUBTS)
def test_who_is_not_in_the_log_may_be_on_the_road(  # noqa: PLR0917
    what: str, s: float, lane: str, v: float, span: tuple[float, float], code: str | None, steps: range
) -> None:
    """As long as it could take to meet: twice the distance over both speeds, at least 10 s."""
    way = road(((900.0, 0.0),))
    t = times(20.0)
    ego = moving("ego", way, t, 100 + 5 * t, way.own)
    other = moving("x", way, t, s + v * t, getattr(way, lane))
    other = other.keep((t > span[0] - 0.01) & (t < span[1] + 0.01))
    con = derived(drive([ego, other], way.environment), tables=["oncoming", "unplaced"])
    found = rows(con, "FROM unplaced ORDER BY t_ns")
    assert {row["code"] for row in found} == ({code} if code else set())
    assert [round(row["t_ns"] / 1e8) for row in found] == list(steps)
    counted = {round(row["t_ns"] / 1e8): row["n_unplaced"] for row in rows(con, "FROM oncoming")}
    assert {k for k, n in counted.items() if n} == set(steps)


@pytest.mark.parametrize(
    ("at", "lane", "v", "doubted"),
    [
        (
            897.7,
            "other",
            -8.0,
            range(36, 120),
        ),  # a sample earlier it was beyond the end; doubted from 400 m before that on
        (895.7, "other", -8.0, range(36, 120)),
        (895.5, "other", -8.0, range(120)),  # 2.1 m from the end, which it does not make in 0.25 s
        (897.55, "own", 0.6, range(0)),  # about to leave over it: it was on the map before, but goes the ego's way
    ],
)
def test_who_comes_in_over_the_end_of_the_map_was_beyond_it(at: float, lane: str, v: float, doubted: range) -> None:
    """The ego's front is 482.5 + 5 t on a map of 900 m: 400 m from its end at 3.5 s."""
    way = road(((900.0, 0.0),))
    t = times(20.0)
    ego = moving("ego", way, t, 480.1 + 5 * t, way.own)
    other = moving("x", way, t, at + v * (t - 12.0), getattr(way, lane)).keep((t > 11.99) & (t < 12.3))
    con = derived(drive([ego, other], way.environment, sensor_range_m=2000.0), tables=["oncoming", "unplaced"])
    counted = {round(row["t_ns"] / 1e8) for row in rows(con, "FROM oncoming WHERE n_unplaced > 0 AND t_ns < 12e9")}
    assert counted == set(doubted)
    known = {round(row["t_ns"] / 1e8) for row in rows(con, "FROM unplaced WHERE code = 'beyond_map'")}
    assert known == (set(range(120)) - counted if lane == "other" else set())


def test_the_end_of_another_chain_tells_nothing() -> None:
    """Who comes in over the end of the side road, that the ego has turned into by then, may have been near before it did."""
    ways = tee()
    t = times(30.0)
    ego = moving("ego", ways["south"], t, 20 + 10 * t, ways["straight"].own)
    s = 160 + 5 * math.pi + 0.1 - 8 * (t - 20.0)
    other = moving("x", ways["south"], t, s + 187.4, ways["straight"].other).keep(t > 19.99)
    con = derived(drive([ego, other], ways["south"].environment), tables=["unplaced"])
    assert {row["code"] for row in rows(con, "FROM unplaced")} == {"appeared"}


@pytest.mark.parametrize(
    ("s", "lane", "v", "doubted"),
    [
        (100.0, "other", -8.0, False),  # all of it is past the ego's rear
        (100.4, "other", -8.0, False),  # not yet, but a step later, however hard it brakes
        (104.0, "other", -8.0, True),  # until the ego has driven past it
        (80.0, "other", -0.4, True),  # it stands there
        (80.0, "own", 8.0, False),  # it comes up from behind, which is no way to be oncoming
    ],
)
def test_who_was_met_and_lost_after_it_is_not_ahead(s: float, lane: str, v: float, doubted: bool) -> None:
    """The ego's rear is at 102.6 m when the other is seen last, 5 s into the log."""
    way = road(((900.0, 0.0),))
    t = times(30.0)
    ego = moving("ego", way, t, 80 + 5 * t, way.own)
    other = moving("x", way, t, s + v * (t - 5.0), getattr(way, lane)).keep(t < 5.01)
    con = derived(drive([ego, other], way.environment), tables=["oncoming", "unplaced"])
    assert len(rows(con, "FROM unplaced")) == 100
    assert {row["n_unplaced"] for row in rows(con, "FROM oncoming WHERE t_ns > 5e9")} == ({1, 0} if doubted else {0})


@pytest.mark.parametrize(
    ("s", "d", "v", "doubted"),
    [
        (400.0, 40.0, 8.0, True),  # moves beside the road: which way it goes is not known
        (400.0, 40.0, 0.0, False),  # parked beside it
        (400.0, 800.0, 8.0, True),  # as near as the corridor reaches
        (400.0, 1200.0, 8.0, False),  # somewhere else altogether
    ],
)
def test_who_moves_off_the_lanes_is_in_doubt(s: float, d: float, v: float, doubted: bool) -> None:
    way = road(((900.0, 0.0),))
    t = times(2.0)
    ego = moving("ego", way, t, 100 + 5 * t, way.own)
    other = moving("x", way, t, s - v * t, d) if v else standing("x", way, t, s, d)
    con = derived(drive([ego, other], way.environment), tables=["oncoming"])
    assert {row["n_unplaced"] for row in rows(con, "FROM oncoming")} == ({1} if doubted else {0})


def test_one_that_comes_from_off_the_lanes_leaves_the_distance_in_doubt() -> None:
    """It jumps onto the road at 10 s: its way from beside it is not one that it drove, so nearer is not ruled out."""
    way = road(((900.0, 0.0),))
    t = times(20.0)
    ego = moving("ego", way, t, 100 + 5 * t, way.own)
    ov = moving("ov", way, t, 500 - 8 * t, np.where(t < 9.95, 60.0, way.other))
    con = derived(drive([ego, ov], way.environment), tables=["oncoming"])
    before = rows(con, "FROM oncoming WHERE t_ns < 9950000000")
    assert {row["n_unplaced"] for row in before} == {1}
    after = rows(con, "FROM oncoming WHERE t_ns > 10050000000")
    assert {(row["object_id"], row["n_unplaced"], row["on_its_way"]) for row in after} == {("ov", 0, False)}
