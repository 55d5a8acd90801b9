"""Velocities that the log does not have: derived from positions, never without saying so."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from drivelint.ingest.order import Steps, listed, rate
from drivelint.ingest.trace import Finding

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from drivelint.ingest.trace import States

MOVED_M = 1.0
"""An actor whose positions spread by more moves; below it a parked car's position noise would become a speed."""


def complete_motion(states: States, step: Steps) -> list[Finding]:
    """Fill velocities that are absent, or zero although the actor moves; drop accelerations that were never measured.

    `states` in order, changed in place: every column of `NUMBERS` exists afterwards.
    """
    from drivelint.ingest.trace import NUMBERS

    n = len(states)
    for name in NUMBERS:
        states.numbers.setdefault(name, np.full(n, np.nan))
    if n == 0:
        return []
    starts = np.flatnonzero(np.r_[True, ~step.same])
    findings = _velocity(states, step, starts)
    findings += _acceleration(states, starts)
    return findings


def _velocity(states: States, step: Steps, starts: NDArray[np.intp]) -> list[Finding]:
    numbers = states.numbers
    vx, vy = numbers["vx_mps"], numbers["vy_mps"]
    absent = np.logical_and.reduceat(np.isnan(vx) & np.isnan(vy), starts)
    still = ~absent & np.logical_and.reduceat((vx == 0.0) & (vy == 0.0), starts)
    if not (absent.any() or still.any()):
        return []
    spread = np.zeros(len(starts))
    for name in ("x_m", "y_m"):
        values = numbers[name]
        extent = np.fmax.reduceat(values, starts) - np.fmin.reduceat(values, starts)
        spread = np.maximum(spread, np.nan_to_num(extent))
    false_zero = still & (spread > MOVED_M)
    findings = []
    for check, which, why in (
        ("velocity_derived", absent, "no velocity in the log"),
        ("velocity_derived", false_zero, "velocity 0 throughout although the positions move"),
    ):
        if not which.any():
            continue
        ids = [states.ids[i] for i in states.actor[starts[which]]]
        rows = _rows_of(which, starts, len(states))
        numbers["vx_mps"] = np.where(rows, rate(numbers["x_m"], step), numbers["vx_mps"])
        numbers["vy_mps"] = np.where(rows, rate(numbers["y_m"], step), numbers["vy_mps"])
        message = f"{why} ({listed(ids)}): velocity is derived from positions by central differences"
        findings.append(
            Finding(
                check,
                "warning",
                message,
                int(rows.sum()),
                int(states.t_ns[rows].min()),
                ids[0] if len(ids) == 1 else None,
            )
        )
    return findings


def _acceleration(states: States, starts: NDArray[np.intp]) -> list[Finding]:
    """Take accelerations that are zero for every actor, although velocities change, for what they are: not recorded."""
    ax, ay = states.numbers["ax_mps2"], states.numbers["ay_mps2"]
    known = ~(np.isnan(ax) & np.isnan(ay))
    if not known.any() or (ax[known] != 0.0).any() or (ay[known] != 0.0).any():
        return []
    changes = False
    for name in ("vx_mps", "vy_mps"):
        values = states.numbers[name]
        changes |= bool(np.any(np.fmax.reduceat(values, starts) - np.fmin.reduceat(values, starts) > 0.5))
    if not changes:
        return []
    states.numbers["ax_mps2"] = np.full(len(states), np.nan)
    states.numbers["ay_mps2"] = np.full(len(states), np.nan)
    n = int(known.sum())
    return [
        Finding(
            "acceleration_not_recorded",
            "info",
            f"acceleration is 0 in all {n} states although speeds change: it counts as not recorded",
            n,
            int(states.t_ns[known].min()),
        )
    ]


def _rows_of(actors: NDArray[np.bool_], starts: NDArray[np.intp], n: int) -> NDArray[np.bool_]:
    return np.repeat(actors, np.diff(np.r_[starts, n]))
