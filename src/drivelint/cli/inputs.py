"""The options of `DriveInput`, which every command that reads a log takes."""

from __future__ import annotations

import inspect
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple

import typer

from drivelint.cli import values

if TYPE_CHECKING:
    from collections.abc import Callable

DriveInputValues = dict[str, Any]
"""Fields of `DriveInput` -> their values."""


class _Option(NamedTuple):
    """A field of `DriveInput` as an option, and how its value is read from that of the command line."""

    type: Any
    flag: str
    metavar: str | None
    help: str
    default: Any = None
    read: Callable[[Any], Any] = lambda value: value
    least: int | None = None


_OPTIONS = {
    "map": _Option(
        Path | None, "--map", "MAP", "The road, as OpenDRIVE, Lanelet2, CommonRoad or a SUMO net: most rules need it."
    ),
    "ego": _Option(str | None, "--ego", "ID|all", "The vehicle under test, or every vehicle in turn."),
    "mapping": _Option(
        str | None, "--mapping", "FILE|NAME", "How a table's columns are read: a TOML file or a shipped name."
    ),
    "map_offset": _Option(
        str | None, "--map-offset", "DX,DY", "Metres added to the map's coordinates.", read=values.parse_offset
    ),
    "map_dir": _Option(
        Path | None, "--map-dir", "DIR", "Folder of maps: each log gets its own, by maps.csv, name or place."
    ),
    "map_origin": _Option(
        str | None,
        "--map-origin",
        "LAT,LON",
        "Where the log's 0,0 is, for a map in degrees (Lanelet2).",
        read=values.parse_origin,
    ),
    "handedness": _Option(
        Literal["auto", "lht", "rht"], "--handedness", None, "Side of the road that is driven on.", "auto"
    ),
    "sensor_range_m": _Option(
        float | None,
        "--sensor-range",
        "M",
        "Range in which the recorder sees everybody. Default: what the log says, else 50 m.",
        least=0,
    ),
    "visibility": _Option(
        Literal["line-of-sight", "none"],
        "--visibility",
        None,
        "Whoever is not recorded: line-of-sight, not in plain view of the recorder (2.5 s after it was lost); none, anywhere.",
        "line-of-sight",
    ),
    "ego_size": _Option(
        str | None,
        "--ego-size",
        "L,W[,AHEAD]",
        "The ego's length and width in metres, where the log has none; AHEAD: its centre ahead of the odometry's frame.",
        read=values.parse_ego_size,
    ),
    "env": _Option(
        list[str] | None,
        "--env",
        "KEY=VALUE",
        "What holds in the drives: nation, weather, light, vehicle_class, road_type, carriageway, area, engaged. "
        "Repeatable. Counts before what the map or the log says.",
        read=lambda words: tuple(words or ()),
    ),
    "topic": _Option(str | None, "--topic", "NAME", "Read this MCAP topic, where several would do."),
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
            said = typer.Option(option.flag, metavar=option.metavar, help=option.help, min=option.least)
            kind, type_ = inspect.Parameter.KEYWORD_ONLY, Annotated[option.type, said]
            parameters.append(inspect.Parameter(name, kind, default=option.default, annotation=type_))
    wrapped.__signature__ = signature.replace(parameters=parameters)  # type: ignore[attr-defined]
    wrapped.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    return wrapped
