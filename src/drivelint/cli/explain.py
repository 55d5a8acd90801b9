"""`drivelint explain`."""

from __future__ import annotations

from pathlib import Path  # noqa: TC003 - Typer looks the annotations up
from typing import Annotated

import typer

from drivelint.cli import options, values
from drivelint.cli.console import print_rich, run_interruptible


def explain(
    name: Annotated[
        str,
        typer.Argument(
            metavar="FINDING",
            help="A finding's id or how it begins; or, for any verdict, RULE or RULE@DRIVE, or how they begin.",
        ),
    ],
    *,
    folder: Annotated[Path, typer.Option("--in", metavar="DIR", help="What check --out wrote.")],
    profile: Annotated[
        str | None, typer.Option("--profile", metavar="NAME", help="The rule's verdict for this profile.")
    ] = None,
    object_: Annotated[
        str | None, typer.Option("--object", metavar="ID", help="The rule's verdict about this actor.")
    ] = None,
    ego: Annotated[str | None, typer.Option("--ego", metavar="ID", help="The rule's verdict on this ego.")] = None,
    verdict: Annotated[
        str | None, typer.Option("--verdict", metavar="WORD", help="A verdict of this kind, such as unknown.")
    ] = None,
    at: Annotated[
        float | None, typer.Option("--at", metavar="S", help="The rule's verdict about this second of the drive.")
    ] = None,
    trace: Annotated[
        Path | None, typer.Option("--trace", metavar="FILE", help="Where the log is, if it was moved.")
    ] = None,
    map_: Annotated[
        Path | None, typer.Option("--map", metavar="MAP", help="Where the map is, if it was moved.")
    ] = None,
    position: Annotated[
        float, typer.Option("--sigma-position", metavar="M", min=0, help="Standard error of each actor's position.")
    ] = 0.1,
    time: Annotated[
        float, typer.Option("--sigma-time", metavar="S", min=0, help="Standard error of each actor's clock.")
    ] = 0.05,
    of_map: Annotated[
        float, typer.Option("--sigma-map", metavar="M", min=0, help="Standard error of where the map lies.")
    ] = 0.1,
    samples: Annotated[
        int, typer.Option("--samples", min=0, max=100_000, help="Copies with such errors; 0 leaves them out.")
    ] = 100,
    seed: Annotated[int, typer.Option("--seed", min=0, help="Another one draws other errors.")] = 0,
    memory: options.MemorySize = None,
    format_: options.FormatOption = "text",
) -> None:
    """Show why one verdict is what it is.

    The clause, the SQL with its numbers, the rows that it read, the margin over time, the least change of a number that
    changes the verdict, and how often it stays the same when positions, clocks and map are a little off. Of several
    verdicts of a rule the worst is shown, unless --ego, --verdict, --profile, --object or --at choose.

    The drive is judged anew by that rule, from the database that check --keep-db kept, else from its log.
    """
    from drivelint.explain import ExplainRequest, MeasurementErrors, VerdictFilter
    from drivelint.explain import explain as explained
    from drivelint.explain.text import render, to_json

    request = ExplainRequest(
        name,
        folder,
        VerdictFilter(profile, object_, at, ego, verdict),
        trace,
        map_,
        MeasurementErrors(position, time, of_map, samples, seed),
        values.parse_memory(memory),
    )
    found = run_interruptible(lambda: explained(request))
    if format_ == "json":
        typer.echo(to_json(found))
    else:
        print_rich(lambda width: render(found, width))
