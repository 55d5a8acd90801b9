"""The status of each finding against the baseline and the waivers, and a summary of the gate."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from drivelint.gate import descriptions
from drivelint.result.gate import NOT_FIXED_WORDS

if TYPE_CHECKING:
    from drivelint.result.gate import Gate

MAX_LISTED_FINDINGS: Final = 40
"""The page lists this many findings of the earlier result per status."""
_STATUSES_OF_DIFFERING_BASELINE_FINDINGS: Final = ("changed", *NOT_FIXED_WORDS, "fixed")
_WAIVER_STATES: Final = {"expired": "expired", "unmatched": "matches no finding", "active": "in force"}
"""The states of a waiver in words; states that need action come first."""
_STATUS_LABELS: Final = {
    "new": "new",
    "open": "not waived",
    "known": "known",
    "waived": "waived",
    "possible": "only possible",
}


class BaselineStatus(NamedTuple):
    """The status of a finding (new, known, waived, only possible; open without a baseline) and the reason of the status."""

    kind: str
    label: str
    why: str

    @property
    def is_gating(self) -> bool:
        """Whether the finding fails the gate: it is not waived, not known from the baseline, and not only possible."""
        return self.kind in {"new", "open"}

    @property
    def filter_key(self) -> str:
        """The key by which the page filters findings; it differs from the names of all packs."""
        return f"gate-{self.kind}"


def finding_status(gate: Gate | None, finding_id: str) -> BaselineStatus | None:
    """Return the status of a finding against the gate; None without a gate. A waiver takes precedence over the baseline."""
    if gate is None:
        return None
    kind = gate.status_at_gate(finding_id)
    waiver, entry = gate.waiver(finding_id), gate.compared_finding(finding_id)
    why = ""
    if waiver is not None:
        why = f"{descriptions.waiver_reason_phrase(waiver)} ({waiver.where})"
    elif kind == "possible":
        why = descriptions.why_gate_excludes(gate, finding_id)
    elif entry is not None and entry.standing == "new":
        why = f"before: {descriptions.words_for_verdict_of_other_result(entry)}: {entry.why}"
    elif entry is not None and entry.standing == "changed":
        why = entry.why
    return BaselineStatus(kind, _status_label(gate, kind), why)


def _status_label(gate: Gate, kind: str) -> str:
    return "not compared" if kind == "open" and not gate.waivers else _STATUS_LABELS[kind]


def gate_summary(gate: Gate | None, finding_ids: list[str]) -> dict[str, Any] | None:
    """Return the part of the page about the gate; None without a gate.

    `since`: the earlier result's name; `counts`: kind, label and number of findings; `waivers`: each with its state and scope in
    words; `gone`: the baseline's findings that differ in this result, by status: the number, and the first ones as text.
    """
    if gate is None:
        return None
    kinds = Counter(status.kind for name in finding_ids if (status := finding_status(gate, name)) is not None)
    shown_kinds = [kind for kind in _STATUS_LABELS if kind != ("open" if gate.baseline is not None else "new")]
    applies = {
        "waived": bool(gate.waivers),
        "known": gate.baseline is not None,
        "possible": gate.confidence is not None,
    }
    before = gate.baseline
    entries_by_status = (
        {kind: before.with_diff_status(kind) for kind in _STATUSES_OF_DIFFERING_BASELINE_FINDINGS} if before else {}
    )
    return {
        "since": before.base_name if before else "",
        "confidence": gate.confidence,
        "counts": [(kind, _status_label(gate, kind), kinds[kind]) for kind in shown_kinds if applies.get(kind, True)],
        "waivers": [
            (waiver, label, descriptions.waiver_scope_phrase(waiver))
            for state, label in _WAIVER_STATES.items()
            for waiver in gate.waivers
            if waiver.state == state
        ],
        "today": gate.today or "",
        "gone": [
            {
                "title": descriptions.DIFF_STATUS_TITLES[kind],
                "n": len(entries),
                "lines": [descriptions.finding_line(entry) for entry in entries[:MAX_LISTED_FINDINGS]],
            }
            for kind, entries in entries_by_status.items()
            if entries
        ],
        "more_unknown": sum(unknowns.n - unknowns.base_n for unknowns in before.new_unknowns) if before else 0,
    }
