"""`drivelint audit`, `merge` and `sql`: many drives, and the folders that `audit --out` wrote."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from drivelint import option_values
from drivelint.cli import options, packs
from drivelint.cli.console import progress as bar
from drivelint.cli.console import run_interruptible
from drivelint.cli.options import argument, option
from drivelint.errors import DriveLintError, UsageError
from drivelint.options.arguments import DriveArguments, ExitCodeArguments, RuleArguments  # noqa: TC001 - read at runtime
from drivelint.options.declaration import engine_values
from drivelint.phrases import plural, terminal_safe, terminal_safe_line
from drivelint.settings import find_settings

DeltaFolder = Annotated[
    str | None,
    option(
        "--delta",
        "PATH",
        "At the end, also write the packed tables as Delta tables into this folder or URL (s3://, gs://, az://). Needs drivelint[delta].",
    ),
]


@options.DeclaredCommand
def audit(
    *,
    sources: Annotated[
        list[str], argument("SOURCE", "Recorded drives: files, globs, folders, or a manifest (Parquet or CSV) of them.")
    ],
    drive: DriveArguments,
    out: Annotated[
        str, option("--out", "DEST", "Folder for the results. After an interruption, the same command continues there.")
    ],
    selection: RuleArguments,
    robustness: Annotated[
        bool,
        option(
            "--robustness/--no-robustness",
            None,
            "Also judge copies with recording errors, as check does, to find how sure each finding is. Takes half as long again.",
        ),
    ] = False,
    exit_codes: ExitCodeArguments,
    min_judged: options.MinJudged = None,
    baseline: Annotated[
        Path | None,
        option(
            "--baseline", "DEST", "An earlier audit or result. Its findings are known; only new ones can fail the run."
        ),
    ] = None,
    waivers: options.Waivers = None,
    today: options.Today = None,
    workers: Annotated[
        int | None, option("--workers", "N", "Number of processes. Default: one per core.", min=1)
    ] = None,
    memory: options.MemorySize = None,
    worker_memory: Annotated[
        str | None,
        option(
            "--worker-memory",
            "SIZE",
            "Limit of the resident memory of one worker. A drive that needs more is quarantined.",
        ),
    ] = None,
    drive_timeout: Annotated[
        float,
        option(
            "--drive-timeout", "S", "Seconds that a drive may compute. A drive that takes longer is quarantined.", min=1
        ),
    ] = 1800.0,
    shard: Annotated[
        str | None,
        option("--shard", "I/N", "Judge the I-th of N parts. `drivelint merge DEST` packs the results at the end."),
    ] = None,
    claim: Annotated[
        bool,
        option(
            "--claim",
            None,
            "Share the drives with other audits into DEST. `merge` packs the results at the end.",
        ),
    ] = False,
    lease: Annotated[
        float,
        option(
            "--lease",
            "S",
            "With --claim: if an audit shows no sign of life for this long, others take over its drives.",
            min=1,
        ),
    ] = 60.0,
    retry_errors: Annotated[
        bool, option("--retry-errors", None, "Try again the drives that could not be judged before.")
    ] = False,
    prune: Annotated[
        bool, option("--prune", None, "Remove results of logs that are no longer among the sources.")
    ] = False,
    cluster: Annotated[
        str | None,
        option("--cluster", "ADDRESS", "Judge on a cluster: Dask (tcp://..., tls://...) or Ray (ray://..., auto)."),
    ] = None,
    delta: DeltaFolder = None,
    evidence: options.Evidence = None,
    sign: options.Sign = None,
    quiet: options.Quiet = False,
) -> None:
    """Judge many drives, on all cores.

    Results are stored as soon as they are computed. After an interruption, the same command continues with the rest.
    A manifest has a column log, and may have map, ego and environment (weather=wet;light=night). Other columns are tags.

    Exit codes: those of check; 4 also if a drive cannot be judged or kills its worker.
    """
    from drivelint.audit import AuditRequest, JudgeSettings
    from drivelint.audit import audit as audited
    from drivelint.audit.text import summary_text
    from drivelint.fleet_report import gated
    from drivelint.gate import GateInputs

    in_parts = shard is not None or claim
    if in_parts and not (baseline is None and waivers is None and min_judged is None):
        raise UsageError(
            "--baseline, --waivers and --min-judged need a complete audit: when all parts have ended, "
            "run the audit without --shard and --claim"
        )
    gate = None
    if not in_parts:
        day, file = option_values.parse_today(today), find_settings()
        gate = GateInputs.from_files(baseline, waivers, file, day, Path(out), load=gated.load_check_or_audit)
    request = AuditRequest(
        sources=tuple(sources),
        **engine_values(drive),
        **engine_values(exit_codes),
        out=out,
        settings=JudgeSettings(
            **engine_values(selection), robustness=robustness, memory=option_values.parse_memory(memory)
        ),
        min_judged=min_judged,
        workers=workers,
        worker_memory=None if worker_memory is None else option_values.parse_memory(worker_memory),
        drive_timeout_s=drive_timeout,
        shard=option_values.parse_shard(shard),
        claim=claim,
        lease_s=lease,
        retry_errors=retry_errors,
        prune=prune,
        cluster=cluster,
        delta=delta,
    )
    pack = option_values.pack_request(evidence, sign, out, has_all_drives=shard is None and not claim)
    with bar(quiet) as progress:
        try:
            counts = run_interruptible(lambda: audited(request, progress))
        except KeyboardInterrupt:
            typer.echo(f"drivelint: {_stored_results_sentence(out)}", err=True)
            raise
    code, lines, why = counts.exit_code(exit_codes.fail_on, strict=exit_codes.strict), list[str](), ""
    if gate is not None or min_judged is not None:
        result = gated.apply_gate(out, gate)
        code, lines = gated.exit_code(result, counts), list(gated.gate_lines(result))
        why = gated.exit_reason(result, code)
    typer.echo(terminal_safe(summary_text(counts, out, code, lines, fail_on=exit_codes.fail_on, gate_reason=why)))
    if pack is not None:
        packs.write_and_print_summary(pack, on_stderr=True)
    raise typer.Exit(int(code))


def _stored_results_sentence(out: str) -> str:
    """Return a sentence with the number of drives that have a result in `out`."""
    from tempfile import TemporaryDirectory

    from drivelint.audit.store import open_store
    from drivelint.audit.unpacked import n_results

    try:
        with TemporaryDirectory(prefix="drivelint-kept-") as home:
            n = n_results(open_store(out), Path(home))
    except (DriveLintError, OSError):  # the user wants to stop, so an error of the store is not reported
        return f"results so far stay in {terminal_safe_line(out)}: the same command continues with the rest"
    if not n:
        return f"no drive has a result in {terminal_safe_line(out)} yet, because drives are judged in groups: the same command begins again"
    sentence = f"{plural(n, 'drive')} {'has' if n == 1 else 'have'} a result, which stays in {terminal_safe_line(out)}"
    return f"{sentence}: the same command continues with the rest"


def merge(
    dest: Annotated[str, argument("DEST", "The folder of the audits with --shard or --claim.")],
    *,
    delta: DeltaFolder = None,
) -> None:
    """Pack the results of audits with --shard or --claim, when all of them have ended.

    Exit codes: 0; 4 if a shard is missing or drives could not be judged; 3 for lossy input. Findings do not change the exit code.
    """
    from drivelint.audit import merge as merged
    from drivelint.audit.text import summary_text

    with bar(False) as progress:
        counts = run_interruptible(lambda: merged(dest, progress, delta))
    code = counts.exit_code("never", strict=False)
    typer.echo(terminal_safe(summary_text(counts, dest, code, fail_on="never")))
    raise typer.Exit(int(code))


def sql(
    dest: Annotated[str, argument("DEST", "The folder that audit --out or check --out wrote.")],
    query: Annotated[
        str,
        argument(
            "QUERY",
            "One SELECT over verdicts, findings, drives, rules and receipts; for an audit also over counted_verdicts, counted_findings "
            "and counted_drives, in which logs with the same content count once, and counted_events, in which a touch of two egos "
            "counts once too.",
        ),
    ],
    format_: Annotated[options.SqlFormat, option("--format", None, "Format of the output on stdout.")] = "text",
) -> None:
    """Query the tables of an audit or a check with SQL. Nothing is changed."""
    from drivelint.audit.ask import run_query

    def warn_on_stderr(warning: str) -> None:
        typer.echo(f"drivelint: {terminal_safe_line(warning)}", err=True)

    typer.echo(run_query(dest, query, format_, warn_on_stderr), nl=False)
