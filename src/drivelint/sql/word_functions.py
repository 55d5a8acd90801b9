"""The possible words that functions of DuckDB return, and the values that they compare."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.sql.word_types import (
    ListOf,
    WordType,
    concatenation,
    possible_words_of_item,
    possible_words_of_member,
    union,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    Kinds = Sequence[WordType]

_FUNCTIONS_RETURNING_FIRST_ARGUMENT: Final = (
    *(
        "any_value",
        "arg_max",
        "arg_min",
        "first",
        "first_value",
        "last",
        "last_value",
        "max",
        "max_by",
        "min",
        "min_by",
        "mode",
    ),
    *(
        "nth_value",
        "nullif",
        "list_distinct",
        "list_reverse",
        "list_slice",
        "list_sort",
        "list_unique",
        "list_where",
        "array_slice",
    ),
)
_ITEM_FUNCTIONS: Final = ("unnest", "list_extract", "list_element", "element_at", "list_min", "list_max", "flatten")
_MEMBERSHIP_FUNCTIONS: Final = frozenset({"contains", "list_contains", "list_has", "list_position", "list_indexof"})
_SET_FUNCTIONS: Final = frozenset({"&&", "@>", "list_has_any", "list_has_all", "list_intersect"})


def _possible_words_of_concatenation(kinds: Kinds) -> WordType:
    return union(kinds) if any(isinstance(kind, ListOf) for kind in kinds) else concatenation(kinds)


_POSSIBLE_WORDS_BY_FUNCTION: Final[Mapping[str, Callable[[Kinds], WordType]]] = {
    **dict.fromkeys(_FUNCTIONS_RETURNING_FIRST_ARGUMENT, lambda kinds: kinds[0]),
    **dict.fromkeys(("lag", "lead"), lambda kinds: union([kinds[0], *kinds[2:3]])),
    **dict.fromkeys(("coalesce", "greatest", "least", "ifnull"), union),
    **dict.fromkeys(("list", "array_agg", "list_value", "array_value"), lambda kinds: ListOf(union(kinds))),
    **dict.fromkeys(_ITEM_FUNCTIONS, lambda kinds: possible_words_of_item(kinds[0])),
    **dict.fromkeys(("||", "concat", "list_concat"), _possible_words_of_concatenation),
    **dict.fromkeys(("struct_extract", "array_extract"), lambda kinds: possible_words_of_member(*kinds)),
}


def possible_words_of_call(function: str, kinds: Kinds) -> WordType:
    """Return the possible values of a function for arguments with the possible values `kinds`; None: unknown."""
    return _POSSIBLE_WORDS_BY_FUNCTION[function](kinds) if function in _POSSIBLE_WORDS_BY_FUNCTION and kinds else None


def compared_words(function: str, kinds: Kinds) -> tuple[WordType, WordType] | None:
    """Return the two values that a function compares; None if it compares none.

    List functions compare an item of the list with a value, or with an item of a second list.
    """
    if len(kinds) != 2:
        return None
    first, second = kinds
    if function in _MEMBERSHIP_FUNCTIONS:
        return possible_words_of_item(first), second
    if function in _SET_FUNCTIONS:
        return possible_words_of_item(first), possible_words_of_item(second)
    return (first, second) if function == "nullif" else None
