"""Opens one or two audits as views of one database."""

from __future__ import annotations

import json
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Final

from drivelint.audit import parts
from drivelint.audit.bucket import as_url
from drivelint.audit.compact import create_views, database
from drivelint.audit.run import AUDIT_FILE, SUMMARY_FILE
from drivelint.audit.store import open_store
from drivelint.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Iterator

    import duckdb

    from drivelint.audit.store import ResultStore

BASE: Final = "base_"
"""What the names of the views of the earlier audit begin with; those of the other begin with nothing."""


@dataclass(frozen=True)
class Audit:
    """An audit that was opened: where it lies, and what `audit.json` says.

    `digest`: the hash of all rows; None: the audit has not ended, or is not packed. `n_loose`: drives that were judged since and are
    not packed, so that no view has them.
    """

    dest: str
    results: ResultStore
    told: dict[str, Any]
    digest: str | None
    n_loose: int
    missing_parts: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """The last part of where it lies."""
        return self.dest.rstrip("/").rpartition("/")[2] if "://" in self.dest else Path(self.dest).resolve().name

    @property
    def settings(self) -> dict[str, Any]:
        """What decided the verdicts: the fields of `JudgeSettings` but `memory`."""
        found: dict[str, Any] = self.told["settings"]
        return found

    @property
    def version(self) -> str | None:
        """The version of drivelint that made it."""
        found: str | None = self.told.get("versions", {}).get("drivelint")
        return found

    @property
    def warning(self) -> str:
        """What is not in its tables though it was or will be judged; '' where nothing is."""
        if self.digest is not None and not self.n_loose and not self.missing_parts:
            return ""
        more = f"{self.n_loose} judged drives are not packed yet; " if self.n_loose else ""
        again = (
            "give the same audit again"
            if self.missing_parts in {(), (parts.ALL,)}
            else (f"parts without an end: {', '.join(self.missing_parts)}; give them again, then drivelint merge")
        )
        return f"{self.dest}: the audit has not ended: {more}{again}, to have all"


def destination(path: Path) -> str:
    """Return what was given as the place of results: a URL, or a path."""
    return as_url(path) or str(path)


def is_audit(dest: str) -> bool:
    """Whether `audit --out` wrote there."""
    return open_store(dest).read(AUDIT_FILE) is not None


@contextmanager
def opened(dest: str, base: str | None = None) -> Iterator[tuple[duckdb.DuckDBPyConnection, Audit, Audit | None]]:
    """Open an audit, and an earlier one under the names that begin with `BASE`. Errors: `UsageError` where none is."""
    with database() as con, TemporaryDirectory(prefix="drivelint-views-") as home:
        found = _open(con, dest, Path(home) / "new", "")
        yield con, found, None if base is None else _open(con, base, Path(home) / "base", BASE)


@contextmanager
def opened_both(base: str, new: str) -> Iterator[tuple[duckdb.DuckDBPyConnection, Audit, Audit]]:
    """Open two audits, the earlier one under the names that begin with `BASE`. Errors: `UsageError` where none is."""
    with opened(new, base) as (con, later, earlier):
        if earlier is None:
            raise UsageError(f"{base}: no audit is here")
        yield con, earlier, later


def _open(con: duckdb.DuckDBPyConnection, dest: str, home: Path, prefix: str) -> Audit:
    home.mkdir()
    results = open_store(dest)
    content = results.read(AUDIT_FILE)
    if content is None:
        raise UsageError(f"{dest}: no audit is here: name the folder that audit --out wrote")
    create_views(con, results, home, prefix)
    summary = json.loads(results.read(SUMMARY_FILE) or b"{}")
    n_loose = sum(1 for _ in results.names("receipts"))
    return Audit(dest, results, json.loads(content), summary.get("digest"), n_loose, tuple(parts.missing(results)))
