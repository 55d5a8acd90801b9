"""The requests to `pack` and `verify`, and the result of `verify`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from drivelint.pack.bag import Problem

MOST_FINDINGS: Final = 100
"""Of so many findings of an audit a pack has the rows, unless it is asked for more."""


@dataclass(frozen=True)
class PackRequest:
    """A request to `pack`: a result folder, the folder of the pack, its content, the signing key, the time stamp.

    `findings`: of an audit, the rows of so many of the worst findings go into it; None: of all. A check's all do.
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
    findings: int | None = MOST_FINDINGS


class Content(NamedTuple):
    """What makes a pack of a result: writes its payload and returns what `evidence.json` says; returns its statement."""

    payload: Callable[[Path], dict[str, Any]]
    statement: Callable[[Path, dict[str, Any]], bytes]


@dataclass(frozen=True)
class VerifyRequest:
    """A request to `verify`: a pack, the required signer and time stamp authority, and the paths of log and map if they are not in it.

    `require_signature`: a missing `key`, which identifies the signer, is a problem. `not_before`: the earliest day of its
    Bagging-Date, as 2026-11-26; None: any, or none.
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
    """The problems of a pack, a sentence if there are none, and what was not examined."""

    problems: list[Problem]
    sentence: str
    notes: list[str]
