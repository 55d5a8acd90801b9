"""Judges windows one after another in a database that stays open."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Self

import pyarrow.compute as pc

from drivelint import catalogue
from drivelint.arrays import replace_columns
from drivelint.engine.apart import judge_and_refuse_faulty
from drivelint.engine.batch import drive_with_map
from drivelint.engine.default_rules import selectors_of_run
from drivelint.engine.map_library import MapLibrary
from drivelint.engine.memory import MemoryLimit
from drivelint.engine.profiles import DEFAULT_PROFILES, load_profiles, profile_table
from drivelint.engine.robustness.copies import with_drive_id
from drivelint.engine.session import JudgingSession
from drivelint.errors import DriveLintError
from drivelint.evaluate.limits import RuleLimits
from drivelint.evaluate.sql_fragments import Binding
from drivelint.result import collect
from drivelint.sql import declarations, store
from drivelint.watch import contact
from drivelint.watch.contact import ContactFinder

if TYPE_CHECKING:
    from collections.abc import Sequence

    import duckdb
    import pyarrow as pa

    from drivelint.catalogue import Rule
    from drivelint.drive.trace import Trace
    from drivelint.engine.barrier import RefusedLog
    from drivelint.engine.batch import Drive
    from drivelint.result.text import Row
    from drivelint.watch.options import WatchOptions

PASSES_PER_RELEASE = 64
"""The number of calls of `judge` after which the database releases unused memory."""
_LASTING_TABLES = frozenset({"profile", "environment", "map_quality"})


@dataclass(frozen=True)
class JudgedWindow:
    """The result of a window: its first and last step, and rows of `finding`, `verdict` and `course`.

    `courses`: margins over time around findings and near misses; empty if they are not requested.
    """

    t_start_ns: int
    t_end_ns: int
    findings: pa.Table
    verdicts: pa.Table
    courses: pa.Table

    def rule_errors(self) -> list[tuple[str, str]]:
        """Return the rules that could not be run, and why."""
        rows = self.verdicts.filter(pc.equal(self.verdicts["verdict"], "error")).select(["rule_id", "reason"])
        return sorted({(row["rule_id"], row["reason"]) for row in rows.to_pylist()})

    def margins_since(self, t_ns: int | None) -> list[Row]:
        """Return the steps of the courses after `t_ns` (None: all steps) in time order, with columns of `margins.parquet`."""
        same = ("drive_id", "ego_id", "rule_id", "profile", "object_id")
        steps = ("t_ns", "observed", "required", "margin", "holds")
        rows = [
            {**{name: row[name] for name in same}, "ref_id": None, **dict(zip(steps, values, strict=True))}
            for row in self.courses.to_pylist()
            for values in zip(*(row[name] for name in steps), strict=True)
        ]
        return sorted((row for row in rows if t_ns is None or row["t_ns"] > t_ns), key=lambda row: row["t_ns"])


class WindowJudge:
    """Judges window after window in one database, in which only the map stays between windows.

    `rules`: rule id -> rule. Memory does not grow with the number of windows.
    Errors: `UsageError`, `RuleError`, `MapError` for wrong options, rules or maps, before the first window.
    """

    def __init__(self, options: WatchOptions) -> None:
        self._known = rules_by_id = catalogue.load_rules(options.rules_dirs)
        self._library = MapLibrary(options)
        self._library.read_user_map()
        selectors = selectors_of_run(options.rules, options.rules_dirs, options, self._library)
        rules = catalogue.select_rules(rules_by_id, selectors, options.ignore)
        self.rules: dict[str, Rule] = {rule.id: rule for rule in rules}
        self._params = params = catalogue.parse_params(rules, options.params)
        profiles = load_profiles(options.rules_dirs)
        self.gaps_ns = {
            rule.id: int(str(Binding(rule, 0, params.get(rule.id, {})).values(["_merge_ns"])["_merge_ns"]))
            for rule in rules
        }
        self.profiles = options.profiles or DEFAULT_PROFILES
        profile_names = profiles.keys() if options.advise else self.profiles
        self.style_by_profile = {name: profile.style for name, profile in profiles.items()}
        self._stack = ExitStack()
        self._con = self._stack.enter_context(store.temporary_database(options.memory, threads=1))
        store.insert(self._con, "profile", profile_table(profiles, sorted(profile_names)))
        self._memory = MemoryLimit(self._con, options.memory)
        # the session writes courses only if it has an observer
        observers = [_observe_nothing] if options.warn or options.serve else []
        limits = RuleLimits(options.rule_timeout, task="windows")
        self._session = JudgingSession(
            self._con, rules, params, None, memory=self._memory, observers=observers, limits=limits
        )
        self._n_passes = 0

    def contact_finder(self) -> ContactFinder | None:
        """Return an object that finds contacts in frames that are not judged yet; None: no rule on contacts is selected."""
        rule_ids = tuple(rule_id for rule_id in contact.CONTACT_RULES if rule_id in self.rules)
        if not rule_ids:
            return None
        # a cursor of its own, which a rule's time limit does not interrupt
        return ContactFinder(self._stack.enter_context(self._con.cursor()), self._known, rule_ids, self._params)

    def judge(self, traces: Sequence[Trace], drive_start_ns: int | None = None) -> list[JudgedWindow | DriveLintError]:
        """Judge windows together; return the result of each, or the error that prevents it. Raise only errors that concern all windows.

        `drive_start_ns`: the log's first step, from which seconds in reasons count; None: each window's first step.
        """
        store.recreate_empty(self._con, [t for t in declarations.tables_of_lifetime("run") if t not in _LASTING_TABLES])
        self._session.forget_judged_logs()
        outcomes: dict[str, JudgedWindow | DriveLintError] = {}
        drives: dict[str, Drive] = {}
        for no, trace in enumerate(traces):
            name = f"{no:06}"
            try:
                drive = drive_with_map(replace(trace, path=Path(name)), self._library)
            except DriveLintError as error:
                outcomes[name] = error
            else:
                drives[name] = replace(
                    drive, trace=_trace_with_drive_start(with_drive_id(drive.trace, name), drive_start_ns)
                )
        refusals: list[RefusedLog] = []
        if drives:
            judge_and_refuse_faulty(self._session, list(drives.values()), refusals)
        outcomes |= {refusal.path.name: refusal.error for refusal in refusals}
        tables = {
            "findings": collect.findings(self._con),
            "verdicts": collect.verdicts(self._con),
            "courses": self._con.execute("FROM course ORDER BY ALL").to_arrow_table(),
        }
        for name in drives:
            if name not in outcomes:
                log = traces[int(name)].tables["data_log"]
                tables_of_window = {key: rows.filter(pc.equal(rows["drive_id"], name)) for key, rows in tables.items()}
                outcomes[name] = JudgedWindow(
                    log["t_start_ns"][0].as_py(), log["t_end_ns"][0].as_py(), **tables_of_window
                )
        self._n_passes += 1
        if self._n_passes % PASSES_PER_RELEASE == 0:
            self._memory.release_unused_memory()
        return [outcomes[name] for name in sorted(outcomes)]

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self._stack.close()


def _trace_with_drive_start(trace: Trace, drive_start_ns: int | None) -> Trace:
    """Return a window whose seconds count from the log's first step."""
    if drive_start_ns is None:
        return trace
    log = replace_columns(trace.tables["data_log"], {"t_start_ns": [drive_start_ns]})
    return replace(trace, tables={**trace.tables, "data_log": log})


def _observe_nothing(con: duckdb.DuckDBPyConnection, _drives: object, /, **_part: bool) -> None:
    """Do nothing: the session writes courses if there is any observer."""
