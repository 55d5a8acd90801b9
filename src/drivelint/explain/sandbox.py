"""A database with copies of one drive, on which one rule is judged repeatedly with different parameters and profiles."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeVar

import duckdb
import msgspec
import pyarrow as pa

from drivelint.arrays import replace_columns
from drivelint.engine.batch import MAX_BATCH_STATES
from drivelint.engine.derive import derive
from drivelint.engine.memory import MemoryLimit
from drivelint.errors import UsageError
from drivelint.evaluate import evaluate
from drivelint.evaluate.sql_fragments import Binding
from drivelint.result.counts import group_rows
from drivelint.sql import store
from drivelint.sql.derivations import derivations, needed_derivations

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from drivelint.catalogue import Rule
    from drivelint.engine.batch import Drive
    from drivelint.explain.model import Row

_T = TypeVar("_T")
_RESULT_TABLES: Final = ("verdict", "finding", "margin")
_SQL_THAT_READS_PROFILE: Final = re.compile(r"\b(?:FROM|JOIN)\s+profile\b", re.IGNORECASE)


class Judgement(NamedTuple):
    """The verdicts and judged steps of one evaluation of the rule."""

    verdicts: list[Row]
    steps: list[Row]


class Sandbox:
    """One rule, and copies of a drive with one map, whose tables are derived once in `con`.

    `profiles`: the rows of the table `profile`. `memory`: the limit of the database in bytes (None: 80 % of the machine's memory), which
    is lifted if it is too low.
    """

    def __init__(
        self,
        rule: Rule,
        drives: Sequence[Drive],
        profiles: pa.Table,
        con: duckdb.DuckDBPyConnection,
        memory: int | None,
    ) -> None:
        self._rule = rule
        self.drive_id = drives[0].trace.drive_id
        self.con = con
        self._memory = MemoryLimit(con, memory)
        states = sum(drive.trace.tables["actor_state"].num_rows for drive in drives)
        self._at_once = max(1, MAX_BATCH_STATES // max(1, states))
        self._insert_rows("profile", profiles)
        self._insert_drives(drives)
        self._derive_tables()

    def _insert_rows(self, table: str, rows: pa.Table) -> None:
        self._memory.run_job(lambda con: store.insert(con, table, rows))

    def _insert_drives(self, drives: Sequence[Drive]) -> None:
        environment = drives[0].environment
        if environment is not None:
            for table, rows in environment.tables.items():
                self._insert_rows(table, rows)
        store.lock_down(self.con)
        place = environment.environment_id if environment else None
        for table in drives[0].trace.tables:
            rows = pa.concat_tables([drive.trace.tables[table] for drive in drives])
            if table == "data_log":
                rows = replace_columns(rows, {"environment_id": [place] * rows.num_rows})
            self._insert_rows(table, rows)

    def _derive_tables(self) -> None:
        try:
            for of_the_map in (True, False):
                derive(self.con, self._rule.reads, are_map_tables=of_the_map)
        except duckdb.OutOfMemoryException:
            if not self._memory.raise_to_machine_limit():
                raise
            store.recreate_empty(self.con, derivations())
            self._derive_tables()

    def judge(self, params: Mapping[str, object]) -> Judgement:
        """Judge every copy by the rule with these parameters."""
        return self._judge_settings_with_retry({self._rule.id: params})[self._rule.id]

    def judge_each(self, params_of_runs: Sequence[Mapping[str, object]]) -> list[Judgement | None]:
        """Judge by the rule with each of these settings of parameters; None for an invalid setting, such as a negative window.

        Several settings are judged in one evaluation, because starting and ending it takes as long as judging four rules.
        """
        valid = [no for no, params in enumerate(params_of_runs) if self._are_params_valid(params)]
        judgements: dict[str, Judgement] = {}
        for some in _batches(valid, self._at_once):
            judgements |= self._judge_settings_with_retry({f"{self._rule.id}~{no}": params_of_runs[no] for no in some})
        return [judgements.get(f"{self._rule.id}~{no}") for no in range(len(params_of_runs))]

    def _judge_settings_with_retry(self, params_by_name: Mapping[str, Mapping[str, object]]) -> dict[str, Judgement]:
        return self._memory.run_job(lambda _con: self._judge_settings_once(params_by_name))

    def _are_params_valid(self, params: Mapping[str, object]) -> bool:
        try:
            Binding(self._rule, 0, params)
        except UsageError:
            return False
        return True

    def judge_profiles(
        self, params: Mapping[str, object], profile: str, columns_and_values: Sequence[tuple[str, float]]
    ) -> list[Judgement]:
        """Judge by the rule with a changed profile for each (column, value): the profile with that value in that column."""
        return [
            judgement
            for some in _batches(columns_and_values, self._at_once)
            for judgement in self._judge_profiles_at_once(params, profile, some)
        ]

    def _judge_profiles_at_once(
        self, params: Mapping[str, object], profile: str, columns_and_values: Sequence[tuple[str, float]]
    ) -> list[Judgement]:
        names = [f"{profile}~{no}" for no in range(len(columns_and_values))]
        for name, (column, value) in zip(names, columns_and_values, strict=True):
            self.con.execute(
                f"INSERT INTO profile SELECT * REPLACE (? AS profile, ? AS {column}) FROM profile WHERE profile = ?",
                [name, value, profile],
            )
        try:
            self._derive_again_tables_that_read_profiles()
            judgement = self.judge(params)
        finally:
            self.con.execute("DELETE FROM profile WHERE list_contains(?, profile)", [names])
        verdicts, steps = (group_rows(rows, lambda row: row["profile"]) for rows in judgement)
        return [
            Judgement(*([{**row, "profile": profile} for row in rows.get(name, [])] for rows in (verdicts, steps)))
            for name in names
        ]

    def _judge_settings_once(self, params_by_name: Mapping[str, Mapping[str, object]]) -> dict[str, Judgement]:
        """Judge by the rule with each setting of parameters in `params_by_name`, and return the judgements by name."""
        for table in _RESULT_TABLES:
            self.con.execute(f"DELETE FROM {table}")
        rules = [msgspec.structs.replace(self._rule, id=name) for name in params_by_name]
        evaluate(self.con, rules, params_by_name, margins=True, may_retry=self._memory.limited)
        verdicts, steps = (
            group_rows(self.query(f"SELECT * FROM {table} ORDER BY drive_id, {order}"), lambda row: row["rule_id"])
            for table, order in (
                ("verdict", "t_start_ns, occurrence, profile, object_id"),
                ("margin", "t_ns, profile, object_id, ref_id"),
            )
        )
        return {name: Judgement(verdicts.get(name, []), steps.get(name, [])) for name in params_by_name}

    def _derive_again_tables_that_read_profiles(self) -> None:
        """Derive again the tables that read the profiles, directly or through other tables."""
        stale: set[str] = set()
        for derivation in needed_derivations(self._rule.reads):
            # `reads` does not contain the table of profiles, which is not derived
            if derivation.reads & stale or _SQL_THAT_READS_PROFILE.search(derivation.sql):
                stale.add(derivation.table)
                self.con.execute(f"DELETE FROM {derivation.table}")
                self._memory.execute(f"INSERT INTO {derivation.table} BY NAME {derivation.sql}")

    def query(self, sql: str, values: Sequence[Any] | Mapping[str, Any] = ()) -> list[Row]:
        """Return the rows of a query as dictionaries."""
        return [dict(row) for row in self.con.execute(sql, values).to_arrow_table().to_pylist()]


def _batches(items: Sequence[_T], size: int) -> Iterator[Sequence[_T]]:
    for start in range(0, len(items), size):
        yield items[start : start + size]
