"""Pedestrian crossings: who is on them, and the ego's ways over them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.derive.junction_scenes import cross, crosswalk, signal
from tests.scenes import Actor, Road, derived, drive, moving, rows, seconds, swing, times

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive
    from tests.scenes import Row

SIDE = {"rht": -1, "lht": 1}  # of the ego's half, along road 1
X = -200 + 100  # the crossing begins here and is 3 m wide


def zebra(hand: str = "rht", said: str = "zebra", lights: tuple[tuple[str, str], ...] = ()) -> Road:
    """Return the way from west to east with a crossing at s = 100 of road 1."""
    return cross(hand, lights, (("1", crosswalk("x", 100.0, said=said)),))["we"]


def going(way: Road, *, v: float = 8.0, s0: float = 20.0, end: float = 14.0, name: str = "ego") -> Actor:
    """The front is at s0 + 2.4 + 8 t: on the crossing at 9.7 s, the rear past it at 10.675 s."""
    t = times(end)
    return moving(name, way, t, s0 + v * t, way.own)


def walker(name: str, t: np.ndarray, y: np.ndarray | float, x: float = X + 1.5, **more: object) -> Actor:
    y = np.broadcast_to(np.asarray(y, float), t.shape).copy()
    vy = np.gradient(y, t)
    given = {"length": 0.5, "width": 0.5, "kind": "pedestrian", **more}
    return Actor(name, t, np.full(t.shape, x), y, np.where(vy < 0, -1.0, 1.0) * np.pi / 2, 0 * t, vy, **given)  # type: ignore[arg-type]


def passages(told: Drive) -> list[Row]:
    con = derived(told, tables=["crossing_passage"])
    return rows(con, "FROM crossing_passage ORDER BY drive_id, ego_id, occurrence")


@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_on_it_half_by_half(hand: str) -> None:
    """Walks from y = -6 to +6 at 1.2 m/s: at y = -3.5 after 2.1 s, at 0 after 5 s, at 3.5 after 7.9 s."""
    way = zebra(hand)
    t = times(14)
    con = derived(drive([going(way), walker("w", t, -6 + 1.2 * t)], way.environment), tables=["_crossing_occupancy"])
    found = rows(con, "FROM _crossing_occupancy ORDER BY t_from_ns")
    assert [(r["crossing_id"], r["object_id"]) for r in found] == [("x", "w")] * 2
    south, north = (
        (1, -1) if hand == "rht" else (-1, 1)
    )  # driven on the right the lane in the south leads east, along the line
    assert [r["along_road"] for r in found] == [south, north]
    assert seconds(found, "t_from_ns") == [pytest.approx(2.1, abs=0.1), pytest.approx(5.0, abs=0.1)]
    assert seconds(found, "t_to_ns") == [pytest.approx(5.0, abs=0.1), pytest.approx(7.9, abs=0.1)]


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(("said", "kind"), [("zebra", "zebra"), ("signalised", "signalled"), ("", None)])
def test_going_over_an_empty_one(hand: str, said: str, kind: str | None) -> None:
    way = zebra(hand, said)
    (row,) = passages(drive([going(way)], way.environment))
    assert (row["crossing_id"], row["kind"], row["occurrence"]) == ("x", kind, 0)
    assert seconds([row], "t_in_ns") == [pytest.approx(9.7)]
    assert seconds([row], "t_out_ns") == [pytest.approx(10.7)]
    assert (row["on_id"], row["t_on_ns"], row["waiting_id"], row["known"]) == (None, None, None, True)
    assert (row["signal_id"], row["state"], row["stood_before"]) == (None, None, False)


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(
    ("half", "since", "on"), [(1, 9.0, True), (1, 10.0, True), (1, 11.5, False), (-1, 9.0, False), (1, 8.0, False)]
)
def test_somebody_on_the_egos_half(hand: str, half: int, since: float, on: bool) -> None:
    """Steps from the kerb onto the ego's half (or the other one) at `since` and stays there for a second."""
    way = zebra(hand)
    t = times(14)
    y = np.where((t >= since) & (t < since + 1), 3.0, 4.5) * SIDE[hand] * half
    (row,) = passages(drive([going(way), walker("w", t, y)], way.environment))
    assert row["on_id"] == ("w" if on else None)
    if on:
        assert seconds([row], "t_on_ns") == [pytest.approx(since)]
    assert row["known"] is True


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(
    ("out", "v", "comes", "known"),
    [
        (-1.0, 1.2, True, True),  # a metre beyond the middle as the ego's front comes, and on to its half
        (-1.0, -1.2, False, True),  # the same, but from the ego's half
        (-3.0, -1.2, False, True),  # from the ego's half, and gone again
        (-2.0, -0.1, False, False),  # on the other half to the end of the log
        (-4.5, 1.2, False, True),  # still beyond the other half
    ],
)
def test_somebody_on_the_other_half(hand: str, out: float, v: float, comes: bool, known: bool) -> None:
    """Walks so that it is `out` metres on the ego's side of the middle at 9.7 s, towards that side at `v`."""
    way = zebra(hand)
    t = times(14)
    (row,) = passages(drive([going(way), walker("w", t, SIDE[hand] * (out + v * (t - 9.7)))], way.environment))
    assert (row["coming_id"], row["coming_known"]) == ("w" if comes else None, known)


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(
    ("off", "on", "known"),
    [
        (0.0, None, True),
        (0.85, None, True),  # its side at the middle line
        (0.95, None, False),
        (2.0, "w", True),  # its middle on the other half
        (3.5, "w", True),
    ],
)
def test_the_ego_on_the_other_half(hand: str, off: float, on: str | None, known: bool) -> None:
    """It goes over the crossing `off` metres nearer to the other half, where somebody who came from the ego's walks off."""
    way = zebra(hand)
    t = times(14)
    s = 20 + 8 * t
    ego = moving("ego", way, t, s, swing(way, s, 40.0, None, share=off / 3.5))
    leaves = walker("w", t, SIDE[hand] * (-2.5 - 1.2 * (t - 9.7)))
    (row,) = passages(drive([ego, leaves], way.environment))
    assert (row["on_id"], row["coming_id"]) == (on, None)
    assert row["coming_known"] is (known and on is None)
    (row,) = passages(drive([ego], way.environment))
    assert (row["on_id"], row["coming_known"], row["known"]) == (None, True, True)


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(("out", "on"), [(60.0, "w"), (103.0, None)])
def test_the_other_half_counts_while_its_middle_is_not_past(hand: str, out: float, on: str | None) -> None:
    """It moves over before the crossing, or as its rear is on it still: from 100 to 103 m."""
    way = zebra(hand)
    t = times(14)
    s = 20 + 8 * t
    ego = moving("ego", way, t, s, swing(way, s, out, None, 12.0))
    leaves = walker("w", t, SIDE[hand] * (-2.5 - 1.2 * (t - 9.7)))
    (row,) = passages(drive([ego, leaves], way.environment))
    assert (row["on_id"], row["coming_known"]) == (on, on is None)


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(
    ("y", "x", "waits"), [(4.5, X + 1.5, True), (5.4, X + 1.5, True), (5.6, X + 1.5, False), (4.5, X - 1.5, True),
        (4.5, X - 3, False), (-4.5, X + 1.5, False)]
)  # fmt: skip
def test_somebody_waits_at_its_end(hand: str, y: float, x: float, waits: bool) -> None:
    way = zebra(hand)
    (row,) = passages(drive([going(way), walker("w", times(14), y * SIDE[hand], x)], way.environment))
    assert row["waiting_id"] == ("w" if waits else None)


@pytest.mark.ci
def test_somebody_who_cannot_be_placed() -> None:
    way = zebra()
    t = times(14)
    w = walker("w", t, -6.0)
    # the window is from 7.7 to 10.7 s; a position moved on for a quarter of a second is still one
    for hidden, known in (
        (t > 9, False),
        (t < 8, False),
        ((t > 9) & (t < 9.5), False),
        (t < 7.6, True),
        (t > 11, True),
    ):
        (row,) = passages(drive([going(way), w.lost(hidden)], way.environment))
        assert row["known"] is known
    far = walker("w", t, -60.0)
    (row,) = passages(drive([going(way), far.lost((t > 9) & (t < 10))], way.environment))
    assert row["known"] is True
    (row,) = passages(drive([going(way), walker("car", t, -6.0, kind="car").lost(t > 9)], way.environment))
    assert row["known"] is True
    (row,) = passages(drive([going(way), walker("w", t, -1.75, kind=None)], way.environment))
    assert (row["known"], row["on_id"]) == (False, None)


def backing(way: Road, *points: tuple[float, float], end: float = 40.0) -> Actor:
    """Return the ego at these (time, s of its centre), heading along the road all the while; crossing at s = 100 to 103."""
    t = times(end)
    whole = moving("ego", way, t, np.interp(t, *np.array(points).T), way.own)
    return replace(whole, yaw=np.full(t.shape, way.at(0.0)[2]))


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize("through", [False, True])
def test_reversing_onto_it(hand: str, through: bool) -> None:
    """It drives over it, stops with its rear 5 m past it and comes back at 2 m/s: at 17.5 s its rear is over the far edge again."""
    way = zebra(hand)
    stays = ((20.0, 100.4), (28.0, 100.4), (33.0, 120.0), (40.0, 120.0))
    ego = backing(way, (0, 22.4), (11, 110.4), (15, 110.4), *(((26.0, 88.4), (40.0, 88.4)) if through else stays))
    on = walker("w", ego.t_s, SIDE[hand] * np.where((ego.t_s > 16) & (ego.t_s < 19), 2.0, 6.0))
    one, two = passages(drive([ego, on], way.environment))
    assert (one["on_id"], two["on_id"]) == (None, "w")
    assert seconds([two], "t_in_ns") == [pytest.approx(17.5, abs=0.11)]
    # its front back before the near edge, or its rear past the far one once more
    assert seconds([two], "t_out_ns") == [pytest.approx(21.4 if through else 29.3, abs=0.2)]
    assert two["stood_before"] is None
    assert (one["known"], two["known"], two["occurrence"]) == (True, True, 1)


def test_reversing_over_it_and_going_over_it_again_is_three_passages() -> None:
    way = zebra()
    ego = backing(way, (0, 22.4), (11, 110.4), (15, 110.4), (26, 88.4), (28, 88.4), (34, 130.4), (40, 130.4))
    assert len(passages(drive([ego], way.environment))) == 3


def test_a_light_past_the_junction_is_not_that_of_a_crossing_at_its_beginning() -> None:
    way = cross("rht", (("2", signal("next", 1.0, "1000001")),), (("10", crosswalk("x", 2.0)),))["we"]
    (row,) = passages(drive([going(way, s0=120.0)], way.environment))
    assert (row["kind"], row["signal_id"]) == (None, None)
    way = cross("rht", (("10", signal("own", 29.0, "1000001")),), (("10", crosswalk("x", 2.0)),))["we"]
    (row,) = passages(drive([going(way, s0=120.0)], way.environment))
    assert (row["kind"], row["signal_id"]) == ("signalled", "own")


def test_each_ego_and_drive_for_itself() -> None:
    way = zebra()
    t = times(14)
    on = walker("w", t, np.where(t > 8, -3.0, -4.5))
    one = drive([going(way), going(way, s0=0.0, name="other"), on], way.environment, egos=("ego", "other"))
    two = drive([going(way)], way.environment, drive_id="e")
    con = derived(one, two, tables=["crossing_passage"])
    found = rows(con, "FROM crossing_passage ORDER BY drive_id, ego_id")
    assert [(r["drive_id"], r["ego_id"], r["on_id"], r["waiting_id"]) for r in found] == [
        ("d", "ego", "w", None), ("d", "other", "w", None), ("e", "ego", None, None),
    ]  # fmt: skip
