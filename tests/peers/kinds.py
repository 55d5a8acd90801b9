"""Why two verdicts on a rule differ: kinds, each computed from the numbers of both sides at the steps at which one finds a breach."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from .sides import Pair

Row = dict[str, Any]
REACTION_S = 0.3
BRAKE_MPS2, BRAKE_LEAD_MPS2 = 10.0, 10.5
ABRUPT_MPS2 = -2.0
NEIGHBOUR_M, STRIP_M = 30.0, 15.0
STANDING_MPS = 0.5


class Kind(NamedTuple):
    """A kind of difference: of which rules, who finds the breach ("peer" or "ours"), and why that is so, by which clause."""

    name: str
    rules: tuple[str, ...]
    breach: str
    explanation: str
    clause: str


def load_kinds() -> list[Kind]:
    """Return the kinds of `stvo_kinds.toml`."""
    table = tomllib.loads(Path(__file__).with_name("stvo_kinds.toml").read_text(encoding="utf-8"))
    return [
        Kind(name, tuple(entry["rules"]), entry["breach"], entry["explanation"], entry["clause"])
        for name, entry in table.items()
    ]


def kinds(pair: Pair, known_kinds: Sequence[Kind]) -> list[str]:
    """Return the kinds that explain a difference, most frequent first; none unless every step of the breach is of one of them."""
    breach = "peer" if pair.peer_result == "broken" else "ours"
    steps = pair.breaks if breach == "peer" else pair.fails
    able = [kind for kind in known_kinds if pair.rule in kind.rules and kind.breach == breach]
    counts = dict.fromkeys((kind.name for kind in able), 0)
    for step in steps:
        fitting = [kind.name for kind in able if FACTS[kind.name](pair, step)]
        if not fitting:
            return []
        for name in fitting:
            counts[name] += 1
    return sorted((name for name, n in counts.items() if n), key=lambda name: (-counts[name], name))


def safe_gap_m(v_mps: float, lead_mps: float) -> float:
    """Return the safe distance of Maierhofer et al. 2020, with the reaction time of our rule."""
    return v_mps * REACTION_S + v_mps**2 / (2 * BRAKE_MPS2) - lead_mps**2 / (2 * BRAKE_LEAD_MPS2)


def ahead(row: Row) -> list[Row]:
    """Return the vehicles ahead in the lane as the peer sees it, nearest first."""
    return sorted(
        (other for other in row["others"] if other["same_lane"] and other["gap_m"] >= 0),
        key=lambda other: other["gap_m"],
    )


def too_near(row: Row) -> list[Row]:
    """Return the vehicles ahead that are nearer than the safe distance, with the reaction time of our rule."""
    return [other for other in ahead(row) if other["gap_m"] < safe_gap_m(row["v_mps"], other["v_mps"])]


def rows_before(pair: Pair, step: int, seconds: float) -> list[Row]:
    """Return the steps up to this one."""
    return [pair.steps[k] for k in range(step - round(seconds / pair.dt_s), step + 1) if k in pair.steps]


def _swaying_cuts_in(pair: Pair, step: int) -> bool:
    """Whoever is too near was in the ego's lane at every step of the 3 s before."""
    row = pair.steps.get(step)
    return row is not None and any(
        all(
            seen["same_lane"]
            for earlier in rows_before(pair, step, 3.0)
            for seen in earlier["others"]
            if seen["id"] == other["id"]
        )
        for other in too_near(row)
    )


def _is_last_step(pair: Pair, step: int) -> bool:
    """The peer has no value for the last step of a vehicle."""
    return pair.last_step is not None and step >= pair.last_step


def _longer_reaction(pair: Pair, step: int) -> bool:
    """With a reaction time of 0.3 s nobody ahead is too near."""
    return bool(ahead(pair.steps[step])) and not too_near(pair.steps[step])


def _reason_a_moment_ago(pair: Pair, step: int) -> bool:
    """Within the second before, the vehicle ahead was too near, or the ego now brakes no harder than that vehicle did."""
    now = pair.steps[step]
    for row in rows_before(pair, step, 1.0):
        for lead in ahead(row)[:1]:
            if lead in too_near(row) or now["a_mps2"] - lead["a_mps2"] >= ABRUPT_MPS2:
                return True
    return False


def _peak_of_samples(pair: Pair, step: int) -> bool:
    """Ours has judged that step, and without the noise of single samples the ego braked within the limit."""
    return pair.values.get(step, -9.0) >= ABRUPT_MPS2


def _at_the_end_of_the_track(pair: Pair, step: int) -> bool:
    """Within 0.2 s of the ends of the ego's track a filter has no whole window."""
    edge = round(0.2 / pair.dt_s)
    return step < min(pair.steps) + edge or step > max(pair.steps) - edge


def _stopped_behind_a_queue(pair: Pair, step: int) -> bool:
    """When the ego slowed down to below 5 km/h, a vehicle in congestion was within 30 m ahead of it."""
    begin = step
    while begin - 1 in pair.steps and pair.steps[begin - 1]["v_mps"] < 5 / 3.6:
        begin -= 1
    rows = [pair.steps[k] for k in range(begin, step + 1) if k in pair.steps]
    first_stop = next((row for row in rows if row["v_mps"] < 0.1), rows[0])
    return any(
        lead["gap_m"] <= 30 and lead["v_mps"] <= 2.78 for row in (rows[0], first_stop) for lead in ahead(row)[:1]
    )


def _never_stood(pair: Pair, step: int) -> bool:
    """The ego is slow but does not stand, at that step or within half a second of it."""
    near = range(step - round(0.5 / pair.dt_s), step + round(0.5 / pair.dt_s) + 1)
    return all(pair.steps[k]["v_mps"] >= 0.1 for k in near if k in pair.steps)


def _front_ahead_m(other_vehicle: Row) -> float:
    """Return how far the front of another vehicle is ahead of the ego's."""
    return float(other_vehicle["gap_m"] + other_vehicle["length_m"])


def _passes(pair: Pair, vehicle: str) -> bool:
    """Whether the ego's front was behind the front of another vehicle, and later is ahead of it, both by more than 0.25 m."""
    fronts = [
        _front_ahead_m(other) for k in sorted(pair.steps) for other in pair.steps[k]["others"] if other["id"] == vehicle
    ]
    behind = [n for n, front_m in enumerate(fronts) if front_m > 0.25]
    return bool(behind) and any(front_m < -0.25 for front_m in fronts[behind[0] :])


def _alongside_only(pair: Pair, step: int) -> bool:
    """The ego gets ahead of none of the slower vehicles that are beside it, to its left, at that step, while its track lasts."""
    row = pair.steps[step]
    beside = [
        other["id"]
        for other in row["others"]
        if other["gap_m"] <= 0
        and other["behind_m"] <= 0
        and other["v_mps"] < row["v_mps"]
        and other["d_m"] > row["d_m"]
    ]
    return bool(beside) and not any(_passes(pair, vehicle) for vehicle in beside)


def _must_brake(pair: Pair, step: int) -> bool:
    """For us, somebody in the ego's way asks for 2 m/s2."""
    return pair.needs.get(step, 0.0) >= -ABRUPT_MPS2


def _fewer_than_three_ahead(pair: Pair, step: int) -> bool:
    """Fewer than three slow vehicles are ahead in the lane."""
    row = pair.steps.get(step)
    return row is not None and sum(other["v_mps"] <= 8.33 for other in ahead(row)) < 3


def _faster_than_walking_pace(pair: Pair, step: int) -> bool:
    """The ego or the vehicle ahead drives faster than 10 km/h."""
    row = pair.steps[step]
    return row["v_mps"] > 2.78 or any(lead["v_mps"] > 2.78 for lead in ahead(row)[:1])


def _border_within_75_cm(pair: Pair, step: int) -> bool:
    """Ours has measured between 0.2 and 0.75 m to the border."""
    return 0.2 < pair.values.get(step, 9.0) <= 0.75


def _no_faster(row: Row, v_mps: float) -> list[Row]:
    """Return the vehicles at a step that are no faster than v_mps and ahead in the lane, or beside it within 30 m."""
    beside = [
        other
        for other in row["others"]
        if not other["same_lane"]
        and max(other["gap_m"], other["behind_m"]) <= NEIGHBOUR_M
        and abs(other["d_m"] - row["d_m"]) <= STRIP_M
    ]
    return [other for other in [*ahead(row)[:1], *beside] if other["v_mps"] <= v_mps]


def _slow_vehicle_beside(pair: Pair, step: int) -> bool:
    """A vehicle ahead or beside is no faster than the ego."""
    row = pair.steps.get(step)
    return row is not None and bool(_no_faster(row, row["v_mps"]))


def _time_to_speed_up(pair: Pair, step: int) -> bool:
    """In the 10 s before, a vehicle ahead or beside was no faster than the ego is now, or in the 15 s before the ego stood."""
    row = pair.steps.get(step)
    return row is not None and (
        any(_no_faster(earlier, row["v_mps"]) for earlier in rows_before(pair, step, 10.0))
        or any(earlier["v_mps"] <= STANDING_MPS < row["v_mps"] for earlier in rows_before(pair, step, 15.0))
    )


def _within_tolerance(pair: Pair, step: int) -> bool:
    """Ours has judged that step, and the speed is within the tolerance."""
    return step in pair.values


def _limit_of_another_country(pair: Pair, step: int) -> bool:
    """The scenario's id is not German, and at that step there is a limit for us."""
    return pair.scenario[:3] not in ("DEU", "ZAM") and "+" not in pair.scenario and step in pair.fails


def _touches_several_lanes(pair: Pair, step: int) -> bool:
    """The ego's box is on more than one lanelet."""
    return bool(pair.steps[step]["lanes"] > 1)


FACTS: Mapping[str, Callable[[Pair, int], bool]] = {
    "swaying_cuts_in": _swaying_cuts_in,
    "last_step": _is_last_step,
    "longer_reaction": _longer_reaction,
    "reason_a_moment_ago": _reason_a_moment_ago,
    "must_brake": _must_brake,
    "peak_of_samples": _peak_of_samples,
    "end_of_track": _at_the_end_of_the_track,
    "stopped_behind_a_queue": _stopped_behind_a_queue,
    "rolls": _never_stood,
    "alongside_only": _alongside_only,
    "fewer_than_three_ahead": _fewer_than_three_ahead,
    "faster_than_walking_pace": _faster_than_walking_pace,
    "border_within_75_cm": _border_within_75_cm,
    "slow_vehicle_beside": _slow_vehicle_beside,
    "time_to_speed_up": _time_to_speed_up,
    "within_tolerance": _within_tolerance,
    "limit_of_another_country": _limit_of_another_country,
    "touches_several_lanes": _touches_several_lanes,
}
