"""Turns the recording of a reader into the tables of `schemas/model.sql`: sorts, completes and checks it, and chooses the egos."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa

from drivelint.arrays import words_of_codes, wrap_angles
from drivelint.drive import absence, checks, contradiction, ego, jumps
from drivelint.drive import actors as actor_rows
from drivelint.drive.align import align_to_ego_steps
from drivelint.drive.clock_restart import without_values_at_restarts
from drivelint.drive.declared_events import with_headlight_events
from drivelint.drive.implausible.bodies import (
    false_track_start_findings,
    repeated_end_position_findings,
    same_body_findings,
)
from drivelint.drive.implausible.motion import implausible_motion_findings
from drivelint.drive.lost_time import LATEST_CREDIBLE_NS, lost_time_findings
from drivelint.drive.motion import complete_velocities
from drivelint.drive.order import UNKNOWN_CODE, sorted_states, steps, without_duplicates
from drivelint.drive.outlines.contact import outline_contact_findings
from drivelint.drive.trace import (
    ASSUMED_MOTION_CHECK,
    BRAKE_LIGHTS,
    EARLIEST_UTC_NS,
    INDICATORS,
    SIZE_COLUMNS,
    STATE_COLUMNS,
    Doubt,
    QualityFinding,
    Trace,
)
from drivelint.errors import TraceError
from drivelint.phrases import name_list
from drivelint.sql.store import arrow_schemas, table_with_owner_id

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.arrays import Floats, Mask
    from drivelint.drive.order import Steps
    from drivelint.drive.trace import Identity, IngestOptions, Recording, States

LONGEST_ID_CHARACTERS = 1000
"""The most characters of an actor's id: every finding about the actor repeats it."""
TRACE_TABLES = (
    "data_log", "actor", "actor_state", "signal_state", "declared_event", "drive_condition", "quality", "doubt",
)  # fmt: skip
"""The tables of `schemas/model.sql` that a trace has, in the order of that file."""


# NaN stands for an unknown value, and arithmetic with NaN gives NaN
@np.errstate(invalid="ignore", divide="ignore", over="ignore")
def finish_trace(path: Path, identity: Identity, recording: Recording, options: IngestOptions) -> Trace:
    """Sort, complete and check a recording, and return it as a trace. Errors: `TraceError` if nothing can be judged."""
    _refuse_log_without_drive(path, recording.states)
    pa.default_memory_pool().release_unused()  # Arrow would keep the memory of the reader's tables
    lost_findings = lost_time_findings(recording.lost_times, recording.frame_times, recording.states.t_ns)
    ego_option = absence.effective_ego_option(recording, options.ego)
    missed, picked = absence.absences(recording, ego_option), absence.ego_choice_findings(recording, ego_option)
    nobody_ns = absence.frame_times_without_states(recording, missed)
    as_read = recording.hand_over_states()
    states, restarts = without_values_at_restarts(as_read)
    states = sorted_states(states)
    # nothing below changes an array in place; only the log's own order shows where its clock restarts
    recorded = None if not options.as_recorded else as_read if restarts else states.copy()
    del as_read
    states, repeated = without_duplicates(states)
    recorded_findings = recording.findings if ego_option is None else absence.without_ego_choices(recording.findings)
    findings = [*recorded_findings, *picked, *lost_findings, *restarts, *repeated]
    assumed = any(f.check_id == ASSUMED_MOTION_CHECK for f in recording.findings)
    states, step, split_tracks, jumped = _split_at_jumps(
        states, recording.ego_ids if ego_option is None else [ego_option], is_motion_assumed=assumed
    )
    findings += jumped
    # assumed velocities are kept; if most velocities of a mapped table are wrong, the user must correct its mapping
    most_replaced = 0.0 if assumed else 0.5 if recording.strict_units else 1.0
    findings += complete_velocities(states, step, most_replaced_share=most_replaced)
    derived = any(f.check_id == "velocity_derived" and f.n == len(states) for f in findings)
    if recording.actors is None:
        actors, varying = actor_rows.from_states(states)
        findings += varying
    else:
        actors = actor_rows.from_table(recording.actors, states, split_tracks.old_id_by_id)
    egos, choice_findings = ego.choose_egos(
        path, actors, ego_option, recording.ego_ids, ego_required=options.need_ego, why=recording.why_no_ego
    )
    findings += [*choice_findings, *ego.fill_sizes(actors, egos, options.ego_size)]
    findings += actor_rows.correct_sizes(states, actors)
    check_findings = checks.quality_findings(states, step, actors, derived_velocities=derived)
    _refuse_wrong_units(path, recording, check_findings)
    findings += check_findings
    if not assumed:
        findings += contradiction.remove_contradictions(
            states, step, actors, derived_velocities=derived, split_tracks=split_tracks
        )
        findings += implausible_motion_findings(states, step, actors, derived_velocities=derived)
        findings += [
            *same_body_findings(states, actors, egos),
            *false_track_start_findings(states, step),
            *repeated_end_position_findings(states, actors),
        ]
    findings += outline_contact_findings(states, step, actors, egos, recording.outlines)
    findings += _unknown_ego_light_findings(states, egos)
    missed = [absence for absence in missed if absence.ego_id in egos]
    states = absence.with_unknown_ego_states(states, missed, recording.frames_ns)
    findings += absence.absence_findings(missed, states)
    states, alignment_findings = align_to_ego_steps(states, egos)
    states = states if recorded is None else recorded.with_all_columns()
    tables = _trace_tables(identity, recording, options, states=states, actors=actors, egos=egos)
    tables["quality"] = _quality_table(identity.drive_id, [*findings, *alignment_findings], recording.format)
    tables["doubt"] = _doubt_table(identity.drive_id, findings, recording.format)
    return Trace(
        identity.drive_id,
        path,
        tables,
        recording.embedded_map,
        recording.map_offset,
        recording.notes,
        recording.frame_times,
        recording.geo_reference,
        recording.geo_offset,
        nobody_ns,
        in_log_order=recorded is not None and bool(restarts),
        fixed_frame=recording.fixed_frame,
    )


def _split_at_jumps(
    states: States, named_egos: list[str], *, is_motion_assumed: bool
) -> tuple[States, Steps, jumps.SplitTracks, list[QualityFinding]]:
    """Split the tracks at jumps, except those of named egos; return the states, their steps, the split and findings."""
    step, split_tracks, findings = steps(states), jumps.NO_SPLIT, []
    if not is_motion_assumed:
        states, cut_findings = jumps.cut_tracks_of_destroyed_actors(states, step, kept_ids=named_egos)
        step = steps(states) if cut_findings else step
        split_tracks = jumps.split_tracks(states, step, kept_ids=named_egos)
        findings = [*cut_findings, *split_tracks.findings]
    if split_tracks.old_id_by_id:
        states = sorted_states(states)
        step = steps(states)
    if "yaw_rad" in states.numbers:
        states.numbers["yaw_rad"] = wrap_angles(states.numbers["yaw_rad"])
    return states, step, split_tracks, findings


def _trace_tables(
    identity: Identity,
    recording: Recording,
    options: IngestOptions,
    *,
    states: States,
    actors: actor_rows.Actors,
    egos: list[str],
) -> dict[str, pa.Table]:
    """Return the tables of a trace except `quality` and `doubt`."""
    is_ego = _rows_of_egos(states, egos)
    unknown = np.full(len(states), UNKNOWN_CODE)
    user_conditions = dict(options.conditions)  # conditions of the user override those of the log
    content: dict[str, list[dict[str, Any]] | dict[str, Any]] = {
        "data_log": [_log_row(identity, recording, states, is_ego, options)],
        "actor": {
            "actor_id": actors.ids,
            "actor_class": actors.classes,
            **{name: _array_with_nulls(actors.sizes[name]) for name in SIZE_COLUMNS},
            "is_ego": [name in egos for name in actors.ids],
        },
        "actor_state": {
            "actor_id": words_of_codes(states.actor, states.ids),
            "t_ns": states.t_ns,
            **{name: _array_with_nulls(states.numbers[name]) for name in STATE_COLUMNS},
            "indicator": words_of_codes(states.codes.get("indicator", unknown), INDICATORS),
            "brake_light": words_of_codes(states.codes.get("brake_light", unknown), BRAKE_LIGHTS),
        },
        "signal_state": _columns_without_repeated_rows(recording.signals, "signal_id", "t_ns", "state"),
        "declared_event": _columns_without_repeated_rows(
            with_headlight_events(recording.events, states), "t_ns", "actor_id", "event", "value"
        ),
        "drive_condition": [
            {"condition": name, "value": value, "source": "env" if name in user_conditions else "trace"}
            for name, value in sorted({**recording.conditions, **user_conditions}.items())
        ],
    }
    return {
        name: table_with_owner_id(name, identity.drive_id, rows, recording.format) for name, rows in content.items()
    }


def with_quality_finding(trace: Trace, finding: QualityFinding) -> Trace:
    """Return the trace with one more row in `quality`."""
    reader = trace.tables["data_log"]["format"][0].as_py()
    rows = pa.concat_tables([trace.tables["quality"], _quality_table(trace.drive_id, [finding], reader)])
    ordered = rows.sort_by([(name, "ascending") for name in ("check_id", "actor_id", "t_first_ns", "message")])
    return replace(trace, tables={**trace.tables, "quality": ordered})


def with_drive_condition_from_map(trace: Trace, condition: str, word: str | None) -> Trace:
    """Return the trace with the map's word for this condition of the drive, if neither the user nor the log states the condition."""
    rows = trace.tables["drive_condition"]
    if word is None or condition in rows["condition"].to_pylist():
        return trace
    row = {"condition": condition, "value": word, "source": "map"}
    rows = pa.concat_tables(
        [rows, table_with_owner_id("drive_condition", trace.drive_id, [row], "of the map")]
    ).sort_by("condition")
    return replace(trace, tables={**trace.tables, "drive_condition": rows})


def _refuse_log_without_drive(path: Path, states: States) -> None:
    """Raise `TraceError` if the log has no states, or if an id or a time shows that it is not a drive."""
    if not len(states):
        raise TraceError(f"{path}: no actor states in this log: nothing can be judged")
    longest = max(states.ids, key=len)
    if len(longest) > LONGEST_ID_CHARACTERS:
        raise TraceError(
            f"{path}: an actor's id of {len(longest)} characters, which begins {longest[:40]!r}: the log is damaged, or the ids are "
            "in another column"
        )
    first, last = int(states.t_ns.min()), int(states.t_ns.max())
    if max(-first, last) > LATEST_CREDIBLE_NS:
        raise TraceError(
            f"{path}: states from {first / 1e9:.6g} s to {last / 1e9:.6g} s: the clock or its unit is wrong"
        )


def _refuse_wrong_units(path: Path, recording: Recording, findings: list[QualityFinding]) -> None:
    """Raise `TraceError` if positions, headings and velocities do not have the same units and frame."""
    remedy = (
        "correct the mapping's units or frame"
        if recording.strict_units
        else "record or convert it again with the units and frame of its format"
    )
    if errors := [finding for finding in findings if finding.severity == "error"]:
        raise TraceError(f"{path}: {errors[0].message}: {remedy}")


def _rows_of_egos(states: States, egos: list[str]) -> Mask:
    return np.isin(np.arange(len(states.ids)), [i for i, name in enumerate(states.ids) if name in egos])[states.actor]


def _unknown_ego_light_findings(states: States, egos: list[str]) -> list[QualityFinding]:
    is_ego = _rows_of_egos(states, egos)
    findings = []
    for column, light_name in (("indicator", "indicator"), ("brake_light", "brake light")):
        codes = states.codes.get(column)
        unknown = is_ego & (codes < 0) if codes is not None else is_ego
        n, of = int(unknown.sum()), int(is_ego.sum())
        if n == 0:
            continue
        message = f"the {light_name} of the ego ({name_list(egos)}) is unknown in {n} of {of} states: rules that need it are unknown"
        only = egos[0] if len(egos) == 1 else None
        findings.append(QualityFinding(f"no_{column}", "info", message, n, int(states.t_ns[unknown].min()), only))
    return findings


def _log_row(
    identity: Identity, recording: Recording, states: States, is_ego: Mask, options: IngestOptions
) -> dict[str, Any]:
    start = int(states.t_ns.min())
    offset = recording.map_offset or (None, None)
    has_lights = {
        c: c in states.codes and bool((states.codes[c][is_ego] >= 0).any()) for c in ("indicator", "brake_light")
    }
    return {
        **dict.fromkeys(arrow_schemas()["data_log"].names),
        "file_name": identity.file_name, "sha256": identity.sha256, "format": recording.format, "n_states": len(states),
        "t_start_ns": start, "t_end_ns": int(states.t_ns.max()),
        "utc_start_ns": start if start >= EARLIEST_UTC_NS else recording.utc_start_ns,
        "sensor_range_m": recording.sensor_range_m if options.sensor_range_m is None else options.sensor_range_m,
        "map_offset_x_m": offset[0], "map_offset_y_m": offset[1],
        "has_indicator": has_lights["indicator"], "names_indicator": recording.names_indicator,
        "has_brake_light": has_lights["brake_light"],
        "has_acceleration": not bool(np.isnan(states.numbers["ax_mps2"][is_ego]).all()),
        "in_sight": options.in_sight,
    }  # fmt: skip


def _columns_without_repeated_rows(rows: pa.Table | None, *keys: str) -> dict[str, Any]:
    """Return these columns of a reader's table, without repeated rows, sorted by the columns in the given order."""
    if rows is None:
        return dict.fromkeys(keys, ())
    distinct = rows.select(keys).group_by(list(keys), use_threads=False).aggregate([])
    return dict(zip(keys, distinct.sort_by([(key, "ascending") for key in keys]).select(keys).columns, strict=True))


def _quality_table(drive_id: str, findings: list[QualityFinding], reader: str) -> pa.Table:
    # a converted log contains findings of the first reading, which the checks may find again
    rows = sorted(dict.fromkeys(findings), key=lambda f: (f.check_id, f.actor_id or "", f.t_first_ns or 0, f.message))
    names = [name for name in arrow_schemas()["quality"].names if name != "drive_id"]
    return table_with_owner_id(
        "quality", drive_id, [{name: getattr(row, name) for name in names} for row in rows], reader
    )


def _doubt_table(drive_id: str, findings: list[QualityFinding], reader: str) -> pa.Table:
    rows = sorted({(*doubt, finding.check_id) for finding in findings for doubt in finding.doubts})
    names = (*Doubt._fields, "code")
    return table_with_owner_id("doubt", drive_id, [dict(zip(names, row, strict=True)) for row in rows], reader)


def _array_with_nulls(values: Floats) -> pa.Array:
    return pa.array(values, from_pandas=True)
