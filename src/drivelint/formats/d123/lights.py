"""The traffic lights of a 123D log (`traffic_light_detections.arrow`): states of lanes, whose numbers are the ids of the lights."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
import pyarrow as pa

from drivelint.arrays import words_of_codes
from drivelint.drive.lost_time import times_of_lost_rows
from drivelint.drive.trace import SIGNAL_STATES, QualityFinding
from drivelint.formats.d123 import facts
from drivelint.formats.d123.arrow_files import LIGHTS, integers, list_lengths, read_modality
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.arrays import Codes, Indices, Times
    from drivelint.drive.trace import LostTime
    from drivelint.formats.d123.arrow_files import ModalityFile

_COLUMNS: Final = {"lane_id": pa.list_(pa.int64()), "status": pa.list_(pa.int32())}


class LightStates(NamedTuple):
    """The rows of `signal_state`, the lanes in them, findings, and the times of unreadable rows."""

    rows: pa.Table
    lanes: tuple[int, ...]
    findings: list[QualityFinding]
    lost_times: list[LostTime]


def read_lights(folder: Path) -> ModalityFile | None:
    """Return the file of lights, or None if the log has none. Errors: as `read_modality`."""
    return read_modality(folder, LIGHTS, _COLUMNS)


def light_states(lights: ModalityFile, about: facts.DatasetFacts, t_ns: Times) -> LightStates:
    """Return the states of the lights. `t_ns`: the times of the rows of the file."""
    counts = [list_lengths(lights.columns[name]) for name in _COLUMNS]
    bad = (counts[0] != counts[1]) | (counts[0] < 0)
    findings, lost_times = [], []
    if bad.any():
        description = "frames of traffic lights whose lanes and states differ in number"
        findings.append(
            QualityFinding("malformed_row", "warning", f"{description}: {int(bad.sum())}: left out", int(bad.sum()))
        )
        lost_times = times_of_lost_rows(t_ns, np.ones(len(t_ns), np.bool_), bad, description)
    good = pa.array(~bad)
    lane, status = (integers(lights.columns[name].filter(good).flatten()) for name in _COLUMNS)
    lanes, lane_index = np.unique(lane, return_inverse=True)
    codes, unknown = _state_codes(status)
    findings += unknown
    if about.steady_for_flashing:
        codes, doubtful = _without_doubtful_colours(codes, lane_index, len(lanes))
        findings += doubtful
    rows = pa.table(
        {
            "signal_id": words_of_codes(lane_index.astype(np.int32), [str(number) for number in lanes.tolist()]),
            "t_ns": np.repeat(t_ns[~bad], counts[0][~bad]),
            "state": words_of_codes(codes, SIGNAL_STATES),
        }
    )
    return LightStates(rows, tuple(lanes.tolist()), findings, lost_times)


def _state_codes(status: Indices) -> tuple[Codes, list[QualityFinding]]:
    """Return indices into `SIGNAL_STATES` (-1: unknown), and a finding on numbers that 123D does not have."""
    codes = facts.light_state_codes()
    inside = (status >= 0) & (status < len(codes))
    if inside.all():
        return np.asarray(codes[status], np.int8), []
    n = int((~inside).sum())
    numbers_text = name_list([str(number) for number in np.unique(status[~inside]).tolist()])
    message = f"states of traffic lights that 123D does not define ({numbers_text}): {n}: treated as unknown"
    known_codes = np.where(inside, codes[np.where(inside, status, 0)], -1).astype(np.int8)
    return known_codes, [QualityFinding("unknown_light_state", "warning", message, n)]


def _without_doubtful_colours(codes: Codes, light: Indices, n: int) -> tuple[Codes, list[QualityFinding]]:
    """Set the states of lights that are red or amber in the whole log to unknown: a flashing light is written like a steady one."""
    is_lit = codes >= 0
    has_state = np.zeros((n, len(SIGNAL_STATES)), np.bool_)
    has_state[light[is_lit], codes[is_lit]] = True
    doubtful = (
        (has_state.sum(axis=1) == 1)
        & ~has_state[:, SIGNAL_STATES.index("green")]
        & ~has_state[:, SIGNAL_STATES.index("off")]
    )
    if not doubtful.any():
        return codes, []
    message = (
        f"traffic lights that are red or amber throughout the log: {int(doubtful.sum())}: their state is not known, "
        "because they may be flashing, which 123D does not distinguish"
    )
    finding = QualityFinding("flashing_or_steady", "warning", message, int(doubtful.sum()))
    return np.where(doubtful[light], np.int8(-1), codes), [finding]
