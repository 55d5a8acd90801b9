"""Finds unknown keys and words in a document, and the most similar known ones."""

from __future__ import annotations

from functools import cache
from types import UnionType
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple, Union, get_args, get_origin, get_type_hints

import msgspec

from drivelint.phrases import hint

if TYPE_CHECKING:
    from collections.abc import Iterator

_FILLED_IN = "line"
"""The key that the reader of the document adds."""


class Problem(NamedTuple):
    """A problem in a document: the keys and list indices that lead to it, and the message."""

    keys: tuple[str | int, ...]
    message: str


def problems(raw: Any, kind: Any, keys: tuple[str | int, ...] = ()) -> Iterator[Problem]:
    """Yield each unknown key of a struct and each unknown word of a Literal. Other errors are reported by msgspec."""
    kinds = _alternative_types(kind)
    if isinstance(raw, dict):
        for struct in (each for each in kinds if isinstance(each, type) and issubclass(each, msgspec.Struct)):
            yield from _problems_of_struct(raw, struct, keys)
        for each in kinds:
            if get_origin(each) is dict:
                for name, value in raw.items():
                    yield from problems(value, get_args(each)[1], (*keys, name))
    elif isinstance(raw, list):
        for each in kinds:
            if get_origin(each) in {list, tuple}:
                for n, value in enumerate(raw):
                    yield from problems(value, get_args(each)[0], (*keys, n))
    elif isinstance(raw, str) and str not in kinds:
        words = [word for each in kinds if get_origin(each) is Literal for word in get_args(each)]
        if words and raw not in words:
            yield Problem(keys, f"{_dotted_name(keys)}: {raw!r}: {hint(raw, words)}")


def _dotted_name(keys: tuple[str | int, ...]) -> str:
    return ".".join(str(key) for key in keys if not isinstance(key, int))


def _problems_of_struct(
    raw: dict[str, Any], struct: type[msgspec.Struct], keys: tuple[str | int, ...]
) -> Iterator[Problem]:
    known = _type_by_key(struct)
    for key, value in raw.items():
        place = (*keys, key)
        if key in known:
            yield from problems(value, known[key], place)
        else:
            near = hint(str(key), [name for name in known if name != _FILLED_IN])
            yield Problem(place, f"unknown key {_dotted_name((*keys, str(key)))!r}: {near}")


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
