"""Opens one or two audits as views in one database."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Final

import pyarrow as pa

from drivelint.audit.bucket import url_of_path
from drivelint.audit.compact import open_database
from drivelint.audit.run import AUDIT_FILE, read_audit_file
from drivelint.audit.sealed import require_audit_unchanged
from drivelint.audit.store import open_store
from drivelint.audit.unpacked import create_views_of_all_results
from drivelint.audit.worker import TABLES
from drivelint.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import duckdb

    from drivelint.audit.store import ResultStore
    from drivelint.audit.unpacked import AuditProgress

BASE_PREFIX: Final = "base_"
"""The prefix of the earlier audit's views; the views of the other audit have no prefix."""


_ALL_LOGS_VIEW_PREFIX: Final = "whole_"


@dataclass(frozen=True)
class Audit:
    """An open audit: its place, the content of `audit.json`, and its progress."""

    dest: str
    results: ResultStore
    audit_json: dict[str, Any]
    standing: AuditProgress

    @property
    def digest(self) -> str | None:
        """The hash of all rows; None: the audit has not ended."""
        return self.standing.digest

    @property
    def name(self) -> str:
        """The last part of the audit's path or URL."""
        return self.dest.rstrip("/").rpartition("/")[2] if "://" in self.dest else Path(self.dest).resolve().name

    @property
    def settings(self) -> dict[str, Any]:
        """The settings that determined the verdicts: the fields of `JudgeSettings` without `memory`."""
        settings: dict[str, Any] = self.audit_json["settings"]
        return settings

    @property
    def version(self) -> str | None:
        """The version of drivelint that made the audit; None: not known."""
        version: str | None = self.audit_json.get("versions", {}).get("drivelint")
        return version

    @property
    def warning(self) -> str:
        """A sentence that the audit has not ended; '' if it has ended."""
        return self.standing.warning and f"{self.dest}: {self.standing.warning}"


def path_or_url(path: Path) -> str:
    """Return the place of results, a URL or a path, as text."""
    return url_of_path(path) or str(path)


def is_audit(dest: str) -> bool:
    """Return whether `audit --out` wrote to this place."""
    return open_store(dest).read(AUDIT_FILE) is not None


@contextmanager
def open_audits(dest: str, base: str | None = None) -> Iterator[tuple[duckdb.DuckDBPyConnection, Audit, Audit | None]]:
    """Open an audit, and optionally an earlier one, whose views have the prefix `BASE_PREFIX`.

    Errors: `UsageError` if there is no audit, or if its files were changed.
    """
    with open_database() as con, TemporaryDirectory(prefix="drivelint-views-") as home:
        audit = _open_audit(con, dest, Path(home) / "new", "")
        yield con, audit, None if base is None else _open_audit(con, base, Path(home) / "base", BASE_PREFIX)


@contextmanager
def open_audit_leaving_out_logs(
    dest: str, sha256s: Sequence[str]
) -> Iterator[tuple[duckdb.DuckDBPyConnection, Audit, int]]:
    """Open an audit without the logs that have one of these hashes; also yield how many of its drives are left out.

    Errors: as `open_audits`.
    """
    with open_database() as con, TemporaryDirectory(prefix="drivelint-views-") as home:
        audit = _open_audit(con, dest, Path(home) / "new", _ALL_LOGS_VIEW_PREFIX)
        con.register("left_out_log", pa.table({"sha256": pa.array(sha256s, pa.string())}))
        con.execute(
            f"CREATE TEMP TABLE own_key AS SELECT key FROM {_ALL_LOGS_VIEW_PREFIX}drives ANTI JOIN left_out_log USING (sha256)"
        )
        for table in (*TABLES, "receipts"):
            con.execute(
                f"CREATE TEMP VIEW {table} AS FROM {_ALL_LOGS_VIEW_PREFIX}{table} SEMI JOIN own_key USING (key)"
            )
        con.execute(f"CREATE TEMP VIEW rules AS FROM {_ALL_LOGS_VIEW_PREFIX}rules")
        (n,) = con.execute(
            f"SELECT count(*) FROM {_ALL_LOGS_VIEW_PREFIX}drives ANTI JOIN own_key USING (key)"
        ).fetchall()[0]
        yield con, audit, n


@contextmanager
def open_audit_in_evidence_pack(folder: Path) -> Iterator[tuple[duckdb.DuckDBPyConnection, Audit]]:
    """Open the audit in an evidence pack. Changed files are not detected here, because `verify` checks them itself. Errors: as
    `open_audits`."""
    with open_database() as con, TemporaryDirectory(prefix="drivelint-views-") as home:
        yield con, _open_audit(con, str(folder), Path(home) / "new", "", is_in_evidence_pack=True)


@contextmanager
def open_two_audits(base: str, new: str) -> Iterator[tuple[duckdb.DuckDBPyConnection, Audit, Audit]]:
    """Open two audits; the views of the earlier one have the prefix `BASE_PREFIX`. Errors: as `open_audits`."""
    with open_audits(new, base) as (con, later, earlier):
        if earlier is None:
            raise UsageError(f"{base}: no audit is here")
        yield con, earlier, later


def _open_audit(
    con: duckdb.DuckDBPyConnection,
    dest: str,
    views_folder: Path,
    views_prefix: str,
    *,
    is_in_evidence_pack: bool = False,
) -> Audit:
    views_folder.mkdir()
    results = open_store(dest)
    audit_json = read_audit_file(results, dest)
    if audit_json is None:
        raise UsageError(f"{dest}: no audit is here: name the folder that audit --out wrote")
    if not is_in_evidence_pack:
        require_audit_unchanged(results, views_folder, dest)
    return Audit(dest, results, audit_json, create_views_of_all_results(con, results, views_folder, views_prefix))
