"""A database with copies of one drive, where one rule is judged again and again: other numbers, the same facts."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import duckdb
import pyarrow as pa

from drivelint.arrays import with_columns
from drivelint.engine.derive import derive
from drivelint.engine.memory import Memory
from drivelint.evaluate import evaluate
from drivelint.sql import store
from drivelint.sql.derivations import derivations, needed

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.catalogue import Rule
    from drivelint.engine.batch import Drive
    from drivelint.explain.model import Row

_JUDGED: Final = ("verdict", "finding", "margin")
_READS_PROFILE: Final = re.compile(r"\b(?:FROM|JOIN)\s+profile\b", re.IGNORECASE)


class Judgement(NamedTuple):
    """The verdicts and judged steps of one judgement."""

    verdicts: list[Row]
    steps: list[Row]


class Sandbox:
    """One rule over some copies of a drive, which share one map, derived once in `con`.

    The shipped or user's `profiles` are the rows of the table `profile`. `memory` is the limit of the database in bytes
    (None: 80 % of the machine's), which is lifted where it does not do.
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
        self._memory = Memory(con, memory)
        self._insert("profile", profiles)
        self._fill(drives)
        self._derive()

    def _insert(self, table: str, rows: pa.Table) -> None:
        self._memory.run_job(lambda con: store.insert(con, table, rows))

    def _fill(self, drives: Sequence[Drive]) -> None:
        environment = drives[0].environment
        if environment is not None:
            for table, rows in environment.tables.items():
                self._insert(table, rows)
        store.lock(self.con)
        place = environment.environment_id if environment else None
        for table in drives[0].trace.tables:
            rows = pa.concat_tables([drive.trace.tables[table] for drive in drives])
            if table == "data_log":
                rows = with_columns(rows, {"environment_id": [place] * rows.num_rows})
            self._insert(table, rows)

    def _derive(self) -> None:
        try:
            for of_the_map in (True, False):
                derive(self.con, self._rule.reads, of_the_map=of_the_map)
        except duckdb.OutOfMemoryException:
            if not self._memory.lift_limit():
                raise
            store.recreate_empty(self.con, derivations())
            self._derive()

    def judge(self, params: Mapping[str, object]) -> Judgement:
        """Judge every copy by the rule with these parameters."""
        return self._memory.run_job(lambda _con: self._judged(params))

    def _judged(self, params: Mapping[str, object]) -> Judgement:
        for table in _JUDGED:
            self.con.execute(f"DELETE FROM {table}")
        given = {self._rule.id: params}
        evaluate(self.con, [self._rule], given, margins=True, may_retry=self._memory.limited)
        return Judgement(
            self.query("SELECT * FROM verdict ORDER BY drive_id, t_start_ns, occurrence, profile, object_id"),
            self.query("SELECT * FROM margin ORDER BY drive_id, t_ns, profile, object_id, ref_id"),
        )

    def set_profile(self, profile: str, column: str, value: float) -> None:
        """Give one number of a profile another value, and derive anew what follows from it."""
        self.con.execute(f"UPDATE profile SET {column} = ? WHERE profile = ?", [value, profile])
        stale: set[str] = set()
        for derivation in needed(self._rule.reads):
            # the profiles are given, not derived: `reads` does not name them
            if derivation.reads & stale or _READS_PROFILE.search(derivation.sql):
                stale.add(derivation.table)
                self.con.execute(f"DELETE FROM {derivation.table}")
                self._memory.execute(f"INSERT INTO {derivation.table} BY NAME {derivation.sql}")

    def query(self, sql: str, values: Sequence[Any] = ()) -> list[Row]:
        """Return the rows of a query as dictionaries."""
        return [dict(row) for row in self.con.execute(sql, list(values)).to_arrow_table().to_pylist()]
