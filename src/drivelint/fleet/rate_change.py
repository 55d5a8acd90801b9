"""Tests whether the rates of two audits differ, by an exact test and a correction for many rules."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from drivelint.fleet.intervals import holm
from drivelint.fleet.rates import OTHER, rates

if TYPE_CHECKING:
    from collections.abc import Sequence

    import duckdb

    from drivelint.fleet.rates import Rate

ALLOWED_FALSE_CALLS: Final = 0.05
"""The chance that any rule is called if the rates of no rule differ."""


@dataclass(frozen=True)
class RateChange:
    """The rates of a rule in two audits. `base`, `new`: of the logs that only one of the audits has; None: it has none of them.

    `p_value`: the chance of a difference like this or a rarer one, if findings per km are the same; None: one audit has no exposure.
    `corrected`: the same, corrected for all rules that were tested.
    """

    rule_id: str
    profile: str | None
    tag_value: str | None
    base: Rate | None
    new: Rate | None
    p_value: float | None
    corrected: float | None

    @property
    def is_called(self) -> bool:
        """Whether the rates differ, as far as 5 % of false calls in all rules together are allowed."""
        return self.corrected is not None and self.corrected <= ALLOWED_FALSE_CALLS


def compare_rates(
    con: duckdb.DuckDBPyConnection, by: str | None = None, *, base: str = "", new: str = OTHER
) -> list[RateChange]:
    """Return for each rule, profile and value of a tag whether its rate differs between two audits.

    Only logs that one of the audits has are counted. Where both have a log, chance has no part in the difference: the findings of
    `compare` are all there is to say, and a test of independent samples would be wrong.
    """
    sides = rates(con, by, of=base, without=new), rates(con, by, of=new, without=base)
    return rate_changes(*sides)


def rate_changes(base: Sequence[Rate], new: Sequence[Rate]) -> list[RateChange]:
    """Return the changes of these rates, whose exposures are independent of each other, in the order of their names.

    The test is exact, given the sum of the findings: if findings per km are the same, each of them falls into the new audit with the new
    audit's share of the exposure. Like the interval of a rate, it assumes that findings occur independently of each other.
    """
    had, has = ({(rate.rule_id, rate.profile, rate.tag_value): rate for rate in side} for side in (base, new))
    names = sorted(had.keys() | has.keys(), key=lambda name: tuple((part is not None, part or "") for part in name))
    values = {name: p for name in names if (p := _p_value(had.get(name), has.get(name))) is not None}
    corrected = dict(zip(values, holm(list(values.values())), strict=True))
    return [RateChange(*name, had.get(name), has.get(name), values.get(name), corrected.get(name)) for name in names]


def _p_value(base: Rate | None, new: Rate | None) -> float | None:
    from scipy.stats import binomtest

    if base is None or new is None or base.km <= 0 or new.km <= 0:
        return None
    findings = base.findings + new.findings
    if not findings:
        return 1.0
    return float(binomtest(new.findings, findings, new.km / (base.km + new.km)).pvalue)
