"""`drivelint pack` and `verify`: a result that others can check."""

from __future__ import annotations

import os
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import typer

from drivelint.cli.console import run_interruptible
from drivelint.cli.options import argument, option
from drivelint.errors import ExitCode, UsageError
from drivelint.phrases import inert, inert_line

Traces = Annotated[
    list[Path] | None, option("--trace", "FILE", "Where a log is, if it was moved. Repeatable: its hash tells which.")
]
Map = Annotated[Path | None, option("--map", "MAP", "Where the map is, if it was moved.")]


def pack(
    folder: Annotated[Path, argument("DIR", "What check --out wrote.")],
    *,
    out: Annotated[Path, option("--out", "PACK", "Folder for the evidence pack.")],
    sign: Annotated[
        Path | None,
        option(
            "--sign",
            "KEY",
            "Sign it with this Ed25519 key: PEM, without a password. A public key (id_ed25519.pub): the one that ssh-agent holds.",
        ),
    ] = None,
    with_inputs: Annotated[
        bool, option("--with-inputs", None, "Also copy the logs, the map and the mapping into it.")
    ] = False,
    traces: Traces = None,
    map_: Map = None,
    date: Annotated[
        str | None,
        option(
            "--date",
            "YYYY-MM-DD",
            "Its Bagging-Date. Default: the day of SOURCE_DATE_EPOCH, if that is set; else none.",
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
    overwrite: Annotated[bool, option("--overwrite", None, "Replace a pack that is there.")] = False,
) -> None:
    """Pack a result as evidence: hashed, signed, and to be checked by others.

    A folder in BagIt form with the tables and reports, the rules, for each finding the rows that its rule read and SQL that gives its
    margin in any DuckDB, and an in-toto statement of what was judged by what. The logs are judged again for it. The same command
    gives the same bytes.
    """
    from drivelint.pack import PackRequest, write_pack

    request = PackRequest(folder, out, sign, with_inputs, tuple(traces or ()), map_, _date(date), timestamp, overwrite)
    told = run_interruptible(lambda: write_pack(request))
    findings = told["findings"]
    n = sum(1 for finding in findings if finding["sql"])
    signed = "signed" if sign else "not signed"
    typer.echo(f"{inert_line(str(out))}: {signed}; {n} of {len(findings)} findings have SQL that gives their margin")
    for finding in findings:
        if finding["without_sql_because"]:
            why = f"  {finding['finding_id']} {finding['rule_id']}: none, as {finding['without_sql_because']}"
            typer.echo(inert_line(why))
    if sheets := [name for name in told["left_out"] if name.startswith("incidents/")]:
        typer.echo(inert_line(f"  not in it, so sign and keep them beside it: {', '.join(sheets)}"))


def verify(
    folder: Annotated[Path, argument("PACK", "What drivelint pack wrote.")],
    *,
    key: Annotated[
        Path | None, option("--key", "PUBLIC", "The Ed25519 key that it must be signed with, PEM. Default: that in it.")
    ] = None,
    traces: Traces = None,
    map_: Map = None,
    timestamp_root: Annotated[
        Path | None,
        option(
            "--timestamp-root",
            "PEM",
            "It must have a time stamp of an authority whose root certificate is one of these.",
        ),
    ] = None,
) -> None:
    """Verify an evidence pack: its files, its signature, what it states; and judge the logs again.

    Without a log in the pack or --trace nothing is judged again, and the line says so. Each thing that is wrong has a line of its own.

    Exit codes: 0 untouched; 1 something is wrong; 2 usage error.
    """
    from drivelint.pack import VerifyRequest
    from drivelint.pack import verify as verified

    request = VerifyRequest(folder, key, tuple(traces or ()), map_, timestamp_root)
    found = run_interruptible(lambda: verified(request))
    for note in found.notes:
        typer.echo(f"drivelint: {inert_line(note)}", err=True)
    for problem in found.problems:
        typer.echo(f"{problem.kind}: {inert_line(problem.what)}")
    if not found.problems:
        typer.echo(inert(found.sentence))
    raise typer.Exit(int(ExitCode.FAILED if found.problems else ExitCode.OK))


def _date(given: str | None) -> str | None:
    """Return the day of the pack: given, or that of SOURCE_DATE_EPOCH; None: neither says one."""
    epoch = os.environ.get("SOURCE_DATE_EPOCH")
    try:
        if given is not None:
            return datetime.strptime(given, "%Y-%m-%d").replace(tzinfo=UTC).date().isoformat()
        return None if epoch is None else datetime.fromtimestamp(int(epoch), UTC).date().isoformat()
    except (ValueError, OverflowError, OSError) as error:
        what = f"--date {given}" if given is not None else f"SOURCE_DATE_EPOCH={epoch}"
        raise UsageError(f"{what}: no day: write --date as 2026-11-26, SOURCE_DATE_EPOCH in seconds") from error
