"""Fleet pages of rows that are made by hand, as text."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import duckdb
from lxml import html

from drivelint.audit.compact import RECEIPT_SCHEMA
from drivelint.audit.store import LocalFolder
from drivelint.audit.unpacked import AuditProgress
from drivelint.fleet_report import content as content_
from drivelint.fleet_report import page
from drivelint.fleet_report.audit_views import Audit
from tests.fleet import audits
from tests.fleet.audits import drive_finding, drive_verdict
from tests.report.synthetic import rule

CONTACT = rule("z-contact", profiles=[], tags=["contact"], title="No collision")
ROOM = rule("a-room", profiles=[], title="Room")


def words_of(element: Any) -> str:
    return " ".join(element.text_content().split())


class FleetPage:
    """The page of a fleet as text."""

    def __init__(self, drives: list[Any], verdicts: list[Any], findings: list[Any], *by: str, **settings: Any) -> None:
        verdicts = [{**row, "t_start_ns": None, "object_id": None} for row in verdicts]
        with duckdb.connect() as con:
            audits.add_rows(con, drives, verdicts, findings, [ROOM, CONTACT])
            con.register("receipts", RECEIPT_SCHEMA.empty_table())
            audit = Audit("out", LocalFolder(Path("out")), {"settings": settings}, AuditProgress("d"))
            self.content = content_.fleet_content(con, audit, None, by)
        self.markdown = page.markdown(self.content).decode()
        self.html: Any = html.fromstring(page.html(self.content))
        (header,) = self.html.findall(".//header")
        self.header = words_of(header)

    def row(self, table: str, name: str) -> Any:
        rows: list[Any] = self.html.xpath(f"{table}//tbody/tr")
        return next(row for row in rows if name in str(row.xpath("string(th)")))


def contact(drive_id: str, n: int = 0, **over: Any) -> dict[str, Any]:
    return drive_finding(drive_id, rule_id="z-contact", finding_id=f"{drive_id}-{n}", t_worst_s=12.5, **over)


def words(drive_id: str, word: str = "pass", **over: Any) -> list[Any]:
    return [drive_verdict(drive_id, word, **({"rule_id": name} | over)) for name in ("a-room", "z-contact")]
