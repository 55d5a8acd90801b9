"""An overtake with an oncoming car: one that is completed or aborted, and one that ends in a crash."""

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
    vbp = moving("vbp", way, t, 140 + 4 * t, way.own)
    ov = moving("ov", way, t, 590 - 9 * t, way.other)
    return way, [ego, vbp, ov]


def crash(way: Road, then: str, start: float = 0.0) -> list[Actor]:
    """Out at 10 s well behind the car ahead, past it at 22 m/s in 9.2 s, and into the oncoming car, which comes at 25 m/s.

    `then`: the log ends there, both stand there, or the ego is drawn back into its lane. `start`: metres that the ego starts
    nearer to the car ahead, so that it has passed it by then.
    """
    t = times(26.0)
    s = 50 + 22 * t
    out = 50 + 22 * 10.0
    met = out + 22 * 9.2
    d = swing(way, s, out, met + 5 if then == "back" else None)
    ego = moving("ego", way, t, s, d)
    vbp = moving("vbp", way, t, out + 45 - start + 17 * (t - 10), way.own)
    ov = moving("ov", way, t, met + 3 + 25 * (19.2 - t), way.other)
    if then == "end":
        return [a.keep(t < 19.25) for a in (ego, vbp, ov)]
    if then == "stand":
        stopped = np.minimum(t, 19.2)
        ego = moving("ego", way, t, 50 + 22 * stopped, swing(way, 50 + 22 * stopped, out, None))
        ov = moving("ov", way, t, met + 3 + 25 * (19.2 - stopped), way.other)
    return [ego, vbp, ov]
