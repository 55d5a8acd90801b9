"""Finds the signals that a fleet's logs and maps lack, and how much could be judged with each signal."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING

from drivelint.fleet.distinct_logs import counted_egos_sql
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Callable

    import duckdb


@dataclass(frozen=True)
class MissingSignal:
    """A signal that rules require and drives lack, with an upper bound of what the signal would decide.

    `*_alone`: counts where this signal is the only missing one. The other counts include rules that lack further signals. Even with the
    signal, a rule may be unknown for another reason, or not apply. `judgements`: pairs of a rule and an ego of a drive. `formats`: formats
    of the logs.
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
class UndecidedReason:
    """A reason for unknown verdicts although all required signals are present, such as an ego that could not be placed in a lane for a
    while.

    `rule_id`, `reason`: an example: one of the rules, and the text of one of its verdicts.
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
    """The causes of undecided verdicts: missing signals, and other reasons. The most frequent come first."""

    signals: tuple[MissingSignal, ...]
    other_reasons: tuple[UndecidedReason, ...]


def missing_signals(con: duckdb.DuckDBPyConnection, *, of: str = "") -> SignalGaps:
    """Return the signals that the drives lack. `of`: prefix of the views' names. Several results of the same log count once."""
    egos = counted_egos_sql(of)
    signals = con.execute(statement("fleet/missing", of=of, subject=egos)).fetchall()
    other_reasons = con.execute(statement("fleet/undecided", of=of, subject=egos)).fetchall()
    return SignalGaps(
        tuple(MissingSignal(*row) for row in signals),
        tuple(UndecidedReason(*row) for row in other_reasons),
    )


def __getattr__(name: str) -> Callable[..., SignalGaps]:
    """Return `missing_signals` by its earlier name `missing`, and warn that the name is deprecated."""
    if name != "missing":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    warnings.warn(f"{__name__}.missing is deprecated: use {__name__}.missing_signals", DeprecationWarning, stacklevel=2)
    return missing_signals
