"""Renders a difference of two audits as text, Markdown and JSON."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import msgspec

from drivelint.errors import ExitCode
from drivelint.fleet_report.difference import NOTHING_IN_COMMON
from drivelint.fleet_report.figures import number_text, percent_with_interval, rate_with_interval
from drivelint.gate.descriptions import DIFF_STATUS_TITLES, MAX_LINES, exit_sentence, finding_line
from drivelint.phrases import one_line, plural
from drivelint.report.markdown import escape_markdown, markdown_code
from drivelint.result.counts import VERDICTS
from drivelint.result.gate import NOT_FIXED_WORDS
from drivelint.result.text import replace_non_finite
from drivelint.result.text_templates import text_template

if TYPE_CHECKING:
    from drivelint.fleet.coverage import RuleCoverage
    from drivelint.fleet.rate_change import RateChange, RateTest
    from drivelint.fleet.trend import Trend
    from drivelint.fleet_report.difference import AuditDifference

AUDIT_DIFF_SCHEMA_VERSION: Final = 1
"""Version of the JSON format: raised when a key is removed or changes its meaning."""
_MAX_LISTED_RATES: Final = 3
"""A sentence lists at most this many rates that have risen."""
MAX_JSON_FINDINGS: Final = 1_000
"""Largest number of findings per standing in the JSON."""


def rate_name(of: RateChange | RuleCoverage | Trend) -> str:
    """Return the rule's id and the profile as text."""
    return of.rule_id if of.profile is None else f"{of.rule_id} [{of.profile}]"


def gating_severity(difference: AuditDifference, fail_on: str | None) -> str | None:
    """Return the severity that gates: the requested one, else the audit's own; None if none was requested and the audits have no common
    drive."""
    return fail_on or (None if difference.is_disjoint else _default_gating_severity(difference))


def exit_code(difference: AuditDifference, fail_on: str | None) -> ExitCode:
    """Return FAILED for new findings that gate; NOT_JUDGED if an audit has not ended, findings are gone but not fixed, or nothing can be
    compared.

    `fail_on` None: the two audits have no common drive. Then significantly higher rates gate instead of findings.
    """
    if fail_on is None:
        if difference.risen_rate_tests(_default_gating_severity(difference)):
            return ExitCode.FAILED
        return ExitCode.OK if difference.has_rates and not _warnings(difference) else ExitCode.NOT_JUDGED
    if difference.n_failing(fail_on):
        return ExitCode.FAILED
    return ExitCode.NOT_JUDGED if difference.n_gone_unfixed(fail_on) or _warnings(difference) else ExitCode.OK


def _default_gating_severity(difference: AuditDifference) -> str:
    """Return the severity from which on findings of the newer audit gate."""
    return str(difference.new.audit_json.get("fail_on", "critical"))


def _warnings(difference: AuditDifference) -> list[str]:
    return [audit.warning for audit in (difference.base, difference.new) if audit.warning]


def _exit_line(difference: AuditDifference, fail_on: str | None) -> str:
    """Return one line with the exit code, its reason, and how many drives were not judged any more."""
    n = len(difference.no_more_judged)
    less = f"; judged less than the baseline: {plural(n, 'drive')} of the baseline not judged" if n else ""
    return f"{_exit_code_and_reason(difference, fail_on)}{less}"


def _exit_code_and_reason(difference: AuditDifference, fail_on: str | None) -> str:
    if fail_on is None:
        return (
            f"exit {int(exit_code(difference, None))}: {_rates_sentence(difference)}; with --fail-on SEVERITY, "
            "all findings of the newer audit gate"
        )
    if exit_code(difference, fail_on) == ExitCode.NOT_JUDGED and _warnings(difference):
        return f"exit 4: no new finding at or above severity {fail_on} so far, but {_warnings(difference)[0]}"
    n, n_added = difference.n_gone_unfixed(fail_on), difference.n_failing_in_added_drives(fail_on)
    sentence = exit_sentence(
        difference.n_failing(fail_on), fail_on, f"{plural(n, 'earlier finding')} gone but not fixed" if n else ""
    )
    added_text = f", {n_added} of them in drives that the base does not contain" if n_added else ""
    rates = f"; {_rates_sentence(difference)}" if difference.has_few_common_drives else ""
    return f"{sentence}{added_text}{rates}"


def _rates_sentence(difference: AuditDifference) -> str:
    """Return a phrase about the comparison of rates of two audits without a common drive, or with few."""
    least = _default_gating_severity(difference)
    if risen := difference.risen_rate_tests(least):
        rates_text = ", ".join(
            f"{rate_name(change)} per {test.per} {ratio_text(test)}" for change, test in risen[:_MAX_LISTED_RATES]
        )
        more = f" and {len(risen) - _MAX_LISTED_RATES} more" if len(risen) > _MAX_LISTED_RATES else ""
        return f"rates at or above severity {least} are higher than chance explains: {rates_text}{more}"
    if warnings := _warnings(difference):
        return f"no rate at or above severity {least} is higher than chance explains so far, but {warnings[0]}"
    why = NOTHING_IN_COMMON if difference.is_disjoint else "few drives are in both audits"
    if not difference.has_rates:
        return f"{why}, and no rule has a rate in both"
    return f"no rate at or above severity {least} is higher than chance explains ({why})"


def changes_sentence(difference: AuditDifference) -> str:
    """Return one sentence about the changes since the base, for a headline."""
    significant = [pair for pair in difference.tests_by_p_value if pair[1].is_significant]
    rate_texts = [f"{rate_name(change)} per {test.per} {ratio_text(test)}" for change, test in significant]
    if len(rate_texts) > _MAX_LISTED_RATES:  # then the nearest test of each rule
        nearest = {
            rate_name(change): text for (change, _), text in reversed(list(zip(significant, rate_texts, strict=True)))
        }
        rate_texts = sorted(nearest.values(), key=rate_texts.index)
    more = (
        f" and {plural(len(rate_texts) - _MAX_LISTED_RATES, 'more rule')}"
        if len(rate_texts) > _MAX_LISTED_RATES
        else ""
    )
    differ = f"rates that differ by more than chance explains: {', '.join(rate_texts[:_MAX_LISTED_RATES])}{more}"
    if not difference.is_disjoint:
        return f"{differ}; {difference.headline}" if rate_texts else difference.headline
    return (
        f"the audits have no drive in common; {differ}"
        if rate_texts
        else "the audits have no drive in common, and no rate differs by more than chance explains"
    )


def rate_line(change_and_test: tuple[RateChange, RateTest]) -> str:
    """Return one line with both rates of a test, their ratio, and the p-values."""
    change, test = change_and_test
    was, now = both_rate_texts(test)
    name = f"{rate_name(change)} per {test.per}"
    return f"{name}: {was}, now {now}: {ratio_text(test)}, p {number_text(test.p_value)}, corrected {number_text(test.corrected)}"


def ratio_text(test: RateTest) -> str:
    """Return the ratio of the later rate to the earlier one as text."""
    return "none before" if test.ratio == math.inf else f"{number_text(test.ratio)} times"


def both_rate_texts(test: RateTest) -> list[str]:
    """Return both rates of a test as text, the earlier first."""
    if test.per == "occasion":
        rows = zip(test.events, test.of, test.rates, strict=True)
        return [f"{n} of {of:.0f}, {percent_with_interval(rate)}" for n, of, rate in rows]
    return [rate_with_interval(rate) for rate in test.rates]


def to_text(difference: AuditDifference, fail_on: str | None, *, markdown: bool = False) -> str:
    """Return a difference as text for a terminal, or as Markdown."""
    filters: dict[str, Any] = {
        "finding_line": finding_line,
        "rate_line": rate_line,
        "escaped": escape_markdown,
        "code": markdown_code,
    }
    name = f"templates/difference.{'md' if markdown else 'txt'}.j2"
    text = text_template(__file__, name, None if markdown else _text_on_one_line, **filters).render(
        diff=difference,
        verdicts=VERDICTS,
        titles=DIFF_STATUS_TITLES,
        words={standing: NOT_FIXED_WORDS.get(standing, standing) for standing in DIFF_STATUS_TITLES},
        most=MAX_LINES,
        exit=_exit_line(difference, fail_on),
    )
    return text.rstrip("\n")


def _text_on_one_line(value: Any) -> Any:
    return one_line(value) if isinstance(value, str) and "\n" in value else value


def to_json(difference: AuditDifference, fail_on: str | None) -> str:
    """Return a difference as JSON: all counts, the first entries of each standing, and how many entries are left out."""
    content = {
        "audit_diff_schema": AUDIT_DIFF_SCHEMA_VERSION,
        "exit": {
            "code": int(exit_code(difference, fail_on)),
            "why": _exit_line(difference, fail_on).partition(": ")[2],
        },
        "warnings": _warnings(difference),
        "fail_on": fail_on,
        "base_name": difference.base.name,
        "name": difference.new.name,
        "counts": difference.counts,
        "gating": difference.gating,
        "base_verdicts": difference.verdicts[0],
        "verdicts": difference.verdicts[1],
        "drives": {
            "both": difference.comparison.drives_both,
            "base_only": difference.comparison.drives_base_only,
            "new_only": difference.comparison.drives_new_only,
        },
        "differences": [group._asdict() for group in difference.comparison.differences],
        "entries": [
            {
                **msgspec.to_builtins(entry.finding),
                **{key: value for key, value in entry._asdict().items() if key != "finding"},
            }
            for entries in difference.entries.values()
            for entry in entries
        ],
        "left_out": {
            standing: difference.counts[standing] - len(entries) for standing, entries in difference.entries.items()
        },
        "no_more_judged": [drive._asdict() for drive in difference.no_more_judged],
        "opened": [unknowns._asdict() for unknowns in difference.new_unknowns],
        "rates": [
            _rate_change_json(change)
            for change in difference.rates
            if change.p_value is not None or change.occasion_p_value is not None
        ],
    }
    return msgspec.json.format(msgspec.json.encode(replace_non_finite(msgspec.to_builtins(content))), indent=2).decode()


def _rate_change_json(change: RateChange) -> dict[str, Any]:
    content: dict[str, Any] = {"rule_id": change.rule_id, "profile": change.profile}
    for side, rate in (("base", change.base), ("new", change.new)):
        content[side] = rate and {
            "findings": rate.findings,
            "km": rate.km,
            "km_unknown": rate.km_unknown,
            "per_100km": rate.per_100km._asdict(),
            "occasions": rate.occasions,
            "occasions_failed": rate.occasions_failed,
        }
    values = ("p_value", "corrected", "occasion_p_value", "occasion_corrected")
    return {**content, **{name: getattr(change, name) for name in values}, "called": change.is_significant}
