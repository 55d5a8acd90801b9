"""The macros of `queries/macros` as syntax trees."""

from __future__ import annotations

import re
from functools import cache
from typing import Any, Final, NamedTuple

from drivelint.sql import syntax
from drivelint.sql.store import macro_definitions

_MACRO: Final = re.compile(r"CREATE OR REPLACE MACRO (\w+)\(([^()]*)\) AS\s+(?!TABLE)(.*)", re.DOTALL | re.IGNORECASE)


class Macro(NamedTuple):
    """A macro of `queries/macros`: its parameters, and the syntax tree of its value."""

    parameters: tuple[str, ...]
    value: dict[str, Any]


@cache
def macro_texts() -> dict[str, tuple[str, str]]:
    """Return name -> (parameters, value) as text, for every macro whose value is an expression."""
    statements = (statement.query for statement in syntax.parser().extract_statements(macro_definitions()))
    matches = (match for text in statements if (match := _MACRO.search(text)))
    return {match[1].lower(): (match[2].lower(), match[3].strip().rstrip(";")) for match in matches}


@cache
def macro(name: str) -> Macro | None:
    """Return a macro of `macro_texts`; None if it has several signatures.

    Macros are parsed one by one: parsing all of them takes longer than checking a rule.
    """
    parameters, value = macro_texts()[name]
    tree = syntax.syntax_tree(f"SELECT {value}")
    if tree["error"]:
        return None
    names = tuple(parameter.strip() for parameter in parameters.split(",") if parameter.strip())
    return Macro(names, tree["statements"][0]["node"]["select_list"][0])
