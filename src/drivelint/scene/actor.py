"""An actor of a scene: its path and its motion, as drawn for right-hand traffic."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from drivelint.errors import UsageError
from drivelint.phrases import hint
from drivelint.scene.layout import road_and_lane_number
from drivelint.scene.road import ActorPath, path_along_lanes

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.arrays import Floats
    from drivelint.scene.document import ActorEntry, Knots, MotionStep
    from drivelint.scene.road import Road

DT_S: Final = 0.01
"""Time step of the motion; the recorder picks samples from these steps."""
DEFAULT_SIZE_BY_CLASS: Final[dict[str, tuple[float, float, float]]] = {
    "car": (4.5, 1.8, 1.5),
    "van": (5.5, 2.0, 2.2),
    "truck": (12.0, 2.5, 3.6),
    "bus": (12.0, 2.5, 3.1),
    "motorcycle": (2.2, 0.8, 1.4),
    "bicycle": (1.8, 0.6, 1.7),
    "trailer": (6.0, 2.2, 2.5),
    "pedestrian": (0.5, 0.5, 1.75),
    "animal": (2.4, 0.7, 2.2),
    "object": (1.0, 1.0, 1.0),
    "vehicle": (4.6, 1.9, 1.6),
}
"""Class -> length, width and height in metres."""
CLASSES_WITH_LIGHTS: Final = frozenset({"car", "van", "truck", "bus", "motorcycle", "vehicle", "trailer"})
BRAKE_LIGHT_DECELERATION_MPS2: Final = 1.0
"""The deceleration above which the brake lights are on."""
_LEAST_SPEED_FOR_HEADING_MPS: Final = 0.3
"""Below this speed, the motion does not change the heading."""


class MotionSamples(NamedTuple):
    """Samples of an actor: seconds, metres, radians, m/s; `push`: its acceleration along its heading, m/s2."""

    t: Floats
    x: Floats
    y: Floats
    z: Floats
    yaw: Floats
    vx: Floats
    vy: Floats
    push: Floats


@dataclass(frozen=True)
class Actor:
    """An actor and its motion."""

    name: str
    text: ActorEntry
    roads: Mapping[str, Road]

    @property
    def size(self) -> tuple[float | None, float | None, float | None]:
        """Length, width and height in metres; None: unknown in the log."""
        if self.text.size is None:
            kind = self.text.kind or "vehicle"
            if kind not in DEFAULT_SIZE_BY_CLASS:
                raise UsageError(f"actor {self.name}: kind {kind!r}: {hint(kind, DEFAULT_SIZE_BY_CLASS)}")
            return DEFAULT_SIZE_BY_CLASS[kind]
        length, width, height, *_ = [*self.text.size, None, None, None]
        return length, width, height

    def motion(self, seconds: float) -> MotionSamples:
        """Return the actor's motion, every `DT_S` from second 0 on. Errors: `UsageError` for an impossible path or step."""
        t: Floats = np.arange(round(seconds / DT_S) + 1).astype(np.float64) * DT_S
        if self.text.track:
            return self._motion_on_track(t)
        way, speed, offset = self._path(), *self._speed_and_offset_knots()
        v = np.interp(t, *_times_and_values(speed))
        s = self.text.from_ + np.concatenate([[0.0], np.cumsum((v[1:] + v[:-1]) / 2 * DT_S)])
        d = values_between_knots(offset, t)
        x, y, heading, z = way.poses_at(s)
        x, y = x - d * np.sin(heading), y + d * np.cos(heading)
        drift = np.gradient(d, DT_S)
        slip = np.where(
            np.abs(v) > _LEAST_SPEED_FOR_HEADING_MPS,
            np.arctan2(drift, np.maximum(np.abs(v), _LEAST_SPEED_FOR_HEADING_MPS)) * np.sign(v),
            0.0,
        )
        return self._motion_of_poses(t, x, y, z, heading + slip)

    def _motion_on_track(self, t: Floats) -> MotionSamples:
        times, x, y = np.array(self.text.track, float).T
        time_on_track = np.clip(t, times[0], times[-1])
        if len(times) < 2:
            raise UsageError(f"actor {self.name}: a track needs at least two points")
        px, py = _smooth_curve_values(times, x, time_on_track), _smooth_curve_values(times, y, time_on_track)
        vx, vy = np.gradient(px, DT_S), np.gradient(py, DT_S)
        moving = np.hypot(vx, vy) > _LEAST_SPEED_FOR_HEADING_MPS
        along = np.unwrap(np.arctan2(vy, vx)[moving]) if moving.any() else np.zeros(1)
        yaw = np.interp(t, t[moving], along) if moving.any() else np.zeros(t.shape)
        return self._motion_of_poses(t, px, py, np.zeros(t.shape), yaw)

    def _motion_of_poses(self, t: Floats, x: Floats, y: Floats, z: Floats, yaw: Floats) -> MotionSamples:
        vx, vy = np.gradient(x, DT_S), np.gradient(y, DT_S)
        if self.text.heading is not None:
            heading = self.text.heading
            yaw = np.radians(
                np.interp(t, *_times_and_values([[0.0, heading]] if isinstance(heading, int | float) else heading))
            )
        elif self.text.facing == "back":
            yaw = yaw + math.pi
        push = np.gradient(vx * np.cos(yaw) + vy * np.sin(yaw), DT_S)
        ground = z if self.text.height is None else np.full(t.shape, float(self.text.height))
        return MotionSamples(t, x, y, ground, yaw, vx, vy, push)

    def _lanes_of_route(self) -> list[tuple[str, int]]:
        texts = [self.text.lane] if self.text.lane else self.text.route
        return [road_and_lane_number(text, self.roads) for text in texts]

    def _path(self) -> ActorPath:
        text = self.text
        keys = [name for name in ("lane", "route", "path", "track", "place") if getattr(text, name)]
        if len(keys) != 1:
            keys_text = " and ".join(keys) or "none"
            raise UsageError(
                f"actor {self.name}: one of lane, route, path, track and place must define its place, but here {keys_text} does"
            )
        if text.place:
            x, y, heading = text.place
            turned = math.radians(heading)
            return ActorPath.through_points(np.array([x, x + math.cos(turned)]), np.array([y, y + math.sin(turned)]))
        if text.path:
            if len(text.path) < 2:
                raise UsageError(f"actor {self.name}: a path needs at least two points; a standing actor has a place")
            x, y = np.array(text.path, float).T
            return ActorPath.through_points(*_dense_points(x, y))
        return path_along_lanes(self.roads, self._lanes_of_route())

    def _speed_and_offset_knots(self) -> tuple[Sequence[Sequence[float]], Sequence[Sequence[float]]]:
        """Return the knots of speed and offset, including the knots that result from the steps."""
        speed: Sequence[Sequence[float]] = _knot_list(self.text.speed)
        offset: Sequence[Sequence[float]] = _knot_list(self.text.offset)
        for step in self.text.do:
            if step.speed is not None or step.stop is not None:
                speed = self._speed_knots_with_step(speed, step)
            if step.lane is not None or step.offset is not None:
                begin, before = self._begin_of_step_s(step, speed), offset[-1][1]
                target = (
                    self._offset_from_own_to_lane_m(step.lane) if step.lane is not None else float(step.offset or 0.0)
                )
                offset = [*offset, [begin, before], [begin + step.over, target]]
        return speed, offset

    def _begin_of_step_s(self, step: MotionStep, speed_knots: Sequence[Sequence[float]]) -> float:
        """Return the second at which a step begins."""
        if step.at is not None:
            return step.at
        if step.place is None:
            raise UsageError(f"actor {self.name}: a step of do begins at a second (at) or at a place")
        return self._second_at_place(step.place, speed_knots)

    def _second_at_place(self, place_m: float, speed_knots: Sequence[Sequence[float]]) -> float:
        t = np.arange(0.0, 600.0, DT_S)
        s = self.text.from_ + np.concatenate(
            [[0.0], np.cumsum(np.interp(t, *_times_and_values(speed_knots))[1:] * DT_S)]
        )
        if s[-1] < place_m:
            raise UsageError(f"actor {self.name}: it never reaches {place_m:g} m")
        return float(t[int(np.argmax(s >= place_m))])

    def _speed_knots_with_step(self, speed: Sequence[Sequence[float]], step: MotionStep) -> Sequence[Sequence[float]]:
        """Return the speed knots `[t_s, speed_mps]` with the change of speed of a step added."""
        target = step.speed or 0.0
        if step.stop is not None:
            now = speed[-1][1]
            centre = step.stop - (self.size[0] or 0.0) / 2
            begin = self._second_at_place(centre - now * now / 2 / step.by, speed)
        else:
            begin = self._begin_of_step_s(step, speed)
        now = float(np.interp(begin, *_times_and_values(speed)))
        earlier = [knot for knot in speed if knot[0] < begin]
        return [*earlier, [begin, now], [begin + max(abs(target - now) / step.by, DT_S), target]]

    def _offset_from_own_to_lane_m(self, lane_number: int) -> float:
        lanes = self._lanes_of_route()
        if not lanes:
            raise UsageError(
                f"actor {self.name}: an actor that does not follow a lane cannot change lane: use an offset"
            )
        road = self.roads[lanes[0][0]]
        here, there = road.lane_offset_m(road.lane(lanes[0][1]), 0.0), road.lane_offset_m(road.lane(lane_number), 0.0)
        return (there - here) * (1 if lanes[0][1] > 0 else -1)


def values_between_knots(knots: Sequence[Sequence[float]], t: Floats) -> Floats:
    """Return the values at times of a curve through knots: smooth without overshooting, constant before the first and after the last."""
    times, values = _times_and_values(knots)
    if len(times) == 1:
        return np.full(t.shape, values[0])
    times = np.concatenate([[times[0] - 1.0], times, [times[-1] + 1.0]])
    values = np.concatenate([values[:1], values, values[-1:]])
    return _smooth_curve_values(times, values, np.clip(t, times[0], times[-1]))


def _smooth_curve_values(times: Floats, values: Floats, t: Floats) -> Floats:
    """Return the values at `t` of a smooth curve through `values` at `times`, without overshooting."""
    from scipy.interpolate import PchipInterpolator  # takes as long as all imports of a check

    result: Floats = PchipInterpolator(times, values)(t)
    return result


def light_states(
    word_or_changes: str | Sequence[tuple[float, str]], t: Floats, words: Sequence[str], light: str
) -> list[str | None]:
    """Return the state of a light at each time; None where it is unknown. Errors: `UsageError`."""
    changes = [(0.0, word_or_changes)] if isinstance(word_or_changes, str) else list(word_or_changes)
    for _, word in changes:
        if word not in {*words, "unknown"}:
            raise UsageError(f"{light}: {word!r}: {hint(word, [*words, 'unknown'])}")
    begins = np.array([begin for begin, _ in changes])
    numbers = np.clip(np.searchsorted(begins, t + 1e-6) - 1, 0, None)
    return [None if changes[n][1] == "unknown" else changes[n][1] for n in numbers]


def _knot_list(value: Knots) -> list[list[float]]:
    return [[0.0, float(value)]] if isinstance(value, int | float) else [list(map(float, knot)) for knot in value]


def _times_and_values(knots: Sequence[Sequence[float]]) -> tuple[Floats, Floats]:
    times, values = np.array(knots, float).T
    return times, values


def _dense_points(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """Return points every 5 cm along the straight lines between these points."""
    s = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    fine = np.union1d(np.arange(0.0, s[-1], 0.05), s)
    return np.interp(fine, s, x), np.interp(fine, s, y)
