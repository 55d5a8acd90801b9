"""How findings stand to an earlier result and to waivers: new, known, waived; and what waivers and the earlier result tell besides."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

from drivelint.gate import words

if TYPE_CHECKING:
    from drivelint.result.gate import Gate, Waiver

MOST: Final = 40
"""Findings of the earlier result that are listed of each kind."""
_GONE: Final = ("changed", "unknown", "lost", "fixed")
_STATES: Final = {"expired": "expired", "unmatched": "no such finding", "active": "in force"}
"""State of a waiver -> words, those that need somebody to act first."""
_LABELS: Final = {"new": "new", "known": "known", "waived": "waived", "open": "not waived"}


class BaselineStatus(NamedTuple):
    """How a finding stands: new, known, waived (or, where there is no earlier result, open), and what there is to say of it."""

    kind: str
    label: str
    why: str

    @property
    def key(self) -> str:
        """What it is found by; no pack is called so."""
        return f"gate-{self.kind}"


class Held(NamedTuple):
    """A waiver in words; `n`: findings like that."""

    state: str
    label: str
    about: str
    reason: str
    owner: str
    expires: str
    where: str
    n: int


class Gone(NamedTuple):
    """Findings of one kind that the earlier result has: how many, and the first of them in words."""

    title: str
    n: int
    lines: list[str]


class View(NamedTuple):
    """What the page says of a gate. `counts`: kind, label and number of findings; `since`: the earlier result's name."""

    since: str
    counts: list[tuple[str, str, int]]
    waivers: list[Held]
    today: str
    gone: list[Gone]
    more_unknown: int


def standing(gate: Gate | None, finding_id: str) -> BaselineStatus | None:
    """Return how a finding stands; None: it was held against nothing. A waiver says more than that it is known."""
    if gate is None:
        return None
    waiver = gate.waiver(finding_id)
    if waiver is not None:
        return _as("waived", f"{words.excuse(waiver)} ({waiver.where})")
    if gate.baseline is None:
        return _as("open", "")
    entry = gate.entry(finding_id)
    if not gate.known(finding_id):
        return _as("new", entry.why if entry else "")
    changed = entry is not None and entry.standing == "changed"
    return _as("known", entry.why if entry and changed else "")


def view(gate: Gate | None, finding_ids: list[str]) -> View | None:
    """Return what the page says of a gate; None: there was none."""
    if gate is None:
        return None
    kinds = [stands.kind for name in finding_ids if (stands := standing(gate, name)) is not None]
    shown = ("new", "known", "waived") if gate.baseline is not None else ("open", "waived")
    order = list(_STATES)
    before = gate.baseline
    return View(
        since=before.base_name if before else "",
        counts=[(kind, _LABELS[kind], kinds.count(kind)) for kind in shown if kind != "waived" or gate.waivers],
        waivers=sorted((_held(waiver) for waiver in gate.waivers), key=lambda held: order.index(held.state)),
        today=gate.today or "",
        gone=[
            Gone(words.TITLES[kind], len(entries), [words.line(entry) for entry in entries[:MOST]])
            for kind in _GONE
            if before and (entries := before.of(kind))
        ],
        more_unknown=sum(each.n - each.base_n for each in before.opened) if before else 0,
    )


def _as(kind: str, why: str) -> BaselineStatus:
    return BaselineStatus(kind, _LABELS[kind], why)


def _held(waiver: Waiver) -> Held:
    return Held(
        waiver.state,
        _STATES[waiver.state],
        words.about(waiver),
        waiver.reason,
        waiver.owner,
        waiver.expires,
        waiver.where,
        waiver.findings,
    )
