"""The types of options in Python, the types that the command line reads instead, and the conversion to values for the engine."""

from __future__ import annotations

import reprlib
from collections.abc import Callable, Iterable, Mapping
from datetime import date
from enum import StrEnum
from os import PathLike, fspath
from pathlib import Path
from typing import Any, Final, Literal, NamedTuple, TypeVar, get_args

from drivelint.errors import UsageError
from drivelint.phrases import hint

AnyPath = str | PathLike[str]
Paths = AnyPath | Iterable[AnyPath]
Texts = str | Iterable[str] | None
Assignments = Mapping[str, object] | Texts
"""Texts KEY=VALUE, or a dictionary."""
Pair = str | tuple[float, float] | None
FailOn = Literal["critical", "major", "minor", "never"]
"""The lowest severity that causes exit code 1."""
Handedness = Literal["auto", "lht", "rht"]
Visibility = Literal["line-of-sight", "none"]
ReportFormat = Literal["html", "junit", "sarif", "xqar", "markdown"]
Format = Literal["text", "json"]
"""Formats of a result on stdout."""
_WORDS = {True: "yes", False: "no"}
_Word = TypeVar("_Word", bound=str)


class ReportFile(StrEnum):
    """`ReportFormat` as an enumeration, because Typer has no lists of a `Literal`."""

    HTML = "html"
    JUNIT = "junit"
    SARIF = "sarif"
    XQAR = "xqar"
    MARKDOWN = "markdown"


def to_texts(value: Paths | None) -> tuple[str, ...]:
    """Return one or several texts or paths as a tuple of texts."""
    if value is None:
        return ()
    several = (value,) if isinstance(value, str | PathLike) else tuple(value)
    for path in several:
        if not isinstance(path, str | PathLike):
            raise UsageError(f"{reprlib.repr(path)} is neither a text nor a path")
    return tuple(fspath(path) for path in several)


def to_path(value: AnyPath | None) -> Path | None:
    """Return the value as a `Path`; None stays None."""
    return None if value is None else Path(value)


def to_paths(value: Paths | None) -> tuple[Path, ...]:
    """Return one or several paths as a tuple of paths."""
    return tuple(Path(text) for text in to_texts(value))


def to_text(value: AnyPath | int | None) -> str | None:
    """Return a name or a path as a text; None stays None."""
    if value is None:
        return None
    return fspath(value) if isinstance(value, PathLike) else str(value)


def to_float(value: float | None) -> float | None:
    """Return a number as a `float`; None stays None."""
    return None if value is None else float(value)


def to_assignments(value: Assignments) -> tuple[str, ...]:
    """Return `KEY=VALUE` for each entry of a dictionary; texts are returned unchanged."""
    if isinstance(value, Mapping):
        return tuple(f"{key}={_WORDS[v] if isinstance(v, bool) else v}" for key, v in value.items())
    return to_texts(value)


def require_one_of(name: str, value: _Word, literal_type: Any) -> _Word:
    """Return the word, if the `Literal` type `literal_type` contains it. Errors: `UsageError` with the nearest valid word."""
    if value not in get_args(literal_type):
        raise UsageError(f"{name}={value!r}: {hint(str(value), get_args(literal_type))}")
    return value


def to_comma_separated(value: str | tuple[float, ...] | None) -> str | None:
    """Return numbers in the format of the command line, so that the same parser checks them."""
    return value if value is None or isinstance(value, str) else ",".join(map(str, value))


class OptionType(NamedTuple):
    """A type of options: its name in Python, the type that Typer reads, and the conversion of both to the engine's value."""

    name: str
    command_line_type: Any
    convert: Callable[[Any], Any] = lambda value: value


NAME_OR_PATH: Final = OptionType("AnyPath | None", str | None, to_text)
"""A path, or a name that drivelint knows."""
OPTION_TYPES: Final[dict[Any, OptionType]] = {
    Paths: OptionType("Paths", list[str], to_texts),
    Paths | None: OptionType("Paths | None", list[Path] | None, to_paths),
    AnyPath: OptionType("AnyPath", Path, Path),
    AnyPath | None: OptionType("AnyPath | None", Path | None, to_path),
    Texts: OptionType("Texts", list[str] | None, to_texts),
    Assignments: OptionType("Assignments", list[str] | None, to_assignments),
    Pair: OptionType("Pair", str | None, to_comma_separated),
    str | tuple[float, ...] | None: OptionType("str | tuple[float, ...] | None", str | None, to_comma_separated),
    str | int | None: OptionType("str | int | None", str | None, to_text),
    date | str | None: OptionType("date | str | None", str | None),
    str | None: OptionType("str | None", str | None),
    float | None: OptionType("float | None", float | None),
    float: OptionType("float", float),
    bool: OptionType("bool", bool),
    bool | None: OptionType("bool | None", bool | None),
    **{
        kind: OptionType(name, kind)
        for name, kind in (
            ("FailOn", FailOn),
            ("Handedness", Handedness),
            ("Visibility", Visibility),
            ("Format", Format),
            ("int", int),
            ("list[ReportFile] | None", list[ReportFile] | None),
        )
    },
}
"""Type of an option's annotation -> its names and conversion."""
