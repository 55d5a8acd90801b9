"""Scenes of the tests of a few files, derived and judged together: a small scene takes its time in planning the statements, not in rows.

A test asks for its scenes one after the other: `derived(...)`, `judged(...)`. `answer_together` runs each of these tests until it
asks for something new, stops it there, answers all such questions in one database, and does so again until no test asks. When pytest
then runs a test, each of its questions has an answer. A question without one (the test was left out, or asks for other than before)
is answered by a database of its own, as everywhere else.
"""

from __future__ import annotations

from collections import defaultdict
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cache
from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeAlias

import pyarrow as pa
import pytest

from drivelint.sql import declarations, store, syntax

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    import duckdb

    from drivelint.engine.batch import Drive
    from drivelint.road.map_reader import MapTables

FILES: Final = 23
"""Files of a folder whose scenes are answered together."""
LEAST_TESTS: Final = 8
MOST_ROUNDS: Final = 5
"""Fewer tests than these, or the questions of a test after so many, are not answered together: a database costs time and memory."""
Row: TypeAlias = "dict[str, Any]"


class Question(NamedTuple):
    """What a test asks for: the derived tables of some drives, or the verdicts of one batch of them."""

    drives: tuple[Drive, ...]
    tables: frozenset[str] = frozenset()
    rules: tuple[str, ...] | None = None
    profiles: tuple[str, ...] = ()
    order: str = ""

    def same_as(self, other: Question) -> bool:
        """Whether both ask for the same, row by row."""
        return (
            self[1:] == other[1:]
            and len(self.drives) == len(other.drives)
            and all(_is_same(a, b) for a, b in zip(self.drives, other.drives, strict=True))
        )


class _AskedError(BaseException):
    """Ends the run of a test that asks for something new; no `except Exception` of the test may hold it up."""

    def __init__(self, question: Question) -> None:
        super().__init__()
        self.question = question


@dataclass(frozen=True)
class SceneTables:
    """The tables of one question in a database of many: a query sees the rows of its drives, under their own names."""

    con: duckdb.DuckDBPyConnection
    prefix: str
    environments: tuple[str, ...]

    def execute(self, sql: str, params: Sequence[object] | Mapping[str, object] | None = None) -> Any:
        """Run a SELECT on the rows of these drives."""
        return self.con.execute(self._restricted(sql), params)

    def _restricted(self, sql: str) -> str:
        ctes = []
        for table in sorted(_tables(sql)):
            columns = declarations.column_comments()[table]
            own = [column for column in ("drive_id", "environment_id") if column in columns]
            if not own:
                continue
            names = ", ".join(f"substr({column}::VARCHAR, {len(self.prefix) + 1}) AS {column}" for column in own)
            ids = ", ".join(f"'{each}'" for each in self.environments) or "NULL"
            of_drives, of_maps = f"starts_with(drive_id::VARCHAR, '{self.prefix}')", f"environment_id IN ({ids})"
            where = of_drives if "drive_id" in own else of_maps
            ctes.append(f"{table} AS (SELECT * REPLACE ({names}) FROM main.{table} WHERE {where})")
        if not ctes:
            return sql
        head = ", ".join(ctes)
        text = sql.lstrip()
        return f"WITH {head}, {text[4:]}" if text[:5].upper() == "WITH " else f"WITH {head} {text}"


@dataclass
class Answers:
    """What the tests `of` these names asked for, by test and number of the question, and which test is running."""

    questions: dict[tuple[str, int], Question] = field(default_factory=dict)
    found: dict[tuple[str, int], Any] = field(default_factory=dict)
    test: str | None = None
    asked: int = 0
    is_rehearsal: bool = False
    of: frozenset[str] = frozenset()

    def forget(self) -> None:
        """Close the databases of the answers."""
        self.of = frozenset()
        self.questions.clear()
        self.found.clear()

    def answer(self, question: Question) -> Any:
        """Return the answer to the next question of the running test; None: there is none."""
        if self.test is None:
            return None
        key = self.test, self.asked
        self.asked += 1
        if key in self.found and question.same_as(self.questions[key]):
            return self.found[key]
        if self.is_rehearsal:
            raise _AskedError(question)
        return None

    @contextmanager
    def running(self, test: str, *, is_rehearsal: bool = False) -> Iterator[None]:
        """Take the questions inside for those of this test."""
        self.test, self.asked, self.is_rehearsal = test, 0, is_rehearsal
        try:
            yield
        finally:
            self.test = None


answers: Final = Answers()
"""The answers for the files whose tests run now."""


def answer_together(items: Sequence[pytest.Item]) -> None:
    """Answer what these tests ask for, all of them at once, unless that was done; a test with fixtures is left out."""
    names = frozenset(item.nodeid for item in items)
    if names == answers.of:
        return
    answers.forget()
    answers.of = names
    waiting = [item for item in items if _is_plain(item)]
    for _ in range(MOST_ROUNDS):
        asked = {}
        for item in waiting:
            if (question := _rehearse(item)) is not None:
                asked[item] = question
        if len(asked) < LEAST_TESTS:
            return
        keys = {(item.nodeid, _asked_so_far(item)): question for item, question in asked.items()}
        answers.questions.update(keys)
        answers.found.update(_answer(keys))
        waiting = list(asked)


def chunk(path: Path) -> str:
    """Return the name of the files whose scenes are answered together: a few of a folder's, next to each other."""
    files = _files(path.parent)
    return f"{path.parent.name} {files.index(path.name) // FILES}"


@cache
def _files(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.glob("test_*.py"))


def _is_plain(item: pytest.Item) -> bool:
    if not isinstance(item, pytest.Function) or hasattr(item.obj, "hypothesis"):
        return False
    given = set(item.callspec.params) if hasattr(item, "callspec") else set()
    return set(item.fixturenames) - given <= {"_answered", "_answered_together", "request"}


def _asked_so_far(item: pytest.Item) -> int:
    return sum(test == item.nodeid for test, _ in answers.questions)


def _rehearse(item: pytest.Item) -> Question | None:
    """Run a test up to its first question without an answer. None: it has none, or fails before; pytest's run says how."""
    assert isinstance(item, pytest.Function)
    params = item.callspec.params if hasattr(item, "callspec") else {}
    try:
        with answers.running(item.nodeid, is_rehearsal=True):
            item.obj(**params)
    except _AskedError as asked:
        return asked.question
    except (Exception, pytest.fail.Exception, pytest.skip.Exception):  # noqa: BLE001
        return None
    return None


def _answer(questions: Mapping[tuple[str, int], Question]) -> dict[tuple[str, int], Any]:
    from tests import scenes

    groups: dict[Any, list[tuple[str, int]]] = defaultdict(list)
    for key, question in questions.items():
        groups[question.rules is None, question.profiles].append(key)
    found: dict[tuple[str, int], Any] = {}
    for (only_derived, profiles), keys in sorted(groups.items()):
        maps: dict[int, MapTables] = {}
        renamed = {key: _renamed(questions[key].drives, f"q{n:04}.", maps) for n, key in enumerate(keys)}
        drives = [drive for each in renamed.values() for drive in each]
        con = store.connect(threads=1)
        if only_derived:
            tables = [questions[key].tables for key in keys]
            scenes.derived(*drives, tables=frozenset().union(*tables) if all(tables) else (), con=con)  # (): all
            for n, key in enumerate(keys):
                ids = {d.environment.environment_id for d in renamed[key] if d.environment}
                found[key] = SceneTables(con, f"q{n:04}.", tuple(sorted(ids)))
            continue
        asked = {key: scenes.rule_ids(questions[key].rules or ()) for key in keys}
        scenes.judged(drives, rules=sorted(set().union(*asked.values())), profiles=profiles, con=con)
        for n, key in enumerate(keys):
            mine = SceneTables(con, f"q{n:04}.", ())
            rules = ", ".join(store.quoted(rule) for rule in asked[key])
            query = f"SELECT * FROM verdict WHERE rule_id IN ({rules}) ORDER BY {questions[key].order}"
            found[key] = scenes.rows(mine, query)
        con.close()
    return found


def _renamed(drives: Sequence[Drive], prefix: str, maps: dict[int, MapTables]) -> list[Drive]:
    """Return the drives with the prefix before their ids, on maps with ids of their own: tests alter maps and leave their ids.

    `maps`: the id of a map's object -> that map under its new id.
    """
    found = []
    for drive in drives:
        tables = {name: _with_prefix(table, "drive_id", prefix) for name, table in drive.trace.tables.items()}
        trace = replace(drive.trace, drive_id=prefix + drive.trace.drive_id, tables=tables)
        road = drive.environment
        if road is not None and id(road) not in maps:
            mark = f"m{len(maps):04}."
            own = {name: _with_prefix(table, "environment_id", mark) for name, table in road.tables.items()}
            maps[id(road)] = replace(road, environment_id=mark + road.environment_id, tables=own)
        found.append(replace(drive, trace=trace, environment=maps[id(road)] if road is not None else None))
    return found


def _with_prefix(table: pa.Table, column: str, prefix: str) -> pa.Table:
    at = table.schema.get_field_index(column)
    ids = pa.array([prefix + each for each in table[column].to_pylist()], table.schema.field(at).type)
    return table.set_column(at, table.schema.field(at), ids)


def _is_same(one: Drive, other: Drive) -> bool:
    """NaN of one is not that of the other: such a scene is derived once more."""
    return (
        one.trace.drive_id == other.trace.drive_id
        and one.environment is other.environment
        and one.trace.tables.keys() == other.trace.tables.keys()
        and all(table.equals(other.trace.tables[name]) for name, table in one.trace.tables.items())
    )


@cache
def _tables(sql: str) -> frozenset[str]:
    return frozenset(
        syntax.tables_read(syntax.parse_select(sql, "a test's query")) & declarations.column_comments().keys()
    )
