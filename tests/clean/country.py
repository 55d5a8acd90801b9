"""Chapters on country roads. Each argument that is given breaks one rule."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tests.clean.motion import smooth
from tests.clean.roads import COUNTRY, steady
from tests.clean.route import LANE
from tests.clean.story import LOOKS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tests.clean.story import Story


def follow(
    w: Story,
    *,
    gap_s: float = 4.5,
    speed: float = 18.0,
    fast: float = 0.0,
    centre: str = "broken",
    out: float = 0.0,
    astride_s: float = 1.0,
    night: bool = False,
    headlights: bool = True,
    hazards: bool = False,
    brakes: float = 0.0,
    pulls: float = 0.0,
    rounding_s: float = 0.0,
    parks: bool = False,
    alone: bool = False,
    chosen_speed: str = "",
) -> None:
    """Behind another car on a country road."""
    s = w.route.road(700.0, replace(COUNTRY[w.nation], centre=centre))
    if fast:
        w.slow(s, 150.0, speed)
        w.slow(s + 150.0, 450.0, fast)
        w.slow(s + 600.0, 100.0, speed)
        gap_s = 9.0
    else:
        w.slow(s, 700.0, speed)
    if out:
        w.plan.shift(-out, s + 250.0, 60.0)
        w.plan.shift(out, s + 310.0 + astride_s * speed, 60.0)
    if night:
        w.conditions["light"] = "night"
    w.plan.brake, w.plan.pull, w.plan.rounding_s = (
        brakes or w.plan.brake,
        pulls or w.plan.pull,
        rounding_s or w.plan.rounding_s,
    )
    if brakes or pulls:
        w.slow(s + 300.0, 100.0, 9.0)
    if parks:
        w.plan.halt(s + 310.0 + (astride_s * speed) / 2, 66.0)

    def scene() -> None:
        if not (brakes or pulls or parks or alone):
            w.meets(w.where(w.t + gap_s), w.route.offset(), between=(w.when(s - 100.0), w.when(s + 600.0)))
        w.events.append((w.when(s - 100.0), "headlights", "on"))
        if not headlights:
            w.events.append((w.when(s + 200.0), "headlights", "off"))
            w.events.append((w.when(s + 500.0), "headlights", "on"))
        if hazards:
            w.hazards.append((w.when(s + 300.0), w.when(s + 400.0)))
        if chosen_speed:
            w.events.append((w.when(s + 200.0), "chosen_speed", chosen_speed))

    w.then(scene)


def overtake(
    w: Story,
    *,
    oncoming_m: float = 900.0,
    gap: float = 170.0,
    clear: float = 45.0,
    looks: Sequence[str] = LOOKS,
    decision: str = "overtake_go",
    confidence: str = "0.98",
    behind_m: float = 0.0,
    ahead_m: float = 0.0,
    solid: bool = False,
    sign: bool = False,
) -> None:
    """Past a slow car on a country road, with somebody coming the other way, far away."""
    v, slow, onward, across = 22.0, 5.0, 15.0, 70.0
    s = w.route.road(400.0, COUNTRY[w.nation])
    w.route.road(1100.0, replace(COUNTRY[w.nation], centre="solid" if solid else "broken"))
    w.slow(s, 1500.0, v)
    out = s + 250.0
    # when the ego begins to move out the other is `gap` ahead, bumper to bumper; to move back when it is `clear` behind
    back = out + (gap + 2 * 4.8 + clear) * v / (v - slow)
    w.leaves(-LANE, out, across, looks=looks)
    w.leaves(LANE, back, across)
    w.indicates("offside", out - 5.5 * v, out + across)
    w.indicates("nearside", back - 2.0 * v, back + across)

    def scene() -> None:
        # without its end one may have been put up before, further back than anybody looks
        w.route.sign(s + 50.0, "no_overtaking" if sign else "no_overtaking_end")
        t0 = w.when(out)
        w.meets(
            steady(w.t, out + gap + 4.8, slow, t0),
            w.route.offset(),
            between=(w.when(s - 100.0), w.when(back + 350.0)),
        )
        w.meets(
            steady(w.t, out + oncoming_m, -onward, t0),
            w.route.offset(-1),
            turned=np.pi,
            between=(w.when(s - 100.0), t0 + 50.0),
        )
        if behind_m:
            w.meets(
                steady(w.t, out - behind_m - 4.8, v + 1.0, t0) - 5.0 * np.clip(w.t - t0 - 2.5, 0.0, None),
                w.route.offset(-1),
                between=(t0 - 8.0, t0 + 8.0),
            )
        if ahead_m:
            w.meets(
                steady(w.t, out + gap + 9.6 + ahead_m, slow, t0) + 0.75 * np.clip(w.t - t0 - 2.0, 0.0, None) ** 2,
                w.route.offset(),
                between=(w.when(s - 100.0), t0 + 16.0),
            )
        w.events += [(t0 - 2.0, decision, None), (t0 - 2.0, "confidence", confidence)]

    w.then(scene)


def overtaken(w: Story, *, speeds_up: bool = False) -> None:
    """Somebody overtakes the ego on a country road, and moves in ahead of it; the ego leaves it room again."""
    v, fast = 15.0, 21.0
    s = w.route.road(900.0, COUNTRY[w.nation])
    w.slow(s, 900.0, v)
    beside = s + 300.0
    if speeds_up:
        w.slow(beside - 20.0, 60.0, 19.0)
        w.plan.limits[-2:] = [
            (s, beside - 20.0, v),
            (beside - 20.0, beside + 40.0, 19.0),
            (beside + 40.0, s + 900.0, v),
        ]

    def scene() -> None:
        t0 = w.when(beside)
        # it draws level at t0, moves in five seconds later, and goes on as fast
        n = w.route.offset(-1) + LANE * smooth((w.t - t0 - 5.0) / 4.0)
        w.meets(steady(w.t, beside, fast, t0), n, between=(t0 - 14.0, t0 + 22.0))

    w.then(scene)
