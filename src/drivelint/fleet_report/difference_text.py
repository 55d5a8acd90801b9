"""A difference of two audits as text, Markdown and JSON, and all its rows as Parquet."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import msgspec

from drivelint.errors import ExitCode
from drivelint.fleet_report.difference import NOTHING_IN_COMMON
from drivelint.fleet_report.figures import figure, interval, share
from drivelint.gate.descriptions import DIFF_STATUS_TITLES, MAX_LINES, exit_sentence, finding_line
from drivelint.phrases import one_line, plural
from drivelint.report.markdown import code, escaped
from drivelint.result.counts import VERDICTS
from drivelint.result.gate import NOT_FIXED
from drivelint.result.text import finite
from drivelint.result.text_templates import text_template

if TYPE_CHECKING:
    from drivelint.fleet.coverage import RuleCoverage
    from drivelint.fleet.rate_change import RateChange, RateTest
    from drivelint.fleet_report.difference import AuditDifference

AUDIT_DIFF_SCHEMA: Final = 1
"""Version of the JSON: raised when a key changes its meaning or goes."""
_MOST_RISEN: Final = 3
JSON_ENTRIES: Final = 1_000
"""Findings of each standing that the JSON has."""


def rate_name(of: RateChange | RuleCoverage) -> str:
    """Return rule and profile."""
    return of.rule_id if of.profile is None else f"{of.rule_id} [{of.profile}]"


def least_severity(found: AuditDifference, asked: str | None) -> str | None:
    """Return the severity that gates: what was asked, else the audit's own; None where no finding can be matched and nothing was asked."""
    return asked or (None if found.is_disjoint else _own_severity(found))


def exit_code(found: AuditDifference, fail_on: str | None) -> ExitCode:
    """FAILED for new findings that gate; NOT_JUDGED where more may come, or findings are gone but not fixed, or nothing can be compared.

    `fail_on` None: of two audits without a common drive, rates that are higher than chance explains gate in the place of findings.
    """
    if fail_on is None:
        if found.risen(_own_severity(found)):
            return ExitCode.FAILED
        return ExitCode.OK if found.has_rates and not _warnings(found) else ExitCode.NOT_JUDGED
    if found.n_failing(fail_on):
        return ExitCode.FAILED
    return ExitCode.NOT_JUDGED if found.n_gone(fail_on) or _warnings(found) else ExitCode.OK


def _own_severity(found: AuditDifference) -> str:
    """Return the severity by which the newer audit gates."""
    return str(found.new.told.get("fail_on", "critical"))


def _warnings(found: AuditDifference) -> list[str]:
    return [audit.warning for audit in (found.base, found.new) if audit.warning]


def _exit(found: AuditDifference, fail_on: str | None) -> str:
    """Return the exit code and its reason, and that fewer drives were judged, in one line."""
    n = len(found.no_more_judged)
    less = f"; judged less than the baseline: {plural(n, 'drive')} of it not judged" if n else ""
    return f"{_code_and_reason(found, fail_on)}{less}"


def _code_and_reason(found: AuditDifference, fail_on: str | None) -> str:
    if fail_on is None:
        return f"exit {int(exit_code(found, None))}: {_rates_sentence(found)}; --fail-on SEVERITY gates on all of the newer audit"
    if exit_code(found, fail_on) == ExitCode.NOT_JUDGED and _warnings(found):
        return f"exit 4: no new finding at or above severity {fail_on} so far, but {_warnings(found)[0]}"
    n = found.n_gone(fail_on)
    return exit_sentence(
        found.n_failing(fail_on), fail_on, f"{plural(n, 'earlier finding')} gone but not fixed" if n else ""
    )


def _rates_sentence(found: AuditDifference) -> str:
    """Return what the rates of two audits without a common drive come to."""
    least = _own_severity(found)
    if risen := found.risen(least):
        told = ", ".join(f"{rate_name(change)} per {test.per} {times(test)}" for change, test in risen[:_MOST_RISEN])
        more = f" and {len(risen) - _MOST_RISEN} more" if len(risen) > _MOST_RISEN else ""
        return f"rates at or above severity {least} are higher than chance explains: {told}{more}"
    if warnings := _warnings(found):
        return f"no rate at or above severity {least} is higher than chance explains so far, but {warnings[0]}"
    if not found.has_rates:
        return f"{NOTHING_IN_COMMON}, and no rule has a rate in both"
    return f"no rate at or above severity {least} is higher than chance explains ({NOTHING_IN_COMMON})"


def since(found: AuditDifference) -> str:
    """Return what changed since the base, in one sentence for a headline."""
    if not found.is_disjoint:
        return found.headline
    called = [f"{rate_name(change)} per {test.per} {times(test)}" for change, test in found.tested if test.is_called]
    if not called:
        return "no drive is in both, and no rate differs by more than chance explains"
    more = f" and {len(called) - _MOST_RISEN} more" if len(called) > _MOST_RISEN else ""
    return (
        f"no drive is in both; rates that differ by more than chance explains: {', '.join(called[:_MOST_RISEN])}{more}"
    )


def rate_line(of: tuple[RateChange, RateTest]) -> str:
    """Return the rates of a test, how many times the earlier one the later one is, and the chance of it."""
    change, test = of
    was, now = rate_sides(test)
    name = f"{rate_name(change)} per {test.per}"
    return f"{name}: {was}, now {now}: {times(test)}, p {figure(test.p_value)}, corrected {figure(test.corrected)}"


def times(test: RateTest) -> str:
    """Return how many times the earlier rate the later one is."""
    return "there was none" if test.ratio == math.inf else f"{figure(test.ratio)} times"


def rate_sides(test: RateTest) -> list[str]:
    """Return both rates of a test in words, the earlier first."""
    if test.per == "occasion":
        told = zip(test.events, test.of, test.rates, strict=True)
        return [f"{n} of {of:.0f}, {share(rate)}" for n, of, rate in told]
    return [interval(rate) for rate in test.rates]


def to_text(found: AuditDifference, fail_on: str | None, *, markdown: bool = False) -> str:
    """Return a difference as text for a person, or as Markdown."""
    filters: dict[str, Any] = {
        "finding_line": finding_line,
        "rate_line": rate_line,
        "escaped": escaped,
        "code": code,
    }
    name = "difference.md.j2" if markdown else "difference.txt.j2"
    text = text_template(__file__, name, None if markdown else _one_line, **filters).render(
        diff=found,
        verdicts=VERDICTS,
        titles=DIFF_STATUS_TITLES,
        words={standing: NOT_FIXED.get(standing, standing) for standing in DIFF_STATUS_TITLES},
        most=MAX_LINES,
        exit=_exit(found, fail_on),
    )
    return text.rstrip("\n")


def _one_line(value: Any) -> Any:
    return one_line(value) if isinstance(value, str) and "\n" in value else value


def to_json(found: AuditDifference, fail_on: str | None) -> str:
    """Return a difference as JSON: all counts, and the first entries of each standing with the number of those left out."""
    content = {
        "audit_diff_schema": AUDIT_DIFF_SCHEMA,
        "exit": {"code": int(exit_code(found, fail_on)), "why": _exit(found, fail_on).partition(": ")[2]},
        "warnings": _warnings(found),
        "fail_on": fail_on,
        "base_name": found.base.name,
        "name": found.new.name,
        "counts": found.counts,
        "gating": found.gating,
        "base_verdicts": found.verdicts[0],
        "verdicts": found.verdicts[1],
        "drives": {
            "both": found.comparison.drives_both,
            "base_only": found.comparison.drives_base_only,
            "new_only": found.comparison.drives_new_only,
        },
        "differences": [each._asdict() for each in found.comparison.differences],
        "entries": [
            {
                **msgspec.to_builtins(each.finding),
                **{key: value for key, value in each._asdict().items() if key != "finding"},
            }
            for entries in found.entries.values()
            for each in entries
        ],
        "left_out": {standing: found.counts[standing] - len(entries) for standing, entries in found.entries.items()},
        "no_more_judged": [each._asdict() for each in found.no_more_judged],
        "opened": [each._asdict() for each in found.opened],
        "rates": [
            _rate_change(each) for each in found.rates if each.p_value is not None or each.occasion_p_value is not None
        ],
    }
    return msgspec.json.format(msgspec.json.encode(finite(msgspec.to_builtins(content))), indent=2).decode()


def _rate_change(each: RateChange) -> dict[str, Any]:
    told: dict[str, Any] = {"rule_id": each.rule_id, "profile": each.profile}
    for side, rate in (("base", each.base), ("new", each.new)):
        told[side] = rate and {
            "findings": rate.findings,
            "km": rate.km,
            "km_unknown": rate.km_unknown,
            "per_100km": rate.per_100km._asdict(),
            "occasions": rate.occasions,
            "occasions_failed": rate.occasions_failed,
        }
    values = ("p_value", "corrected", "occasion_p_value", "occasion_corrected")
    return {**told, **{name: getattr(each, name) for name in values}, "called": each.is_called}
