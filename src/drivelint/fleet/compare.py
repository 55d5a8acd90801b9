"""Compares two audits of any size: which findings are new, fixed, changed, unchanged, failing elsewhere, unknown or lost in the second one.

The terms and the matching rules are those of `drivelint.gate`, which compares two results in memory; this module does it in SQL. Only
drives are matched differently: by the content of the log first, because many logs of a fleet have the same name.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Final, NamedTuple

from drivelint.errors import UsageError
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    import duckdb

MOST_TIME_BETWEEN_MATCHED_FINDINGS_S: Final = 1.0
MOST_DISTANCE_BETWEEN_MATCHED_FINDINGS_M: Final = 5.0
UNCHANGED_MARGIN_TOLERANCE: Final = 0.01
UNCHANGED_INTERVAL_TOLERANCE_S: Final = 0.1
"""Copies of the constants in `drivelint.gate`, which this package must not import. A test checks that they are equal."""


class DifferenceCount(NamedTuple):
    """The number of findings of a rule with the same standing (new, fixed, …) and the same causes.

    `causes`: what is known to differ: `drive` (only one audit has it), `software` (the tag `release`), `rule` (its version), `parameters`
    (of the rule), `data` (the content of the log), `map`, or `tool` (the version of drivelint). If it has one cause and `causes_not_known`
    is empty, that cause explains the difference.
    """

    rule_id: str
    profile: str | None
    standing: str
    causes: tuple[str, ...]
    causes_not_known: tuple[str, ...]
    n: int


class Comparison(NamedTuple):
    """The counts of findings of two audits by standing, and of their drives. The temporary table `difference` has one row per finding."""

    differences: tuple[DifferenceCount, ...]
    drives_both: int
    drives_base_only: int
    drives_new_only: int

    def counts_by_standing(self) -> Counter[str]:
        """Return standing -> number of findings."""
        counts: Counter[str] = Counter()
        for difference in self.differences:
            counts[difference.standing] += difference.n
        return counts


def compare(
    con: duckdb.DuckDBPyConnection,
    *,
    base: str = "",
    new: str = "other_",
    tools: tuple[str | None, str | None] = (None, None),
) -> Comparison:
    """Return the difference of two audits. `base`, `new`: prefixes of their views' names.

    In the views of `drivelint.fleet.distinct_logs`, several results of the same log count once.
    `tools`: the versions of drivelint that made the audits; None: not known. The temporary table `difference` gets the columns of
    `drivelint.result.gate.ComparedFinding` without `stable`, the keys of both drives, `causes` and `causes_not_known`. Errors: `UsageError`
    for an audit whose tables lack the times in which actors were recorded.
    """
    if any("recorded" not in con.table(f"{of}drives").columns for of in (base, new)):
        raise UsageError(
            "an audit was made by an earlier drivelint, which did not store when each actor was recorded: audit the drives again"
        )
    numbers = {
        "near_s": f"{MOST_TIME_BETWEEN_MATCHED_FINDINGS_S!r}",
        "near_m": f"{MOST_DISTANCE_BETWEEN_MATCHED_FINDINGS_M!r}",
    }
    con.execute(statement("fleet/same_drive", base=base, new=new))
    for side, of in (("base", base), ("new", new)):
        con.execute(statement("fleet/timed_finding", side=side, of=of))
    con.execute(statement("fleet/candidate", **numbers))
    _match_findings(con)
    con.execute(statement("fleet/part", **numbers))
    for side, other_side, of in (("base", "new", new), ("new", "base", base)):
        con.execute(statement("fleet/only", side=side, other_side=other_side, of=of, **numbers))
    tolerances = {
        "margin_tolerance": f"{UNCHANGED_MARGIN_TOLERANCE!r}",
        "interval_tolerance_s": f"{UNCHANGED_INTERVAL_TOLERANCE_S!r}",
    }
    sql = statement("fleet/difference", base=base, new=new, **tolerances)
    con.execute(sql, {"base_tool": tools[0], "new_tool": tools[1]})
    rows = con.execute(statement("fleet/differences")).fetchall()
    counts = (DifferenceCount(r, p, s, tuple(causes), tuple(unknown), n) for r, p, s, causes, unknown, n in rows)
    n_common = _count_rows(con, "same_drive")
    return Comparison(
        tuple(counts),
        n_common,
        _count_rows(con, f"{base}drives") - n_common,
        _count_rows(con, f"{new}drives") - n_common,
    )


def _match_findings(con: duckdb.DuckDBPyConnection) -> None:
    """Fill the table `pair` from `candidate`, until no candidate is left. Each round takes at least one pair; usually one or two rounds
    suffice."""
    con.execute("CREATE OR REPLACE TEMP TABLE pair (drive VARCHAR, new_no BIGINT, base_no BIGINT)")
    while _count_rows(con, "candidate"):
        con.execute(statement("fleet/pair"))
        con.execute(statement("fleet/untaken"))


def _count_rows(con: duckdb.DuckDBPyConnection, table: str) -> int:
    (n,) = con.execute(f"SELECT count(*) FROM {table}").fetchone() or (0,)
    return int(n)
