"""Before whom the ego went through a junction, and when "nobody" may be said."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pytest

from drivelint.reasons.reason_text import sentence
from tests.derive.junction_scenes import ARM, R, cross, star
from tests.scenes import Actor, Road, derived, drive, moving, rows, times

if TYPE_CHECKING:
    from tests.scenes import Row

RELATIONS = ("ahead_going", "from_left", "from_right", "oncoming", "pedestrian")


def going(
    way: Road, *, v: float = 8.0, s0: float = 120.0, end: float = 24.0, name: str = "ego", **more: object
) -> Actor:
    t = times(end)
    return moving(name, way, t, s0 + v * t, way.own, **more)


def answers(*actors: Actor, way: Road, **options: object) -> dict[str, Row]:
    """Return the rows of the first passage by relation."""
    con = derived(drive(actors, way.environment, **options), tables=["passage_conflict"])  # type: ignore[arg-type]
    found = rows(con, "FROM passage_conflict WHERE ego_id = 'ego' AND occurrence = 0 ORDER BY relation")
    assert tuple(row["relation"] for row in found) == RELATIONS
    return {row["relation"]: row | {"reason": row["reason"] and sentence(row["reason"])} for row in found}


def seen(found: dict[str, Row]) -> dict[str, str]:
    return {relation: row["object_id"] for relation, row in found.items() if row["object_id"]}


def test_nobody_is_certain_where_everybody_is_placed() -> None:
    ways = cross()
    far = going(ways["ns"], v=0.01, s0=20.0, name="far")
    for row in answers(going(ways["wn"]), far, way=ways["we"]).values():
        assert (row["object_id"], row["pet_s"], row["decel_mps2"], row["reason"]) == (None, math.inf, 0.0, None)


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(
    ("ego", "other", "relation"),
    [
        ("we", "sn", "from_right"), ("we", "ns", "from_left"), ("nw", "we", None), ("sn", "we", "from_left"),
        ("wn", "ew", "oncoming"), ("ws", "ew", None), ("en", "we", None), ("nw", "sn", None),
        ("se", "we", "from_left"), ("ws", "ns", "from_left"), ("wn", "en", "oncoming"),
    ],
)  # fmt: skip
def test_where_they_came_from(hand: str, ego: str, other: str, relation: str | None) -> None:
    """They come 3 s after the ego. Which of two turns crosses the other's way depends on the side that is driven on."""
    if hand == "lht":
        mirror = str.maketrans("ns", "sn")
        ego, other = ego.translate(mirror), other.translate(mirror)
        relation = {"from_left": "from_right", "from_right": "from_left"}.get(relation or "", relation)
    ways = cross(hand)
    found = answers(going(ways[ego]), going(ways[other], s0=92.0, name="other"), way=ways[ego])
    expected = {relation: "other"} if relation else {}
    assert seen(found) == expected
    for r, row in found.items():
        if r == relation:
            assert 0 < row["pet_s"] < 6
            assert row["reason"] is None
            if (
                relation != "oncoming" or other == "ew"
            ):  # who turns at a constant rate along the line between the lanes is slower in the bend
                assert row["decel_mps2"] == pytest.approx(0, abs=1e-6)


BENT = (180.0, -50.0, 60.0)  # the road leads off by 50 degrees, another one by 60 to the other side


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(
    ("arms", "ego", "other", "relations"),
    [
        (BENT, (1, 3), (2, 1), {"from_right", "oncoming"}),
        ((180.0, -70.0, 80.0), (1, 3), (2, 1), {"from_right", "oncoming"}),
        ((180.0, -62.0, 55.0), (1, 3), (2, 1), {"from_right", "oncoming"}),  # as straight as the ego's own way
        ((180.0, -75.0, 60.0), (1, 3), (2, 1), {"from_right"}),  # the ego keeps to the straighter one
        ((180.0, -60.0, 80.0, 0.0), (1, 3), (2, 1), {"from_right"}),  # there is one straight ahead
        ((180.0, -60.0, 80.0, 0.0), (1, 3), (4, 1), {"oncoming"}),
        ((180.0, -85.0, 95.0), (1, 3), (2, 1), {"from_right"}),  # they lie across
    ],
)
def test_the_road_ahead_may_bend(
    hand: str, arms: tuple[float, ...], ego: tuple[int, int], other: tuple[int, int], relations: set[str]
) -> None:
    """The ego turns across the lanes of those who come by the other arm to the ego's road."""
    if hand == "lht":
        arms = tuple(-a for a in arms)
        relations = {{"from_right": "from_left"}.get(r, r) for r in relations}
    ways = star(hand, arms)
    found = answers(going(ways[ego]), going(ways[other], s0=104.0, name="other"), way=ways[ego])
    assert seen(found) == dict.fromkeys(relations, "other")


def test_who_brakes_on_the_bent_road_ahead() -> None:
    ways = star("rht", BENT)
    t = times(24)
    brakes = moving("other", ways[2, 1], t, np.interp(t, (0, 8, 10, 24), (90, 154, 160, 160)), ways[2, 1].own)
    found = answers(going(ways[1, 3]), brakes, way=ways[1, 3])
    assert {relation for relation, row in found.items() if row["braked_id"]} == {"from_right", "oncoming"}


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(("s0", "pet_s"), [(110.0, (0.0, 1.0)), (103.0, None), (92.0, (2.0, 4.0))])
def test_an_oncoming_one_who_turns_into_the_egos_road_comes_across_it_or_perhaps_follows_it(
    hand: str, s0: float, pet_s: tuple[float, float] | None
) -> None:
    """From 1 s to 2 s behind the ego, whether the other had to wait is not known; 2 s are enough in any case."""
    ways = cross(hand)
    ego, other = ("wn", "en") if hand == "rht" else ("ws", "es")
    row = answers(going(ways[ego]), going(ways[other], s0=s0, name="other"), way=ways["we"])["oncoming"]
    if pet_s is None:
        assert (row["object_id"], row["pet_s"]) == (None, None)
        assert row["reason"].startswith("object other turned into the same road 1.")
    else:
        assert row["object_id"] == "other"
        assert pet_s[0] < row["pet_s"] < pet_s[1]


def test_a_cyclist_along_the_egos_road_goes_on_while_the_ego_turns() -> None:
    """Driving on the right the ego turns right; the cyclist comes up on its right, straight on."""
    ways = cross()
    t = times(24)
    cyclist = moving("c", ways["we"], t, 108 + 8.0 * t, -3.2, kind="bicycle", length=1.8, width=0.6)
    found = answers(going(ways["ws"]), cyclist, way=ways["we"])
    assert seen(found) == {"ahead_going": "c"}
    assert found["ahead_going"]["pet_s"] < 2.0


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize("kind", ["bicycle", "animal", "car"])
@pytest.mark.parametrize(("ahead", "hit"), [(2.5, True), (-1.0, True), (4.5, False), (6.0, False), (15.0, False)])
def test_who_was_there_first_and_is_driven_into(hand: str, kind: str, ahead: float, hit: bool) -> None:
    """It goes straight on beside the ego, its middle so far ahead of the ego's, which turns to its side; 3.3 m ahead, its rear is past."""
    ways = cross(hand)
    ego, side = ("ws", -1) if hand == "rht" else ("wn", 1)
    t = times(24)
    other = moving("c", ways["we"], t, 120 + ahead + 8.0 * t, side * 3.7, kind=kind, length=1.8, width=0.6)
    found = answers(going(ways[ego]), other, way=ways["we"])
    assert seen(found) == ({"ahead_going": "c"} if hit else {})
    if hit:
        assert found["ahead_going"]["pet_s"] < 0


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(("s0", "hit"), [(129.0, True), (138.0, False)])
def test_an_oncoming_one_who_was_there_first(hand: str, s0: float, hit: bool) -> None:
    """The ego turns across it: into its side, or when it is past."""
    ways = cross(hand)
    ego = "wn" if hand == "rht" else "ws"
    found = answers(going(ways[ego], s0=118.0), going(ways["ew"], s0=s0, name="other"), way=ways["we"])
    assert seen(found) == ({"oncoming": "other"} if hit else {})


def walker(y: np.ndarray | float, x: np.ndarray | float, t: np.ndarray, **more: object) -> Actor:
    x, y = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float), t)[:2]
    vx, vy = np.gradient(x, t), np.gradient(y, t)
    given = {"length": 0.5, "width": 0.5, "kind": "pedestrian", **more}
    return Actor("w", t, x, y, np.arctan2(vy, vx), vx, vy, **given)  # type: ignore[arg-type]


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(("before", "counts"), [(3.0, True), (8.0, True), (30.0, False)])
def test_somebody_on_foot_over_the_mouth_of_the_road_turned_out_of(hand: str, before: float, counts: bool) -> None:
    """The walker goes over road 1, `before` metres before the junction, and comes to the ego's way about a second after it."""
    ways = cross(hand)
    t = times(24)
    past = (ARM - before + 3 - 120) / 8
    y = ways["we"].own + (1.2 + 1.4 * (past + 1 - t)) * (-1 if hand == "rht" else 1)
    found = answers(going(ways["wn"]), walker(y, -R - before, t), way=ways["we"])
    assert seen(found) == ({"pedestrian": "w"} if counts else {})
    if counts:
        assert 0 < found["pedestrian"]["pet_s"] < 2


@pytest.mark.parametrize(
    ("kind", "length", "relations"),
    [
        (None, 1.8, {"oncoming", "pedestrian"}),
        ("object", 1.8, {"oncoming", "pedestrian"}),  # a thing that moves
        (None, 4.8, {"oncoming"}),
        ("vehicle", 1.8, {"oncoming"}),
        ("pedestrian", 1.8, {"pedestrian"}),
    ],
)
def test_without_a_class_it_may_be_either(kind: str | None, length: float, relations: set[str]) -> None:
    ways = cross()
    other = going(ways["ew"], s0=92.0, name="o", kind=kind, length=length)
    assert seen(answers(going(ways["wn"]), other, way=ways["we"])) == dict.fromkeys(relations, "o")


def test_somebody_without_a_position_may_be_the_one() -> None:
    """A car that nobody placed leaves the roads open, but not the people on foot; and the other way round."""
    ways = cross()
    other = going(ways["ew"], s0=92.0, name="o")
    lost = other.lost((other.t_s > 8) & (other.t_s < 20))
    found = answers(going(ways["wn"]), lost, way=ways["we"])
    for relation, row in found.items():
        if relation == "pedestrian":
            assert (row["pet_s"], row["reason"]) == (math.inf, None)
        else:
            assert (row["pet_s"], row["decel_mps2"]) == (None, None)
            assert row["reason"] == "actor o has no position, or only an outdated one"
    t = times(24)
    on_foot = walker(R + 3.0, -5 + 1.4 * (t - 9), t)
    found = answers(going(ways["wn"]), on_foot.lost(t > 8), way=ways["we"])
    assert found["pedestrian"]["pet_s"] is None
    assert found["oncoming"]["pet_s"] == math.inf


def test_a_lower_pet_that_was_seen_is_given_with_the_doubt() -> None:
    ways = cross()
    other = going(ways["ew"], s0=98.0, name="o")
    ghost = going(ways["ns"], s0=92.0, name="ghost")
    row = answers(going(ways["wn"]), other, ghost.lost(ghost.t_s > 6), way=ways["we"])["oncoming"]
    assert row["object_id"] == "o"
    assert row["pet_s"] > 0
    assert row["reason"] == "actor ghost is no longer recorded"


@pytest.mark.ci
def test_the_log_must_go_on_for_a_while() -> None:
    """The rear leaves the junction at 11.4 s."""
    ways = cross()
    assert answers(going(ways["wn"], end=15.6), way=ways["we"])["oncoming"]["pet_s"] == math.inf
    row = answers(going(ways["wn"], end=15.0), way=ways["we"])["oncoming"]
    assert (row["pet_s"], row["reason"]) == (None, "the log ends too soon after the junction")
    row = answers(going(ways["wn"], end=10.0), way=ways["we"])["oncoming"]
    assert (row["pet_s"], row["reason"]) == (None, "the log, or its part before a hole, ends in the junction")
    row = answers(going(ways["wn"], s0=190.0), way=ways["we"])["oncoming"]
    assert (row["pet_s"], row["reason"]) == (None, "the log, or its part after a hole, begins in the junction")
    ego = going(ways["wn"])
    row = answers(ego.keep((ego.t_s < 12.5) | (ego.t_s > 13.5)), way=ways["we"])["oncoming"]
    assert (row["pet_s"], row["reason"]) == (None, "there is a hole in the log soon after the junction")


def test_every_ego_and_drive_for_itself() -> None:
    ways = cross()
    a, b = going(ways["wn"]), going(ways["ew"], s0=92.0, name="other")
    one = drive([a, b], ways["we"].environment, egos=("ego", "other"))
    two = drive([a], ways["we"].environment, drive_id="e")
    con = derived(one, two, tables=["passage_conflict"])
    found = rows(con, "FROM passage_conflict WHERE object_id IS NOT NULL")
    assert [(r["drive_id"], r["ego_id"], r["relation"], r["object_id"]) for r in found] == [
        ("d", "ego", "oncoming", "other")
    ]
    assert rows(con, "SELECT count(*) AS n FROM passage_conflict") == [{"n": 15}]
