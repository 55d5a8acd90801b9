"""CommonRoad scenarios (XML, 2018b and 2020a): their obstacles and lights as a drive, the file itself as its map.

A scenario has no ego, only the start of a planning problem: the user names an obstacle with --ego. The position of a state is that of the
shape's origin, which may differ from the box centre (see `shapes`). Values given as areas or intervals are unknown. Environment obstacles
(buildings, pillars) are outlines, no actors. Phantom obstacles are not read.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.drive.box_centre import velocity_of_centre, yaw_rates
from drivelint.drive.trace import ACTOR_CLASSES, QualityFinding, Recording, States
from drivelint.errors import TraceError
from drivelint.formats import safe_xml
from drivelint.formats.commonroad.country import country_in_scenario_name
from drivelint.formats.commonroad.environment import environment_outlines
from drivelint.formats.commonroad.lights import signal_states
from drivelint.formats.commonroad.shapes import box_offsets, read_shape, shape_findings
from drivelint.phrases import name_list
from drivelint.road.countries import nation_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from lxml import etree

    from drivelint.arrays import Floats
    from drivelint.formats.probe import Probe


formats: Final = {"commonroad": ("CommonRoad scenario", "named with --ego")}
takes_mapping: Final = False
_CLASS_BY_TYPE = {
    "car": "car", "taxi": "car", "truck": "truck", "bus": "bus", "motorcycle": "motorcycle", "bicycle": "bicycle",
    "pedestrian": "pedestrian", "priorityVehicle": "vehicle", "parkedVehicle": "vehicle", "train": "vehicle",
    "constructionZone": "object", "roadBoundary": "object", "pillar": "object", "building": "object",
    "median_strip": "object",
}  # fmt: skip
_PATH_BY_COLUMN = {
    "x_m": "position/point/x", "y_m": "position/point/y", "yaw_rad": "orientation/exact", "v": "velocity/exact",
    "a": "acceleration/exact", "slip": "slipAngle/exact", "yaw_rate": "yawRate/exact", "step": "time/exact",
}  # fmt: skip
"""Column -> path of its element in a state."""
_ALL_STATES_XPATH: Final = "(initialState | trajectory/state)"
_COUNT_OF_INEXACT_VALUES_XPATH: Final = (
    f"count({_ALL_STATES_XPATH}//intervalStart | {_ALL_STATES_XPATH}/position/*[not(self::point)])"
)
_ROOT_TAG: Final = b"<commonRoad"
_OBSTACLE_START_TAG: Final = re.compile(rb"<(dynamicO|staticO|o)bstacle[\s>]")
_TAG: Final = re.compile(rb"<(/?)([A-Za-z][\w.-]*)>")
_STATE: Final = re.compile(rb"<state>.*?</state>", re.DOTALL)
_COMMENT_OR_CDATA: Final = re.compile(rb"<!--.*?-->|<!\[CDATA\[.*?\]\]>", re.DOTALL)
_TRAJECTORY: Final = re.compile(rb"<trajectory>(.*?)</trajectory>", re.DOTALL)


def accepts(probe: Probe) -> bool:
    """Return whether the file has CommonRoad's root element."""
    return _ROOT_TAG in probe.head


def has_obstacles(path: Path, head: bytes) -> bool:
    """Return whether the file is a scenario with obstacles, not only a map."""
    return _ROOT_TAG in head and _OBSTACLE_START_TAG.search(path.read_bytes()) is not None


def read(probe: Probe) -> Recording:
    """Read a scenario. Errors: `TraceError` for malformed XML, missing or repeated obstacles, or invalid times."""
    path = probe.path
    content = path.read_bytes()
    fast = extract_trajectories(content)
    rest, fast_columns = fast or (content, [])
    root = safe_xml.parse(rest, str(path), TraceError)
    step_s = safe_xml.number_or_nan(root.get("timeStepSize"))
    if not step_s > 0.0:
        raise TraceError(
            f"{path}: timeStepSize is {root.get('timeStepSize')!r}: a scenario needs a positive number of seconds"
        )
    obstacles = [*root.findall("dynamicObstacle"), *root.findall("staticObstacle"), *root.findall("obstacle")]
    if not obstacles:
        raise TraceError(f"{path}: the scenario has no obstacles: there is no actor to judge")
    ids = [str(o.get("id")) for o in obstacles]
    if len(set(ids)) < len(ids):
        twice = name_list(sorted({i for i in ids if ids.count(i) > 1}))
        raise TraceError(f"{path}: two obstacles have the same id: {twice}")
    trajectories = dict(zip(root.iter("trajectory"), fast_columns, strict=True)) if fast else {}
    parts = [_state_columns(path, o, trajectories) for o in obstacles]
    last = max((int(part["step"].max()) for part in parts if len(part["step"])), default=0)
    parts = [_repeat_if_static(o, part, last) for o, part in zip(obstacles, parts, strict=True)]
    counts = [len(part["step"]) for part in parts]
    shapes = [read_shape(o) for o in obstacles]
    columns = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    offsets = [box_offsets(shape, part["yaw_rad"]) for shape, part in zip(shapes, parts, strict=True)]
    heading = columns["yaw_rad"] + np.nan_to_num(columns["slip"])
    words = [_CLASS_BY_TYPE.get((o.findtext("type") or "").strip()) for o in obstacles]
    classes = [ACTOR_CLASSES.index(word) if word else -1 for word in words]
    unknown = np.full(sum(counts), -1, np.int8)
    states = States(
        ids,
        np.repeat(np.arange(len(ids), dtype=np.int32), counts),
        np.round(columns["step"] * step_s * 1e9).astype(np.int64),
        {
            "x_m": columns["x_m"], "y_m": columns["y_m"], "yaw_rad": columns["yaw_rad"],
            "vx_mps": columns["v"] * np.cos(heading), "vy_mps": columns["v"] * np.sin(heading),
            "ax_mps2": columns["a"] * np.cos(heading), "ay_mps2": columns["a"] * np.sin(heading),
            "length_m": np.repeat([s.length_m for s in shapes], counts),
            "width_m": np.repeat([s.width_m for s in shapes], counts),
        },
        {"actor_class": np.repeat(np.array(classes, np.int8), counts), "indicator": unknown, "brake_light": unknown},
        np.zeros(sum(counts), np.bool_),
    )  # fmt: skip
    _move_to_box_centres(
        states, columns["yaw_rate"], np.concatenate(offsets, axis=1), np.repeat([s.turn_rad for s in shapes], counts)
    )
    recording = Recording("commonroad", states, embedded_map=content if root.find("lanelet") is not None else None)
    if nation := nation_of(country_in_scenario_name(root)):
        recording.conditions["nation"] = nation
    if len(states):
        recording.signals, findings = signal_states(root, step_s, columns["step"].min(), columns["step"].max())
        recording.findings += findings
    has_unplaced_box = [
        bool((np.isnan(o).any(axis=0) & ~np.isnan(part["yaw_rad"])).any())
        for o, part in zip(offsets, parts, strict=True)
    ]
    recording.outlines, unread = environment_outlines(root)
    unread += [str(obstacle.get("id")) for obstacle in root.findall("phantomObstacle")]
    recording.findings += [
        *shape_findings(ids, shapes, has_unplaced_box),
        *_findings_on_unread_parts(obstacles, unread),
    ]
    return recording


def _move_to_box_centres(states: States, recorded_yaw_rate: Floats, offset: Floats, turn_rad: Floats) -> None:
    """Move the states, in place, from the shapes' origins to the box centres, by `offset` (2, n), and turn them by `turn_rad` (n,)."""
    log = states.numbers
    log["x_m"], log["y_m"] = states.place + offset
    if np.any(offset != 0.0):
        derived = yaw_rates(states, log["yaw_rad"])
        turning = np.where(np.isnan(recorded_yaw_rate), derived, recorded_yaw_rate)
        log["vx_mps"], log["vy_mps"] = velocity_of_centre(states.velocity, offset, turning)
    log["yaw_rad"] = log["yaw_rad"] + turn_rad


def _findings_on_unread_parts(obstacles: Sequence[etree._Element], unread: Sequence[str]) -> list[QualityFinding]:
    """Return findings on values that are not read (areas and intervals), and on the `unread` obstacles."""
    uncertain = sum(int(float(str(o.xpath(_COUNT_OF_INEXACT_VALUES_XPATH)))) for o in obstacles)
    sets = [str(o.get("id")) for o in obstacles if o.find("occupancySet") is not None]
    findings = []
    if uncertain:
        message = f"values of obstacles given as intervals or areas: {uncertain}: they are not known"
        findings.append(QualityFinding("uncertain_value", "warning", message, uncertain))
    if sets:
        message = (
            f"of {name_list(sets)} only the initial state is known: afterwards the scenario gives only areas "
            "in which the actor may be"
        )
        findings.append(QualityFinding.of_actors("uncertain_value", "warning", message, sets))
    if unread:
        message = (
            f"environment and phantom obstacles are not read: {name_list(unread)}: a contact with them is not detected"
        )
        findings.append(QualityFinding("unread_obstacle", "warning", message, len(unread)))
    return findings


def _state_columns(
    path: Path, obstacle: etree._Element, trajectories: Mapping[etree._Element, Mapping[str, Floats]]
) -> dict[str, Floats]:
    """Return the columns of an obstacle, (n,) each. Errors: `TraceError` for a state without an exact time."""
    states = [*obstacle.findall("initialState"), *obstacle.findall("trajectory/state")]
    columns = {
        name: np.array([safe_xml.number_or_nan(state.findtext(place)) for state in states], np.float64)
        for name, place in _PATH_BY_COLUMN.items()
    }
    trajectory = obstacle.find("trajectory")
    more = None if trajectory is None else trajectories.get(trajectory)
    if more is not None:
        unknown = np.full(len(next(iter(more.values()))), np.nan)
        columns = {n: np.concatenate([values, more.get(_PATH_BY_COLUMN[n], unknown)]) for n, values in columns.items()}
    columns["step"] = np.trunc(columns["step"])
    if not np.isfinite(columns["step"]).all():
        raise TraceError(
            f"{path}: obstacle {obstacle.get('id')}, line {obstacle.sourceline}: a state without an exact time"
        )
    return columns


def _repeat_if_static(obstacle: etree._Element, columns: dict[str, Floats], last_step: int) -> dict[str, Floats]:
    """Return the columns of an obstacle; a static obstacle gets a state at every step of the scenario."""
    n = len(columns["step"])
    static = obstacle.tag == "staticObstacle" or obstacle.findtext("role") == "static"
    if static and n == 1:
        columns = {name: np.repeat(values, last_step + 1) for name, values in columns.items()}
        columns["step"] = np.arange(last_step + 1, dtype=np.float64)
        columns["v"], columns["yaw_rate"] = np.zeros((2, last_step + 1))
    return columns


def extract_trajectories(content: bytes) -> tuple[bytes, list[dict[str, Floats]]] | None:
    """Extract the trajectories of a file with regular expressions, five times as fast as element by element.

    Returns the file without the trajectories, and the numbers of each trajectory by element path. None if states differ in form.
    """
    first = _STATE.search(content)
    shape = None if first is None else _state_pattern(first[0])
    if shape is None:
        return None
    pattern, places, n_tags = shape
    parts = _TRAJECTORY.split(content)
    columns = []
    for body in parts[1::2]:
        rows = pattern.findall(body)
        if not rows or len(rows) * n_tags != body.count(b"<") or b"&" in body:
            return None
        try:
            values = np.array([tuple(map(float, row)) for row in rows], np.float64)
        except ValueError:
            return None
        columns.append(dict(zip(places, values.T, strict=True)))
    rest = b"<trajectory/>".join(parts[::2])
    # if a trajectory is in a comment, or was not extracted (with attributes or without content), the order is uncertain
    if b"<trajectory" in b"".join(_COMMENT_OR_CDATA.findall(rest)) or rest.count(b"<trajectory") != len(columns):
        return None
    return rest, columns


def _state_pattern(state: bytes) -> tuple[re.Pattern[bytes], list[str], int] | None:
    """Return a pattern for states of this form, the element paths of its numbers, and its number of tags; None for an unsuitable form."""
    pattern, at, is_open = b"", 0, False
    places: list[str] = []
    stack: list[str] = []
    tags = list(_TAG.finditer(state))
    for tag in tags:
        between = state[at : tag.start()]
        closes, name = bool(tag[1]), tag[2].decode()
        if closes and not stack:
            return None
        if is_open and closes:
            pattern += rb"([^<]*)"
            places.append("/".join(stack[1:]))
        elif between.strip():
            return None
        else:
            pattern += rb"\s*"
        pattern += re.escape(tag[0])
        if closes:
            stack.pop()
        else:
            stack.append(name)
        at, is_open = tag.end(), not closes
    if (
        len(tags) != state.count(b"<")
        or any("interval" in place or (place.startswith("position/") and "/point/" not in place) for place in places)
        or len(places) < 2
        or len(set(places)) < len(places)
    ):
        return None
    return re.compile(pattern), places, len(tags)
