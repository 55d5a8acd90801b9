"""One evaluation: which statements a rule needs, in order, and when it can stop early."""

from __future__ import annotations

from collections import deque
from concurrent.futures import ThreadPoolExecutor, wait
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final

import duckdb

from drivelint.evaluate import findings, invariant, reference_points, temp_tables
from drivelint.evaluate.limits import RuleLimits
from drivelint.evaluate.sql_fragments import rule_statement
from drivelint.reasons.reason_table import make_reason_table
from drivelint.resources import folder
from drivelint.sql import store
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from drivelint.evaluate.limits import Excess
    from drivelint.evaluate.sql_fragments import Binding

LEAST_RULES_FOR_TWO_CONNECTIONS: Final = 16
"""From so many rules on they are judged on two connections."""
LEAST_STEPS_FOR_TWO_CONNECTIONS: Final = 2_000
"""Steps below which they are not: the tables that the second one needs cost more than it would save."""
MOST_STEPS_FOR_TWO_CONNECTIONS: Final = 200_000
"""Steps from which on they are not: one statement then uses all cores, and two would need twice the memory."""


@dataclass
class Evaluation:
    """A connection, the rules to judge on it, what is asked for, and what the rules share."""

    con: duckdb.DuckDBPyConnection
    bindings: Sequence[Binding]
    margins: bool
    keep_measure_series: bool = False
    may_retry: bool = False
    limits: RuleLimits = field(default_factory=lambda: RuleLimits(None))
    release: Callable[[], None] | None = None
    """Gives memory back before the statements that are about all rules."""
    alone: bool = True
    """No rule is judged on a second connection at the same time."""
    _n_todo: dict[int, int] = field(default_factory=dict, init=False)
    _n_subjects: int = field(default=0, init=False)
    _has_holes: bool = field(default=False, init=False)
    _check_engagement: bool = field(default=False, init=False)
    _has_doubts: bool = field(default=False, init=False)
    _has_sensors: bool = field(default=False, init=False)
    _empty: set[str] = field(default_factory=set, init=False)

    def judge(self) -> None:
        """Judge by every rule, then write the verdicts, findings and margins of all of them at once."""
        self.prepare()
        todo = deque(binding for binding in self.bindings if self._n_todo.get(binding.no))
        # what memory the process takes can be laid to a rule only if no other one runs meanwhile
        shipped = deque(binding for binding in todo if _is_shipped(binding))
        n_steps = self._count("SELECT count(*) FROM step")
        if (
            len(shipped) >= LEAST_RULES_FOR_TWO_CONNECTIONS
            and LEAST_STEPS_FOR_TWO_CONNECTIONS <= n_steps < MOST_STEPS_FOR_TWO_CONNECTIONS
        ):
            todo = deque(binding for binding in todo if binding not in shipped)
            self._share(shipped)
        self._work(todo)
        if self.release:
            self.release()
        self._run("blind", "closed", "named", "failed")
        make_reason_table(
            self.con,
            "SELECT rule_no, cause, start_ns FROM _named UNION ALL SELECT rule_no, cause, start_ns FROM _failed",
            {binding.no: binding.rule.reasons for binding in self.bindings},
        )
        self._run("finding", "verdict", *(("margin",) if self.margins else ()))
        if self.keep_measure_series:
            self._run("course")

    def _share(self, todo: deque[Binding]) -> None:
        """Judge on a second connection too: on so few rows a statement is planned and run on one core."""
        with ThreadPoolExecutor(1) as pool, store.cursor(self.con) as other:
            self.alone = False
            helper = replace(self, con=other)
            helped = pool.submit(helper.judge_from_queue, todo)
            try:
                self._work(todo)
                helped.result()
                for table in temp_tables.OUTCOME_TABLES:
                    store.insert(self.con, table, other.execute(f"FROM temp.{table}").to_arrow_table())
            finally:
                todo.clear()  # whatever came between, the helper stops after its present rule
                wait([helped])
                self.alone = True

    def judge_from_queue(self, todo: deque[Binding]) -> None:
        """Judge rules from a shared queue; another run collects the outcomes."""
        self.prepare()
        self._work(todo)

    def _work(self, todo: deque[Binding]) -> None:
        """Judge by the rules that are still to do, until there are none."""
        while True:
            try:
                binding = todo.popleft()
            except IndexError:
                return
            if (lost := self.limits.lost(binding.rule.id)) is not None:
                self._record(binding, lost, again=True)
                continue
            if self._has_no_occasion(binding):
                continue
            with self.limits.hold(self.con, binding.rule.id, alone=self.alone) as held:
                try:
                    with store.telling_short_memory():
                        self.judge_rule(binding)
                except duckdb.Error as error:
                    failure = error
                else:
                    continue
            self._blame(binding, failure, held.excess)

    def prepare(self) -> None:
        """Make the run's tables, decide which rules need not run, and group the default grids once for all rules."""
        self._n_todo = temp_tables.create_tables(self.con, self.bindings)
        self._n_subjects = self._count("SELECT count(*) FROM _subject")
        self._has_holes = self._count("SELECT count(*) FROM _segment WHERE seg > 0") > 0
        self._run("watched")
        self._check_engagement = self._count("SELECT count(*) FROM _watched") > 0
        self._empty = store.empty_tables(self.con)
        self._has_doubts = "doubt" not in self._empty
        self._has_sensors = bool(self._count("SELECT count(*) FROM data_log WHERE sensor_range_m IS NOT NULL"))
        if self._has_doubts:
            temp_tables.create_doubts(self.con, self.bindings)
        quick = [b for b in self.bindings if self._is_quick(b)]
        if quick:
            objects = any(binding.rule.per_object for binding in quick)
            self.con.execute(statement("judging/grid_group"), {"_objects": objects})

    def judge_rule(self, binding: Binding) -> None:
        """Run the statements of one rule."""
        if binding.rule.kind == "invariant":
            self._invariant(binding)
        else:
            self._occasion(binding)

    def _has_no_occasion(self, binding: Binding) -> bool:
        """Whether a rule needs no statement; one of the user's may have an error in it, which only running it shows."""
        return bool(binding.rule.occasion_needs & self._empty) and _is_shipped(binding)

    def _is_quick(self, binding: Binding) -> bool:
        """Whether the first pass can settle groups; margins need every step anyway."""
        return not self.margins and invariant.has_default_grid(binding.rule)

    def _is_partial(self, binding: Binding) -> bool:
        return self._n_todo.get(binding.no, 0) < self._n_subjects

    def _invariant(self, binding: Binding) -> None:
        rule, partial, quick = binding.rule, self._is_partial(binding), self._is_quick(binding)
        if rule.per_profile:
            self._execute(rule_statement("profile_set", rule), binding)
        if rule.per_object and "applies" not in rule.sections:
            self._execute(invariant.lost_objects_sql(rule, partial, self._check_engagement), binding)
        n_steps = -1
        if quick:
            self._execute(invariant.first_pass_sql(rule, partial), binding)
            if self._has_doubts:
                self._execute(statement("judging/doubt_of_groups"), binding)
            n_steps = self._count(
                f"SELECT coalesce(sum(n), 0)::BIGINT FROM _group WHERE rule_no = {binding.no} AND NOT clean"
            )
            if self._has_near_misses(binding, "_group", "clean"):
                self._execute(findings.first_pass_measure_series_sql(binding.rule), binding)
            if self._may_stop(n_steps):
                return
        elif self._may_stop(
            self._execute(invariant.steps_to_judge_sql(rule, partial, self._check_engagement), binding)
        ):
            return
        n_judged = self._execute(invariant.second_pass_sql(rule, partial, quick, self._check_engagement), binding)
        if self._may_stop(n_judged):
            return
        if self._check_engagement or n_judged != n_steps:  # as many rows as the grid has steps: none can be double
            self._execute(statement("judging/error_of_grid"), binding)
        if self._has_doubts:
            self._execute(statement("judging/doubt_of_short_time"), binding)
        self._doubt_steps(binding, "object_id")
        self._execute(invariant.episodes_sql(rule), binding)
        if self._has_holes:
            self._execute(statement("judging/outcome_of_holes"), binding)
        self._leave(binding)

    def _occasion(self, binding: Binding) -> None:
        rule = binding.rule
        if self._may_stop(self._execute(reference_points.raw_references_sql(rule, self._is_partial(binding)), binding)):
            return
        described = self.con.execute("SELECT * FROM _raw_reference LIMIT 0").description or []
        columns = [str(column[0]) for column in described]
        own_object = "object_id" in columns
        self._execute(reference_points.references_sql(columns), binding)
        self._execute(reference_points.windows_sql(rule, own_object, self._check_engagement), binding)
        self._execute(reference_points.reference_steps_sql(rule), binding)
        if rule.per_profile:
            self._execute(rule_statement("profile_set", rule), binding)
        self._execute(reference_points.judged_steps_sql(rule, own_object, self._check_engagement), binding)
        self._doubt_steps(binding, "coalesce(nullif(who, ''), object_id)")
        self._execute(statement("judging/error_of_references"), binding)
        self._execute(reference_points.outcomes_sql(rule, own_object), binding)
        self._leave(binding)

    def _doubt_steps(self, binding: Binding, whom: str) -> None:
        """Take back what was judged by data in doubt, or missed by less than a sensor can tell; `whom`: the object of a step, in SQL."""
        if self._has_doubts:
            self._execute(statement("judging/doubt_of_steps", object=whom), binding)
        if self._has_sensors and binding.rule.sense != "holds":
            self._execute(statement("judging/error_of_measuring"), binding)

    def _leave(self, binding: Binding) -> None:
        if self._has_near_misses(binding, "_outcome", "verdict = 'pass'"):
            self._execute(findings.near_miss_measure_series_sql(binding.rule), binding)
        if not self._may_stop(self._count("SELECT count(*) FROM (FROM _judged WHERE NOT holds LIMIT 1)")):
            self._execute(findings.stretches_sql(binding.rule), binding)
            if self.keep_measure_series:
                self._execute(findings.measure_series_sql(binding.rule), binding)
        if self.margins:
            self._execute(findings.margins_sql(binding.rule), binding)

    def _has_near_misses(self, binding: Binding, table: str, kept: str) -> bool:
        """Whether measure series are asked for, and some kept rows of a table of outcomes are near misses."""
        near = f"FROM {table} JOIN _rule USING (rule_no) WHERE rule_no = {binding.no} AND {kept} AND is_near_miss(margin, near_margin)"
        return self.keep_measure_series and not self._may_stop(self._count(f"SELECT count(*) {near}"))

    def _may_stop(self, n_rows: int) -> bool:
        return n_rows == 0

    def _run(self, *names: str) -> None:
        """Run statements of `queries/judging` in this order."""
        for name in names:
            self.con.execute(statement(f"judging/{name}"))

    def _execute(self, sql: str, binding: Binding) -> int:
        """Execute one statement with exactly the values it names; return how many rows it made."""
        parsed = self.con.extract_statements(sql)[0]
        row = self.con.execute(parsed, binding.values(parsed.named_parameters)).fetchone()
        return int(row[0]) if row else 0

    def _count(self, sql: str) -> int:
        row = self.con.execute(sql).fetchone()
        return int(row[0]) if row else 0

    def _blame(self, binding: Binding, error: duckdb.Error, excess: Excess | None) -> None:
        """Record this rule as an error for every drive and ego that it was to judge; raise the error if a retry may avoid it."""
        if excess is not None:
            self._record(binding, excess)
        elif isinstance(error, duckdb.OutOfMemoryException):
            if self.may_retry:
                raise error
            self._record(
                binding, "out_of_memory"
            )  # the database's message names block sizes that differ from run to run
        else:
            self._record(binding, "rule_error", f"rule {binding.rule.id}: {str(error).splitlines()[0]}")

    def _record(self, binding: Binding, code: str, told: str | None = None, *, again: bool = False) -> None:
        values = {"no": binding.no, "code": code, "told": told, "again": again, "rule": binding.rule.id}
        self.con.execute(statement("judging/error_of_rule"), {**values, "limit_s": self.limits.allowed_s})


def _is_shipped(binding: Binding) -> bool:
    return binding.rule.path.is_relative_to(folder("queries"))


@dataclass
class PlanRecorder(Evaluation):
    """An evaluation that records the plan of every statement and runs all alternatives."""

    keep_measure_series: bool = True
    plans: list[str] = field(default_factory=list, init=False)

    def prepare(self) -> None:
        """Make the run's tables; holes and drivers that are not engaged are always looked for."""
        super().prepare()
        self._has_holes = self._check_engagement = True

    def _may_stop(self, n_rows: int) -> bool:  # noqa: ARG002 - the shape of what it overrides
        return False

    def _execute(self, sql: str, binding: Binding) -> int:
        parsed = self.con.extract_statements(f"EXPLAIN {sql}")[0]
        rows = self.con.execute(parsed, binding.values(parsed.named_parameters)).fetchall()
        self.plans += [str(plan) for _, plan in rows]
        return super()._execute(sql, binding)
