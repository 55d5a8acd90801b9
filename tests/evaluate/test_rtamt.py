"""Windowed rules of the catalogue against rtamt, which monitors signal temporal logic: the same verdict, and its robustness
is our margin.

Both mean the same only where three things are set alike, as the tests at the end hold with rtamt 0.4.10. Its monitor of discrete time
counts samples and does not look at times, so there is one at every period, 0.1 s, in both. A bound of 5 s has 51 samples, both ends among
them. At the end of a log it judges what is left of a window, and ours says unknown, so each window lies wholly in the log.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from drivelint.casefile.merged_cases import NumberedCase, judge, merge_cases, outcome_of_case
from drivelint.casefile.scene import complete_scene
from drivelint.catalogue import load_rules
from tests.evaluate.stl import FAR, PERIOD_S, SPECS, STEPS, TIMES, Spec, Trace

if TYPE_CHECKING:
    from drivelint.casefile.merged_cases import CaseOutcome

rtamt: Any = pytest.importorskip("rtamt", reason="rtamt is not installed (pip install rtamt)")

PHASES = (Phase.explicit, Phase.generate)  # a seed does not shrink
RULES = load_rules()
EXACT = 1e-9


@cache
def monitor(formula: str, names: tuple[str, ...]) -> Any:
    spec = rtamt.StlDiscreteTimeOfflineSpecification()
    for name in (*names, "out"):
        spec.declare_var(name, "float")
    spec.set_sampling_period(round(PERIOD_S * 1000), "ms", 0.1)
    spec.spec = f"out = {formula}"
    spec.parse()
    return spec


def robustness(spec: Spec, trace: Trace, formula: str | None = None) -> float:
    """Return rtamt's value of the rule's formula, or another, at the reference point, or at the beginning for an invariant."""
    times = {"time": [k * PERIOD_S for k in range(STEPS)]}
    rows = monitor(formula or spec.formula, tuple(trace.signals)).evaluate(times | trace.signals)
    return float(rows[trace.at if spec.window_s else 0][1])


def our_outcomes(spec: Spec, traces: list[Trace]) -> list[CaseOutcome]:
    """Judge all traces at once, as drives of one database."""
    rule = RULES[spec.rule]
    members = [NumberedCase(no, complete_scene(rule, trace.given_tables, ()), {}) for no, trace in enumerate(traces)]
    outcome = judge([rule], merge_cases(members, "drive_id"), {})[rule.id]
    return [outcome_of_case(outcome, member.no) for member in members]


def check(spec: Spec, trace: Trace, outcome: CaseOutcome) -> str:
    """Hold one trace's verdict against rtamt's robustness; return the verdict."""
    value = robustness(spec, trace)
    rows = outcome.verdicts
    words = {row["verdict"] for row in rows}
    if value > FAR / 2:
        assert words == {"not_applicable"}, "rtamt: nowhere on"
        return "not_applicable"
    if spec.window_s:
        assert len(rows) == 1
    if spec.surely and value > 0 and robustness(spec, trace, spec.surely) < -EXACT:
        assert words == {"unknown"}
        return "unknown"
    verdict = "fail" if "fail" in words else "pass"
    assert words <= {"pass", "fail"}, rows[0]["reason"]
    if spec.is_measured:
        assert min(row["margin"] for row in rows) == pytest.approx(value, rel=EXACT, abs=EXACT)
    if abs(value) > EXACT:  # at the limit itself > and >= differ, and to rtamt both are 0
        assert verdict == ("pass" if value > 0 else "fail")
    return verdict


@pytest.mark.ci
@pytest.mark.sample(5)
@pytest.mark.parametrize("spec", SPECS, ids=lambda spec: spec.rule)
def test_the_catalogue_and_rtamt_agree(spec: Spec) -> None:
    seen: set[str] = set()

    @settings(max_examples=2, deadline=None, derandomize=True, database=None, phases=PHASES)
    @given(seeds=st.lists(st.integers(0, 2**32), min_size=15, max_size=20, unique=True))
    def agree(seeds: list[int]) -> None:
        traces = [spec.random(seed) for seed in seeds]
        for trace, outcome in zip(traces, our_outcomes(spec, traces), strict=True):
            seen.add(check(spec, trace, outcome))

    agree()
    assert seen >= {"pass", "fail"}, "the traces show both"


@pytest.mark.sample(1, ci=2)
@pytest.mark.parametrize(
    ("rule", "formula"),
    [
        ("ukhc.r103.signal-before", "historically[0s,4.9s](lit >= 0)"),
        ("ukhc.r103.signal-before", "always[0s,5s](lit >= 0)"),
        ("ukhc.r168.drop-back", "eventually[0s,5s](gap >= 2 * v)"),
        ("ukhc.r103.signal-off", "eventually[0.1s,5s](lit <= 0)"),
        ("ukhc.r103.signal-off", "eventually[0s,4.9s](lit <= 0)"),
        ("ukhc.r103.signal-off", "eventually[0s,5.1s](lit <= 0)"),
        ("ukhc.r182.no-pass-before-turn", "historically[0s,5.1s](free >= 0)"),
        ("alks-r157.cut-in", "eventually[0s,5s](clear > 0)"),
        ("stvo.s4-truck", "always((on >= 0) -> (gap >= 50.01))"),
    ],
)
def test_another_formula_would_be_noticed(rule: str, formula: str) -> None:
    spec = next(spec for spec in SPECS if spec.rule == rule)
    traces = [spec.random(seed) for seed in range(40)]
    other = spec._replace(formula=formula)
    noticed = 0
    for trace, outcome in zip(traces, our_outcomes(spec, traces), strict=True):
        try:
            check(other, trace, outcome)
        except AssertionError:
            noticed += 1
    assert noticed


def test_enough_of_the_catalogue_is_compared() -> None:
    windowed = [spec for spec in SPECS if spec.window_s]
    assert len(SPECS) >= 10
    assert len({RULES[spec.rule].kind for spec in windowed}) == 2, "pre- and postconditions"
    assert {RULES[spec.rule].quantifier for spec in windowed} == {"always", "eventually"}


def value_at(formula: str, signal: list[float], at: int, times: list[float] | None = None) -> float:
    """Return rtamt's value of a formula over the signal `x` at a step."""
    given = {"time": times or [k * PERIOD_S for k in range(len(signal))], "x": signal}
    return float(monitor(formula, ("x",)).evaluate(given)[at][1])


def test_a_bound_has_both_of_its_ends() -> None:
    signal = [1.0] * 52
    for step, within in ((50, True), (51, False)):
        low = [-1.0 if k == step else value for k, value in enumerate(signal)]
        assert (value_at("always[0s,5s](x >= 0)", low, 0) < 0) == within


def test_rtamt_counts_samples_whatever_their_times() -> None:
    """With samples twice as far apart, the same formula looks 10 s ahead: the traces have the period that rtamt is told."""
    low = [-1.0 if k == 50 else 1.0 for k in range(60)]
    slow = [2 * k * PERIOD_S for k in range(60)]
    assert value_at("always[0s,5s](x >= 0)", low, 0, slow) == value_at("always[0s,5s](x >= 0)", low, 0) == -1.0
    first, last = (float(each) for each in TIMES.split(" ")[0].split(".."))
    assert (first, TIMES.split(" ")[2]) == (0.0, str(PERIOD_S))
    assert last == pytest.approx((STEPS - 1) * PERIOD_S)


def test_rtamt_judges_what_is_left_of_a_window_at_the_end() -> None:
    """Kept, although the 5 s are not over: ours is unknown there, see tests of truncated windows. So no trace is judged there."""
    assert value_at("always[0s,5s](x >= 0)", [1.0] * 20, 10) == 1.0
    assert value_at("eventually[0s,5s](x >= 0)", [-1.0] * 20, 10) == -1.0
    for spec in SPECS:
        before, after = (round(s / PERIOD_S) for s in spec.window_s or (0.0, 0.0))
        assert all(before <= spec.random(seed).at <= STEPS - 1 - after for seed in range(20)), spec.rule
