"""Renders differences, waivers and the gate as text for a terminal and as JSON for programs. Counts of unknown and not applicable verdicts
are always included."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any, Final

import msgspec

from drivelint.errors import ExitCode
from drivelint.phrases import name_list, plural
from drivelint.result import counts
from drivelint.result.gate import NOT_FIXED_WORDS, n_findings
from drivelint.result.text import ego_name, number
from drivelint.result.text_templates import text_template

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from drivelint.result.gate import ComparedFinding, Difference, Gate, NewUnknowns, Waiver
    from drivelint.result.model import Result
    from drivelint.result.text import Row

MAX_LINES: Final = 50
"""Largest number of findings or reasons per kind on a terminal; JSON has all of them."""

MOST_CHANGED_RULES: Final = 2
"""Largest number of changed rules that a sentence names; it counts the others."""

DIFF_SCHEMA_VERSION: Final = 1
"""Version of the JSON format: raised when a key is removed or changes its meaning."""

DIFF_STATUS_TITLES: Final = {
    "new": "New",
    "changed": "Changed: in both results, with different values",
    "elsewhere": "Not fixed: the rule still fails, at another step or place",
    "unknown": "Not fixed: now unknown",
    "lost": "Not fixed: not judged in the newer result",
    "fixed": "Fixed",
}
"""Diff status -> heading, in the order of the text. Unchanged findings are only counted."""


def gating_findings(difference: Difference, least_severity: str, gate: Gate | None = None) -> list[ComparedFinding]:
    """Return the new findings of stable rules at or above a severity that no waiver in the newer result covers."""
    if least_severity == "never":
        return []
    severe = counts.SEVERITIES[: counts.SEVERITIES.index(least_severity) + 1]
    waived = gate.waived if gate else {}
    return [
        e
        for e in difference.with_diff_status("new")
        if e.stable and e.severity in severe and e.finding_id not in waived
    ]


def difference_headline(difference: Difference) -> str:
    """Return one sentence with the counts of new, changed, unchanged, fixed, and gone but not fixed findings."""
    return f"{difference.event_counts()['new']} new, {earlier_findings_sentence(difference)}"


def earlier_findings_sentence(difference: Difference) -> str:
    """Return a sentence about what became of the earlier result's findings. New findings are not counted: a waiver may cover them."""
    n = difference.event_counts()
    passes = n_findings(entry for entry in difference.with_diff_status("fixed") if entry.there == "pass")
    worse = n_findings(entry for entry in difference.entries if entry.worse)
    return counts_sentence(n, worse, (passes, n["fixed"] - passes))


def counts_sentence(n_by_status: Mapping[str, int], n_worse: int, n_fixed: tuple[int, int]) -> str:
    """Return a sentence with the non-zero counts of an earlier result's findings. `n_by_status`: diff status -> number.

    `n_worse`: how many of the changed findings are worse. `n_fixed`: how many findings pass now, and how many have a rule that does not
    apply any more.
    """
    passes, idle = (
        f"{k} now {words}" if k else "" for k, words in zip(n_fixed, ("pass", "not applicable"), strict=True)
    )
    phrases = (
        [f"{n_by_status['changed']} changed{f' ({n_worse} worse)' if n_worse else ''}"]
        if n_by_status["changed"]
        else []
    )
    phrases += [f"{n_by_status['unchanged']} unchanged"] if n_by_status["unchanged"] else []
    phrases += (
        [f"{n_by_status['fixed']} fixed ({', '.join(filter(None, (passes, idle)))})"] if n_by_status["fixed"] else []
    )
    unfixed = [f"{n_by_status[status]} {words}" for status, words in NOT_FIXED_WORDS.items() if n_by_status[status]]
    parts = [", ".join(phrases)] if phrases else []
    parts += [f"gone but not fixed: {', '.join(unfixed)}"] if unfixed else []
    return "; ".join(parts) or "no earlier finding"


def judged_less_sentence(difference: Difference) -> str:
    """Return a sentence about what the newer result judged less than the earlier one, on another map, or by changed rules; '' if
    there is nothing."""
    n, critical = sum(difference.undecided.values()), difference.undecided.get("critical", 0)
    more = f" ({critical} critical)" if critical else ""
    parts = (
        [f"{plural(n, 'verdict')} unknown that {'was' if n == 1 else 'were'} pass or fail before{more}"] if n else []
    )
    for noun, names, verb in (
        ("drive", difference.base_only, "checked"),
        ("rule", difference.rules_not_run, "selected"),
    ):
        parts += [f"{plural(len(names), noun)} of the baseline not {verb}"] if names else []
    parts += [f"{plural(len(difference.shorter), 'drive')} shorter by more than a tenth"] if difference.shorter else []
    sentences = [f"judged less than the baseline: {', '.join(parts)}"] if parts else []
    if difference.other_maps:
        sentences.append(f"judged on another map than in the baseline: {plural(len(difference.other_maps), 'drive')}")
    if difference.changed_rules:
        rules = name_list(difference.changed_rules, MOST_CHANGED_RULES)
        sentences.append(f"judged by other parameters or another version of a rule than in the baseline: {rules}")
    return "; ".join(sentences)


def difference_text(
    difference: Difference, failing: Sequence[ComparedFinding], fail_on: str, gate: Gate | None = None
) -> str:
    """Return a difference as text for a terminal."""
    text = text_template(__file__, "difference.txt.j2", finding_line=finding_line).render(
        diff=difference,
        verdicts=counts.VERDICTS,
        headline=difference_headline(difference),
        less=judged_less_sentence(difference),
        titles=DIFF_STATUS_TITLES,
        waived=gate.waived if gate else {},
        groups=unknowns_by_reason(difference.new_unknowns),
        n_findings=n_findings,
        surplus_rows_sentence=more_rows_than_findings_sentence,
        exit=exit_summary(difference, failing, fail_on),
        most=MAX_LINES,
    )
    return text.removesuffix("\n")


def exit_summary(difference: Difference, failing: Sequence[ComparedFinding], fail_on: str) -> str:
    """Return the exit code of a difference and its reason, in one line."""
    return exit_sentence(n_findings(failing), fail_on, unjudged_findings_phrase(difference, fail_on))


def exit_code(difference: Difference, failing: Sequence[ComparedFinding], fail_on: str) -> ExitCode:
    """Return FAILED for new findings that gate; NOT_JUDGED if the newer result did not judge an earlier finding again; else OK."""
    if failing:
        return ExitCode.FAILED
    return ExitCode.NOT_JUDGED if unjudged_findings_phrase(difference, fail_on) else ExitCode.OK


def unjudged_findings_phrase(difference: Difference, least_severity: str) -> str:
    """Return a phrase that counts the earlier findings that the newer result did not judge or cannot decide; '' if none of these gates."""
    if least_severity == "never":
        return ""
    severe = counts.SEVERITIES[: counts.SEVERITIES.index(least_severity) + 1]
    n = n_findings(entry for entry in difference.unfixed_findings() if entry.stable and entry.severity in severe)
    phrases = [f"{plural(n, 'earlier finding')} gone but not fixed"] if n else []
    phrases += ["the newer run was interrupted"] if difference.is_partial else []
    return " and ".join(phrases)


def exit_sentence(n_failing: int, fail_on: str, unjudged_phrase: str = "") -> str:
    """Return the exit code and its reason in one line. `n_failing`: number of new findings that gate."""
    if fail_on == "never":
        return "exit 0: new findings do not gate (--fail-on never)"
    range_text = f"at or above severity {fail_on}"
    if n_failing:
        return f"exit 1: {plural(n_failing, 'new finding')} {range_text}"
    if unjudged_phrase:
        return f"exit 4: no new finding {range_text}, but {unjudged_phrase}"
    return f"exit 0: no new finding {range_text}"


def to_json(difference: Difference, failing: Sequence[ComparedFinding], fail_on: str) -> str:
    """Return a difference as JSON: all entries, and the exit code."""
    content = {
        "diff_schema": DIFF_SCHEMA_VERSION,
        "exit": {
            "code": int(exit_code(difference, failing, fail_on)),
            "why": exit_summary(difference, failing, fail_on).partition(": ")[2],
        },
        "fail_on": fail_on,
        "counts": difference.counts(),
        "events": difference.event_counts(),
        "gating": [entry.finding_id for entry in failing],
        **msgspec.to_builtins(difference),
    }
    return msgspec.json.format(msgspec.json.encode(content), indent=2).decode()


def finding_line(entry: ComparedFinding) -> str:
    """Return a finding in one line: severity, place, rule, and the verdict of the other result there.

    A finding that is worse has both margins at the end of the line.
    """
    profile = "" if entry.profile is None else f" [{entry.profile}]"
    parties = ego_name(entry.ego_id) + ("" if entry.object_id is None else f", object {entry.object_id}")
    draft = "" if entry.stable else ", draft"
    margin = "" if entry.margin is None or entry.worse else f", margin {number(entry.margin, entry.unit)}"
    head = (
        f"{entry.severity}{draft}: {entry.drive_id} at {entry.t_s:.2f} s: {entry.rule_id}{profile}, {parties}{margin}"
    )
    return f"{head}{_phrase_on_other_result(entry)}"


def more_rows_than_findings_sentence(entries: Sequence[ComparedFinding]) -> str:
    """Return a sentence that explains why there are more rows than findings; '' if there are not."""
    left_out = [entry for entry in entries if entry.event_id != entry.finding_id]
    is_of_profiles = any(entry.profile is not None for entry in left_out)
    return counts.rows_and_findings_sentence(len(entries), n_findings(entries), has_profile_repeats=is_of_profiles)


def _phrase_on_other_result(entry: ComparedFinding) -> str:
    if entry.standing == "changed":
        return f": {entry.why}"
    return f" ({'the base says' if entry.standing == 'new' else 'now'} {words_for_verdict_of_other_result(entry)}: {entry.why})"


def words_for_verdict_of_other_result(entry: ComparedFinding) -> str:
    """Return, in words, the verdict of the other result at the time and place of a finding."""
    return {"not_applicable": "not applicable", "none": "nothing"}.get(entry.there, entry.there)


def waiver_warnings(gate: Gate) -> Iterator[str]:
    """Yield a warning for each waiver that has expired or matches no finding."""
    for waiver in gate.waivers:
        if waiver.state == "expired":
            matches = (
                "no finding matches"
                if not waiver.findings
                else f"{plural(waiver.findings, 'finding')} match{'es' if waiver.findings == 1 else ''}"
            )
            matches = waiver.unknown_rule or f"{matches} it"
            yield f"{waiver.where}: expired {waiver.expires} ({waiver.owner}): it has no effect; {matches}"
        elif waiver.state == "unmatched":
            if waiver.unknown_rule:
                yield f"{waiver.where}: {waiver.rule} ({waiver.owner}): {waiver.unknown_rule}"
                continue
            yield f"{waiver.where}: no finding matches {waiver_scope_phrase(waiver)} ({waiver.owner}); correct or remove it"


def waiver_scope_phrase(waiver: Waiver) -> str:
    """Return a phrase with the rule, drive, ego, object, profile and times that a waiver covers."""
    parts = [("drive", waiver.drive), ("ego", waiver.ego), ("object", waiver.object), ("profile", waiver.profile)]
    patterns = "".join(f", {name} {value}" for name, value in parts if value is not None)
    since = "" if waiver.from_s is None else f", from {waiver.from_s:g} s"
    return f"{waiver.rule}{patterns}{since}" + ("" if waiver.to_s is None else f", to {waiver.to_s:g} s")


def waiver_reason_phrase(waiver: Waiver) -> str:
    """Return a phrase about the waiver: until when, by whom and why a finding does not gate."""
    return f"waived until {waiver.expires} by {waiver.owner}: {waiver.reason}"


def why_gate_excludes(gate: Gate | None, finding_id: str) -> str:
    """Return why a finding does not gate: its waiver, else the baseline, else its low confidence; '' if the gate has no reason."""
    waiver = gate.waiver(finding_id) if gate else None
    if waiver is not None:
        return waiver_reason_phrase(waiver)
    entry = gate.compared_finding(finding_id) if gate else None
    if entry is not None and entry.standing != "new":
        return "known: the baseline contains it" + (f"; worse now: {entry.why}" if entry.worse else "")
    if gate and gate.is_possible(finding_id):
        return f"possible: the finding occurs in less than {100 * (gate.confidence or 0.0):g} % of the copies with recording errors"
    return ""


def why_not_gating(result: Result, row: Row, rule: Row | None) -> str:
    """Return why a finding or a failed verdict does not gate; '' if it gates. `rule`: its row of the table `rule`."""
    if "finding_id" in row and (reason := why_gate_excludes(result.gate, row["finding_id"])):
        return reason
    is_new = "finding_id" in row and result.gate is not None and result.gate.status_at_gate(row["finding_id"]) == "new"
    new = "new, " if is_new else ""
    if rule is None or rule["status"] != "stable":
        return new + ("draft" if rule is None else str(rule["status"]))
    severe = () if result.fail_on == "never" else counts.SEVERITIES[: counts.SEVERITIES.index(result.fail_on) + 1]
    return "" if row["severity"] in severe else f"{new}below --fail-on {result.fail_on}"


def gate_counts(gate: Gate) -> dict[str, Any]:
    """Return a gate's counts as data for JSON. `events`: findings of a baseline, one per event; the other counts are of rows."""
    states, before = Counter(waiver.state for waiver in gate.waivers), gate.baseline
    return {
        "today": gate.today,
        "baseline": None
        if before is None
        else {"name": before.base_name, **before.counts(), "events": before.event_counts()},
        "waived_findings": len(gate.waived),
        "confidence": gate.confidence,
        "possible_findings": len(gate.possible),
        "waivers": {state: states[state] for state in ("active", "expired", "unmatched")},
        "notes": list(waiver_warnings(gate)),
    }


def unknowns_by_reason(new_unknowns: Iterable[NewUnknowns]) -> list[tuple[str, list[str], int]]:
    """Return (reason, its rules, number of additional unknown verdicts) for each reason, the most frequent first."""
    rows = [
        (
            reason,
            sorted({unknowns.rule_id for unknowns in alike}),
            sum(unknowns.n - unknowns.base_n for unknowns in alike),
        )
        for reason, alike in counts.group_rows(new_unknowns, lambda unknowns: unknowns.reason).items()
    ]
    return sorted(rows, key=lambda item: (-item[2], item[0]))
