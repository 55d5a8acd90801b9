"""Refuses arguments of the wrong type, with an error that names the argument: values in a notebook are often texts."""

from __future__ import annotations

import inspect
import reprlib
from collections.abc import Callable, Collection, Iterable, Mapping
from datetime import date
from functools import update_wrapper, wraps
from numbers import Integral, Real
from os import PathLike
from typing import Any, Final, ParamSpec, TypeVar

import numpy as np

from drivelint.errors import UsageError
from drivelint.options.declaration import python_signature
from drivelint.phrases import hint

_P = ParamSpec("_P")
_R = TypeVar("_R")
_A = TypeVar("_A")


def _is_path(value: object) -> bool:
    return isinstance(value, str | PathLike)


def _is_number(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


def _are_numbers(value: object) -> bool:
    return isinstance(value, Collection) and not isinstance(value, str | bytes) and all(map(_is_number, value))


def _is_path_or_iterable(value: object) -> bool:
    return _is_path(value) or isinstance(value, Iterable)  # items of an iterator are checked later, when they are read


_CHECK_OF_TYPE: Final[dict[str, tuple[Callable[[Any], bool], str]]] = {
    "None": (lambda value: value is None, "None"),
    "bool": (lambda value: isinstance(value, bool | np.bool_), "True or False"),
    "str": (lambda value: isinstance(value, str), "a text"),
    "int": (lambda value: isinstance(value, Integral) and not isinstance(value, bool), "a whole number"),
    "float": (_is_number, "a number"),
    "date": (lambda value: isinstance(value, date), "a date"),
    "AnyPath": (_is_path, "a path"),
    "Paths": (_is_path_or_iterable, "a path, or several"),
    "Texts": (lambda value: value is None or _is_path_or_iterable(value), "a text, or several"),
    "Assignments": (
        lambda value: value is None or _is_path_or_iterable(value) or isinstance(value, Mapping),
        "texts KEY=VALUE, or a dictionary",
    ),
    "Pair": (lambda value: value is None or isinstance(value, str) or _are_numbers(value), "two numbers"),
    "tuple[float, ...]": (_are_numbers, "numbers"),
}
"""Annotation in a signature -> test of a value, and the name of the type in messages. `require_one_of` checks `Literal` types."""


def with_argument_checks(function: Callable[_P, _R]) -> Callable[_P, _R]:
    """Return the function with argument checks: it raises `UsageError` for an unknown keyword or an argument of another type.

    Annotations are texts, since the functions' modules import `annotations` from `__future__`.
    """
    signature = inspect.signature(function)
    kinds = {name: str(parameter.annotation).split(" | ") for name, parameter in signature.parameters.items()}
    names = [
        name
        for name, parameter in signature.parameters.items()
        if name != "self" and parameter.kind != parameter.POSITIONAL_ONLY
    ]
    type_names = {name: parts for name, parts in kinds.items() if set(parts) <= _CHECK_OF_TYPE.keys()}

    @wraps(function)
    def checked_call(*args: _P.args, **keywords: _P.kwargs) -> _R:
        if unknown := keywords.keys() - set(names):
            word = min(unknown)
            raise UsageError(f"{function.__name__}() has no argument {word!r}: {hint(word, names)}")
        for name, value in signature.bind(*args, **keywords).arguments.items():
            if name in type_names and not any(_CHECK_OF_TYPE[part][0](value) for part in type_names[name]):
                type_texts = [_CHECK_OF_TYPE[part][1] for part in type_names[name] if part != "None"]
                raise UsageError(f"{name}={reprlib.repr(value)}: give {' or '.join(type_texts)}")
        return function(*args, **keywords)

    return checked_call


def with_arguments_of(arguments: Callable[_P, _A]) -> Callable[[Callable[[_A], _R]], Callable[_P, _R]]:
    """Return a decorator: the function of a class of arguments becomes a function of its fields, with argument checks."""

    def decorate(function: Callable[[_A], _R]) -> Callable[_P, _R]:
        def call(*args: _P.args, **keywords: _P.kwargs) -> _R:
            return function(arguments(*args, **keywords))

        update_wrapper(call, function, updated=())
        vars(call).pop("__wrapped__")
        signature = python_signature(arguments, function.__annotations__["return"])  # type: ignore[arg-type]
        vars(call)["__signature__"] = signature
        return with_argument_checks(call)

    return decorate
