"""Builds scenarios of ScenarioNet for the tests, as its converters write them, and their pickles."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np

STEP_S = 0.1


def track(
    place: Any, heading: Any = 0.0, *, kind: str = "VEHICLE", dataset_type: str | None = None, **state: Any
) -> dict[str, Any]:
    """Return a track at places (T, 2): it has velocities by central differences, sizes of a car, and is valid all the time."""
    place = np.asarray(place, np.float64)
    n = len(place)
    values = {
        "position": np.column_stack([place, np.full(n, 0.8)]),
        "heading": np.broadcast_to(np.asarray(heading, np.float64), n).copy(),
        "velocity": np.gradient(place, STEP_S, axis=0),
        "valid": np.ones(n),
        "length": np.full((n, 1), 4.5),
        "width": np.full((n, 1), 1.8),
        "height": np.full((n, 1), 1.5),
        **state,
    }
    return {"type": kind, "state": values, "metadata": {"type": dataset_type or kind, "object_id": "?"}}


def straight(n: int, speed: float, x: float = 0.0, y: float = 0.0) -> np.ndarray:
    """Return places (n, 2) of somebody who goes east."""
    return np.column_stack([x + np.arange(n) * STEP_S * speed, np.full(n, y)])


def lane(polyline: Any, kind: str = "LANE_SURFACE_STREET", **more: Any) -> dict[str, Any]:
    """Return a lane."""
    return {"type": kind, "polyline": np.asarray(polyline, np.float32), **more}


def line(polyline: Any, kind: str = "ROAD_LINE_BROKEN_SINGLE_WHITE") -> dict[str, Any]:
    """Return a line or an edge."""
    return {"type": kind, "polyline": np.asarray(polyline, np.float32)}


def boundary(name: str, last: int, first: int = 0, kind: str = "UNKNOWN") -> dict[str, str]:
    """Return a boundary as Waymo's lanes refer to one: everything is text."""
    return {
        "lane_start_index": str(first), "lane_end_index": str(last), "boundary_type": kind, "boundary_feature_id": name,
    }  # fmt: skip


def light(states: list[str | None], lane_id: Any, stop_point: Any) -> dict[str, Any]:
    """Return a traffic light."""
    place = np.asarray(stop_point, np.float32)
    return {
        "type": "TRAFFIC_LIGHT",
        "state": {"object_state": states},
        "lane": lane_id,
        "stop_point": place,
        "metadata": {},
    }


def scenario(
    tracks: dict[str, Any],
    *,
    dataset: str = "waymo",
    lights: dict[str, Any] | None = None,
    features: dict[str, Any] | None = None,
    **metadata: Any,
) -> dict[str, Any]:
    """Return a scenario; its ego is the first track."""
    n = len(next(iter(tracks.values()))["state"]["heading"])
    return {
        "id": "made",
        "version": "1",
        "length": n,
        "metadata": {"dataset": dataset, "sdc_id": next(iter(tracks)), "ts": np.arange(n) * STEP_S, **metadata},
        "tracks": tracks,
        "dynamic_map_states": lights or {},
        "map_features": features or {},
    }


def put(folder: Path, content: Any, *, name: str = "sd_made_1.pkl", protocol: int = 4) -> Path:
    """Write the pickle of anything."""
    path = folder / name
    path.write_bytes(pickle.dumps(content, protocol))
    return path
