"""Compares two audits of any size: which findings are new, fixed, changed, unchanged, failing elsewhere, unknown now or lost.

The words and the rules of matching are those of `drivelint.gate`, which compares two results in memory; here all of it is SQL. Only
drives are matched otherwise: by the content of the log first, since in a fleet many logs have the same name.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Final, NamedTuple

from drivelint.errors import UsageError
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    import duckdb

NEAR_S: Final = 1.0
NEAR_M: Final = 5.0
MARGIN_TOLERANCE: Final = 0.01
INTERVAL_TOLERANCE_S: Final = 0.1
"""The numbers of `drivelint.gate`, which stands beside this package; a test holds them equal."""
CAUSES: Final = ("drive", "software", "rule", "parameters", "data", "map", "tool")
"""What may differ between two audits where a finding does: only one has the drive; the tag `release`, the rule's version, its
parameters, the log's content, the map's, and the version of drivelint."""


class DifferenceCount(NamedTuple):
    """Number of findings of a rule with one standing, and what differs there between the audits.

    `causes`: what is known to differ; a difference with a single one is due to it, if nothing is in `causes_not_known`.
    """

    rule_id: str
    profile: str | None
    standing: str
    causes: tuple[str, ...]
    causes_not_known: tuple[str, ...]
    n: int


class Comparison(NamedTuple):
    """The findings of two audits by standing. The temporary table `difference` has one row for each."""

    differences: tuple[DifferenceCount, ...]
    drives_both: int
    drives_base_only: int
    drives_new_only: int

    def counts(self) -> Counter[str]:
        """Return standing -> number of findings."""
        found: Counter[str] = Counter()
        for each in self.differences:
            found[each.standing] += each.n
        return found


def compare(
    con: duckdb.DuckDBPyConnection,
    *,
    base: str = "",
    new: str = "other_",
    tools: tuple[str | None, str | None] = (None, None),
) -> Comparison:
    """Return the difference of two audits. `base`, `new`: prefixes of the names of their views.

    A log that is there twice counts once in the views of `drivelint.fleet.distinct_logs`.

    Errors: `UsageError` for an audit whose tables do not say when actors were recorded.
    `tools`: the versions of drivelint that made them; None: not known. Makes the temporary table `difference`: the columns of
    `drivelint.result.gate.ComparedFinding` but `stable`, the keys of both drives, and `causes` and `causes_not_known`.
    """
    if any("recorded" not in con.table(f"{of}drives").columns for of in (base, new)):
        raise UsageError(
            "an audit was made by an earlier drivelint, which did not store when each actor was recorded: audit the drives again"
        )
    numbers = {"near_s": f"{NEAR_S!r}", "near_m": f"{NEAR_M!r}"}
    con.execute(statement("fleet/same_drive", base=base, new=new))
    for side, of in (("base", base), ("new", new)):
        con.execute(statement("fleet/timed_finding", side=side, of=of))
    con.execute(statement("fleet/candidate", **numbers))
    _take_pairs(con)
    con.execute(statement("fleet/part", **numbers))
    for side, other_side, of in (("base", "new", new), ("new", "base", base)):
        con.execute(statement("fleet/only", side=side, other_side=other_side, of=of, **numbers))
    tolerances = {"margin_tolerance": f"{MARGIN_TOLERANCE!r}", "interval_tolerance_s": f"{INTERVAL_TOLERANCE_S!r}"}
    made = statement("fleet/difference", base=base, new=new, **tolerances)
    con.execute(made, {"base_tool": tools[0], "new_tool": tools[1]})
    rows = con.execute(statement("fleet/differences")).fetchall()
    counts = (DifferenceCount(r, p, s, tuple(causes), tuple(unknown), n) for r, p, s, causes, unknown, n in rows)
    both = _number(con, "same_drive")
    return Comparison(tuple(counts), both, _number(con, f"{base}drives") - both, _number(con, f"{new}drives") - both)


def _take_pairs(con: duckdb.DuckDBPyConnection) -> None:
    """Fill the table `pair` from `candidate`, until no candidate is left. Each round takes one at least; one or two do mostly."""
    con.execute("CREATE OR REPLACE TEMP TABLE pair (drive VARCHAR, new_no BIGINT, base_no BIGINT)")
    while _number(con, "candidate"):
        con.execute(statement("fleet/pair"))
        con.execute(statement("fleet/untaken"))


def _number(con: duckdb.DuckDBPyConnection, table: str) -> int:
    (n,) = con.execute(f"SELECT count(*) FROM {table}").fetchone() or (0,)
    return int(n)
