"""Finds words in SQL that a column can never have: `is_class(actor_class, 'cyclist')` is never true, and the rule never applies.

DuckDB does not report them: even an ENUM column may be compared with any text. This module walks the syntax tree and computes the possible
words of each expression, from the tables' columns through CTEs, joins, functions and macros. An expression that it cannot compute may have
any value.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache, partial, reduce
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from drivelint.sql import declarations, syntax, word_types
from drivelint.sql.macro_trees import macro, macro_texts
from drivelint.sql.word_functions import compared_words, possible_words_of_call
from drivelint.sql.word_scope import UNKNOWN, Relation, Scope, Source, union_of_relations, with_column_names
from drivelint.sql.word_types import (
    NULL,
    ListOf,
    LiteralPlace,
    Parameter,
    PossibleWords,
    StructOf,
    WordType,
    WrongWord,
    as_indirect,
    possible_words_of_item,
    possible_words_of_member,
    union,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    Node = dict[str, Any]

_COMPARISONS: Final = frozenset(
    {"COMPARE_EQUAL", "COMPARE_NOTEQUAL", "COMPARE_DISTINCT_FROM", "COMPARE_NOT_DISTINCT_FROM"}
)
_FUNCTIONS_WITH_LAMBDA: Final = frozenset({"list_filter", "list_transform", "list_apply"})


class CheckedQuery(NamedTuple):
    """A query's columns, its wrong words, and for each parameter the values to which the query compares it."""

    relation: Relation
    wrong: Sequence[WrongWord]
    parameters: Mapping[str, Sequence[PossibleWords]]


def check_query(tree: Node, tables: Mapping[str, Relation] | None = None) -> CheckedQuery:
    """Check the tree of a SELECT. `tables`: additional tables outside `schemas/`, such as a rule's reference points."""
    walker = _Walker({**_relation_by_table(), **(tables or {})})
    relation = walker.relation_of_query(tree, {}, None)
    return CheckedQuery(relation, walker.wrong, walker.parameters)


def wrong_words_in_columns(table: str, relation: Relation) -> list[WrongWord]:
    """Return the literals that a query puts into a column of this table although they are not words of the column's vocabulary.

    The columns of a UNION, matched by position, have the names in its first query.
    """
    columns = declarations.word_columns()[table]
    wrong = []
    for name, kind in relation.columns:
        column = word_types.possible_words_of_column(columns[name]) if name in columns else None
        if isinstance(column, PossibleWords) and isinstance(kind, PossibleWords):
            wrong += [
                WrongWord(word, place.offset, column)
                for word, place in kind.literals.items()
                if not column.may_be(word)
            ]
    return wrong


def check_macro(name: str) -> list[WrongWord]:
    """Return the wrong words in a macro; a parameter may have the values of the columns with its name."""
    walker = _Walker(_relation_by_table())
    walker.possible_words_of_macro_call(name, None)
    return walker.wrong


@cache
def _relation_by_table() -> dict[str, Relation]:
    columns = declarations.word_columns()
    return {
        table: Relation(
            [
                (name, word_types.possible_words_of_column(columns[table][name]) if name in columns[table] else None)
                for name in names
            ]
        )
        for table, names in declarations.column_comments().items()
    }


@cache
def _possible_words_by_column() -> dict[str, WordType]:
    """Return column -> its possible values, for columns with the same values in every table that has them."""
    kinds_by_name: dict[str, list[WordType]] = {}
    for columns in declarations.word_columns().values():
        for name, column in columns.items():
            kinds_by_name.setdefault(name, []).append(word_types.possible_words_of_column(column))
    return {name: kinds[0] for name, kinds in kinds_by_name.items() if all(kind == kinds[0] for kind in kinds)}


class _Walker:
    """Walks trees: each method returns the possible values of a node, and collects the node's wrong words."""

    def __init__(self, tables: Mapping[str, Relation]) -> None:
        self._relation_by_table = tables
        self._depth = 0
        """The number of macro calls around the current node."""
        self._call: int | None = None
        """The byte offset of the outermost of these macro calls."""
        self._wrong: dict[tuple[str, int | None], WrongWord] = {}
        self.parameters: dict[str, list[PossibleWords]] = {}

    @property
    def wrong(self) -> list[WrongWord]:
        """The wrong words, without duplicates."""
        return list(self._wrong.values())

    # ---- queries

    def relation_of_query(self, node: Node, ctes: Mapping[str, Relation], outer: Scope | None) -> Relation:
        inner_ctes = dict(ctes)
        for entry in node.get("cte_map", {}).get("map", ()):
            value = entry["value"]
            name = entry["key"].lower()
            inner_ctes[name] = with_column_names(
                self.relation_of_query(value["query"]["node"], inner_ctes, outer), value.get("aliases", ())
            )
        match node["type"]:
            case "SELECT_NODE":
                return self._relation_of_select(node, inner_ctes, outer)
            case "SET_OPERATION_NODE":
                first, *rest = (self.relation_of_query(part, inner_ctes, outer) for part in syntax.union_queries(node))
                return reduce(partial(union_of_relations, by_name="BY_NAME" in node["setop_type"]), rest, first)
            case "RECURSIVE_CTE_NODE":
                return self._relation_of_recursive_cte(node, inner_ctes, outer)
        return UNKNOWN

    def _relation_of_recursive_cte(self, node: Node, ctes: Mapping[str, Relation], outer: Scope | None) -> Relation:
        """Return the columns of a recursive CTE. Wrong words are collected only after its possible values no longer change."""
        name = node["cte_name"].lower()
        relation = self.relation_of_query(node["left"], ctes, outer)
        for _ in range(4):
            apart = _Walker(self._relation_by_table)
            more = union_of_relations(
                relation, apart.relation_of_query(node["right"], {**ctes, name: relation}, outer), by_name=False
            )
            if more == relation:
                self.relation_of_query(node["right"], {**ctes, name: relation}, outer)
                return relation
            relation = more
        return Relation([(column, None) for column, _ in relation.columns], relation.complete)

    def _relation_of_select(self, node: Node, ctes: Mapping[str, Relation], outer: Scope | None) -> Relation:
        scope = Scope(outer, ctes)
        scope.sources = self._sources_of_from_clause(node["from_table"], scope)
        columns: list[tuple[str, WordType]] = []
        complete = True
        for item in node["select_list"]:
            if item["class"] == "STAR":
                star = self._columns_of_star(item, scope)
                columns += star.columns
                complete = complete and star.complete
                continue
            kind = self.words_of(item, scope)
            if item.get("function_name", "").lower() == "unnest" and isinstance(kind, StructOf) and _is_recursive(item):
                columns += kind.fields.items()
                continue
            name = syntax.column_name(item)
            columns.append((name, as_indirect(kind)))
            if item.get("alias"):
                scope.aliases.setdefault(name, as_indirect(kind))
        for key, value in node.items():
            if key not in {"select_list", "from_table", "cte_map"}:
                self._check_inner_expressions(value, scope)
        return Relation(columns, complete)

    def _columns_of_star(self, item: Node, scope: Scope) -> Relation:
        """Return the columns that a `*` selects."""
        if item.get("columns") or item.get("expr"):
            return UNKNOWN
        source_name = item.get("relation_name", "").lower()
        sources = [source for source in scope.sources if not source_name or source.name == source_name]
        if source_name and not sources:
            kind = scope.lookup([source_name])
            return Relation(list(kind.fields.items())) if isinstance(kind, StructOf) else UNKNOWN
        dropped = {_excluded_column_name(name) for name in item.get("exclude_list") or ()}
        replaced = {
            entry["key"].lower(): as_indirect(self.words_of(entry["value"], scope))
            for entry in item.get("replace_list") or ()
        }
        columns = [
            (name, replaced.get(name, kind))
            for source in sources
            for name, kind in source.relation.columns
            if name not in dropped and (source_name or name not in source.hidden)
        ]
        return Relation(columns, all(source.relation.complete for source in sources) and not item.get("rename_list"))

    def _sources_of_from_clause(self, node: Node, scope: Scope) -> list[Source]:
        name = (node.get("alias") or node.get("table_name") or "").lower()
        match node["type"]:
            case "EMPTY":
                return []
            case "JOIN":
                return self._sources_of_join(node, scope)
            case "BASE_TABLE":
                table = node["table_name"].lower()
                relation = scope.ctes.get(table) or self._relation_by_table.get(table) or UNKNOWN
            case "SUBQUERY":
                relation = self.relation_of_query(node["subquery"]["node"], scope.ctes, scope)
            case "EXPRESSION_LIST":
                rows = [[self.words_of(value, scope) for value in row] for row in node["values"]]
                relation = Relation(
                    [(f"col{n}", as_indirect(union(kinds))) for n, kinds in enumerate(zip(*rows, strict=True))]
                )
            case "TABLE_FUNCTION":
                call = node["function"]
                kind = self.words_of(call, scope)
                is_list = call["function_name"].lower() in {"unnest", "range", "generate_series"}
                relation = Relation([(call["function_name"].lower(), as_indirect(kind))], complete=is_list)
            case _:
                relation = UNKNOWN
        return [Source(name, with_column_names(relation, node.get("column_name_alias", ())))]

    def _sources_of_join(self, node: Node, scope: Scope) -> list[Source]:
        left = self._sources_of_from_clause(node["left"], scope)
        right = self._sources_of_from_clause(node["right"], Scope(scope.outer, scope.ctes, left))
        self._check_inner_expressions(node.get("condition"), Scope(scope.outer, scope.ctes, [*left, *right]))
        if node.get("join_type") in {"SEMI", "ANTI"}:
            return left
        shared = {name.lower() for name in node.get("using_columns", ())}
        if node.get("ref_type") == "NATURAL":
            shared |= {name for source in left for name, _ in source.relation.columns}
        return [*left, *(source.with_hidden_columns(frozenset(shared)) for source in right)]

    # ---- expressions

    def words_of(self, node: Node, scope: Scope) -> WordType:
        """Return the possible values of an expression."""
        of_class = getattr(self, f"_{node['class'].lower()}", None)
        if of_class is not None:
            kind: WordType = of_class(node, scope)
            return kind
        self._check_inner_expressions([value for key, value in node.items() if key != "class"], scope)
        return None

    def _check_inner_expressions(self, part: Any, scope: Scope) -> None:
        """Check all expressions in a part of a tree."""
        if isinstance(part, dict) and "class" in part:
            self.words_of(part, scope)
        elif isinstance(part, dict | list):
            for inner in part.values() if isinstance(part, dict) else part:
                if isinstance(inner, dict | list):
                    self._check_inner_expressions(inner, scope)

    def _constant(self, node: Node, _scope: Scope) -> WordType:
        value = node["value"]
        if value["is_null"]:
            return NULL
        if value["type"]["id"] != "VARCHAR":
            return None
        place = LiteralPlace(self._call if self._depth else syntax.byte_offset_of(node), in_macro=bool(self._depth))
        return PossibleWords(literals={value["value"]: place}, direct=True)

    @staticmethod
    def _column_ref(node: Node, scope: Scope) -> WordType:
        return scope.lookup([name.lower() for name in node["column_names"]])

    @staticmethod
    def _parameter(node: Node, _scope: Scope) -> WordType:
        return Parameter(node["identifier"])

    def _case(self, node: Node, scope: Scope) -> WordType:
        checks = node["case_checks"]
        for check in checks:
            self.words_of(check["when_expr"], scope)
        return union(
            self.words_of(part, scope) for part in (*(check["then_expr"] for check in checks), node["else_expr"])
        )

    def _cast(self, node: Node, scope: Scope) -> WordType:
        kind = self.words_of(node["child"], scope)
        return kind if node["cast_type"]["id"] == "VARCHAR" or kind == NULL else None

    def _comparison(self, node: Node, scope: Scope) -> WordType:
        left, right = self.words_of(node["left"], scope), self.words_of(node["right"], scope)
        if node["type"] in _COMPARISONS:
            self._check_comparison(left, right)
        return None

    def _operator(self, node: Node, scope: Scope) -> WordType:
        kinds = [self.words_of(child, scope) for child in node["children"]]
        match node["type"]:
            case "COMPARE_IN" | "COMPARE_NOT_IN":
                for kind in kinds[1:]:
                    self._check_comparison(kinds[0], kind.item if isinstance(kind, ListOf) else kind)
            case "OPERATOR_COALESCE":
                return union(kinds)
            case "ARRAY_EXTRACT" | "STRUCT_EXTRACT":
                return possible_words_of_member(*kinds)
            case "ARRAY_SLICE":
                return kinds[0]
        return None

    def _window(self, node: Node, scope: Scope) -> WordType:
        return self._function(node, scope)

    def _function(self, node: Node, scope: Scope) -> WordType:
        name = node["function_name"].lower()
        children = node["children"]
        if name in _FUNCTIONS_WITH_LAMBDA and children[1]["class"] == "LAMBDA":
            return self._possible_words_of_list_lambda(name, node, scope)
        kinds = [self.words_of(child, scope) for child in children]
        self._check_inner_expressions(
            {key: value for key, value in node.items() if key not in {"children", "class"}}, scope
        )
        if name in macro_texts():
            return self.possible_words_of_macro_call(name, kinds, node)
        if name == "struct_pack":
            return StructOf(
                {child["alias"].lower(): as_indirect(kind) for child, kind in zip(children, kinds, strict=True)}
            )
        if pair := compared_words(name, kinds):
            self._check_comparison(*pair)
        if len(kinds) == 2:
            self._collect_wrong_words(word_types.wrong_patterns(name, *kinds))
        return possible_words_of_call(name, kinds)

    def _possible_words_of_list_lambda(self, name: str, node: Node, scope: Scope) -> WordType:
        """Return the possible values of a list function with a lambda, such as `list_filter`."""
        items, function = self.words_of(node["children"][0], scope), node["children"][1]
        left = function["lhs"]
        names = [column["column_names"][0].lower() for column in left.get("children") or [left]]
        bound = {**dict.fromkeys(names), names[0]: as_indirect(possible_words_of_item(items))}
        value = self.words_of(function["expr"], Scope(scope, scope.ctes, bound=bound))
        return items if name == "list_filter" else ListOf(value)

    def possible_words_of_macro_call(
        self, name: str, kinds: Sequence[WordType] | None, call: Node | None = None
    ) -> WordType:
        """Return the possible values of a macro call. `kinds`: possible values of the arguments; None: any values."""
        body = macro(name)
        if body is None or (kinds is not None and len(kinds) != len(body.parameters)):
            return None
        if kinds is not None and all(kind is None for kind in kinds):
            return _possible_words_of_macro(name)
        arguments = zip(body.parameters, kinds or [None] * len(body.parameters), strict=True)
        columns = _possible_words_by_column()
        bound = {parameter: columns.get(parameter) if kind is None else kind for parameter, kind in arguments}
        if not self._depth:
            self._call = None if call is None else syntax.byte_offset_of(call)
        self._depth += 1
        kind = self.words_of(body.value, Scope(bound=bound))
        self._depth -= 1
        return as_indirect(kind)

    def _subquery(self, node: Node, scope: Scope) -> WordType:
        relation = self.relation_of_query(node["subquery"]["node"], scope.ctes, scope)
        first = relation.columns[0][1] if relation.columns else None
        if node["subquery_type"] == "ANY":
            kind = self.words_of(node["child"], scope)
            if node["comparison_type"] in _COMPARISONS:  # the literals in the list of ANY are written at this place
                self._check_comparison(
                    kind, replace(first, direct=not first.vocabularies) if isinstance(first, PossibleWords) else first
                )
            return None
        return first if node["subquery_type"] == "SCALAR" else None

    def _check_comparison(self, left: WordType, right: WordType) -> None:
        for side, other_side in ((left, right), (right, left)):
            if isinstance(side, Parameter) and isinstance(other_side, PossibleWords) and not other_side.direct:
                self.parameters.setdefault(side.name, []).append(other_side)
        self._collect_wrong_words(word_types.wrong_words(left, right))

    def _collect_wrong_words(self, wrong_words: Iterable[WrongWord]) -> None:
        for wrong in wrong_words:
            self._wrong.setdefault((wrong.word, wrong.offset), wrong)


@cache
def _possible_words_of_macro(name: str) -> WordType:
    """Return the possible values of a macro for any arguments."""
    return _Walker(_relation_by_table()).possible_words_of_macro_call(name, None)


def _is_recursive(unnest: Node) -> bool:
    return any(child.get("alias") == "recursive" for child in unnest["children"])


def _excluded_column_name(name: Any) -> str:
    """Return the name of a column that a `*` excludes, in lower case."""
    return str(name if isinstance(name, str) else name["column"]).lower()
