"""A scene: a road and its actors for some seconds; logs and tables are made from its samples."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from tests.demo.motion import TICKS_PER_S, Track, actor_track, half_extents, stop_on_contact
from tests.demo.opendrive import opendrive

if TYPE_CHECKING:
    from tests.demo.actors import Actor
    from tests.demo.road import Handedness, Road

LANE_DEPARTURE_M = 0.05  # a corner this far over the centre line has left the lane
SAMPLE_RATE_HZ = 10


@dataclass(frozen=True)
class Scene:
    """One drive on one road. `shows`: what it is for, in a sentence. The ego is actor 1, the other actors 2, 3, ..."""

    name: str
    shows: str
    road: Road
    ego: Actor
    other_actors: tuple[Actor, ...]
    duration_s: float
    road_name: str = ""

    @property
    def map_name(self) -> str:
        """Return the name of the road's file, without its ending: scenes on one road share it."""
        return self.road_name or self.name

    @cached_property
    def map_text(self) -> str:
        """Return the road as OpenDRIVE."""
        return opendrive(self.road, self.map_name)

    @cached_property
    def tracks(self) -> tuple[Track, ...]:
        """Return everybody's samples, the ego's first, all at the same times."""
        ego = actor_track(self.ego, self.road, self.duration_s)
        others = [actor_track(other, self.road, self.duration_s) for other in self.other_actors]
        rows = np.arange(0, len(ego.t_s), TICKS_PER_S // SAMPLE_RATE_HZ)
        return tuple(track.at(rows) for track in stop_on_contact(ego, others))

    def driven_on_the(self, hand: Handedness) -> Scene:
        """Return the same scene where the other side of the road is driven on."""
        return replace(self, road=self.road.driven_on_the(hand))


@dataclass(frozen=True)
class LaneDeparture:
    """The first sample with the ego's box over the centre line: when, and the station of its front."""

    t_s: float
    front: float


def lane_departure(ego: Actor, road: Road, duration_s: float) -> LaneDeparture:
    """Return where the ego leaves its lane for the oncoming one. Errors: `ValueError` where it never does."""
    track = actor_track(ego, road, duration_s)
    track = track.at(np.arange(0, len(track.t_s), TICKS_PER_S // SAMPLE_RATE_HZ))
    along, across = half_extents(ego.body, track.yaw - road.line.at(track.station)[2])
    over = np.flatnonzero(track.offset - across < -LANE_DEPARTURE_M)
    if not len(over):
        raise ValueError("the ego never leaves its lane")
    k = int(over[0])
    return LaneDeparture(float(track.t_s[k]), float(track.station[k] + along[k]))


def place_oncoming(oncoming: Actor, to: LaneDeparture, *, ahead_m: float) -> Actor:
    """Return an oncoming actor placed so that it is `ahead_m` ahead of the ego, front to front, when the ego departs."""
    front = to.front + ahead_m
    return oncoming.starts(front + oncoming.body.length_m / 2 + oncoming.speed_mps * to.t_s, lane=-1)
