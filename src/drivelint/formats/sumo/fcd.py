"""SUMO's floating car data (`--fcd-output`, XML, CSV or Parquet), with the vehicle types of its route files.

A position is the middle of the front bumper, an angle runs clockwise from north. FCD has no sizes: they are in the `vType`
elements of a route or additional file, given with --mapping or found beside the log. For states of lights, see `lights`.
Persons and containers are road users of their own unless they ride in a vehicle.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.arrays import wrap_angles
from drivelint.drive.lost_time import times_of_lost_rows
from drivelint.drive.trace import BRAKE_LIGHTS, INDICATORS, LostTime, QualityFinding, Recording, States
from drivelint.errors import TraceError
from drivelint.formats.sumo.boxes import RowActors, boxes_of
from drivelint.formats.sumo.degrees import positions_in_net_and_findings
from drivelint.formats.sumo.fcd_tables import column_groups, read_csv, read_parquet
from drivelint.formats.sumo.fcd_xml import ROOT_TAG, read_xml
from drivelint.formats.sumo.lights import add_light_states
from drivelint.formats.sumo.riders import is_riding
from drivelint.formats.sumo.rows import CONTAINER, KINDS, PERSON, PERSON_OR_CONTAINER, UNKNOWN_KIND, VEHICLE
from drivelint.formats.sumo.vehicle_types import type_and_original, types_and_notes
from drivelint.formats.tables import parquet
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    from drivelint.arrays import Codes, Floats, Mask, Times
    from drivelint.drive.trace import IngestOptions
    from drivelint.formats.probe import Probe
    from drivelint.formats.sumo.rows import Rows
    from drivelint.formats.sumo.vehicle_types import VehicleType


formats: Final = {"sumo-fcd": ("SUMO floating car data", "named with --ego")}
takes_mapping: Final = True
HEAD_BYTES = 65536
_LARGEST_TIME_S = 9e9  # beyond it nanoseconds do not fit into 64 bits
_RIGHT, _LEFT, _EMERGENCY, _BRAKE = 1, 2, 4, 8
_KIND_BY_ACTOR_CLASS: Final = {None: UNKNOWN_KIND, "pedestrian": PERSON, "object": CONTAINER}


def is_fcd(path: Path, head: bytes) -> bool:
    """Return whether a file is FCD: it has an <fcd-export> element, or is a table with the columns of FCD."""
    if head.startswith(b"PAR1") or _begins_with_time_column(head):
        return bool(_column_groups_of_file(path, head))
    if b"<fcd-export" in head:
        return True
    if head.lstrip()[:1] != b"<" or b"sumo" not in head.lower():
        return False
    with path.open("rb") as file:  # its comment with the configuration may be long
        return b"<fcd-export" in file.read(HEAD_BYTES)


def accepts(probe: Probe) -> bool:
    """Return whether the file is FCD. With a mapping for tables, the columns must also name their elements and include angles."""
    if probe.path.is_dir() or not is_fcd(probe.path, probe.head):
        return False
    if probe.options.mapping is None or probe.options.mapping.lower().endswith(".xml"):
        return True
    groups = _column_groups_of_file(probe.path, probe.head) if not probe.head.lstrip().startswith(b"<") else {}
    return all(name and "angle" in columns for name, columns in groups.items())


def read(probe: Probe) -> Recording:
    """Read a log. The option `mapping` is the file with its vTypes; without it, the files beside the log are used.

    Errors: `TraceError` for a file that cannot be read, `UsageError` for a types file without a vType.
    """
    path = probe.path
    rows = _read_rows(path)
    nameless = pc.equal(rows.table["id"], "").to_numpy()
    # a step without actors is a row with its time alone
    filled = np.any([np.isfinite(rows.numbers(name)) for name in ("x", "y", "angle", "speed")], axis=0)
    dropped = int((nameless & filled).sum())
    lost_times = _lost_times(rows.numbers("time"), nameless & filled, f"{path.name}: rows without an id")
    rows = rows.take(~nameless)
    untimed = int((~(np.abs(rows.numbers("time")) < _LARGEST_TIME_S)).sum())
    if untimed:
        raise TraceError(f"{path}: rows of vehicles without a valid time: {untimed}: write the log again")
    types, notes = types_and_notes(path, probe.options.mapping)
    rows = rows._replace(kind=_row_kinds_from_types(rows, types))
    rides = is_riding(rows)
    if rides.all():
        raise TraceError(f"{path}: no vehicle in this log")
    last_ns = int(_times_ns(rows).max())
    recording = _recording(path, rows.take(~rides), types, probe.options)
    recording.notes += notes
    if rides.any():
        message = (
            f"rows of persons or containers that ride in a vehicle: {int(rides.sum())}: in these "
            "rows they are not separate road users"
        )
        recording.findings.append(QualityFinding("riding", "info", message, int(rides.sum())))
    if rows.lacks_end:
        recording.lost_times.append(
            LostTime(last_ns, None, f"{path.name} ends without </{ROOT_TAG}>: its writer did not finish it")
        )
    if rows.selection_options:
        recording.findings.append(_selection_finding(rows.selection_options))
    add_light_states(recording, path, _is_fcd_file)
    if dropped:
        message = f"rows without an id: {dropped}: they are not judged"
        recording.findings.append(QualityFinding("dropped_row", "error", message, dropped))
        recording.lost_times += lost_times
    return recording


def _selection_finding(options: tuple[str, ...]) -> QualityFinding:
    message = (
        f"by its configuration, SUMO wrote only some of the road users ({name_list(list(options))}): who else was around the ego is "
        "not known, and rules about other actors are unknown"
    )
    return QualityFinding("road_users_left_out", "warning", message)


def _lost_times(time_s: Floats, lost_rows: Mask, cause: str) -> list[LostTime]:
    timed = np.abs(time_s) < _LARGEST_TIME_S
    return times_of_lost_rows(np.round(np.where(timed, time_s, 0.0) * 1e9).astype(np.int64), timed, lost_rows, cause)


def _is_fcd_file(file: Path) -> bool:
    with file.open("rb") as content:
        return is_fcd(file, content.read(HEAD_BYTES))


def _read_rows(path: Path) -> Rows:
    with path.open("rb") as file:
        start = file.read(16)
    if start.startswith(b"PAR1"):
        return read_parquet(path)
    return read_csv(path) if _begins_with_time_column(start) else read_xml(path)


def _begins_with_time_column(head: bytes) -> bool:
    """Return whether a file begins with the name of SUMO's first column, which other programs may have put in quotes."""
    return head.lstrip(b'\xef\xbb\xbf"').startswith(b"time")


def _column_groups_of_file(path: Path, head: bytes) -> dict[str, dict[str, str]]:
    if head.startswith(b"PAR1"):
        return column_groups(parquet.schema(path).names)
    names = re.split(r"[;,\t]", head.split(b"\n", 1)[0].decode("utf-8-sig", "replace").strip())
    return column_groups([name.strip('"') for name in names])


def _times_ns(rows: Rows) -> Times:
    return np.round(rows.numbers("time") * 1e9).astype(np.int64)


def _row_kinds_from_types(rows: Rows, types: Mapping[str, VehicleType]) -> Codes:
    """Return the kinds of the rows. A table's column names do not show the kind of a row; the row's type does, if it is known."""
    open_ = np.isin(rows.kind, (UNKNOWN_KIND, PERSON_OR_CONTAINER))
    if not open_.any():
        return rows.kind
    names = pc.dictionary_encode(rows.table["type"]).combine_chunks()
    ids = frozenset(pc.unique(rows.table["id"]).to_pylist())
    type_of_names = [type_and_original(name, types, ids)[0] for name in names.dictionary.to_pylist()]
    by_type = np.array([_KIND_BY_ACTOR_CLASS.get(kind.actor_class, VEHICLE) for kind in type_of_names], np.int8)[
        names.indices.to_numpy()
    ]
    # a carried person stays a person whatever vehicle class its type has
    is_by_type = open_ & (by_type != UNKNOWN_KIND) & ~((rows.kind == PERSON_OR_CONTAINER) & (by_type == VEHICLE))
    return np.where(is_by_type, by_type, rows.kind)


def _actor_ids_indices_and_notes(rows: Rows) -> tuple[list[str], NDArray[np.int32], list[str]]:
    """Return the ids of all actors, the index of each row's actor, and notes.

    SUMO's vehicles, persons and containers may have the same id: then the id of a person or container begins with its kind.
    """
    encoded = pc.dictionary_encode(rows.table["id"]).combine_chunks()
    ids, actor = [str(value) for value in encoded.dictionary.to_pylist()], encoded.indices.to_numpy().astype(np.int32)
    is_vehicle = np.isin(rows.kind, (VEHICLE, UNKNOWN_KIND))
    if is_vehicle.all():
        return ids, actor, []
    part = np.where(is_vehicle, 0, np.where(rows.kind == CONTAINER, CONTAINER, PERSON))
    pairs, code = np.unique(actor.astype(np.int64) * len(KINDS) + part, return_inverse=True)
    id_index, kinds = pairs // len(KINDS), pairs % len(KINDS)
    twice = np.bincount(id_index, minlength=len(ids))[id_index] > 1
    names = [
        f"{KINDS[k]}:{ids[i]}" if is_shared and k else ids[i]
        for i, k, is_shared in zip(id_index, kinds, twice, strict=True)
    ]
    shared = sorted({ids[i] for i in id_index[twice]})
    note = (
        f"persons or containers have the same ids as vehicles ({name_list(shared)}): they are renamed "
        f"{KINDS[PERSON]}:ID or {KINDS[CONTAINER]}:ID"
    )
    return names, code.astype(np.int32), [note] if shared else []


def _recording(path: Path, rows: Rows, types: Mapping[str, VehicleType], options: IngestOptions) -> Recording:
    ids, actor, notes = _actor_ids_indices_and_notes(rows)
    angle = rows.numbers("angle")
    if not np.isfinite(angle).any():
        raise TraceError(
            f"{path}: no heading: no vehicle has an angle, which is needed to place the boxes behind the front bumpers: record the "
            "log with the attribute angle (SUMO's option fcd-output.attributes)"
        )
    names = pc.dictionary_encode(rows.table["type"]).combine_chunks()
    row_actors = RowActors(ids, actor, names.dictionary.to_pylist(), names.indices.to_numpy(), rows.kind)
    boxes = boxes_of(row_actors, types, options)
    xy, findings = positions_in_net_and_findings(path, rows, actor, options.map)
    yaw = wrap_angles(np.pi / 2 - np.radians(angle))
    cos, sin = np.cos(yaw), np.sin(yaw)
    is_vehicle = np.isin(rows.kind, (VEHICLE, UNKNOWN_KIND))
    speed = rows.numbers("speed")
    # in a table, these columns of a person may contain other values
    accel, signals = (np.where(is_vehicle, rows.numbers(name), np.nan) for name in ("acceleration", "signals"))
    numbers = {
        "x_m": xy[:, 0] - boxes.bumper_ahead_m * cos, "y_m": xy[:, 1] - boxes.bumper_ahead_m * sin, "yaw_rad": yaw,
        "vx_mps": speed * cos, "vy_mps": speed * sin, "ax_mps2": accel * cos, "ay_mps2": accel * sin,
        "length_m": boxes.length_m, "width_m": boxes.width_m,
    }  # fmt: skip
    states = States(
        ids,
        actor,
        _times_ns(rows),
        numbers,
        {"actor_class": boxes.actor_class, **_vehicle_light_codes(signals)},
        np.any([pc.is_inf(c).to_numpy() for c in rows.table.columns if pa.types.is_floating(c.type)], axis=0),
    )
    angleless = int(np.isnan(angle).sum())
    if angleless:
        message = (
            f"no angle in {angleless} of {len(angle)} states: their boxes behind the front bumpers cannot be placed"
        )
        findings.append(QualityFinding("no_angle", "warning", message, angleless))
    return Recording("sumo-fcd", states, findings=[*boxes.findings, *findings], notes=notes)


def _vehicle_light_codes(signals: Floats) -> dict[str, Codes]:
    has_signals = (signals >= 0) & (signals < 2**31)
    bits = np.where(has_signals, signals, 0).astype(np.int64)
    indicator = np.full(len(bits), INDICATORS.index("off"), np.int8)
    for bit, word in ((_RIGHT, "right"), (_LEFT, "left"), (_EMERGENCY, "hazard")):
        indicator[bits & bit > 0] = INDICATORS.index(word)
    indicator[(bits & _RIGHT > 0) & (bits & _LEFT > 0)] = INDICATORS.index("hazard")
    brake = np.where(bits & _BRAKE > 0, BRAKE_LIGHTS.index("on"), BRAKE_LIGHTS.index("off")).astype(np.int8)
    return {
        "indicator": np.where(has_signals, indicator, np.int8(-1)),
        "brake_light": np.where(has_signals, brake, np.int8(-1)),
    }
