"""Before whom the ego went through a junction, and when "nobody" may be said."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from drivelint.reasons.reason_text import sentence
from tests.derive.junction_scenes import cross
from tests.scenes import Actor, Road, derived, drive, moving, rows, times

if TYPE_CHECKING:
    from tests.scenes import Row

RELATIONS = ("ahead_going", "from_left", "from_right", "oncoming", "pedestrian")


def going(way: Road, *, s0: float = 120.0, name: str = "ego") -> Actor:
    t = times(24.0)
    return moving(name, way, t, s0 + 8.0 * t, way.ego_d)


def answers(*actors: Actor, way: Road) -> dict[str, Row]:
    """Return the rows of the first passage by relation."""
    con = derived(drive(actors, way.environment), tables=["passage_conflict"])
    found = rows(con, "FROM passage_conflict WHERE ego_id = 'ego' AND occurrence = 0 ORDER BY relation")
    assert tuple(row["relation"] for row in found) == RELATIONS
    return {row["relation"]: row | {"reason": row["reason"] and sentence(row["reason"])} for row in found}


def object_ids(row_by_relation: dict[str, Row]) -> dict[str, str]:
    return {relation: row["object_id"] for relation, row in row_by_relation.items() if row["object_id"]}


@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize(
    ("ego_way", "other_way", "relation"),
    [
        ("we", "sn", "from_right"), ("we", "ns", "from_left"), ("nw", "we", None), ("sn", "we", "from_left"),
        ("wn", "ew", "oncoming"), ("ws", "ew", None), ("en", "we", None), ("nw", "sn", None),
        ("se", "we", "from_left"), ("ws", "ns", "from_left"), ("wn", "en", "oncoming"),
    ],
)  # fmt: skip
def test_where_they_came_from(hand: str, ego_way: str, other_way: str, relation: str | None) -> None:
    """They come 3 s after the ego. Which of two turns crosses the other's way depends on the side that is driven on."""
    if hand == "lht":
        mirror = str.maketrans("ns", "sn")
        ego_way, other_way = ego_way.translate(mirror), other_way.translate(mirror)
        relation = {"from_left": "from_right", "from_right": "from_left"}.get(relation or "", relation)
    ways = cross(hand)
    found = answers(going(ways[ego_way]), going(ways[other_way], s0=92.0, name="other"), way=ways[ego_way])
    expected = {relation: "other"} if relation else {}
    assert object_ids(found) == expected
    for r, row in found.items():
        if r == relation:
            assert 0 < row["pet_s"] < 6
            assert row["reason"] is None
            if (
                relation != "oncoming" or other_way == "ew"
            ):  # who turns at a constant rate along the line between the lanes is slower in the bend
                assert row["decel_mps2"] == pytest.approx(0, abs=1e-6)
