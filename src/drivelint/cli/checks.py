"""The commands `report` and `diff` for the result of a check: a folder that `check --out` wrote."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

from drivelint.cli.console import run_interruptible
from drivelint.errors import UsageError
from drivelint.phrases import name_list, terminal_safe, terminal_safe_json, terminal_safe_line

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from drivelint.incident import IncidentRequest
    from drivelint.result.model import Result


def write_reports_of_check(folder: Path, formats: Sequence[str], base_url: str | None) -> None:
    """Write reports of a check into its folder, and print their names. `base_url`: only for Markdown."""
    from drivelint.report import markdown
    from drivelint.report.outputs import REPORT_FORMATS
    from drivelint.result.folder import add_file
    from drivelint.result.load import load_result

    if base_url is not None and "markdown" not in formats:
        raise UsageError("--base-url is for --to markdown: other reports have no links to the report")
    result = load_result(folder)
    warn_of_partial_result(folder, result)
    for format_name in dict.fromkeys(formats):
        name, render = REPORT_FORMATS[format_name]
        add_file(folder, name, markdown.render(result, base_url) if format_name == "markdown" else render(result))
        typer.echo(terminal_safe_line(str(folder / name)))


def write_incident_sheet(request: IncidentRequest) -> None:
    """Write the incident sheet of a finding and print the names of its files.

    If the name fits findings (or near misses) in several drives, print the other drives on stderr.
    """
    from drivelint.incident import other_drives_with_named_finding, write_sheet

    for path in run_interruptible(lambda: write_sheet(request)):
        typer.echo(terminal_safe_line(str(path)))
    if other_drives := other_drives_with_named_finding(request):
        name = request.name
        message = f"{name} also fits {name_list(other_drives)}: the sheet is about the worst; choose another with {name}@DRIVE"
        typer.echo(f"drivelint: {terminal_safe_line(message)}", err=True)


def diff_checks(base: Path, new: Path, format_: str, fail_on: str | None) -> None:
    """Print the difference of two checks, and exit with its exit code."""
    from drivelint.gate import compare_results, descriptions
    from drivelint.result.load import load_result
    from drivelint.result.one_line import result_on_one_line

    earlier, later = load_result(base), load_result(new)
    if format_ == "text":
        earlier, later = result_on_one_line(earlier), result_on_one_line(later)
    warn_of_partial_result(base, earlier)
    warn_of_partial_result(new, later)
    least = later.fail_on if fail_on is None else fail_on
    difference, failing = compare_results(earlier, later, (base.resolve().name, new.resolve().name), least)
    if format_ == "json":
        typer.echo(terminal_safe_json(descriptions.to_json(difference, failing, least)))
    elif format_ == "markdown":
        from drivelint.report import markdown

        typer.echo(markdown.render_difference(difference, failing, least, later.gate))
    else:
        typer.echo(terminal_safe(descriptions.difference_text(difference, failing, least, later.gate)))
    raise typer.Exit(int(descriptions.exit_code(difference, failing, least)))


def warn_of_partial_result(folder: Path, result: Result) -> None:
    """Print a warning on stderr if a result is from an interrupted run."""
    if result.interrupted:
        from drivelint.result.model import interruption_sentence

        typer.echo(f"drivelint: {terminal_safe_line(str(folder))}: {interruption_sentence(result.drives)}", err=True)
