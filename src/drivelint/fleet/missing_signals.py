"""The signals that a fleet's logs and maps lack, and how much could be judged with them."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING

from drivelint.fleet.distinct_logs import subject
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Callable

    import duckdb


@dataclass(frozen=True)
class MissingSignal:
    """A signal that rules require and drives lack: how much recording it would decide, at most.

    `*_alone`: where nothing else that the rule requires is missing; the others need further signals, too. Where the signal is there, a rule
    may still be unknown for another reason, or not apply. `judgements`: pairs of a rule and an ego of a drive. `formats`: of the logs.
    """

    signal: str
    rules: int
    rules_alone: int
    drives: int
    drives_alone: int
    km: float
    km_alone: float
    judgements: int
    judgements_alone: int
    formats: list[str]


@dataclass(frozen=True)
class Undecided:
    """A reason of unknown verdicts though all required signals are there, such as an ego that is not placed for a while.

    `rule_id`, `reason`: one of the rules, and what one of its verdicts says.
    """

    reason_code: str
    cause_code: str | None
    rules: int
    drives: int
    verdicts: int
    rule_id: str
    reason: str


@dataclass(frozen=True)
class SignalGaps:
    """The undecided verdicts: those that lack a signal, and those with another reason. The most frequent come first."""

    signals: tuple[MissingSignal, ...]
    other_reasons: tuple[Undecided, ...]


def missing_signals(con: duckdb.DuckDBPyConnection, *, of: str = "") -> SignalGaps:
    """Return the signals that the drives lack, by the views whose names begin with `of`; a log that is there twice counts once."""
    egos = subject(of)
    signals = con.execute(statement("fleet/missing", of=of, subject=egos)).fetchall()
    other_reasons = con.execute(statement("fleet/undecided", of=of, subject=egos)).fetchall()
    return SignalGaps(
        tuple(MissingSignal(*row) for row in signals),
        tuple(Undecided(*row) for row in other_reasons),
    )


def __getattr__(name: str) -> Callable[..., SignalGaps]:
    """Return `missing_signals` under its earlier name `missing`, with a note that the name is deprecated."""
    if name != "missing":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    warnings.warn(f"{__name__}.missing is deprecated: use {__name__}.missing_signals", DeprecationWarning, stacklevel=2)
    return missing_signals
