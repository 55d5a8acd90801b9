"""The data of an audit: its request, one drive of it, a task for a worker, and the receipt that proves a drive's result."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field, replace
from pathlib import Path  # noqa: TC003 - msgspec reads it
from typing import TYPE_CHECKING, Any, Final, Literal

import msgspec

if TYPE_CHECKING:
    from drivelint.drive.trace import DriveInput

RECEIPT_VERSION: Final = 1
"""Version of receipts: raised when a field changes its meaning or goes."""
Status = Literal["judged", "refused", "quarantined"]
"""judged; refused: the log cannot be judged; quarantined: each process that judged the drive died or took too long."""


@dataclass(frozen=True)
class JudgeSettings:
    """The settings that decide the verdicts of an audit besides its logs and maps: the options of `check` of the same names."""

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

    `log`: path or URL. `size` in bytes and `stamp` (time of the last change, or ETag) identify an unchanged file.
    `source_id`: hash of them, of the tags, of the options and of the run; `options_id`: hash of the options and of what the map holds.
    """

    log: str
    options: DriveInput
    tags: dict[str, str] = field(default_factory=dict)
    size: int = 0
    stamp: str = ""
    source_id: str = ""
    options_id: str = ""

    def with_ids(self, size: int, stamp: str, run_id: str, options_id: str) -> AuditDrive:
        """Return the drive with the data of its log, and its ids."""
        source_id = digest([run_id, options_id, self.log, size, stamp, self.tags])
        return replace(self, size=size, stamp=stamp, source_id=source_id, options_id=options_id)

    @property
    def options_json(self) -> str:
        """The options as JSON, paths as text."""
        return msgspec.json.encode(self.options, enc_hook=str).decode()


@dataclass(frozen=True)
class Task:
    """Drives that a worker judges together, where it puts the results, and how often workers were lost over them."""

    drives: tuple[AuditDrive, ...]
    dest: str
    run_id: str
    settings: JudgeSettings
    attempts: int = 0

    @property
    def size(self) -> int:
        """Bytes of all logs."""
        return sum(drive.size for drive in self.drives)


@dataclass(frozen=True)
class Receipt:
    """The proof that a drive was judged, written after its results: a drive without one has no result.

    `key`: hash of log, tags, map, options, rules, parameters, and versions. `batch`: the file of each table that has its rows, beside those
    of `n_in_batch` drives in all.
    `off_map`: the map does not fit it. `rows_sha256`: hash of these rows, whatever other drives are in the file.
    `counts`: verdict -> rows; `failed`: severity -> failed verdicts of stable rules, which gate; `unknown`: unknown ones of stable rules.
    `beyond_limits`: of the verdicts that are errors, those of rules that took too much time or memory.
    `options`: those of the drive, as JSON.
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
    """The result existed before. This is only for this run and is never stored."""
    version: int = RECEIPT_VERSION

    def to_json(self) -> bytes:
        """Return the receipt as it is stored."""
        told = msgspec.to_builtins(self)
        del told["reused"]
        return msgspec.json.encode(told, order="sorted") + b"\n"

    @classmethod
    def from_json(cls, content: bytes) -> Receipt:
        """Read a stored receipt. Errors: `msgspec.MsgspecError`."""
        return msgspec.json.decode(content, type=cls)


def digest(value: Any) -> str:
    """Return the SHA-256 of a value as JSON with sorted keys, paths as text."""
    return hashlib.sha256(msgspec.json.encode(value, enc_hook=str, order="sorted")).hexdigest()
