"""What belongs to the ego: the trailer that it draws, the id under which its track goes on; and who does not, however close."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.derive.junction_scenes import cross, crosswalk
from tests.derive.trailer_scene import trailer_behind
from tests.scenes import Actor, Road, derived, drive, moving, road, rows, standing, times, verdict_rows

if TYPE_CHECKING:
    import duckdb
    from numpy.typing import NDArray

    from drivelint.engine.batch import Drive

HANDS = pytest.mark.parametrize("hand", ["lht", "rht"])
CRASH = "ukhc.no-collision"
BEND = ((150.0, 0.0), (60.0, 1 / 40), (300.0, 0.0))


def parts(scene: Drive) -> dict[str, str]:
    con = derived(scene, tables=["_ego_part"])
    return {row["object_id"]: row["part"] for row in rows(con, "FROM _ego_part")}


def there(con: duckdb.DuckDBPyConnection) -> set[str]:
    return {row["object_id"] for row in rows(con, "SELECT DISTINCT object_id FROM pair")}


@pytest.mark.parametrize(("hitch", "length"), [(0.5, 6.0), (1.2, 4.0), (-1.0, 12.0)])
@pytest.mark.parametrize("kind", ["trailer", None])
@HANDS
def test_the_trailer_is_the_ego(hand: str, kind: str | None, hitch: float, length: float) -> None:
    """Round a bend of 40 m: behind a drawbar, and over a fifth wheel, where the boxes overlap."""
    way = road(BEND, hand)
    t = times(20.0)
    ego = moving("ego", way, t, 40 + 10 * t, way.ego_d, length=6.0, width=2.4)
    scene = drive([ego, trailer_behind("t", ego, hitch, length, kind=kind)], way.environment)
    touches = hitch < 0
    if kind == "trailer" or touches:
        assert parts(scene) == {"t": "trailer"}
        con = derived(scene, tables=["pair", "conflict", "ego_state", "unplaced"])
        assert not rows(con, "FROM pair")
        assert not rows(con, "FROM conflict")
        for row in rows(con, "FROM ego_state"):
            assert row["combination_m"] == pytest.approx(6 + length + 2 * hitch, abs=0.4)
            assert row["front_s_m"] - row["rear_s_m"] == pytest.approx(row["combination_m"], abs=0.5)
        assert {row["verdict"] for row in verdict_rows([scene], rules=[CRASH])} == {"not_applicable"}
    else:
        assert parts(scene) == {}


@pytest.mark.ci
@HANDS
def test_the_trailer_s_box_is_the_ego_s(hand: str) -> None:
    """Who stands in its way is struck though the ego is past, and the ego's rear is the trailer's."""
    way = road(((600.0, 0.0),), hand)
    t = times(10.0)
    ego = moving("ego", way, t, 100 + 10 * t, way.ego_d)
    behind = moving("behind", way, t, 60 + 10 * t, way.ego_d)
    wide = replace(trailer_behind("t", ego, kind="trailer"), width=3.0)
    beside = standing("beside", way, t, 150, way.ego_d + 2.2, width=1.6)
    scene = drive([ego, wide, behind, beside], way.environment)
    con = derived(scene, tables=["pair", "ego_state"])
    assert there(con) == {"behind", "beside"}
    gap = "SELECT e.rear_s_m - p.front_s_m AS gap_m FROM pair p JOIN ego_state e USING (drive_id, ego_id, t_ns)"
    assert {round(r["gap_m"], 1) for r in rows(con, f"{gap} WHERE object_id = 'behind'")} == {28.2}
    found = {row["object_id"]: row["verdict"] for row in verdict_rows([scene], rules=[CRASH])}
    assert found == {"behind": "pass", "beside": "fail"}
    # while the trailer is not placed, nobody knows
    lost = drive([ego, wide.without_position((t > 4) & (t < 6)), behind, beside], way.environment)
    found = {row["object_id"]: row["verdict"] for row in verdict_rows([lost], rules=[CRASH])}
    assert found["behind"] == "unknown"


@pytest.mark.parametrize("unseen", [False, True])
@HANDS
def test_its_rear_is_past_a_mark_when_the_trailer_s_is(hand: str, unseen: bool) -> None:
    """A crossing at 100 m, 3 m wide, and a junction from 185 to 215 m: the ego's rear is 2.4 m behind its middle, the trailer's 9.4 m."""
    way = cross(hand, (), (("1", crosswalk("walk", 100.0)),))["we"]
    t = times(24.0)
    ego = moving("ego", way, t, 60 + 8 * t, way.ego_d)
    trailer = trailer_behind("t", ego, kind="trailer")
    if unseen:
        trailer = trailer.without_position((t > 5) & (t < 20.5))
    for parts_, reach in (([ego], 2.4), ([ego, trailer], 9.4)):
        con = derived(drive(parts_, way.environment), tables=["crossing_passage", "junction_passage"])
        (over,) = rows(con, "FROM crossing_passage")
        (through,) = rows(con, "FROM junction_passage")
        assert over["t_in_ns"] / 1e9 == pytest.approx((100 - 2.4 - 60) / 8, abs=0.11)
        assert over["t_out_ns"] / 1e9 == pytest.approx((103 + reach - 60) / 8, abs=0.11)
        assert through["t_in_ns"] / 1e9 == pytest.approx((185 - 2.4 - 60) / 8, abs=0.11)
        assert through["t_out_ns"] / 1e9 == pytest.approx((215 + reach - 60) / 8, abs=0.11)


# ---- ids


def renamed(way: Road, at: NDArray[np.float64], early: NDArray[np.bool_], late: NDArray[np.bool_]) -> list[Actor]:
    """Return one vehicle under two ids: in the samples of the one mask, and in those of the other."""
    whole = moving("ego", way, at, 50 + 18 * at, way.ego_d)
    return [whole.keep(early), replace(whole.keep(late), actor_id="next")]


@pytest.mark.ci
@pytest.mark.parametrize("overlap", [-1, 0, 1, 2])
@pytest.mark.parametrize("ego", ["ego", "next"])
@HANDS
def test_the_ego_under_another_id_is_no_collision(hand: str, ego: str, overlap: int) -> None:
    """The tracks share samples, or there is a sample between them: seen from either of the two."""
    way = road(((600.0, 0.0),), hand)
    t = times(12.0)
    k = np.arange(len(t))
    both = [*renamed(way, t, k < 60, k >= 60 - overlap), moving("other", way, t, 520 - 15 * t, way.oncoming_d)]
    scene = drive(both, way.environment, egos=[ego])
    assert parts(scene) == {("next" if ego == "ego" else "ego"): "successor" if ego == "ego" else "predecessor"}
    con = derived(scene, tables=["pair", "conflict", "lost_object", "unplaced"])
    assert there(con) == {"other"}
    assert not rows(con, "FROM conflict")
    assert {row["object_id"] for row in verdict_rows([scene], rules=[CRASH])} <= {"other"}
    assert "fail" not in {row["verdict"] for row in verdict_rows([scene], rules=[CRASH])}
