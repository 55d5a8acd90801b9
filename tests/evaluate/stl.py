"""Rules of the catalogue as formulas of signal temporal logic, with random traces on which both can be judged.

A trace is a set of signals at every tenth of a second and one reference point whose window lies wholly in the log, without
holes and unknowns: beyond that the two differ on purpose (a truncated window, a hole or a NULL is unknown here). Where a
rule does not apply, the signal `on` is -FAR and the formula `on >= 0 -> ...` is kept by FAR.
"""

from __future__ import annotations

from itertools import pairwise
from random import Random
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable

STEPS = 131
PERIOD_S = 0.1
FAR = 1000.0
TIMES = "0..13.0 by 0.1"

Signals = dict[str, list[float]]
GivenTables = dict[str, Any]


class Trace(NamedTuple):
    """Signals by name, the index of the reference point, and the tables that show a rule just that."""

    signals: Signals
    at: int
    given_tables: GivenTables


class Dice(NamedTuple):
    """Chance, and the first steps of what is in the window and of what comes after it: there most ought to change."""

    chance: Random
    edges: tuple[int, int]

    def change(self) -> int | None:
        """Return a step at which a signal is to change for good, at an edge or one beside it; None: anyhow."""
        if self.chance.random() < 0.4:
            return None
        return self.chance.choice(self.edges) + self.chance.choice((-1, 0, 1))


class Spec(NamedTuple):
    """A rule and its formula; `window_s` is (before, after) the reference point, None: an invariant, judged from the start."""

    rule: str
    formula: str
    trace: Callable[[Dice, int], Trace]
    window_s: tuple[float, float] | None = None
    is_measured: bool = True
    surely: str | None = None
    """What must hold, too, for a pass: the rule is unknown where only `formula` holds."""

    def random(self, seed: int) -> Trace:
        """Return the trace of a seed."""
        dice = Random(seed)  # noqa: S311 - traces, not secrets
        before, after = self.window_s or (0.0, 0.0)
        n_before, n_after = round(before / PERIOD_S), round(after / PERIOD_S)
        at = dice.randint(n_before, STEPS - 1 - n_after)
        return self.trace(Dice(dice, (at - n_before, at + n_after + 1)), at)


def walk(dice: Dice, low: float, high: float) -> list[float]:
    """Return a signal that wanders about a random level between `low` and `high`, or about one, then about another."""
    chance, change = dice.chance, dice.change()
    reach = chance.uniform(0, (high - low) / 3)
    levels = [chance.uniform(low, high) for _ in range(2)]
    knots = [chance.uniform(-reach, reach) for _ in range(STEPS // 10 + 2)]
    mixed = [knots[k // 10] * (1 - k % 10 / 10) + knots[k // 10 + 1] * (k % 10 / 10) for k in range(STEPS)]
    about = [levels[change is not None and k >= change] for k in range(STEPS)]
    return [round(min(max(level + value, low), high), 6) for level, value in zip(about, mixed, strict=True)]


def runs(dice: Dice) -> list[bool]:
    """Return a signal that is on for random stretches (always, never, now and then, with short gaps), or changes once."""
    chance, change = dice.chance, dice.change()
    on, rare = chance.random() < 0.5, chance.choice([0.0, 0.01, 0.03, 0.1])
    if change is not None:
        return [on == (k < change) for k in range(STEPS)]
    state, values = on, []
    for _ in range(STEPS):
        state = (not on) if state == on and chance.random() < rare else state if chance.random() < 0.8 else on
        values.append(state)
    return values


def events(dice: Dice) -> list[int]:
    """Return steps at which something happens: none, a few anywhere, or one at an edge of the window."""
    change = dice.change()
    if change is not None and 0 <= change < STEPS:
        return [change]
    return sorted(dice.chance.sample(range(STEPS), dice.chance.choice([0, 0, 1, 2])))


def sign(values: list[bool]) -> list[float]:
    """Return 1 for true and -1 for false."""
    return [1.0 if value else -1.0 for value in values]


def _steps(**columns: Any) -> GivenTables:
    return {"t_s": TIMES, **columns}


def _t(at: int) -> float:
    return round(at * PERIOD_S, 3)


def _signal_before(dice: Dice, at: int) -> Trace:
    lit = runs(dice)
    given_tables = {
        "lane_departure": {"t_s": _t(at), "side": "left", "begin_seen": True, "back": False},
        "ego_state": _steps(indicator=["left" if on else "off" for on in lit]),
    }
    return Trace({"lit": sign(lit)}, at, given_tables)


def _signal_means_go(dice: Dice, at: int) -> Trace:
    yaw = walk(dice, -1.2, 1.2)
    crossings = events(dice)
    given_tables: GivenTables = {
        "indicator_on": {"t_on_s": _t(at), "t_off_s": 13, "side": "left", "at_log_start": False},
        "ego_state": _steps(yaw_rad=yaw, indicator="left"),
    }
    if crossings:
        given_tables["lane_departure"] = [
            {"occurrence": i, "t_s": _t(k), "side": "left", "begin_seen": True} for i, k in enumerate(crossings)
        ]
    signals = {"yaw": yaw, "start": [yaw[at]] * STEPS, "out": sign([k in crossings for k in range(STEPS)])}
    return Trace(signals, at, given_tables)


def _signal_off(dice: Dice, at: int) -> Trace:
    lit = runs(dice)
    given_tables = {
        "indicator_on": {"t_on_s": 0, "t_off_s": 13, "side": "left", "at_log_start": False},
        "lane_change": {"t_start_s": 0, "t_done_s": _t(at), "side": "left", "begin_seen": True, "known": True},
        "ego_state": _steps(indicator=["left" if on else "off" for on in lit]),
    }
    return Trace({"lit": sign(lit)}, at, given_tables)


def _restored(low: float, high: float) -> Callable[[Dice, int], Trace]:
    """Return what makes a vehicle `b` that cut in, at a random gap while the ego drives at a random speed."""

    def trace(dice: Dice, at: int) -> Trace:
        gap, v = walk(dice, low, high), walk(dice, 3.0, 16.0)
        given_tables = {
            "cut_in": {"t_s": _t(at), "object_id": "b", "gap_m": gap[at], "begin_seen": True, "side": "left"},
            "ego_state": _steps(speed_mps=v),
            "lead": _steps(object_id="b", gap_m=gap, ego_speed_mps=v, speed_mps=v, in_lane=True, oncoming=False),
        }
        return Trace({"gap": gap, "v": v}, at, given_tables)

    return trace


def _clear(dice: Dice, at: int) -> Trace:
    clear = walk(dice, -0.5, 2.5)
    given_tables = {
        "cut_in": {"t_s": _t(at), "object_id": "b", "gap_m": 100, "ego_speed_mps": 20, "speed_mps": 19, "side": "left"},
        "ego_state": _steps(speed_mps=20),
        "pair": _steps(object_id="b", clearance_m=clear, clearance_is_bound=False),
    }
    return Trace({"clear": clear}, at, given_tables)


def _passing(dice: Dice, at: int) -> Trace:
    got_ahead = events(dice)
    given_tables: GivenTables = {
        "junction_passage": {"t_in_s": _t(at), "turn": "left", "across": False},
        "ego_state": _steps(speed_mps=8),
    }
    if got_ahead:
        given_tables["passing"] = [
            {"occurrence": i, "t_s": _t(k), "object_id": "c", "ego_passes": True, "side": "left", "speed_mps": 4}
            for i, k in enumerate(got_ahead)
        ]
    return Trace({"free": sign([k not in got_ahead for k in range(STEPS)])}, at, given_tables)


def _speed(dice: Dice, at: int) -> Trace:
    v, limit = walk(dice, 8.0, 16.0), walk(dice, 12.0, 16.0)
    given_tables = {
        "ego_state": _steps(speed_mps=v, limit_mps=limit),
        "ego_condition": _steps(engaged=True, limit_mps=limit, vehicle_class="car", road_type="motorway"),
    }
    # between two samples: up with 3.5 m/s2, then down with 8
    peak = [max(a, (8 * a + 3.5 * b + 28 * PERIOD_S) / 11.5) for a, b in pairwise(v)] + v[-1:]
    return Trace({"v": v, "limit": limit, "peak": peak}, at, given_tables)


def _behind(
    gap: tuple[float, float], v: tuple[float, float], ahead: tuple[float, float]
) -> Callable[[Dice, int], Trace]:
    """Return what makes a vehicle ahead that the ego follows now and then, at random gaps and speeds."""

    def trace(dice: Dice, at: int) -> Trace:
        signals = {"gap": walk(dice, *gap), "v": walk(dice, *v), "w": walk(dice, *ahead)}
        follows = runs(dice)
        given_tables = {
            "ego_state": _steps(speed_mps=signals["v"]),
            "ego_condition": _steps(
                engaged=True, limit_mps=30, weather="dry", road_type="motorway", vehicle_class="bus"
            ),
            "following": _steps(
                object_id="b", follows=follows, gap_m=signals["gap"], ego_speed_mps=signals["v"], speed_mps=signals["w"]
            ),
        }
        return Trace(signals | {"on": [FAR if on else -FAR for on in follows]}, at, given_tables)

    return trace


def _apart(dice: Dice, at: int) -> Trace:
    clear = walk(dice, -0.5, 2.5)
    given_tables = {
        "ego_state": _steps(speed_mps=8, fastest_3s_mps=8),
        "pair": _steps(object_id="b", clearance_m=clear, clearance_is_bound=False),
    }
    return Trace({"clear": clear}, at, given_tables)


def _comfort(dice: Dice, at: int) -> Trace:
    signals = {"a": walk(dice, -5, 3), "lat": walk(dice, -6, 6), "jerk": walk(dice, -5, 5)}
    given_tables = {
        "ego_state": _steps(speed_mps=8),
        "ego_condition": _steps(vehicle_class="car", engaged=True),
        "ego_motion": _steps(accel_mps2=signals["a"], lat_accel_mps2=signals["lat"], jerk_mps3=signals["jerk"]),
    }
    return Trace(signals, at, given_tables)


_STOPPING = "0.058 + 0.289 * (v / 0.44704) + 0.015 * (v / 0.44704) * (v / 0.44704)"

SPECS = (
    Spec("ukhc.r103.signal-before", "historically[0s,5s](lit >= 0)", _signal_before, (5, 0), is_measured=False),
    Spec(
        "ukhc.r103.signal-means-go",
        "eventually[0s,10s]((out >= 0) or (yaw - start >= 0.5))",
        _signal_means_go,
        (0, 10),
        is_measured=False,
    ),
    Spec("ukhc.r103.signal-off", "eventually[0s,5s](lit <= 0)", _signal_off, (0, 5), is_measured=False),
    Spec("ukhc.r168.drop-back", "eventually[0s,10s](gap >= 2 * v)", _restored(0, 30), (0, 10), is_measured=False),
    Spec("ukhc.r182.no-pass-before-turn", "historically[0s,5s](free >= 0)", _passing, (5, 0), is_measured=False),
    Spec(
        "alks-r157.cut-in-gap",
        "eventually[0s,10s](gap >= v * (1.1 + 0.01 * (3.6 * v - 10)))",
        _restored(0, 20),
        (0, 10),
    ),
    Spec("alks-r157.cut-in", "always[0s,5s](clear > 0)", _clear, (0, 5)),
    Spec("ukhc.no-collision", "always(clear > 0)", _apart),
    Spec("ukhc.r124.speed-limit", "always(v <= limit + 0.45)", _speed, surely="always(peak <= limit + 0.45)"),
    Spec("stvo.rg3", "always(v <= limit + 0.83)", _speed, surely="always(peak <= limit + 0.83)"),
    Spec("stvo.s4-truck", "always((on >= 0) -> (gap >= 50))", _behind((40, 90), (15, 25), (15, 25))),
    Spec(
        "stvo.rg1",
        "always((on >= 0) -> (gap >= v * 0.3 + v * v / 20 - w * w / 21))",
        _behind((0, 30), (15, 25), (10, 15)),
    ),
    Spec("ukhc.r126.two-second", "always((on >= 0) -> (gap / v >= 2))", _behind((20, 70), (15, 25), (15, 25))),
    Spec(
        "ukhc.r126.stopping-gap",
        f"always((on >= 0) -> (gap >= {_STOPPING}))",
        _behind((30, 110), (15, 25), (15, 25)),
    ),
    Spec("comfort.lateral", "always(abs(lat) <= 3)", _comfort),
    Spec(
        "comfort.nuplan",
        "always((a / 2.4 <= 1) and ((0 - a) / 4.05 <= 1) and (abs(lat) / 4.89 <= 1) and (abs(jerk) / 4.13 <= 1))",
        _comfort,
    ),
)
