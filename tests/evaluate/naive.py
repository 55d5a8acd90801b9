"""A slow, obvious evaluator of one subject: loops over steps, written from the text of the design and not from the
engine."""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

Holds = bool | None


class Step(NamedTuple):
    """One judged or expected step. `applies` and `value` are three-valued; `present`: the condition returned a row.

    `engaged` and `wet`, three-valued too: whether the automated driver drives, and whether a rule for wet roads is in force.
    """

    t: int
    seg: int
    present: bool
    applies: bool | None
    value: float | None
    engaged: bool | None = True
    wet: bool | None = True


class Outcome(NamedTuple):
    """What a verdict row says."""

    start: int
    end: int
    verdict: str
    code: str
    worst: int | None
    n_expected: int
    n_judged: int


def segments(times: list[int], gap: int) -> list[int]:
    """Number the segments between holes."""
    out, seg = [], 0
    for i, t in enumerate(times):
        seg += bool(i and t - times[i - 1] > gap)
        out.append(seg)
    return out


def in_force(step: Step, *, wet_only: bool) -> bool | None:
    """Whether a rule is in force: the driver is engaged and, where the rule is for wet roads only, the road is wet."""
    said = [step.engaged, step.wet] if wet_only else [step.engaged]
    if False in said:
        return False
    return None if None in said else True


def blind(step: Step, *, wet_only: bool) -> Step:
    """Return the step as a rule sees it that may not be in force there."""
    return step._replace(wet=step.wet if wet_only else True)


def holds(step: Step) -> Holds:
    """More than zero is required."""
    applies = True if not step.present else step.applies
    if not (step.engaged and step.wet) or not step.present or applies is None or step.value is None:
        return None
    return step.value > 0


def why_unknown(step: Step) -> str:
    if step.engaged is not True:
        return "engaged_unknown" if step.engaged is None else "not_engaged"
    if step.wet is None:
        return "weather_unknown"
    if not step.present:
        return "missing_step"
    return "applies_unknown" if step.applies is None else "null_value"


def expected(steps: list[Step]) -> list[Step]:
    return [s for s in steps if not (s.present and s.applies is False)]


def worst(steps: list[Step], *, eventually: bool = False) -> int | None:
    judged = [s for s in steps if holds(s) is not None]
    if not judged:
        return min((s.t for s in steps), default=None)
    best = None
    for s in judged:
        assert s.value is not None
        if best is None or (s.value > best.value if eventually else s.value < best.value):  # type: ignore[operator]
            best = s
    return best.t if best else None


def judge(steps: list[Step], *, eventually: bool = False, problem: str = "") -> tuple[str, str]:
    """Return verdict and reason code of expected steps in time order."""
    values = [holds(s) for s in steps]
    if eventually and True in values:
        return "pass", "kept"
    if not eventually and False in values:
        return "fail", "violated"
    if problem:
        return "unknown", problem
    if None in values:
        return "unknown", why_unknown(steps[values.index(None)])
    return ("fail", "violated") if eventually else ("pass", "kept")


def invariant(steps: list[Step], gap: int, period: int, *, wet_only: bool = False) -> list[Outcome]:
    """Episodes and holes of one series, in time order."""
    forced = [s for s in steps if in_force(s, wet_only=wet_only) is not False]
    live = expected([blind(s, wet_only=wet_only) for s in forced])
    out: list[Outcome] = []
    episode: list[Step] = []
    for step in live:
        if episode and (step.seg != episode[-1].seg or step.t - episode[-1].t > gap):
            out.append(_episode(episode))
            episode = []
        episode.append(step)
    if episode:
        out.append(_episode(episode))
    return sorted([*out, *_holes(live, steps, gap, period)], key=lambda outcome: (outcome.start, outcome.end))


def _episode(steps: list[Step]) -> Outcome:
    verdict, code = judge(steps)
    return Outcome(
        steps[0].t, steps[-1].t, verdict, code, worst(steps), len(steps), sum(holds(s) is not None for s in steps)
    )


def _holes(live: list[Step], steps: list[Step], gap: int, period: int) -> list[Outcome]:
    """Holes that the rule reaches: it applies at the last step before, or at the first step after."""
    out = []
    for before in sorted({step.seg for step in steps})[:-1]:
        start = max(step.t for step in steps if step.seg == before)
        end = min(step.t for step in steps if step.seg == before + 1)
        reaches = [
            s for s in live if (s.seg == before and start - s.t <= gap) or (s.seg == before + 1 and s.t - end <= gap)
        ]
        if reaches:
            out.append(Outcome(start, end, "unknown", "log_hole", start, max(1, (end - start) // period - 1), 0))
    return out


def window(steps: list[Step], a: int, b: int, gap: int, *, eventually: bool) -> Outcome:
    """A temporal condition over [a, b]."""
    inside = [s for s in steps if a <= s.t <= b]
    log_start, log_end = steps[0].t, steps[-1].t
    problem = ""
    edges = [a, *(s.t for s in inside), b]
    if not inside:
        problem = "window_truncated" if a < log_start or b > log_end else "log_hole"
    elif (inside[0].t - a > gap and inside[0].t == log_start) or (b - inside[-1].t > gap and inside[-1].t == log_end):
        problem = "window_truncated"
    elif edges[1] - a > gap or b - edges[-2] > gap or any(y.seg != x.seg for x, y in pairwise(inside)):
        problem = "log_hole"
    return _reference(
        expected([blind(s, wet_only=False) for s in inside]), a, b, eventually=eventually, problem=problem
    )


def occasion(steps: list[Step], t: int, otherwise: Outcome, *, wet_only: bool, physical: bool) -> Outcome:
    """A reference point: where the rule is not in force, or may not be, that is the verdict, and no anchor is looked for."""
    here = next(
        (s for s in steps if s.t == t), Step(t, -1, present=False, applies=True, value=None, engaged=None, wet=None)
    )
    if here.seg < 0 and all(s.engaged for s in steps):
        here = here._replace(engaged=True)  # nothing was ever said of the driver
    force = in_force(here, wet_only=wet_only)
    if force:
        return otherwise
    a, b = (t, t) if physical else (otherwise.start, otherwise.end)
    if force is False:
        return Outcome(a, b, "not_applicable", "outside_conditions", None, 0, 0)
    code = "engaged_unknown" if here.engaged is None else "weather_unknown"
    return Outcome(a, b, "unknown", code, None, 0, 0)


def points(steps: list[Step], at: list[int], *, eventually: bool = False) -> Outcome:
    """An execution (one time) or a physical condition (several)."""
    by_time = {s.t: blind(s, wet_only=False) for s in steps}
    nothing = True if all(s.engaged for s in steps) else None
    asked = [by_time.get(t, Step(t, -1, present=False, applies=True, value=None, engaged=nothing)) for t in sorted(at)]
    return _reference(expected(asked), min(at), max(at), eventually=eventually, problem="")


def _reference(live: list[Step], a: int, b: int, *, eventually: bool, problem: str) -> Outcome:
    if not live and not problem:
        return Outcome(a, b, "not_applicable", "outside_conditions", None, 0, 0)
    verdict, code = judge(live, eventually=eventually, problem=problem)
    return Outcome(
        a, b, verdict, code, worst(live, eventually=eventually), len(live), sum(holds(s) is not None for s in live)
    )


def stretches(steps: list[Step], merge: int) -> list[tuple[int, int]]:
    """Failing runs of one invariant's series: adjacent failing steps, and runs closer than `merge`; never across a
    hole."""
    runs: list[tuple[int, int]] = []
    last: tuple[int, Step] | None = None
    for k, step in enumerate(steps):
        if holds(blind(step, wet_only=False)) is not False or (step.present and step.applies is False):
            continue
        joined = last is not None and last[1].seg == step.seg and (k - last[0] == 1 or step.t - last[1].t < merge)
        runs = [*runs[:-1], (runs[-1][0], step.t)] if joined else [*runs, (step.t, step.t)]
        last = (k, step)
    return runs
