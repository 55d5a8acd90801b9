"""`drivelint pack` and `verify`: packs of results that others can check."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from drivelint import option_values
from drivelint.cli import options  # noqa: TC001 - Typer looks the annotations up
from drivelint.cli.console import run_interruptible
from drivelint.cli.options import argument, option
from drivelint.errors import ExitCode
from drivelint.phrases import plural, terminal_safe, terminal_safe_line

if TYPE_CHECKING:
    from drivelint.pack import PackRequest

NewTracePaths = Annotated[
    list[Path] | None,
    option(
        "--trace",
        "FILE",
        "New path of a log that was moved; for an audit, also a folder of logs. Repeatable. Logs are recognised by their hash.",
    ),
]
NewMapPath = Annotated[Path | None, option("--map", "MAP", "The new path of the map, if it was moved.")]


def pack(
    folder: Annotated[Path, argument("DIR", "The folder that check --out or audit --out wrote.")],
    *,
    out: Annotated[Path, option("--out", "PACK", "Folder for the evidence pack.")],
    sign: options.Sign = None,
    with_inputs: Annotated[
        bool, option("--with-inputs", None, "Also copy the logs, the map and the mapping into it.")
    ] = False,
    traces: NewTracePaths = None,
    map_: NewMapPath = None,
    date: Annotated[
        str | None,
        option(
            "--date",
            "YYYY-MM-DD",
            "The Bagging-Date of the pack. Default: the day of SOURCE_DATE_EPOCH, if that is set; else none.",
        ),
    ] = None,
    timestamp: Annotated[
        Path | None,
        option(
            "--timestamp",
            "FILE",
            "Add the time stamp (RFC 3161 response, .tsr) that an authority made of statement.dsse.json in the same pack.",
        ),
    ] = None,
    findings: Annotated[
        str | None,
        option(
            "--findings", "N|all", "For an audit: pack the rows of its N worst findings. Default: 100; for a check all."
        ),
    ] = None,
    overwrite: Annotated[bool, option("--overwrite", None, "Replace a pack that is there.")] = False,
) -> None:
    """Pack the result of a check or an audit as evidence: hashed, signed, and verifiable by others.

    Writes a BagIt folder with the tables, the reports and the rules; for each finding the rows that its rule read, and SQL that
    computes its margin in any DuckDB; and an in-toto statement of the logs, the map, the rules and the results. To find these rows,
    the logs with findings are judged again. The same command gives the same bytes.
    """
    from drivelint.pack import DEFAULT_PACKED_FINDINGS, PackRequest

    n_findings = (
        DEFAULT_PACKED_FINDINGS if findings is None else option_values.parse_number_or_all("--findings", findings)
    )
    request = PackRequest(
        folder,
        out,
        sign,
        with_inputs,
        tuple(traces or ()),
        map_,
        option_values.parse_pack_date(date),
        timestamp,
        overwrite,
        n_findings,
    )
    write_and_print_summary(request)


def write_and_print_summary(request: PackRequest, *, on_stderr: bool = False) -> None:
    """Write a pack and print a summary of its content; with `on_stderr` on stderr."""
    from drivelint.pack import write_pack
    from drivelint.pack.audits import packed_findings_text
    from drivelint.pack.contents import phrase_on_findings_with_sql
    from drivelint.result.load import load_result

    summary = run_interruptible(lambda: write_pack(request))
    findings, left = summary["findings"], summary.get("findings_left_out")
    if left is not None:  # an audit
        findings_text = packed_findings_text(request.out, summary)
    else:
        findings_text = phrase_on_findings_with_sql(load_result(request.folder).findings.to_pylist(), findings)
    signed = "signed" if request.key else "not signed"
    less = f"; {plural(left, 'less severe finding')} left out (drivelint pack --findings all)" if left else ""
    copies = summary.get("n_copies")
    once = f"; {plural(copies, 'log')} with the content of another log: counted once" if copies else ""
    pages = sum(name.endswith(".html") for name in summary.get("incidents", ()))
    sheets = f"; {plural(pages, 'incident sheet')}" if pages else ""
    sentence = f"{signed}; {findings_text}{less}{once}{sheets}"
    typer.echo(f"{terminal_safe_line(str(request.out))}: {sentence}", err=on_stderr)
    for finding in findings:
        if finding["without_sql_because"]:
            why = f"  {finding['finding_id']} {finding['rule_id']}: no SQL, because {finding['without_sql_because']}"
            typer.echo(terminal_safe_line(why), err=on_stderr)
    if left_out := [name for name in summary["left_out"] if name.startswith("incidents/")]:
        why = "sheets of findings that the result does not contain, and PDFs whose page is missing or would be written differently now"
        typer.echo(terminal_safe_line(f"  left out of the pack ({why}): {', '.join(left_out)}"), err=on_stderr)


def verify(
    folder: Annotated[Path, argument("PACK", "The folder that drivelint pack wrote.")],
    *,
    key: Annotated[
        Path | None,
        option("--key", "PUBLIC", "The public Ed25519 key of the signer, PEM. Default: the key in the pack."),
    ] = None,
    require_signature: Annotated[
        bool,
        option("--require-signature", None, "Refuse a pack without a known signer. Needs --key."),
    ] = False,
    not_before: Annotated[
        str | None,
        option("--not-before", "YYYY-MM-DD", "Refuse a pack with an earlier Bagging-Date, or without one."),
    ] = None,
    traces: NewTracePaths = None,
    map_: NewMapPath = None,
    timestamp_root: Annotated[
        Path | None,
        option(
            "--timestamp-root",
            "PEM",
            "Require a time stamp of an authority with one of these root certificates.",
        ),
    ] = None,
) -> None:
    """Verify an evidence pack: its files, its signature and its statements; and judge the logs again.

    If there is no log in the pack and no --trace, nothing is judged again, and the output states this. The output has one line per
    problem. Without --key, exit code 0 does not prove who made the pack; with --require-signature, the exit code is then 1. An older
    pack of the same signer is equally valid: the output states its date, and with --not-before an older pack has exit code 1.

    Exit codes: 0 unchanged; 1 something is wrong; 2 usage error.
    """
    from drivelint.pack import VerifyRequest
    from drivelint.pack import verify as verified
    from drivelint.pack.bag import explanation_text

    request = VerifyRequest(
        folder, key, tuple(traces or ()), map_, timestamp_root,
        require_signature, None if not_before is None else option_values.parse_day("--not-before", not_before),
    )  # fmt: skip
    verification = run_interruptible(lambda: verified(request))
    for note in verification.notes:
        typer.echo(f"drivelint: {terminal_safe_line(note)}", err=True)
    for problem in verification.problems:
        typer.echo(f"{problem.kind}: {terminal_safe_line(problem.subject)}{explanation_text(problem)}")
    if not verification.problems:
        typer.echo(terminal_safe(verification.sentence))
    raise typer.Exit(int(ExitCode.FAILED if verification.problems else ExitCode.OK))
