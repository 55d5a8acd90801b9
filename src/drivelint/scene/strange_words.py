"""Finds unknown and missing keys, unknown words and values of a wrong kind in a document, and the most similar known words."""

from __future__ import annotations

from functools import cache
from types import NoneType, UnionType
from typing import (
    TYPE_CHECKING,
    Annotated,
    Any,
    Final,
    Literal,
    NamedTuple,
    Union,
    get_args,
    get_origin,
    get_type_hints,
)

import msgspec

from drivelint.phrases import hint, plural

if TYPE_CHECKING:
    from collections.abc import Iterator

_FILLED_IN = "line"
"""The key that the reader of the document adds."""
_KIND_BY_TYPE: Final[dict[Any, str]] = {
    bool: "yes or no", NoneType: "nothing", int: "a number", float: "a number", list: "a list", tuple: "a list", dict: "keys with values"
}  # fmt: skip
"""The type of a value -> its kind in words; all others are text."""


class Problem(NamedTuple):
    """A problem in a document: the keys and list indices that lead to it, and the message."""

    keys: tuple[str | int, ...]
    message: str


def problems(raw: Any, kind: Any, keys: tuple[str | int, ...] = ()) -> Iterator[Problem]:
    """Yield each unknown or missing key of a struct, unknown word of a Literal, and value of a wrong kind or length.

    Other errors, such as a number below its least value, are reported by msgspec.
    """
    if (message := _kind_problem(raw, kind)) is not None:
        yield Problem(keys, f"{_dotted_name(keys)}: {message}")
        return
    kinds = _alternative_types(kind)
    if isinstance(raw, dict):
        for struct in (part for part in kinds if isinstance(part, type) and issubclass(part, msgspec.Struct)):
            yield from _problems_of_struct(raw, struct, keys)
        for part in kinds:
            if get_origin(part) is dict:
                for name, value in raw.items():
                    yield from problems(value, get_args(part)[1], (*keys, name))
    elif isinstance(raw, list):
        for part in kinds:
            if get_origin(part) in {list, tuple}:
                item_types = [item for item in get_args(part) if item is not Ellipsis]
                for n, value in enumerate(raw):
                    yield from problems(value, item_types[min(n, len(item_types) - 1)], (*keys, n))


def _kind_problem(raw: Any, kind: Any) -> str | None:
    """Return what is wrong with a value itself, in words: its kind, its length, or its word; None: nothing."""
    kinds = _alternative_types(kind)
    kind_names = {_kind_of_type(part) for part in kinds}
    if _kind_of_value(raw) not in kind_names:
        here = "nothing" if raw is None else f"{raw!r} is {_kind_of_value(raw)}"
        return f"{here}: write {' or '.join(sorted(kind_names - {'nothing'}))} (drivelint docs scenes)"
    length = _exact_length(kind)
    if isinstance(raw, list) and length not in {None, len(raw)}:
        return f"{raw} has {plural(len(raw), 'value')}: write {length}"
    words = [word for part in kinds if get_origin(part) is Literal for word in get_args(part)]
    if isinstance(raw, str) and str not in kinds and words and raw not in words:
        return f"{raw!r}: {hint(raw, words)}"
    return None


def _dotted_name(keys: tuple[str | int, ...]) -> str:
    return ".".join(str(key) for key in keys if not isinstance(key, int))


def _problems_of_struct(
    raw: dict[str, Any], struct: type[msgspec.Struct], keys: tuple[str | int, ...]
) -> Iterator[Problem]:
    types = _type_by_key(struct)
    if raw.keys() <= types.keys():
        for name in sorted(_required_keys(struct) - raw.keys()):
            yield Problem(
                keys, f"{_dotted_name(keys) or 'the file'}: the key {name!r} is missing (drivelint docs scenes)"
            )
    for key, value in raw.items():
        place = (*keys, key)
        if key in types:
            yield from problems(value, types[key], place)
        else:
            near = hint(str(key), [name for name in types if name != _FILLED_IN])
            yield Problem(place, f"unknown key {_dotted_name((*keys, str(key)))!r}: {near}")


@cache
def _type_by_key(struct: type[msgspec.Struct]) -> dict[str, Any]:
    hints = get_type_hints(struct, include_extras=True)
    return {info.encode_name: hints[info.name] for info in msgspec.structs.fields(struct)}


def _required_keys(struct: type[msgspec.Struct]) -> set[str]:
    return {info.encode_name for info in msgspec.structs.fields(struct) if info.required}


def _kind_of_value(value: Any) -> str:
    """Return the kind of a YAML value, in words."""
    return _KIND_BY_TYPE.get(type(value), "text")


def _kind_of_type(kind: Any) -> str:
    """Return the kind of the values of a type, in the words of `_kind_of_value`."""
    plain = get_origin(kind) or kind
    if isinstance(plain, type) and issubclass(plain, msgspec.Struct):
        plain = dict
    return _KIND_BY_TYPE.get(plain, "text")


def _exact_length(kind: Any) -> int | None:
    """Return the length that a list must have; None: any."""
    origin, parts = get_origin(kind), get_args(kind)
    if origin in {Union, UnionType}:
        return next((length for part in parts if (length := _exact_length(part)) is not None), None)
    if origin is Annotated:
        return next((meta.min_length for meta in parts[1:] if meta.min_length == meta.max_length), None)
    return len(parts) if origin is tuple and Ellipsis not in parts else None


def _alternative_types(kind: Any) -> list[Any]:
    if get_origin(kind) is Annotated:
        return _alternative_types(get_args(kind)[0])
    if get_origin(kind) in {Union, UnionType}:
        return [alternative for part in get_args(kind) for alternative in _alternative_types(part)]
    return [kind]
