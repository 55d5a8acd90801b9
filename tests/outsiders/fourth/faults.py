"""Faults of a log: tracks that are lost, jump, tremble or are turned round."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np

from tests.outsiders.fourth.movement import NS, Columns

Tracks = Mapping[str, Columns]  # by who moves
Fault = Callable[[Tracks], None]


def lost(name: str, begin: float, end: float) -> Fault:
    """The log loses somebody from begin to end."""

    def fault(tracks: Tracks) -> None:
        track = tracks[name]
        there = [not begin * NS <= t < end * NS for t in track["t_ns"]]
        for values in track.values():
            values[:] = [value for value, seen in zip(values, there, strict=True) if seen]

    return fault


def jump(name: str, begin: float, end: float, dx: float, dy: float) -> Fault:
    """A track jumps to another place and back."""

    def fault(tracks: Tracks) -> None:
        track = tracks[name]
        for row, t in enumerate(track["t_ns"]):
            if begin * NS <= t < end * NS:
                track["x_m"][row] += dx
                track["y_m"][row] += dy

    return fault


def turned(name: str) -> Fault:
    """Somebody's heading is logged the wrong way round."""

    def fault(tracks: Tracks) -> None:
        yaw = tracks[name]["yaw_rad"]
        yaw[:] = [math.remainder(value + math.pi, 2 * math.pi) for value in yaw]

    return fault


def noise(sigma: float, seed: int) -> Fault:
    """Everybody's position trembles."""

    def fault(tracks: Tracks) -> None:
        random = np.random.default_rng(seed)
        for track in tracks.values():
            shift = random.normal(0.0, sigma, (len(track["t_ns"]), 2))
            for name, by in zip(("x_m", "y_m"), shift.T.tolist(), strict=True):
                track[name][:] = [value + one for value, one in zip(track[name], by, strict=True)]

    return fault
