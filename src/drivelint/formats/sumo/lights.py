"""SUMO's light states (`SaveTLSStates` and `SaveTLSSwitchStates`, XML) that lie beside its floating car data.

A state has a letter for each connection that the light controls. The letter of connection 3 of light `c` is for the signal `c_3`, as in
SUMO's nets and in the OpenDRIVE that SUMO writes.
Source: SUMO's documentation of "Simulation/Output/Traffic Lights" and "Simulation/Traffic Lights".
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow as pa

from drivelint.arrays import words_of_codes
from drivelint.drive.lost_time import times_of_lost_rows
from drivelint.drive.trace import SIGNAL_STATES, QualityFinding
from drivelint.errors import TraceError
from drivelint.formats import safe_xml
from drivelint.formats.sumo.clock import seconds
from drivelint.formats.sumo.end_tag import with_end_tag
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path

    from lxml import etree

    from drivelint.arrays import Floats, Mask
    from drivelint.drive.trace import Recording

_LIGHT_STATES_FILE_PATTERN: Final = "*tls*.xml"
_HEAD_BYTES: Final = 65536
_LARGEST_TIME_S: Final = 1e9
_STATE_BY_LETTER: Final = {
    "r": "red", "u": "red_amber", "y": "amber", "Y": "amber", "g": "green", "G": "green", "o": "flashing", "O": "off",
}  # fmt: skip
"""The letter s (green for turning right after a stop) has no word here: the state is unknown."""


def add_light_states(recording: Recording, log: Path, is_log: Callable[[Path], bool]) -> None:
    """Add the light states that belong to a log.

    They are in the file with the log's name up to the first dot, or in the only file of light states in a folder with no other log.
    `is_log` returns whether a file is a log. If no file or several files fit, a note names them.
    """
    files = [
        file for file in sorted(log.parent.glob(_LIGHT_STATES_FILE_PATTERN)) if file != log and _has_light_states(file)
    ]
    log_files = [file for file in files if _name_up_to_first_dot(file) == _name_up_to_first_dot(log)]
    if (
        not log_files
        and len(files) == 1
        and not any(is_log(file) for file in log.parent.iterdir() if file.is_file() and file != log)
    ):
        log_files = files
    if len(log_files) == 1:
        _read_light_states(log_files[0], recording)
    elif files:
        reason = "it is not known which of them belongs to the log" if log_files else "no log has the name of this file"
        names = name_list([file.name for file in log_files or files])
        note = (
            f"{log.name}: light states in {names} are not read: {reason}: call it {_name_up_to_first_dot(log)}.tls.xml"
        )
        recording.notes.append(note)


def _name_up_to_first_dot(file: Path) -> str:
    return file.name.partition(".")[0]


def _has_light_states(file: Path) -> bool:
    with file.open("rb") as content:
        return b"<tlsStates" in content.read(_HEAD_BYTES)


def _read_light_states(file: Path, recording: Recording) -> None:
    try:
        content, lacks_end = with_end_tag(file.read_bytes(), "tlsStates", r"<tlsState\s[^<>]*/>")
        root = safe_xml.parse(content, f"light states of {file.name} are not read: it", TraceError)
    except TraceError as error:
        recording.findings.append(QualityFinding("lights_unread", "warning", str(error)))
        return
    recording.signals, times_s, unread = _rows_times_and_unreadable_states(root.iter("tlsState"))
    recording.notes.append(f"the states of traffic lights are those of {file.name} beside it")
    if lacks_end:
        recording.notes.append(f"{file.name} ends without </tlsStates>: its writer did not finish it")
    if unread.any():
        description = f"light states of {file.name} without a time, light or state"
        n = int(unread.sum())
        recording.findings.append(
            QualityFinding("malformed_row", "warning", f"{description}: {n}: they are left out", n)
        )
        timed = np.abs(times_s) < _LARGEST_TIME_S
        t_ns = np.round(np.where(timed, times_s, 0.0) * 1e9).astype(np.int64)
        recording.lost_times += times_of_lost_rows(t_ns, timed, unread, description)


def _rows_times_and_unreadable_states(states: Iterable[etree._Element]) -> tuple[pa.Table | None, Floats, Mask]:
    """Return the rows of all connections, and for each state its time in seconds and whether it cannot be read."""
    states_by_light: dict[tuple[str, int], tuple[list[float], list[str]]] = {}
    every: list[float] = []
    dropped: list[bool] = []
    for element in states:
        light, letters, at = element.get("id"), element.get("state"), seconds(element.get("time"))
        every.append(at)
        dropped.append(False)
        if not light or not letters or not letters.isascii() or not abs(at) < _LARGEST_TIME_S:
            dropped[-1] = True
            continue
        times, state_texts = states_by_light.setdefault((light, len(letters)), ([], []))
        times.append(at)
        state_texts.append(letters)
    unread = np.array(every, np.float64), np.array(dropped, np.bool_)
    if not states_by_light:
        return None, *unread
    words = np.full(256, -1, np.int8)
    for letter, word in _STATE_BY_LETTER.items():
        words[ord(letter)] = SIGNAL_STATES.index(word)
    parts = [
        _rows_of_light(light, n, np.array(times), words[np.frombuffer("".join(state_texts).encode(), np.uint8)])
        for (light, n), (times, state_texts) in sorted(states_by_light.items())
    ]
    return pa.concat_tables(parts), *unread


def _rows_of_light(light: str, n_connections: int, times_s: np.ndarray, codes: np.ndarray) -> pa.Table:
    """Return the rows of one light: `times_s` (t,), `codes` (t * `n_connections`,) of SIGNAL_STATES, -1: not known."""
    names = words_of_codes(
        np.tile(np.arange(n_connections, dtype=np.int32), len(times_s)), [f"{light}_{k}" for k in range(n_connections)]
    )
    t_ns = np.repeat(np.round(times_s * 1e9).astype(np.int64), n_connections)
    return pa.table({"signal_id": names, "t_ns": t_ns, "state": words_of_codes(codes, SIGNAL_STATES)})
