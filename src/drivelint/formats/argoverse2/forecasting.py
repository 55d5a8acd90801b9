"""Motion forecasting scenarios of Argoverse 2: one Parquet table of tracks at ten steps a second, and the map beside it.

The track AV is the recording vehicle. The guide states that positions are box centres, but those of AV are its rear axle. A published
scenario shows this: in turns, the recorded point moves along the heading, as only the rear axle does. Measured, it lies -0.3 m ahead of
the axle, give or take 0.2 m; the box centre would be 1.3 m ahead. The egovehicle frame of the sensor logs has the same origin. The reader
moves AV to its box centre.

Other tracks have no size, so gaps to them are not known. Tracks come from the vehicle's own tracker, in fragments of ten steps and more.
No range is documented within which every actor has a track.

Source: Argoverse user guide ("Motion Forecasting Dataset"); av2-api, `data_schema` and `scenario_serialization`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.drive.trace import ACTOR_CLASSES, QualityFinding, Recording, States
from drivelint.errors import TraceError
from drivelint.formats.argoverse2 import cells, vehicle
from drivelint.formats.argoverse2.categories import FORECASTING_CLASSES, class_codes
from drivelint.formats.argoverse2.cities import NATION, frame_of_city
from drivelint.formats.folders import folder_kind
from drivelint.formats.tables import parquet
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.arrays import Times
    from drivelint.formats.probe import Probe

NAME: Final = "argoverse2-forecasting"
formats: Final = {NAME: ("Argoverse 2 motion forecasting scenario", "the track AV, the vehicle that records")}
takes_mapping: Final = False
EGO_ID: Final = "AV"
SENSOR_RANGE_M: Final = 50.0
"""Not documented. In published scenarios, the density of tracks is constant up to about 50 m from the vehicle, and lower beyond."""
STEP_NS: Final = 100_000_000
_MAP_FILE_PATTERN: Final = "log_map_archive_*.json"
_TIME_COLUMN: Final = "timestep"
_STATE_COLUMN_BY_FILE_COLUMN: Final = {
    "position_x": "x_m", "position_y": "y_m", "heading": "yaw_rad", "velocity_x": "vx_mps", "velocity_y": "vy_mps",
}  # fmt: skip
_REQUIRED_COLUMNS: Final = ("track_id", "object_type", _TIME_COLUMN, *_STATE_COLUMN_BY_FILE_COLUMN)
_CLOCK_COLUMNS: Final = ("start_timestamp", "end_timestamp", "num_timestamps")


def accepts(probe: Probe) -> bool:
    """Return whether the path is a scenario folder or, without a mapping, a Parquet file with the columns of a scenario."""
    if probe.path.is_dir():
        return folder_kind(probe.path) == NAME
    if probe.options.mapping is not None or not probe.head.startswith(b"PAR1"):
        return False
    return set(_REQUIRED_COLUMNS) <= set(parquet.schema(probe.path).names)


def read(probe: Probe) -> Recording:
    """Read a scenario. Errors: `TraceError` for a damaged file, missing columns, or several scenarios in one file or folder."""
    path = _scenario_file(probe.path)
    rows = _scenario_table(path)
    step, timed = cells.integer_column(path, rows, _TIME_COLUMN)
    t_ns = _times_of_rows(path, rows, step)
    usable, findings, lost_times = cells.rows_with_track_and_time(path, rows, "track_id", t_ns, timed)
    rows, t_ns = rows.filter(pa.array(usable)), t_ns[usable]
    ids = pc.dictionary_encode(cells.cast_column(path, rows, "track_id", pa.string()))
    classes, notes = class_codes(cells.cast_column(path, rows, "object_type", pa.string()), FORECASTING_CLASSES)
    raw = cells.number_columns(path, rows, _STATE_COLUMN_BY_FILE_COLUMN)
    odd = np.zeros(len(rows), np.bool_)
    numbers = {}
    for name, values in raw.items():
        wrong = ~np.isfinite(values)
        odd |= wrong & rows[name].is_valid().to_numpy(zero_copy_only=False)
        numbers[_STATE_COLUMN_BY_FILE_COLUMN[name]] = np.where(wrong, np.nan, values)
    states = States(
        ids.dictionary.to_pylist(), ids.indices.to_numpy().astype(np.int32), t_ns, numbers,
        {"actor_class": classes}, odd,
    )  # fmt: skip
    _move_ego_to_box_centre(states)
    recording = Recording(NAME, states, ego_ids=[EGO_ID], findings=findings, lost_times=lost_times, notes=notes)
    if EGO_ID in states.ids:
        recording.findings.append(vehicle.assumed_size_finding(EGO_ID))
    recording.sensor_range_m = SENSOR_RANGE_M
    recording.conditions["nation"] = NATION
    city = [word for word in _distinct_texts(path, rows, "city") if word]
    if len(city) == 1 and (frame := frame_of_city(city[0])):
        recording.geo_reference, recording.geo_offset = frame.reference, (frame.x_m, frame.y_m, 0.0)
    _add_map(recording, probe.path)
    return recording


def _scenario_file(path: Path) -> Path:
    if not path.is_dir():
        return path
    files = sorted(path.glob("scenario_*.parquet"))
    if len(files) > 1:
        raise TraceError(
            f"{path}: {len(files)} scenarios in one folder ({name_list([file.name for file in files])}): give one of them"
        )
    return files[0]


def _scenario_table(path: Path) -> pa.Table:
    has = parquet.schema(path).names
    if lacking := [name for name in _REQUIRED_COLUMNS if name not in has]:
        raise TraceError(
            f"{path}: no column {', '.join(lacking)}: a scenario needs {', '.join(_REQUIRED_COLUMNS)}: get it again"
        )
    optional = [name for name in (*_CLOCK_COLUMNS, "city", "scenario_id") if name in has]
    rows = parquet.table(path, [*_REQUIRED_COLUMNS, *optional])
    if len(names := _distinct_texts(path, rows, "scenario_id")) > 1:
        raise TraceError(f"{path}: has {len(names)} scenarios: write one file per scenario")
    return rows


def _distinct_texts(path: Path, rows: pa.Table, name: str) -> list[str | None]:
    if name not in rows.schema.names:
        return []
    texts: list[str | None] = pc.unique(cells.cast_column(path, rows, name, pa.string())).to_pylist()
    return texts


def _times_of_rows(path: Path, rows: pa.Table, step: Times) -> Times:
    """Return the time of each row: steps evenly spaced from the first to the last time stamp; without time stamps, at 10 Hz from 0."""
    if not set(_CLOCK_COLUMNS) <= set(rows.schema.names) or not len(rows):
        return step * STEP_NS
    start, end, n = (values[0] for values in cells.number_columns(path, rows, _CLOCK_COLUMNS).values())
    if not (end > start and n > 1):
        return step * STEP_NS
    spacing: Times = np.round(step * ((end - start) / (n - 1))).astype(np.int64)
    return int(start) + spacing


def _move_ego_to_box_centre(states: States) -> None:
    """Move the ego from its rear axle to its box centre, and set its class and size, in place.

    The velocity remains that of the axle: along the heading, both points have the same velocity.
    """
    ego_rows = states.actor == states.ids.index(EGO_ID) if EGO_ID in states.ids else np.zeros(len(states), np.bool_)
    states.codes["actor_class"][ego_rows] = ACTOR_CLASSES.index("car")
    numbers = states.numbers
    x, y, yaw = (numbers[name][ego_rows] for name in ("x_m", "y_m", "yaw_rad"))
    numbers["x_m"][ego_rows], numbers["y_m"][ego_rows] = vehicle.box_centres(x, y, yaw)
    for name, size in zip(("length_m", "width_m", "height_m"), vehicle.EGO_BOX_SIZE_M, strict=True):
        numbers[name] = np.where(ego_rows, size, np.nan)


def _add_map(recording: Recording, path: Path) -> None:
    files = sorted((path if path.is_dir() else path.parent).glob(_MAP_FILE_PATTERN))
    if not path.is_dir():
        name = path.name.removeprefix("scenario_").removesuffix(".parquet")
        maps_of_log = [file for file in files if name in file.name]
        if maps_of_log:
            recording.notes.append(
                f"its map {maps_of_log[0].name} is in the same folder: give the folder, or use --map"
            )
    elif len(files) > 1:
        names = name_list([file.name for file in files])
        message = f"the scenario has {len(files)} maps ({names}), and none is used: keep only one"
        recording.findings.append(QualityFinding.unusable_map(message))
    elif files:
        try:
            recording.embedded_map = files[0].read_bytes()
        except OSError as error:
            raise TraceError(f"{files[0]}: cannot be read: {error.strerror or error}") from error
    else:
        recording.notes.append(f"its map is missing: {_MAP_FILE_PATTERN}")
