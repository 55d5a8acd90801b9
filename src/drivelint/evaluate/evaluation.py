"""Runs an evaluation: for each rule the statements that it needs, in order, and then the statements about all rules at once."""

from __future__ import annotations

from collections import deque
from concurrent.futures import ThreadPoolExecutor, wait
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final, NamedTuple

import duckdb

from drivelint.evaluate import invariant, reference_points, temp_tables
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
"""From this number of built-in rules on, rules are judged on two connections."""
LEAST_STEPS_FOR_TWO_CONNECTIONS: Final = 2_000
"""Below this number of steps, one connection is used: the tables of a second one would cost more than it saves."""
TOO_MANY_STEPS_FOR_TWO_CONNECTIONS: Final = 200_000
"""From this number of steps on, one connection is used: one statement then uses all cores, and two would need twice the memory."""
LEAST_STEPS_FOR_A_FIRST_PASS: Final = 2_000
"""From this number of steps on, there is a first pass (see `invariant`); for fewer steps, it costs more than it saves."""
MOST_PENDING_ROWS: Final = 50_000
"""If there are more judged steps than this, `aggregate_pending_steps` is called before the next rule."""


class _StepSelectionAndCount(NamedTuple):
    """Which steps of an invariant's grid are judged one by one, and their number (-1: unknown)."""

    selection: invariant.StepSelection
    n: int


@dataclass
class Evaluation:
    """A connection, the rules to judge on it, the options, and the state that the rules have in common."""

    con: duckdb.DuckDBPyConnection
    bindings: Sequence[Binding]
    margins: bool
    keep_measure_series: bool = False
    may_retry: bool = False
    limits: RuleLimits = field(default_factory=lambda: RuleLimits(None))
    release: Callable[[], None] | None = None
    """Called before the statements about all rules, to free memory."""
    is_only_connection: bool = True
    """Whether no rule is judged on another connection at the same time."""
    _n_todo: dict[int, int] = field(default_factory=dict, init=False)
    _rules_outside_conditions: set[int] = field(default_factory=set, init=False)
    """The numbers of the rules whose conditions are met at no step."""
    _n_steps: int = field(default=0, init=False)
    _n_subjects: int = field(default=0, init=False)
    _has_holes: bool = field(default=False, init=False)
    _check_engagement: bool = field(default=False, init=False)
    _has_doubts: bool = field(default=False, init=False)
    _has_sensors: bool = field(default=False, init=False)
    _empty_tables: set[str] = field(default_factory=set, init=False)
    _is_short: bool = field(default=False, init=False)
    _pending: list[Binding] = field(default_factory=list, init=False)
    """The rules whose judged steps are not aggregated to outcomes yet."""
    _n_pending: int = field(default=0, init=False)
    _has_old_steps: bool = field(default=True, init=False)
    """Whether the tables of judged steps contain steps of earlier rules. Then the next rule replaces these tables."""
    _may_be_double: bool = field(default=False, init=False)
    """Whether there may be several pending steps with the same key."""
    _rules_to_aggregate_separately: set[int] = field(default_factory=set, init=False)
    """The numbers of the rules whose steps are aggregated separately, because `aggregate_pending_steps` failed with several rules."""

    def judge(self) -> None:
        """Judge by every rule, then write the verdicts, findings and margins of all rules at once."""
        self.prepare()
        todo = deque(binding for binding in self.bindings if self._n_todo.get(binding.no))
        # only built-in rules run in parallel: the growth of memory is a user rule's only if no other rule runs
        shipped = deque(binding for binding in todo if _is_shipped(binding))
        if (
            len(shipped) >= LEAST_RULES_FOR_TWO_CONNECTIONS
            and LEAST_STEPS_FOR_TWO_CONNECTIONS <= self._n_steps < TOO_MANY_STEPS_FOR_TWO_CONNECTIONS
        ):
            todo = deque(binding for binding in todo if binding not in shipped)
            self._judge_on_two_connections(shipped)
        self._judge_queue_and_aggregate(todo)
        if self.release:
            self.release()
        self._run_statements("blind", "closed")
        unexplained = "FROM _closed WHERE verdict = 'unknown' AND reason IS NULL AND tells_no_cause(code)"
        self._run_statements("cause" if self._count_rows(f"SELECT count(*) {unexplained}") else "no_cause", "named")
        n_failed = self._run_statements("failed")
        make_reason_table(
            self.con,
            "SELECT rule_no, cause, start_ns FROM _named UNION ALL SELECT rule_no, cause, start_ns FROM _failed",
            {binding.no: binding.rule.reasons for binding in self.bindings},
        )
        self._run_statements(*(("finding",) if n_failed else ()), "verdict", *(("margin",) if self.margins else ()))
        if self.keep_measure_series:
            self._run_statements("course")

    def _judge_on_two_connections(self, todo: deque[Binding]) -> None:
        """Judge the rules of the queue on two connections, because DuckDB uses only one core for few rows."""
        with ThreadPoolExecutor(1) as pool, store.cursor(self.con) as second:
            self.is_only_connection = False
            helper = replace(self, con=second)
            helped = pool.submit(helper.judge_from_queue, todo)
            try:
                self._judge_queue_and_aggregate(todo)
                helped.result()
                for table in temp_tables.OUTCOME_TABLES:
                    store.insert(self.con, table, second.execute(f"FROM temp.{table}").to_arrow_table())
            finally:
                todo.clear()  # if an error occurred, the helper stops after its current rule
                wait([helped])
                self.is_only_connection = True

    def judge_from_queue(self, todo: deque[Binding]) -> None:
        """Judge rules from a shared queue; the other `Evaluation` collects the outcomes."""
        self.prepare()
        self._judge_queue_and_aggregate(todo)

    def _judge_queue_and_aggregate(self, todo: deque[Binding]) -> None:
        """Judge by the rules of the queue until it is empty, and make outcomes of their steps."""
        self._judge_queue(todo)
        while self._pending:
            try:
                with store.uniform_memory_errors():
                    self.aggregate_pending_steps()
            except duckdb.Error:
                self._judge_queue(deque(self._discard_results_to_judge_separately(self._pending)))

    def _discard_results_to_judge_separately(self, bindings: Sequence[Binding]) -> list[Binding]:
        """Delete the results of these rules, and return the rules to judge them separately, so that only the faulty one fails."""
        again = list(bindings)
        numbers = [binding.no for binding in again]
        for table in temp_tables.OUTCOME_TABLES:
            self.con.execute(f"DELETE FROM {table} WHERE list_contains(?, rule_no)", [numbers])
        self._rules_to_aggregate_separately.update(numbers)
        self._forget_pending_steps()
        return again

    def _judge_queue(self, todo: deque[Binding]) -> None:
        """Evaluate the bindings, taken from the front of `todo`, which two threads may share, until it is empty."""
        while True:
            try:
                binding = todo.popleft()
            except IndexError:
                return
            if (excess := self.limits.exceeded_limit(binding.rule.id)) is not None:
                self._insert_error_verdicts(binding, excess, was_skipped=True)
                continue
            if self._has_no_occasion(binding):
                continue
            aggregates = False
            with self.limits.limit_statements(self.con, binding.rule.id, alone=self.is_only_connection) as limits:
                try:
                    with store.uniform_memory_errors():
                        self.judge_rule(binding)
                        aggregates = (
                            binding.no in self._rules_to_aggregate_separately or self._n_pending > MOST_PENDING_ROWS
                        )
                        if aggregates:
                            self.aggregate_pending_steps()
                except duckdb.Error as error:
                    failure = error
                else:
                    continue
            self._pending = [waiting for waiting in self._pending if waiting is not binding]
            if aggregates:
                todo.extendleft(self._discard_results_to_judge_separately(self._pending))
            self._record_error(binding, failure, limits.excess)

    def prepare(self) -> None:
        """Create the temporary tables, decide which rules need not run, and group the default grids once for all rules."""
        self._n_todo, self._rules_outside_conditions = temp_tables.create_tables_and_count_subjects(
            self.con, self.bindings
        )
        self._forget_pending_steps()
        self._run_statements("watched")
        row = self.con.execute(statement("judging/content")).fetchone() or (0, 0, False, False, False)
        self._n_steps, self._n_subjects, self._has_holes, self._check_engagement, self._has_sensors = row
        self._is_short = self._n_steps < LEAST_STEPS_FOR_A_FIRST_PASS
        self._empty_tables = store.tables_without_rows(self.con)
        self._has_doubts = "doubt" not in self._empty_tables
        if self._has_doubts:
            temp_tables.create_table_of_doubted_steps(self.con, self.bindings)
        quick = [b for b in self.bindings if self._has_first_pass(b)]
        if quick:
            objects = any(binding.rule.per_object for binding in quick)
            self.con.execute(statement("judging/grid_group"), {"_objects": objects})

    def judge_rule(self, binding: Binding) -> None:
        """Judge the steps by one rule; `aggregate_pending_steps` makes outcomes of the judged steps."""
        if self._has_old_steps:
            self._create_tables_of_steps()
        self._pending.append(binding)
        if binding.rule.kind == "invariant":
            self._judge_invariant(binding)
        else:
            self._judge_at_references(binding)

    def _has_no_occasion(self, binding: Binding) -> bool:
        """Return whether a built-in rule has no outcome because a table is empty; a user's rule always runs, to show its errors."""
        return bool(binding.rule.occasion_needs & self._empty_tables) and _is_shipped(binding)

    def _has_first_pass(self, binding: Binding) -> bool:
        """Return whether the rule has a first pass; margins need every step, so there is none then."""
        return not self._is_short and not self.margins and invariant.has_default_grid(binding.rule)

    def _skips_some_subjects(self, binding: Binding) -> bool:
        return self._n_todo.get(binding.no, 0) < self._n_subjects

    def _judge_invariant(self, binding: Binding) -> None:
        rule, partial, steps = (
            binding.rule,
            self._skips_some_subjects(binding),
            self._settle_groups_and_select_remaining_steps(binding),
        )
        if steps is None:
            return
        n_judged = self._execute(
            invariant.judged_steps_sql(rule, partial, self._check_engagement, steps.selection), binding
        )
        self._n_pending += n_judged
        # if there are as many rows as steps in the grid, no key can be repeated
        self._may_be_double |= self._check_engagement or n_judged != steps.n

    def _settle_groups_and_select_remaining_steps(self, binding: Binding) -> _StepSelectionAndCount | None:
        """Settle groups without judging each step; return the remaining steps, or None if there are none."""
        rule, partial = binding.rule, self._skips_some_subjects(binding)
        if rule.per_profile:
            self._execute(rule_statement("profile_set", rule), binding)
        if rule.per_object and "applies" not in rule.sections and "lost_object" not in self._empty_tables:
            self._execute(invariant.insert_unknowns_of_lost_objects_sql(rule, partial, self._check_engagement), binding)
        if binding.no in self._rules_outside_conditions and _is_shipped(binding):
            return None
        if self._has_first_pass(binding):
            self._execute(invariant.first_pass_sql(rule, partial), binding)
            if self._has_doubts:
                self._execute(statement("judging/doubt_of_groups"), binding)
            left = f"SELECT coalesce(sum(n), 0)::BIGINT FROM _group WHERE rule_no = {binding.no} AND NOT clean"
            n_steps = self._count_rows(left)
            near = f"FROM _group JOIN _rule USING (rule_no) WHERE rule_no = {binding.no} AND clean AND is_near_miss(margin, near_margin)"
            if self.keep_measure_series and not self._may_skip_rest(self._count_rows(f"SELECT count(*) {near}")):
                self._execute(invariant.first_pass_measure_series_sql(rule), binding)
            return None if self._may_skip_rest(n_steps) else _StepSelectionAndCount("unsettled", n_steps)
        if "applies" in rule.sections or not self._is_short:
            n_steps = self._execute(invariant.steps_to_judge_sql(rule, partial, self._check_engagement), binding)
            return None if self._may_skip_rest(n_steps) else _StepSelectionAndCount("asked", -1)
        return _StepSelectionAndCount("all", -1)

    def _judge_at_references(self, binding: Binding) -> None:
        rule = binding.rule
        columns = rule.columns.get("reference") or self._columns_of_select(rule.sections["reference"], binding)
        own_object = "object_id" in columns
        if self._may_skip_rest(
            self._execute(reference_points.references_sql(rule, columns, self._skips_some_subjects(binding)), binding)
        ):
            return
        self._execute(reference_points.time_windows_sql(rule, own_object, self._check_engagement), binding)
        if (window_steps := reference_points.window_steps_sql(rule)) is not None:
            self._execute(window_steps, binding)
        if rule.per_profile:
            self._execute(rule_statement("profile_set", rule), binding)
        self._n_pending += self._execute(
            reference_points.judged_steps_sql(rule, own_object, self._check_engagement), binding
        )
        self._may_be_double = True

    def aggregate_pending_steps(self) -> None:
        """Aggregate the pending steps to outcomes, failing stretches, measure series and margins, for all pending rules at once."""
        kinds = {binding.rule.kind == "invariant" for binding in self._pending}
        if not self._may_skip_rest(self._n_pending):
            if self._may_be_double:
                self._run_statements("error_of_steps")
            if self._has_doubts:
                self._run_statements("doubt_of_short_time", "doubt_of_steps")
            if self._has_sensors:
                self._run_statements("error_of_measuring", "key_frames", "error_of_one_sample")
            if True in kinds:
                self._run_statements("outcome_of_episodes", *(["outcome_of_holes"] if self._has_holes else []))
        if False in kinds and not self._may_skip_rest(
            self._count_rows("SELECT count(*) FROM (FROM _occasion LIMIT 1)")
        ):
            self._run_statements("outcome_of_references")
        near = "FROM _outcome JOIN _rule USING (rule_no) WHERE verdict = 'pass' AND is_near_miss(margin, near_margin)"
        if self.keep_measure_series and not self._may_skip_rest(self._count_rows(f"SELECT count(*) {near}")):
            self._run_statements("course_of_near_misses")
        if not self._may_skip_rest(self._count_rows("SELECT count(*) FROM (FROM _judged WHERE NOT holds LIMIT 1)")):
            self._run_statements("stretch", *(["course_of_stretches"] if self.keep_measure_series else []))
        if self.margins:
            self._run_statements("margin_of_steps")
        self._forget_pending_steps()

    def _forget_pending_steps(self) -> None:
        """Forget the judged steps, and free their space: at once if there are many, else before the next rule."""
        are_many = self._n_pending > MOST_PENDING_ROWS
        self._pending, self._n_pending, self._may_be_double, self._has_old_steps = [], 0, False, True
        if are_many:
            self._create_tables_of_steps()

    def _create_tables_of_steps(self) -> None:
        self.con.execute(statement("judging/pending"))  # new tables: DuckDB does not free space of deleted rows
        self._has_old_steps = False

    def _may_skip_rest(self, n_rows: int) -> bool:
        return n_rows == 0

    def _run_statements(self, *names: str) -> int:
        """Run statements of `queries/judging` in this order; return the number of rows that the last one inserted."""
        n_rows = 0
        for name in names:
            n_rows = self._count_rows(statement(f"judging/{name}"))
        return n_rows

    def _execute(self, sql: str, binding: Binding) -> int:
        """Execute one statement with the values of its parameters; return the number of rows that it inserted."""
        parsed = self.con.extract_statements(sql)[0]
        row = self.con.execute(parsed, binding.values(parsed.named_parameters)).fetchone()
        return int(row[0]) if row else 0

    def _columns_of_select(self, sql: str, binding: Binding) -> list[str]:
        """Return the names of the columns of a rule's SELECT."""
        parsed = self.con.extract_statements(f"SELECT * FROM (\n{sql}\n) LIMIT 0")[0]
        described = self.con.execute(parsed, binding.values(parsed.named_parameters)).description or []
        return [str(column[0]) for column in described]

    def _count_rows(self, sql: str) -> int:
        row = self.con.execute(sql).fetchone()
        return int(row[0]) if row else 0

    def _record_error(self, binding: Binding, error: duckdb.Error, excess: Excess | None) -> None:
        """Record an error for this rule, for every drive and ego that it had to judge; raise the error if a retry may avoid it."""
        if excess is not None:
            self._insert_error_verdicts(binding, excess)
        elif isinstance(error, duckdb.OutOfMemoryException):
            if self.may_retry:
                raise error
            self._insert_error_verdicts(
                binding, "out_of_memory"
            )  # the database's message names block sizes that differ from run to run
        else:
            self._insert_error_verdicts(binding, "rule_error", f"rule {binding.rule.id}: {str(error).splitlines()[0]}")

    def _insert_error_verdicts(
        self, binding: Binding, code: str, detail: str | None = None, *, was_skipped: bool = False
    ) -> None:
        values = {"no": binding.no, "code": code, "told": detail, "again": was_skipped, "rule": binding.rule.id}
        self.con.execute(statement("judging/error_of_rule"), {**values, "limit_s": self.limits.allowed_cpu_s})


def _is_shipped(binding: Binding) -> bool:
    return binding.rule.path.is_relative_to(folder("queries"))


@dataclass
class PlanRecorder(Evaluation):
    """An evaluation that records the query plan of every statement, and runs all statements that a rule may need."""

    keep_measure_series: bool = True
    plans: list[str] = field(default_factory=list, init=False)

    def prepare(self) -> None:
        """Create the temporary tables, and enable the statements about holes and engagement, whatever the drives contain."""
        super().prepare()
        self._has_holes = self._check_engagement = True
        self._empty_tables, self._rules_outside_conditions = set(), set()

    def _may_skip_rest(self, n_rows: int) -> bool:  # noqa: ARG002 - the signature of the overridden method
        return False

    def _execute(self, sql: str, binding: Binding) -> int:
        parsed = self.con.extract_statements(f"EXPLAIN {sql}")[0]
        rows = self.con.execute(parsed, binding.values(parsed.named_parameters)).fetchall()
        self.plans += [str(plan) for _, plan in rows]
        return super()._execute(sql, binding)

    def _run_statements(self, *names: str) -> int:
        n_rows = 0
        for name in names:
            rows = self.con.execute(f"EXPLAIN {statement(f'judging/{name}')}").fetchall()
            self.plans += [str(plan) for _, plan in rows]
            n_rows = super()._run_statements(name)
        return n_rows
