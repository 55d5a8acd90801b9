"""The commands that read whole audits: `report` and `diff` for a folder that `audit --out` wrote, `trend` and `what-if`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from drivelint import option_values
from drivelint.cli import options  # noqa: TC001 - Typer looks the annotations up
from drivelint.cli.console import progress, run_interruptible
from drivelint.cli.options import argument, option
from drivelint.errors import UsageError
from drivelint.phrases import name_list, terminal_safe, terminal_safe_json, terminal_safe_line

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.fleet_report.audit_views import Audit


def write_report_of_audit(
    dest: str,
    to: str,
    by: Sequence[str],
    baseline: Path | None,
    *,
    drive_pages: str | None,
    moments: int | None,
    quiet: bool,
) -> None:
    """Write a report of an audit into its folder, and print the name of the file."""
    from drivelint.fleet_report import gated, page
    from drivelint.fleet_report.audit_views import path_or_url
    from drivelint.fleet_report.drive_pages import DEFAULT_N_DRIVE_PAGES

    if to not in (*page.FORMATS, *gated.FORMATS):
        formats = name_list([*page.FORMATS, *gated.FORMATS])
        raise UsageError(f"--to {to}: an audit can be reported as {formats}; the other formats are for a check")
    if to in gated.FORMATS:
        if by or baseline is not None or drive_pages is not None or moments is not None:
            raise UsageError(
                f"--by, --baseline, --drive-pages and --moments are for html and markdown: {to} contains only "
                "the gate of the last drivelint audit"
            )
        name, audit = run_interruptible(lambda: gated.write_report(dest, to))
        _print_warning_of_audit(audit)
        typer.echo(terminal_safe_line(f"{dest.rstrip('/')}/{name}"))
        return
    if (drive_pages is not None or moments is not None) and to != "html":
        raise UsageError("--drive-pages and --moments are for --to html: the other formats are one file")
    n_drive_pages = (
        DEFAULT_N_DRIVE_PAGES
        if drive_pages is None
        else option_values.parse_number_or_all("--drive-pages", drive_pages)
    )
    base = None if baseline is None else path_or_url(baseline)
    with progress(quiet) as listener:
        name, audit = run_interruptible(
            lambda: page.write_fleet_page(
                dest, to, tuple(by), base, most_drives=n_drive_pages, most_moments=moments, progress=listener
            )
        )
    _print_warning_of_audit(audit)
    typer.echo(terminal_safe_line(f"{dest.rstrip('/')}/{name}"))


def diff_audits(base: str, new: str, format_: str, fail_on: str | None, rows: Path | None) -> None:
    """Print the difference of two audits, and exit with its exit code."""
    from drivelint.fleet_report import difference_text
    from drivelint.fleet_report.audit_views import open_two_audits
    from drivelint.fleet_report.difference import difference, write_finding_rows
    from drivelint.gate.descriptions import MAX_LINES

    n_findings = difference_text.MAX_JSON_FINDINGS if format_ == "json" else MAX_LINES

    def print_difference() -> None:
        with open_two_audits(base, new) as (con, earlier, later):
            for audit in (earlier, later):
                _print_warning_of_audit(audit)
            changes = difference(con, later, earlier, n_findings)
            if rows is not None:
                write_finding_rows(con, rows)
        least = difference_text.gating_severity(changes, fail_on)
        if format_ == "json":
            typer.echo(terminal_safe_json(difference_text.to_json(changes, least)))
        elif format_ == "markdown":
            typer.echo(difference_text.to_text(changes, least, markdown=True))
        else:
            typer.echo(terminal_safe(difference_text.to_text(changes, least)))
        raise typer.Exit(int(difference_text.exit_code(changes, least)))

    run_interruptible(print_difference)


def what_if(
    dest: Annotated[Path, argument("DEST", "The folder that audit --out wrote.")],
    setting: Annotated[str, argument("RULE.PARAM=V", "Another value of a rule's parameter.")],
    by: Annotated[
        str | None,
        option("--by", "TAG", "Count verdicts by a tag of the manifest, or by a situation such as weather."),
    ] = None,
    format_: options.FormatOption = "text",
) -> None:
    """Show which verdicts of an audit change with another value of a parameter, without reading a log.

    Stored verdicts are enough if the parameter is only the required value. Otherwise a new audit is needed; the output states why.

    Exit codes: 0 the answer is complete; 4 some or all verdicts need a new audit; 2 usage error.
    """
    from drivelint.fleet_report.audit_views import path_or_url
    from drivelint.fleet_report.what_if import to_json, to_text, what_if_in_audit

    answer = run_interruptible(lambda: what_if_in_audit(path_or_url(dest), setting, by))
    typer.echo(terminal_safe_json(to_json(answer)) if format_ == "json" else terminal_safe(to_text(answer)))
    raise typer.Exit(int(answer.exit_code))


def trend(
    dests: Annotated[list[str], argument("DEST", "The folders that audit --out wrote, in the order of time.")],
    format_: Annotated[options.DiffFormat, option("--format", None, "Format of the output on stdout.")] = "text",
) -> None:
    """Compare the rates of several audits, for example one a month: which rules rise or fall by more than chance explains.

    A log that several audits have counts in the first of them only, so a growing audit gives its additions.

    Exit codes: 0; 2 usage error; 4 an audit has not ended, or no rule has a rate to compare. Findings do not change the exit code.
    """
    from drivelint.fleet_report.audit_views import path_or_url
    from drivelint.fleet_report.trend import audit_trend, to_json, to_text

    def warn_on_stderr(warning: str) -> None:
        typer.echo(f"drivelint: {terminal_safe_line(warning)}", err=True)

    result = run_interruptible(lambda: audit_trend([path_or_url(Path(dest)) for dest in dests], warn_on_stderr))
    if format_ == "json":
        typer.echo(terminal_safe_json(to_json(result)))
    elif format_ == "markdown":
        typer.echo(to_text(result, markdown=True))
    else:
        typer.echo(terminal_safe(to_text(result)))
    raise typer.Exit(int(result.exit_code))


def _print_warning_of_audit(audit: Audit) -> None:
    """Print an audit's warning on stderr, such as that it has not ended."""
    if audit.warning:
        typer.echo(f"drivelint: {terminal_safe_line(audit.warning)}", err=True)
