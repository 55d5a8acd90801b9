"""Computes which verdicts of a fleet change with another value of a rule's parameter, from the stored observed values.

A verdict only stores the observed value of its worst step. That is enough if the rule compares the observed value with the parameter
itself, and the parameter does not affect the observed value. Every other rule or parameter needs a new check.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

from drivelint.errors import UsageError
from drivelint.fleet.distinct_logs import counted_egos_sql
from drivelint.fleet.situations import parameters_of_tag
from drivelint.phrases import hint
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    import duckdb

    from drivelint.catalogue import Rule


class FlipCount(NamedTuple):
    """The number of verdicts, of one profile and value of a tag, that change or stay the same. `becomes` None: they need a new check."""

    profile: str | None
    tag_value: str | None
    was: str
    becomes: str | None
    n: int


class FlippedVerdict(NamedTuple):
    """One verdict that changes. `becomes` None: it needs a new check."""

    log: str
    ego_id: str
    profile: str | None
    object_id: str | None
    occurrence: int | None
    was: str
    becomes: str | None


class WhatIf(NamedTuple):
    """The effect of another value of a parameter on the verdicts. `needs_check`: why every verdict needs a new check; None:
    stored values are enough."""

    rule_id: str
    param: str
    value: float
    needs_check: str | None
    verdicts: tuple[FlipCount, ...] = ()

    @property
    def flips(self) -> tuple[FlipCount, ...]:
        """The counts of verdicts that are known to change."""
        return tuple(count for count in self.verdicts if count.becomes not in {None, count.was})

    @property
    def not_known(self) -> int:
        """The number of verdicts that need a new check."""
        return sum(count.n for count in self.verdicts if count.becomes is None)


def what_if(
    con: duckdb.DuckDBPyConnection, rule: Rule, param: str, value: float, by: str | None = None, *, of: str = ""
) -> WhatIf:
    """Return the verdicts of a rule with another value of a parameter, by profile and value of a tag.

    The temporary table `what_if` gets one row per verdict, unless a new check is needed. Findings are not predicted: a failed verdict may
    have several, and their start and end depend on every step. Errors: `UsageError` for a parameter that the rule does not have.
    """
    if why := reason_for_new_check(rule, param):
        return WhatIf(rule.id, param, value, why)
    # rounded as in an evaluation
    required = round(value, 9) if rule.sense in {">=", "<="} else value
    bound = {
        "rule_id": rule.id,
        "rule_version": rule.version,
        "value": required,
        "is_bound": rule.has_column("at_least"),
    }
    bound["proven"] = "pass" if rule.sense.startswith(">") else "fail"
    con.execute(
        statement("fleet/what_if", of=of, subject=counted_egos_sql(of, by), sense=rule.sense),
        bound | parameters_of_tag(by),
    )
    rows = con.execute(statement("fleet/flips")).fetchall()
    return WhatIf(rule.id, param, value, None, tuple(FlipCount(*row) for row in rows))


def flipped_verdicts(con: duckdb.DuckDBPyConnection, max_verdicts: int, *, of: str = "") -> tuple[FlippedVerdict, ...]:
    """Return the first verdicts of the table `what_if` that change or need a new check."""
    return tuple(
        FlippedVerdict(*row)
        for row in con.execute(statement("fleet/flipped", of=of), {"most": max_verdicts}).fetchall()
    )


def reason_for_new_check(rule: Rule, param: str) -> str | None:
    """Return why stored verdicts are not enough to apply another value of a parameter; None: they are enough."""
    if param not in rule.params:
        raise UsageError(f"rule {rule.id} has no parameter {param!r}; {hint(param, rule.params)}")
    default = rule.params[param].default
    if isinstance(default, bool | str):
        return f"{param} is no number"
    if (
        rule.sense == "holds"
        or rule.kind not in {"invariant", "execution"}
        or rule.combine != "each"
        or rule.quantifier != "always"
    ):
        return "its verdict does not depend only on one observed and one required value"
    text = re.sub(r"--.*", "", "\n".join(rule.sections.values()))
    condition = re.sub(r"--.*", "", rule.sections["condition"])
    is_required = re.search(rf",\s*\${param}\s+AS\s+required\s*(,|FROM\b)", condition)
    elsewhere = len(re.findall(rf"\${param}\b", text)) > 1 or len(re.findall(r"\brequired\b", condition)) > 1
    if not is_required or elsewhere or re.search(r"\bUNION\b", condition):
        return f"{param} is not only the required value: it also affects the observed value, or when the rule applies"
    if param in {rule.window_s, rule.exempt_after_s, rule.merge_gap_s}:
        return f"{param} is also a time that determines which steps count"
    return None
