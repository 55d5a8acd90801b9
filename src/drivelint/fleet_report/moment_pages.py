"""Pages with the moments of single drives of an audit: plan view, charts, player and camera pictures, as the report of a check has them.

An audit keeps verdicts and findings, but no positions. So each of these drives is judged again, from its log and by the settings of the
audit. The page is written only if the findings are the same.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple

import msgspec

from drivelint import run
from drivelint.audit.bucket import is_url
from drivelint.drive.trace import DriveInput
from drivelint.errors import DriveLintError
from drivelint.fleet_report.drive_pages import page_name
from drivelint.fleet_report.rows import options_column_sql, query_rows
from drivelint.report import html
from drivelint.report.progress import Silent

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import duckdb

    from drivelint.fleet_report.audit_views import Audit
    from drivelint.fleet_report.rows import Row
    from drivelint.report.progress import Progress
    from drivelint.result.model import Result

DEFAULT_N_DRIVES_WITH_MOMENTS: Final = 3
"""Number of drives whose moments are drawn by default."""
DEFAULT_MAX_STATES_OF_DRIVE_WITH_MOMENTS: Final = 200_000
"""By default, drives with more actor states are left out: to judge them again takes longer than a person waits for a page."""
_AUDIT_SETTINGS_FOR_NEW_CHECK: Final = ("rules", "ignore", "profiles", "params", "rules_dirs")


class MomentsPage(NamedTuple):
    """The page with the moments of a drive. `content`: empty if there is none, for this `reason`."""

    key: str
    name: str
    content: bytes
    reason: str


def worst_drives(con: duckdb.DuckDBPyConnection, n: int | None) -> list[Row]:
    """Return the worst drives that have a page and findings, after `drive_pages.choose_drives_and_return_page_names`.

    `n`: number of drives; None: `DEFAULT_N_DRIVES_WITH_MOMENTS`, without drives of more than
    `DEFAULT_MAX_STATES_OF_DRIVE_WITH_MOMENTS` states.
    """
    bound = {
        "most": DEFAULT_N_DRIVES_WITH_MOMENTS if n is None else n,
        "most_states": DEFAULT_MAX_STATES_OF_DRIVE_WITH_MOMENTS if n is None else None,
    }
    return query_rows(con, "moment_drives", bound, options=options_column_sql(con))


def pages_with_moments(drives: Sequence[Row], audit: Audit, progress: Progress) -> Iterator[MomentsPage]:
    """Judge these drives again, one by one; yield the moments of each."""
    if drives:
        progress.stage("drawing moments", len(drives))
    for drive in drives:
        progress.doing(drive["drive_id"])
        yield _page_with_moments(drive, audit)
        progress.advance()


def _page_with_moments(drive: Row, audit: Audit) -> MomentsPage:
    reason, content = "", b""
    try:
        result = _check_again(drive, audit)
        if reason := _difference_from_audit(result, drive):
            reason = f"{reason}: audit the drives again, or check this one alone"
        else:
            content = html.render(result, in_result_folder=False)
    except (DriveLintError, OSError, msgspec.MsgspecError) as error:
        reason = str(error)
    return MomentsPage(drive["key"], moments_page_name(drive["key"]), content, reason)


def _check_again(drive: Row, audit: Audit) -> Result:
    """Check a drive by the settings of its audit. Errors: `DriveLintError`."""
    if is_url(drive["log"]):
        raise DriveLintError("the log is in an object store: copy it, and check the copy")
    if not Path(drive["log"]).exists():
        raise DriveLintError(f"the log is not at {drive['log']} any more")
    options = msgspec.json.decode(drive["options"] or "{}", type=DriveInput, dec_hook=lambda kind, value: kind(value))
    rules, ignore, profiles, params, rules_dirs = (
        tuple(audit.settings.get(name, ())) for name in _AUDIT_SETTINGS_FOR_NEW_CHECK
    )
    request = run.CheckOptions(
        (drive["log"],),
        **{name: getattr(options, name) for name in options.__dataclass_fields__},
        rules=rules,
        ignore=ignore,
        profiles=profiles,
        params=params,
        rules_dirs=tuple(map(Path, rules_dirs)),
        robustness=bool(audit.settings.get("robustness", False)),
        annotate=False,
        evidence=True,
    )
    return run.check(request, Silent())


def _difference_from_audit(result: Result, drive: Row) -> str:
    """Return how a drive that was judged again differs from its result in the audit; empty: in nothing that counts."""
    (row,) = result.drives.to_pylist()
    if row["sha256"] != drive["sha256"]:
        return "the log has changed since the audit"
    if row["map_sha256"] != drive["map_sha256"]:
        return "the map has changed since the audit"
    if sorted(result.findings["finding_id"].to_pylist()) != drive["finding_ids"]:
        return "this version of drivelint gives other findings"
    return ""


def moments_page_name(drive_key: str) -> str:
    """Return the name of the page with a drive's moments."""
    return page_name(drive_key).removesuffix(".html") + "-moments.html"
