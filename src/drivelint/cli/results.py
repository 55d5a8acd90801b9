"""`drivelint report` and `drivelint diff`: what reads the folders that `check --out` wrote."""

from __future__ import annotations

from pathlib import Path  # noqa: TC003 - Typer looks the annotations up
from typing import Annotated

import typer

from drivelint.cli import options  # noqa: TC001 - Typer looks the annotations up
from drivelint.errors import ExitCode


def report(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="What check --out wrote.")],
    to: Annotated[
        options.ReportFormat,
        typer.Option(
            "--to",
            help="html: one page that opens offline; junit, sarif (2.1.0), xqar (ASAM): for servers and viewers; "
            "markdown: for a comment on a pull request.",
        ),
    ] = "html",
) -> None:
    """Write a report from a result folder, into it.

    Files: report.html, junit.xml, report.sarif, report.xqar, report.md. Prints the name of the one that was written.
    """
    from drivelint.report.report_formats import REPORT_FORMATS
    from drivelint.result.files import publish
    from drivelint.result.load import load_result

    name, render = REPORT_FORMATS[to]
    publish(folder, {name: render(load_result(folder))}, {})
    typer.echo(str(folder / name))


def diff(
    base: Annotated[Path, typer.Argument(metavar="BASE", help="What check --out wrote, earlier.")],
    new: Annotated[Path, typer.Argument(metavar="NEW", help="What check --out wrote, later.")],
    format_: Annotated[options.DiffFormat, typer.Option("--format", help="What is printed on stdout.")] = "text",
    fail_on: Annotated[
        options.FailOn | None,
        typer.Option("--fail-on", help="Least severity of a new finding that makes exit code 1. Default: NEW's."),
    ] = None,
) -> None:
    """Compare two results: new, fixed, changed and unchanged findings.

    What NEW did not judge is not fixed: it is listed apart, with the reason. Findings that NEW's run waived do not gate.

    Exit codes: 0 no new finding of a stable rule at or above --fail-on; 1 there is one; 2 usage error.
    """
    from drivelint.gate import compare_results, descriptions
    from drivelint.result.load import load_result

    earlier, later = load_result(base), load_result(new)
    least = later.fail_on if fail_on is None else fail_on
    found, failing = compare_results(earlier, later, (base.resolve().name, new.resolve().name), least)
    if format_ == "json":
        typer.echo(descriptions.to_json(found, failing, least))
    elif format_ == "markdown":
        from drivelint.report import markdown

        typer.echo(markdown.difference(found, failing, least, later.gate))
    else:
        typer.echo(descriptions.difference_text(found, failing, least, later.gate))
    raise typer.Exit(int(ExitCode.FAILED if failing else ExitCode.OK))
