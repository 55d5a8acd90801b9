"""A model of a perception recorder: what a vehicle's sensors and tracker write of the traffic around it.

Everything is drawn from one seed, so the same drive and the same recorder give the same log. The ego's own track stays as it was
(its own localisation is another subject); of all others only what is seen is written, with errors.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from .traffic import Track

    Floats = NDArray[np.float64]
    Mask = NDArray[np.bool_]

SEEN_FOR_S: Final = 0.3
"""A tracker needs so long before it writes a new actor."""


@dataclass(frozen=True)
class Recorder:
    """How well it sees. Rates are per actor and minute in view; zero: never."""

    range_m: float = 100.0
    occlusion: bool = True
    hz: float = 10.0
    position_m: float = 0.1  # standard deviations of errors
    velocity_mps: float = 0.2
    yaw_rad: float = 0.01
    size_m: float = 0.1  # of the whole track
    latency_s: float = 0.0
    dropouts: float = 0.0  # 0.1 to 2 s
    jumps: float = 0.0  # one sample, 5 to 60 m away
    back_steps: float = 0.0  # one sample, 0.5 to 3 m back
    switches: float = 0.0  # another id from there on
    flips: float = 0.0  # heading turned round, 0.1 to 1 s
    flickers: float = 0.0  # the share of tracks whose class is not known


MILD: Final = Recorder()
FAULTY: Final = Recorder(
    range_m=80.0, position_m=0.2, velocity_mps=0.3, size_m=0.2, dropouts=2.0, jumps=0.3, back_steps=0.5, switches=0.5,
    flips=0.5, flickers=0.05,
)  # fmt: skip
HARSH: Final = Recorder(
    range_m=60.0, hz=5.0, position_m=0.3, velocity_mps=0.5, yaw_rad=0.03, size_m=0.3, latency_s=0.1, dropouts=6.0, jumps=1.0,
    back_steps=2.0, switches=2.0, flips=2.0, flickers=0.2,
)  # fmt: skip
LEVELS: Final = {"mild": MILD, "faulty": FAULTY, "harsh": HARSH}


def recorded(ego: Track, objects: Sequence[Track], recorder: Recorder, seed: int) -> list[Track]:
    """Return what is written: the ego's own track at the recorder's rate, and the others as they are seen."""
    rng = np.random.default_rng(seed)
    period_ns = round(1e9 / recorder.hz)
    ego = ego.take((ego.t_ns - ego.t_ns[0]) % period_ns == 0)
    there = [_during(track, ego) for track in objects]
    there = [track for track in there if len(track.t_ns)]
    seen = visible(ego, there, recorder)
    found = [ego]
    for track, mask in zip(there, seen, strict=True):
        found += _recorded_parts(track, mask, recorder, rng)
    return found


def _during(track: Track, ego: Track) -> Track:
    """Return its samples at the ego's times."""
    return track.take(np.isin(track.t_ns, ego.t_ns))


def visible(ego: Track, objects: Sequence[Track], recorder: Recorder) -> list[Mask]:
    """Say of each sample whether the ego sees it: within range, and a corner or the middle not behind another box."""
    at = {int(t): k for k, t in enumerate(ego.t_ns)}
    index = [np.array([at[int(t)] for t in track.t_ns], np.int64) for track in objects]
    near, far, low, high, middle = ([] for _ in range(5))
    points = []
    for track, k in zip(objects, index, strict=True):
        dx, dy = track.x - ego.x[k], track.y - ego.y[k]
        c, s = np.cos(track.yaw)[:, None], np.sin(track.yaw)[:, None]
        along = track.length / 2 * np.array([1, 1, -1, -1, 0])
        aside = track.width / 2 * np.array([1, -1, 1, -1, 0])
        px, py = dx[:, None] + along * c - aside * s, dy[:, None] + along * s + aside * c
        bearing, distance = np.arctan2(py, px), np.hypot(px, py)
        off = np.remainder(bearing - bearing[:, 4:] + np.pi, 2 * np.pi) - np.pi
        points.append((bearing, distance))
        middle.append(bearing[:, 4])
        low.append(off.min(axis=1))
        high.append(off.max(axis=1))
        near.append(distance.min(axis=1))
        far.append(np.hypot(dx, dy) <= recorder.range_m)
    seen = [mask.copy() for mask in far]
    if not recorder.occlusion:
        return seen
    for i, k in enumerate(index):
        hidden = np.zeros((len(k), 5), np.bool_)
        for j, other in enumerate(index):
            if i == j:
                continue
            _, mine, his = np.intersect1d(k, other, assume_unique=True, return_indices=True)
            if not len(mine):
                continue
            bearing, distance = points[i][0][mine], points[i][1][mine]
            off = np.remainder(bearing - middle[j][his][:, None] + np.pi, 2 * np.pi) - np.pi
            behind = (off > low[j][his][:, None]) & (off < high[j][his][:, None]) & (distance > near[j][his][:, None])
            hidden[mine] |= behind
        seen[i] &= ~hidden.all(axis=1)
    return seen


def _recorded_parts(track: Track, in_view: Mask, recorder: Recorder, rng: np.random.Generator) -> list[Track]:
    """Return its track as it is written: parts with an id each, without what is not seen."""
    n = len(track.t_ns)
    period_s = 1.0 / recorder.hz

    def happens(rate: float) -> Mask:
        return rng.random(n) < rate * period_s / 60.0

    def stretches(rate: float, least_s: float, most_s: float) -> Mask:
        mask = np.zeros(n, np.bool_)
        for k in np.flatnonzero(happens(rate)):
            mask[k : k + max(1, round(rng.uniform(least_s, most_s) / period_s))] = True
        return mask

    x = track.x + rng.normal(0, recorder.position_m, n)
    y = track.y + rng.normal(0, recorder.position_m, n)
    vx = track.vx + rng.normal(0, recorder.velocity_mps, n)
    vy = track.vy + rng.normal(0, recorder.velocity_mps, n)
    late = recorder.latency_s
    x, y = x - late * track.vx, y - late * track.vy
    yaw = track.yaw + rng.normal(0, recorder.yaw_rad, n)
    jump, back = happens(recorder.jumps), happens(recorder.back_steps)
    far, way = rng.uniform(5, 60, n), rng.uniform(-np.pi, np.pi, n)
    step = rng.uniform(0.5, 3.0, n)
    x = np.where(jump, x + far * np.cos(way), np.where(back, x - step * np.cos(track.yaw), x))
    y = np.where(jump, y + far * np.sin(way), np.where(back, y - step * np.sin(track.yaw), y))
    yaw = np.where(stretches(recorder.flips, 0.1, 1.0), yaw + np.pi, yaw)
    yaw = np.remainder(yaw + np.pi, 2 * np.pi) - np.pi
    in_view = in_view & ~stretches(recorder.dropouts, 0.1, 2.0)
    length, width = np.maximum(0.3, np.array([track.length, track.width]) + rng.normal(0, recorder.size_m, 2))
    kind = None if rng.random() < recorder.flickers else track.kind
    whole = replace(track, x=x, y=y, vx=vx, vy=vy, yaw=yaw, length=float(length), width=float(width), kind=kind)
    # a new id after each switch, and wherever it was out of view for more than 2 s
    part = np.cumsum(happens(recorder.switches) | _after_long(in_view, round(2.0 / period_s)))
    found = []
    for number in np.unique(part[in_view]).tolist():
        rows = in_view & (part == number)
        first = np.flatnonzero(rows)[: max(0, round(SEEN_FOR_S / period_s) - 1)]
        rows[first] = False
        if rows.any():
            found.append(whole.take(rows, actor_id=track.actor_id if number == 0 else f"{track.actor_id}/{number}"))
    return found


def _after_long(in_view: Mask, max_gap: int) -> Mask:
    """Say of each sample whether it is the first one seen after more than `max_gap` that were not."""
    rows = np.flatnonzero(in_view)
    again = np.zeros(len(in_view), np.bool_)
    again[rows[1:][np.diff(rows) > max_gap + 1]] = True
    return again
