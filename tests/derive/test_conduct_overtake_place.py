"""Where an overtake begins and ends, and who comes up from behind when it begins."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests.derive.marked import marked
from tests.formats.opendrive import xodr
from tests.scenes import (
    Actor,
    Road,
    derived,
    drive,
    limited,
    linked,
    moving,
    plan,
    road,
    rows,
    standing,
    swing,
    tee,
    times,
)

HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])
ROW = dict[str, Any]


def place(way: Road, *actors: Actor, egos: tuple[str, ...] = ("ego",)) -> list[ROW]:
    con = derived(drive(actors, way.environment, egos=egos), tables=["overtake_place"])
    return rows(con, "FROM overtake_place ORDER BY ego_id, occurrence")


def scene(
    way: Road, start: float = 50.0, out: float = 100.0, back: float = 220.0, end: float = 25.0
) -> tuple[Actor, Actor]:
    """Return an ego that overtakes a car parked at 160 m, at 12 m/s."""
    t = times(end)
    s = start + 12 * t
    return moving("ego", way, t, s, swing(way, s, out, back)), standing("vbp", way, t, 160, way.own)


@HANDS
def test_nobody_behind_and_nothing_ahead(hand: str) -> None:
    (found,) = place(road(hand=hand), *scene(road(hand=hand)))
    assert (found["junction_m"], found["crossing_m"]) == (math.inf, math.inf)
    assert (found["rear_id"], found["rear_gap_m"], found["rear_ttc_s"], found["rear_known"]) == (
        None,
        None,
        math.inf,
        True,
    )
    assert (found["marking_out"], found["marking_back"], found["no_overtaking"]) == (None, None, None)


REAR = [
    ("overtaking lane, faster", 70.0, 20.0, 1.0, 0.0, True),
    ("alongside in it", 96.0, 12.0, 1.0, 0.0, True),
    ("own lane", 70.0, 20.0, 0.0, 0.0, False),
    ("own lane, pulling out", 70.0, 20.0, 0.1, 0.5, True),
]


@HANDS
@pytest.mark.parametrize(("what", "at", "speed", "over", "drift", "counts"), REAR)
def test_who_comes_up_from_behind(  # noqa: PLR0917
    hand: str, what: str, at: float, speed: float, over: float, drift: float, counts: bool
) -> None:
    """`at`: where it is when the ego is about to go out, at 101 m; `over`: share of a lane towards the overtaking one."""
    way = road(hand=hand)
    ego, vbp = scene(way)
    con = derived(drive([ego, vbp], way.environment), tables=["overtake"])
    t0 = rows(con, "FROM overtake")[0]["t0_ns"] / 1e9
    front = 50 + 12 * t0 + 2.4
    t = ego.t_s
    d = way.own + (way.other - way.own) * over + np.sign(way.other) * drift * (t - t0)
    other = moving("r", way, t, at + speed * (t - t0), d)
    (found,) = place(way, ego, vbp, other)
    assert found["rear_id"] == ("r" if counts else None), what
    if counts:
        gap = front - 4.8 - (at + 2.4)
        assert found["rear_gap_m"] == pytest.approx(gap, abs=0.3)  # a box that turns reaches further
        ttc = 0.0 if gap < 0 else gap / (speed - 12) if speed > 12 else math.inf
        assert found["rear_ttc_s"] == pytest.approx(ttc, rel=0.05)


@HANDS
@pytest.mark.parametrize(("speed", "counts"), [(20.0, True), (8.0, False)])
def test_a_narrow_one_beside_the_ego_in_its_own_lane(hand: str, speed: float, counts: bool) -> None:
    """Its middle 0.8 m ahead, it moves over at 0.5 m/s: a faster one overtakes the ego, a slower one is passed."""
    way = road(hand=hand)
    ego, vbp = scene(way)
    t0 = rows(derived(drive([ego, vbp], way.environment), tables=["overtake"]), "FROM overtake")[0]["t0_ns"] / 1e9
    t = ego.t_s
    s = 50 + 12 * t0 + 0.8 + speed * (t - t0)
    d = way.own * 1.3 + np.sign(way.other) * 0.5 * (t - t0)
    rider = moving("r", way, t, s, d, kind="motorcycle", length=2.2, width=0.8)
    (found, *_) = place(way, ego, vbp, rider)
    assert found["rear_id"] == ("r" if counts else None)


def test_who_may_come_is_not_ruled_out() -> None:
    way = road()
    ego, vbp = scene(way)
    other = moving("r", way, ego.t_s, 40 + 12 * ego.t_s, way.own)
    (found,) = place(way, ego, vbp, other)
    assert (found["rear_id"], found["rear_known"]) == (None, True)
    (found,) = place(way, ego, vbp, other.lost(ego.t_s > 3.0))
    assert (found["rear_id"], found["rear_known"]) == (None, False)


@pytest.mark.ci
@HANDS
def test_the_junction_ahead(hand: str) -> None:
    """The tee's junction begins at 200 m; the ego's front is at 102 m or so when it goes out."""
    way = tee(hand)["straight"]
    ego, vbp = scene(way)
    (found,) = place(way, ego, vbp)
    con = derived(drive([ego, vbp], way.environment), tables=["overtake"])
    t0 = rows(con, "FROM overtake")[0]["t0_ns"] / 1e9
    assert found["junction_m"] == pytest.approx(200 - (50 + 12 * t0 + 2.4), abs=0.2)
    t = ego.t_s
    s = 150 + 12 * t
    late = moving("ego", way, t, s, swing(way, s, 200, 300))
    (found,) = place(way, late, standing("vbp", way, t, 250, way.own))
    assert -20 < found["junction_m"] < 0  # inside it


def signed(signs: str, kind: str = "") -> Road:
    """Return 600 m of road with these signals and objects."""
    text = xodr.xodr(
        xodr.road(
            geometry=plan(((600.0, 0.0),)), lanes=xodr.section(0, linked(1), linked(-1)), length=600.0, attributes='rule="RHT"',
            more=limited(60),
        ).replace("</road>", f"<objects>{kind}</objects><signals>{signs}</signals></road>")
    )  # fmt: skip
    return Road(load_map(MapSource(f"signed-{len(signs)}-{len(kind)}.xodr", text.encode())), ((600.0, 0.0),))


def sign(s: float, code: str, number: int = 1) -> str:
    return (
        f'<signal s="{s}" t="-4" id="{number}" name="" dynamic="no" orientation="+" country="DE" type="{code}" subtype="" '
        'value="-1" zOffset="2"/>'
    )


@pytest.mark.sample(0, ci=3)
@pytest.mark.parametrize(
    ("signs", "holds"),
    [
        (sign(40, "276"), True),
        (sign(140, "276"), True),  # the ego comes to it before it draws level with the vehicle that it passes
        (sign(160, "276"), None),  # level by then; another may stand before the map begins
        (sign(60, "280") + sign(140, "276", 2), True),
        (sign(60, "280") + sign(160, "276", 2), False),
        (sign(60, "276") + sign(140, "280", 2), True),  # out before it ends
        (sign(20, "276") + sign(60, "280", 2), False),  # its end is said
        (sign(20, "280") + sign(60, "276", 2), True),
        (sign(20, "274"), None),  # no such sign anywhere
    ],
)
def test_a_sign_that_forbids_it(signs: str, holds: bool | None) -> None:
    way = signed(signs)
    (found,) = place(way, *scene(way))
    assert found["no_overtaking"] is holds


@pytest.mark.ci
@HANDS
def test_the_line_that_is_crossed_out_and_back(hand: str) -> None:
    """Of a double line the one nearer to where the ego is: out of its own lane it is the one, back the other."""
    for centre in ("solid", "broken", "solid broken"):
        way = marked(hand, centre)
        (found,) = place(way, *scene(way))
        if centre == "solid broken":
            # named from left to right; in right-hand traffic the ego comes from the right of it
            out, back = ("broken_solid", "solid_broken") if hand == "rht" else ("solid_broken", "broken_solid")
            assert (found["marking_out"], found["marking_back"]) == (out, back)
        else:
            assert (found["marking_out"], found["marking_back"]) == (centre, centre)
    ego, vbp = scene(marked(hand, "solid"))
    (found,) = place(marked(hand, "solid"), ego.keep(ego.t_s < 12), vbp.keep(ego.t_s < 12))
    assert (found["marking_out"], found["marking_back"]) == ("solid", None)  # never seen to come back


def test_each_ego_has_its_own() -> None:
    way = road()
    t = times(25.0)
    egos = [
        moving(name, way, t, start + 12 * t, swing(way, start + 12 * t, 100, 220))
        for name, start in (("a", 80), ("b", 10))
    ]
    found = place(way, *egos, standing("vbp", way, t, 160, way.own), egos=("a", "b"))
    assert {(row["ego_id"], row["rear_id"]) for row in found} == {("a", None), ("b", None)}
    assert len(found) == 2
