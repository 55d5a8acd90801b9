"""The options that several commands have, each written down once: those of `DriveInput`, which every command that reads a log takes."""

from __future__ import annotations

import inspect
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple

import typer

from drivelint import option_values
from drivelint.cli import completion

if TYPE_CHECKING:
    from collections.abc import Callable

Format = Literal["text", "json"]
"""How results are printed on stdout."""
ConvertTarget = Literal["mcap", "parquet"]
ReportFormat = Literal["html", "junit", "sarif", "xqar", "markdown"]
SqlFormat = Literal["text", "csv", "json"]
DiffFormat = Literal["text", "json", "markdown"]
RuleKind = Literal["invariant", "execution", "precondition", "postcondition"]
FailOn = Literal["critical", "major", "minor", "never"]
"""The least severity that makes exit code 1."""
Texts = list[str] | None
"""What an option that may be given several times has."""


def argument(metavar: str, words: str, **more: Any) -> Any:
    """Return an argument of a command with its help."""
    return typer.Argument(metavar=metavar, help=words, **more)


def option(flag: str, metavar: str | None, words: str, **more: Any) -> Any:
    """Return an option of a command with its help."""
    return typer.Option(flag, metavar=metavar, help=words, **more)


def rules(words: str) -> Any:
    """Return the option that names the rules to judge by."""
    return option("--rules", "SEL", words, autocompletion=completion.rule_ids)


def profile(words: str) -> Any:
    """Return the option that names the profiles to judge by."""
    return option("--profile", "NAME", words)


def robustness(words: str) -> Any:
    """Return the option on copies of a drive with recording errors."""
    return option("--robustness/--no-robustness", None, words)


Baseline = Annotated[
    Path | None, option("--baseline", "DIR", "An earlier result: its findings are known, only new ones gate.")
]
Waivers = Annotated[
    Path | None, option("--waivers", "FILE", "TOML of findings that an owner accepts until a day: shown, fail no run.")
]
MinJudged = Annotated[
    float | None,
    option(
        "--min-judged",
        "SHARE",
        "Of the rules that may apply, at least this share must be decided, such as 0.5: else exit code 4.",
        min=0.0,
        max=1.0,
    ),
]
Today = Annotated[
    str | None, option("--today", "DATE", "The day that waivers are held against. Default: the system's.")
]
MemorySize = Annotated[
    str | None,
    option(
        "--memory",
        "SIZE|none",
        "Memory of the database before it uses the disk: 512MB, 2GB; none: 80 % of the machine's. Results do not depend "
        "on it; a step that needs more takes more, with a note. The program itself takes some 300 MB more. Default: 1200MB.",
    ),
]
Evidence = Annotated[
    Path | None,
    option("--evidence", "PACK", "Then pack the result as evidence into this folder, as drivelint pack does."),
]
Sign = Annotated[
    Path | None,
    option(
        "--sign",
        "KEY",
        "Sign the pack with this Ed25519 key: PEM, without a password. A public key (id_ed25519.pub): the one that ssh-agent holds.",
    ),
]
Overwrite = Annotated[
    bool, option("--overwrite", None, "Replace files in it that drivelint is not known to have written.")
]
Ignore = Annotated[
    Texts, option("--ignore", "SEL", "Leave these rules out. Repeatable.", autocompletion=completion.rule_ids)
]
Param = Annotated[Texts, option("--param", "RULE.PARAM=V", "Set a rule's parameter. Repeatable.")]
RulesAsInCheck = Annotated[Texts, rules("Rules to judge by, as in check. Repeatable. Default: those of check.")]
ProfileAsInCheck = Annotated[Texts, profile("As in check. Repeatable.")]
Strict = Annotated[bool, option("--strict", None, "No rule may be unknown: exit code 4.")]
FailOnOption = Annotated[FailOn, option("--fail-on", None, "Least severity that makes exit code 1.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="No progress on stderr.")]
FormatOption = Annotated[Format, option("--format", None, "What is printed on stdout.")]
RulesDirs = Annotated[
    list[Path] | None, option("--rules-dir", "DIR", "Folder with rule packs of your own. Repeatable.")
]
DriveInputValues = dict[str, Any]
"""Fields of `DriveInput` -> their values."""


class _DriveOption(NamedTuple):
    """A field of `DriveInput` as an option, and how its value is read from that of the command line."""

    type: Any
    annotation: Any
    default: Any = None
    parse: Callable[[Any], Any] = lambda value: value


DRIVE_OPTIONS = {
    "map": _DriveOption(
        Path | None,
        option("--map", "MAP", "The road, as OpenDRIVE, Lanelet2, CommonRoad or a SUMO net: most rules need it."),
    ),
    "ego": _DriveOption(str | None, option("--ego", "ID|all", "The vehicle under test, or every vehicle in turn.")),
    "mapping": _DriveOption(
        str | None, option("--mapping", "FILE|NAME", "How a table's columns are read: a TOML file or a shipped name.")
    ),
    "map_offset": _DriveOption(
        str | None,
        option("--map-offset", "DX,DY", "Metres added to the map's coordinates."),
        parse=option_values.parse_offset,
    ),
    "map_dir": _DriveOption(
        Path | None, option("--map-dir", "DIR", "Folder of maps: each log gets its own, by maps.csv, name or place.")
    ),
    "map_origin": _DriveOption(
        str | None,
        option("--map-origin", "LAT,LON", "Where the log's 0,0 is, for a map in degrees (Lanelet2)."),
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
            "Range in which the recorder sees everybody. Default: what the log says, else 50 m.",
            min=0,
        ),
    ),
    "visibility": _DriveOption(
        Literal["line-of-sight", "none"],
        option(
            "--visibility",
            None,
            "Where an unrecorded actor may be. line-of-sight: not in plain view of the recorder (2.5 s after it was lost); none: anywhere.",
        ),
        "line-of-sight",
    ),
    "ego_size": _DriveOption(
        str | None,
        option(
            "--ego-size",
            "L,W[,AHEAD]",
            "The ego's length and width in metres, where the log has none; AHEAD: its centre ahead of the odometry's frame.",
        ),
        parse=option_values.parse_ego_size,
    ),
    "env": _DriveOption(
        Texts,
        option(
            "--env",
            "KEY=VALUE",
            "What holds in the drives: nation, weather, light, vehicle_class, road_type, carriageway, area, engaged. "
            "Repeatable. Counts before what the map or the log says.",
        ),
        parse=lambda words: tuple(words or ()),
    ),
    "topic": _DriveOption(str | None, option("--topic", "NAME", "Read this MCAP topic, where several would do.")),
}


def takes_drive_input(command: Callable[..., None]) -> Callable[..., None]:
    """Replace the parameter `drive` of a command by the command line options of `DriveInput`."""
    signature = inspect.signature(command, eval_str=True)

    @wraps(command)
    def wrapped(**values: Any) -> None:
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
    wrapped.__signature__ = signature.replace(parameters=parameters)  # type: ignore[attr-defined]
    wrapped.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    return wrapped
