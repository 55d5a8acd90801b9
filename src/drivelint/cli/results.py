"""`drivelint report`, `diff` and `explain`. What `check --out` wrote goes to `checks`, what `audit --out` wrote to `fleets`."""

from __future__ import annotations

from pathlib import Path  # noqa: TC003 - Typer looks the annotations up
from typing import Annotated

import typer

from drivelint import option_values
from drivelint.cli import checks, completion, fleets, options
from drivelint.cli.console import print_rich, run_interruptible
from drivelint.cli.options import argument, option
from drivelint.errors import UsageError
from drivelint.phrases import inert_json


def report(
    folder: Annotated[Path, argument("DIR", "What check --out or audit --out wrote.")],
    to: Annotated[
        options.ReportFormat,
        option(
            "--to",
            None,
            "html: one page that opens offline; junit, sarif (2.1.0), xqar (ASAM): for servers and viewers; "
            "markdown: for a comment on a pull request.",
        ),
    ] = "html",
    *,
    incident: Annotated[
        str | None,
        option(
            "--incident",
            "FINDING",
            "Two A4 pages about one finding, instead: incidents/ID.html. Its id, or RULE or RULE@DRIVE, as in explain; "
            "or contact: the worst contact.",
        ),
    ] = None,
    pdf: Annotated[
        bool, option("--pdf", None, "With --incident: also as PDF, printed by an installed Chromium.")
    ] = False,
    trace: Annotated[
        Path | None, option("--trace", "FILE", "With --incident: where the log is, if it was moved.")
    ] = None,
    map_: Annotated[Path | None, option("--map", "MAP", "With --incident: where the map is, if it was moved.")] = None,
    base_url: Annotated[
        str | None,
        option(
            "--base-url", "URL", "With markdown: where DIR can be opened, for links to report.html. Default: no links."
        ),
    ] = None,
    by: Annotated[
        list[str] | None,
        option(
            "--by", "TAG", "Of an audit: rates by a tag of the manifest, or a situation such as weather. Repeatable."
        ),
    ] = None,
    baseline: Annotated[
        Path | None, option("--baseline", "DEST", "Of an audit: an earlier one, to say what is new since.")
    ] = None,
    drive_pages: Annotated[
        str | None,
        option(
            "--drive-pages",
            "N|all",
            "Of an audit, with html: pages of the N worst drives in its folder drives; 0 for none. Default: 100.",
        ),
    ] = None,
) -> None:
    """Write a report from a result folder, into it.

    Files: report.html, junit.xml, report.sarif, report.xqar, report.md. Prints the name of the one that was written.
    Of an audit: fleet.html or fleet.md, with rates, worst drives, coverage, and what could not be judged. Beside fleet.html, a page of
    each of the worst drives.

    With --incident, the sheet of one finding, to be filed: when and where, both parties, speeds, who slowed, second by second,
    what each of them did by the same rules, how sure it is, what the recording does not hold. The log is judged again for it.
    """
    from drivelint.fleet_report.audit_views import destination, is_audit

    of_the_sheet = pdf or trace is not None or map_ is not None
    of_an_audit = bool(by) or baseline is not None or drive_pages is not None
    if is_audit(dest := destination(folder)):
        if incident is not None or of_the_sheet or base_url is not None:
            raise UsageError(f"{dest} is an audit: --incident, --pdf, --trace, --map and --base-url are of a check")
        fleets.report_audit(dest, to, by or (), baseline, drive_pages)
    elif of_an_audit:
        raise UsageError(
            f"--by, --baseline and --drive-pages are of an audit, and {dest} is none: name the folder of audit --out"
        )
    elif incident is not None:
        from drivelint.incident import IncidentRequest

        checks.write_incident_sheet(IncidentRequest(incident, folder, pdf, trace, map_))
    elif of_the_sheet:
        raise UsageError("--pdf, --trace and --map are about an incident sheet: name its finding with --incident")
    else:
        checks.report_check(folder, to, base_url)


def diff(
    base: Annotated[Path, argument("BASE", "What check --out or audit --out wrote, earlier.")],
    new: Annotated[Path, argument("NEW", "What the same command wrote, later.")],
    format_: Annotated[options.DiffFormat, option("--format", None, "What is printed on stdout.")] = "text",
    fail_on: Annotated[
        options.FailOn | None,
        option("--fail-on", None, "Least severity of a new finding that makes exit code 1. Default: NEW's."),
    ] = None,
    rows: Annotated[
        Path | None,
        option("--rows", "FILE", "Of two audits: every finding of either as Parquet, with what else differs there."),
    ] = None,
) -> None:
    """Compare two results, or two audits: new, fixed, changed and unchanged findings.

    What NEW did not judge is not fixed: it is listed apart, with the reason. Findings that NEW's run waived do not gate.
    Of two audits it also says what else differs (software, rules, parameters, data, map, tool), and which rates do.

    Exit codes: 0 no new finding of a stable rule at or above --fail-on; 1 there is one; 2 usage error; 4 there is none so far, but
    findings of BASE are unknown or not looked at in NEW, or a run has not ended. Of two audits without a common drive, and without
    --fail-on: 1 where the rate of such a rule is higher than chance explains, 0 where none is, 4 where no rule has a rate in both.
    """
    from drivelint.fleet_report.audit_views import destination, is_audit

    if is_audit(destination(base)) or is_audit(destination(new)):
        fleets.diff_audits(destination(base), destination(new), format_, fail_on, rows)
    elif rows is not None:
        raise UsageError("--rows is of two audits: of two checks, --format json has all findings")
    else:
        checks.diff_checks(base, new, format_, fail_on)


def explain(
    name: Annotated[
        str,
        argument(
            "FINDING",
            "A finding's id or how it begins; or, for any verdict, RULE or RULE@DRIVE, or how they begin.",
            autocompletion=completion.rule_ids,
        ),
    ],
    *,
    folder: Annotated[Path, option("--in", "DIR", "What check --out wrote.")],
    profile: Annotated[str | None, option("--profile", "NAME", "The rule's verdict for this profile.")] = None,
    object_: Annotated[str | None, option("--object", "ID", "The rule's verdict about this actor.")] = None,
    ego: Annotated[str | None, option("--ego", "ID", "The rule's verdict on this ego.")] = None,
    verdict: Annotated[str | None, option("--verdict", "WORD", "A verdict of this kind, such as unknown.")] = None,
    at: Annotated[float | None, option("--at", "S", "The rule's verdict about this second of the drive.")] = None,
    trace: Annotated[Path | None, option("--trace", "FILE", "Where the log is, if it was moved.")] = None,
    map_: Annotated[Path | None, option("--map", "MAP", "Where the map is, if it was moved.")] = None,
    position: Annotated[
        float, option("--sigma-position", "M", "Standard error of each actor's position.", min=0)
    ] = 0.1,
    time: Annotated[float, option("--sigma-time", "S", "Standard error of each actor's clock.", min=0)] = 0.05,
    of_map: Annotated[float, option("--sigma-map", "M", "Standard error of where the map lies.", min=0)] = 0.1,
    samples: Annotated[
        int | None,
        option(
            "--samples",
            None,
            "Copies with such errors; 0 leaves them out. Default: 100, for an unknown verdict 10.",
            min=0,
            max=100_000,
        ),
    ] = None,
    seed: Annotated[int, option("--seed", None, "Another one draws other errors.", min=0)] = 0,
    memory: options.MemorySize = None,
    format_: options.FormatOption = "text",
) -> None:
    """Show why one verdict is what it is.

    The clause, the SQL with its numbers, the rows that it read, the margin over time, the least change of a number that
    changes the verdict, and how often it stays the same when positions, clocks and map are a little off. Of several
    verdicts of a rule the worst is shown, unless --ego, --verdict, --profile, --object or --at choose.

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
    checks.warn_of_partial(folder, load_result(folder))
    found = run_interruptible(lambda: explained(request))
    if format_ == "json":
        typer.echo(inert_json(to_json(found)))
    else:
        print_rich(lambda width: render(found, width))
