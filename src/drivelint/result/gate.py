"""Defines the gate's data, the comparison with a baseline and the waivers; reads and writes it as `gate.json`.

The file is there only if a baseline or waivers were given.
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
"""Of NEW's findings: new, changed, unchanged. Of BASE's that NEW has not: fixed (kept there, or never applicable), elsewhere (the rule
fails there at another step or place), unknown (NEW cannot decide), lost (NEW did not judge it). None of the last three is fixed."""
NOT_FIXED: Final = {"unknown": "unknown now", "lost": "not judged now", "elsewhere": "still failing elsewhere"}
"""Status of a finding that is gone but not fixed -> words."""
GATE_VERSION: Final = 1
"""Version of the file: raised when a key changes its meaning or goes."""


@dataclass(frozen=True)
class ComparedFinding:
    """One finding as compared between two results.

    `finding_id`, place in time and margin are those of NEW, where it has the finding, else those of BASE; `base_id` is
    None for a new one. `there`: what the other result says there (verdict, or none). `stable`: its rule gates. `worse`: its margin
    is less than it was, by more than can be overlooked.
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
    """Id of the finding that is counted for it in its result; '': itself."""

    @property
    def counted_id(self) -> str:
        """The id of the finding that is counted for it."""
        return self.event or self.finding_id


@dataclass(frozen=True)
class NewUnknowns:
    """Verdicts of one drive, ego, rule and profile that are unknown or errors now and were not in the baseline."""

    drive_id: str
    ego_id: str
    rule_id: str
    profile: str | None
    stable: bool
    n: int
    base_n: int
    reason: str


def n_findings(entries: Iterable[ComparedFinding]) -> int:
    """Return how many findings these are, one of each event."""
    return len({entry.counted_id for entry in entries})


class Difference(msgspec.Struct, frozen=True):
    """Two results side by side: every finding of both is one entry, NEW's first.

    `base_verdicts`, `verdicts`: verdict -> rows, zeros included. `base_only`, `new_only`: drives that the other has not.
    `undecided`: severity -> verdicts that were pass or fail in BASE and are unknown in NEW. `rules_not_run`: rules of BASE only.
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
    """The newer run was interrupted."""
    undecided: dict[str, int] = msgspec.field(default_factory=dict)
    rules_not_run: tuple[str, ...] = ()
    n_both: int | None = None
    """Drives that both have."""
    other_maps: tuple[str, ...] = ()
    """Drives of NEW that BASE judged on another map, or without one."""
    shorter: tuple[str, ...] = ()
    """Drives of NEW that last less than nine tenths of what they last in BASE."""

    def counts(self) -> dict[str, int]:
        """Return diff status -> number of findings, zeros included."""
        found = Counter(entry.standing for entry in self.entries)
        return {standing: found[standing] for standing in DIFF_STATUSES}

    def event_counts(self) -> dict[str, int]:
        """Return diff status -> number of findings, one of each event; of a known event that changed in a part, it is changed."""
        changed = {entry.counted_id for entry in self.with_diff_status("changed")}
        as_before = [entry for entry in self.with_diff_status("unchanged") if entry.counted_id not in changed]
        found = {status: n_findings(self.with_diff_status(status)) for status in DIFF_STATUSES}
        return found | {"unchanged": n_findings(as_before)}

    def with_diff_status(self, status: str) -> list[ComparedFinding]:
        """Return the findings of one status."""
        return [entry for entry in self.entries if entry.standing == status]

    def not_fixed(self) -> list[ComparedFinding]:
        """Return BASE's findings that NEW has not, and that are not fixed."""
        return [entry for status in NOT_FIXED for entry in self.with_diff_status(status)]


@dataclass(frozen=True)
class Waiver:
    """Findings that an owner accepts until a date: they are shown, and do not fail a run.

    `where`: file and line. `from_s`, `to_s`: seconds since the drive's first time stamp. `expires`: last day, ISO.
    `state`: active, expired (it waives nothing), unmatched (no finding is like that). `findings`: how many are.
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
    """That no rule has its id, and which one is meant; '': one has, or rules of other packs may have."""


@dataclass(frozen=True)
class Gate:
    """The baseline and the waivers that keep a finding from failing a run.

    `today`: the date for the expiry of waivers, None without waivers. `waived`: finding_id -> index of its waiver.
    `confidence`: the share of its copies that must keep a finding that may fail a run; None: it is not asked. `possible`: the ids
    of findings of which fewer do.
    """

    today: str | None = None
    baseline: Difference | None = None
    waivers: tuple[Waiver, ...] = ()
    waived: dict[str, int] = field(default_factory=dict)
    confidence: float | None = None
    possible: tuple[str, ...] = ()

    @cached_property
    def _standing(self) -> dict[str, ComparedFinding]:
        entries = self.baseline.entries if self.baseline else ()
        # of those with one id the first counts
        return {e.finding_id: e for e in reversed(entries) if e.standing in {"new", "changed", "unchanged"}}

    def compared(self, finding_id: str) -> ComparedFinding | None:
        """Return the finding as compared with the baseline; None without one."""
        return self._standing.get(finding_id)

    def waiver(self, finding_id: str) -> Waiver | None:
        """Return the waiver of a finding."""
        number = self.waived.get(finding_id)
        return None if number is None else self.waivers[number]

    def in_baseline(self, finding_id: str) -> bool:
        """Return whether the baseline had this finding."""
        entry = self.compared(finding_id)
        return entry is not None and entry.standing != "new"

    def is_gating(self, finding_id: str) -> bool:
        """Return whether a finding may fail a run: it is neither waived nor in the baseline nor only possible."""
        return self.standing(finding_id) in {"new", "open"}

    def standing(self, finding_id: str) -> str:
        """Return the one standing by which a finding is counted: waived, known, possible, or else new; open without a baseline."""
        if finding_id in self.waived:
            return "waived"
        if self.in_baseline(finding_id):
            return "known"
        if self.is_possible(finding_id):
            return "possible"
        return "open" if self.baseline is None else "new"

    def is_possible(self, finding_id: str) -> bool:
        """Return whether too few of a finding's copies keep it for the asked confidence."""
        return finding_id in self._possible

    @cached_property
    def _possible(self) -> frozenset[str]:
        return frozenset(self.possible)


@dataclass(frozen=True)
class _File:
    gate_schema: int
    gate: Gate


def render(gate: Gate) -> bytes:
    """Return a gate as UTF-8 JSON with a final newline; numbers that are not finite are null."""
    return msgspec.json.format(msgspec.json.encode(_File(GATE_VERSION, gate)), indent=2) + b"\n"


def load(folder: Path) -> Gate | None:
    """Return the gate of a result folder; None: there was none. Errors: `UsageError` for a file of another kind."""
    path = folder / GATE_FILE
    try:
        found = msgspec.json.decode(path.read_bytes(), type=_File)
    except FileNotFoundError:
        return None
    except (OSError, msgspec.MsgspecError, UnicodeDecodeError) as error:
        raise UsageError(f"{path}: cannot be read as the gate of a result ({error}): check the drives again") from error
    if found.gate_schema != GATE_VERSION:
        raise UsageError(
            f"{path}: written with gate schema {found.gate_schema}, this drivelint reads {GATE_VERSION}: check the drives again"
        )
    return found.gate
