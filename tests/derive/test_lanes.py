"""Places on the road: lanelets, the ego's lane, its chain, and its box in the corridor."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from shapely import affinity
from shapely.geometry import LineString, Point, box

from tests import blinding
from tests.scenes import LANE, derived, drive, judged, moving, road, rows, standing, swing, tee, times


def test_a_centre_is_on_every_lanelet_that_holds_it() -> None:
    """On the line between two lanes it is on both (2 cm of tolerance), beside the road on none, without position neither."""
    way = road(((100.0, 0.0),))
    places = {"own": -1.75, "line": 0.01, "other": 1.75, "verge": 3.6, "edge": 3.51}
    actors = [standing(name, way, times(0.1), 40.0, d) for name, d in places.items()]
    lost = replace(standing("lost", way, times(0.1), 40.0, 0.0), x=np.full(2, np.nan))
    con = derived(drive([*actors, lost], way.environment, egos=["own"]), tables=["lane_occupancy"])
    found = rows(con, "FROM lane_occupancy WHERE t_ns = 0 ORDER BY actor_id, lanelet_id")
    assert [(row["actor_id"], row["lanelet_id"]) for row in found] == [
        ("edge", "1.0.1"),
        ("line", "1.0.-1"),
        ("line", "1.0.1"),
        ("lost", None),
        ("other", "1.0.1"),
        ("own", "1.0.-1"),
        ("verge", None),
    ]
    by_place = {(row["actor_id"], row["lanelet_id"]): row for row in found}
    own, line = by_place["own", "1.0.-1"], by_place["line", "1.0.1"]
    assert (own["s_m"], own["d_m"], own["half_width_m"]) == pytest.approx((40.0, 0.0, LANE / 2))
    assert own["heading_diff_rad"] == pytest.approx(0.0)
    # lane 1 is driven westwards: 60 m from its start, the centre 1.74 m left of its middle, the heading against it
    assert (line["s_m"], line["d_m"]) == pytest.approx((60.0, 1.74))
    assert abs(line["heading_diff_rad"]) == pytest.approx(math.pi)


@pytest.mark.parametrize("way", ["straight", "south"])
def test_in_a_junction_it_is_on_the_lanelet_that_leads_on(way: str) -> None:
    """Lanes of the straight and of the turning road lie on each other; which one is driven shows behind the junction."""
    path = tee()[way]
    t = times(12.0)
    con = derived(
        drive([moving("ego", path, t, 150 + 6 * t, path.own)], path.environment), tables=["ego_lane", "chain"]
    )
    lanes = [row["lanelet_id"] for row in rows(con, "FROM ego_lane ORDER BY t_ns")]
    expected = {"straight": ["1.0.-1", "10.0.-1", "2.0.-1"], "south": ["1.0.-1", "11.0.-1", "3.0.-1"]}[way]
    assert list(dict.fromkeys(lanes)) == expected
    assert sorted(lanes, key=expected.index) == lanes  # no flicker between them
    chain = [row["lanelet_id"] for row in rows(con, "FROM chain WHERE t_first_ns IS NOT NULL ORDER BY seq")]
    assert chain == expected
    assert rows(con, "SELECT count(DISTINCT chain_id) AS n FROM chain")[0]["n"] == 1


def test_a_chain_has_its_stations_in_one_line() -> None:
    way = road(cuts=(200.0, 400.0))
    t = times(20.0)
    con = derived(drive([moving("ego", way, t, 250 + 8 * t, way.own)], way.environment), tables=["chain", "ego_state"])
    found = rows(con, "FROM chain ORDER BY seq")
    assert [(row["chain_id"], row["lanelet_id"], round(row["s_start_m"], 6)) for row in found] == [
        (0, "1.0.-1", -200.0),
        (0, "1.1.-1", 0.0),
        (0, "1.2.-1", 200.0),
    ]
    assert found[0]["t_first_ns"] is None  # where it came from was not driven in this log
    assert found[1]["t_first_ns"] == 0
    assert found[2]["t_first_ns"] == pytest.approx(150 / 8 * 1e9, abs=1.1e8)
    state = rows(con, "FROM ego_state ORDER BY t_ns")
    assert [row["s_m"] for row in state] == pytest.approx(list(50 + 8 * t))
    assert {row["lanelet_id"] for row in state} == {"1.1.-1", "1.2.-1"}


@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_an_overtake_in_the_opposing_lane_keeps_its_chain(hand: str) -> None:
    way = road(hand=hand, cuts=(200.0, 400.0))
    t = times(30.0)
    s = 100 + 12 * t
    ego = moving("ego", way, t, s, swing(way, s, 150, 330))
    con = derived(drive([ego], way.environment), tables=["ego_state", "chain"])
    state = rows(con, "FROM ego_state ORDER BY t_ns")
    assert {row["chain_id"] for row in state} == {0}
    assert [row["s_m"] for row in state] == pytest.approx(list(s))
    assert any(row["with_direction"] is False for row in state)
    across = [row["d_m"] for row in state]
    assert max(across) == pytest.approx(LANE if hand == "rht" else 0, abs=1e-6)
    assert min(across) == pytest.approx(-LANE if hand == "lht" else 0, abs=1e-6)


def test_a_change_to_another_lane_of_its_direction_is_a_new_chain() -> None:
    way = road(lanes=(0, 2))
    t = times(20.0)
    s = 100 + 12 * t
    d = -1.5 * LANE + LANE * np.clip((s - 201) / 40, 0, 1)
    con = derived(drive([moving("ego", way, t, s, d)], way.environment), tables=["ego_state"])
    state = rows(con, "FROM ego_state ORDER BY t_ns")
    assert [row["chain_id"] for row in state] == [0 if at < -LANE + 1e-9 else 1 for at in d]
    assert {(row["chain_id"], row["lanelet_id"]) for row in state} == {(0, "1.0.-2"), (1, "1.0.-1")}


def test_several_laps_of_a_ring_are_one_way() -> None:
    """800 m round along the reference line; the ego's lane lies 1.75 m outside of it and is longer by 11 m."""
    way = road(((800.0, 2 * math.pi / 800.0),), ring=True)
    t = times(100.0, period=0.2)
    con = derived(drive([moving("ego", way, t, 5 + 20 * t, way.own)], way.environment), tables=["ego_state"])
    state = rows(con, "FROM ego_state ORDER BY t_ns")
    longer = (800 / (2 * math.pi) + LANE / 2) / (800 / (2 * math.pi))
    assert [row["s_m"] for row in state] == pytest.approx(list((5 + 20 * t) * longer), abs=0.2)
    assert {row["chain_id"] for row in state} == {0}
    assert max(abs(row["d_m"]) for row in state) < 0.02
    visits = rows(con, "FROM chain WHERE t_first_ns IS NOT NULL ORDER BY seq")
    assert [row["t_first_ns"] / 1e9 for row in visits] == pytest.approx([0.0, 39.75, 79.75], abs=0.21)


@pytest.mark.ci
def test_without_a_link_the_chain_ends_and_another_begins() -> None:
    way = road(cuts=(200.0, 400.0))
    broken = blinding.without_links(way.environment, "broken", "1.1.-1")
    t = times(30.0)
    con = derived(drive([moving("ego", way, t, 150 + 12 * t, way.own)], broken), tables=["ego_state"])
    ends = rows(con, "SELECT chain_id, max(s_start_m + length_m) AS m FROM chain GROUP BY ALL ORDER BY ALL")
    assert [(row["chain_id"], row["m"]) for row in ends] == [(0, 200.0), (1, 200.0), (2, 200.0)]
    state = rows(con, "FROM ego_state ORDER BY t_ns")
    assert [row["chain_id"] for row in state] == [0 if s < 200 else 1 if s < 400 else 2 for s in 150 + 12 * t]


@pytest.mark.parametrize("curvature", [1 / 60, -1 / 60])
@pytest.mark.parametrize(("d", "turned"), [(0.0, 0.0), (0.6, 0.2), (-1.6, -0.35), (1.2, 0.6)])
def test_the_box_in_a_bend(curvature: float, d: float, turned: float) -> None:
    """Corners against the boundaries as lines: a bend must not tilt the box. Positive: over the boundary."""
    way = road(((30.0, 0.0), (150.0, curvature), (30.0, 0.0)))
    ego = standing("ego", way, times(0.2), 100.0, way.own + d, turned=turned)
    con = derived(drive([ego], way.environment), tables=["ego_corridor"])
    found = rows(con, "FROM ego_corridor WHERE chain_id = 0")[0]
    x, y, heading = (float(v) for v in way.at(100.0, way.own + d))
    outline = affinity.translate(
        affinity.rotate(box(-2.4, -0.9, 2.4, 0.9), heading + turned, origin=(0, 0), use_radians=True), x, y
    )
    corners = [Point(c) for c in outline.exterior.coords[:-1]]
    fine = np.linspace(60, 140, 4001)

    def beyond(offset: float, sign: int) -> list[float]:
        """Signed distance of each corner from the line at this offset, positive on its `sign` side."""
        line = LineString(np.column_stack(way.at(fine, offset)[:2]))
        inner = LineString(np.column_stack(way.at(fine, offset - sign * 8)[:2]))
        return [line.distance(c) * (1 if inner.distance(c) > 8 else -1) for c in corners]

    left, right = beyond(way.own + LANE / 2, 1), beyond(way.own - LANE / 2, -1)
    assert found["left_out_m"] == pytest.approx(max(left), abs=0.02)
    assert found["left_in_m"] == pytest.approx(min(left), abs=0.02)
    assert found["right_out_m"] == pytest.approx(max(right), abs=0.02)
    assert found["right_in_m"] == pytest.approx(min(right), abs=0.02)
    assert found["d_m"] == pytest.approx(d, abs=0.02)
    assert found["heading_diff_rad"] == pytest.approx(turned, abs=0.01)
    centre = LineString(np.column_stack(way.at(np.linspace(0, 210, 9001), way.own)[:2]))
    stations = [centre.project(c) for c in corners]
    assert found["front_s_m"] == pytest.approx(max(stations), abs=0.05)
    assert found["rear_s_m"] == pytest.approx(min(stations), abs=0.05)


def test_a_step_without_position_is_on_no_lane() -> None:
    way = road()
    t = times(2.0)
    ego = moving("ego", way, t, 50 + 10 * t, way.own).lost((t > 0.95) & (t < 1.25))
    con = derived(drive([ego], way.environment), tables=["ego_state"])
    state = rows(con, "FROM ego_state ORDER BY t_ns")
    assert [k for k, row in enumerate(state) if row["lanelet_id"] is None] == [10, 11, 12]
    assert all(row["s_m"] is None and row["chain_id"] == 0 for row in state[10:13])
    assert len(rows(con, "FROM ego_lane")) == len(t)


@pytest.mark.ci
def test_a_lane_that_is_driven_both_ways_fits_a_drive_against_its_drawn_direction() -> None:
    """Neither the ego nor another vehicle that drives so says that the map is wrong."""
    way, t = road(), times(30.0)
    lanelets = way.environment.tables["lanelet"]
    both_ways = lanelets.set_column(
        lanelets.schema.get_field_index("bidirectional"),
        lanelets.schema.field("bidirectional"),
        [[True] * len(lanelets)],
    )
    environment = replace(way.environment, tables={**way.environment.tables, "lanelet": both_ways})
    actors = [moving("ego", way, t, 500 - 12 * t, way.own), moving("o", way, t, 550 - 12 * t, way.own)]
    con = derived(drive(actors, environment), tables=["registration", "ego_state"])
    (found,) = rows(con, "FROM registration")
    assert (found["ok"], found["n_with_direction"]) == (True, found["n_moving"])
    assert {(row["with_direction"], row["with_traffic"]) for row in rows(con, "FROM ego_state")} == {(False, True)}


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(
    ("others", "ok"),
    [
        ((), False),
        ((("own", 15.0),), True),
        ((("own", 15.0), ("other", -12.0)), True),
        ((("own", 0.0),), True),
        # against its lane, beside the lanes, half of them
        ((("own", -15.0),), False),
        ((("beside", 15.0),), False),
        ((("own", 15.0), ("own", -15.0)), False),
    ],
)
def test_other_vehicles_tell_whether_the_map_or_the_ego_is_elsewhere(
    hand: str, others: tuple[tuple[str, float], ...], ok: bool
) -> None:
    """The ego drives against the traffic all the time: a map of the wrong hand looks the same, but not to the others."""
    way, t = road(((2000.0, 0.0),), hand=hand), times(25.0)
    beside = {"own": way.own, "other": way.other, "beside": 3 * way.own}
    actors = [moving("ego", way, t, 600 - 12 * t, way.own)]
    for n, (lane, speed) in enumerate(others):
        s = 900 + 100 * n + speed * t
        one = moving(f"o{n}", way, t, s, beside[lane]) if speed else standing(f"o{n}", way, t, 950.0, beside[lane])
        actors.append(one)
    con = derived(drive(actors, way.environment), tables=["registration"])
    (found,) = rows(con, "FROM registration")
    assert found["ok"] is ok
    wrong = {row["verdict"] for row in judged([drive(actors, way.environment)], rules=["ukhc.r143.direction"])}
    assert wrong == ({"fail"} if ok else {"unknown"})


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(
    ("pieces", "well_until", "well_from", "ok"),
    [
        (((1000.0, 0.0),), 90.0, 800.0, True),
        # never, only before, only after, or not for long
        (((1000.0, 0.0),), 0.0, 2000.0, False),
        (((1000.0, 0.0),), 200.0, 2000.0, False),
        (((1000.0, 0.0),), 0.0, 700.0, False),
        (((1000.0, 0.0),), 55.0, 800.0, False),
        # a map that lies to the north of the road fits on the parts that lead north, too
        (((220.0, 0.0), (157.0, 1 / 100), (360.0, 0.0), (157.0, -1 / 100), (300.0, 0.0)), 180.0, 950.0, False),
        # of two roads that cross both fit: it lies right
        (((220.0, 0.0), (157.0, 1 / 100), (300.0, 0.0), (157.0, -1 / 100), (900.0, 0.0)), 500.0, 1500.0, True),
    ],
)
def test_an_ego_that_keeps_to_its_lane_before_and_after_vouches_for_the_map(
    hand: str, pieces: tuple[tuple[float, float], ...], well_until: float, well_from: float, ok: bool
) -> None:
    """Most of the time it is 1.5 m beside the middle of its lane; is that the map or the ego?"""
    way = road(pieces, hand=hand)
    t = times((sum(length for length, _ in pieces) - 60) / 14)
    s = 30 + 14 * t
    d = way.own + np.sign(way.own) * np.where((s < well_until) | (s > well_from), 0.0, 1.5)
    (found,) = rows(
        derived(drive([moving("ego", way, t, s, d)], way.environment), tables=["registration"]), "FROM registration"
    )
    assert found["lateral_median_m"] > 1.2
    assert found["ok"] is ok
    assert ("fits_before_and_after" in found["reason"]) is ok


@pytest.mark.parametrize(
    ("shift", "back", "ok"),
    [(0.0, 210, True), (0.0, 150, True), (1.5, 150, False), (-1.5, 150, False), (0.0, 290, False)],
)
@pytest.mark.parametrize("hand", ["lht", "rht"])
def test_a_short_log_half_of_which_is_an_overtake_fits_the_map(hand: str, shift: float, back: float, ok: bool) -> None:
    """Over the middle from 2 s on for some time; with the map 1.5 m aside, or hardly in its lane at all, it may not fit."""
    way = road(hand=hand)
    t = times(16.0)
    s = 50 + 15 * t
    aside = shift * np.sign(way.own)
    ego = moving("ego", way, t, s, swing(way, s, 65, back, change=30.0, share=0.5) + aside)
    rider = moving("c", way, t, 130 + 3 * t, way.own * 1.6 + aside, kind="bicycle", length=1.8, width=0.6)
    scene = drive([ego, rider], way.environment)
    (found,) = rows(derived(scene, tables=["registration"]), "FROM registration WHERE ego_id = 'ego'")
    assert found["ok"] is ok, found["reason"]
