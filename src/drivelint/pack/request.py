"""The requests to `pack` and `verify`, and the result of `verify`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from drivelint.pack.bag import Problem

DEFAULT_PACKED_FINDINGS: Final = 100
"""Default number of findings of an audit whose rows are in its pack."""


@dataclass(frozen=True)
class PackRequest:
    """A request to `pack`: a result folder, the folder of the pack, its content, the signing key, the time stamp.

    `findings`: number of worst findings of an audit whose rows go into the pack; None: all. The pack of a check has all findings.
    """

    folder: Path
    out: Path
    key: Path | None = None
    with_inputs: bool = False
    traces: tuple[Path, ...] = ()
    map: Path | None = None
    date: str | None = None
    timestamp: Path | None = None
    overwrite: bool = False
    findings: int | None = DEFAULT_PACKED_FINDINGS


class PackContentFunctions(NamedTuple):
    """The two functions that make a pack. `payload` writes the payload into a folder and returns the content of `evidence.json`.

    `statement` returns the bytes of the statement.
    """

    payload: Callable[[Path], dict[str, Any]]
    statement: Callable[[Path, dict[str, Any]], bytes]


@dataclass(frozen=True)
class VerifyRequest:
    """A request to `verify`: a pack, the required signer and time stamp authority, and paths of logs and map that are not in the pack.

    `require_signature`: report a problem if no `key` is given, because only a key identifies the signer. `not_before`: the earliest allowed
    Bagging-Date, such as 2026-11-26; None: any date, or no date.
    """

    folder: Path
    key: Path | None = None
    traces: tuple[Path, ...] = ()
    map: Path | None = None
    timestamp_root: Path | None = None
    require_signature: bool = False
    not_before: str | None = None


@dataclass(frozen=True)
class Verification:
    """The result of `verify`: the problems of a pack, a sentence for a pack without problems, and notes on what was not examined."""

    problems: list[Problem]
    sentence: str
    notes: list[str]
