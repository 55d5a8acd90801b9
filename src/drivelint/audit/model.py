"""The data types of an audit: settings, one drive, a task for a worker, and the receipt that proves a drive's result."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field, replace
from pathlib import Path  # noqa: TC003 - msgspec reads it
from typing import TYPE_CHECKING, Any, Final, Literal

import msgspec

if TYPE_CHECKING:
    from drivelint.drive.trace import DriveInput

RECEIPT_VERSION: Final = 1
"""Version of the receipt format: raised when a field is removed or changes its meaning."""
Status = Literal["judged", "refused", "quarantined"]
"""`refused`: the log cannot be judged. `quarantined`: each process that judged the drive died or exceeded a limit."""


@dataclass(frozen=True)
class JudgeSettings:
    """The settings that determine the verdicts of an audit, besides its logs and maps. They have the names of the options of `check`."""

    rules: tuple[str, ...] = ()
    ignore: tuple[str, ...] = ()
    profiles: tuple[str, ...] = ()
    params: tuple[str, ...] = ()
    rules_dirs: tuple[Path, ...] = ()
    robustness: bool = False
    memory: int | None = None


@dataclass(frozen=True)
class AuditDrive:
    """One drive of an audit: a row of the manifest, or a log that was found in a folder.

    `log`: path or URL. `size` in bytes and `stamp` (time of the last change, or ETag) show whether a file is unchanged.
    `source_id`: hash of path, size, stamp, tags, options and run. `options_id`: hash of the options and of the map's content.
    """

    log: str
    options: DriveInput
    tags: dict[str, str] = field(default_factory=dict)
    size: int = 0
    stamp: str = ""
    source_id: str = ""
    options_id: str = ""

    def with_ids(self, size: int, stamp: str, run_id: str, options_id: str) -> AuditDrive:
        """Return the drive with the size and the stamp of its log, and with its ids."""
        source_id = digest([run_id, options_id, self.log, size, stamp, self.tags])
        return replace(self, size=size, stamp=stamp, source_id=source_id, options_id=options_id)

    @property
    def options_json(self) -> str:
        """The options as JSON, paths as text."""
        return msgspec.json.encode(self.options, enc_hook=str).decode()


@dataclass(frozen=True)
class Task:
    """Drives that a worker judges together, the place of the results, and how many workers were already lost on these drives."""

    drives: tuple[AuditDrive, ...]
    dest: str
    run_id: str
    settings: JudgeSettings
    attempts: int = 0


@dataclass(frozen=True)
class Receipt:
    """The proof that a drive was judged. It is written after the drive's results: a drive without a receipt has no result.

    `key`: hash of log, tags, map, options, rules, parameters, and versions. `batch`: name of the files that contain the drive's rows; the
    batch has `n_in_batch` drives.
    `off_map`: the map does not fit the drive. `rows_sha256`: hash of the drive's rows, independent of other drives in the files.
    `counts`: verdict -> number of rows. `failed`: severity -> number of failed verdicts of stable rules, which gate. `unknown`: number of
    unknown verdicts of stable rules.
    `beyond_limits`: number of the `error` verdicts whose rules exceeded their limit of time or memory. `options`: the drive's options as
    JSON.
    """

    key: str
    source_id: str
    batch: str
    status: Status
    log: str
    size: int
    stamp: str
    drive_id: str
    log_sha256: str | None
    map_sha256: str | None
    reason: str | None = None
    lossy: bool = False
    off_map: bool = False
    rows_sha256: str = ""
    km: float = 0.0
    duration_s: float = 0.0
    counts: dict[str, int] = field(default_factory=dict)
    failed: dict[str, int] = field(default_factory=dict)
    unknown: int = 0
    beyond_limits: int = 0
    tags: dict[str, str] = field(default_factory=dict)
    options: str = ""
    n_in_batch: int = 1
    reused: bool = False
    """The result existed before this run. This field is never stored."""
    version: int = RECEIPT_VERSION

    def to_json(self) -> bytes:
        """Return the receipt as the JSON that is stored."""
        values = msgspec.to_builtins(self)
        del values["reused"]
        return msgspec.json.encode(values, order="sorted") + b"\n"

    @classmethod
    def from_json(cls, content: bytes) -> Receipt:
        """Read a stored receipt. Errors: `msgspec.MsgspecError`."""
        return msgspec.json.decode(content, type=cls)


def digest(value: Any) -> str:
    """Return the SHA-256 of a value as JSON with sorted keys, paths as text."""
    return hashlib.sha256(msgspec.json.encode(value, enc_hook=str, order="sorted")).hexdigest()
