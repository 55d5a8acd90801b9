"""Makes the reference from the sources: the data dictionary, the reason codes with their texts, and the macros for SQL.

The data dictionary has every table of `schemas/*.sql` and `queries/library` with its columns, their vocabularies, and the tables that it
reads.
"""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING, Any, Final

from drivelint.catalogue import load_rules
from drivelint.errors import UsageError
from drivelint.phrases import hint
from drivelint.reasons.reason_text import texts_of_shared_codes
from drivelint.report import catalogue_page
from drivelint.resources import folder
from drivelint.result import geometry
from drivelint.result.names import TABLE_OF_FILE, TABLE_OF_PICTURE_FILE
from drivelint.result.text_templates import cell, text_template
from drivelint.sql import store, syntax
from drivelint.sql.declarations import column_comments, lifetimes
from drivelint.sql.derivations import derivations
from drivelint.sql.library import library_tables
from drivelint.sql.words import vocabularies

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

_INTRODUCTION: Final = """Every table that drivelint fills, with the meaning of each column; rules read these tables.

Distances are metres, speeds metres per second, angles radians, and times integer nanoseconds of the log's own clock. NULL
means that the value is not known, unless the column says otherwise. `drivelint check --keep-db` keeps these tables in
`drivelint.duckdb`.

A column of words has only the words of one vocabulary. They are listed with the column, or under *Words*. A rule, a case, a mapping or
a reader's output with any other word is refused.
"""
_VOCABULARY_HINT: Final = "drivelint docs dictionary NAME prints one of them."
_MACRO_PATTERN: Final = re.compile(
    r"((?:^--.*\n)*)^CREATE OR REPLACE MACRO (\w+\((?:[^)]+\)|\)(?: AS .+;$)?))", re.MULTILINE
)
_MARKUP_CHARACTERS: Final = re.compile(r"([\\`*_\[\]<>~&])")
_HEADING_BY_SCHEMA_FILE: Final = {
    "model": "The recorded drive",
    "map": "The map",
    "profile": "Driving profiles",
    "library/log": "Derived: time and inputs of a log",
    "library/map": "Derived: the prepared map",
    "library/motion": "Derived: motion",
    "library/lanes": "Derived: lanes",
    "library/others": "Derived: other road users",
    "library/overtakes": "Derived: overtakes",
    "library/junctions": "Derived: junctions and crossings",
    "library/sight": "Derived: what cannot be seen",
    "verdict": "Verdicts",
    "output": "Drives and rules",
    "evidence": "Evidence for the report",
}
"""File of `schemas/`, or topic of the library -> the heading of its tables."""
_LIFETIME_WORDS: Final = {
    "map": "as long as batches use the map",
    "drive": "while its batch of drives is judged",
    "part": "while a part of the egos of a drive is judged",
    "run": "to the end of the run",
}


def page() -> str:
    """Return the data dictionary as Markdown. Errors: `DriveLintError` for a file that `_HEADING_BY_SCHEMA_FILE` lacks."""
    sources_by_table = sources_of_derived_tables()
    filters: dict[str, Any] = {
        "about": _derivation_comment,
        "columns": _column_table,
        "escaped": escape_markdown,
        "facts": lambda name: " ".join(_table_facts(name, sources_by_table, _markdown_links, "`")),
        "links": _markdown_links,
    }
    return text_template(__file__, "dictionary.md.j2", **filters).render(
        says=_INTRODUCTION,
        levels=derivation_levels(sources_by_table),
        read=sources_by_table,
        groups={heading: column_comments(file) for file, heading in _HEADING_BY_SCHEMA_FILE.items()},
        vocabularies=vocabularies(),
    )


def text() -> str:
    """Return the data dictionary as plain text, with a block per table and a line per column."""
    groups = (
        f"{heading.upper()}\n\n" + "\n".join(map(table_text, column_comments(file)))
        for file, heading in _HEADING_BY_SCHEMA_FILE.items()
    )
    words = f"WORDS\n\n{_VOCABULARY_HINT}\n\n" + "\n".join(map(_vocabulary_text, vocabularies()))
    return "\n".join([_INTRODUCTION, *groups, words])


def table_text(name: str) -> str:
    """Return one table, or one vocabulary, as plain text.

    The text of a table has its name, its description, and a line per column with type and meaning. Errors: `UsageError` with the nearest
    table or vocabulary.
    """
    if name in vocabularies() and name not in column_comments():
        return _vocabulary_text(name)
    if name not in column_comments():
        near = hint(name, [*column_comments(), *vocabularies()])
        advice = "drivelint docs dictionary prints all" if near.startswith("known") else near
        raise UsageError(f"docs dictionary {name}: no table {name!r}: {advice}")
    columns = [(column, _column_types()[name, column], comment) for column, comment in column_comments()[name].items()]
    wide, wider = (max(len(row[i]) for row in columns) for i in (0, 1))
    facts = [
        line
        for line in (_derivation_comment(name), " ".join(_table_facts(name, sources_of_derived_tables(), ", ".join)))
        if line
    ]
    rows = [f"  {column:<{wide}}  {kind:<{wider}}  {comment}" for column, kind, comment in columns]
    return "\n".join([name, *facts, *rows]) + "\n"


def _vocabulary_text(name: str) -> str:
    """Return a vocabulary as plain text: its name, its words and their meaning."""
    vocabulary = vocabularies()[name]
    return (
        f"[{name}]\n  {', '.join(vocabulary.words)}{'' if vocabulary.has_all_words else ', ...'}\n  {vocabulary.says}\n"
    )


def escape_markdown(text: str) -> str:
    """Return text with Markdown's special characters escaped."""
    return _MARKUP_CHARACTERS.sub(r"\\\1", text)


def output_tables_text() -> str:
    """Return a section per result file with the columns of its table."""
    files = {**TABLE_OF_FILE, **TABLE_OF_PICTURE_FILE, "margins": "margin"}
    return "\n".join(f"### {stem}.parquet\n\n{_column_table(name, in_file=True)}" for stem, name in files.items())


@cache
def sources_of_derived_tables() -> Mapping[str, tuple[str, ...]]:
    """Return derived table -> tables that its SELECT reads, in the order of derivation."""
    return {
        name: tuple(
            sorted(syntax.tables_read(syntax.parse_select(derivation.sql, name)) & column_comments().keys() - {name})
        )
        for name, derivation in derivations().items()
    }


def derivation_levels(sources_by_table: Mapping[str, Iterable[str]]) -> list[list[str]]:
    """Return the derived tables per level; each table reads only recorded tables and tables of lower levels."""
    level: dict[str, int] = {}
    for name, tables in sources_by_table.items():
        level[name] = 1 + max((level.get(table, 0) for table in tables), default=0)
    return [[name for name in sorted(level) if level[name] == n] for n in range(1, max(level.values()) + 1)]


def _table_facts(
    name: str,
    sources_by_table: Mapping[str, tuple[str, ...]],
    join_names: Callable[[Iterable[str]], str],
    quote: str = "",
) -> list[str]:
    """Return sentences about a table: how long it is kept, the files to which it is written and by which it is filled, and its readers.

    The tables that it reads are named too.
    `join_names`: a function that joins names; `quote`: the mark around the file name.
    """
    sentences = [f"Kept {_LIFETIME_WORDS[lifetimes()[name]]}."]
    if files := [stem for stem, of in {**TABLE_OF_FILE, **TABLE_OF_PICTURE_FILE}.items() if of == name]:
        sentences.append(f"Written to {quote}{files[0]}.parquet{quote}.")
    if name in library_tables():
        sentences.append(f"Filled by {quote}{library_tables()[name].short_path}{quote}.")
    if name in sources_by_table:
        sentences.append(
            f"Reads {join_names(sources_by_table[name])}." if sources_by_table[name] else "Reads no table."
        )
    if readers := [table for table, tables in sources_by_table.items() if name in tables]:
        sentences.append(f"Read by {join_names(sorted(readers))}.")
    if rules := [rule_id for rule_id, reads in _tables_read_by_rules() if name in reads]:
        sentences.append(f"Rules: {', '.join(rules)}.")
    return sentences


@cache
def _tables_read_by_rules() -> list[tuple[str, tuple[str, ...]]]:
    return sorted((rule_id, tuple(rule.reads)) for rule_id, rule in load_rules(()).items())


def _derivation_comment(name: str) -> str:
    """Return what a library table is; '' for another table."""
    return library_tables()[name].description if name in library_tables() else ""


def _column_table(name: str, *, in_file: bool = False) -> str:
    lines = ["| column | type | meaning |", "|---|---|---|"]
    for column, comment in column_comments()[name].items():
        lines.append(
            f"| `{column}` | {cell(escape_markdown(_column_types()[name, column]))} | {cell(escape_markdown(comment))} |"
        )
    for column, shape in geometry.GEOMETRIES_OF_TABLE.get(name, {}).items() if in_file else ():
        lines.append(f"| `{column}` | GEOMETRY | {cell(escape_markdown(f'{shape.kind}: {shape.comment}'))} |")
    return "\n".join(lines) + "\n"


@cache
def _column_types() -> dict[tuple[str, str], str]:
    """Return (table, column) -> its SQL type, including NOT NULL."""
    with store.connect() as con:
        rows = con.execute("SELECT table_name, column_name, data_type, is_nullable FROM duckdb_columns()").fetchall()
    return {(name, column): kind if nullable else f"{kind} NOT NULL" for name, column, kind, nullable in rows}


def _markdown_links(names: Iterable[str]) -> str:
    return ", ".join(f"[{name}](#{name})" for name in names)


def reasons_page() -> str:
    """Return every reason code as Markdown: first the codes that rules share, then the codes of single rules."""
    return text_template(__file__, "reasons.md.j2").render(
        shared=texts_of_shared_codes(), rules=sorted(load_rules(()).items())
    )


def macros_page() -> str:
    """Return every macro as Markdown, grouped by file: its parameters, and the comment above it.

    A macro without parameters is shown with its value. Macros without a comment have the comment of the macro above.
    """
    files: dict[str, list[tuple[str, str]]] = {}
    for file in sorted((folder("queries") / "macros").glob("*.sql")):
        about = ""
        for comment, signature in _MACRO_PATTERN.findall(file.read_text(encoding="utf-8")):
            about = " ".join(line.removeprefix("--").strip() for line in comment.splitlines()) or about
            files.setdefault(file.stem, []).append((signature, about))
    return text_template(__file__, "macros.md.j2").render(files=files)


REFERENCE_TEXTS: Final[dict[str, Callable[[], str]]] = {
    "dictionary": text,
    "catalogue": lambda: catalogue_page.render_markdown(load_rules(()).values(), folder("queries") / "assertions"),
    "reasons": reasons_page,
    "macros": macros_page,
}
"""Topic of `drivelint docs` that is no guide -> the function that returns its text."""
