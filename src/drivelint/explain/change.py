"""The nearest value of each parameter and profile number that would change the verdict."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, NamedTuple

from drivelint.errors import DriveLintError
from drivelint.explain.model import Change

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from drivelint.explain.sandbox import Sandbox
    from drivelint.explain.verdict_context import VerdictContext

SEARCH_FACTORS: Final = (0.02, 0.1, 0.25, 0.5, 1.0, 3.0, 10.0)
"""How far to look in each direction, in parts of the value as it is (of 1 where it is 0)."""
_HALVINGS: Final = 8
_PROFILE: Final = {
    "pull_out_angle_rad": ("rad", "angle at which this profile pulls out"),
    "cut_in_angle_rad": ("rad", "angle at which this profile cuts in"),
    "pull_out_headroom_m": ("m", "gap to the vehicle ahead at which this profile pulls out"),
    "cut_in_clearance_m": ("m", "gap to the vehicle behind at which this profile cuts in"),
}


class _Number(NamedTuple):
    name: str
    what: str
    unit: str
    now: float
    most: float
    judge: Callable[[float], str]


def verdict_changes(context: VerdictContext, sandbox: Sandbox, verdict: str) -> list[Change]:
    """Return the nearest change of each number that changes `verdict` on the drive in `sandbox`, the least relative one first."""
    found = [_nearest(number, verdict) for number in _numbers(context, sandbox)]
    return sorted(found, key=lambda c: (c.found is None, abs((c.found or 0.0) - c.now) / (abs(c.now) or 1.0), c.name))


def _numbers(context: VerdictContext, sandbox: Sandbox) -> Iterator[_Number]:
    for name, param in context.rule.params.items():
        now = context.params[name]
        if isinstance(now, bool) or not isinstance(now, int | float):
            continue

        def with_param(value: float, name: str = name) -> str:
            try:
                return context.judge(sandbox, {**context.params, name: value})
            except DriveLintError:  # no value for this parameter, such as a window of less than nothing
                return "error"

        yield _Number(name, param.why, param.unit, float(now), math.inf, with_param)
    profile = context.target.verdict_row["profile"]
    if not context.rule.per_profile or profile is None:
        return
    for row in sandbox.query("SELECT * FROM profile WHERE profile = ?", [profile]):
        for column, (unit, what) in _PROFILE.items():
            now = row[column]
            if now is None:
                continue  # the profile that this overtake itself had

            def with_profile(value: float, column: str = column) -> str:
                sandbox.set_profile(profile, column, value)
                return context.judge(sandbox)

            most = math.pi / 2 if unit == "rad" else math.inf
            try:
                yield _Number(f"{profile}.{column}", what, unit, float(now), most, with_profile)
            finally:
                sandbox.set_profile(profile, column, now)


def _nearest(number: _Number, verdict: str) -> Change:
    """Look outwards on both sides at once until the verdict changes on one, then halve the last stretch there."""
    scale = abs(number.now) or 1.0
    least = 0.0 if number.now >= 0 else -math.inf  # a number that is not negative stays so
    sides = [_values(number, scale * sign, least) for sign in (1, -1)]
    low, high = min(number.now, *sides[1]), max(number.now, *sides[0])
    none = Change(number.name, number.what, number.unit, number.now, None, None, False, low, high)
    shut: set[int] = set()
    for n in range(len(SEARCH_FACTORS)):
        edges: list[Change] = []
        for side, values in enumerate(sides):
            if n >= len(values) or side in shut:
                continue
            becomes = number.judge(values[n])
            if becomes == "error":
                shut.add(side)  # no value beyond it means anything
            elif not _same(becomes, verdict):
                value, beyond = _edge(number, values, n, becomes)
                edges.append(none._replace(found=value, becomes=becomes, beyond=beyond))
        if edges:
            return min(edges, key=lambda edge: (abs((edge.found or 0.0) - number.now), edge.found))
    return none


def _values(number: _Number, scale: float, least: float) -> list[float]:
    """Return the values to look at on one side, nearest first."""
    reached = dict.fromkeys(min(number.most, max(least, number.now + scale * factor)) for factor in SEARCH_FACTORS)
    return [value for value in reached if value != number.now]


def _same(becomes: str, verdict: str) -> bool:
    """Whether the verdict is the same; a decided one that becomes unknown counts as the same: such a value makes no sense."""
    return becomes == verdict or (becomes == "unknown" and verdict in {"pass", "fail"})


def _edge(number: _Number, values: list[float], at: int, becomes: str) -> tuple[float, bool]:
    """Return the nearest value on one side that changes the verdict, and whether those further away agree."""
    near, far = (values[at - 1] if at else number.now), values[at]
    for _ in range(_HALVINGS):
        middle = (near + far) / 2
        if number.judge(middle) == becomes:
            far = middle
        else:
            near = middle
    further = values[at + 1 : at + 3] or [values[at]]
    return _round(number, far, becomes), all(number.judge(v) == becomes for v in further)


def _round(number: _Number, far: float, becomes: str) -> float:
    """Return a short number at or just beyond `far`, at which the verdict is the same."""
    away = math.ceil if far > number.now else math.floor
    size = math.floor(math.log10(max(abs(far), 1e-12)))
    for digits in range(1, 7):
        unit = 10.0 ** (size - digits + 1)
        value = float(f"{away(far / unit) * unit:.{digits}g}")
        if abs(value - far) <= max(0.05 * abs(far - number.now), 1e-9) and number.judge(value) == becomes:
            return value
    return far
