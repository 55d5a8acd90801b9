"""Converts the keywords of the Python interface, which are the options of the command line with Python types."""

from __future__ import annotations

import reprlib
from collections.abc import Iterable, Mapping
from os import PathLike, fspath
from pathlib import Path
from typing import Any, Literal, TypeVar, get_args

from drivelint import option_values
from drivelint.errors import UsageError
from drivelint.phrases import hint

AnyPath = str | PathLike[str]
Paths = AnyPath | Iterable[AnyPath]
Texts = str | Iterable[str] | None
Assignments = Mapping[str, object] | Texts
"""Texts KEY=VALUE, or a dictionary."""
Pair = str | tuple[float, float] | None
FailOn = Literal["critical", "major", "minor", "never"]
Handedness = Literal["auto", "lht", "rht"]
Visibility = Literal["line-of-sight", "none"]
ReportFormat = Literal["html", "junit", "sarif", "xqar", "markdown"]
_WORDS = {True: "yes", False: "no"}
_Word = TypeVar("_Word", bound=str)


def to_texts(value: Paths | None) -> tuple[str, ...]:
    """Return one or several texts or paths as a tuple of texts."""
    if value is None:
        return ()
    several = (value,) if isinstance(value, str | PathLike) else tuple(value)
    for each in several:
        if not isinstance(each, str | PathLike):
            raise UsageError(f"{reprlib.repr(each)} is neither a text nor a path")
    return tuple(fspath(each) for each in several)


def to_path(value: AnyPath | None) -> Path | None:
    """Return the value as a `Path`; None stays None."""
    return None if value is None else Path(value)


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


def drive_input_fields(
    *,
    ego: str | int | None,
    mapping: AnyPath | None,
    topic: str | None,
    sensor_range: float | None,
    visibility: Visibility,
    ego_size: str | tuple[float, ...] | None,
    env: Assignments,
) -> dict[str, Any]:
    """Return the fields of `DriveInput` about the log. Errors: `UsageError` for an invalid value."""
    return {
        "ego": None if ego is None else str(ego),
        "mapping": None if mapping is None else fspath(mapping),
        "topic": topic,
        "sensor_range_m": sensor_range,
        "visibility": require_one_of("visibility", visibility, Visibility),
        "ego_size": option_values.parse_ego_size(_comma_separated(ego_size)),
        "env": to_assignments(env),
    }


def map_input_fields(
    *, map_: AnyPath | None, map_dir: AnyPath | None, map_offset: Pair, map_origin: Pair, handedness: Handedness
) -> dict[str, Any]:
    """Return the fields of `DriveInput` about the map. Errors: `UsageError` for an invalid value."""
    return {
        "map": to_path(map_),
        "map_dir": to_path(map_dir),
        "map_offset": option_values.parse_offset(_comma_separated(map_offset)),
        "map_origin": option_values.parse_origin(_comma_separated(map_origin)),
        "handedness": require_one_of("handedness", handedness, Handedness),
    }


def _comma_separated(value: str | tuple[float, ...] | None) -> str | None:
    """Return numbers in the format of the command line, so that the same parser checks them."""
    return value if value is None or isinstance(value, str) else ",".join(map(str, value))
