"""Chapters at the junctions of a town. Each argument that is given breaks one rule."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tests.clean.motion import BICYCLE, WALKER
from tests.clean.roads import FRONT, TOWN, moving_off, steady
from tests.clean.route import LANE

if TYPE_CHECKING:
    from tests.clean.story import Story


def stop_sign(w: Story, *, halts: bool = True, wide: float = 0.0, short: float = 0.3) -> None:
    """To a stop sign, and to the nearside there."""
    s = w.route.road(200.0, TOWN[w.nation])
    line = s + 198.0
    w.slow(s, 193.0, 12.0)
    w.route.stop_line(line, "stop")
    if halts:
        w.plan.halt(line - short - FRONT, 4.8)
    j = w.route.junction("left" if w.route.h > 0 else "right", ("left", "right"), TOWN[w.nation])
    w.slow(line - 5.0, j.s_out + 10.0 - line, 3.5)
    w.indicates("nearside", line - 70.0, j.s_out + 4.0)
    if wide:
        w.plan.shift(-wide, j.s_in - 2.0, 10.0)
        w.plan.shift(wide, j.s_out + 12.0, 20.0)
    after = w.route.road(200.0, TOWN[w.nation])
    w.slow(after + 5.0, 195.0, 12.0)


def offside_turn(
    w: Story, *, oncoming_s: float = 6.0, walker_s: float = 8.0, cut_m: float = 0.0, fast: float = 4.0
) -> None:
    """Across the oncoming traffic into a side road, after somebody has come and before somebody else comes."""
    s = w.route.road(250.0, TOWN[w.nation])
    w.slow(s, 244.0, 11.0)
    turn = "right" if w.route.h > 0 else "left"
    j = w.route.junction(turn, (turn, "straight"), TOWN[w.nation])
    w.slow(j.s_in - 6.0, j.s_out + 12.0 - j.s_in, fast)
    w.indicates("offside", j.s_in - 80.0, j.s_out + 4.0)
    if cut_m:
        w.plan.shift(-cut_m, j.s_in - 4.0, 12.0)
        w.plan.shift(cut_m, j.s_out + 6.0, 20.0)
    after = w.route.road(200.0, TOWN[w.nation])
    w.slow(after + 6.0, 194.0, 12.0)

    def scene() -> None:
        line, inside = j.across("straight", "came")
        for t_in in (w.when(j.s_in) - 8.0, w.when(j.s_out + 5.0) + oncoming_s):
            w.meets(steady(w.t, inside, 10.0, t_in), LANE / 2, line=line, between=(t_in - 12.0, t_in + 12.0))
        t_walk = w.when(j.s_out + 5.0) + walker_s
        w.meets(j.s_out + 3.5, 4.5 - 1.2 * np.clip(w.t - t_walk, 0.0, 7.0), WALKER, turned=np.pi / 2)

    w.then(scene)


def nearside_turn(w: Story, *, cyclist_s: float = 6.0, passes: bool = False, blocked: bool = False) -> None:
    """Into a side road on the nearside, well before somebody on a bicycle who goes on."""
    s = w.route.road(250.0, TOWN[w.nation])
    w.slow(s, 244.0, 11.0)
    turn = "left" if w.route.h > 0 else "right"
    j = w.route.junction(turn, (turn, "straight"), TOWN[w.nation])
    w.slow(j.s_in - 6.0, j.s_out + 12.0 - j.s_in, 3.5)
    w.indicates("nearside", j.s_in - 80.0, j.s_out + 4.0)
    after = w.route.road(200.0, TOWN[w.nation])
    w.slow(after + 6.0, 194.0, 12.0)
    if blocked:
        w.plan.halt(j.s_in + 10.0, 12.0)

    def scene() -> None:
        if blocked:
            at, gone = j.s_in + 10.0 + 4.8 + 3.0, w.when(j.s_in + 10.3) - 3.0
            w.meets(moving_off(w.t, at, gone), w.route.offset(), between=(w.when(s - 100.0), w.when(after + 100.0)))
            return
        line, inside = j.across("came", "straight")
        t_in = w.when(j.s_out) + cyclist_s
        if passes:  # four seconds before the turn
            t_pass = w.when(j.s_in) - 4.0
            t_in = t_pass + (j.s_in - float(w.where(t_pass))) / 5.0
        # one who comes soon after the ego comes up from behind while it slows down
        since = 28.0 if passes else 13.0 if cyclist_s > 3.0 else 4.5
        beside = LANE + (0.9 if passes else -0.5)
        w.meets(steady(w.t, inside, 5.0, t_in), beside, BICYCLE, line=line, between=(t_in - since, t_in + 15.0))

    w.then(scene)


def light(w: Story, *, runs: bool = False, blocked: bool = False) -> None:
    """To a red light, on when it is green."""
    s = w.route.road(200.0, TOWN[w.nation])
    line, name = s + 198.0, f"light{s:.0f}"
    w.route.stop_line(line, light=name)
    w.slow(s, 200.0, 12.0)
    halt = line - 0.3 - FRONT
    if not runs:
        w.plan.halt(halt, 8.0)
    j = w.route.junction("straight", ("left", "straight", "right"), TOWN[w.nation])
    after = w.route.road(150.0, TOWN[w.nation])
    w.slow(j.s_in, after + 150.0 - j.s_in, 12.0)
    if blocked:
        w.plan.halt(j.s_in + 8.0, 12.0)

    def scene() -> None:
        seen = w.stands(halt)
        green = seen + (30.0 if runs else 6.0)
        states = (
            (-1e9, "green"),
            (seen - 14.0, "amber"),
            (seen - 11.0, "red"),
            (green - 2.0, "red_amber"),
            (green, "green"),
        )
        w.signals += [(name, t, next(word for since, word in reversed(states) if since <= t)) for t in w.t]
        if blocked:
            at, gone = j.s_in + 8.0 + 4.8 + 3.0, w.when(j.s_in + 8.3) - 3.0
            w.meets(moving_off(w.t, at, gone), w.route.offset(), between=(w.when(s - 100.0), w.when(after + 60.0)))

    w.then(scene)
