"""Turns Waymo scenarios as JSON, as Nocturne and GPUDrive write them, into scenarios of ScenarioNet, which drivelint reads.

Steps of 0.1 s. Where an object is not valid, its numbers are -10000. Nocturne has headings in degrees and columns of places, and no ids,
so that an object is called by its number; GPUDrive has radians and ids. Neither has links between lanes, nor the lines that bound them;
only GPUDrive says of what kind a line is, and which object is the recorder: in Waymo's files that is the last one, a car of 5.286 m by
2.332 m, and so it is in Nocturne's.

    python -m tests.waymo_json FILE.json ... --out FOLDER
"""

from __future__ import annotations

import argparse
import json
import pickle
from pathlib import Path
from typing import Any, Final

import numpy as np

STEP_S: Final = 0.1
_TYPES: Final = {"vehicle": "VEHICLE", "pedestrian": "PEDESTRIAN", "cyclist": "CYCLIST"}
_ROADS: Final = {
    "lane": "LANE_SURFACE_STREET", "road_line": "UNKNOWN_LINE", "road_edge": "ROAD_EDGE_BOUNDARY", "crosswalk": "CROSSWALK",
    "stop_sign": "STOP_SIGN", "speed_bump": "SPEED_BUMP", "driveway": "DRIVEWAY",
}  # fmt: skip
_ELEMENTS: Final = {
    1: "LANE_FREEWAY", 2: "LANE_SURFACE_STREET", 3: "LANE_BIKE_LANE", 6: "ROAD_LINE_BROKEN_SINGLE_WHITE",
    7: "ROAD_LINE_SOLID_SINGLE_WHITE", 8: "ROAD_LINE_SOLID_DOUBLE_WHITE", 9: "ROAD_LINE_BROKEN_SINGLE_YELLOW",
    10: "ROAD_LINE_BROKEN_DOUBLE_YELLOW", 11: "ROAD_LINE_SOLID_SINGLE_YELLOW", 12: "ROAD_LINE_SOLID_DOUBLE_YELLOW",
    13: "ROAD_LINE_PASSING_DOUBLE_YELLOW", 16: "ROAD_EDGE_MEDIAN",
}  # fmt: skip
"""`map_element_id` of GPUDrive, as in Waymo's tf.Example format."""
_BOUNDED: Final = frozenset({"CROSSWALK", "SPEED_BUMP", "DRIVEWAY"})


def scenario(content: dict[str, Any]) -> dict[str, Any]:
    """Return a scenario of ScenarioNet."""
    objects = content["objects"]
    ids = [str(each.get("id", number)) for number, each in enumerate(objects)]
    degrees = "metadata" not in content
    steps = len(objects[0]["valid"])
    recorder = content.get("metadata", {}).get("sdc_track_index", len(objects) - 1)
    features = {f"r{number}": _feature(road) for number, road in enumerate(content["roads"])}
    return {
        "id": content["name"],
        "version": "json",
        "length": steps,
        "metadata": {
            "dataset": "waymo",
            "coordinate": "waymo",
            "metadrive_processed": False,
            "sdc_id": ids[recorder],
            "ts": np.arange(steps) * STEP_S,
        },
        "tracks": {name: _track(name, each, degrees=degrees) for name, each in zip(ids, objects, strict=True)},
        "dynamic_map_states": _lights(content.get("tl_states") or {}, features, steps),
        "map_features": features,
    }


def _columns(points: Any) -> np.ndarray:
    """Return points (n, k) that are given as columns or as a list."""
    axes = [axis for axis in "xyz" if axis in (points if isinstance(points, dict) else points[0])]
    columns = [points[axis] if isinstance(points, dict) else [each[axis] for each in points] for axis in axes]
    return np.array(columns, np.float64).T


def _track(name: str, waymo_object: dict[str, Any], *, degrees: bool) -> dict[str, Any]:
    valid = np.array(waymo_object["valid"], np.bool_)
    place, heading = _columns(waymo_object["position"]), np.array(waymo_object["heading"], np.float64)
    state = {
        "position": np.pad(place, ((0, 0), (0, 3 - place.shape[1]))),
        "heading": np.radians(heading) if degrees else heading,
        "velocity": _columns(waymo_object["velocity"])[:, :2],
        "valid": valid,
        **{size: np.full(len(valid), float(waymo_object.get(size, np.nan))) for size in ("length", "width", "height")},
    }
    return {
        "type": _TYPES.get(waymo_object["type"], "OTHER"),
        "state": state,
        "metadata": {"object_id": name, "type": waymo_object["type"]},
    }


def _feature(road: dict[str, Any]) -> dict[str, Any]:
    kind = _ELEMENTS.get(road.get("map_element_id", -1), _ROADS.get(road["type"], "UNKNOWN"))
    points = _columns(road["geometry"])
    if kind == "STOP_SIGN":
        return {"type": kind, "position": points[0], "lane": []}
    return {"type": kind, "polygon" if kind in _BOUNDED else "polyline": points}


def _lights(states: dict[str, Any], features: dict[str, Any], steps: int) -> dict[str, Any]:
    """Return the lights on the lanes that begin at their stop points: lanes have no ids by which a light could name them."""
    begins = {name: each["polyline"][0, :2] for name, each in features.items() if each["type"].startswith("LANE")}
    lights = {}
    for light in states.values():
        stop = np.array([light["x"][0], light["y"][0]])
        lane = min(begins, key=lambda name: float(np.hypot(*(begins[name] - stop))))
        words: list[str | None] = [None] * steps
        for step, word in zip(light["time_index"], light["state"], strict=True):
            words[step] = f"LANE_STATE_{word.upper()}"
        lights[lane] = {
            "type": "TRAFFIC_LIGHT",
            "lane": lane,
            "stop_point": stop,
            "state": {"object_state": words},
            "metadata": {},
        }
    return lights


def write(source: Path, folder: Path) -> Path:
    """Write the scenario of a file to a folder; return its path."""
    target = folder / f"sd_waymo_json_{source.stem}.pkl"
    target.write_bytes(pickle.dumps(scenario(json.loads(source.read_text(encoding="utf-8"))), protocol=4))
    return target


def main() -> None:
    """Write the scenarios of some files."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0] if __doc__ else "")
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    for file in arguments.files:
        print(write(file, arguments.out))


if __name__ == "__main__":
    main()
