"""What goes wrong in a log: tracks that jump, freeze, have holes or tremble."""

from __future__ import annotations

import numpy as np

from tests.outsiders.sixth.maps import OWN
from tests.outsiders.sixth.movement import Actor


def jolt(a: Actor) -> None:
    """Lose 5 m/s at once after eight seconds."""
    k = a.t >= 8.0
    a.vx[k] -= 5.0
    a.x[k] -= 5.0 * (a.t[k] - 8.0)


def jump(a: Actor) -> None:
    """Be recorded elsewhere for one step."""
    k = np.abs(a.t - 7.0) < 0.01
    a.x[k] = 20 + 20 * 7.0 + 0.4
    a.y[k] = OWN


def hole(a: Actor) -> None:
    """Be out of the log for four seconds."""
    keep = (a.t < 6.0) | (a.t > 10.0)
    a.t, a.x, a.y, a.yaw = a.t[keep], a.x[keep], a.y[keep], a.yaw[keep]
    a.vx, a.vy, a.z = a.vx[keep], a.vy[keep], a.z[keep]
    a.ind = [lamp for lamp, k in zip(a.ind, keep, strict=True) if k]


def tremble(a: Actor) -> None:
    """Have a speed that is noise."""
    random = np.random.default_rng(7)
    a.vx += random.normal(0, 0.12, len(a.t))
    a.vy += random.normal(0, 0.05, len(a.t))


def mute(a: Actor) -> None:
    """Have a speed of zero in the log."""
    a.vx *= 0.0
    a.vy *= 0.0


def freeze(a: Actor) -> None:
    """Stay where it was after six seconds."""
    k = a.t >= 6.0
    a.x[k], a.y[k] = a.x[k][0], a.y[k][0]
