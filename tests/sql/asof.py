"""ASOF joins of a statement, guarded: the statement fails where the right side is not unique by the columns of the condition."""

from __future__ import annotations

import re
from typing import Any, Final, NamedTuple, Self

import duckdb

_COMMENTS: Final = re.compile(r"--[^\n]*")
_JOIN: Final = re.compile(r"\bASOF\s+(?:LEFT\s+)?JOIN\s+", re.IGNORECASE)
_NAME: Final = re.compile(r"\s*(\w+)")
_ON: Final = re.compile(r"\s+ON\s+", re.IGNORECASE)
_ALIAS: Final = re.compile(r"\s*(?:AS\s+)?(\w+)\s+ON\s+", re.IGNORECASE)
_END: Final = re.compile(
    r"[()]|\b(?:ASOF|LEFT|RIGHT|FULL|INNER|SEMI|ANTI|CROSS|JOIN|WHERE|GROUP|ORDER|QUALIFY|UNION|WINDOW|LIMIT)\b|;",
    re.IGNORECASE,
)


class Join(NamedTuple):
    """An ASOF join: its right side with the place of its text (first, end), and the columns of that side in the condition."""

    right: str
    first: int
    end: int
    columns: tuple[str, ...]

    @property
    def name(self) -> str:
        """Return what tells the join from others: right side and columns."""
        return f"{' '.join(self.right.split())} BY {', '.join(self.columns)}"


def joins(sql: str) -> list[Join]:
    """Return the ASOF joins of a statement without comments. Errors: `ValueError` for one that is written in another way."""
    found = []
    for start in _JOIN.finditer(sql):
        first = start.end()
        end = _closing(sql, first) if sql[first] == "(" else first + len(_NAME.match(sql[first:])[0])  # type: ignore[index]
        if (named := _ON.match(sql, end)) is not None:
            alias, begin = sql[first:end], named.end()
        elif (named := _ALIAS.match(sql, end)) is not None:
            alias, begin = named[1], named.end()
        else:
            raise ValueError(f"an ASOF join without alias and ON: {sql[start.start() : end + 60]}")
        condition = sql[begin : _end(sql, begin)]
        columns = dict.fromkeys(re.findall(rf"\b{alias}\.(\w+)", condition))
        found.append(Join(sql[first:end], first, end, tuple(columns)))
    return found


def without_comments(sql: str) -> str:
    """Return a statement without its comments."""
    return _COMMENTS.sub("", sql)


def guarded(sql: str, sequences: dict[str, str]) -> str:
    """Return the statement with right sides that raise an error at rows with equal columns, and count their rows.

    `sequences` (name of a join -> sequence) names the counters; NULL equals nothing, so such rows meet no row of the left side.
    """
    text = without_comments(sql)
    for join in reversed(joins(text)):
        keys = ", ".join(join.columns)
        unknown = " OR ".join(f"{column} IS NULL" for column in join.columns)
        side = f"(SELECT * FROM {guarded(join.right, sequences)} QUALIFY CASE WHEN {unknown} THEN true"
        side += f" WHEN nextval('{sequences[join.name]}') > 0 AND count(*) OVER (PARTITION BY {keys}) = 1 THEN true"
        alias = (
            f" AS {join.right}" if join.right.isidentifier() and text[join.end :].lstrip()[:3].upper() == "ON " else ""
        )
        side += f" ELSE error('rows with equal {join.name.replace(chr(39), chr(34))}')::BOOLEAN END){alias}"
        text = text[: join.first] + side + text[join.end :]
    return text


class Guarded:
    """A connection that runs the ASOF joins of every statement with guarded right sides."""

    def __init__(self, con: duckdb.DuckDBPyConnection, sequences: dict[str, str]) -> None:
        self._con = con
        self._sequences = sequences

    def execute(self, query: Any, parameters: Any = None) -> duckdb.DuckDBPyConnection:
        """Run a statement as DuckDB's `execute` does."""
        text = query if isinstance(query, str) else query.query
        if not _JOIN.search(without_comments(text)):
            return self._con.execute(query, parameters)
        for join in joins(without_comments(text)):
            if join.name not in self._sequences:
                self._sequences[join.name] = f"asof_{len(self._sequences)}"
                self._con.execute(f"CREATE SEQUENCE {self._sequences[join.name]}")
        return self._con.execute(guarded(text, self._sequences), parameters)

    def cursor(self) -> Guarded:
        """Return another connection to the same database."""
        return Guarded(self._con.cursor(), self._sequences)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._con.close()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._con, name)


def _closing(sql: str, first: int) -> int:
    """Return where the parenthesis at `first` is closed."""
    depth = 0
    for mark in re.finditer(r"[()]", sql[first:]):
        depth += 1 if mark[0] == "(" else -1
        if depth == 0:
            return first + mark.end()
    raise ValueError(f"a parenthesis is not closed: {sql[first : first + 60]}")


def _end(sql: str, first: int) -> int:
    """Return where a condition that begins at `first` ends: at the next clause, or where the subquery is closed."""
    depth = 0
    for mark in _END.finditer(sql, first):
        if mark[0] == "(":
            depth += 1
        elif mark[0] == ")":
            depth -= 1
            if depth < 0:
                return mark.start()
        elif depth == 0:
            return mark.start()
    return len(sql)
