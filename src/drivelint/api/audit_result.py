"""The result of an audit as a Python object."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pyarrow as pa

from drivelint.api.arguments import with_argument_checks
from drivelint.api.tables import Table, TableSet
from drivelint.errors import UsageError
from drivelint.fleet import rates
from drivelint.fleet.distinct_logs import create_counted_views
from drivelint.fleet_report import gated
from drivelint.fleet_report.audit_views import is_audit, open_audits, path_or_url
from drivelint.phrases import name_list
from drivelint.report.outcome import headline
from drivelint.report.outputs import REPORT_FORMATS
from drivelint.result.counts import one_finding_per_event
from drivelint.result.model import exit_status

if TYPE_CHECKING:
    from drivelint.options.types import AnyPath

_SCHEMA_OF_TABLE = {
    "verdicts": "verdict",
    "findings": "finding",
    "drives": "drive",
    "rules": "rule",
    "events": "finding",
}


class AuditResult(TableSet):
    """The result of an audit: its tables, its gate, and its rates. In the tables, logs with the same content are one drive.

    `verdicts`, `findings`, `drives`, `rules`: as for a check. `events`: one finding per event; a touch of two egos, or an overtake under
    several profiles, is one event. `logs`: the path and the tags of each drive's log. All rows are in memory: about 0.3 MB per drive,
    if all rules were run.
    """

    verdicts: Table
    findings: Table
    drives: Table
    rules: Table
    events: Table
    logs: Table

    @with_argument_checks
    def __init__(self, folder: AnyPath) -> None:
        """Open a folder that `audit --out` wrote. Errors: `DriveLintError` for a folder without an audit."""
        self._dest = path_or_url(Path(folder))
        if not is_audit(self._dest):
            raise UsageError(f"{folder}: no audit is here: name the folder that drivelint audit --out wrote")
        self._result = gated.audit_result(self._dest)
        findings = self._result.findings
        tables = {name: getattr(self._result, name) for name in ("verdicts", "findings", "drives", "rules")}
        tables["events"] = pa.Table.from_pylist(one_finding_per_event(findings.to_pylist()), schema=findings.schema)
        with open_audits(self._dest) as (con, audit, _):
            prefix = create_counted_views(con)
            tables["logs"] = con.execute(
                f"SELECT drive_id, log, tags FROM {prefix}drives ORDER BY ALL"
            ).to_arrow_table()
            self.notes = tuple(filter(None, [audit.warning]))
        super().__init__(tables, schema_tables=_SCHEMA_OF_TABLE)
        for name, table in self.tables.items():
            setattr(self, name, table)

    @property
    def exit_code(self) -> int:
        """The exit code from the findings, the unknown verdicts, and the gate of the last `drivelint audit`."""
        return int(exit_status(self._result).code)

    @property
    def why(self) -> str:
        """The reason for the exit code, in one sentence."""
        return exit_status(self._result).why

    @with_argument_checks
    def rates(self, by: str | None = None) -> Table:
        """Return the rates of events per 100 km, per hour and per occasion, one row per rule and profile.

        `by`: a tag or situation, to have one row per rule, profile and value. Each rate is a struct of `rate`, `low` and `high` (95 %).
        Errors: `DriveLintError` for a tag that no drive has.
        """
        with open_audits(self._dest) as (con, _, _):
            rows = [_rate_row(rate) for rate in rates.rates(con, by)]
        return Table(pa.Table.from_pylist(rows))

    @with_argument_checks
    def report(self, *, to: str) -> str:
        """Return a report as text. `to`: junit or sarif. For the pages of a fleet, use `drivelint report`."""
        if to not in gated.FORMATS:
            raise UsageError(f"to={to!r}: of an audit there are {name_list(gated.FORMATS)}")
        return REPORT_FORMATS[to][1](self._result).decode()

    def __repr__(self) -> str:
        return f"<drivelint.AuditResult: {headline(self._result).sentence}; exit code {self.exit_code}>"


def _rate_row(rate: rates.Rate) -> dict[str, Any]:
    """Return a rate as a row, with its estimates as structs."""
    columns = asdict(rate)
    for name in ("per_100km", "per_hour", "per_occasion", "per_ego"):
        columns[name] = getattr(rate, name)._asdict()
    return columns
