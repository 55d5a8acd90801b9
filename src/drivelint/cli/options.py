"""Options that several commands share. The options of `DriveInput` belong to every command that reads a log."""

from __future__ import annotations

import inspect
from enum import StrEnum
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple

import typer

from drivelint import option_values
from drivelint.cli import completion

if TYPE_CHECKING:
    from collections.abc import Callable


class ReportFormat(StrEnum):
    """Formats of a report; an enumeration, because Typer has no lists of a `Literal`."""

    HTML = "html"
    JUNIT = "junit"
    SARIF = "sarif"
    XQAR = "xqar"
    MARKDOWN = "markdown"


Format = Literal["text", "json"]
"""Formats of a result on stdout."""
ConvertTarget = Literal["mcap", "parquet"]
SqlFormat = Literal["text", "csv", "json"]
DiffFormat = Literal["text", "json", "markdown"]
RuleKind = Literal["invariant", "execution", "precondition", "postcondition"]
FailOn = Literal["critical", "major", "minor", "never"]
"""The lowest severity that causes exit code 1."""
Texts = list[str] | None
"""The value of an option that may be repeated."""


def argument(metavar: str, help_text: str, **settings: Any) -> Any:
    """Return an argument of a command with its help."""
    return typer.Argument(metavar=metavar, help=help_text, **settings)


def option(flag: str, metavar: str | None, help_text: str, **settings: Any) -> Any:
    """Return an option of a command with its help."""
    return typer.Option(flag, metavar=metavar, help=help_text, **settings)


def rules_option(help_text: str) -> Any:
    """Return the option `--rules`, which selects the rules to judge by."""
    return option("--rules", "SEL", help_text, autocompletion=completion.rule_ids)


def profile_option(help_text: str) -> Any:
    """Return the option `--profile`, which selects the profiles to judge by."""
    return option("--profile", "NAME", help_text)


def robustness_option(help_text: str) -> Any:
    """Return the option `--robustness`: whether to judge copies of a drive with recording errors."""
    return option("--robustness/--no-robustness", None, help_text)


Baseline = Annotated[
    Path | None,
    option("--baseline", "DIR", "An earlier result. Its findings are known; only new ones can fail the run."),
]
Waivers = Annotated[
    Path | None,
    option(
        "--waivers",
        "FILE",
        "TOML file of findings that an owner accepts until a date. They are shown, but do not fail the run.",
    ),
]
MinJudged = Annotated[
    float | None,
    option(
        "--min-judged",
        "SHARE",
        "Exit code 4 if less than this share of the rules that may apply is decided, such as 0.5.",
        min=0.0,
        max=1.0,
    ),
]
Today = Annotated[
    str | None, option("--today", "DATE", "The date that decides whether a waiver has expired. Default: today.")
]
MemorySize = Annotated[
    str | None,
    option(
        "--memory",
        "SIZE|none",
        "Memory of the database before it uses the disk: 512MB, 2GB; none: 80 % of the machine's. Results do not depend "
        "on it. If a step needs more, it takes more, with a note. The program itself takes some 300 MB more. Default: 1200MB.",
    ),
]
Evidence = Annotated[
    Path | None,
    option("--evidence", "PACK", "Also pack the result as evidence into this folder, as drivelint pack does."),
]
Sign = Annotated[
    Path | None,
    option(
        "--sign",
        "KEY",
        "Sign the pack with this Ed25519 key: PEM, without a password. Or the public key (id_ed25519.pub) of a key in ssh-agent.",
    ),
]
Overwrite = Annotated[bool, option("--overwrite", None, "Also replace files in it that drivelint did not write.")]
Ignore = Annotated[
    Texts, option("--ignore", "SEL", "Leave these rules out. Repeatable.", autocompletion=completion.rule_ids)
]
Param = Annotated[Texts, option("--param", "RULE.PARAM=V", "Set a rule's parameter. Repeatable.")]
RulesAsInCheck = Annotated[Texts, rules_option("Rules to judge by, as in check. Repeatable. Default: those of check.")]
ProfileAsInCheck = Annotated[Texts, profile_option("As in check. Repeatable.")]
Strict = Annotated[bool, option("--strict", None, "Exit code 4 if a rule is unknown.")]
FailOnOption = Annotated[FailOn, option("--fail-on", None, "Lowest severity that causes exit code 1.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="No progress on stderr.")]
FormatOption = Annotated[Format, option("--format", None, "Format of the output on stdout.")]
RulesDirs = Annotated[
    list[Path] | None, option("--rules-dir", "DIR", "Folder with rule packs of your own. Repeatable.")
]
DriveInputValues = dict[str, Any]
"""Fields of `DriveInput` -> their values."""


class _DriveOption(NamedTuple):
    """A command line option for a field of `DriveInput`, and the function that parses its value."""

    type: Any
    annotation: Any
    default: Any = None
    parse: Callable[[Any], Any] = lambda value: value


DRIVE_OPTIONS = {
    "map": _DriveOption(
        Path | None,
        option(
            "--map", "MAP", "The map of the road: OpenDRIVE, Lanelet2, CommonRoad or a SUMO net. Most rules need it."
        ),
    ),
    "ego": _DriveOption(str | None, option("--ego", "ID|all", "The vehicle under test, or every vehicle in turn.")),
    "mapping": _DriveOption(
        str | None,
        option(
            "--mapping", "FILE|NAME", "The meaning of a table's columns: a TOML file, or the name of a shipped mapping."
        ),
    ),
    "map_offset": _DriveOption(
        str | None,
        option("--map-offset", "DX,DY", "Metres added to the map's coordinates."),
        parse=option_values.parse_offset,
    ),
    "map_dir": _DriveOption(
        Path | None,
        option("--map-dir", "DIR", "Folder of maps. Each log gets its map by maps.csv, by name or by place."),
    ),
    "map_origin": _DriveOption(
        str | None,
        option("--map-origin", "LAT,LON", "Position of the log's 0,0, for a map in degrees (Lanelet2)."),
        parse=option_values.parse_origin,
    ),
    "handedness": _DriveOption(
        Literal["auto", "lht", "rht"], option("--handedness", None, "Side of the road that is driven on."), "auto"
    ),
    "sensor_range_m": _DriveOption(
        float | None,
        option(
            "--sensor-range",
            "M",
            "Range in which the recorder sees every actor. Default: the value in the log, else 50 m.",
            min=0,
        ),
    ),
    "visibility": _DriveOption(
        Literal["line-of-sight", "none"],
        option(
            "--visibility",
            None,
            "Where an unrecorded actor may be. line-of-sight: not in plain view, from 2.5 s after it was lost; none: anywhere.",
        ),
        "line-of-sight",
    ),
    "ego_size": _DriveOption(
        str | None,
        option(
            "--ego-size",
            "L,W[,AHEAD]",
            "The ego's length and width in metres, if the log has none. AHEAD: distance of its centre ahead of the odometry's frame.",
        ),
        parse=option_values.parse_ego_size,
    ),
    "env": _DriveOption(
        Texts,
        option(
            "--env",
            "KEY=VALUE",
            "A condition of the drives: nation, weather, light, vehicle_class, road_type, carriageway, area, engaged. "
            "Repeatable. Takes precedence over the map and the log.",
        ),
        parse=lambda words: tuple(words or ()),
    ),
    "topic": _DriveOption(str | None, option("--topic", "NAME", "The MCAP topic to read, if several are possible.")),
}


def add_drive_options(command: Callable[..., None]) -> Callable[..., None]:
    """Replace the parameter `drive` of a command by the command line options of `DriveInput`."""
    signature = inspect.signature(command, eval_str=True)

    @wraps(command)
    def command_with_drive(**values: Any) -> None:
        drive = {name: each.parse(values.pop(name)) for name, each in DRIVE_OPTIONS.items()}
        command(**values, drive=drive)

    parameters: list[inspect.Parameter] = []
    for parameter in signature.parameters.values():
        if parameter.name != "drive":
            parameters.append(parameter)
            continue
        for name, each in DRIVE_OPTIONS.items():
            kind, type_ = inspect.Parameter.KEYWORD_ONLY, Annotated[each.type, each.annotation]
            parameters.append(inspect.Parameter(name, kind, default=each.default, annotation=type_))
    command_with_drive.__signature__ = signature.replace(parameters=parameters)  # type: ignore[attr-defined]
    command_with_drive.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    return command_with_drive
