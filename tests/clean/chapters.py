"""The chapters of the drives: what the ego meets there, and how it behaves. Each argument that is given breaks one rule."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tests.clean.motion import BICYCLE, CAR, WALKER
from tests.clean.route import LANE, Kind

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from tests.clean.story import Story

    Floats = NDArray[np.float64]

COUNTRY = Kind("rural", (60.0, "mph"))
TOWN = Kind("town", (30.0, "mph"))
MOTORWAY = Kind("motorway", (70.0, "mph"), lanes=3, oncoming=0, centre="solid", beside="shoulder")
FRONT = 2.4  # from the ego's centre to its bumper


def open_road(w: Story, length: float = 150.0) -> None:
    """Nobody there, between two chapters."""
    w.slow(w.route.road(length, COUNTRY), length, 13.0)


def moving_off(t: Floats, at: float, gone: float, v: float = 12.0) -> Floats:
    """Return the stations of one who stands at a station and drives off at a time, with 1.2 m/s2."""
    rolling = np.clip(t - gone, 0.0, v / 1.2)
    found: Floats = at + 0.6 * rolling**2 + v * np.clip(t - gone - v / 1.2, 0.0, None)
    return found


def follow(w: Story, *, gap_s: float = 4.5, speed: float = 18.0, fast: float = 0.0, centre: str = "broken", out: float = 0.0,
           astride_s: float = 1.0, night: bool = False, headlights: bool = True, hazards: bool = False) -> None:  # fmt: skip
    """Behind another car on a country road."""
    s = w.route.road(700.0, Kind("rural", (60.0, "mph"), centre=centre))
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

    def scene() -> None:
        w.meets(lambda t: w.where(t + gap_s), w.route.offset(), between=(w.when(s - 100.0), w.when(s + 600.0)))
        w.events.append((w.when(s - 100.0), "headlights", "on"))
        if not headlights:
            w.events.append((w.when(s + 200.0), "headlights", "off"))
            w.events.append((w.when(s + 500.0), "headlights", "on"))
        if hazards:
            w.hazards.append((w.when(s + 300.0), w.when(s + 400.0)))

    w.then(scene)


def overtake(w: Story, *, oncoming_m: float = 900.0, gap: float = 170.0, clear: float = 45.0,
             looks: tuple[str, ...] = ("mirror_check", "blind_spot_check"), decision: str = "overtake_go", confidence: str = "0.98") -> None:  # fmt: skip
    """Past a slow car on a country road, with somebody coming the other way, far away."""
    v, slow, onward, across = 22.0, 5.0, 15.0, 70.0
    s = w.route.road(1500.0, COUNTRY)
    w.slow(s, 1500.0, v)
    out = s + 250.0
    # when the ego begins to move out the other is `gap` ahead, bumper to bumper; to move back when it is `clear` behind
    back = out + (gap + 2 * 4.8 + clear) * v / (v - slow)
    w.leaves(-LANE, out, across, looks=tuple(looks))
    w.leaves(LANE, back, across)
    w.indicates("offside", out - 5.5 * v, out + across)
    w.indicates("nearside", back - 2.0 * v, back + across)

    def scene() -> None:
        t0 = w.when(out)
        w.meets(lambda t: out + gap + 4.8 + slow * (t - t0), w.route.offset(), between=(w.when(s - 100.0), w.when(back + 350.0)))
        w.meets(lambda t: out + oncoming_m - onward * (t - t0), w.route.offset(-1), turned=np.pi, between=(w.when(s - 100.0), t0 + 50.0))
        w.events += [(t0 - 2.0, decision, None), (t0 - 2.0, "confidence", confidence)]

    w.then(scene)


def cyclist(w: Story, *, clearance: float = 1.9) -> None:
    """Past somebody on a bicycle in a town."""
    v, slow, across = 12.0, 5.0, 45.0
    s = w.route.road(600.0, TOWN)
    w.slow(s, 600.0, v)
    rider = w.route.offset() + 0.95
    by = rider - 0.3 - 0.9 - clearance - w.route.offset()
    out = s + 200.0
    back = out + (60.0 + 15.0) * v / (v - slow)
    w.leaves(by, out, across)
    w.plan.shift(-by, back, across)
    w.indicates("offside", out - 5.5 * v, out + across)

    def scene() -> None:
        t0 = w.when(out)
        w.meets(lambda t: out + 60.0 + slow * (t - t0), rider, BICYCLE, between=(w.when(s - 100.0), w.when(s + 560.0)))
        w.events += [(t0 - 2.0, "overtake_go", None), (t0 - 2.0, "confidence", "0.98")]

    w.then(scene)


def stop_sign(w: Story, *, halts: bool = True, wide: float = 0.0) -> None:
    """To a stop sign, and to the nearside there."""
    s = w.route.road(200.0, TOWN)
    line = s + 198.0
    w.slow(s, 193.0, 12.0)
    w.route.stop_line(line, "stop")
    if halts:
        w.plan.halt(line - 0.8 - FRONT, 4.5)
    j = w.route.junction("left" if w.route.h > 0 else "right", ("left", "right"), TOWN)
    w.slow(line - 5.0, j.s_out + 10.0 - line, 3.5)
    w.indicates("nearside", line - 70.0, j.s_out + 4.0)
    if wide:
        w.plan.shift(-wide, j.s_in - 2.0, 10.0)
        w.plan.shift(wide, j.s_out + 12.0, 20.0)
    after = w.route.road(200.0, TOWN)
    w.slow(after + 5.0, 195.0, 12.0)


def offside_turn(w: Story, *, oncoming_s: float = 6.0, walker_s: float = 8.0, cut: float = 0.0) -> None:
    """Across the oncoming traffic into a side road, after somebody has come and before somebody else comes."""
    s = w.route.road(250.0, TOWN)
    w.slow(s, 244.0, 11.0)
    turn = "right" if w.route.h > 0 else "left"
    j = w.route.junction(turn, (turn, "straight"), TOWN)
    w.slow(j.s_in - 6.0, j.s_out + 12.0 - j.s_in, 4.0)
    w.indicates("offside", j.s_in - 80.0, j.s_out + 4.0)
    if cut:
        w.plan.shift(-cut, j.s_in - 4.0, 12.0)
        w.plan.shift(cut, j.s_out + 6.0, 20.0)
    after = w.route.road(200.0, TOWN)
    w.slow(after + 6.0, 194.0, 12.0)

    def scene() -> None:
        line, inside = j.across("straight", "came")
        for t_in in (w.when(j.s_in) - 8.0, w.when(j.s_out + 5.0) + oncoming_s):
            w.meets(lambda t, t_in=t_in: inside + 10.0 * (t - t_in), LANE / 2, line=line, between=(t_in - 12.0, t_in + 12.0))
        t_walk = w.when(j.s_out + 5.0) + walker_s
        w.meets(j.s_out + 3.5, lambda t: 4.5 - 1.2 * np.clip(t - t_walk, 0.0, 7.0), WALKER, turned=np.pi / 2)

    w.then(scene)


def light(w: Story, *, runs: bool = False, blocked: bool = False) -> None:
    """To a red light, on when it is green."""
    s = w.route.road(200.0, TOWN)
    line, name = s + 198.0, f"light{s:.0f}"
    w.route.stop_line(line, light=name)
    w.slow(s, 200.0, 12.0)
    halt = line - 1.2 - FRONT
    if not runs:
        w.plan.halt(halt, 8.0)
    j = w.route.junction("straight", ("left", "straight", "right"), TOWN)
    after = w.route.road(150.0, TOWN)
    w.slow(j.s_in, after + 150.0 - j.s_in, 12.0)
    if blocked:
        w.plan.halt(j.s_in + 8.0, 12.0)

    def scene() -> None:
        seen = w.stands(halt)
        green = seen + (30.0 if runs else 6.0)
        states = ((-1e9, "green"), (seen - 14.0, "amber"), (seen - 11.0, "red"), (green - 2.0, "red_amber"), (green, "green"))
        w.signals += [(name, t, next(word for since, word in reversed(states) if since <= t)) for t in w.t]
        if blocked:
            at, gone = j.s_in + 8.0 + 4.8 + 3.0, w.when(j.s_in + 8.3) - 3.0
            w.meets(lambda t: moving_off(t, at, gone), w.route.offset(), between=(w.when(s - 100.0), w.when(after + 60.0)))

    w.then(scene)


def zebra(w: Story, *, yields: bool = True, queue: bool = False, stands: float = 0.0) -> None:
    """To a zebra crossing that somebody goes over."""
    s = w.route.road(400.0, TOWN)
    w.slow(s, 400.0, 12.0)
    crossing = s + 200.0
    w.route.crossing(crossing, "zebra")
    halt = crossing - 2.5 - FRONT
    if yields:
        w.plan.halt(halt, 10.0)
    if queue or stands:
        w.plan.halt(crossing + 1.0, stands or 9.0)

    def scene() -> None:
        t0 = w.stands(halt) - 1.0 if yields else w.when(crossing - FRONT) - 1.6
        far = 2 * LANE + 3.0 if yields else 1.9
        w.meets(crossing + 1.5, lambda t: LANE + 1.5 - np.clip(1.3 * (t - t0), 0.0, far), WALKER, turned=np.pi / 2)
        if queue:
            at, gone = crossing + 1.0 + 4.8 + 3.0, w.when(crossing + 1.3) - 3.0
            w.meets(lambda t: moving_off(t, at, gone), w.route.offset(), between=(w.when(s - 100.0), w.when(s + 300.0)))

    w.then(scene)


def pelican(w: Story, *, state: str = "green", walker: bool = False) -> None:
    """Over a signalled crossing while the light is green."""
    s = w.route.road(400.0, TOWN)
    w.slow(s, 400.0, 12.0)
    crossing, name = s + 200.0, f"pelican{s:.0f}"
    w.route.crossing(crossing, "signalled", light=name)

    def scene() -> None:
        t0 = w.when(crossing - FRONT)
        w.signals += [(name, t, state if abs(t - t0) < 8.0 else "green") for t in w.t]
        edge = LANE - 0.4 if walker else LANE + 3.0
        w.meets(crossing + 1.5, np.where(np.abs(w.t - t0) < 4.0, edge, LANE + 3.0), WALKER, turned=np.pi / 2)

    w.then(scene)


def queue(w: Story, *, gap: float = 8.0, horn: bool = False) -> None:
    """Behind a queue that stands, and on with it."""
    s = w.route.road(500.0, TOWN)
    w.slow(s, 500.0, 12.0)
    halt = s + 250.0
    w.plan.halt(halt, 12.0)

    def scene() -> None:
        for k in range(2):
            at, gone = halt + (k + 1) * (4.8 + gap), w.stands(halt) + 8.0 - k
            w.meets(lambda t, at=at, gone=gone: moving_off(t, at, gone, 13.0), w.route.offset(), between=(w.when(s - 120.0), w.when(s + 380.0)))
        w.events.append((w.when(s - 20.0), "horn", "off"))
        if horn:
            w.events += [(w.stands(halt) + 5.0, "horn", "on"), (w.stands(halt) + 6.0, "horn", "off")]

    w.then(scene)


def motorway(w: Story, *, shoulder: bool = False, stops_s: float = 0.0, back: float = 0.0, lane: int = 2, vehicle_class: str = "",
             speed: float = 29.0) -> None:  # fmt: skip
    """Past a slower car on a motorway and back to the left."""
    v, slow, across = speed, 24.0, 130.0
    s = w.route.road(3200.0, MOTORWAY)
    end = s + 3200.0
    w.slow(s, 400.0, 20.0)
    w.slow(s + 400.0, 2790.0, v)
    w.slow(end - 10.0, 10.0, 13.0)
    out, gap, clear = s + 900.0, 180.0, 110.0
    back_at = out + (gap + 9.6 + clear) * v / (v - slow)
    by = LANE * (lane - 1)
    w.leaves(-by, out, across)
    w.leaves(by, back_at, across)
    w.indicates("offside", out - 4.0 * v, out + across)
    w.indicates("nearside", back_at - 4.0 * v, back_at + across)
    if shoulder:
        w.plan.shift(3.3, s + 150.0, 100.0)
        w.plan.shift(-3.3, s + 350.0, 100.0)
    if stops_s:
        w.plan.halt(s + 200.0, stops_s, back=back)
    if vehicle_class:
        w.conditions["vehicle_class"] = vehicle_class

    def scene() -> None:
        t0 = w.when(out)
        w.meets(lambda t: out + gap + 4.8 + slow * (t - t0), w.route.offset(), between=(w.when(out - 150.0), w.when(end - 30.0)))
        w.events += [(t0 - 2.0, "overtake_go", None), (t0 - 2.0, "confidence", "0.98")]

    w.then(scene)


CHAPTERS: dict[str, Callable[..., None]] = {
    f.__name__: f
    for f in (follow, overtake, cyclist, stop_sign, offside_turn, light, zebra, pelican, queue, motorway)
}
