"""Evaluation: the rules over the tables of a database, any number of drives and egos at once.

Every (subject, rule) gets at least one verdict row, by construction: what was decided before running, what the rule's statements left,
or not applicable. Where a rule's SQL fails, that rule is `error` for the subjects it was to judge, and the others go on.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import duckdb

from drivelint.errors import UsageError
from drivelint.evaluate import closing, findings, invariant, occasion, stage
from drivelint.evaluate.terms import Binding

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.catalogue import Rule

__all__ = ["evaluate"]


def evaluate(
    con: duckdb.DuckDBPyConnection,
    rules: Sequence[Rule],
    params: Mapping[str, Mapping[str, object]] | None = None,
    *,
    margins: bool = False,
) -> None:
    """Judge every (drive_id, ego_id) of `clock` by `rules`; append to `verdict`, `finding` and, if asked for, `margin`.

    `con` holds the tables of schemas/*.sql, filled. `params` is rule id -> parameter -> value. A failing statement costs its rule only.
    Errors: `UsageError` for parameters of rules or names that do not exist.
    """
    params = params or {}
    strange = sorted(params.keys() - {rule.id for rule in rules})
    if strange:
        raise UsageError(f"parameters are given for {strange[0]!r}, which is not among the selected rules")
    bindings = [Binding(rule, no, params.get(rule.id, {})) for no, rule in enumerate(rules)]
    run = _Run(con, bindings, margins)
    try:
        run.judge()
    finally:
        stage.clean_up(con)


class _Run:
    """One evaluation: its connection, its rules and what they share."""

    def __init__(self, con: duckdb.DuckDBPyConnection, bindings: Sequence[Binding], margins: bool) -> None:
        self.con = con
        self.bindings = bindings
        self.margins = margins
        self.n_todo: dict[int, int] = {}
        self.n_subjects = 0
        self.n_segments = 0

    def judge(self) -> None:
        """Run every rule and close."""
        self.n_todo = stage.prepare(self.con, self.bindings)
        self.n_subjects = self._count("SELECT count(*) FROM _subject")
        self.n_segments = self._count("SELECT count(*) FROM _segment")
        live = [b for b in self.bindings if self.n_todo.get(b.no)]
        quick = [] if self.margins else [b for b in live if b.rule.kind == "invariant" and invariant.grid_of(b.rule)]
        if quick:
            self.con.execute(invariant.GRID_GROUPS, {"_objects": any(b.rule.per_object for b in quick)})
        for binding in live:
            try:
                self._rule(binding, quick=binding in quick)
            except duckdb.Error as error:
                self._blame(binding, error)
        for statement in closing.STATEMENTS:
            self.con.execute(statement)

    def _rule(self, binding: Binding, *, quick: bool) -> None:
        if binding.rule.kind == "invariant":
            self._invariant(binding, quick=quick)
        else:
            self._occasion(binding)

    def _invariant(self, binding: Binding, *, quick: bool) -> None:
        rule, partial = binding.rule, self._partial(binding)
        if rule.profiled:
            self._run(invariant.profile_set(rule), binding)
        if rule.per_object and "applies" not in rule.sections:
            self._run(invariant.lost_objects(rule, partial), binding)
        expected = -1
        if quick:
            self._run(invariant.first_pass(rule, partial), binding)
            expected = self._count(
                f"SELECT coalesce(sum(n), 0)::BIGINT FROM _group WHERE rule_no = {binding.no} AND NOT clean"
            )
            if not expected:
                return
        made = self._run(invariant.second_pass(rule, partial, quick), binding)
        if not made:
            return
        if made != expected:
            self._run(invariant.FAULTS, binding)
        self._run(invariant.episodes(rule), binding)
        if self.n_segments > self.n_subjects:
            self._run(invariant.HOLES, binding)
        self._leavings(binding)

    def _occasion(self, binding: Binding) -> None:
        rule = binding.rule
        if not self._run(occasion.raw_references(rule, self._partial(binding)), binding):
            return
        described = self.con.execute("SELECT * FROM _raw_reference LIMIT 0").description or []
        columns = [str(column[0]) for column in described]
        own_object = "object_id" in columns
        self._run(occasion.references(columns), binding)
        self._run(occasion.occasions(rule, own_object), binding)
        self._run(occasion.points(rule), binding)
        if rule.profiled:
            self._run(invariant.profile_set(rule), binding)
        self._run(occasion.judged(rule, own_object), binding)
        self._run(occasion.FAULTS, binding)
        self._run(occasion.outcomes(rule, own_object), binding)
        self._leavings(binding)

    def _leavings(self, binding: Binding) -> None:
        self._run(findings.stretches(binding.rule), binding)
        if self.margins:
            self._run(findings.margins(binding.rule), binding)

    def _partial(self, binding: Binding) -> bool:
        return self.n_todo[binding.no] < self.n_subjects

    def _run(self, sql: str, binding: Binding) -> int:
        """Execute one statement with exactly the values it names; return the rows it made."""
        statement = self.con.extract_statements(sql)[0]
        row = self.con.execute(statement, binding.values(statement.named_parameters)).fetchone()
        return int(row[0]) if row else 0

    def _count(self, sql: str) -> int:
        row = self.con.execute(sql).fetchone()
        return int(row[0]) if row else 0

    def _blame(self, binding: Binding, error: duckdb.Error) -> None:
        """Make this rule an error for every subject that it was to judge."""
        line = str(error).splitlines()[0]
        self.con.execute(
            "INSERT INTO _error SELECT rule_no, drive_id, ego_id, 'rule_error', $reason FROM _todo WHERE rule_no = $no",
            {"no": binding.no, "reason": f"rule {binding.rule.id}: {line}"},
        )
