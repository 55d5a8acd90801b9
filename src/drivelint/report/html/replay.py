"""The positions of actors over time as compact JSON, from which the page's script animates plan views."""

from __future__ import annotations

import json
from collections import defaultdict
from typing import TYPE_CHECKING, Final

import numpy as np
from markupsafe import Markup

from drivelint.report.html.svg import polygon_path
from drivelint.result.counts import group_rows

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from drivelint.report.html.road import DrawnMaps
    from drivelint.result.text import Row

    Key = tuple[str, str, int]

MAX_REPLAY_POINTS: Final = 60_000
"""Positions of actors in the page; further drives are shown without a replay."""
_NS_PER_CENTISECOND: Final = 10_000_000
_CM_PER_M: Final = 100


def centiseconds(t_ns: int, start_ns: int) -> int:
    """Return a time in hundredths of a second since the drive's start, the unit of the page's script."""
    return round((t_ns - start_ns) / _NS_PER_CENTISECOND)


def replays(
    scenes: Iterable[Row], spaces: Mapping[Key, Sequence[Row]], starts: Mapping[str, int], road: DrawnMaps
) -> dict[str, Markup]:
    """Return the replay of each drive as JSON for the page's script, up to `MAX_REPLAY_POINTS` points in total.

    `a`: actor -> times, x, y (cm from the map's origin) and heading (centirad), each as its first value and then differences;
    `s`: ego -> time -> actor -> SVG path of its danger space in the drawn units of `road`.
    """
    by_drive: dict[str, Markup] = {}
    n = 0
    for drive_id, rows in group_rows(scenes, lambda scene: scene["drive_id"]).items():
        start = starts.get(drive_id) or 0
        lanes = road.lanes_of(rows[0]["environment_id"])
        tracks = _positions_by_actor(rows)
        n += sum(len(track) for track in tracks.values())
        if n > MAX_REPLAY_POINTS:
            break
        actors = {
            actor: _difference_encoded_columns(sorted(track.items()), start, lanes.origin)
            for actor, track in sorted(tracks.items())
        }
        rings: dict[str, dict[int, dict[str, str]]] = {}
        for (drive, ego, t_ns), around in spaces.items():
            if drive == drive_id:
                rings.setdefault(ego, {})[centiseconds(t_ns, start)] = {
                    ring["actor_id"]: polygon_path(
                        np.rint(lanes.to_drawn_units(np.column_stack([ring["x_m"], ring["y_m"]])))
                    )
                    for ring in around
                }
        by_drive[drive_id] = _json({"a": actors, "s": rings})
    return by_drive


def _positions_by_actor(scenes: Sequence[Row]) -> dict[str, dict[int, tuple[float, float, float]]]:
    tracks: dict[str, dict[int, tuple[float, float, float]]] = defaultdict(dict)
    for actor in (actor for scene in scenes for actor in scene["actors"]):
        tracks[actor["actor_id"]] |= {p["t_ns"]: (p["x_m"], p["y_m"], p["yaw_rad"] or 0.0) for p in actor["path"] or []}
    return tracks


def _difference_encoded_columns(
    track: Sequence[tuple[int, tuple[float, float, float]]], start_ns: int, origin: tuple[float, ...]
) -> list[list[int]]:
    if not track:
        return [[], [], [], []]
    x, y, yaw = np.array([place for _, place in track]).T
    t = np.array([centiseconds(t_ns, start_ns) for t_ns, _ in track])
    columns = (t, (x - origin[0]) * _CM_PER_M, (y - origin[1]) * _CM_PER_M, np.unwrap(yaw) * 100)
    return [np.diff(np.rint(c).astype(np.int64), prepend=0).tolist() for c in columns]


def _json(value: object) -> Markup:
    """Return JSON without the characters that could end the script element around it."""
    text = json.dumps(value, separators=(",", ":"), ensure_ascii=True)
    return Markup(text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026"))  # noqa: S704 - escaped
