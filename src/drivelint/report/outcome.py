"""The outcome of a run as a word and a sentence, the same in all reports."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import pyarrow.compute as pc

from drivelint.drive.trace import NOT_IN_FOLDER_CHECK, OWN_MAP_UNUSABLE_CHECK
from drivelint.errors import ExitCode
from drivelint.gate import descriptions
from drivelint.phrases import plural
from drivelint.report.inputs import n_rules_without_map
from drivelint.report.worst_first import is_contact
from drivelint.result import counts
from drivelint.result.certainty import doubt_words
from drivelint.result.gate import n_findings
from drivelint.result.model import (
    decision_counts,
    exit_status,
    gating_findings,
    is_first_not_judged_reason_too_little_decided,
)
from drivelint.result.text import ego_and_object_names, number

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.result.gate import Gate
    from drivelint.result.model import Result
    from drivelint.result.text import Row

LABEL_OF_EXIT_CODE: Final = {
    ExitCode.OK: "PASS",
    ExitCode.FAILED: "FAIL",
    ExitCode.USAGE: "ERROR",
    ExitCode.LOSSY: "LOSSY",
    ExitCode.NOT_JUDGED: "NOT JUDGED",
    ExitCode.INTERRUPTED: "PARTIAL",
}
_MOSTLY_UNKNOWN: Final = "MOSTLY UNKNOWN"
_TOO_LITTLE_JUDGED: Final = "TOO LITTLE JUDGED"
"""The label of a run that exits with 4 because it decided fewer rules than `--min-judged` requires."""
_NOT_APPLICABLE: Final = "NOT APPLICABLE"
_FINDINGS_LABEL: Final = "FINDINGS"
_HEADLINE_KIND_OF_LABEL: Final = {
    LABEL_OF_EXIT_CODE[ExitCode.OK]: "pass",
    _NOT_APPLICABLE: "not_applicable",
    _FINDINGS_LABEL: "near",
}
LET_THROUGH_WORDS: Final = {"known": "known", "waived": "waived", "possible": "only possible"}
"""The standings (`Gate.status_at_gate`) of findings that a gate lets through, in words."""
_NO_MAP_WORDS: Final = {
    OWN_MAP_UNUSABLE_CHECK: "the log's own map cannot be used",
    NOT_IN_FOLDER_CHECK: "no map in the folder covers the place",
}
"""Data-quality checks because of which a drive has no map, in words."""
_GATING_WITHOUT_BASELINE_OR_WAIVERS_LABEL: Final = "counted"
"""The word for gating findings if the gate has neither a baseline nor waivers, only a confidence."""


class HeadlinePart(NamedTuple):
    """A part of the outcome's sentence; `kind`: contact, possible contact, warning, or ''."""

    words: str
    kind: str = ""


class Headline(NamedTuple):
    """The outcome of a run, which reports show first. `label`: one word, such as FAIL; `parts`: the parts of the sentence after it.

    `kind` selects the colour: fail, near (a gate lets all findings through), unknown, not_applicable or pass.
    """

    label: str
    kind: str
    parts: tuple[HeadlinePart, ...]

    @property
    def sentence(self) -> str:
        """The sentence, without a full stop."""
        return "; ".join(part.words for part in self.parts)


class Event(NamedTuple):
    """A finding, and the rows of the same event: also under other profiles, or of the other ego of a touch.

    `finding`: the row that reports show. `rows`: all rows of the event in the order of the table, including `finding`.
    """

    finding: Row
    rows: tuple[Row, ...]

    @property
    def id(self) -> str:
        """The id of the event's first row. Unlike `finding`, that row does not depend on how sure each row is."""
        return str(self.rows[0]["finding_id"])

    @property
    def other_rows(self) -> list[Row]:
        """The rows of the event that reports only mention."""
        return [row for row in self.rows if row is not self.finding]

    @property
    def other_rows_words(self) -> str:
        """The other rows in words, such as "also under the profile observed, margin -3.00 m"; '' if there are none."""
        return "; ".join(
            f"also found for {ego_and_object_names(row)}"
            if row["ego_id"] != self.finding["ego_id"]
            else f"also under the profile {row['profile']}"
            + ("" if row["margin"] is None else f", margin {number(row['margin'], row['unit'])}")
            for row in self.other_rows
        )


class _UndecidedRules(NamedTuple):
    """The number of undecided rules (`n`) among the rules that may apply (`of`), counted per drive and ego.

    `several`: there is more than one ego.
    """

    n: int
    of: int
    several: bool

    @property
    def are_most(self) -> bool:
        """Whether more rules are undecided than decided."""
        return 2 * self.n > self.of

    @property
    def headline_words(self) -> str:
        """The part of the outcome's sentence about undecided rules."""
        subject = "the rule that may apply" if self.of == 1 else f"{self.n} of the {self.of} rules that may apply"
        return f"{subject} could not be judged{', counted for each drive and ego' if self.several else ''}"


class RuleCounts(NamedTuple):
    """The numbers of rules by how they were judged.

    `judged_somewhere`: with a pass or failure; `partly`: among these, rules that also have unknown verdicts or errors.
    Rules without a pass or failure: all verdicts unknown or errors (`never`), all not applicable (`idle`), or both (`open`).
    `unrecorded`: all verdicts not applicable, some because the log lacks a signal that the rule needs; not counted as `idle`.
    """

    judged_somewhere: int
    partly: int
    never: int
    idle: int
    open: int
    unrecorded: int


def headline(result: Result) -> Headline:
    """Return the outcome of a run. Each finding is counted once: as new, or by the reason why it does not gate."""
    rules = {rule["rule_id"]: rule for rule in result.rules.to_pylist()}
    rows = one_finding_per_event_and_status(result.gate, result.findings.to_pylist())
    left = [row for row in rows if status_at_gate(result.gate, row["finding_id"]) not in LET_THROUGH_WORDS]
    label = _outcome_label(result, bool(rows))
    verdict_counts = counts.verdict_counts(result.verdicts)
    lacking = counts.verdicts_lacking_signal(result.verdicts).num_rows
    whole = not verdict_counts["unknown"] + verdict_counts["error"] + lacking and not result.interrupted
    whole = whole and bool(pc.all(pc.equal(result.drives["status"], "judged")).as_py())
    before = None if result.gate is None else result.gate.baseline
    less = "" if before is None else descriptions.judged_less_sentence(before)
    whole = whole and not less
    kind = "unknown" if less else _HEADLINE_KIND_OF_LABEL.get(label, "unknown")
    if not rows:
        parts = [HeadlinePart(_no_findings_words(result, verdict_counts, label, is_all_judged=whole))]
    else:
        parts = [
            HeadlinePart(_findings_words(result, rows)),
            *_known_but_worse_findings_parts(result.gate),
            *_contact_parts(result, rows, rules),
        ]
        doubtful = sum(bool(doubt_words(row)) for row in rows)
        if doubtful and (result.gate is None or result.gate.confidence is None):
            some = "" if doubtful == len(rows) else f"{doubtful} of {plural(len(rows), 'finding')} "
            parts.append(HeadlinePart(f"{some}only possible"))
        if (open_rules := _count_undecided_rules(result)).are_most or label == _TOO_LITTLE_JUDGED:
            parts.append(HeadlinePart(open_rules.headline_words, "warning"))
    if less:
        parts.append(HeadlinePart(less, "warning"))
    if n := n_rules_without_map(result):
        need = "1 rule needs" if n == 1 else f"{n} rules need"
        checks = {check["check_id"] for drive in result.drives["quality"].to_pylist() for check in drive}
        cause = next((words for check, words in _NO_MAP_WORDS.items() if check in checks), "no map was given")
        parts.append(HeadlinePart(f"{cause}: {need} one (--map)", "warning"))
    return Headline(label, "fail" if left else kind, tuple(parts))


def one_finding_per_event_and_status(gate: Gate | None, rows: Sequence[Row]) -> list[Row]:
    """Return one finding of each event; if the findings of an event differ in standing (new, known), one of each standing."""
    return [event.finding for event in events_by_status(gate, rows)]


def events_by_status(gate: Gate | None, rows: Sequence[Row]) -> list[Event]:
    """Return the events with the findings of `one_finding_per_event_and_status`, in the order of these findings."""
    of_standing = counts.group_rows(rows, lambda row: status_at_gate(gate, row["finding_id"]))
    members: dict[int, list[Row]] = {}
    for group in of_standing.values():
        for row, place in zip(group, counts.representative_indices(group), strict=True):
            members.setdefault(id(group[place]), []).append(row)
    return [Event(row, tuple(members[id(row)])) for row in rows if id(row) in members]


def status_at_gate(gate: Gate | None, finding_id: str) -> str:
    """Return the standing of a finding, see `Gate.status_at_gate`; '' without a gate."""
    return "" if gate is None else gate.status_at_gate(finding_id)


def rule_counts(result: Result) -> RuleCounts:
    """Return the numbers of rules by how they were judged."""
    by_rule = counts.verdict_counts_by(result.verdicts, "rule_id")
    rules = [by_rule[rule_id] for rule_id in result.rules["rule_id"].to_pylist()]
    judged_rules = [n for n in rules if n["pass"] + n["fail"]]
    other_rules = [n for n in rules if not n["pass"] + n["fail"]]
    undecided = [n for n in other_rules if n["unknown"] + n["error"]]
    never = sum(not n["not_applicable"] for n in undecided)
    partly = sum(bool(n["unknown"] + n["error"]) for n in judged_rules)
    lacking = set(counts.verdicts_lacking_signal(result.verdicts)["rule_id"].to_pylist())
    names = result.rules["rule_id"].to_pylist()
    idle = [name for name in names if not sum(by_rule[name][v] for v in ("pass", "fail", "unknown", "error"))]
    unrecorded = len(lacking.intersection(idle))
    return RuleCounts(len(judged_rules), partly, never, len(idle) - unrecorded, len(undecided) - never, unrecorded)


def _outcome_label(result: Result, has_findings: bool) -> str:
    """Return the outcome of a run as a word.

    The word is not PASS if there are findings, even if none gates, nor if fewer rules were decided than left undecided.
    """
    code, verdict_counts = exit_status(result).code, counts.verdict_counts(result.verdicts)
    if code != ExitCode.OK and not (
        code == ExitCode.NOT_JUDGED and is_first_not_judged_reason_too_little_decided(result)
    ):
        return LABEL_OF_EXIT_CODE.get(code, "?")
    if code == ExitCode.NOT_JUDGED and verdict_counts["pass"] + verdict_counts["fail"]:
        return _TOO_LITTLE_JUDGED
    if has_findings:
        return _FINDINGS_LABEL
    if not verdict_counts["pass"] + verdict_counts["fail"]:
        lacking = counts.verdicts_lacking_signal(result.verdicts).num_rows
        return (
            "UNKNOWN"
            if verdict_counts["unknown"] + verdict_counts["error"] + lacking or not verdict_counts["not_applicable"]
            else _NOT_APPLICABLE
        )
    return _MOSTLY_UNKNOWN if _count_undecided_rules(result).are_most else LABEL_OF_EXIT_CODE[code]


def _count_undecided_rules(result: Result) -> _UndecidedRules:
    """Count the undecided rules, and the rules that may apply, per drive and ego."""
    n_decided, n = decision_counts(result.verdicts)
    return _UndecidedRules(n - n_decided, n, len(counts.distinct_rows(result.verdicts, ["drive_id", "ego_id"])) > 1)


def _no_findings_words(result: Result, verdict_counts: Mapping[str, int], label: str, *, is_all_judged: bool) -> str:
    has_judged_drive = pc.any(pc.equal(result.drives["status"], "judged")).as_py()
    if not has_judged_drive or not result.verdicts.num_rows:
        return "nothing was judged"
    if (
        not verdict_counts["pass"] + verdict_counts["fail"]
        and verdict_counts["unknown"]
        + verdict_counts["error"]
        + counts.verdicts_lacking_signal(result.verdicts).num_rows
    ):
        return "no findings, because nothing could be decided"
    if not verdict_counts["pass"] + verdict_counts["fail"]:
        return "no findings, because no rule applied: the situations of the rules did not occur"
    if label in {_MOSTLY_UNKNOWN, _TOO_LITTLE_JUDGED}:
        return f"no findings, but {_count_undecided_rules(result).headline_words}"
    return "no findings" if is_all_judged else "no findings, but not everything could be judged"


def _findings_words(result: Result, rows: Sequence[Row]) -> str:
    """Return the number of findings in words; with a gate, by standing."""
    where = f" in {len({row['drive_id'] for row in rows})} of {plural(result.drives.num_rows, 'drive')}"
    gate = result.gate
    if gate is None:
        return f"{counts.severity_counts_text(rows)} {'finding' if len(rows) == 1 else 'findings'}{where}"
    groups = counts.group_rows(rows, lambda row: gate.status_at_gate(row["finding_id"]))
    parts = []
    for name, group in groups.items():
        if name not in LET_THROUGH_WORDS:
            n, gating = len(group), len(counts.one_finding_per_event(gating_findings(result).to_pylist()))
            some = "" if gating == n else f"; {gating or 'none'} {'gates' if gating < 2 else 'gate'}"
            label = {"new": "new", "open": "not waived" if gate.waivers else _GATING_WITHOUT_BASELINE_OR_WAIVERS_LABEL}[
                name
            ]
            parts.append(f"{n} {label} ({counts.severity_counts_text(group)}{some})")
    parts += [
        f"{len(groups[name])} {words} ({counts.severity_counts_text(groups[name])})"
        for name, words in LET_THROUGH_WORDS.items()
        if name in groups
    ]
    if gate.baseline is not None and "new" not in groups:
        return f"no new finding; {', '.join(parts)}{where}"
    return f"{plural(len(rows), 'finding')}{where}: {', '.join(parts)}"


def _known_but_worse_findings_parts(gate: Gate | None) -> list[HeadlinePart]:
    """Return the sentence's part about known findings with a worse margin than in the baseline; [] if there are none."""
    entries = gate.baseline.entries if gate is not None and gate.baseline is not None else ()
    n = n_findings(e for e in entries if gate and e.worse and gate.status_at_gate(e.finding_id) == "known")
    return (
        [HeadlinePart("1 known finding is worse" if n == 1 else f"{n} known findings are worse", "warning")]
        if n
        else []
    )


def _contact_parts(result: Result, rows: Sequence[Row], rules: Mapping[str, Row]) -> list[HeadlinePart]:
    """Return the sentence's parts about drives with a contact or a possible contact; contacts known from the baseline count too."""
    contacts = [row for row in rows if is_contact(row, rules)]
    touched = {row["drive_id"] for row in contacts if not doubt_words(row)}
    sure = [row for row in contacts if row["drive_id"] in touched]
    maybe = [row for row in contacts if row["drive_id"] not in touched]
    parts = []
    for words, group in (("CONTACT", sure), ("possible contact", maybe)):
        if group:
            n = plural(len({row["drive_id"] for row in group}), "drive")
            parts.append(HeadlinePart(f"{words} in {n}{_contacts_at_gate_words(result.gate, group)}", words.lower()))
    return parts


def _contacts_at_gate_words(gate: Gate | None, contacts: Sequence[Row]) -> str:
    """Return in brackets how many drives have a new contact, or, if none, why the gate lets them through; '' if all drives have one."""
    if gate is None:
        return ""
    new = {row["drive_id"] for row in contacts if gate.status_at_gate(row["finding_id"]) not in LET_THROUGH_WORDS}
    if new:
        label = (
            "new"
            if gate.baseline is not None
            else "not waived"
            if gate.waivers
            else _GATING_WITHOUT_BASELINE_OR_WAIVERS_LABEL
        )
        return "" if len(new) == len({row["drive_id"] for row in contacts}) else f" ({len(new)} {label})"
    why = {gate.status_at_gate(row["finding_id"]) for row in contacts}
    return f" ({' or '.join(words for name, words in LET_THROUGH_WORDS.items() if name in why)})"
