"""The declarations of all tables: columns, types, comments and lifetimes, from `schemas/*.sql` and `queries/library`."""

from __future__ import annotations

import re
from functools import cache

from drivelint.errors import DriveLintError
from drivelint.resources import folder
from drivelint.sql import words
from drivelint.sql.library import TABLE_LIFETIMES, library_tables

_TABLE = re.compile(r"^CREATE TABLE (\w+) \(\n(.*?)^\);", re.DOTALL | re.MULTILINE)
_LIFETIME = re.compile(r"^-- lifetime: (\w+)\nCREATE TABLE (\w+) \(", re.MULTILINE)
_COLUMN = re.compile(r"^    (\w+) (.*?),?\s*-- (.+)$", re.MULTILINE)
_QUANTITIES = re.compile(r"\{([a-z, ]+)\}$")
"""Matches the end of a column's comment: the quantities, of the ego or another actor, from which the column is computed."""


@cache
def create_statements(file: str = "*") -> str:
    """Return the CREATE statements of `schemas/<file>.sql`, or, for `library/<topic>`, of a topic of the library; `*`: all."""
    topic = file.removeprefix("library/") if file.startswith("library/") else None
    declared = [
        path.read_text(encoding="utf-8") for path in sorted(folder("schemas").glob(f"{file}.sql")) if topic is None
    ]
    if topic is not None or file == "*":
        declared += [table.declaration for table in library_tables().values() if topic in (None, table.topic)]
    return "\n".join(declared)


@cache
def column_lists() -> dict[str, str]:
    """Return table -> the text between the brackets of its CREATE TABLE."""
    return dict(_TABLE.findall(create_statements()))


@cache
def column_comments(file: str = "*") -> dict[str, dict[str, str]]:
    """Return table -> column -> comment for every table of `schemas/<file>.sql` or `library/<topic>` (`*`: of all), in file order."""
    return {
        table: {column: words.readable_comment(_QUANTITIES.sub("", comment).rstrip()) for column, _, comment in columns}
        for table, columns in _column_declarations(file).items()
    }


@cache
def _column_declarations(file: str = "*") -> dict[str, list[tuple[str, str, str]]]:
    """Return table -> its columns as (name, type, comment); the raw comment includes the mark of a vocabulary, see `words`."""
    return {name: _COLUMN.findall(body) for name, body in _TABLE.findall(create_statements(file))}


@cache
def column_types() -> dict[str, dict[str, str]]:
    """Return table -> column -> its declared SQL type, with NOT NULL."""
    return {table: {column: kind for column, kind, _ in columns} for table, columns in _column_declarations().items()}


@cache
def word_columns() -> dict[str, dict[str, words.WordColumn]]:
    """Return table -> column -> its vocabulary, for the columns with words of a vocabulary."""
    return {
        table: {
            column: words_of_column
            for column, kind, comment in columns
            if (words_of_column := words.word_column(kind, comment))
        }
        for table, columns in _column_declarations().items()
    }


@cache
def input_quantities_by_column() -> dict[str, dict[str, frozenset[str]]]:
    """Return table -> column -> the quantities of actors from which it is computed, if its comment ends in a list of quantities."""
    return {
        table: {
            name: frozenset(made_of[1].split(", "))
            for name, _, comment in columns
            if (made_of := _QUANTITIES.search(comment))
        }
        for table, columns in _column_declarations().items()
    }


@cache
def lifetimes() -> dict[str, str]:
    """Return table -> its lifetime, from the line above it in `schemas/`. Errors: `DriveLintError` for a table without a lifetime."""
    lifetime_by_table = {table: lifetime for lifetime, table in _LIFETIME.findall(create_statements())}
    for table in column_comments():
        if lifetime_by_table.get(table) not in TABLE_LIFETIMES:
            raise DriveLintError(
                f"schemas: table {table!r} has no lifetime: write -- lifetime: {' | '.join(TABLE_LIFETIMES)} above it"
            )
    return lifetime_by_table


def tables_of_lifetime(*kinds: str) -> list[str]:
    """Return the tables with these lifetimes, in the order of the files."""
    return [table for table in column_comments() if lifetimes()[table] in kinds]
