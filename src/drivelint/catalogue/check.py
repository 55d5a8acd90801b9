"""Checks a rule's SQL without running it: one SELECT, known tables and functions only, bound parameters, named columns.

The module compares DuckDB's syntax tree with the lists in `allowed_sql`. DuckDB itself also parses and serialises statements that are not
allowed (such as two statements, DESCRIBE, `query('...')` and `FROM '/etc/passwd'`).
"""

from __future__ import annotations

import re
from contextlib import contextmanager
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import duckdb

from drivelint.catalogue import allowed_sql
from drivelint.catalogue.allowed_sql import ENGINE_TABLES
from drivelint.errors import RuleError
from drivelint.phrases import nearest_word
from drivelint.sql.syntax import (
    byte_offset_of,
    column_name,
    parser,
    syntax_tree,
    tables_needing_rows,
    union_queries,
    walk,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

__all__ = [
    "ENGINE_TABLES",
    "SelectParts",
    "check_query",
    "collect_problems",
    "error_message",
    "line_of_error",
    "parameter_places",
    "raise_problems",
]

Node = dict[str, Any]

_TOO_DEEP = "too deeply nested to be checked: split it into CTEs"


class SelectParts(NamedTuple):
    """The parts of one SELECT.

    `places`: table, or `AS column` for a column that it returns -> `file:line` of its first mention.
    `columns`: its columns, None if it uses `*`. `needs`: tables that must have rows for the SELECT to return rows.
    `column_names`: all column names in the SELECT, in lower case, except names used only in the text of a reason.
    `by_name`: it is a UNION BY NAME, whose later branches may add columns.
    """

    tables: frozenset[str]
    parameters: frozenset[str]
    columns: tuple[str, ...] | None
    places: dict[str, str]
    reasons: tuple[GivenReason, ...] = ()
    needs: frozenset[str] = frozenset()
    column_names: frozenset[str] = frozenset()
    by_name: bool = False


class GivenReason(NamedTuple):
    """A reason that the SQL gives by `why(code, {...})`: its code, argument names and place (`file:line`).

    `arguments` is None if the second argument is no STRUCT literal.
    """

    code: str
    arguments: frozenset[str] | None
    place: str


class _SqlText(NamedTuple):
    """SQL, with its file and the line of the file on which it begins."""

    sql: str
    file: str
    line: int

    def place_at(self, offset: int | None) -> str:
        """Return `file:line` of a byte offset in the SQL; the first line of the SQL if the offset is None."""
        before = b"" if offset is None else self.sql.encode()[:offset]
        return f"{self.file}:{self.line + before.count(10)}"

    def place_of_error(self, error: duckdb.Error) -> str:
        """Return `file:line` of an error of DuckDB."""
        line = re.search(r"^LINE (\d+):", str(error), re.MULTILINE)
        return f"{self.file}:{self.line + (int(line[1]) - 1 if line else 0)}"


@contextmanager
def collect_problems(problems: list[str]) -> Iterator[None]:
    """Add the message of a `RuleError` inside the block to the problems, so that an author sees all problems."""
    try:
        yield
    except RuleError as error:
        problems.append(str(error))


def raise_problems(problems: Sequence[str]) -> None:
    """Raise `RuleError` with one line per problem, if there are problems."""
    if problems:
        raise RuleError("\n".join(dict.fromkeys(problems)))


def error_message(error: duckdb.Error) -> str:
    """Return DuckDB's error message on one line, with the names that it suggests, without its SQL excerpt."""
    text = re.split(r"^LINE \d+:", str(error), maxsplit=1, flags=re.MULTILINE)[0]
    return " ".join(text.split())


def line_of_error(error: duckdb.Error, text: str) -> int | None:
    """Return the line number in the file `text` of the SQL excerpt in DuckDB's error; None if no line or several lines match.

    DuckDB's own line number is useless if the failed statement was composed from parts of the file.
    """
    match = re.search(r"^LINE \d+: (.*)$", str(error), re.MULTILINE)
    part = match[1].strip().removeprefix("...").removesuffix("...").strip() if match else ""
    numbers = [n for n, line in enumerate(text.splitlines(), 1) if part and part in line]
    return numbers[0] if len(numbers) == 1 else None


@lru_cache(maxsize=2048)  # a process may judge several times, with the same rules
def check_query(sql: str, file: str, line: int = 1) -> SelectParts:
    """Check the SQL of one section, which begins at `line` of `file`, and return its parts.

    Errors: `RuleError` with file and line if the section is not exactly one SELECT, or uses an element that `allowed_sql` does not list.
    Also for a CTE with the name of a table, or with a name that begins with `_`, like the engine's tables.
    """
    text = _SqlText(sql, file, line)
    statement, node = _parse_select(text)
    collector = _SyntaxCollector(text)
    for part, ctes in walk(node):
        collector.visit(part, ctes)
    raise_problems(collector.refusals)
    parameters = frozenset(statement.named_parameters)
    try:
        needs = tables_needing_rows(node) & collector.tables.keys()
    except RecursionError as error:
        raise RuleError(f"{text.place_at(0)}: {_TOO_DEEP}") from error
    names = frozenset(collector.column_names)
    return SelectParts(
        frozenset(collector.tables),
        parameters,
        _result_columns(node),
        collector.tables | _places_of_result_columns(text, node),
        tuple(collector.reasons),
        needs,
        names,
        _is_union_by_name(node),
    )


def _parse_select(text: _SqlText) -> tuple[duckdb.Statement, Node]:
    try:
        statements = parser().extract_statements(text.sql)
        if len(statements) > 1:
            second = text.sql.encode().find(statements[1].query.strip().encode())
            raise RuleError(
                f"{text.place_at(second)}: a section is exactly one SELECT, found {len(statements)} statements"
            )
        if not statements or statements[0].type != duckdb.StatementType.SELECT:
            raise RuleError(f"{text.place_at(0)}: a section is exactly one SELECT, and this is none")
        tree = syntax_tree(text.sql)
    except duckdb.Error as error:
        raise RuleError(f"{text.place_of_error(error)}: {error_message(error)}") from error
    except RecursionError as error:
        raise RuleError(f"{text.place_at(0)}: {_TOO_DEEP}") from error
    if tree.get("error") or len(tree["statements"]) != 1:
        raise RuleError(
            f"{text.place_at(0)}: only a plain SELECT can be checked: {tree.get('error_message', 'none here')}"
        )
    return statements[0], tree["statements"][0]["node"]


def parameter_places(sql: str, file: str, line: int) -> dict[str, str] | None:
    """Return parameter -> `file:line` of its first use in SQL that begins at `line`; None if the SQL cannot be parsed."""
    text = _SqlText(sql, file, line)
    try:
        names = {name for statement in parser().extract_statements(sql) for name in statement.named_parameters}
    except duckdb.Error:
        return None
    content = sql.encode()
    marks = [at for at, kind in duckdb.tokenize(sql) if kind == duckdb.token_type.operator]
    used = [(match[1].decode(), at) for at in marks if (match := re.compile(rb"\$(\w+)").match(content, at))]
    offsets = dict.fromkeys(names) | {name: at for name, at in reversed(used) if name in names}
    return {name: text.place_at(at) for name, at in offsets.items()}


class _SyntaxCollector:
    """Collects from a syntax tree: forbidden elements (`refusals`), tables (name -> `file:line`), column names and reasons."""

    def __init__(self, text: _SqlText) -> None:
        self._text = text
        self.refusals: list[str] = []
        self.tables: dict[str, str] = {}
        self.reasons: list[GivenReason] = []
        self.column_names: set[str] = set()
        self._worded: set[int] = set()

    def visit(self, part: Node, ctes: frozenset[str]) -> None:
        """Process one node. `ctes`: names of the CTEs in its scope."""
        kind = part.get("type")
        if part.get("sample"):
            self._add_refusal(part, "a sample differs every time: a rule may not use one")
        modifiers = {modifier["type"] for modifier in part.get("modifiers") or ()}
        if modifiers & {"LIMIT_MODIFIER", "LIMIT_PERCENT_MODIFIER"} and "ORDER_MODIFIER" not in modifiers:
            self._add_refusal(part, "LIMIT without ORDER BY returns different rows every time: add ORDER BY")
        if part.get("ref_type") == "POSITIONAL":
            self._add_refusal(part, "POSITIONAL JOIN depends on the order of rows, which is not fixed")
        if "class" in part:
            self._visit_expression(part)
        elif kind == "BASE_TABLE":
            self._visit_table(part, ctes)
        elif kind == "TABLE_FUNCTION":
            name = str(part["function"]["function_name"]).lower()
            if name not in allowed_sql.TABLE_FUNCTIONS | allowed_sql.macros():
                self._add_refusal(part["function"], f"table function {name}() is not allowed in a rule")
        elif _is_forbidden_node(part):
            self._add_refusal(part, f"{_kind_in_words(kind)} is not allowed in a rule: write a plain SELECT")
        for entry in part.get("cte_map", {}).get("map", ()):
            self._visit_cte(entry)

    def _visit_expression(self, part: Node) -> None:
        kind = part["class"]
        if kind not in allowed_sql.EXPRESSIONS:
            self._add_refusal(part, f"{_kind_in_words(kind)} is not allowed in a rule")
        name = str(part.get("function_name", "")).lower()
        if name and name not in allowed_sql.functions():
            near = nearest_word(name, allowed_sql.functions())
            function = f"function {name}()" if name.isidentifier() else f"operator {name.removesuffix('__postfix')}"
            suggestion = f"; did you mean {near}()?" if near else ""
            self._add_refusal(
                part,
                f"{function} is not allowed in a rule{suggestion}: only functions that always return the same value and "
                "use nothing but the tables, and the library's macros",
            )
        if name in allowed_sql.NEEDING_ORDER_BY and not _has_order_by(part):
            self._add_refusal(
                part, f"{name}() without ORDER BY returns a different row every time: add ORDER BY, or write max(...)"
            )
        if name == "why":
            place = self._text.place_at(byte_offset_of(part))
            code, *rest = part["children"]
            arguments = _struct_fields(rest[0]) if rest else frozenset[str]()
            self.reasons += [GivenReason(child, arguments, place) for child in _possible_texts(code)]
            # columns that are used only in the text of a reason decide nothing; the walk visits a parent before its children
            self._worded.update(id(child) for child, _ in walk(part["children"]) if child.get("class") == "COLUMN_REF")
        if kind == "COLUMN_REF" and id(part) not in self._worded:
            self.column_names.add(part["column_names"][-1].lower())
        if kind == "COLUMN_REF" and len(part["column_names"]) == 1:
            word = part["column_names"][0].lower()
            if word in allowed_sql.REFUSED_NAMES:
                self._add_refusal(part, f"{word} does not return the same value every time: a rule may not use it")

    def _visit_table(self, part: Node, ctes: frozenset[str]) -> None:
        name = part["table_name"].lower()
        whole = ".".join(word for word in (part["catalog_name"], part["schema_name"], name) if word)
        if part.get("at_clause"):
            self._add_refusal(part, "AT (...) is not allowed in a rule")
        if whole in ctes:
            return
        if whole not in allowed_sql.tables():
            self._add_refusal(part, allowed_sql.unknown_table_message(whole))
            return
        self.tables.setdefault(name, self._text.place_at(part["query_location"]))

    def _visit_cte(self, entry: Node) -> None:
        name = str(entry["key"]).lower()
        if name in allowed_sql.tables() or name.startswith("_"):
            select = entry["value"]["query"]["node"]
            self._add_refusal(
                select, f"rename the CTE {name!r}: it hides a table, or begins with _ like the engine's own"
            )

    def _add_refusal(self, part: Node, message: str) -> None:
        self.refusals.append(f"{self._text.place_at(byte_offset_of(part))}: {message}")


def _has_order_by(part: Node) -> bool:
    """Return whether an aggregate or a window function has an ORDER BY."""
    return bool(part.get("orders") or (part.get("order_bys") or {}).get("orders"))


def _possible_texts(part: Node) -> list[str]:
    """Return the texts that an expression may return: a constant, or the constants in the branches of a CASE."""
    if part["class"] == "CONSTANT":
        return [str(part["value"]["value"])]
    if part["class"] != "CASE":
        return []
    branches = [*(check["then_expr"] for check in part["case_checks"]), part["else_expr"]]
    return [text for branch in branches for text in _possible_texts(branch)]


def _struct_fields(part: Node) -> frozenset[str] | None:
    """Return the field names of a STRUCT literal; None for another expression."""
    if str(part.get("function_name", "")).lower() != "struct_pack":
        return None
    return frozenset(str(child["alias"]) for child in part["children"])


def _is_forbidden_node(part: Node) -> bool:
    """Return whether a node is a source of rows or a query of a type that a rule may not use."""
    kind = str(part.get("type"))
    if {"alias", "sample"} <= part.keys():
        return kind not in allowed_sql.SOURCES
    return kind.endswith("_NODE") and kind not in allowed_sql.NODES


def _kind_in_words(kind: object) -> str:
    return str(kind).removesuffix("_NODE").removesuffix("_REF").replace("_", " ")


def _is_union_by_name(node: Node) -> bool:
    """Return whether a query is a UNION BY NAME, or its first branch is one."""
    while node["type"] == "SET_OPERATION_NODE":
        if node["setop_type"] == "UNION_BY_NAME":
            return True
        node = union_queries(node)[0]
    return False


def _result_columns(node: Node) -> tuple[str, ...] | None:
    """Return the column names of a SELECT, or of the first branch of a UNION; None if a column has no name or is a `*`."""
    while node["type"] == "SET_OPERATION_NODE":
        node = union_queries(node)[0]
    if node["type"] != "SELECT_NODE":
        return None
    names = tuple("" if item["class"] == "STAR" else column_name(item) for item in node["select_list"])
    return names if all(names) else None


def _places_of_result_columns(text: _SqlText, node: Node) -> dict[str, str]:
    """Return `AS column` -> `file:line` of the column's name, for a SELECT or the first branch of a UNION."""
    while node["type"] == "SET_OPERATION_NODE":
        node = union_queries(node)[0]
    items, content = node.get("select_list", []), text.sql.encode()
    offsets = [byte_offset_of(item) or 0 for item in items]
    places: dict[str, str] = {}
    for item, start, end in zip(items, offsets, [*offsets[1:], len(content)], strict=True):
        name = column_name(item)
        alias = re.search(rf'\bas\s+"?{re.escape(name)}\b'.encode(), content[start : max(start, end)], re.IGNORECASE)
        places.setdefault(f"AS {name}", text.place_at(start + alias.start() if alias else start))
    return places
