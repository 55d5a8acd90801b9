"""Writes and reads data of a converted log for which OSI has no field: two MCAP metadata records, and a channel of declared events.

`drivelint.trace`: the source of the log, the map offset and sensor range of its mapping, the projection of its coordinates, the
conditions of the drive, and the findings from reading. `drivelint.actors`: OSI id -> the row of `actor` in JSON, because OSI has only
numbers as ids, fewer classes, and only one ego. The channel has JSON messages `drivelint.DeclaredEvent`.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import msgspec
import numpy as np
import pyarrow as pa

from drivelint.drive import conditions
from drivelint.drive.trace import CHECKS_REPEATED_AT_READING, SIZE_COLUMNS, QualityFinding
from drivelint.errors import TraceError
from drivelint.sql.words import vocabularies

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from pathlib import Path

    from drivelint.drive.trace import Recording, Trace

CONVERTED_LOG_LIBRARY: Final = "drivelint convert"
"""The library in the header of converted logs."""
TRACE_RECORD: Final = "drivelint.trace"
ACTORS_RECORD: Final = "drivelint.actors"
EVENT_MESSAGE: Final = "drivelint.DeclaredEvent"
EGO_DEPENDENT_CHECK_IDS: Final = frozenset({"no_ego", "ego_count", "no_indicator", "no_brake_light"})
"""Checks of findings that depend on the ego. Converted logs omit them; reading finds them again for the chosen ego."""
COORDINATES_OSI_CANNOT_OMIT: Final = ("z_m",)
"""Coordinates that cannot be left out of an OSI vector. The record lists a coordinate that no state has."""


class _ActorRecord(msgspec.Struct, forbid_unknown_fields=True, frozen=True, kw_only=True):
    actor_id: str
    actor_class: str | None = None
    length_m: float | None = None
    width_m: float | None = None
    height_m: float | None = None
    is_ego: bool = False


class _TraceRecord(msgspec.Struct, frozen=True, kw_only=True):
    """The record `drivelint.trace`, with each value as JSON. Unknown keys come from newer versions, and are ignored."""

    map_offset_m: tuple[float, float] | None = None
    geo_reference: str | None = None
    geo_offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    sensor_range_m: float | None = None
    utc_start_ns: int | None = None
    unknown: tuple[str, ...] = ()
    conditions: dict[str, str] = {}
    quality: tuple[QualityFinding, ...] = ()
    as_recorded: bool = False
    nobody_ns: tuple[int, ...] = ()


class Event(msgspec.Struct, forbid_unknown_fields=True, frozen=True, kw_only=True):
    """A declared event: one message of the channel, and one row of `declared_event`."""

    t_ns: int
    actor_id: str
    event: str
    value: str | None = None


# decoders are built at import: building one later in several threads is unsafe, see formats/tables/mapping.py
DECODERS: Final = tuple(msgspec.json.Decoder(kind) for kind in (_ActorRecord, _TraceRecord, Event))
EVENT_SCHEMA: Final = msgspec.json.encode(msgspec.json.schema(Event), order="sorted")


def metadata_records(trace: Trace, osi_ids: Mapping[str, int], *, as_recorded: bool) -> dict[str, dict[str, str]]:
    """Return the metadata records of a trace. `osi_ids`: actor id -> OSI id; `as_recorded`: whether its states are as recorded."""
    log = trace.tables["data_log"].to_pylist()[0]
    states = trace.tables["actor_state"]
    trace_facts: dict[str, Any] = {
        "source": log["file_name"],
        "source_sha256": log["sha256"],
        "source_format": log["format"],
        "quality": ego_independent_quality(trace).drop_columns("drive_id").to_pylist(),
        "unknown": [name for name in COORDINATES_OSI_CANNOT_OMIT if states[name].null_count == states.num_rows],
    }
    holds = {r["condition"]: r["value"] for r in trace.tables["drive_condition"].to_pylist() if r["source"] == "trace"}
    optional = {
        "conditions": holds or None, "map_offset_m": trace.map_offset,
        "sensor_range_m": log["sensor_range_m"], "utc_start_ns": log["utc_start_ns"],
        "geo_reference": trace.geo_reference, "geo_offset": trace.geo_offset if trace.geo_reference else None,
        "as_recorded": as_recorded or None, "nobody_ns": trace.times_without_actors_ns.tolist() or None,
    }  # fmt: skip
    trace_facts |= {name: value for name, value in optional.items() if value is not None}
    actors = trace.tables["actor"].drop_columns("drive_id").to_pylist()
    return {
        TRACE_RECORD: {name: msgspec.json.encode(value).decode() for name, value in trace_facts.items()},
        ACTORS_RECORD: {str(osi_ids[row["actor_id"]]): msgspec.json.encode(row).decode() for row in actors},
    }


def ego_independent_quality(trace: Trace) -> pa.Table:
    """Return the rows of `quality` that do not depend on the ego; converted logs contain them."""
    rows = trace.tables["quality"]
    return rows.filter(
        pa.array([check not in EGO_DEPENDENT_CHECK_IDS for check in rows["check_id"].to_pylist()], pa.bool_())
    )


def apply_metadata(path: Path, metadata: Mapping[str, Mapping[str, str]], recording: Recording) -> None:
    """Add the content of the metadata records to a recording. Errors: `TraceError` if a record is invalid."""
    if TRACE_RECORD in metadata:
        _apply_trace_record(path, _decode_record(path, TRACE_RECORD, metadata[TRACE_RECORD], _TraceRecord), recording)
    if ACTORS_RECORD in metadata:
        rows = {
            number: _decode_record(path, f"{ACTORS_RECORD}, actor {number}", text, _ActorRecord)
            for number, text in metadata[ACTORS_RECORD].items()
        }
        _apply_actor_records(path, rows, recording)


def read_declared_events(path: Path, messages: Sequence[bytes]) -> pa.Table | None:
    """Return declared events as rows; None without messages. Errors: `TraceError` for a message that cannot be read."""
    if not messages:
        return None
    try:
        rows = [msgspec.json.decode(message, type=Event) for message in messages]
    except (msgspec.ValidationError, msgspec.DecodeError) as error:
        raise TraceError(f"{path}: a declared event cannot be read ({error}): convert the log again") from error
    kinds = {"t_ns": pa.int64(), "actor_id": pa.string(), "event": pa.string(), "value": pa.string()}
    return pa.table({name: pa.array([getattr(row, name) for row in rows], kind) for name, kind in kinds.items()})


def parse_conditions(path: Path, rows: Iterable[tuple[str | None, str | None]]) -> dict[str, str]:
    """Return name -> value of the drive's conditions in a log, in drivelint's spelling. `rows`: pairs of name and value.

    Errors: `TraceError` for an unknown name or value, and for contradictions.
    """
    condition_words: dict[str, str] = {}
    for pair in rows:
        if pair[0] is None or pair[1] is None:
            raise TraceError(f"{path}: a condition of the drive lacks its name or its value: give both")
        name, word = conditions.canonical_spelling(pair[0], pair[1])
        if wrong := conditions.condition_problem(name) or conditions.value_problem(name, word):
            raise TraceError(f"{path}: condition of the drive: {wrong}")
        if condition_words.setdefault(name, word) != word:
            raise TraceError(f"{path}: the drive's {name} is both {condition_words[name]!r} and {word!r}: give one")
    return condition_words


def validated_findings(path: Path, findings: Sequence[QualityFinding]) -> list[QualityFinding]:
    """Return the findings that a converted log contains. Errors: `TraceError` for a finding of an unknown check."""
    for finding in findings:
        if wrong := vocabularies()["log_check"].problem(finding.check_id):
            raise TraceError(f"{path}: quality: {wrong}: convert the log again with this version")
    return list(findings)


def _apply_trace_record(path: Path, facts: _TraceRecord, recording: Recording) -> None:
    recording.conditions |= parse_conditions(path, facts.conditions.items())
    if facts.map_offset_m is not None:
        dx, dy = recording.map_offset = facts.map_offset_m
        recording.notes.append(f"the log moves the map by ({dx:+g}, {dy:+g}) m")
    if facts.geo_reference is not None:
        recording.geo_reference, recording.geo_offset = facts.geo_reference, facts.geo_offset
    if facts.utc_start_ns is not None:
        recording.utc_start_ns = facts.utc_start_ns
    recording.sensor_range_m = facts.sensor_range_m
    for name in set(facts.unknown) & set(COORDINATES_OSI_CANNOT_OMIT):
        recording.states.numbers[name] = np.full(len(recording.states), np.nan)
    # only these empty frames were in the original log; the conversion added frames for traffic lights
    recording.frames_ns = np.array(facts.nobody_ns, np.int64)
    findings = [f for f in facts.quality if not facts.as_recorded or f.check_id not in CHECKS_REPEATED_AT_READING]
    recording.findings += validated_findings(path, findings)


def _apply_actor_records(path: Path, rows: Mapping[str, _ActorRecord], recording: Recording) -> None:
    names = [rows[number].actor_id if number in rows else number for number in recording.states.ids]
    if len(set(names)) < len(names) or len({row.actor_id for row in rows.values()}) < len(rows):
        raise TraceError(
            f"{path}: the metadata record {ACTORS_RECORD} gives two actors one name: convert the log again"
        )
    for row in rows.values():
        if row.actor_class is not None and (wrong := vocabularies()["actor_class"].problem(row.actor_class)):
            raise TraceError(f"{path}: the metadata record {ACTORS_RECORD}: {wrong}")
    recording.states.ids = names
    records = sorted(rows.values(), key=lambda row: row.actor_id)
    columns = ("actor_id", "actor_class", *SIZE_COLUMNS, "is_ego")
    recording.actors = pa.table({name: [getattr(row, name) for row in records] for name in columns})
    recording.ego_ids = [row.actor_id for row in records if row.is_ego]


def _decode_record(path: Path, record_name: str, text: Mapping[str, str] | str, kind: type[Any]) -> Any:
    try:
        if isinstance(text, str):
            value = msgspec.json.decode(text, type=kind)
        else:
            value = msgspec.convert({key: msgspec.json.decode(item) for key, item in text.items()}, kind)
    except (msgspec.ValidationError, msgspec.DecodeError) as error:
        raise TraceError(
            f"{path}: the metadata record {record_name} cannot be read ({error}): convert the log again"
        ) from error
    if isinstance(value, _TraceRecord) and not all(map(math.isfinite, value.map_offset_m or ())):
        raise TraceError(
            f"{path}: the metadata record {record_name} has the map offset {value.map_offset_m}: convert the log again"
        )
    return value
