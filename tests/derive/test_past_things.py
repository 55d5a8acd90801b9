"""Things that stand in the lane, such as cones, may be passed over a solid line; what drives may not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.derive.marked import marked
from tests.scenes import Actor, drive, judged, moving, standing, swing, times

HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])
LINE = "ukhc.r129.no-cross-solid"


def past(
    hand: str, cones: list[float], *, share: float = 0.5, kind: str = "object", slow_mps: float | None = None
) -> str:
    """Return the verdict on an ego that goes over the solid middle line round cones at these places; `share` of the lane inwards.

    `slow_mps`: of a car that the ego overtakes there, too.
    """
    way = marked(hand)
    t = times(40.0)
    s = 50 + 12 * t
    ego = moving("ego", way, t, s, swing(way, s, 140, 330, change=30.0, share=0.8))
    row: list[Actor] = [
        replace(standing(f"c{k}", way, t, at, 2 * share * way.own), length=0.4, width=0.4, kind=kind)
        for k, at in enumerate(cones)
    ]
    if slow_mps is not None:
        row.append(moving("slow", way, t, 120 + slow_mps * t, way.own))
    rows = judged([drive([ego, *row], way.environment)], rules=[LINE])
    worst = [v for v in ("fail", "unknown", "pass") if v in {row["verdict"] for row in rows}]
    return worst[0]


ROW = [float(at) for at in np.arange(170.0, 331.0, 15.0)]


@HANDS
@pytest.mark.parametrize("share", [0.4, 0.5, 0.6])
def test_a_row_of_cones_in_the_lane(hand: str, share: float) -> None:
    assert past(hand, ROW, share=share) == "pass"


@pytest.mark.ci
@HANDS
def test_what_is_no_reason(hand: str) -> None:
    assert past(hand, []) == "fail"
    assert past(hand, ROW, share=1.02) == "fail"  # posts along the edge
    assert past(hand, ROW[:2]) == "fail"  # 60 m beyond the last, nothing stands there
    assert past(hand, ROW, slow_mps=5.0) == "fail"
