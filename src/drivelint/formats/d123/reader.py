"""Reads a log of 123D, a folder of Arrow files: the ego's states, the boxes of the actors around it, lights, and its map.

A log has a table of frames (`sync.arrow`), which links the rows of each file to the frames. The ego's poses may be far denser than the
boxes; the ego's steps are the frames that have both, because the actors around it are not known in between. Positions are box centres.
The recorded pose of the ego is that of its IMU; the reader moves it to the box centre.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from drivelint.drive.lost_time import times_of_lost_rows
from drivelint.drive.trace import QualityFinding, Recording, States
from drivelint.errors import TraceError
from drivelint.formats.d123 import boxes as box_file
from drivelint.formats.d123 import ego as ego_file
from drivelint.formats.d123 import facts
from drivelint.formats.d123.arrow_files import (
    BOXES,
    EGO_STATE,
    LIGHTS,
    SYNC,
    file_path,
    frame_table_columns_and_log_info,
    integers,
    read_modality,
)
from drivelint.formats.d123.clock import converter_from_times
from drivelint.formats.d123.lights import light_states, read_lights
from drivelint.formats.d123.map_file import find_map
from drivelint.formats.folders import folder_kind

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    import pyarrow as pa

    from drivelint.arrays import Indices, Mask, Times
    from drivelint.formats.d123.arrow_files import LogInfo, ModalityFile
    from drivelint.formats.d123.clock import LogTimeConverter
    from drivelint.formats.probe import Probe

NAME: Final = "123d"
formats: Final = {NAME: ("123D log (Arrow files of py123d)", "the vehicle of ego_state_se3.arrow")}
takes_mapping: Final = False
_NO_ROAD_USERS: Final = QualityFinding(
    "no_road_users",
    "warning",
    f"the log has no {BOXES}.arrow: the actors around the ego are not recorded: rules about other actors are unknown",
)
_SAME_EGO_AND_BOX_TIME_TOLERANCE_US: Final = 10  # a difference in time in which no actor moves by a millimetre
_MALFORMED_FRAMES_TEXT: Final = (
    "frames whose lists of boxes differ in length or lack a track, or that refer to missing rows"
)


def accepts(probe: Probe) -> bool:
    """Return whether the path is a folder with the ego's states and the table of frames."""
    return probe.path.is_dir() and folder_kind(probe.path) == NAME


def read(probe: Probe) -> Recording:
    """Read a log.

    Errors: `TraceError` for a damaged file, a column that is missing or of another type, a version that is not read, and a log without
    a usable frame.
    """
    folder = probe.path
    sync, info = frame_table_columns_and_log_info(folder)
    about = facts.dataset_facts(info.dataset)
    ego, boxes, lights = ego_file.read_ego(folder), box_file.read_boxes(folder), read_lights(folder)
    files = [file.columns["timestamp_us"] for file in (ego, boxes, lights) if file is not None]
    time = converter_from_times(folder, [sync["timestamp_us"], *files], utc=about.utc)
    frames = _usable_frame_rows(folder, sync, ego, boxes)
    recording = Recording(
        NAME, _NO_STATES, sensor_range_m=about.sensor_range_m, notes=[_data_set_note(info), *time.notes]
    )
    recording.notes += frames.notes
    if nation := about.nation_of(info.location):
        recording.conditions["nation"] = nation
    if frames.malformed.any():
        n = int(frames.malformed.sum())
        recording.findings.append(
            QualityFinding("malformed_row", "warning", f"{_MALFORMED_FRAMES_TEXT}: {n}: left out", n)
        )
        t_ns = time.nanoseconds(integers(sync["timestamp_us"]))
        recording.lost_times += times_of_lost_rows(
            t_ns, np.ones(len(t_ns), np.bool_), frames.malformed, _MALFORMED_FRAMES_TEXT
        )
    box_states: list[States] = []
    if boxes is None:
        recording.findings.append(_NO_ROAD_USERS)
    else:
        t_ns = time.nanoseconds(integers(boxes.columns["timestamp_us"])[frames.box_rows])
        states, findings, notes = box_file.box_states(boxes, frames.box_rows, t_ns, about)
        box_states.append(states)
        recording.findings += findings
        recording.notes += notes
    name = ego_file.ego_id_unlike_box_ids(box_states[0].ids if box_states else ())
    forward_m = 0.0 if probe.options.ego_size is None else probe.options.ego_size.forward_m
    box, findings = ego_file.ego_box(ego, about, name, forward_m)
    recording.findings += findings
    t_ns = time.nanoseconds(frames.ego_us)
    ego_states = ego_file.ego_states(ego, frames.ego_rows, t_ns, box, about=about, name=name)
    recording.states, recording.ego_ids = _ego_with_boxes(ego_states, box_states), [name]
    light_lanes: tuple[int, ...] = ()
    if lights is not None:
        state_rows = light_states(lights, about, time.nanoseconds(integers(lights.columns["timestamp_us"])))
        recording.signals, light_lanes = state_rows.rows, state_rows.lanes
        recording.findings += state_rows.findings
        recording.lost_times += state_rows.lost_times
    recording.embedded_map, findings, notes = find_map(folder, info, light_lanes)
    recording.findings += findings
    recording.notes += notes
    return recording


def log_time_converter(folder: Path) -> LogTimeConverter:
    """Return the clock with which `read` reads a log. Errors: as `read`."""
    sync, info = frame_table_columns_and_log_info(folder)
    files = [read_modality(folder, name, {}) for name in (EGO_STATE, BOXES, LIGHTS)]
    times = [file.columns["timestamp_us"] for file in files if file is not None]
    return converter_from_times(folder, [sync["timestamp_us"], *times], utc=facts.dataset_facts(info.dataset).utc)


_NO_STATES: Final = States([], np.zeros(0, np.int32), np.zeros(0, np.int64), {}, {}, np.zeros(0, np.bool_))


class _FrameRows(NamedTuple):
    """For each frame that is read, its row in the ego's file and in the file of boxes; which frames are malformed; and notes.

    `ego_us`: the time of each row in `ego_rows`.
    """

    ego_rows: Indices
    ego_us: Times
    box_rows: Indices
    malformed: Mask
    notes: list[str]


def _usable_frame_rows(
    folder: Path, sync: Mapping[str, pa.Array], ego: ModalityFile, boxes: ModalityFile | None
) -> _FrameRows:
    """Return the frames that have the ego and, if the log has boxes, boxes. Errors: `TraceError` if there is no such frame."""
    ego_rows = integers(sync[EGO_STATE])
    box_rows = integers(sync[BOXES]) if boxes is not None and BOXES in sync else np.full(len(ego_rows), -1)
    whole, malformed = ego_rows >= 0, ego_rows >= ego.n_rows
    notes = []
    if boxes is not None:
        if n := int((whole & (box_rows < 0)).sum()):
            notes.append(
                f"{n} of {int(whole.sum())} frames have no boxes: they are not read, because the other actors are not known there"
            )
        if n := boxes.n_rows - len(np.unique(box_rows[(box_rows >= 0) & (box_rows < boxes.n_rows)])):
            notes.append(f"{n} of {boxes.n_rows} rows of boxes belong to no frame of {SYNC}.arrow: they are not read")
        whole &= box_rows >= 0
        malformed |= box_rows >= boxes.n_rows
        bad_rows = np.append(box_file.malformed_rows(boxes), False)
        malformed |= bad_rows[np.where(malformed, -1, box_rows)]
    malformed &= whole
    usable = np.flatnonzero(whole & ~malformed)
    if not len(usable):
        raise TraceError(
            f"{file_path(folder, SYNC)}: no frame has the ego and boxes that can be read: nothing can be judged: convert the log again"
        )
    ego_rows, box_rows = ego_rows[usable], box_rows[usable]
    moments = integers(ego.columns["timestamp_us"])
    ego_us = moments[ego_rows]
    if boxes is not None:
        ego_rows, ego_us = _nearest_ego_rows(integers(boxes.columns["timestamp_us"])[box_rows], moments, ego_rows)
    return _FrameRows(ego_rows, ego_us, box_rows, np.asarray(malformed, np.bool_), notes)


def _nearest_ego_rows(box_us: Times, ego_us: Times, rows_of_frames: Indices) -> tuple[Indices, Times]:
    """Return for each time of boxes the ego's row nearest in time, and its time. `ego_us`: the times of all rows of the ego.

    The row that the frame itself names (`rows_of_frames`) may be a later row: the first after the frame's time. Converters round times: the
    ego's and the boxes' time may differ by a microsecond although both were recorded at one time.
    """
    if (np.diff(ego_us) < 0).any():
        return rows_of_frames, ego_us[rows_of_frames]
    after = np.clip(np.searchsorted(ego_us, box_us), 1, max(len(ego_us) - 1, 1))
    before, after = after - 1, np.minimum(after, len(ego_us) - 1)
    rows = np.where(box_us - ego_us[before] <= ego_us[after] - box_us, before, after)
    return rows, np.where(np.abs(ego_us[rows] - box_us) <= _SAME_EGO_AND_BOX_TIME_TOLERANCE_US, box_us, ego_us[rows])


def _ego_with_boxes(ego_states: States, box_states: list[States]) -> States:
    """Return the states of the ego and of the boxes together."""
    if not box_states:
        return ego_states
    ids = [*ego_states.ids, *box_states[0].ids]
    return States.concatenate(
        [replace(ego_states, ids=ids), replace(box_states[0], ids=ids, actor=box_states[0].actor + np.int32(1))]
    )


def _data_set_note(info: LogInfo) -> str:
    place = "" if info.location is None else f", {info.location}"
    return f"data set {info.dataset or 'without a name'}{place}; written by py123d {info.version}"
