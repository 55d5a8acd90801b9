"""Draws the sheet of a finding: the scene from above at its begin, worst moment and end, its course over time, and what it claims.

Boxes stand as drivelint has them, with their noses where it has them travel. Where that contradicts the motion of the track, or is in
doubt, both are marked, in the scene and in the caption: an examiner must not judge by a wrong heading.
"""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from .recording import Recording, Track, apart, recording

if TYPE_CHECKING:
    from pathlib import Path

    from .lots import Result

EGO, OBJECT, MOVING, PARKED = "tab:blue", "tab:red", "0.25", "0.6"
WARNING = "magenta"
"""The motion of an actor whose box does not stand along it, and boxes without a heading or with one in doubt."""
FILLS = {"crosswalk": "#fff2b0", "bicycle": "#d7efd7", "walkway": "#eee0ee", "shoulder": "#e8e0d8"}
BEFORE_S = AFTER_S = 5.0


def draw_sheet(result: Result, row: dict[str, Any], number: int, path: Path) -> None:
    """Write the sheet of a finding as PNG. It needs matplotlib, which is imported here only."""
    from matplotlib import pyplot as plt

    plt.switch_backend("agg")
    log = recording(result.folder)
    ego, other = log.tracks[row["ego_id"]], log.tracks.get(row["object_id"] or "")
    figure = plt.figure(figsize=(16, 12.4), dpi=75)
    figure.subplots_adjust(0.03, 0.03, 0.985, 0.87, 0.5, 0.14)
    figure.suptitle(_caption(row, number, ego, other), fontsize=10.5, ha="left", x=0.01, y=0.995, family="monospace")
    grid = figure.add_gridspec(3, 12, height_ratios=(2.3, 1, 1))
    axes = [figure.add_subplot(grid[0, 4 * i : 4 * i + 4]) for i in range(3)]
    for axis, name in zip(axes, ("start", "worst", "end"), strict=True):
        _from_above(axis, log, row, row[f"t_{name}_s"])
        axis.set_title(f"{name}: {row[f't_{name}_s']:.2f} s", fontsize=10)
    _series(
        [figure.add_subplot(grid[1 + i // 2, 6 * (i % 2) : 6 * (i % 2) + 6]) for i in range(4)], row, ego, other, log
    )
    figure.savefig(path)
    plt.close(figure)


def _caption(row: dict[str, Any], number: int, ego: Track, other_track: Track | None) -> str:
    moments = [row[f"t_{name}_s"] for name in ("start", "worst", "end")]

    def about(track: Track) -> str:
        size = f"{track.length:.1f} x {track.width:.1f} m" if track.sized else "no size"
        return (
            f"{track.actor_class} {size}, seen {track.t[0]:.1f} to {track.t[-1]:.1f} s{heading_warning(track, moments)}"
        )

    who = f"EGO (blue) {about(ego)}" + (f";  OBJECT (red) {about(other_track)}" if other_track else ";  no object")
    required = "" if row["required"] is None else f"  required {row['required']:.2f} {row['unit'] or ''}"
    observed = "" if row["observed"] is None else f"  {row['observes'] or 'observed'} {row['observed']:.2f}"
    lines = [
        f"#{number}  {row['severity']}  {row['rule_id']}: {row['title']}  [{row['profile'] or ''}]",
        f"LAW  {row['clause'] or ''}",
        f"ASKS {row['hypothesis']}",
        f"CLAIM {row['reason']}{observed}{required}  from {row['t_start_s']:.2f} s to {row['t_end_s']:.2f} s",
        who,
    ]
    return "\n".join(piece for line in lines for piece in textwrap.wrap(line, 165, subsequent_indent="     "))


def heading_warning(track: Track, moments: list[float]) -> str:
    """Return what an examiner must know of the headings at these times; '' where the boxes stand along the motion."""
    off, said = track.is_off_motion(), []
    for t in dict.fromkeys(moments):
        i = track.at(t)
        if i is None:
            continue
        if not np.isfinite(track.yaw[i]):
            said.append(f"no heading at {t:.1f} s")
        elif off[i] or track.doubted[i]:
            turned = abs(np.degrees(np.angle(np.exp(1j * (track.motion()[i] - track.yaw[i])))))
            apart_from = "" if np.isnan(turned) else f" {turned:.0f} deg off its motion"
            said.append(f"heading{apart_from}{' (in doubt)' if track.doubted[i] else ''} at {t:.1f} s")
    return f" ({WARNING.upper()}: {', '.join(said)})" if said else ""


def _from_above(axis: Any, log: Recording, row: dict[str, Any], t: float) -> None:
    ego, other = log.tracks[row["ego_id"]], log.tracks.get(row["object_id"] or "")
    i = ego.at(t)
    if i is None:
        return
    j = None if other is None else other.at(t)
    up = next((float(rad[i]) for rad in (ego.travel, ego.motion(), ego.yaw) if np.isfinite(rad[i])), 0.0)
    x0, y0, turn = ego.x[i], ego.y[i], np.pi / 2 - up
    middle, half = np.zeros(2), 22.0
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])

    def to_view(x: Any, y: Any) -> Any:
        return rotation @ np.array([np.asarray(x) - x0, np.asarray(y) - y0])

    if other is not None and j is not None:
        there = to_view(other.x[j], other.y[j])
        half = float(np.clip(np.abs(there).max() / 2 + 11, 17.0, 70.0))
        middle = np.clip(there / 2, -60, 60)
    _lanes(axis, log, to_view, float(np.abs(middle).max()) + half)
    for name, track in log.tracks.items():
        k = track.at(t, 0.12)
        if k is None or np.hypot(track.x[k] - x0, track.y[k] - y0) > 150:
            continue
        colour = EGO if track is ego else OBJECT if track is other else MOVING if track.extent_m() > 1.5 else PARKED
        _box(axis, track, k, to_view, colour)
        if colour in (MOVING, EGO, OBJECT):
            past, future = (track.t <= t) & (track.t > t - BEFORE_S), (track.t >= t) & (track.t < t + AFTER_S)
            axis.plot(*to_view(track.x[past], track.y[past]), "-", color=colour, lw=1, zorder=5)
            axis.plot(*to_view(track.x[future], track.y[future]), ":", color=colour, lw=1.3, zorder=5)
        label = to_view(track.x[k], track.y[k])
        if np.abs(label - middle).max() < half:
            axis.text(
                *label, f"{name[-4:]} {track.actor_class[:4]} {track.speed[k]:.1f}", fontsize=7, zorder=8, clip_on=True
            )
    axis.set_xlim(middle[0] - half, middle[0] + half)
    axis.set_ylim(middle[1] - half, middle[1] + half)
    axis.set_aspect("equal")
    axis.tick_params(labelsize=7)
    axis.grid(alpha=0.25)


def _box(axis: Any, track: Track, k: int, to_view: Any, colour: str) -> None:
    """Draw the box of a state with a nose in its direction of travel, and its motion as an arrow where the box does not stand along it.

    A state without a heading is a circle in which the box is, however it stands.
    """
    x, y, known = track.x[k], track.y[k], colour in {EGO, OBJECT}
    motion, reach = track.motion()[k], np.array([0.25, 0.5]) * track.length
    if np.isfinite(track.yaw[k]):
        corners = np.asarray(track.boxes([k])[0].exterior.coords).T
        edge = WARNING if track.doubted[k] else colour
        axis.fill(
            *to_view(*corners), fc=colour if known else "none", ec=edge, alpha=0.75 if known else 1, lw=1.2, zorder=6
        )
        # a box that travels backwards has its nose at its rear
        nose = to_view(x + np.cos(track.travel[k]) * reach, y + np.sin(track.travel[k]) * reach)
        axis.plot(*nose, color="k" if known else colour, lw=1.5, zorder=7)
    else:
        around, radius = np.linspace(0, 2 * np.pi, 40), np.hypot(track.length, track.width) / 2
        circle = to_view(x + radius * np.cos(around), y + radius * np.sin(around))
        axis.plot(*circle, color=colour if known else WARNING, lw=1.2, ls="--", zorder=6)
    if np.isfinite(motion) and (track.is_off_motion()[k] or track.doubted[k] or not np.isfinite(track.yaw[k])):
        tip = to_view(
            x + np.array([0, 1]) * np.cos(motion) * track.length, y + np.array([0, 1]) * np.sin(motion) * track.length
        )
        axis.annotate("", tip[:, 1], tip[:, 0], arrowprops={"arrowstyle": "->", "color": WARNING, "lw": 1.5}, zorder=9)


def _lanes(axis: Any, log: Recording, to_view: Any, reach: float) -> None:
    arrows: list[tuple[float, float, float, float]] = []
    for lane in log.lanes:
        if min(len(lane["left_x_m"] or ()), len(lane["right_x_m"] or ())) < 2:
            continue
        left, right = to_view(lane["left_x_m"], lane["left_y_m"]), to_view(lane["right_x_m"], lane["right_y_m"])
        around = np.concatenate([left, right[:, ::-1]], axis=1)
        if (around.min(axis=1) > reach).any() or (around.max(axis=1) < -reach).any():
            continue
        fill = FILLS.get(lane["lane_type"], "#f2f2f2" if lane["drivable"] else "#e0e0ea")
        axis.fill(*around, fc=fill, ec="none", zorder=1)
        for line, marking in ((left, lane["left_marking"]), (right, lane["right_marking"])):
            word = marking or ""
            colour, style, width = ("0.8", "-", 0.8)
            if "solid" in word:
                colour, width = "goldenrod", 1.8
            elif word:
                colour, style = "0.45", "--"
            axis.plot(*line, style, color=colour, lw=width, zorder=2)
        for i, j in ((0, 1), (-2, -1)):
            way = left[:, j] - left[:, i]
            arrows.append((*(left[:, j] + right[:, j]) / 2, *way / max(float(np.hypot(*way)), 0.1)))
    if arrows:
        axis.quiver(*np.array(arrows).T, angles="xy", scale_units="xy", scale=0.5, color="0.65", width=0.004, zorder=3)
    for line in log.stop_lines:
        axis.plot(*to_view(line[:, 0], line[:, 1]), color="purple", lw=2, zorder=3)


def _series(axes: list[Any], row: dict[str, Any], ego: Track, other_track: Track | None, log: Recording) -> None:
    first, last = row["t_start_s"] - BEFORE_S, row["t_end_s"] + AFTER_S
    speeds, distances, places, turns = axes
    for track, colour, name in ((ego, EGO, "ego"), (other_track, OBJECT, "object")):
        if track is not None:
            w = (track.t >= first) & (track.t <= last)
            speeds.plot(track.t[w], track.speed[w], ".-", color=colour, label=f"speed {name}", ms=3)
            speeds.plot(track.t[w], track.derived_speed()[w], ":", color=colour, label="from positions")
            turns.plot(track.t[w], np.degrees(np.unwrap(track.yaw[w])), color=colour, label=f"heading {name} deg")
            turns.plot(track.t[w], _beside(track.motion()[w], track.yaw[w]), ":", color=colour, label="of its motion")
    speeds.set_ylabel("m/s")
    if other_track is not None:
        t, distance, ahead, left = apart(ego, other_track)
        w = (t >= first) & (t <= last)
        distances.plot(t[w], distance[w], "k.-", ms=3, label="distance between boxes, m")
        distances.plot(
            t[w], np.clip(ahead[w], -10, None), color="tab:green", label="object's rear ahead of ego's front, m"
        )
        places.plot(
            t[w],
            left[w],
            color="tab:red",
            label=f"object left of ego, m (widths {ego.width:.1f}, {other_track.width:.1f})",
        )
        if w.any():
            distances.set_ylim(-3, min(float(np.nanmax(distance[w])) + 2, 60))
            places.set_ylim(max(float(np.nanmin(left[w])) - 1, -12), min(float(np.nanmax(left[w])) + 1, 12))
    w = (ego.t >= first) & (ego.t <= last)
    if other_track is None and w.sum() > 2:
        distances.plot(
            ego.t[w], np.gradient(ego.speed[w], ego.t[w]), color=EGO, label="acceleration of ego (from speed), m/s2"
        )
    inside = _edges(log, ego, np.flatnonzero(w))
    places.plot(ego.t[w], inside[0], color="0.3", ls="--", label="ego's left side to left edge of its lane, m")
    places.plot(ego.t[w], inside[1], color="0.6", ls="-.", label="ego's right side to right edge, m")
    for axis in axes:
        axis.axvspan(row["t_start_s"], row["t_end_s"], color="orange", alpha=0.2)
        axis.axvline(row["t_worst_s"], color="orange")
        axis.set_xlim(max(first, float(ego.t[0]) - 1), min(last, float(ego.t[-1]) + 1))
        axis.grid(alpha=0.3)
        axis.tick_params(labelsize=8)
        if axis.get_legend_handles_labels()[0]:
            axis.legend(fontsize=7.5, loc="best")


def _beside(motion: Any, yaw: Any) -> Any:
    """Return directions of motion in degrees, in the turn that is nearest to the headings as they are plotted."""
    shown = np.unwrap(yaw)
    return np.degrees(shown + np.angle(np.exp(1j * (motion - shown))))


def _edges(log: Recording, ego: Track, indices: Any) -> tuple[list[float], list[float]]:
    """Return the room to the left and right edges of the lane that the ego's middle is on, NaN on none: the one that fits its heading."""
    rooms: tuple[list[float], list[float]] = ([], [])
    for i in indices:
        point = shapely.Point(ego.x[i], ego.y[i])
        on = [log.shapes[k] for k in log.tree.query(point, predicate="intersects")]
        if not on or not np.isfinite(ego.yaw[i]):
            rooms[0].append(np.nan)
            rooms[1].append(np.nan)
            continue
        lane = max(on, key=lambda shape: abs(np.cos(shape.heading - ego.yaw[i])))
        along = np.cos(lane.heading - ego.yaw[i]) > 0
        for side, line in zip(rooms, (lane.left, lane.right) if along else (lane.right, lane.left), strict=True):
            side.append(float(line.distance(point)) - ego.width / 2)
    return rooms
