"""The chapters of the drives: what the ego meets there, and how it behaves. Each argument that is given breaks one rule."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tests.clean.motion import BICYCLE, HORSE, WALKER, smooth
from tests.clean.route import LANE, Kind

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from tests.clean.story import Story

    Floats = NDArray[np.float64]

COUNTRY = {"gb": Kind("rural", (60.0, "mph")), "de": Kind("rural", (100.0, "km/h"))}
TOWN = {"gb": Kind("town", (30.0, "mph")), "de": Kind("town", (50.0, "km/h"))}
_APART = Kind("motorway", (70.0, "mph"), lanes=3, oncoming=0, centre="solid", beside="shoulder")
MOTORWAY = {"gb": _APART, "de": replace(_APART, limit=(120.0, "km/h"))}
SIGNAL_S = {"gb": 5.0, "de": 3.0}  # before a lane change begins: Rule 103 asks for time, UN R79 for no more than 5 s
FRONT = 2.4  # from the ego's centre to its bumper


def open_road(w: Story, length: float = 150.0) -> None:
    """Nobody there, between two chapters."""
    w.slow(w.route.road(length, COUNTRY[w.nation]), length, 13.0)


def moving_off(t: Floats, at: float, gone: float, v: float = 12.0) -> Floats:
    """Return the stations of one who stands at a station and drives off at a time, with 2 m/s2."""
    rolling = np.clip(t - gone, 0.0, v / 2.0)
    found: Floats = at + rolling**2 + v * np.clip(t - gone - v / 2.0, 0.0, None)
    return found


def follow(w: Story, *, gap_s: float = 4.5, speed: float = 18.0, fast: float = 0.0, centre: str = "broken", out: float = 0.0,
           astride_s: float = 1.0, night: bool = False, headlights: bool = True, hazards: bool = False, brakes: float = 0.0,
           pulls: float = 0.0, rounding_s: float = 0.0, parks: bool = False, alone: bool = False, chosen: str = "") -> None:  # fmt: skip
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
            w.meets(lambda t: w.where(t + gap_s), w.route.offset(), between=(w.when(s - 100.0), w.when(s + 600.0)))
        w.events.append((w.when(s - 100.0), "headlights", "on"))
        if not headlights:
            w.events.append((w.when(s + 200.0), "headlights", "off"))
            w.events.append((w.when(s + 500.0), "headlights", "on"))
        if hazards:
            w.hazards.append((w.when(s + 300.0), w.when(s + 400.0)))
        if chosen:
            w.events.append((w.when(s + 200.0), "chosen_speed", chosen))

    w.then(scene)


def overtake(w: Story, *, oncoming_m: float = 900.0, gap: float = 170.0, clear: float = 45.0,
             looks: tuple[str, ...] = ("mirror_check", "blind_spot_check"), decision: str = "overtake_go", confidence: str = "0.98",
             behind_m: float = 0.0, ahead_m: float = 0.0, solid: bool = False, aside: float = LANE, sign: bool = False) -> None:  # fmt: skip
    """Past a slow car on a country road, with somebody coming the other way, far away."""
    v, slow, onward, across = 22.0, 5.0, 15.0, 70.0
    s = w.route.road(400.0, COUNTRY[w.nation])
    w.route.road(1100.0, replace(COUNTRY[w.nation], centre="solid" if solid else "broken"))
    w.slow(s, 1500.0, v)
    out = s + 250.0
    # when the ego begins to move out the other is `gap` ahead, bumper to bumper; to move back when it is `clear` behind
    back = out + (gap + 2 * 4.8 + clear) * v / (v - slow)
    w.leaves(-aside, out, across, looks=tuple(looks))
    w.leaves(aside, back, across)
    w.indicates("offside", out - 5.5 * v, out + across)
    w.indicates("nearside", back - 2.0 * v, back + across)

    def scene() -> None:
        # a map with such signs somewhere shows that there is none here
        w.route.sign(s + 50.0 if sign else w.route.length - 20.0, "no_overtaking")
        t0 = w.when(out)
        w.meets(
            lambda t: out + gap + 4.8 + slow * (t - t0),
            w.route.offset(),
            between=(w.when(s - 100.0), w.when(back + 350.0)),
        )
        w.meets(
            lambda t: out + oncoming_m - onward * (t - t0),
            w.route.offset(-1),
            turned=np.pi,
            between=(w.when(s - 100.0), t0 + 50.0),
        )
        if behind_m:
            w.meets(
                lambda t: out - behind_m - 4.8 + (v + 1.0) * (t - t0) - 5.0 * np.clip(t - t0 - 2.5, 0.0, None),
                w.route.offset(-1),
                between=(t0 - 8.0, t0 + 8.0),
            )
        if ahead_m:
            w.meets(
                lambda t: out + gap + 9.6 + ahead_m + slow * (t - t0) + 0.75 * np.clip(t - t0 - 2.0, 0.0, None) ** 2,
                w.route.offset(),
                between=(w.when(s - 100.0), t0 + 16.0),
            )
        w.events += [(t0 - 2.0, decision, None), (t0 - 2.0, "confidence", confidence)]

    w.then(scene)


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
            lambda t: out + 60.0 + slow * (t - t0),
            rider,
            HORSE if horse else BICYCLE,
            between=(w.when(s - 100.0), w.when(s + 560.0)),
        )
        w.events += [(t0 - 2.0, "overtake_go", None), (t0 - 2.0, "confidence", "0.98")]

    w.then(scene)


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
    w: Story, *, oncoming_s: float = 6.0, walker_s: float = 8.0, cut: float = 0.0, fast: float = 4.0
) -> None:
    """Across the oncoming traffic into a side road, after somebody has come and before somebody else comes."""
    s = w.route.road(250.0, TOWN[w.nation])
    w.slow(s, 244.0, 11.0)
    turn = "right" if w.route.h > 0 else "left"
    j = w.route.junction(turn, (turn, "straight"), TOWN[w.nation])
    w.slow(j.s_in - 6.0, j.s_out + 12.0 - j.s_in, fast)
    w.indicates("offside", j.s_in - 80.0, j.s_out + 4.0)
    if cut:
        w.plan.shift(-cut, j.s_in - 4.0, 12.0)
        w.plan.shift(cut, j.s_out + 6.0, 20.0)
    after = w.route.road(200.0, TOWN[w.nation])
    w.slow(after + 6.0, 194.0, 12.0)

    def scene() -> None:
        line, inside = j.across("straight", "came")
        for t_in in (w.when(j.s_in) - 8.0, w.when(j.s_out + 5.0) + oncoming_s):
            w.meets(
                lambda t, t_in=t_in: inside + 10.0 * (t - t_in), LANE / 2, line=line, between=(t_in - 12.0, t_in + 12.0)
            )
        t_walk = w.when(j.s_out + 5.0) + walker_s
        w.meets(j.s_out + 3.5, lambda t: 4.5 - 1.2 * np.clip(t - t_walk, 0.0, 7.0), WALKER, turned=np.pi / 2)

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
            w.meets(
                lambda t: moving_off(t, at, gone), w.route.offset(), between=(w.when(s - 100.0), w.when(after + 60.0))
            )

    w.then(scene)


def zebra(w: Story, *, yields: bool = True, queue: bool = False, stands: float = 0.0) -> None:
    """To a zebra crossing that somebody goes over."""
    s = w.route.road(400.0, TOWN[w.nation])
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


def queue(w: Story, *, gap: float = 8.0, horn: bool = False, brakes: float = 0.0) -> None:
    """Behind a queue that stands, and on with it."""
    s = w.route.road(500.0, TOWN[w.nation])
    w.slow(s, 500.0, 12.0)
    halt = s + 250.0
    w.plan.halt(halt, 12.0)
    w.plan.brake = brakes or w.plan.brake

    def scene() -> None:
        for k in range(2):
            at, gone = halt + (k + 1) * (4.8 + gap), w.stands(halt) + 9.5 - k
            w.meets(
                lambda t, at=at, gone=gone: moving_off(t, at, gone, 13.0),
                w.route.offset(),
                between=(w.when(s - 120.0), w.when(s + 380.0)),
            )
        if horn:
            w.events += [(w.stands(halt) + 5.0, "horn", "on"), (w.stands(halt) + 6.0, "horn", "off")]

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
            w.meets(
                lambda t: moving_off(t, at, gone), w.route.offset(), between=(w.when(s - 100.0), w.when(after + 100.0))
            )
            return
        line, inside = j.across("came", "straight")
        t_in = w.when(j.s_out) + cyclist_s
        if passes:  # four seconds before the turn
            t_pass = w.when(j.s_in) - 4.0
            t_in = t_pass + (j.s_in - float(w.where(t_pass))) / 5.0
        # one who comes soon after the ego comes up from behind while it slows down
        since = 28.0 if passes else 13.0 if cyclist_s > 3.0 else 4.5
        beside = LANE + (0.9 if passes else -0.5)
        w.meets(lambda t: inside + 5.0 * (t - t_in), beside, BICYCLE, line=line, between=(t_in - since, t_in + 15.0))

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
        more = lambda t: 1.5 * np.clip(t_held + 1.5 - t, 0.0, 1.5) ** 2 + 4.5 * np.clip(t_held - t, 0.0, None)  # noqa: E731
        came = lambda t: stands + 15.0 - 9.0 * (t - t_back) + (more(t) if forced else 0.0)  # noqa: E731
        w.meets(came, w.route.offset(-1), turned=np.pi, between=(t_back - 30.0, t_back + 12.0))
        t0 = w.when(stands - 65.0)
        w.events += [(t0 - 2.0, "overtake_go", None), (t0 - 2.0, "confidence", "0.98")]

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
        n = lambda t: w.route.offset(-1) + LANE * smooth((t - t0 - 5.0) / 4.0)  # noqa: E731
        w.meets(lambda t: beside + fast * (t - t0), n, between=(t0 - 14.0, t0 + 22.0))

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
            at, gone = halt + (k + 1) * 11.0, w.stands(halt) + 12.9 - k
            way = (w.when(s - 300.0), w.when(s + 1400.0))
            w.meets(lambda t, at=at, gone=gone: moving_off(t, at, gone, 26.0), w.route.offset(), between=way)

    w.then(scene)


def motorway(w: Story, *, shoulder: bool = False, stops_s: float = 0.0, back: float = 0.0, lane: int = 2, vehicle_class: str = "",
             speed: float = 29.0, signal_s: float = 0.0, within: float = 110.0, behind_m: float = 0.0, mrm: bool = False,
             brakes: float = 0.0, hazards: bool = True, looks: bool = True, gap: float = 180.0) -> None:  # fmt: skip
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
            lambda t: out + gap + 4.8 + slow * (t - t0),
            w.route.offset(),
            between=(w.when(out - 150.0), w.when(end - 30.0)),
        )
        w.events += [(t0 - 2.0, "overtake_go", None), (t0 - 2.0, "confidence", "0.98")]
        if behind_m:
            w.meets(lambda t: out - behind_m - 4.8 + v * (t - t0), w.route.offset(2), between=(t0 - 12.0, t0 + 20.0))
        if mrm:
            start, stop = w.when(s + 100.0), w.when(s + 340.0)
            w.events += [(start, "minimal_risk_manoeuvre", "on"), (stop, "minimal_risk_manoeuvre", "off")]
            if hazards:
                w.hazards.append((start, stop))

    w.then(scene)


def cut_in(w: Story, *, goes_on: bool = True, gap: float = 21.0) -> None:
    """Somebody changes lane in front of the ego, a little faster, on a town's road of two lanes."""
    v, across = 12.0, 40.0
    s = w.route.road(700.0, replace(TOWN[w.nation], lanes=2, oncoming=0, centre="solid"))
    w.slow(s, 700.0, v)
    begins = s + 200.0

    def scene() -> None:
        t0 = w.when(begins)
        ahead = lambda t: (
            begins + 4.8 + gap + v * (t - t0) + (3.0 if goes_on else 0.0) * np.clip(t - t0 + 3.0, 0.0, None)
        )  # noqa: E731
        n = lambda t: w.route.offset(2) + LANE * smooth((t - t0) * v / across)  # noqa: E731
        w.meets(ahead, n, between=(t0 - 12.0, t0 + 30.0))

    w.then(scene)


def convoy(w: Story, *, gap_s: float = 5.2, speed: float = 25.0, vehicle_class: str = "", fast: float = 0.0, brakes: float = 0.0,
           alone: bool = False, undertakes: bool = False) -> None:  # fmt: skip
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
            w.meets(lambda t: s + 700.0 + 20.0 * (t - t0), w.route.offset(2), between=(t0 - 15.0, t0 + 15.0))
        elif not (alone or fast or brakes):
            w.meets(lambda t: w.where(t + gap_s), w.route.offset(), between=(w.when(s - 200.0), w.when(s + 1400.0)))

    w.then(scene)


CHAPTERS: dict[str, Callable[..., None]] = {
    f.__name__: f
    for f in (
        follow,
        overtake,
        cyclist,
        stop_sign,
        offside_turn,
        light,
        zebra,
        pelican,
        queue,
        motorway,
        jam,
        nearside_turn,
        parked,
        overtaken,
        convoy,
        cut_in,
    )
}
