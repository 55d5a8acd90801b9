"""Writes pages about single drives of an audit, one file each: facts, findings, unknown verdicts and their reasons.

One statement per table of the audit copies the rows of all chosen drives into temporary tables, which are read in groups of drives. Neither
the number of scans nor the memory of this process grows with the number of drives.
"""

from __future__ import annotations

import hashlib
import re
import shlex
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Final, NamedTuple

from drivelint.audit.bucket import is_url
from drivelint.fleet_report import figures
from drivelint.fleet_report.drive_command import check_command
from drivelint.fleet_report.rows import (
    finding_per_event_sql,
    options_column_sql,
    query_rows,
    ranked_drives_sql,
    severity_order_sql,
)
from drivelint.phrases import plural
from drivelint.reasons.signals import DEFAULT_REMEDY, remedy
from drivelint.report.html.anchors import anchor
from drivelint.report.html.environment import page_environment
from drivelint.result.certainty import doubt_words
from drivelint.result.counts import SEVERITIES, VERDICTS, group_rows, rows_and_findings_sentence
from drivelint.result.text import ego_name, utc_at
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    import duckdb
    from jinja2 import Environment

    from drivelint.fleet_report.audit_views import Audit
    from drivelint.fleet_report.rows import Row

DRIVE_PAGES_FOLDER: Final = "drives"
DEFAULT_N_DRIVE_PAGES: Final = 100
"""Default number of drives that get a page."""
MAX_FINDINGS_PER_PAGE: Final = 200
"""Largest number of findings on a page."""
MAX_REASONS_AND_NOTES: Final = 40
"""Largest number of reasons for unknown verdicts on a page, and of notes on the data."""
_DRIVES_AT_A_TIME: Final = 100
_SHA256: Final = re.compile(r"[0-9a-f]{64}")
_PAGE_FILE_NAME: Final = re.compile(rf"{_SHA256.pattern}(-moments)?\.html")
_HERE: Final = Path(__file__).parent


class MomentsLink(NamedTuple):
    """The page with the moments of a drive. `name`: None where there is none, for this `reason`."""

    name: str | None
    reason: str


NO_MOMENTS_LINKS: Final[Mapping[str, MomentsLink]] = MappingProxyType({})


def page_name(drive_key: str) -> str:
    """Return the file name of a drive's page. A key that is not a SHA-256 may contain anything, so its hash is used instead."""
    plain = (
        drive_key
        if _SHA256.fullmatch(drive_key)
        else hashlib.sha256(drive_key.encode("utf-8", "surrogatepass")).hexdigest()
    )
    return f"{DRIVE_PAGES_FOLDER}/{plain}.html"


def is_page_name(name: str) -> bool:
    """Return whether a name is that of a drive's page, or of the page with its moments."""
    folder, _, file = name.rpartition("/")
    return folder == DRIVE_PAGES_FOLDER and _PAGE_FILE_NAME.fullmatch(file) is not None


def choose_drives_and_return_page_names(con: duckdb.DuckDBPyConnection, max_drives: int | None) -> list[str]:
    """Choose the drives that get a page, and return the names of the pages. `fleet_content` must run before.

    `max_drives`: the number of drives with findings, the worst first; None: all drives of the audit.
    """
    con.execute(statement("fleet_report/page_drives", ranked=ranked_drives_sql()), {"most": max_drives})
    return [page_name(key) for (key,) in con.execute("SELECT key FROM page_drive ORDER BY no").fetchall()]


def page_urls(con: duckdb.DuckDBPyConnection, drive_keys: Iterable[str | None]) -> dict[str, str]:
    """Return key -> relative URL of the page, for those of the given drives that have a page."""
    keys = sorted({key for key in drive_keys if key is not None})
    page_drives = con.execute("SELECT key FROM page_drive WHERE list_contains($keys, key) ORDER BY no", {"keys": keys})
    return {key: page_name(key) for (key,) in page_drives.fetchall()}


def pages(
    con: duckdb.DuckDBPyConnection,
    audit: Audit,
    rules: Mapping[str, Row],
    moments: Mapping[str, MomentsLink] = NO_MOMENTS_LINKS,
) -> Iterator[tuple[str, bytes]]:
    """Yield the name and content of each chosen drive's page.

    `rules`: rule_id -> row of the table `rule`. `moments`: key of a drive -> the page with its moments.
    """
    con.execute(statement("fleet_report/page_facts", options=options_column_sql(con)))
    con.execute(
        statement(
            "fleet_report/page_findings", gravest_first=severity_order_sql(), event=finding_per_event_sql("paged_")
        ),
        {"most": MAX_FINDINGS_PER_PAGE},
    )
    con.execute(statement("fleet_report/page_verdicts"))
    (n_pages,) = con.execute("SELECT count(*) FROM page_drive").fetchone() or (0,)
    template = _template_environment().get_template("drive.html.j2")
    same = {
        "audit": audit,
        "titles": {rule_id: rule["title"] for rule_id, rule in rules.items()},
        "rules": rules,
        "severities": SEVERITIES,
        "verdicts": VERDICTS,
        "max_notes": MAX_REASONS_AND_NOTES,
    }
    for first in range(1, n_pages + 1, _DRIVES_AT_A_TIME):
        for drive_values in _template_values(con, audit, first, first + _DRIVES_AT_A_TIME - 1):
            key = drive_values["drive"]["key"]
            values = same | drive_values | {"moments": moments.get(key)}
            yield page_name(key), template.render(values).encode("utf-8", "replace")


def _template_values(con: duckdb.DuckDBPyConnection, audit: Audit, first: int, last: int) -> Iterator[Row]:
    """Yield the values of the template for each drive with a number from `first` to `last`."""
    bound = {"first": first, "last": last}
    facts = query_rows(con, "page_some", bound, table="page_facts", order="no")
    findings = query_rows(con, "page_some", bound, table="page_finding", order="no, nth")
    parts = (findings, query_rows(con, "page_counts", bound), query_rows(con, "page_undecided", bound))
    by_drive = [group_rows(part, lambda row: row["no"]) for part in parts]
    for drive in facts:
        yield _page_content(audit, drive, *(part.get(drive["no"], []) for part in by_drive))


def _page_content(
    audit: Audit, drive: Row, findings: list[Row], verdict_counts: list[Row], undecided: list[Row]
) -> Row:
    for row in findings:
        row |= {"doubt": doubt_words(row), "utc": utc_at(row["t_worst_ns"], drive)}
    for row in undecided:
        row["mend"] = remedy(row["reason_code"], None, drive["format"] or "mapped")
    counts = dict.fromkeys(VERDICTS, 0) | {row["verdict"]: row["n"] for row in verdict_counts}
    by_severity = {name: findings[0][f"n_{name}"] if findings else 0 for name in SEVERITIES}
    n_rows, n_findings = findings[0]["n_rows"] if findings else 0, sum(by_severity.values())
    home = f"{DRIVE_PAGES_FOLDER}/{drive['drive_id']}"
    worst = [findings[0]["finding_id"]] if findings else []
    return {
        "drive": drive | {"tags": sorted(drive["tags"] or ()), "utc": utc_at(drive["t_start_ns"], drive)},
        "headline": _headline(drive, by_severity, counts),
        "findings": findings,
        "n_findings": n_findings,
        "n_rows": n_rows,
        "rows_sentence": rows_and_findings_sentence(
            n_rows, n_findings, has_profile_repeats=bool(findings and findings[0]["is_of_profiles"])
        ),
        "counts": counts,
        "undecided": undecided,
        "lacking": group_rows(drive["not_judged"], lambda lack: (lack["signal"], lack["reason"])),
        "command": check_command(drive["log"], drive["options"], audit.settings, drive["drive_id"]),
        "explain": [shlex.join(["drivelint", "explain", finding_id, "--in", home]) for finding_id in worst],
        "is_stored": is_url(drive["log"]),
    }


def _headline(drive: Row, by_severity: Mapping[str, int], counts: Mapping[str, int]) -> tuple[str, str]:
    """Return the outcome (fail, unknown or pass) of a drive, and the sentence at the top of its page."""
    if drive["status"] != "judged":
        return "unknown", "Could not be judged"
    if n := sum(by_severity.values()):
        counts_text = ", ".join(f"{count:,} {name}" for name, count in by_severity.items() if count)
        return "fail", f"{counts_text} {'finding' if n == 1 else 'findings'}"
    if not counts["pass"]:
        return "unknown", "Nothing could be decided"
    if counts["unknown"] or counts["error"]:
        return "unknown", "No finding, but not everything could be judged"
    return "pass", "No finding"


@cache
def _template_environment() -> Environment:
    environment = page_environment(
        ("tables.js",),
        _HERE / "templates",
        ("fleet.css", "drive.css"),
        base_styles=("report.css", "narrow.css", "first.css"),
    )
    environment.filters |= {"ego_name": ego_name, "figure": figures.number_text, "plural": plural}
    environment.globals |= {"what_is_null": DEFAULT_REMEDY, "anchor": anchor}
    return environment
