"""Evaluates rules over the tables of a database, for all drives and egos at once.

Every rule and subject (an ego in a drive) gets at least one verdict row: decided before the rule runs, returned by the rule's statements,
or not applicable. If the SQL of a rule fails, its verdict is `error` for the subjects that it had to judge; other rules are not affected.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.errors import UsageError
from drivelint.evaluate.evaluation import Evaluation, PlanRecorder
from drivelint.evaluate.limits import RuleLimits
from drivelint.evaluate.sql_fragments import Binding
from drivelint.sql import store

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
    """Judge every (drive_id, ego_id) of `clock` by `rules`; append to `verdict`, `finding` and, if requested, `margin` and `course`.

    `con`: a database with the filled tables of schemas/*.sql, not inside a transaction. `params`: rule id -> parameter -> value.
    `margins`, `keep_measure_series`: fill `margin` and `course`. A statement that fails or exceeds `limits` (None: no limits) affects only
    its rule. `release` frees memory; it is called before the statements about all rules. `may_retry`: if memory is short, raise the error
    instead of recording it for the rule; the tables are then incomplete. Errors: `UsageError` for parameters of unselected rules or with
    unknown names; `duckdb.OutOfMemoryException`.
    """
    params = params or {}
    strange = sorted(params.keys() - {rule.id for rule in rules})
    if strange:
        raise UsageError(f"parameters are set for {strange[0]!r}, which is not among the selected rules")
    if not rules:
        return
    bindings = [Binding(rule, no, params.get(rule.id, {})) for no, rule in enumerate(rules)]
    with store.cursor(con) as cursor:  # its end drops all temporary tables
        run = Evaluation(
            cursor,
            bindings,
            margins=margins,
            keep_measure_series=keep_measure_series,
            may_retry=may_retry,
            limits=limits or RuleLimits(None),
            release=release,
        )
        run.judge()


def query_plans(con: duckdb.DuckDBPyConnection, rule: Rule) -> list[str]:
    """Return the physical plans of all statements that a rule may run.

    Errors: `duckdb.Error` if the rule's SQL does not match the tables.
    """
    plans: list[str] = []
    for margins in (False, True):
        binding = Binding(rule, 0, {})
        with store.cursor(con) as cursor:
            run = PlanRecorder(cursor, [binding], margins=margins)
            run.prepare()
            run.judge_rule(binding)
            run.aggregate_pending_steps()
        plans += run.plans
    return plans
