"""The actors of a scene: size, start, speed changes, lateral shifts and indicators.

An actor is said in a chain of small sentences, each of which returns a new actor:

    car().starts(20.0).drives(25 * MPH).moves_out(3.5, at=100.0, within=22.0).signals("offside", 4.0, 9.0)
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, NamedTuple

IndicatorSide = Literal["offside", "nearside", "hazard"]


class Body(NamedTuple):
    """An actor's class and box, in metres."""

    kind: Literal["car", "van", "bus", "truck", "bicycle", "pedestrian"]
    length_m: float
    width_m: float
    height_m: float


class SpeedChange(NamedTuple):
    """From a time on the speed goes to `to_mps` at this rate (m/s2)."""

    at_s: float
    to_mps: float
    rate_mps2: float


class LateralShift(NamedTuple):
    """A smooth lateral shift `by` metres (nearside positive) from station `at`, over the distance `within`."""

    at: float
    within: float
    by: float


class Indicator(NamedTuple):
    """An indicator that is on from a time until before another."""

    side: IndicatorSide
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
    speeds: tuple[SpeedChange, ...] = ()
    shifts: tuple[LateralShift, ...] = ()
    lights: tuple[Indicator, ...] = ()
    leaves: bool = False

    def starts(self, at: float, *, lane: int = 1, nearside_m: float = 0.0) -> Actor:
        """Begin at a station in a lane (negative: oncoming), `nearside_m` nearer to the nearside than the lane's middle."""
        return replace(self, station=at, lane=lane, beside_m=nearside_m)

    def drives(self, mps: float) -> Actor:
        """Drive at this speed from the start."""
        return replace(self, speed_mps=mps)

    def then_drives(self, mps: float, *, at_s: float, rate: float) -> Actor:
        """Accelerate or brake to another speed from a time on."""
        return replace(self, speeds=(*self.speeds, SpeedChange(at_s, mps, rate)))

    def moves_out(self, by: float, *, at: float, within: float) -> Actor:
        """Move sideways to the offside, beginning at a station, within a distance along the road."""
        return replace(self, shifts=(*self.shifts, LateralShift(at, within, -by)))

    def moves_in(self, by: float, *, at: float, within: float) -> Actor:
        """Move sideways to the nearside."""
        return replace(self, shifts=(*self.shifts, LateralShift(at, within, by)))

    def signals(self, side: IndicatorSide, from_s: float, until_s: float) -> Actor:
        """Have an indicator on."""
        return replace(self, lights=(*self.lights, Indicator(side, from_s, until_s)))

    def leaves_by_the_fork(self) -> Actor:
        """Follow the branch instead of the road."""
        return replace(self, leaves=True)

    def on_the_other_level(self) -> Actor:
        """Follow the road that lies over or under the first one."""
        return replace(self, leaves=True)


def car() -> Actor:
    """Return a car of the paper's size."""
    return Actor(Body("car", 4.8, 1.8, 1.5))


def lorry() -> Actor:
    """Return a lorry without a trailer."""
    return Actor(Body("truck", 12.0, 2.5, 4.0))


def cyclist() -> Actor:
    """Return somebody on a bicycle."""
    return Actor(Body("bicycle", 1.8, 0.6, 1.7))


def pedestrian() -> Actor:
    """Return somebody on foot."""
    return Actor(Body("pedestrian", 0.5, 0.5, 1.7))
