"""`drivelint report`, `diff` and `explain`. The module `checks` handles results of `check --out`; `fleets` handles audits."""

from __future__ import annotations

from pathlib import Path  # noqa: TC003 - Typer looks the annotations up
from typing import Annotated

import typer

from drivelint import option_values
from drivelint.cli import checks, completion, fleets, options
from drivelint.cli.console import print_rich, run_interruptible
from drivelint.cli.options import argument, option
from drivelint.errors import UsageError
from drivelint.options.types import FailOn, ReportFile
from drivelint.phrases import terminal_safe_json


def report(
    folder: Annotated[Path, argument("DIR", "The folder that check --out or audit --out wrote.")],
    to: Annotated[
        list[ReportFile] | None,
        option(
            "--to",
            "html|junit|sarif|xqar|markdown",
            "html: one page that opens offline; junit, sarif (2.1.0), xqar (ASAM): for servers and viewers; "
            "markdown: for a comment on a pull request. Repeatable. Default: html.",
        ),
    ] = None,
    *,
    incident: Annotated[
        str | None,
        option(
            "--incident",
            "FINDING",
            "Write two A4 pages about one finding or near miss instead: incidents/ID.html. Give its id, RULE or RULE@DRIVE, as in "
            "explain; or contact, for the worst contact.",
        ),
    ] = None,
    pdf: Annotated[
        bool, option("--pdf", None, "With --incident: also as PDF, printed by an installed Chromium.")
    ] = False,
    trace: Annotated[
        Path | None, option("--trace", "FILE", "With --incident: the new path of the log, if it was moved.")
    ] = None,
    map_: Annotated[
        Path | None, option("--map", "MAP", "With --incident: the new path of the map, if it was moved.")
    ] = None,
    base_url: Annotated[
        str | None,
        option("--base-url", "URL", "With markdown: the URL of DIR, for links to report.html. Default: no links."),
    ] = None,
    by: Annotated[
        list[str] | None,
        option(
            "--by",
            "TAG",
            "For an audit: rates by a tag of the manifest, or by a situation such as weather. Repeatable.",
        ),
    ] = None,
    baseline: Annotated[
        Path | None, option("--baseline", "DEST", "For an audit: an earlier audit, to show the changes since then.")
    ] = None,
    drive_pages: Annotated[
        str | None,
        option(
            "--drive-pages",
            "N|all",
            "For an audit, with html: write pages of the N worst drives into its folder drives; 0 for none. Default: 100.",
        ),
    ] = None,
    moments: Annotated[
        int | None,
        option(
            "--moments",
            "N",
            "For an audit, with html: judge the N worst drives again and draw their moments, as the report of a check does. "
            "Default: 3, without long drives.",
            min=0,
        ),
    ] = None,
    quiet: options.Quiet = False,
) -> None:
    """Write a report of a result into its folder.

    Writes report.html, junit.xml, report.sarif, report.xqar or report.md, and prints its name.
    For an audit: fleet.html or fleet.md, with rates, worst drives, coverage, and what could not be judged; beside fleet.html, a page
    for each of the worst drives.

    With --incident: writes a sheet about one finding or near miss, for the records. The sheet has time and place, and both parties
    with their speeds and braking second by second. It states what each party did by the same rules, how sure the finding is, and what
    the recording lacks. To write it, the log is judged again.
    """
    from drivelint.fleet_report.audit_views import is_audit, path_or_url

    formats = to or [ReportFile.HTML]
    of_the_sheet = pdf or trace is not None or map_ is not None
    of_an_audit = bool(by) or baseline is not None or drive_pages is not None or moments is not None
    if is_audit(dest := path_or_url(folder)):
        if incident is not None or of_the_sheet or base_url is not None:
            raise UsageError(
                f"{dest} is an audit: --incident, --pdf, --trace, --map and --base-url are only for a check"
            )
        for format_name in dict.fromkeys(formats):
            fleets.write_report_of_audit(
                dest, format_name, by or (), baseline, drive_pages=drive_pages, moments=moments, quiet=quiet
            )
    elif of_an_audit:
        raise UsageError(
            f"--by, --baseline, --drive-pages and --moments are only for an audit, and {dest} is not an "
            "audit: give the folder of audit --out"
        )
    elif incident is not None:
        from drivelint.incident import IncidentRequest

        checks.write_incident_sheet(IncidentRequest(incident, folder, pdf, trace, map_))
    elif of_the_sheet:
        raise UsageError("--pdf, --trace and --map are for an incident sheet: choose its finding with --incident")
    else:
        checks.write_reports_of_check(folder, formats, base_url)


def diff(
    base: Annotated[Path, argument("BASE", "The folder that an earlier check --out or audit --out wrote.")],
    new: Annotated[Path, argument("NEW", "The folder that the same command wrote later.")],
    format_: Annotated[options.DiffFormat, option("--format", None, "Format of the output on stdout.")] = "text",
    fail_on: Annotated[
        FailOn | None,
        option("--fail-on", None, "Lowest severity of a new finding that causes exit code 1. Default: that of NEW."),
    ] = None,
    rows: Annotated[
        Path | None,
        option(
            "--rows", "FILE", "For two audits: write every finding of either as Parquet, with the other differences."
        ),
    ] = None,
) -> None:
    """Compare two results, or two audits: new, fixed, changed and unchanged findings.

    A finding that NEW did not judge is not fixed; it is listed separately, with the reason. Findings that are waived in NEW do not
    change the exit code. For two audits, the other differences (software, rules, parameters, data, map, tool) and the changed rates
    are printed too.

    Exit codes: 0 no new finding of a stable rule at or above --fail-on; 1 such a finding; 2 usage error; 4 no such finding so far,
    but findings of BASE are unknown or were not looked for in NEW, or a run has not ended. For two audits without a common drive, and
    without --fail-on: 1 if the rate of a stable rule rose by more than chance explains, 0 if no rate did, 4 if no rule has a rate in both.
    """
    from drivelint.fleet_report.audit_views import is_audit, path_or_url

    if is_audit(path_or_url(base)) or is_audit(path_or_url(new)):
        fleets.diff_audits(path_or_url(base), path_or_url(new), format_, fail_on, rows)
    elif rows is not None:
        raise UsageError("--rows is only for two audits: for two checks, --format json contains all findings")
    else:
        checks.diff_checks(base, new, format_, fail_on)


def explain(
    name: Annotated[
        str,
        argument(
            "FINDING",
            "The id of a finding, or, for any verdict, RULE or RULE@DRIVE. All of them may be shortened to their beginning.",
            autocompletion=completion.rule_ids,
        ),
    ],
    *,
    folder: Annotated[Path, option("--in", "DIR", "The folder that check --out wrote.")],
    profile: Annotated[str | None, option("--profile", "NAME", "The verdict for this profile.")] = None,
    object_: Annotated[str | None, option("--object", "ID", "The verdict about this actor.")] = None,
    ego: Annotated[str | None, option("--ego", "ID", "The verdict on this ego.")] = None,
    verdict: Annotated[str | None, option("--verdict", "WORD", "A verdict of this kind, such as unknown.")] = None,
    at: Annotated[float | None, option("--at", "S", "The verdict about this second of the drive.")] = None,
    trace: Annotated[Path | None, option("--trace", "FILE", "The new path of the log, if it was moved.")] = None,
    map_: Annotated[Path | None, option("--map", "MAP", "The new path of the map, if it was moved.")] = None,
    position: Annotated[
        float, option("--sigma-position", "M", "Standard error of each actor's position.", min=0)
    ] = 0.1,
    time: Annotated[float, option("--sigma-time", "S", "Standard error of each actor's clock.", min=0)] = 0.05,
    of_map: Annotated[float, option("--sigma-map", "M", "Standard error of the map's position.", min=0)] = 0.1,
    samples: Annotated[
        int | None,
        option(
            "--samples",
            None,
            "Number of copies with such errors; 0: none. Default: 100; for an unknown verdict 10.",
            min=0,
            max=100_000,
        ),
    ] = None,
    seed: Annotated[int, option("--seed", None, "Seed of the random errors.", min=0)] = 0,
    memory: options.MemorySize = None,
    format_: options.FormatOption = "text",
) -> None:
    """Show the reason for one verdict.

    Prints the clause, the SQL with its numbers, the rows that it read, and the margin over time. Also prints the smallest change of
    a number that changes the verdict, and how often the verdict stays the same with small errors in positions, clocks and map. If a
    rule has several verdicts, the worst is shown, unless --ego, --verdict, --profile, --object or --at choose another.

    explain judges the drive again by that rule. It reads the database of check --keep-db, or else the log.
    """
    from drivelint.explain import ExplainRequest, MeasurementErrors, VerdictFilter
    from drivelint.explain import explain as explained
    from drivelint.explain.text import render, to_json
    from drivelint.result.load import load_result

    request = ExplainRequest(
        name,
        folder,
        VerdictFilter(profile, object_, at, ego, verdict),
        trace,
        map_,
        MeasurementErrors(position, time, of_map, samples, seed),
        option_values.parse_memory(memory),
    )
    checks.warn_of_partial_result(folder, load_result(folder))
    explanation = run_interruptible(lambda: explained(request))
    if format_ == "json":
        typer.echo(terminal_safe_json(to_json(explanation)))
    else:
        print_rich(lambda width: render(explanation, width))
