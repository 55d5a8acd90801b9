"""The content of an explanation as plain data."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, NamedTuple

Row = dict[str, Any]


class Step(NamedTuple):
    """One judged step: when, what was observed and required, the margin (positive: kept), whether kept (None: unknown)."""

    t_ns: int
    observed: float | None
    required: float | None
    margin: float | None
    holds: bool | None


class TableRows(NamedTuple):
    """Rows of one library table that the rule read at the deciding step; `more` were left out.

    `at_ns`: the time of the rows where the object has none at the deciding step: its last one before, or else its first.
    """

    table: str
    rows: list[Row]
    more: int
    at_ns: int | None = None


class Part(NamedTuple):
    """One of the parts that a requirement is the sum of."""

    name: str
    description: str
    value: float


class Change(NamedTuple):
    """The nearest change of one number that changes the verdict; `nearest_value` None: none was found between `low` and `high`."""

    name: str
    description: str
    unit: str
    now: float
    nearest_value: float | None
    becomes: str | None
    beyond: bool
    """The verdict stays so further away, too."""
    low: float
    high: float


@dataclass(frozen=True)
class Sensitivity:
    """The number of copies of the drive with random errors that had each verdict.

    `certainty`: `sure` or `possible`, as the finding is, whose copies `check` judged with assumed errors; all that is known
    of their verdicts is how many are `fail`. None: these copies were judged with the errors given here.
    """

    samples: int
    seed: int
    position_m: float
    time_s: float
    map_m: float
    counts: dict[str, int]
    from_ns: int | None
    to_ns: int | None
    """The judged part of the drive; None: all of it."""
    certainty: str | None = None


@dataclass(frozen=True)
class Explanation:
    """The explanation of one verdict. Verdicts are those of `verdict`; the numbers are of the deciding step."""

    rule: Row
    """rule_id, title, clause, hypothesis, kind, severity, legal, status, sense, unit, observes, near_margin."""
    drive: Row
    """drive_id, file_name, t_start_ns."""
    verdict: Row
    """The row of `verdict`, and `finding_id` with the numbers of the finding where one is explained."""
    other_verdicts: list[Row]
    """Further verdict rows of this rule in this drive: profile, object_id, t_start_ns, verdict."""
    asks: str | None
    """What to record or to provide, by the reason."""
    decides_ns: int | None
    parts: list[Part]
    """The parts of the verdict's `required`; empty: not known."""
    sql: dict[str, str]
    params: list[Row]
    rows: list[TableRows]
    series: list[Step]
    changes: list[Change]
    sensitivity: Sensitivity | None
    source: str
    """The source of the numbers: the kept database, or the log."""
    notes: list[str] = field(default_factory=list)
    """What could not be shown, and why."""
