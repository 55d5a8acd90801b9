"""Reads the tracks and lanes of a judged log, and measures distances between boxes with shapely: none of drivelint's own measures."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from drivelint.sql import store

Floats = NDArray[np.float64]
NO_SIZE = {"pedestrian": (0.6, 0.6), "bicycle": (1.8, 0.6), "cyclist": (1.8, 0.6), "motorcycle": (2.2, 0.8)}
"""Length and width in metres with which somebody without a size is drawn; others as a car of 4.5 x 1.8."""
MOTION_HALF_S = 0.5
MOTION_LEAST_M = 1.0
"""A track has a direction of motion where it leads this far within half a second before and after; less may be noise."""
OFF_MOTION_RAD = np.deg2rad(20.0)
"""A box of which the heading and the motion differ by more than this, forwards or backwards, is marked: one of the two is wrong."""


class Track(NamedTuple):
    """The states of one actor; `sized`: whether its box is recorded.

    `yaw`: the heading of the box. `travel`: the direction in which drivelint has the actor travel. `doubted`: it doubts the heading.
    """

    actor_class: str
    length: float
    width: float
    sized: bool
    t: Floats
    x: Floats
    y: Floats
    yaw: Floats
    speed: Floats
    travel: Floats
    doubted: NDArray[np.bool_]

    def at(self, t: float, tolerance: float = 0.26) -> int | None:
        """Return the index of the state nearest to a time, None: there is none."""
        i = int(np.argmin(np.abs(self.t - t)))
        return i if abs(self.t[i] - t) <= tolerance else None

    def boxes(self, indices: NDArray[np.intp] | list[int]) -> NDArray[np.object_]:
        """Return the polygons of states."""
        i = np.asarray(indices, dtype=np.intp)
        ahead = np.array([1, 1, -1, -1]) * self.length / 2
        left = np.array([1, -1, -1, 1]) * self.width / 2
        c, s = np.cos(self.yaw[i])[:, None], np.sin(self.yaw[i])[:, None]
        corners = np.stack([self.x[i, None] + c * ahead - s * left, self.y[i, None] + s * ahead + c * left], axis=-1)
        polygons: NDArray[np.object_] = shapely.polygons(corners)
        return polygons

    def motion(self) -> Floats:
        """Return the direction in which the positions lead at each state, NaN where they lead nowhere."""
        if len(self.t) < 2:
            return np.full(len(self.t), np.nan)
        last = len(self.t) - 1
        i = np.clip(np.searchsorted(self.t, self.t - MOTION_HALF_S - 1e-6), 0, last)
        j = np.clip(np.searchsorted(self.t, self.t + MOTION_HALF_S + 1e-6, side="right") - 1, 0, last)
        dx, dy = self.x[j] - self.x[i], self.y[j] - self.y[i]
        return np.where(np.hypot(dx, dy) >= MOTION_LEAST_M, np.arctan2(dy, dx), np.nan)

    def is_off_motion(self) -> NDArray[np.bool_]:
        """Return at each state whether the box stands across its motion, or faces away from where it is taken to travel."""
        motion = self.motion()
        across = np.abs(np.sin(motion - self.yaw)) > np.sin(OFF_MOTION_RAD)
        off: NDArray[np.bool_] = across | (np.cos(motion - self.travel) < 0)
        return off

    def extent_m(self) -> float:
        """Return how far from one place the track leads, in metres."""
        return float(max(np.ptp(self.x), np.ptp(self.y)))

    def derived_speed(self) -> Floats:
        """Return the speed that the positions give, over two steps."""
        if len(self.t) < 3:
            return np.full(len(self.t), np.nan)
        speed: Floats = np.hypot(np.gradient(self.x, self.t), np.gradient(self.y, self.t))
        return speed


class LaneShape(NamedTuple):
    """A drivable lane: its area, its edges and the heading from its begin to its end."""

    area: Any
    left: Any
    right: Any
    heading: float


class Recording(NamedTuple):
    """Tracks by actor, lanes as rows of the result, and the shapes of the drivable ones in `tree`."""

    tracks: dict[str, Track]
    lanes: list[dict[str, Any]]
    shapes: list[LaneShape]
    tree: Any
    stop_lines: list[Floats]


@lru_cache(maxsize=3)
def recording(folder: Path) -> Recording:
    """Return what a judged log has recorded; times are seconds since its start."""
    with store.open_without_creating_tables(folder / "drivelint.duckdb", read_only=True) as con:
        states = con.execute(
            """
            SELECT actor_id, any_value(actor.actor_class), any_value(actor.length_m), any_value(actor.width_m),
                list((t_ns - start_ns) / 1e9 ORDER BY t_ns), list(s.x_m ORDER BY t_ns), list(s.y_m ORDER BY t_ns),
                list(s.yaw_rad ORDER BY t_ns), list(sqrt(s.vx_mps ** 2 + s.vy_mps ** 2) ORDER BY t_ns),
                list(coalesce(d.travel_rad, s.yaw_rad) ORDER BY t_ns), list(h.t_ns IS NOT NULL ORDER BY t_ns)
            FROM actor_state s
            JOIN actor USING (drive_id, actor_id)
            LEFT JOIN state_dynamics d USING (drive_id, actor_id, t_ns)
            LEFT JOIN (
                SELECT DISTINCT drive_id, actor_id, a.t_ns
                FROM actor_state a
                JOIN doubt b USING (drive_id, actor_id)
                WHERE b.quantity = 'heading' AND a.t_ns BETWEEN b.t_from_ns AND b.t_to_ns
            ) h USING (drive_id, actor_id, t_ns)
            CROSS JOIN (SELECT min(t_ns) AS start_ns FROM actor_state)
            WHERE s.x_m IS NOT NULL GROUP BY actor_id ORDER BY actor_id
            """
        ).fetchall()
        stops = con.execute("SELECT ST_AsWKB(geom) FROM stop_line").fetchall()
        lanes = con.execute(f"SELECT * EXCLUDE (geom) FROM '{folder / 'lanes.parquet'}'")
        names = [column[0] for column in lanes.description or ()]
        rows = [dict(zip(names, row, strict=True)) for row in lanes.fetchall()]
    tracks = {row[0]: _track(*row[1:]) for row in states}
    shapes = [_shape(lane) for lane in rows if lane["drivable"] and min(map(len, _edges(lane))) > 1]
    tree = shapely.STRtree([shape.area for shape in shapes])
    return Recording(
        tracks, rows, shapes, tree, [shapely.get_coordinates(shapely.from_wkb(bytes(wkb))) for (wkb,) in stops]
    )


def _edges(lane: dict[str, Any]) -> tuple[list[tuple[float, float]], ...]:
    return tuple(list(zip(lane[f"{s}_x_m"] or (), lane[f"{s}_y_m"] or (), strict=True)) for s in ("left", "right"))


def _shape(lane: dict[str, Any]) -> LaneShape:
    left, right = _edges(lane)
    heading = np.arctan2(left[-1][1] - left[0][1], left[-1][0] - left[0][0])
    area = shapely.make_valid(shapely.Polygon([*left, *right[::-1]]))
    return LaneShape(area, shapely.LineString(left), shapely.LineString(right), float(heading))


def _track(actor_class: str, length: float | None, width: float | None, *columns: list[float | None]) -> Track:
    t, x, y, yaw, speed, travel = (np.array(column, dtype=np.float64) for column in columns[:-1])
    drawn_length, drawn_width = NO_SIZE.get(actor_class, (4.5, 1.8))
    sized = length is not None and width is not None
    doubted = np.array(columns[-1], dtype=np.bool_)
    return Track(actor_class, length or drawn_length, width or drawn_width, sized, t, x, y, yaw, speed, travel, doubted)


def apart(first: Track, second: Track) -> tuple[Floats, Floats, Floats, Floats]:
    """Return the times that two tracks share, and of each the distance of the boxes, and how far ahead and left the other is of the first.

    Ahead is from bumper to bumper (negative: the boxes overlap lengthwise, or the other is behind), left from middle to middle.
    """
    near = np.clip(np.searchsorted(second.t, first.t), 1, max(len(second.t) - 1, 1)) if len(second.t) > 1 else None
    j = (
        np.zeros(len(first.t), dtype=np.intp)
        if near is None
        else np.where(np.abs(second.t[near] - first.t) < np.abs(second.t[near - 1] - first.t), near, near - 1)
    )
    i = np.flatnonzero((np.abs(second.t[j] - first.t) < 0.06) & np.isfinite(first.yaw) & np.isfinite(second.yaw[j]))
    j = j[i]
    if not len(i):
        return (np.empty(0),) * 4
    boxes = second.boxes(j)
    distance = shapely.distance(first.boxes(i), boxes)
    corners = shapely.get_coordinates(boxes).reshape(len(i), 5, 2)
    dx, dy = corners[..., 0] - first.x[i, None], corners[..., 1] - first.y[i, None]
    c, s = np.cos(first.yaw[i])[:, None], np.sin(first.yaw[i])[:, None]
    ahead = (dx * c + dy * s).min(axis=1) - first.length / 2
    left = -(second.x[j] - first.x[i]) * s[:, 0] + (second.y[j] - first.y[i]) * c[:, 0]
    return first.t[i], distance, ahead, left
