"""Judges drives batch by batch: fills tables, derives further ones, evaluates the rules, and clears the tables."""

from __future__ import annotations

from contextlib import ExitStack, nullcontext
from typing import TYPE_CHECKING, Protocol

import duckdb
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.arrays import replace_columns
from drivelint.engine.batch import MAX_BATCH_STATES, egos_to_skip_by_part, have_few_states, have_many_states
from drivelint.engine.derive import derive
from drivelint.engine.earth import set_longitude_and_latitude
from drivelint.engine.interruption import InterruptedRunError, Interruption
from drivelint.engine.margins import MarginFile
from drivelint.engine.memory import MemoryLimit
from drivelint.engine.robustness.judging import RobustnessJudge
from drivelint.engine.set_aside import move_large_tables_to_disk
from drivelint.errors import RuleError
from drivelint.evaluate import evaluate
from drivelint.evaluate.limits import RuleLimits
from drivelint.sql import declarations, store
from drivelint.sql.derivations import (
    TABLES_NEEDED_FOR_DRIVES,
    TABLES_NEEDED_FOR_RULES,
    TABLES_NEEDED_FOR_RULES_ABOUT_OTHERS,
    derived_tables,
    needed_derivations,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence
    from pathlib import Path

    from drivelint.catalogue import Rule
    from drivelint.engine.batch import Drive
    from drivelint.engine.robustness.copies import MeasurementErrors


class BatchObserver(Protocol):
    """A function that is called after each batch, while its tables still have their rows."""

    def __call__(self, con: duckdb.DuckDBPyConnection, drives: Sequence[Drive], /, *, first: bool, last: bool) -> None:
        """Process a batch, or the egos of a part of one drive; `first` and `last`: whether it is the first or the last part."""
        ...


class JudgingSession:
    """Judges batches of drives in one database, which it locks. Between batches, the database contains only results and a few states.

    A drive of many egos is judged in parts, so that its tables stay small. Call `judge_copies` after the last batch.
    `out`: the folder of `margins_file` and the kept database. `observers`: called after each part, while its tables have their rows.
    `memory`: limits the size of parts and of the database (default: no limit). `interruption`: can abort a batch.
    `errors`: of the copies that show how robust findings are; None: no copies. `copies_of_all`: copies for all critical and major
    findings, else for the worst ones.
    `limits`: of each rule on a batch of drives; `limits_of_copies`: on a batch of copies (default: those of `RuleLimits`).
    """

    def __init__(
        self,
        con: duckdb.DuckDBPyConnection,
        rules: Sequence[Rule],
        params: Mapping[str, Mapping[str, object]],
        out: Path | None,
        *,
        margins: bool = False,
        keep_db: bool = False,
        observers: Sequence[BatchObserver] = (),
        memory: MemoryLimit | None = None,
        interruption: Interruption | None = None,
        errors: MeasurementErrors | None = None,
        copies_of_all: bool = False,
        limits: RuleLimits | None = None,
        limits_of_copies: RuleLimits | None = None,
    ) -> None:
        self._con = con
        self._rules = rules
        self._params = params
        self._observers = observers
        self._tables = {table for rule in rules for table in rule.reads}
        self._also: tuple[str, ...] = TABLES_NEEDED_FOR_DRIVES
        if rules:
            self._also = (
                TABLES_NEEDED_FOR_RULES_ABOUT_OTHERS
                if any(rule.looks_at_others for rule in rules)
                else TABLES_NEEDED_FOR_RULES
            )
        self._memory = memory or MemoryLimit(con, None)
        self._interruption = interruption or Interruption()
        self._limits = limits or RuleLimits()
        self._limits.memory = self._memory.most_growth_bytes
        self._limits_of_copies = limits_of_copies or RuleLimits()
        self._robustness = None
        if errors:
            self._robustness = RobustnessJudge(
                con,
                rules,
                params,
                errors=errors,
                memory=self._memory,
                load=self._load_drives,
                forget=self._delete_except_in_kept_database,
                limits=self._limits_of_copies,
                is_stopped=self._interruption.forbids_new_copies,
                of_all=copies_of_all,
            )
        self._seen: set[str] = set()
        self._has_derived_tables = bool(store.id_types(con))  # an earlier session filled them
        self._maps: frozenset[str] = frozenset()
        self._kept_maps: set[str] = set()
        self._margins = MarginFile(out / ".margins.parquet") if margins and out else None
        self._kept = out / "drivelint.duckdb" if keep_db and out else None
        if self._kept:
            self._attach_kept_database(self._kept)
        store.lock_down(con)  # from here on, rules of other authors may run in the database

    @property
    def margins_file(self) -> Path | None:
        """The path of the margins file; None: margins were not requested."""
        return None if self._margins is None else self._margins.path

    @property
    def judged_drive_ids(self) -> frozenset[str]:
        """The ids of the drives that were judged."""
        return frozenset(self._seen)

    def has_judged(self, drive: Drive) -> bool:
        """Return whether this log was judged before, by its drive id."""
        return drive.trace.drive_id in self._seen

    def forget_judged_logs(self) -> None:
        """Clear the list of judged logs, so that they can be judged again. The caller must first delete their results."""
        self._seen.clear()
        for limits in (self._limits, self._limits_of_copies):
            limits.forget_excesses()  # limits must not depend on which logs this worker happened to judge before

    def judge(self, drives: Sequence[Drive]) -> None:
        """Judge a batch of drives; if it fails, its rows are deleted.

        Errors: `InterruptedRunError`; `duckdb.OutOfMemoryException` if memory is short for several drives, or for a single drive even with
        one ego at a time and all memory of the machine.
        """
        if not drives:
            return
        is_complete = False
        self._limits.batches = sum(drive.size_in_states_or_pairs for drive in drives) / MAX_BATCH_STATES
        while not is_complete:
            try:
                one_core = store.one_thread(self._con) if have_few_states(drives) else nullcontext()
                with one_core, store.uniform_memory_errors(), self._interruption.interruptible(self._con):
                    is_complete = self._judge_if_memory_suffices(drives)
            except InterruptedRunError:
                self._delete_drives(
                    [drive.trace.drive_id for drive in drives]
                )  # `_judge_if_memory_suffices`'s deletion may be incomplete
                raise
            except duckdb.OutOfMemoryException:
                # data of a single ego that cannot be spilled to disk may use all memory of the machine
                if len(drives) > 1 or not self._memory.raise_to_machine_limit():
                    raise
        ids = [drive.trace.drive_id for drive in drives]
        with ExitStack() as undo:
            undo.callback(self._delete_drives, ids)
            if self._margins:
                self._margins.add(self._con, self._memory)
            if self._robustness:
                self._robustness.add(drives)
            undo.pop_all()
        self._seen.update(ids)
        if not have_few_states(drives):  # few states need little memory, and the next batch recreates the tables anyway
            store.recreate_empty(self._con, self._tables_to_fill("drive", "part"))

    @property
    def n_waiting_drives(self) -> int:
        """The number of drives whose copies are not judged yet."""
        return self._robustness.n_waiting_drives if self._robustness else 0

    def n_findings_to_copy_first(self) -> int:
        """Return the number of findings for which copies are judged first."""
        return self._robustness.n_findings_to_copy_first() if self._robustness else 0

    def judge_copies(self, advance: Callable[[int], None] | None = None) -> None:
        """Judge the waiting copies of several batches together; after an interruption, only for a limited time.

        `advance` is called with the number of findings that are newly settled.
        """
        if self._robustness:
            self._robustness.judge(advance)

    def _judge_if_memory_suffices(self, drives: Sequence[Drive]) -> bool:
        """Judge a batch. Return False if a part with several egos ran out of memory: the next try has smaller parts."""
        ids = [drive.trace.drive_id for drive in drives]
        on_earth = [drive.trace.drive_id for drive in drives if drive.geo]
        with ExitStack() as undo:
            undo.callback(self._delete_drives, ids)
            self._load_drives(drives)
            set_longitude_and_latitude(self._con, on_earth, "data_log")
            todo = egos_to_skip_by_part(drives, self._memory.pairs_per_part)
            for no, deferred in enumerate(todo):
                if no:
                    store.recreate_empty(self._con, self._tables_to_fill("part"))
                if deferred:
                    egos = pa.table({"drive_id": ids * len(deferred), "ego_id": deferred})
                    store.insert(self._con, "deferred_ego", egos)
                pairs_by_ego = {ego: n for ego, n in drives[0].pairs_by_ego.items() if ego not in set(deferred)}
                cuttable = len(drives) == 1 and len(pairs_by_ego) > 1
                try:
                    may_retry = len(drives) > 1 or cuttable or self._memory.limited
                    with store.uniform_memory_errors():
                        self._judge_part(
                            ids,
                            may_retry=may_retry,
                            release=self._memory.release_unused_memory if have_many_states(drives) else None,
                        )
                        set_longitude_and_latitude(self._con, on_earth, "finding")
                        for observer in self._observers:
                            observer(self._con, drives, first=no == 0, last=no + 1 == len(todo))
                except duckdb.OutOfMemoryException:
                    if not cuttable:
                        raise
                    self._memory.halve_parts(sum(pairs_by_ego.values()))
                    return False
                # the kept database contains every ego, so `deferred_ego` is not copied
                self._append_to_kept_database(
                    (t for t in declarations.tables_of_lifetime("part") if t != "deferred_ego"), has_shared_rows=no > 0
                )
            self._append_to_kept_database(declarations.tables_of_lifetime("drive"))
            undo.pop_all()
        return True

    def _judge_part(self, ids: Sequence[str], *, may_retry: bool, release: Callable[[], None] | None) -> None:
        """Judge the egos of the current part."""
        derive(self._con, self._tables, are_map_tables=False, always_needed_tables=self._also)
        margins, series = self._margins is not None, bool(self._observers)
        evaluate(
            self._con,
            self._rules,
            self._params,
            margins=margins,
            keep_measure_series=series,
            may_retry=may_retry,
            limits=self._limits,
            release=release,
        )
        # the caller then judges each drive alone, so that only the faulty drive is affected
        erred = "SELECT rule_id FROM verdict WHERE verdict = 'error' AND list_contains(?, drive_id) ORDER BY rule_id LIMIT 1"
        if len(ids) > 1 and (row := self._con.execute(erred, [list(ids)]).fetchone()):
            raise RuleError(f"{row[0]} failed on a batch of {len(ids)} drives")

    def close(self) -> None:
        """Finish the margins file and the kept database."""
        if self._margins:
            self._margins.close()
        if self._kept:
            self._append_to_kept_database(declarations.tables_of_lifetime("run"))
            self._con.execute("DETACH kept")
            self._kept = None

    def _load_drives(self, drives: Sequence[Drive]) -> None:
        environments = {d.environment.environment_id: d.environment for d in drives if d.environment}
        if not environments.keys() <= self._maps:
            self._maps = frozenset()  # until the new maps are complete: a failure here must not leave half a map
            # an earlier session may have left its map in the database
            for table in sorted(set(declarations.tables_of_lifetime("map")) - store.tables_without_rows(self._con)):
                self._con.execute(f"DELETE FROM {table}")
            for id_, environment in sorted(environments.items()):
                is_loaded = self._con.execute("FROM environment WHERE environment_id = ?", [id_]).fetchone() is not None
                for table, rows in environment.tables.items():
                    if not (is_loaded and declarations.lifetimes()[table] == "run"):
                        store.insert(self._con, table, rows)
            derive(self._con, self._tables, are_map_tables=True, always_needed_tables=self._also)
            self._maps = frozenset(environments)
            self._append_maps_to_kept(environments.keys() - self._kept_maps)
        tables = self._tables_to_fill("drive", "part")
        if not self._has_derived_tables:  # they are created when they are filled
            tables = [table for table in tables if table not in derived_tables()]
        self._has_derived_tables = True
        store.recreate_with_enums(self._con, tables, _drive_ids(drives), _actor_ids(drives))
        for table in drives[0].trace.tables:
            rows = pa.concat_tables(
                [_log_rows_with_map(d) if table == "data_log" else d.trace.tables[table] for d in drives]
            )
            store.insert(self._con, table, rows)
        del rows
        for drive in drives:
            move_large_tables_to_disk(self._con, drive.trace)

    def _tables_to_fill(self, *lifetimes: str) -> list[str]:
        """Return the tables of these lifetimes that get rows: those of a log, and the derived tables that the rules need."""
        unneeded = derived_tables() - {derivation.table for derivation in needed_derivations(self._tables, self._also)}
        return [table for table in declarations.tables_of_lifetime(*lifetimes) if table not in unneeded]

    def _attach_kept_database(self, path: Path) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.unlink(missing_ok=True)
        with store.connect(path):
            pass
        self._con.execute("RESET GLOBAL checkpoint_threshold")  # else the WAL would grow as large as the database
        self._con.execute(f"ATTACH {store.quoted(path)} AS kept")

    def _append_to_kept_database(self, tables: Iterable[str], *, has_shared_rows: bool = False) -> None:
        """Append tables to the kept database; `has_shared_rows`: it already contains the rows that all parts of a drive have in common."""
        if not self._kept:
            return
        for table in tables:
            whole = has_shared_rows and ("ego_id" not in declarations.column_comments()[table] or table == "_ego_clock")
            except_kept = f" EXCEPT FROM kept.{table}" if whole else ""
            self._memory.execute(f"INSERT INTO kept.{table} SELECT * FROM {table}{except_kept}")

    def _append_maps_to_kept(self, ids: Iterable[str]) -> None:
        new = sorted(ids)
        if self._kept and new:
            for table in declarations.tables_of_lifetime("map"):
                self._con.execute(
                    f"INSERT INTO kept.{table} SELECT * FROM {table} WHERE list_contains(?, environment_id)", [new]
                )
            self._kept_maps.update(new)

    def _delete_drives(self, ids: Sequence[str]) -> None:
        self._delete_except_in_kept_database(ids)
        for table in (
            declarations.tables_of_lifetime("drive", "part") if self._kept else ()
        ):  # some parts may have been copied
            self._con.execute(f"DELETE FROM kept.{table} WHERE list_contains(?, drive_id)", [list(ids)])

    def _delete_except_in_kept_database(self, ids: Sequence[str]) -> None:
        """Delete the rows of these drives from the database, but not from the kept database, which never contains copies."""
        store.recreate_empty(self._con, self._tables_to_fill("drive", "part"))
        for table in declarations.tables_of_lifetime("run"):
            if "drive_id" in declarations.column_comments()[table]:
                self._con.execute(f"DELETE FROM {table} WHERE list_contains(?, drive_id)", [list(ids)])


def _log_rows_with_map(drive: Drive) -> pa.Table:
    log, geo = drive.trace.tables["data_log"], drive.geo
    place = drive.environment.environment_id if drive.environment else None
    columns: dict[str, str | float | None] = {"environment_id": place}
    if geo:
        columns |= {"geo_reference": geo.reference, "geo_x_m": geo.x_m, "geo_y_m": geo.y_m, "geo_yaw_rad": geo.yaw_rad}
    return replace_columns(log, {name: [value] * log.num_rows for name, value in columns.items()})


def _drive_ids(drives: Iterable[Drive]) -> list[str]:
    return [drive_id for drive in drives for drive_id in drive.trace.tables["data_log"]["drive_id"].to_pylist()]


def _actor_ids(drives: Iterable[Drive]) -> set[str]:
    names = set(declarations.tables_of_lifetime("drive", "part"))
    tables = [d.trace.tables[name] for d in drives for name in d.trace.tables if name in names]
    columns = [table.column(c) for table in tables for c in table.column_names if c in store.ACTOR_ID_COLUMNS]
    return {actor_id for column in columns for actor_id in pc.unique(column).to_pylist() if actor_id is not None}
