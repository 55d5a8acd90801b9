"""Creates mutants of a rule: variants with one deliberate fault that at least one case of the rule must notice.

* the sense reversed, and its boundary changed: >= becomes <, and >; `holds` becomes NOT holds
* every ordering comparison in the SQL reversed
* every threshold times 0.9 and 1.1: numeric parameters, numeric literals, constants of the library (`standing_mps()`) and
  other expressions for `required`
* every window halved and doubled: window_s, exempt_after_s, merge_gap_s (if the header sets it)
* every term of every WHERE, HAVING, QUALIFY and JOIN ... ON or USING left out

Not changed: expressions for the reason; the literals 0 and 1 (counts and signs) and powers of ten from 1000 on (units).
The faults are made in DuckDB's syntax tree, which DuckDB converts back to SQL.
"""

from __future__ import annotations

import copy
import json
from collections import Counter
from functools import cache
from itertools import accumulate
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec

from drivelint.catalogue.allowed_sql import macros
from drivelint.sql.syntax import column_name, parser, syntax_tree

if TYPE_CHECKING:
    from collections.abc import Iterator

    from drivelint.catalogue import Rule

Node = dict[str, Any]
NodePath = tuple[str | int, ...]
"""The keys that lead from a statement's node to a node inside it."""

OPPOSITE = {">": "<=", ">=": "<", "<": ">=", "<=": ">"}
BOUNDARY_SWAP = {">": ">=", ">=": ">", "<": "<=", "<=": "<"}
_REVERSED_COMPARISON = {
    "COMPARE_LESSTHAN": "COMPARE_GREATERTHANOREQUALTO",
    "COMPARE_LESSTHANOREQUALTO": "COMPARE_GREATERTHAN",
    "COMPARE_GREATERTHAN": "COMPARE_LESSTHANOREQUALTO",
    "COMPARE_GREATERTHANOREQUALTO": "COMPARE_LESSTHAN",
}
_CLAUSES = {"where_clause": "WHERE", "having": "HAVING", "qualify": "QUALIFY", "condition": "ON"}
_WINDOW_FIELDS = ("window_s", "exempt_after_s", "merge_gap_s")
_THRESHOLD_FACTORS = (0.9, 1.1)
_WINDOW_FACTORS = (0.5, 2.0)


class Mutant(NamedTuple):
    """A rule with one deliberate fault, and a text that identifies the fault."""

    fault: str
    rule: Rule


def mutants(rule: Rule) -> list[Mutant]:
    """Return all mutants of a rule, each with a unique name of its fault (a second fault with the same text gets `#2`)."""
    counts: Counter[str] = Counter()
    rule_mutants: list[Mutant] = []
    for fault, wrong in (
        *_mutants_of_sense(rule),
        *_mutants_of_params(rule),
        *_mutants_of_windows(rule),
        *_mutants_of_sql(rule),
    ):
        counts[fault] += 1
        name = fault if counts[fault] == 1 else f"{fault} #{counts[fault]}"
        rule_mutants.append(Mutant(name, msgspec.structs.replace(wrong, id=f"{rule.id}~{len(rule_mutants)}")))
    return rule_mutants


def _mutants_of_sense(rule: Rule) -> Iterator[Mutant]:
    if rule.sense == "holds":
        sql = f"SELECT * REPLACE (NOT holds AS holds) FROM (\n{rule.sections['condition']}\n)"
        yield Mutant("NOT holds", _with_section(rule, "condition", sql))
        return
    for sense in (OPPOSITE[rule.sense], BOUNDARY_SWAP[rule.sense]):
        yield Mutant(f"sense {rule.sense} -> {sense}", msgspec.structs.replace(rule, sense=sense))


def _mutants_of_params(rule: Rule) -> Iterator[Mutant]:
    windows = {getattr(rule, field) for field in _WINDOW_FIELDS}
    for name, param in rule.params.items():
        if isinstance(param.default, bool | str) or param.default == 0:
            continue
        for factor in _WINDOW_FACTORS if name in windows else _THRESHOLD_FACTORS:
            wrong_param = msgspec.structs.replace(param, default=param.default * factor)
            wrong = msgspec.structs.replace(rule, params={**rule.params, name: wrong_param})
            yield Mutant(f"params.{name} * {factor:g}", wrong)


def _mutants_of_windows(rule: Rule) -> Iterator[Mutant]:
    text = rule.path.read_text(encoding="utf-8")
    for field in _WINDOW_FIELDS:
        seconds = getattr(rule, field)
        if isinstance(seconds, str) or not seconds or f"\n-- {field} =" not in text:
            continue
        for factor in _WINDOW_FACTORS:
            yield Mutant(f"{field} * {factor:g}", msgspec.structs.replace(rule, **{field: seconds * factor}))


def _mutants_of_sql(rule: Rule) -> Iterator[Mutant]:
    for section, sql in rule.sections.items():
        tree = syntax_tree(sql)
        for place in _deciding_nodes(tree["statements"][0]["node"]):
            for fault, wrong_tree in _faulty_trees(tree, *place):
                sql_of_mutant = _tree_sql(_with_inner_for_cross_joins(wrong_tree))
                yield Mutant(f"@{section} {fault}", _with_section(rule, section, sql_of_mutant))


def printed_rule(rule: Rule) -> Rule:
    """Return a rule whose SQL is as DuckDB prints its syntax trees: the SQL of each mutant differs from this text by one fault."""
    sections = {name: printed_select(sql) for name, sql in rule.sections.items()}
    return msgspec.structs.replace(rule, id=f"{rule.id}~printed", sections=sections)


def mutants_of_select(select: str) -> list[tuple[str, str]]:
    """Return the mutants of a table's SELECT as (fault, SELECT): comparisons reversed, and thresholds times 0.9 and 1.1."""
    counts: Counter[str] = Counter()
    wrong_selects: list[tuple[str, str]] = []
    tree = _with_inner_for_cross_joins(syntax_tree(select))
    for node_path, node in _deciding_nodes(tree["statements"][0]["node"]):
        for fault, wrong_tree in _trees_with_other_values(tree, node_path, node):
            counts[fault] += 1
            wrong_selects.append((fault if counts[fault] == 1 else f"{fault} #{counts[fault]}", _tree_sql(wrong_tree)))
    return wrong_selects


def printed_select(select: str) -> str:
    """Return a SELECT as DuckDB prints its syntax tree: each mutant differs from this text by one fault."""
    return _tree_sql(_with_inner_for_cross_joins(syntax_tree(select)))


def _with_inner_for_cross_joins(part: Any) -> Any:
    """Return a tree with `INNER JOIN ... ON true` for CROSS JOIN: DuckDB prints a comma, which binds less tightly than the next JOIN."""
    if isinstance(part, list):
        return [_with_inner_for_cross_joins(item) for item in part]
    if not isinstance(part, dict):
        return part
    is_cross_join = part.get("type") == "JOIN" and part.get("ref_type") == "CROSS"
    inner = {"ref_type": "REGULAR", "condition": _parse_expression("true")} if is_cross_join else {}
    return {key: _with_inner_for_cross_joins(value) for key, value in (part | inner).items()}


def _with_section(rule: Rule, name: str, sql: str) -> Rule:
    return msgspec.structs.replace(rule, sections={**rule.sections, name: sql})


def _deciding_nodes(root: Node) -> list[tuple[NodePath, Node]]:
    """Return every node that can change a verdict, in the order of the text, each with its path in the tree."""
    wording = _column_paths(root, frozenset({"reason", "reason_code"}))
    nodes: list[tuple[NodePath, Node]] = []
    todo: list[tuple[NodePath, Any]] = [((), root)]
    while todo:
        node_path, part = todo.pop()
        if node_path in wording:
            continue
        if isinstance(part, dict):
            nodes.append((node_path, part))
            todo += [((*node_path, key), part[key]) for key in reversed(part)]
        elif isinstance(part, list):
            todo += [((*node_path, i), part[i]) for i in range(len(part) - 1, -1, -1)]
    return nodes


def _output_select_paths(root: Node) -> list[NodePath]:
    """Return the paths of the SELECT nodes that produce the statement's columns: the root or the branches of a UNION."""
    if root["type"] == "SELECT_NODE":
        return [()]
    if root["type"] != "SET_OPERATION_NODE":
        return []
    branches: list[NodePath] = (
        [("left",), ("right",)] if "left" in root else [("children", i) for i in range(len(root["children"]))]
    )
    return [(*branch, *node_path) for branch in branches for node_path in _output_select_paths(_node_at(root, branch))]


def _column_paths(root: Node, names: frozenset[str]) -> set[NodePath]:
    """Return the paths of the expressions for the statement's columns with these names."""
    outputs = _output_select_paths(root)
    if not outputs:
        return set()
    first = _node_at(root, outputs[0])["select_list"]
    indices = [i for i, item in enumerate(first) if column_name(item) in names]
    return {(*node_path, "select_list", i) for node_path in outputs for i in indices}


def _node_at(root: Any, node_path: NodePath) -> Any:
    for key in node_path:
        root = root[key]
    return root


def _faulty_trees(tree: Node, node_path: NodePath, node: Node) -> Iterator[tuple[str, Node]]:
    """Yield the faults of one node, each as its text and the changed tree."""
    yield from _trees_with_other_values(tree, node_path, node)
    for key, words in _CLAUSES.items():
        clause = node.get(key)
        if isinstance(clause, dict) and (key != "condition" or node.get("type") == "JOIN"):
            yield from _trees_without_a_term(tree, (*node_path, key), clause, words)
    using = node.get("using_columns") or []
    for i, column in enumerate(using):
        rest = node | {"using_columns": using[:i] + using[i + 1 :]}
        if not rest["using_columns"]:
            rest |= {"condition": _parse_expression("true")}
        yield f"USING without: {column}", _replace_node(tree, node_path, rest)


def _trees_with_other_values(tree: Node, node_path: NodePath, node: Node) -> Iterator[tuple[str, Node]]:
    """Yield a reversed comparison, or a threshold times each factor, as the text of the fault and the changed tree."""
    if (turned := _REVERSED_COMPARISON.get(str(node.get("type")))) is not None:
        yield f"turned: {_node_sql(node)}", _replace_node(tree, node_path, node | {"type": turned})
    if _is_threshold(tree, node_path, node):
        for factor in _THRESHOLD_FACTORS:
            yield f"{_node_sql(node)} * {factor:g}", _replace_node(tree, node_path, _scale_node(node, factor))


def _trees_without_a_term(tree: Node, node_path: NodePath, clause: Node, words: str) -> Iterator[tuple[str, Node]]:
    terms = clause["children"] if clause["type"] == "CONJUNCTION_AND" else [clause]
    for i, term in enumerate(terms):
        rest = terms[:i] + terms[i + 1 :]
        new = clause | {"children": rest} if len(rest) > 1 else rest[0] if rest else _parse_expression("true")
        yield f"{words} without: {_node_sql(term)}", _replace_node(tree, node_path, new)


def _is_threshold(tree: Node, node_path: NodePath, node: Node) -> bool:
    kind = node.get("class")
    if kind == "CONSTANT":
        return _is_threshold_number(node["value"])
    if kind == "FUNCTION" and not node["children"] and node["function_name"].lower() in macros():
        return True
    if kind in {None, "PARAMETER"}:
        return False
    return node_path in _column_paths(tree["statements"][0]["node"], frozenset({"required"}))


def _is_threshold_number(value: Node) -> bool:
    if value.get("is_null") or isinstance(value["value"], bool) or not isinstance(value["value"], int | float):
        return False
    info = value["type"].get("type_info") or {}
    number = abs(value["value"]) / 10 ** info.get("scale", 0)
    return number not in {0, 1, *(10.0**n for n in range(3, 19))}


def _replace_node(tree: Node, node_path: NodePath, new: Node) -> Node:
    new_tree: Node = copy.deepcopy(tree)
    _node_at(new_tree["statements"][0]["node"], node_path[:-1])[node_path[-1]] = copy.deepcopy(new)
    return new_tree


def _scale_node(node: Node, factor: float) -> Node:
    product: Node = copy.deepcopy(_parse_expression(f"1 * {factor}::DOUBLE"))
    product["children"][0] = node | {"alias": ""}
    return product | {"alias": node.get("alias", "")}


@cache
def _parse_expression(sql: str) -> Node:
    node: Node = syntax_tree(f"SELECT {sql}")["statements"][0]["node"]["select_list"][0]
    return node


def _node_sql(node: Node) -> str:
    tree = copy.deepcopy(syntax_tree("SELECT 1"))
    tree["statements"][0]["node"]["select_list"] = [node | {"alias": ""}]
    return _without_brackets(_tree_sql(tree).removeprefix("SELECT "))


def _without_brackets(text: str) -> str:
    """Return an expression without the brackets that DuckDB prints around it."""
    while text.startswith("(") and text.endswith(")") and _has_balanced_brackets(text[1:-1]):
        text = text[1:-1]
    return text


def _has_balanced_brackets(text: str) -> bool:
    depths = list(accumulate(((letter == "(") - (letter == ")") for letter in text), initial=0))
    return min(depths) == depths[-1] == 0


def _tree_sql(tree: Node) -> str:
    return str(parser().execute("SELECT json_deserialize_sql(?::JSON)", [json.dumps(tree)]).fetchall()[0][0])
