"""The options of `DriveInput`, which every command that reads a log takes: one line each."""

from __future__ import annotations

import inspect
from functools import wraps
from typing import TYPE_CHECKING, Any, NamedTuple

from drivelint.cli import options, values

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

DriveInputValues = dict[str, Any]
"""Fields of `DriveInput` -> their values."""


class _Option(NamedTuple):
    """A field of `DriveInput`: its Typer annotation, its default, and how its value is read from that of the command line."""

    annotation: Any
    default: Any = None
    read: Callable[[Any], Any] = lambda value: value


_OPTIONS: Mapping[str, _Option] = {
    "map": _Option(options.MapFile),
    "ego": _Option(options.EgoId),
    "mapping": _Option(options.MappingName),
    "map_offset": _Option(options.MapOffset, None, values.parse_offset),
    "map_dir": _Option(options.MapDir),
    "map_origin": _Option(options.MapOrigin, None, values.parse_origin),
    "handedness": _Option(options.HandednessOption, "auto"),
    "sensor_range_m": _Option(options.SensorRange),
    "visibility": _Option(options.VisibilityOption, "line-of-sight"),
    "ego_size": _Option(options.EgoSize, None, values.parse_ego_size),
    "env": _Option(options.Conditions, None, lambda words: tuple(words or ())),
    "topic": _Option(options.Topic),
}


def takes_drive_input(command: Callable[..., None]) -> Callable[..., None]:
    """Replace the parameter `drive` of a command by the command line options of `DriveInput`."""
    signature = inspect.signature(command, eval_str=True)

    @wraps(command)
    def wrapped(**given: Any) -> None:
        drive = {name: option.read(given.pop(name)) for name, option in _OPTIONS.items()}
        command(**given, drive=drive)

    parameters: list[inspect.Parameter] = []
    for parameter in signature.parameters.values():
        if parameter.name != "drive":
            parameters.append(parameter)
            continue
        for name, option in _OPTIONS.items():
            kind = inspect.Parameter.KEYWORD_ONLY
            parameters.append(inspect.Parameter(name, kind, default=option.default, annotation=option.annotation))
    wrapped.__signature__ = signature.replace(parameters=parameters)  # type: ignore[attr-defined]
    wrapped.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    return wrapped
