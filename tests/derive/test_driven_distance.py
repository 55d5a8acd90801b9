"""What an overtake that was broken off really took, however long the log goes on; and who is beside the ego, not ahead."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from drivelint.reasons.reason_text import sentence
from tests.derive.overtake_scene import crash
from tests.scenes import Actor, Road, derived, drive, moving, road, rows, swing, times


def as_driven(actors: list[Actor], way: Road) -> dict[str, Any]:
    con = derived(drive(actors, way.environment), tables=["overtake_sda"])
    (row,) = rows(con, "FROM overtake_sda WHERE profile = 'observed'")
    return row


@pytest.mark.ci
@pytest.mark.parametrize("lost", [False, True])
def test_what_was_driven_ends_where_both_stand(lost: bool) -> None:
    """Both stand from 19.2 s on, nose to nose. A shorter film of the wreck changes nothing. `lost`: the oncoming car is lost at 15 s."""
    way = road(((2000.0, 0.0),))
    ego, vbp, ov = crash(way, "stand")
    whole = [ego, vbp, ov.keep(ov.t_s < 15.0) if lost else ov]
    found = as_driven(whole, way)
    k0 = round(found["t0_ns"] / 1e8)
    assert found["covered_m"] == pytest.approx((ego.x[-1] - ego.x[k0]) + (ov.x[k0] - ov.x[-1]), abs=0.6)
    assert "until it stood there" in sentence(found["reason"])
    for end in (20.0, 23.0):
        cut = as_driven([a.keep(a.t_s < end) for a in whole], way)
        assert (cut["sda_m"], cut["spare_s"], cut["reason"]) == (found["sda_m"], found["spare_s"], found["reason"])


def test_an_oncoming_vehicle_that_brakes_counts_with_the_way_that_it_made() -> None:
    """It comes at 25 m/s when the ego goes out, and at 5 m/s when they meet."""
    way = road(((2000.0, 0.0),))
    ego, vbp, _ = crash(way, "end")
    v = np.clip(25 - 8 * (ego.t_s - 12), 5, 25)
    made = np.concatenate([[0.0], np.cumsum((v[1:] + v[:-1]) / 2 * np.diff(ego.t_s))])
    ov = moving("ov", way, ego.t_s, ego.x[-1] + 5 + made[-1] - made, way.other)
    row = as_driven([ego, vbp, ov], way)
    k0 = round(row["t0_ns"] / 1e8)
    assert row["zone"] == "A"
    assert row["covered_m"] == pytest.approx((ego.x[-1] - ego.x[k0]) + (ov.x[k0] - ov.x[-1]), abs=0.6)


@pytest.mark.parametrize(
    ("share", "gain", "ahead", "vbp"),
    [
        (0.28, 3.0, False, []),
        (0.28, 3.0, True, ["ahead"]),
        (0.28, 30.0, False, ["beside"]),
        (0.8, 3.0, False, ["beside"]),
    ],
)
def test_who_is_beside_an_ego_over_the_line_is_overtaken_only_if_it_is_passed(
    share: float, gain: float, ahead: bool, vbp: list[str]
) -> None:
    """In a queue, a car at the edge of the lane is beside the ego when that moves 0.1 m over the line, and the log ends there.

    With `gain` the ego passes it, or its centre goes over the line (`share`), or another car is ahead.
    """
    way, t = road(), times(10.0)
    s = 50 + gain / 10 * t
    ego = moving("ego", way, t, s, swing(way, s, 50 + 0.5 * gain, None, change=0.2 * gain, share=share))
    edge = way.own - way.over * 1.9
    beside = moving("beside", way, t, 51 + 0.65 * gain + 0.2 * t, edge)
    others = [moving("ahead", way, t, 80 + 0.2 * t, way.own)] if ahead else []
    found = rows(derived(drive([ego, beside, *others], way.environment), tables=["overtake"]), "FROM overtake")
    assert [row["vbp_id"] for row in found] == vbp
    assert all((row["vbp_gap_m"] < 0) == (row["vbp_id"] == "beside") for row in found)
