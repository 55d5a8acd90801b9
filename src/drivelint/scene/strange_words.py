"""Finds unknown keys and words in a document, and the most similar known ones."""

from __future__ import annotations

from functools import cache
from types import UnionType
from typing import TYPE_CHECKING, Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

import msgspec

from drivelint.phrases import hint

if TYPE_CHECKING:
    from collections.abc import Iterator

_FILLED_IN = "line"
"""The key that the reader of the document adds."""


def problem_lines(raw: Any, kind: Any, where: str = "") -> Iterator[str]:
    """Yield a line for each unknown key of a struct and each unknown word of a Literal. Other errors are reported by msgspec."""
    kinds = _alternative_types(kind)
    if isinstance(raw, dict):
        for struct in (each for each in kinds if isinstance(each, type) and issubclass(each, msgspec.Struct)):
            yield from _problem_lines_of_struct(raw, struct, where)
        for each in kinds:
            if get_origin(each) is dict:
                for name, value in raw.items():
                    yield from problem_lines(value, get_args(each)[1], f"{where}{name}.")
    elif isinstance(raw, list):
        for each in kinds:
            if get_origin(each) in {list, tuple}:
                for value in raw:
                    yield from problem_lines(value, get_args(each)[0], where)
    elif isinstance(raw, str) and str not in kinds:
        words = [word for each in kinds if get_origin(each) is Literal for word in get_args(each)]
        if words and raw not in words:
            yield f"{where.rstrip('.')}: {raw!r}: {hint(raw, words)}"


def _problem_lines_of_struct(raw: dict[str, Any], struct: type[msgspec.Struct], where: str) -> Iterator[str]:
    known = _type_by_key(struct)
    for key, value in raw.items():
        if key in known:
            yield from problem_lines(value, known[key], f"{where}{key}.")
        else:
            yield f"unknown key {where + str(key)!r}: {hint(str(key), [name for name in known if name != _FILLED_IN])}"


@cache
def _type_by_key(struct: type[msgspec.Struct]) -> dict[str, Any]:
    hints = get_type_hints(struct, include_extras=True)
    return {info.encode_name: hints[info.name] for info in msgspec.structs.fields(struct)}


def _alternative_types(kind: Any) -> list[Any]:
    if get_origin(kind) is Annotated:
        return _alternative_types(get_args(kind)[0])
    if get_origin(kind) in {Union, UnionType}:
        return [each for part in get_args(kind) for each in _alternative_types(part)]
    return [kind]
