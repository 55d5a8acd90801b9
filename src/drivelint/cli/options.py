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
