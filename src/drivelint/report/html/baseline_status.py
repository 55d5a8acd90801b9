"""The status of each finding against the baseline and the waivers, and a summary of the gate."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

from drivelint.gate import descriptions

if TYPE_CHECKING:
    from drivelint.result.gate import Gate, Waiver

MAX_LISTED: Final = 40
"""Findings of the earlier result that are listed of each kind."""
_GONE: Final = ("changed", "unknown", "lost", "fixed")
_STATES: Final = {"expired": "expired", "unmatched": "no such finding", "active": "in force"}
"""State of a waiver -> words, those that need somebody to act first."""
_LABELS: Final = {"new": "new", "known": "known", "waived": "waived", "open": "not waived"}


class BaselineStatus(NamedTuple):
    """The status of a finding (new, known, waived; open without a baseline) and the reason for it."""

    kind: str
    label: str
    why: str

    @property
    def filter_key(self) -> str:
        """The key by which the page filters findings; no pack has this name."""
        return f"gate-{self.kind}"


class WaiverSummary(NamedTuple):
    """A waiver as the page shows it; `n` counts the findings that match it."""

    state: str
    label: str
    about: str
    reason: str
    owner: str
    expires: str
    where: str
    n: int


class BaselineFindings(NamedTuple):
    """The findings of the baseline with one standing: their number and the first of them as text."""

    title: str
    n: int
    lines: list[str]


class GateSummary(NamedTuple):
    """What the page says of a gate. `counts`: kind, label and number of findings; `since`: the earlier result's name."""

    since: str
    counts: list[tuple[str, str, int]]
    waivers: list[WaiverSummary]
    today: str
    gone: list[BaselineFindings]
    more_unknown: int


def finding_status(gate: Gate | None, finding_id: str) -> BaselineStatus | None:
    """Return the status of a finding against the gate; None without a gate. A waiver takes precedence over the baseline."""
    if gate is None:
        return None
    waiver = gate.waiver(finding_id)
    if waiver is not None:
        return _as("waived", f"{descriptions.waiver_reason(waiver)} ({waiver.where})")
    if gate.baseline is None:
        return _as("open", "")
    entry = gate.compared(finding_id)
    if not gate.in_baseline(finding_id):
        return _as("new", entry.why if entry else "")
    changed = entry is not None and entry.standing == "changed"
    return _as("known", entry.why if entry and changed else "")


def gate_summary(gate: Gate | None, finding_ids: list[str]) -> GateSummary | None:
    """Return the summary of the gate for the page; None without a gate."""
    if gate is None:
        return None
    kinds = [stands.kind for name in finding_ids if (stands := finding_status(gate, name)) is not None]
    shown = ("new", "known", "waived") if gate.baseline is not None else ("open", "waived")
    order = list(_STATES)
    before = gate.baseline
    return GateSummary(
        since=before.base_name if before else "",
        counts=[(kind, _LABELS[kind], kinds.count(kind)) for kind in shown if kind != "waived" or gate.waivers],
        waivers=sorted((_held(waiver) for waiver in gate.waivers), key=lambda held: order.index(held.state)),
        today=gate.today or "",
        gone=[
            BaselineFindings(
                descriptions.STANDING_TITLES[kind],
                len(entries),
                [descriptions.finding_line(entry) for entry in entries[:MAX_LISTED]],
            )
            for kind in _GONE
            if before and (entries := before.with_standing(kind))
        ],
        more_unknown=sum(each.n - each.base_n for each in before.opened) if before else 0,
    )


def _as(kind: str, why: str) -> BaselineStatus:
    return BaselineStatus(kind, _LABELS[kind], why)


def _held(waiver: Waiver) -> WaiverSummary:
    return WaiverSummary(
        waiver.state,
        _STATES[waiver.state],
        descriptions.waiver_scope(waiver),
        waiver.reason,
        waiver.owner,
        waiver.expires,
        waiver.where,
        waiver.findings,
    )
