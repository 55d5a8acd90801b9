"""Chapters in a town, between its junctions. Each argument that is given breaks one rule."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tests.clean.motion import BICYCLE, HORSE, WALKER, smooth
from tests.clean.roads import FRONT, TOWN, moving_off, steady
from tests.clean.route import LANE

if TYPE_CHECKING:
    from tests.clean.story import Story


def cyclist(w: Story, *, clearance: float = 1.9, horse: bool = False) -> None:
    """Past somebody on a bicycle in a town."""
    v, slow, across = 12.0, 3.5 if horse else 5.0, 45.0
    s = w.route.road(600.0, TOWN[w.nation])
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
        w.meets(
            steady(w.t, out + 60.0, slow, t0),
            rider,
            HORSE if horse else BICYCLE,
            between=(w.when(s - 100.0), w.when(s + 560.0)),
        )
        w.events += [(t0 - 2.0, "overtake_go", None), (t0 - 2.0, "confidence", "0.98")]

    w.then(scene)


def zebra(w: Story, *, yields: bool = True, queue: bool = False, stands: float = 0.0, passes: bool = False) -> None:
    """To a zebra crossing that somebody goes over."""
    s = w.route.road(400.0, TOWN[w.nation])
    w.slow(s, 400.0, 12.0)
    crossing = s + 200.0
    w.route.crossing(crossing, "zebra")
    halt = crossing - 2.5 - FRONT
    if yields and not passes:
        w.plan.halt(halt, 10.0)
    if queue or stands:
        w.plan.halt(crossing + 1.0, stands or 9.0)
    if passes:
        w.leaves(-LANE, crossing - 95.0, 35.0)
        w.leaves(LANE, crossing + 20.0, 35.0)

    def scene() -> None:
        if passes:  # its front gets ahead of the other's just before the crossing; nobody is on foot
            w.meets(steady(w.t, crossing - 8.0, 3.0, w.when(crossing - 8.0)), w.route.offset())
            return
        t0 = w.stands(halt) - 1.0 if yields else w.when(crossing - FRONT) - 1.6
        far = 2 * LANE + 3.0 if yields else 1.9
        w.meets(crossing + 1.5, LANE + 1.5 - np.clip(1.3 * (w.t - t0), 0.0, far), WALKER, turned=np.pi / 2)
        if queue:
            at, gone = crossing + 1.0 + 4.8 + 3.0, w.when(crossing + 1.3) - 3.0
            w.meets(moving_off(w.t, at, gone), w.route.offset(), between=(w.when(s - 100.0), w.when(s + 300.0)))

    w.then(scene)


def pelican(w: Story, *, state: str = "green", walker: bool = False) -> None:
    """Over a signalled crossing while the light is green."""
    s = w.route.road(400.0, TOWN[w.nation])
    w.slow(s, 400.0, 12.0)
    crossing, name = s + 200.0, f"pelican{s:.0f}"
    w.route.crossing(crossing, "signalled", light=name)

    def scene() -> None:
        t0 = w.when(crossing - FRONT)
        w.signals += [(name, t, state if abs(t - t0) < 8.0 else "green") for t in w.t]
        edge = LANE - 0.4 if walker else LANE + 3.0
        w.meets(crossing + 1.5, np.where(np.abs(w.t - t0) < 4.0, edge, LANE + 3.0), WALKER, turned=np.pi / 2)

    w.then(scene)


def queue(w: Story, *, gap: float = 8.0, horn: bool = False, brakes: float = 0.0, dark: bool = False) -> None:
    """Behind a queue that stands, and on with it."""
    s = w.route.road(500.0, TOWN[w.nation])
    w.slow(s, 500.0, 12.0)
    halt = s + 250.0
    w.plan.halt(halt, 12.0)
    w.plan.brake = brakes or w.plan.brake
    if dark:
        w.conditions["light"] = "night"

    def scene() -> None:
        if dark:
            w.events += [(w.when(s + 10.0), "headlights", "on"), (w.when(s + 100.0), "headlights", "off")]
            w.events.append((w.when(s + 400.0), "headlights", "on"))
        for k in range(2):
            at, gone = halt + (k + 1) * (4.8 + gap), w.stands(halt) + 9.5 - k
            w.meets(
                moving_off(w.t, at, gone, 13.0),
                w.route.offset(),
                between=(w.when(s - 120.0), w.when(s + 380.0)),
            )
        if horn:
            w.events += [(w.stands(halt) + 5.0, "horn", "on"), (w.stands(halt) + 6.0, "horn", "off")]

    w.then(scene)


def parked(w: Story, *, oncoming_s: float = 14.0, aside: float = 2.6, forced: bool = False) -> None:
    """Round a parked car, long before somebody comes the other way."""
    v, across = 10.0, 35.0
    s = w.route.road(500.0, TOWN[w.nation])
    w.slow(s, 500.0, v)
    stands = s + 250.0
    by = -aside
    w.leaves(by, stands - 65.0, across)
    w.leaves(-by, stands + 15.0, across)
    w.indicates("offside", stands - 65.0 - 5.5 * v, stands - 30.0)

    def scene() -> None:
        w.meets(stands, w.route.offset() + 0.9, between=(w.when(s - 100.0), w.when(s + 460.0)))
        t_back = w.when(stands + 15.0 + across) + oncoming_s
        # one who is forced to brake does so with 3 m/s2, down to the speed of the other
        t_held = w.when(stands)
        more = 1.5 * np.clip(t_held + 1.5 - w.t, 0.0, 1.5) ** 2 + 4.5 * np.clip(t_held - w.t, 0.0, None)
        comes = steady(w.t, stands + 15.0, -9.0, t_back) + (more if forced else 0.0)
        w.meets(comes, w.route.offset(-1), turned=np.pi, between=(t_back - 30.0, t_back + 12.0))
        t0 = w.when(stands - 65.0)
        w.events += [(t0 - 2.0, "overtake_go", None), (t0 - 2.0, "confidence", "0.98")]

    w.then(scene)


def cut_in(w: Story, *, goes_on: bool = True, gap: float = 21.0) -> None:
    """Somebody changes lane in front of the ego, a little faster, on a town's road of two lanes."""
    v, across = 12.0, 40.0
    s = w.route.road(700.0, replace(TOWN[w.nation], lanes=2, oncoming=0, centre="solid"))
    w.slow(s, 700.0, v)
    begins = s + 200.0

    def scene() -> None:
        t0 = w.when(begins)
        ahead = steady(w.t, begins + 4.8 + gap, v, t0)
        if goes_on:
            ahead = ahead + 3.0 * np.clip(w.t - t0 + 3.0, 0.0, None)
        n = w.route.offset(2) + LANE * smooth((w.t - t0) * v / across)
        w.meets(ahead, n, between=(t0 - 12.0, t0 + 30.0))

    w.then(scene)
