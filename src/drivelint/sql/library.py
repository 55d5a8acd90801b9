"""Reads the library tables: each file `queries/library/<topic>/<table>.sql` describes one table, declares its columns, and fills it.

A file has four parts: comment lines that say what the table is, `-- lifetime: ...`, `CREATE TABLE`, and `INSERT INTO ... BY NAME` with one
SELECT. A table whose name begins with `_` is private: only other library tables and drivelint's own statements read it.
"""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING, Final, NamedTuple

from drivelint.errors import DriveLintError
from drivelint.resources import folder

if TYPE_CHECKING:
    from pathlib import Path

_FILE: Final = re.compile(
    r"\A((?:--(?! lifetime:)[^\n]*\n)+)(-- lifetime: (\w+)\nCREATE TABLE (\w+) \(\n.*?^\);\n)\nINSERT INTO (\w+) BY NAME\n(.+)\Z",
    re.DOTALL | re.MULTILINE,
)


TABLE_LIFETIMES: Final = ("map", "drive", "part", "run")
"""How long the rows of a table stay. `map`: until a batch needs other maps. `drive`: while the batch is judged. `part`: while the egos of
one part of a drive are judged. `run`: until the end of the run."""
_LIFETIMES_OF_LIBRARY_TABLES: Final = ("part", "map", "run")
"""Those that the SELECT of a library table can have: `drive` is of the tables of the log, which `schemas` declares."""
QUANTITIES: Final = ("position", "heading", "velocity", "size", "class", "existence", "identity")
"""The quantities of an actor that a check of the log can doubt: what the end of a column's comment may name."""
_COLUMN_WITH_QUANTITIES: Final = re.compile(r"^    (\w+) .* -- .*\{([^{}\n]*)\}\s*$", re.MULTILINE)
_UNCOMMENTED_COLUMN: Final = re.compile(r"^    (\w+) (?!.* -- \S)", re.MULTILINE)


class LibraryTable(NamedTuple):
    """One file of the library. `declaration`: the CREATE TABLE with its lifetime; `select`: the SELECT that fills the table."""

    name: str
    topic: str
    path: Path
    description: str
    declaration: str
    select: str

    @property
    def short_path(self) -> str:
        """The path below the folder `queries`, for messages."""
        return f"queries/library/{self.topic}/{self.name}.sql"

    @property
    def is_private(self) -> bool:
        """Whether only the library and drivelint's own statements may read the table."""
        return self.name.startswith("_")


@cache
def library_tables() -> dict[str, LibraryTable]:
    """Return table -> its file, ordered by topic and name. Errors: `DriveLintError` for a file without one of the four parts."""
    files = sorted((folder("queries") / "library").glob("*/*.sql"))
    if not files:
        raise DriveLintError(f"{folder('queries') / 'library'}: there are no tables: reinstall drivelint")
    return {file.stem: _read_file(file) for file in files}


def _read_file(file: Path) -> LibraryTable:
    text = file.read_text(encoding="utf-8")
    match = _FILE.match(text)
    if match is None or not match[4] == match[5] == file.stem:
        raise DriveLintError(
            f"{file}: write a comment, `-- lifetime: part`, `CREATE TABLE {file.stem} (`, `);`, an empty line, "
            f"`INSERT INTO {file.stem} BY NAME` and a SELECT; "
            f"the first that is missing, or not in its place: {_first_missing_part(text, file.stem)}"
        )
    if match[3] not in _LIFETIMES_OF_LIBRARY_TABLES:
        lifetimes = ", ".join(_LIFETIMES_OF_LIBRARY_TABLES)
        raise DriveLintError(
            f"{file}: lifetime {match[3]!r} is none of the library: known are {lifetimes}; a table of a SELECT on the egos' steps has part"
        )
    if bare := _UNCOMMENTED_COLUMN.search(match[2]):
        raise DriveLintError(
            f"{file}: column {bare[1]} has no comment: write `-- ` and what it is after it, on the same line"
        )
    for column, quantities in _COLUMN_WITH_QUANTITIES.findall(match[2]):
        if unknown := sorted(set(quantities.split(", ")).difference(QUANTITIES)):
            raise DriveLintError(
                f"{file}: column {column}: {unknown[0]!r} is no quantity of an actor: known are {', '.join(QUANTITIES)}"
            )
    description = " ".join(line.removeprefix("--").strip() for line in match[1].splitlines())
    return LibraryTable(file.stem, file.parent.name, file, description, match[2], match[6])


def _first_missing_part(text: str, table: str) -> str:
    """Return the first part of a library file that does not follow the parts before it."""
    name = re.escape(table)
    patterns = {
        "a comment": r"(?:--(?! lifetime:)[^\n]*\n)+",
        "`-- lifetime: part`": r"-- lifetime: \w+\n",
        f"`CREATE TABLE {table} (`": rf"CREATE TABLE {name} \(\n",
        "`);`": r".*?^\);\n",
        "an empty line": r"\n",
        f"`INSERT INTO {table} BY NAME`": rf"INSERT INTO {name} BY NAME\n",
    }
    before = ""
    for part, pattern in patterns.items():
        before += pattern
        if re.match(before, text, re.DOTALL | re.MULTILINE) is None:
            return part
    return "a SELECT"
