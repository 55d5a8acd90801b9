"""An overtake with an oncoming car, completed or aborted."""

from __future__ import annotations

import numpy as np

from tests.scenes import Actor, Road, moving, road, swing, times


def scene(hand: str = "rht", end: float = 30.0, *, abort: bool = False) -> tuple[Road, list[Actor]]:
    """Pass a slower car at 12 m/s: out from s = 150 on, back from s = 280 on; the oncoming car is met late."""
    way = road(hand=hand)
    t = times(end)
    s = 50 + 12 * t
    if abort:  # brakes to 4 m/s when it is half over, behind the car ahead
        v_t = np.clip(12 - 4 * (t - 9), 4, 12)
        s = 50 + np.concatenate([[0.0], np.cumsum((v_t[1:] + v_t[:-1]) / 2 * np.diff(t))])
    d = swing(way, s, 150, 165 if abort else 280, share=0.6 if abort else 1.0)
    ego = moving("ego", way, t, s, d)
    vbp = moving("vbp", way, t, 140 + 4 * t, way.ego_d)
    ov = moving("ov", way, t, 590 - 9 * t, way.oncoming_d)
    return way, [ego, vbp, ov]
