"""What a gate knows of a result beyond its tables: what an earlier result had, and what somebody answers for."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from functools import cached_property
from typing import Final

STANDINGS: Final = ("new", "changed", "unchanged", "fixed", "unknown", "lost")
"""Of NEW's findings: new, changed, unchanged. Of BASE's that NEW has not: fixed (kept there, or never applicable), unknown
(NEW cannot tell), lost (NEW did not look there). Neither of the last two is fixed."""


@dataclass(frozen=True)
class Entry:
    """One finding in the light of two results.

    `finding_id`, place in time and margin are those of NEW, where it has the finding, else those of BASE; `base_id` is
    None for a new one. `there`: what the other result says there (verdict, or none). `stable`: its rule gates.
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


@dataclass(frozen=True)
class Opened:
    """Verdicts of one drive, ego, rule and profile that became unknown or erred: more than BASE had."""

    drive_id: str
    ego_id: str
    rule_id: str
    profile: str | None
    stable: bool
    n: int
    base_n: int
    reason: str


@dataclass(frozen=True)
class Difference:
    """Two results side by side: every finding of both is one entry, NEW's first.

    `base_verdicts`, `verdicts`: verdict -> rows, zeros included. `base_only`, `new_only`: drives that the other has not.
    """

    entries: tuple[Entry, ...]
    opened: tuple[Opened, ...]
    base_verdicts: dict[str, int]
    verdicts: dict[str, int]
    base_only: tuple[str, ...]
    new_only: tuple[str, ...]
    base_name: str = "base"
    name: str = "new"

    def counts(self) -> dict[str, int]:
        """Return standing -> number of findings, zeros included."""
        found = Counter(entry.standing for entry in self.entries)
        return {standing: found[standing] for standing in STANDINGS}

    def of(self, standing: str) -> list[Entry]:
        """Return the findings of one standing."""
        return [entry for entry in self.entries if entry.standing == standing]


@dataclass(frozen=True)
class Waiver:
    """Findings that somebody answers for until a day: they are shown, and do not gate.

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


@dataclass(frozen=True)
class Gate:
    """What lets a finding through: an earlier result that had it, a waiver.

    `today`: the date that waivers were held against, None without waivers. `waived`: finding_id -> index of its waiver.
    """

    today: str | None = None
    baseline: Difference | None = None
    waivers: tuple[Waiver, ...] = ()
    waived: dict[str, int] = field(default_factory=dict)

    @cached_property
    def _standing(self) -> dict[str, Entry]:
        entries = self.baseline.entries if self.baseline else ()
        found: dict[str, Entry] = {}
        for entry in entries:
            if entry.standing in {"new", "changed", "unchanged"}:
                found.setdefault(entry.finding_id, entry)
        return found

    def entry(self, finding_id: str) -> Entry | None:
        """Return how a finding stands to the baseline; None without one."""
        return self._standing.get(finding_id)

    def waiver(self, finding_id: str) -> Waiver | None:
        """Return the waiver of a finding."""
        number = self.waived.get(finding_id)
        return None if number is None else self.waivers[number]

    def known(self, finding_id: str) -> bool:
        """Return whether the baseline had this finding."""
        entry = self.entry(finding_id)
        return entry is not None and entry.standing != "new"

    def gates(self, finding_id: str) -> bool:
        """Return whether a finding may fail a run: nobody waived it, and the baseline had it not."""
        return finding_id not in self.waived and not self.known(finding_id)
