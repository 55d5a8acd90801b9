"""Who is in a scene: a body, where it starts, how fast it goes, when it changes its place in the road, what it signals.

An actor is said in a chain of small sentences, each of which returns a new actor:

    car().starts(20.0).drives(25 * MPH).moves_out(3.5, at=100.0, within=22.0).signals("offside", 4.0, 9.0)
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, NamedTuple

Side = Literal["offside", "nearside", "hazard"]


class Body(NamedTuple):
    """An actor's class and box, in metres."""

    kind: Literal["car", "van", "bus", "truck", "bicycle", "pedestrian"]
    length_m: float
    width_m: float
    height_m: float


class Speed(NamedTuple):
    """From a time on the speed goes to `to_mps` at this rate (m/s2)."""

    at_s: float
    to_mps: float
    rate_mps2: float


class Shift(NamedTuple):
    """From a station on, the actor moves sideways within a distance, nearside positive (a smooth step)."""

    at: float
    within: float
    by: float


class Signal(NamedTuple):
    """An indicator that is on from a time until before another."""

    side: Side
    from_s: float
    until_s: float


@dataclass(frozen=True)
class Actor:
    """One actor of a scene; stations and offsets are those of the road's line."""

    body: Body
    station: float = 0.0
    lane: int = 1
    beside_m: float = 0.0
    speed_mps: float = 0.0
    speeds: tuple[Speed, ...] = ()
    shifts: tuple[Shift, ...] = ()
    lights: tuple[Signal, ...] = ()
    leaves: bool = False

    def starts(self, at: float, *, lane: int = 1, nearer: float = 0.0) -> Actor:
        """Begin at a station in a lane (negative: oncoming), `nearer` to the nearside than the lane's middle."""
        return replace(self, station=at, lane=lane, beside_m=nearer)

    def drives(self, mps: float) -> Actor:
        """Drive at this speed from the start."""
        return replace(self, speed_mps=mps)

    def then_drives(self, mps: float, *, at_s: float, rate: float) -> Actor:
        """Accelerate or brake to another speed from a time on."""
        return replace(self, speeds=(*self.speeds, Speed(at_s, mps, rate)))

    def moves_out(self, by: float, *, at: float, within: float) -> Actor:
        """Move sideways to the offside, beginning at a station, within a distance along the road."""
        return replace(self, shifts=(*self.shifts, Shift(at, within, -by)))

    def moves_in(self, by: float, *, at: float, within: float) -> Actor:
        """Move sideways to the nearside."""
        return replace(self, shifts=(*self.shifts, Shift(at, within, by)))

    def signals(self, side: Side, from_s: float, until_s: float) -> Actor:
        """Have an indicator on."""
        return replace(self, lights=(*self.lights, Signal(side, from_s, until_s)))

    def leaves_by_the_fork(self) -> Actor:
        """Follow the branch instead of the road."""
        return replace(self, leaves=True)


def car() -> Actor:
    """Return a car of the paper's size."""
    return Actor(Body("car", 4.8, 1.8, 1.5))


def van() -> Actor:
    """Return a delivery van."""
    return Actor(Body("van", 5.9, 2.0, 2.6))


def bus() -> Actor:
    """Return a bus."""
    return Actor(Body("bus", 11.0, 2.5, 3.0))


def cyclist() -> Actor:
    """Return somebody on a bicycle."""
    return Actor(Body("bicycle", 1.8, 0.6, 1.7))


def pedestrian() -> Actor:
    """Return somebody on foot."""
    return Actor(Body("pedestrian", 0.5, 0.5, 1.7))
