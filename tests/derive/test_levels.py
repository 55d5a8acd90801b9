"""Roads over each other: heights where they are recorded, and what the map tells where they are not."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.derive.bridge_scenes import bridge, lifted
from tests.scenes import derived, drive, moving, rows, standing, times, verdict_rows

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive
    from tests.scenes import Row

HANDS = pytest.mark.parametrize("hand", ["lht", "rht"])
CRASH = "ukhc.no-collision"


def crossing(hand: str, rise_m: float | None = None) -> Drive:
    """Return the ego on the lower road at 15 m/s and a car that crosses over it in the very moment, 300 m on."""
    low, high = bridge(hand, rise_m)
    t = times(12.0)
    ego = moving("ego", low, t, 300 - 15 * (6.0 - t), low.ego_d)
    over = moving("over", high, t, 200 + 15 * (t - 6.0), high.ego_d)
    return drive([ego, over], low.environment)


def rows_of(scene: Drive, *rules: str) -> list[Row]:
    return verdict_rows([scene], rules=rules)


def verdicts(scene: Drive, *rules: str) -> set[str]:
    return {row["verdict"] for row in rows_of(scene, *rules)}


@pytest.mark.ci
@HANDS
def test_a_car_on_the_bridge_is_no_collision(hand: str) -> None:
    """By height, by the map's heights, or by a map that does not say."""
    by_height = lifted(crossing(hand), {"ego": 0.0, "over": 6.0})
    for scene in (by_height, crossing(hand, 6.0), crossing(hand)):
        assert verdicts(scene, CRASH) == {"unknown"}
        found = rows(derived(scene, tables=["pair", "conflict"]), "FROM pair WHERE off_level ORDER BY t_ns")
        assert all(row["x_m"] is None and row["s_m"] is None and (row["clearance_m"] or 1) > 0 for row in found)
        assert any(row["clearance_m"] is None for row in found)
        # over the running lane and one lane's width to each side: 10.5 m and its length at 15 m/s
        assert 0.8 <= len(found) / 10 <= 1.4
        assert not rows(derived(scene, tables=["conflict"]), "FROM conflict")


@pytest.mark.ci
@HANDS
def test_on_one_level_it_is_one(hand: str) -> None:
    """The log's heights are the same, or the map's: there is a crossing without a junction."""
    level = lifted(crossing(hand), {"ego": 0.0, "over": 0.8}, slope=0.001)
    for scene in (level, crossing(hand, 0.0)):
        assert verdicts(scene, CRASH) == {"fail"}
        assert rows(derived(scene, tables=["conflict"]), "FROM conflict")


@pytest.mark.ci
@HANDS
def test_without_heights_nothing_more_passes(hand: str) -> None:
    """The law: heights taken away, no pass appears; nobody is taken for one who is not there."""
    low, high = bridge(hand)
    t = times(12.0)
    ego = moving("ego", low, t, 210 + 15 * t, low.ego_d)
    others = [
        moving("over", high, t, 110 + 15 * t, high.ego_d),
        moving("back", high, t, 320 - 15 * t, high.oncoming_d),
        moving("lead", low, t, 260 + 14 * t, low.ego_d),
        moving("met", low, t, 580 - 15 * t, low.oncoming_d),
        standing("stands", high, t, 200 + low.ego_d, high.ego_d),
        standing("beside", high, t, 200 - high.ego_d, high.ego_d),
    ]
    scene = drive([ego, *others], low.environment)
    known = lifted(
        scene,
        {a.actor_id: 6.0 if a.actor_id in {"over", "back", "stands", "beside"} else 0.0 for a in (ego, *others)},
        1e-4,
    )

    def passed(scene: Drive) -> dict[tuple[object, ...], list[tuple[int, int]]]:
        found: dict[tuple[object, ...], list[tuple[int, int]]] = {}
        for r in verdict_rows([scene], rules=["ukhc", "criticality", "rss", "stvo"]):
            if r["verdict"] == "pass":
                of = (r["rule_id"], r["profile"], r["object_id"])
                found.setdefault(of, []).append((r["t_start_ns"], r["t_end_ns"]))
        return found

    before, after = passed(known), passed(scene)
    assert before
    met: dict[object, list[int]] = {}
    for row in rows(derived(known, tables=["pair"]), "SELECT object_id, t_ns FROM pair"):
        met.setdefault(row["object_id"], []).append(row["t_ns"])
    new = [
        (of, begin, end)
        for of, spans in after.items()
        for begin, end in spans
        # an actor that the heights put on another level has no verdict at those steps
        for t_ns in ([at for at in met.get(of[2], []) if begin <= at <= end] if of[2] else [begin, end])
        if not any(first <= t_ns <= last for first, last in before.get(of, ()))
    ]
    assert new == []
