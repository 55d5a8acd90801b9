"""The options that several commands have, and the words they take: each written down once."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

Format = Literal["text", "json"]
"""How results are printed on stdout."""
ConvertTarget = Literal["mcap", "parquet"]
ReportFormat = Literal["html", "junit", "sarif", "xqar", "markdown"]
DiffFormat = Literal["text", "json", "markdown"]
RuleKind = Literal["invariant", "execution", "precondition", "postcondition"]
FailOn = Literal["critical", "major", "minor", "never"]
"""The least severity that makes exit code 1."""
Visibility = Literal["line-of-sight", "none"]
"""What a log that does not record an actor says about it."""
Handedness = Literal["auto", "lht", "rht"]

MapFile = Annotated[
    Path | None,
    typer.Option(
        "--map", metavar="MAP", help="The road, as OpenDRIVE, Lanelet2, CommonRoad or a SUMO net: most rules need it."
    ),
]
EgoId = Annotated[
    str | None, typer.Option("--ego", metavar="ID|all", help="The vehicle under test, or every vehicle in turn.")
]
MappingName = Annotated[
    str | None,
    typer.Option(
        "--mapping", metavar="FILE|NAME", help="How a table's columns are read: a TOML file or a shipped name."
    ),
]
MapOffset = Annotated[
    str | None, typer.Option("--map-offset", metavar="DX,DY", help="Metres added to the map's coordinates.")
]
MapDir = Annotated[
    Path | None,
    typer.Option("--map-dir", metavar="DIR", help="Folder of maps: each log gets its own, by maps.csv, name or place."),
]
MapOrigin = Annotated[
    str | None,
    typer.Option("--map-origin", metavar="LAT,LON", help="Where the log's 0,0 is, for a map in degrees (Lanelet2)."),
]
HandednessOption = Annotated[Handedness, typer.Option("--handedness", help="Side of the road that is driven on.")]
SensorRange = Annotated[
    float | None,
    typer.Option(
        "--sensor-range",
        metavar="M",
        min=0,
        help="Range in which the recorder sees everybody. Default: what the log says, else 50 m.",
    ),
]
VisibilityOption = Annotated[
    Visibility,
    typer.Option(
        "--visibility",
        help="Whoever is not recorded: line-of-sight, not in plain view of the recorder (2.5 s after it was lost); none, anywhere.",
    ),
]
EgoSize = Annotated[
    str | None,
    typer.Option(
        "--ego-size",
        metavar="L,W[,AHEAD]",
        help="The ego's length and width in metres, where the log has none; AHEAD: its centre ahead of the odometry's frame.",
    ),
]
Conditions = Annotated[
    list[str] | None,
    typer.Option(
        "--env",
        metavar="KEY=VALUE",
        help="What holds in the drives: nation, weather, light, vehicle_class, road_type, carriageway, area, engaged. "
        "Repeatable. Counts before what the map or the log says.",
    ),
]
Topic = Annotated[
    str | None, typer.Option("--topic", metavar="NAME", help="Read this MCAP topic, where several would do.")
]
Baseline = Annotated[
    Path | None,
    typer.Option("--baseline", metavar="DIR", help="An earlier result: its findings are known, only new ones gate."),
]
Waivers = Annotated[
    Path | None,
    typer.Option("--waivers", metavar="FILE", help="TOML of findings that somebody answers for: shown, but no gate."),
]
Today = Annotated[
    str | None,
    typer.Option("--today", metavar="DATE", help="The day that waivers are held against. Default: the system's."),
]
MemorySize = Annotated[
    str | None,
    typer.Option(
        "--memory",
        metavar="SIZE|none",
        help="What the database keeps to before it uses the disk: 512MB, 2GB; none, 80 % of the machine's. Results do not depend "
        "on it; what cannot go to disk takes more, which is said. The program itself takes some 300 MB more. Default: 1200MB.",
    ),
]
FormatOption = Annotated[Format, typer.Option("--format", help="What is printed on stdout.")]
RulesDirs = Annotated[
    list[Path] | None,
    typer.Option("--rules-dir", metavar="DIR", help="Folder with rule packs of your own. Repeatable."),
]
