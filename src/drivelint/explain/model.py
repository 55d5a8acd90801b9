"""The content of an explanation as plain data."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, NamedTuple

Row = dict[str, Any]


class Step(NamedTuple):
    """One judged step: time, observed and required value, margin (positive: kept), and whether the rule was kept (None: unknown)."""

    t_ns: int
    observed: float | None
    required: float | None
    margin: float | None
    holds: bool | None


class TableRows(NamedTuple):
    """Rows of one table that the rule read at the deciding step; `more`: the number of rows left out.

    `at_ns`: the time of the rows if the object has no row at the deciding step: the last time before it, else the object's first time.
    """

    table: str
    rows: list[Row]
    more: int
    at_ns: int | None = None


class RequiredValuePart(NamedTuple):
    """One summand of a requirement."""

    name: str
    description: str
    value: float


class NearestChange(NamedTuple):
    """The nearest value of one number that changes the verdict; `nearest_value` None: no such value between `low` and `high`."""

    name: str
    description: str
    unit: str
    now: float
    nearest_value: float | None
    becomes: str | None
    beyond: bool
    """Whether values further away give the same verdict as `nearest_value`."""
    low: float
    high: float


@dataclass(frozen=True)
class Sensitivity:
    """The number of copies of the drive with random errors, by verdict.

    `certainty`: `sure` or `possible` if the copies are those that `check` judged for the finding; `counts` then contains only `fail`.
    None: the copies were judged for this explanation.
    """

    samples: int
    seed: int
    position_m: float
    time_s: float
    map_m: float
    counts: dict[str, int]
    from_ns: int | None
    to_ns: int | None
    """Start and end of the judged part of the drive; None: the whole drive."""
    certainty: str | None = None


@dataclass(frozen=True)
class Explanation:
    """The explanation of one verdict; numbers are those of the deciding step."""

    rule: Row
    """rule_id, title, breach, clause, hypothesis, kind, severity, legal, status, sense, unit, observes, near_margin."""
    drive: Row
    """drive_id, file_name, t_start_ns."""
    verdict: Row
    """The row of the table `verdict`; if a finding is explained, with `finding_id` and the finding's numbers."""
    other_verdicts: list[Row]
    """Further verdict rows of this rule in this drive: profile, object_id, t_start_ns, verdict."""
    asks: str | None
    """What the user can record or provide so that the verdict can be decided; None: nothing."""
    decides_ns: int | None
    parts: list[RequiredValuePart]
    """The summands of the verdict's `required`; empty: not known."""
    sql: dict[str, str]
    params: list[Row]
    rows: list[TableRows]
    series: list[Step]
    changes: list[NearestChange]
    sensitivity: Sensitivity | None
    source: str
    """The source of the numbers: the kept database, or the log."""
    notes: list[str] = field(default_factory=list)
    """Changes since the run, and data that are missing from the explanation."""
