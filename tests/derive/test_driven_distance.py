"""What an overtake that was broken off really took, however long the log goes on."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from drivelint.reasons.reason_text import sentence
from tests.derive.overtake_scene import crash
from tests.scenes import Actor, Road, derived, drive, moving, road, rows


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
