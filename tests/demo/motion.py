"""Computes the motion of a scene's actors along the road; actors that touch the ego stop with it.

Motion is solved on a grid of milliseconds, so that samples, lane departures and contacts need no formula of their own.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from tests.demo.actors import Actor, Body
    from tests.demo.road import Road

    Floats = NDArray[np.float64]

TICKS_PER_S = 1000  # per second
_GRID_M = 0.02
_BRAKES_MPS2 = 0.5  # slower than this without the brake
_TOUCH_M = 0.02  # bodies give way by this much before both stand


@dataclass(frozen=True, eq=False)
class Track:
    """An actor's motion, arrays of one value per tick: station, offset (nearside positive), pose, height of the road, speed, lights."""

    actor: Actor
    t_s: Floats
    station: Floats
    offset: Floats
    x: Floats
    y: Floats
    yaw: Floats
    ground: Floats
    speed: Floats
    light: NDArray[np.str_]
    brakes: NDArray[np.bool_]

    def at(self, rows: NDArray[np.intp]) -> Track:
        """Return the track at these ticks."""
        names = ("t_s", "station", "offset", "x", "y", "yaw", "ground", "speed", "light", "brakes")
        return replace(self, **{name: getattr(self, name)[rows] for name in names})

    def stopped_at(self, tick: int) -> Track:
        """Return the track of a body that stands still from a tick on."""
        n = len(self.t_s)
        frozen = self.at(np.minimum(np.arange(n), tick))
        return replace(frozen, t_s=self.t_s, speed=np.where(np.arange(n) >= tick, 0.0, self.speed))


def actor_track(actor: Actor, road: Road, duration_s: float) -> Track:
    """Return an actor's motion on a road."""
    t = np.arange(round(duration_s * TICKS_PER_S) + 1) / TICKS_PER_S
    along = 1 if actor.lane > 0 else -1
    line = road.path(branch=actor.leaves)
    speed = _speeds(actor, t)
    way = np.concatenate([[0.0], np.cumsum((speed[1:] + speed[:-1]) / 2 / TICKS_PER_S)])
    # the length of the path over a fine grid of stations gives the station after any way
    reach = np.arange(0.0, float(way[-1]) * 1.2 + 1.0, _GRID_M)
    grid = actor.station + along * reach
    d, slope = _offsets(actor, road, grid)
    scale = np.hypot(1.0 - line.curvature(grid) * d * road.nearside_factor, slope)
    path = np.concatenate([[0.0], np.cumsum((scale[1:] + scale[:-1]) / 2 * _GRID_M)])
    station = actor.station + along * np.interp(way, path, reach)
    d, slope = _offsets(actor, road, station)
    x, y, heading = line.at(station, d * road.nearside_factor)
    drift = np.arctan2(slope * road.nearside_factor, 1.0 - line.curvature(station) * d * road.nearside_factor)
    yaw = heading + drift + (0.0 if along > 0 else np.pi)
    yaw = np.arctan2(np.sin(yaw), np.cos(yaw))
    brakes = np.diff(speed, prepend=speed[0]) * TICKS_PER_S < -_BRAKES_MPS2
    ground = road.height_m(station, branch=actor.leaves)
    return Track(actor, t, station, d, x, y, yaw, ground, speed, _lights(actor, road, t), brakes)


def _speeds(actor: Actor, t: Floats) -> Floats:
    speed, now = np.full(t.shape, actor.speed_mps), actor.speed_mps
    for change in sorted(actor.speeds):
        now = float(speed[min(round(change.at_s * TICKS_PER_S), len(t) - 1)])
        passed = np.clip(t - change.at_s, 0.0, None) * change.rate_mps2
        over = change.to_mps - now
        speed = np.where(t >= change.at_s, now + np.sign(over) * np.minimum(passed, abs(over)), speed)
    return speed


def _offsets(actor: Actor, road: Road, station: Floats) -> tuple[Floats, Floats]:
    """Return the offset at stations and its slope along the line."""
    along = 1 if actor.lane > 0 else -1
    d = np.full(station.shape, road.lane_offset(actor.lane) + actor.beside_m * along)
    slope = np.zeros(station.shape)
    for shift in actor.shifts:
        u = np.clip((station - shift.at) * along / shift.within, 0.0, 1.0)
        d = d + shift.by * along * u * u * (3.0 - 2.0 * u)
        slope = slope + shift.by * 6.0 * u * (1.0 - u) / shift.within
    return d, slope


def _lights(actor: Actor, road: Road, t: Floats) -> NDArray[np.str_]:
    sides = {"nearside": road.hand, "offside": "right" if road.hand == "left" else "left", "hazard": "hazard"}
    light = np.full(t.shape, "off", dtype="<U6")
    for signal in actor.lights:
        light[(t >= signal.from_s - 1e-9) & (t < signal.until_s - 1e-9)] = sides[signal.side]
    return light


def half_extents(body: Body, drift: Floats) -> tuple[Floats, Floats]:
    """Return half the extent of a box along and across the line, turned by `drift` (rad) against it."""
    c, s = np.abs(np.cos(drift)), np.abs(np.sin(drift))
    return c * body.length_m / 2 + s * body.width_m / 2, s * body.length_m / 2 + c * body.width_m / 2


def separation(a: Track, b: Track) -> Floats:
    """Return the largest gap of two boxes over their four axes and in height at every tick; negative: they overlap, by that depth."""
    heights = [track.ground + track.actor.body.height_m / 2 for track in (a, b)]
    gaps = [np.abs(heights[1] - heights[0]) - (a.actor.body.height_m + b.actor.body.height_m) / 2]
    for yaw in (a.yaw, a.yaw + np.pi / 2, b.yaw, b.yaw + np.pi / 2):
        apart = np.abs((b.x - a.x) * np.cos(yaw) + (b.y - a.y) * np.sin(yaw))
        gaps.append(apart - half_extents(a.actor.body, a.yaw - yaw)[0] - half_extents(b.actor.body, b.yaw - yaw)[0])
    found: Floats = np.max(gaps, axis=0)
    return found


def stop_on_contact(ego: Track, other_tracks: list[Track]) -> list[Track]:
    """Return all tracks, the ego's first; the ego and the first actor that it touches stop at the contact."""
    deep = [np.flatnonzero(separation(ego, other) <= -_TOUCH_M) for other in other_tracks]
    ticks = [int(found[0]) if len(found) else len(ego.t_s) for found in deep]
    first = min(ticks, default=len(ego.t_s))
    if first == len(ego.t_s):
        return [ego, *other_tracks]
    return [
        ego.stopped_at(first),
        *(o.stopped_at(first) if tick == first else o for o, tick in zip(other_tracks, ticks, strict=True)),
    ]
