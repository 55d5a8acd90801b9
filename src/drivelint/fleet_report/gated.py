"""Applies the gate to an audit. The audit is read as a check's result, so baseline, waivers, exit codes, JUnit and SARIF work as for
`check`.

Logs with the same content are one drive, as in every count of an audit. All rows are in memory: about 0.3 MB per drive with 60 rules.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Final

from drivelint.audit.bucket import is_url
from drivelint.audit.run import AUDIT_FILE, RULES_FILE
from drivelint.audit.sealed import seal
from drivelint.audit.unpacked import SUMMARY_FILE
from drivelint.errors import ExitCode
from drivelint.fleet.distinct_logs import create_counted_views
from drivelint.fleet_report.audit_views import is_audit, open_audits, path_or_url
from drivelint.gate import descriptions
from drivelint.report.outcome import headline
from drivelint.report.outputs import REPORT_FORMATS
from drivelint.result import gate
from drivelint.result.collect import ORDER_OF_FINDINGS, ORDER_OF_VERDICTS
from drivelint.result.load import load_result
from drivelint.result.model import Result, exit_status
from drivelint.result.names import GATE_FILE
from drivelint.result.request import RunRequest
from drivelint.run import CheckOptions
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Iterator

    import duckdb

    from drivelint.audit.store import ResultStore
    from drivelint.audit.summary import AuditSummary
    from drivelint.fleet_report.audit_views import Audit
    from drivelint.gate import GateInputs

FORMATS: Final = ("junit", "sarif")
"""The formats of reports that both a check and an audit can write."""
_EXIT_CODES_BY_PRECEDENCE: Final = (ExitCode.USAGE, ExitCode.FAILED, ExitCode.NOT_JUDGED, ExitCode.LOSSY, ExitCode.OK)
"""Exit codes in the order of precedence."""


def audit_result(dest: str) -> Result:
    """Return an audit as the result of a check, with its gate. Errors: as `open_audits`."""
    with open_audits(dest) as (con, audit, _):
        return _result_of_audit(con, audit)


def load_check_or_audit(path: Path) -> Result:
    """Return the result that `check --out` or `audit --out` wrote to `path`. Errors: `UsageError`."""
    dest = path_or_url(path)
    return audit_result(dest) if is_audit(dest) else load_result(path)


def apply_gate(dest: str, inputs: GateInputs | None) -> Result:
    """Compare an audit that has ended with its baseline and waivers. Write `gate.json` into the audit, and return the result with its
    gate."""
    with open_audits(dest) as (con, audit, _):
        result = _result_of_audit(con, audit)
        result = result if inputs is None else inputs.apply_to(result)
        if result.gate is not None:
            audit.results.write(GATE_FILE, gate.render(result.gate))
            seal(audit.results, [AUDIT_FILE, RULES_FILE, GATE_FILE], audit.results.read(SUMMARY_FILE) or b"")
    return result


def exit_code(result: Result, summary: AuditSummary) -> ExitCode:
    """Return the exit code with the higher precedence: from the gated findings, or from the audit's summary."""
    other_exit = replace(summary, failed={}).exit_code("never", strict=result.strict)
    return min((exit_status(result).code, other_exit), key=_EXIT_CODES_BY_PRECEDENCE.index)


def exit_reason(result: Result, code: ExitCode) -> str:
    """Return why an audit exits with this code if the gate determines it; '' if the audit's summary does."""
    status = exit_status(result)
    return status.why if status.code is code else ""


def gate_lines(result: Result) -> Iterator[str]:
    """Yield lines about the gate: the findings by standing, the reason for the exit code, and doubtful waivers."""
    yield f"gate: {headline(result).sentence}"
    yield f"  {exit_status(result).why}"
    if result.gate is not None:
        yield from (f"  {text}" for text in descriptions.waiver_warnings(result.gate))


def write_report(dest: str, report_format: str) -> tuple[str, Audit]:
    """Write a report in one of `FORMATS` into the audit; return its file name, and the audit. Errors: as `open_audits`; `OutputError`."""
    name, render = REPORT_FORMATS[report_format]
    with open_audits(dest) as (con, audit, _):
        audit.results.write(name, render(_result_of_audit(con, audit)))
    return name, audit


def _result_of_audit(con: duckdb.DuckDBPyConnection, audit: Audit) -> Result:
    view_prefix = create_counted_views(con)
    orders = {"verdicts": ORDER_OF_VERDICTS, "findings": ORDER_OF_FINDINGS}
    rows = {
        table: con.execute(
            statement("fleet_report/as_checked", of=view_prefix, table=table, order=order)
        ).to_arrow_table()
        for table, order in orders.items()
    }
    drives = con.execute(statement("fleet_report/drives_as_checked", of=view_prefix)).to_arrow_table()
    logs = dict(zip(drives["drive_id"].to_pylist(), drives["log"].to_pylist(), strict=True))
    here = {drive: log for drive, log in logs.items() if not is_url(log)}
    return Result(
        **rows,
        drives=drives.drop_columns(["log"]),
        rules=con.execute("FROM rules ORDER BY rule_id").to_arrow_table(),
        fail_on=audit.audit_json["fail_on"],
        strict=audit.audit_json.get("strict", False),  # older audits lack both keys
        min_judged=audit.audit_json.get("min_judged"),
        gate=_stored_gate(audit.results),
        run_options=RunRequest.from_options(CheckOptions(()), here),
    )


def _stored_gate(results: ResultStore) -> gate.Gate | None:
    """Return the gate that the audit's last run stored; None: it stored none."""
    content = results.read(GATE_FILE)
    if content is None:
        return None
    with TemporaryDirectory(prefix="drivelint-gate-") as home:
        (Path(home) / GATE_FILE).write_bytes(content)
        return gate.load(Path(home))
