"""Searches for the nearest value of each parameter and profile number that would change the verdict.

The searches of all numbers run side by side: each requests verdicts for some values, and one evaluation judges all requested values.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, NamedTuple

from drivelint.explain.model import NearestChange

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterator, Sequence

    from drivelint.explain.sandbox import Sandbox
    from drivelint.explain.verdict_context import VerdictContext

    Search = Generator[Sequence[float], dict[float, str], NearestChange]

RELATIVE_SEARCH_DISTANCES: Final = (0.02, 0.1, 0.25, 0.5, 1.0, 3.0, 10.0)
"""The distances of the tried values in each direction, as multiples of the present value (of 1 if it is 0)."""
_N_DISTANCES_TRIED_FIRST: Final = 3
"""The number of distances that are judged first, because most changes of a verdict occur there."""
_LEAST_HALVINGS_OF_INTERVAL: Final = 8
_MOST_HALVINGS_OF_INTERVAL: Final = 12
_RELATIVE_SEARCH_TOLERANCE: Final = 0.005
"""After the least number of halvings, the interval in which the verdict changes is halved until it is at most this share of the value.

A value is rounded by at most this share."""
_UNIT_AND_TEXT_BY_COLUMN: Final = {
    "pull_out_angle_rad": ("rad", "angle at which this profile pulls out"),
    "cut_in_angle_rad": ("rad", "angle at which this profile cuts in"),
    "pull_out_headroom_m": ("m", "gap to the vehicle ahead at which this profile pulls out"),
    "cut_in_clearance_m": ("m", "gap to the vehicle behind at which this profile cuts in"),
}


class _VariedNumber(NamedTuple):
    """A number that is varied. `column`: a profile's column, None for a parameter; `halvings`: number per evaluation."""

    name: str
    description: str
    unit: str
    now: float
    maximum: float
    column: str | None
    halvings: int


def nearest_changes_of_verdict(context: VerdictContext, sandbox: Sandbox, verdict: str) -> list[NearestChange]:
    """Return the nearest change of each number that changes `verdict` on the drive in `sandbox`, the least relative change first.

    The tables of `sandbox` that are derived from profiles are not valid afterwards.
    """
    changes = [
        *_search_changes(
            list(_varied_parameters(context)),
            verdict,
            lambda tried_values: _verdicts_with_parameters(context, sandbox, tried_values),
        ),
        *_search_changes(
            list(_varied_profile_numbers(context, sandbox)),
            verdict,
            lambda tried_values: _verdicts_with_profiles(context, sandbox, tried_values),
        ),
    ]
    return sorted(
        changes,
        key=lambda c: (c.nearest_value is None, abs((c.nearest_value or 0.0) - c.now) / (abs(c.now) or 1.0), c.name),
    )


def _varied_parameters(context: VerdictContext) -> Iterator[_VariedNumber]:
    for name, param in context.rule.params.items():
        now = context.params[name]
        if not isinstance(now, bool) and isinstance(now, int | float):
            # one more value costs half as much as starting and ending an evaluation
            yield _VariedNumber(name, param.why, param.unit, float(now), math.inf, None, halvings=2)


def _varied_profile_numbers(context: VerdictContext, sandbox: Sandbox) -> Iterator[_VariedNumber]:
    profile = context.target.verdict_row["profile"]
    if not context.rule.per_profile or profile is None:
        return
    for row in sandbox.query("SELECT * FROM profile WHERE profile = ?", [profile]):
        for column, (unit, text) in _UNIT_AND_TEXT_BY_COLUMN.items():
            now = row[column]
            if now is not None:  # NULL: the profile `observed`
                maximum = math.pi / 2 if unit == "rad" else math.inf
                # one more value is one more row, which costs almost nothing
                yield _VariedNumber(f"{profile}.{column}", text, unit, float(now), maximum, column, halvings=4)


def _verdicts_with_parameters(
    context: VerdictContext, sandbox: Sandbox, tried_values: Sequence[tuple[_VariedNumber, float]]
) -> list[str]:
    judgements = sandbox.judge_each([{**context.params, number.name: value} for number, value in tried_values])
    return [
        "error" if judgement is None else context.verdicts_on(judgement, [sandbox.drive_id])[0]
        for judgement in judgements
    ]


def _verdicts_with_profiles(
    context: VerdictContext, sandbox: Sandbox, tried_values: Sequence[tuple[_VariedNumber, float]]
) -> list[str]:
    columns_and_values = [(number.column, value) for number, value in tried_values if number.column is not None]
    judgements = sandbox.judge_profiles(context.params, context.target.verdict_row["profile"], columns_and_values)
    return [context.verdicts_on(judgement, [sandbox.drive_id])[0] for judgement in judgements]


def _search_changes(
    numbers: Sequence[_VariedNumber], verdict: str, judge: Callable[[Sequence[tuple[_VariedNumber, float]]], list[str]]
) -> list[NearestChange]:
    """Return the nearest change of each number. `judge` returns the verdict for each number and value."""
    changes: list[NearestChange] = []
    running: list[tuple[_VariedNumber, Search, dict[float, str] | None]] = [
        (n, _search_nearest_change(n, verdict), None) for n in numbers
    ]
    while running:
        requests: list[tuple[_VariedNumber, Search, Sequence[float]]] = []
        for number, search, answer in running:
            try:
                requests.append((number, search, next(search) if answer is None else search.send(answer)))
            except StopIteration as end:
                changes.append(end.value)
        flat = [(number, value) for number, _, values in requests for value in values]
        verdicts = iter(judge(flat) if flat else [])
        running = [(number, search, {v: next(verdicts) for v in values}) for number, search, values in requests]
    return changes


def _search_nearest_change(number: _VariedNumber, verdict: str) -> Search:
    """Try values further away on both sides until the verdict changes on one side, then halve the last interval there."""
    scale = abs(number.now) or 1.0
    least = 0.0 if number.now >= 0 else -math.inf  # keep a number that is not negative at 0 or more
    sides = [_values_to_try(number, scale * sign, least) for sign in (1, -1)]
    low, high = min(number.now, *sides[1]), max(number.now, *sides[0])
    no_change = NearestChange(number.name, number.description, number.unit, number.now, None, None, False, low, high)
    shut: set[int] = set()
    verdicts: dict[float, str] = {}
    for n in range(len(RELATIVE_SEARCH_DISTANCES)):
        if n in {0, _N_DISTANCES_TRIED_FIRST}:
            verdicts |= yield [v for values in sides for v in values[n : _N_DISTANCES_TRIED_FIRST if n == 0 else None]]
        edges: list[NearestChange] = []
        for side, values in enumerate(sides):
            if n >= len(values) or side in shut:
                continue
            becomes = verdicts[values[n]]
            if becomes == "error":
                shut.add(side)  # values beyond are not valid either
            elif not _is_no_useful_change(becomes, verdict):
                value, becomes, beyond = yield from _nearest_changing_value(number, values, n, verdict, verdicts)
                edges.append(no_change._replace(nearest_value=value, becomes=becomes, beyond=beyond))
        if edges:
            return min(edges, key=lambda edge: (abs((edge.nearest_value or 0.0) - number.now), edge.nearest_value))
    return no_change


def _values_to_try(number: _VariedNumber, scale: float, least: float) -> list[float]:
    """Return the values to try on one side, the nearest first."""
    reached = dict.fromkeys(
        min(number.maximum, max(least, number.now + scale * factor)) for factor in RELATIVE_SEARCH_DISTANCES
    )
    return [value for value in reached if value != number.now]


def _is_no_useful_change(becomes: str, verdict: str) -> bool:
    """Return whether a verdict counts as unchanged: it is the same, or a pass or fail became unknown, which is no useful change."""
    return becomes == verdict or (becomes == "unknown" and verdict in {"pass", "fail"})


def _nearest_changing_value(
    number: _VariedNumber, values: list[float], index: int, verdict: str, verdicts: dict[float, str]
) -> Generator[Sequence[float], dict[float, str], tuple[float, str, bool]]:
    """Return the nearest value on one side that changes the verdict, the new verdict, and whether values further away give it too."""
    near, far = (values[index - 1] if index else number.now), values[index]
    becomes = verdicts[far]
    for n in range(0, _MOST_HALVINGS_OF_INTERVAL, number.halvings):
        if n >= _LEAST_HALVINGS_OF_INTERVAL and abs(far - near) <= _RELATIVE_SEARCH_TOLERANCE * abs(far):
            break
        halved = yield list(_values_by_halving(near, far, number.halvings))
        for _ in range(number.halvings):
            middle = (near + far) / 2
            if halved[middle] == "error" or _is_no_useful_change(halved[middle], verdict):
                near = middle
            else:  # the verdict may differ from that further away: fail, then pass, then not applicable
                far, becomes = middle, halved[middle]
    further = values[index + 1 : index + 3] or [values[index]]
    short = _values_with_few_digits_beyond(number, far)
    verdicts = verdicts | (yield [v for v in dict.fromkeys((*further, *short[:1])) if v not in verdicts])
    beyond = all(verdicts[v] == becomes for v in further)
    for value in short:
        if value not in verdicts:
            verdicts |= yield [value]
        if verdicts[value] == becomes:
            return value, becomes, beyond
    return far, becomes, beyond


def _values_by_halving(near: float, far: float, halvings: int) -> Iterator[float]:
    """Yield every value that `halvings` halvings of the interval from `near` to `far` can reach."""
    if halvings:
        middle = (near + far) / 2
        yield middle
        yield from _values_by_halving(near, middle, halvings - 1)
        yield from _values_by_halving(middle, far, halvings - 1)


def _values_with_few_digits_beyond(number: _VariedNumber, far: float) -> list[float]:
    """Return numbers with few digits at or just beyond `far`, the shortest first."""
    away = math.ceil if far > number.now else math.floor
    size = math.floor(math.log10(max(abs(far), 1e-12)))
    values = []
    for digits in range(1, 7):
        unit = 10.0 ** (size - digits + 1)
        value = float(f"{away(far / unit) * unit:.{digits}g}")
        if abs(value - far) <= max(min(0.05 * abs(far - number.now), _RELATIVE_SEARCH_TOLERANCE * abs(far)), 1e-9):
            values.append(value)
    return values
