"""Evaluates rules over the tables of a database, for all drives and egos at once.

Every (subject, rule) gets at least one verdict row, by construction: what was decided before running, what the rule's
statements left, or not applicable. Where a rule's SQL fails, that rule is `error` for the subjects that it was to
judge, and the others go on.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.errors import UsageError
from drivelint.evaluate import temp_tables
from drivelint.evaluate.evaluation import Evaluation, PlanRecorder
from drivelint.evaluate.limits import RuleLimits
from drivelint.evaluate.sql_fragments import Binding

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import duckdb

    from drivelint.catalogue import Rule

__all__ = ["evaluate", "query_plans"]


def evaluate(
    con: duckdb.DuckDBPyConnection,
    rules: Sequence[Rule],
    params: Mapping[str, Mapping[str, object]] | None = None,
    *,
    margins: bool = False,
    keep_measure_series: bool = False,
    may_retry: bool = False,
    limits: RuleLimits | None = None,
    release: Callable[[], None] | None = None,
) -> None:
    """Judge every (drive_id, ego_id) of `clock` by `rules`; append to `verdict`, `finding` and, if asked for, `margin`, `course`.

    `con` holds the tables of schemas/*.sql, filled, and is not inside a transaction. `params` is rule id -> parameter
    -> value.
    A failing statement costs its rule only, and so does one beyond `limits` (None: there are none).
    `release` gives memory back; it is called before the statements that are about all rules.
    With `may_retry`, running out of memory is no failure of the rule but raised, and the
    tables are then of no use. Errors: `UsageError` for parameters of rules or names that do not exist;
    `duckdb.OutOfMemoryException`.
    """
    params = params or {}
    strange = sorted(params.keys() - {rule.id for rule in rules})
    if strange:
        raise UsageError(f"parameters are set for {strange[0]!r}, which is not among the selected rules")
    if not rules:
        return
    bindings = [Binding(rule, no, params.get(rule.id, {})) for no, rule in enumerate(rules)]
    run = Evaluation(
        con,
        bindings,
        margins=margins,
        keep_measure_series=keep_measure_series,
        may_retry=may_retry,
        limits=limits or RuleLimits(None),
        release=release,
    )
    try:
        run.judge()
    finally:
        temp_tables.drop_tables(con)


def query_plans(con: duckdb.DuckDBPyConnection, rule: Rule) -> list[str]:
    """Return the physical plans of all statements that a rule may run.

    Errors: `duckdb.Error` where the rule's SQL does not match the tables.
    """
    plans: list[str] = []
    for margins in (False, True):
        binding = Binding(rule, 0, {})
        run = PlanRecorder(con, [binding], margins=margins)
        try:
            run.prepare()
            run.judge_rule(binding)
            run.conclude()
        finally:
            temp_tables.drop_tables(con)
        plans += run.plans
    return plans
