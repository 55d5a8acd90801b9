"""Chapters on motorways. Each argument that is given breaks one rule."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.clean.roads import COUNTRY, MOTORWAY, SIGNAL_S, moving_off, steady
from tests.clean.route import LANE

if TYPE_CHECKING:
    from tests.clean.story import Story


def motorway(
    w: Story,
    *,
    shoulder: bool = False,
    stops_s: float = 0.0,
    back: float = 0.0,
    lane: int = 2,
    vehicle_class: str = "",
    speed: float = 29.0,
    signal_s: float = 0.0,
    within: float = 110.0,
    behind_m: float = 0.0,
    mrm: bool = False,
    brakes: float = 0.0,
    hazards: bool = True,
    looks: bool = True,
    gap: float = 180.0,
) -> None:
    """Past a slower car on a motorway and back."""
    v, slow = speed, 24.0
    s = w.route.road(150.0, COUNTRY[w.nation])
    w.slow(s, 150.0, 20.0)
    s = w.route.road(2700.0, MOTORWAY[w.nation])
    w.route.road(500.0, MOTORWAY[w.nation])  # so that the lanes of the first part lead on
    end = s + 3200.0
    w.slow(s, 400.0, 20.0)
    w.slow(s + 400.0, 2790.0, v)
    w.slow(end - 10.0, 10.0, 20.0)
    out, clear = s + 900.0, 110.0
    back_at = out + (gap + 9.6 + clear) * v / (v - slow)
    by = LANE * (lane - 1)
    before = signal_s or SIGNAL_S[w.nation]
    w.leaves(-by, out, within)
    w.leaves(by, back_at, 110.0)
    w.indicates("offside", out - before * v, out + within, looks=looks)
    w.indicates("nearside", back_at - SIGNAL_S[w.nation] * v, back_at + 110.0)
    if shoulder:
        w.plan.shift(3.3, s + 150.0, 100.0)
        w.plan.shift(-3.3, s + 350.0, 100.0)
    if stops_s:
        w.plan.halt(s + 300.0, stops_s, back=back)
    w.plan.brake = brakes or w.plan.brake
    if vehicle_class:
        w.conditions["vehicle_class"] = vehicle_class
    w.slow(w.route.road(150.0, COUNTRY[w.nation]), 150.0, 20.0)

    def scene() -> None:
        t0 = w.when(out)
        w.meets(
            steady(w.t, out + gap + 4.8, slow, t0),
            w.route.offset(),
            between=(w.when(out - 150.0), w.when(end - 30.0)),
        )
        w.events += [(t0 - 2.0, "overtake_go", None), (t0 - 2.0, "confidence", "0.98")]
        if behind_m:
            w.meets(steady(w.t, out - behind_m - 4.8, v, t0), w.route.offset(2), between=(t0 - 12.0, t0 + 20.0))
        if mrm:
            start, stop = w.when(s + 100.0), w.when(s + 340.0)
            w.events += [(start, "minimal_risk_manoeuvre", "on"), (stop, "minimal_risk_manoeuvre", "off")]
            if hazards:
                w.hazards.append((start, stop))

    w.then(scene)


def jam(w: Story) -> None:
    """Behind traffic that stands on a motorway, and on with it."""
    w.slow(w.route.road(150.0, COUNTRY[w.nation]), 150.0, 20.0)
    s = w.route.road(1500.0, MOTORWAY[w.nation])
    w.slow(s, 1490.0, 25.0)
    w.slow(s + 1490.0, 10.0, 20.0)
    w.slow(w.route.road(150.0, COUNTRY[w.nation]), 150.0, 20.0)
    halt = s + 500.0
    w.plan.halt(halt, 14.0)

    def scene() -> None:
        for k in range(2):
            at, gone = halt + (k + 1) * 11.0, w.stands(halt) + 11.0 - k
            way = (w.when(s - 300.0), w.when(s + 1400.0))
            w.meets(moving_off(w.t, at, gone, 26.0), w.route.offset(), between=way)

    w.then(scene)


def convoy(
    w: Story,
    *,
    gap_s: float = 5.2,
    speed: float = 25.0,
    vehicle_class: str = "",
    fast: float = 0.0,
    brakes: float = 0.0,
    alone: bool = False,
    undertakes: bool = False,
) -> None:
    """Behind another car on a motorway."""
    w.slow(w.route.road(150.0, COUNTRY[w.nation]), 150.0, 20.0)
    s = w.route.road(1500.0, MOTORWAY[w.nation])
    w.slow(s, 500.0, min(speed, 25.0))
    w.slow(s + 500.0, 500.0, fast or speed)
    w.slow(s + 1000.0, 490.0, speed)
    w.slow(s + 1490.0, 10.0, min(speed, 20.0))
    w.slow(w.route.road(150.0, COUNTRY[w.nation]), 150.0, 20.0)
    if vehicle_class:
        w.conditions["vehicle_class"] = vehicle_class
    if brakes:
        w.plan.brake = brakes
        w.slow(s + 700.0, 100.0, 19.0)

    def scene() -> None:
        if undertakes:
            t0 = w.when(s + 700.0)
            w.meets(steady(w.t, s + 700.0, 20.0, t0), w.route.offset(2), between=(t0 - 15.0, t0 + 15.0))
        elif not (alone or fast or brakes):
            w.meets(w.where(w.t + gap_s), w.route.offset(), between=(w.when(s - 200.0), w.when(s + 1400.0)))

    w.then(scene)
