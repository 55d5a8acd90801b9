"""The gate's data: the comparison with a baseline, and the waivers. Reads and writes `gate.json`.

The file exists only if a baseline or waivers were given.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Final

import msgspec

from drivelint.errors import UsageError
from drivelint.result.names import GATE_FILE

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

DIFF_STATUSES: Final = ("new", "changed", "unchanged", "fixed", "elsewhere", "unknown", "lost")
"""The statuses of findings in a comparison of two results, BASE and NEW.

Findings of NEW are new, changed or unchanged. Findings that only BASE has are one of these: fixed (NEW finds the rule kept or not
applicable); elsewhere (in NEW the rule fails at another step or place); unknown (NEW cannot decide); lost (NEW did not judge there)."""
NOT_FIXED_WORDS: Final = {"unknown": "unknown now", "lost": "not judged now", "elsewhere": "still failing elsewhere"}
"""Status of a finding that only BASE has and that is not fixed -> words."""
GATE_VERSION: Final = 1
"""Version of the file: raised when a key changes its meaning or is removed."""


@dataclass(frozen=True)
class ComparedFinding:
    """One finding as compared between two results, BASE and NEW.

    `finding_id`, time and margin are from NEW if it has the finding, else from BASE; `base_id` is None for a new finding. `standing`: one
    of `DIFF_STATUSES`. `there`: the verdict of the other result at that time, or `none`. `stable`: the rule is stable, so it gates.
    `worse`: the margin is smaller than in BASE by more than the tolerance.
    """

    standing: str
    finding_id: str
    base_id: str | None
    drive_id: str
    ego_id: str
    rule_id: str
    profile: str | None
    object_id: str | None
    severity: str
    stable: bool
    t_s: float
    margin: float | None
    base_margin: float | None
    unit: str | None
    there: str
    why: str
    worse: bool = False
    event: str = ""
    """Id of the finding that represents this one's event in its result; '': this finding itself."""

    @property
    def event_id(self) -> str:
        """The id of the finding that represents this one's event."""
        return self.event or self.finding_id

    @property
    def event_key(self) -> tuple[str, str]:
        """The drive and the id of the event: findings of two logs with the same content have the same ids."""
        return self.drive_id, self.event_id


@dataclass(frozen=True)
class NewUnknowns:
    """Verdicts of one drive, ego, rule and profile of which more are unknown or errors (`n`) than in the baseline (`base_n`)."""

    drive_id: str
    ego_id: str
    rule_id: str
    profile: str | None
    stable: bool
    n: int
    base_n: int
    reason: str


def n_findings(entries: Iterable[ComparedFinding]) -> int:
    """Return the number of findings, counting one per event."""
    return len({entry.event_key for entry in entries})


class Difference(msgspec.Struct, frozen=True):
    """The comparison of two results, BASE and NEW: every finding is one entry, first the findings of NEW.

    `base_verdicts`, `verdicts`: verdict -> number of rows in BASE and NEW, zeros included. `base_only`, `new_only`: drives that only BASE
    or only NEW has. `undecided`: severity -> number of verdicts that were pass or fail in BASE and are unknown in NEW. `rules_not_run`:
    rules that only BASE has.
    """

    entries: tuple[ComparedFinding, ...]
    new_unknowns: tuple[NewUnknowns, ...] = msgspec.field(name="opened")
    base_verdicts: dict[str, int]
    verdicts: dict[str, int]
    base_only: tuple[str, ...]
    new_only: tuple[str, ...]
    base_name: str = "base"
    name: str = "new"
    is_partial: bool = False
    """The run of NEW was interrupted."""
    undecided: dict[str, int] = msgspec.field(default_factory=dict)
    rules_not_run: tuple[str, ...] = ()
    n_both: int | None = None
    """The number of drives that both results have."""
    other_maps: tuple[str, ...] = ()
    """Drives of NEW that BASE judged on another map, or without one."""
    shorter: tuple[str, ...] = ()
    """Drives of NEW that are shorter than nine tenths of their duration in BASE."""
    changed_rules: tuple[str, ...] = ()
    """Rules that have another version or other parameters in NEW than in BASE."""

    def counts(self) -> dict[str, int]:
        """Return diff status -> number of findings, zeros included."""
        n_by_standing = Counter(entry.standing for entry in self.entries)
        return {standing: n_by_standing[standing] for standing in DIFF_STATUSES}

    def event_counts(self) -> dict[str, int]:
        """Return diff status -> number of findings, one per event; an event with a changed and an unchanged finding is changed."""
        changed_events = {entry.event_key for entry in self.with_diff_status("changed")}
        as_before = [entry for entry in self.with_diff_status("unchanged") if entry.event_key not in changed_events]
        n_by_status = {status: n_findings(self.with_diff_status(status)) for status in DIFF_STATUSES}
        return n_by_status | {"unchanged": n_findings(as_before)}

    def with_diff_status(self, status: str) -> list[ComparedFinding]:
        """Return the findings with this status."""
        return [entry for entry in self.entries if entry.standing == status]

    def unfixed_findings(self) -> list[ComparedFinding]:
        """Return the findings that only BASE has and that are not fixed."""
        return [entry for status in NOT_FIXED_WORDS for entry in self.with_diff_status(status)]


@dataclass(frozen=True)
class Waiver:
    """Findings that an owner accepts until a date: reports show them, but they do not fail a run.

    `where`: file and line. `from_s`, `to_s`: seconds since the drive's first time stamp. `expires`: last day, ISO.
    `state`: active, expired (waives nothing), unmatched (no finding matches). `findings`: number of findings that match.
    """

    where: str
    rule: str
    reason: str
    owner: str
    expires: str
    drive: str | None = None
    ego: str | None = None
    object: str | None = None
    profile: str | None = None
    from_s: float | None = None
    to_s: float | None = None
    state: str = "active"
    findings: int = 0
    unknown_rule: str = ""
    """A sentence that no rule has the id `rule`, with the id that may be meant; '' if a rule has the id or another pack may have it."""


@dataclass(frozen=True)
class Gate:
    """The baseline, the waivers and the confidence that prevent a finding from failing a run.

    `today`: the date for the expiry of waivers, None without waivers. `waived`: finding_id -> index of its waiver.
    `confidence`: the least share of copies that must keep a finding before it may fail a run; None: no least share. `possible`: ids of
    the findings with a smaller share.
    """

    today: str | None = None
    baseline: Difference | None = None
    waivers: tuple[Waiver, ...] = ()
    waived: dict[str, int] = field(default_factory=dict)
    confidence: float | None = None
    possible: tuple[str, ...] = ()

    @cached_property
    def _compared_by_id(self) -> dict[str, ComparedFinding]:
        entries = self.baseline.entries if self.baseline else ()
        # if several entries have the same id, the first one wins
        return {e.finding_id: e for e in reversed(entries) if e.standing in {"new", "changed", "unchanged"}}

    def compared_finding(self, finding_id: str) -> ComparedFinding | None:
        """Return the finding as compared with the baseline; None without a baseline."""
        return self._compared_by_id.get(finding_id)

    def waiver(self, finding_id: str) -> Waiver | None:
        """Return the waiver of a finding; None if it is not waived."""
        number = self.waived.get(finding_id)
        return None if number is None else self.waivers[number]

    def is_in_baseline(self, finding_id: str) -> bool:
        """Return whether the baseline had this finding."""
        entry = self.compared_finding(finding_id)
        return entry is not None and entry.standing != "new"

    def is_gating(self, finding_id: str) -> bool:
        """Return whether a finding may fail a run: it is not waived, not in the baseline, and not only possible."""
        return self.status_at_gate(finding_id) in {"new", "open"}

    def status_at_gate(self, finding_id: str) -> str:
        """Return the status of a finding at the gate: waived, known (in the baseline), possible; else new, or open without a baseline."""
        if finding_id in self.waived:
            return "waived"
        if self.is_in_baseline(finding_id):
            return "known"
        if self.is_possible(finding_id):
            return "possible"
        return "open" if self.baseline is None else "new"

    def is_possible(self, finding_id: str) -> bool:
        """Return whether the share of copies that keep a finding is below the requested confidence."""
        return finding_id in self._possible_ids

    @cached_property
    def _possible_ids(self) -> frozenset[str]:
        return frozenset(self.possible)


@dataclass(frozen=True)
class _GateFile:
    gate_schema: int
    gate: Gate


def render(gate: Gate) -> bytes:
    """Return a gate as UTF-8 JSON with a final newline; NaN and infinity become null."""
    return msgspec.json.format(msgspec.json.encode(_GateFile(GATE_VERSION, gate)), indent=2) + b"\n"


def load(folder: Path) -> Gate | None:
    """Return the gate of a result folder; None if it has no gate. Errors: `UsageError` for an unreadable `gate.json`."""
    path = folder / GATE_FILE
    try:
        file = msgspec.json.decode(path.read_bytes(), type=_GateFile)
    except FileNotFoundError:
        return None
    except (OSError, msgspec.MsgspecError, UnicodeDecodeError) as error:
        raise UsageError(f"{path}: cannot be read as the gate of a result ({error}): check the drives again") from error
    if file.gate_schema != GATE_VERSION:
        raise UsageError(
            f"{path}: written with gate schema {file.gate_schema}, this drivelint reads {GATE_VERSION}: check the drives again"
        )
    return file.gate
