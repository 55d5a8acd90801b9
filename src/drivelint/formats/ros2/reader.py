"""Reads ROS 2 logs in MCAP or SQLite. Messages are recognised by the names of their schemas, not by topics.

Positions are box centres: of Autoware's tracks and of vision_msgs' detections by their definition, of the CARLA bridge's objects by
assumption (see `merge`). The odometry gives the position of its child frame; `--ego-size` states how far ahead of that frame, for example
of the rear axle, the centre of the ego's box lies.
"""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from drivelint.drive.ego import MOST_UNREPORTED_SIZE_DIFFERENCE_M
from drivelint.drive.lost_time import times_of_lost_rows
from drivelint.drive.trace import QualityFinding, Recording, States, single_map_or_finding
from drivelint.errors import TraceError
from drivelint.formats.coordinate_frames import TransformTree, fixed_frame
from drivelint.formats.mcap import bag
from drivelint.formats.mcap.silent import silent_topics_text
from drivelint.formats.ros2 import ego as ros_ego
from drivelint.formats.ros2 import traffic_lights
from drivelint.formats.ros2.ego_frame import drop_unplaced_ends, ego_rows_or_reason
from drivelint.formats.ros2.log import TRAFFIC_LIGHT_MESSAGE_TYPES, Log
from drivelint.formats.ros2.merge import DEFAULT_EGO_ID, FORMAT, SQLITE_FORMAT, merge_ego
from drivelint.formats.ros2.messages import (
    CARLA_OBJECTS,
    CONTROL_MODE,
    EGO_INFO,
    ENGAGE,
    HAZARD_LIGHTS,
    MESSAGE_TYPES,
    ODOMETRY,
    PARAMETER_EVENTS,
    TRANSFORMS,
    TURN_INDICATORS,
    VEHICLE_DIMENSIONS,
    WORLD_INFO,
)
from drivelint.formats.ros2.objects import MESSAGE_TYPES_OF_SAME_OBJECTS, OBJECT_CONVERTERS, stamps
from drivelint.formats.ros2.recorded_poses import (
    RecordedPoses,
    distinct_values,
    frame_times_and_start,
    join_batches,
    set_times_and_return_are_own_times,
    states_in_fixed_frame,
)
from drivelint.formats.ros2.types import message_kind
from drivelint.formats.ros2.vehicle import is_axle_frame, vehicle_box
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    from drivelint.arrays import Times
    from drivelint.drive.trace import IngestOptions
    from drivelint.formats.ros2.cdr import Table
    from drivelint.formats.ros2.vehicle import VehicleBox

STATIC_TOPIC_SUFFIX = "tf_static"
"""The end of the topic name of static transforms; the messages themselves do not show that they are static."""
TOPICS_APART_NS = 1_000_000_000
"""A recorder subscribes to topics one after another, so their recordings may begin and end a second apart."""
_VALUE_FIELD_BY_REPORT = {TURN_INDICATORS: "report", HAZARD_LIGHTS: "report", CONTROL_MODE: "mode", ENGAGE: "engage"}
"""Message type of a report about the ego -> the field with its value."""


def read(path: Path, options: IngestOptions) -> Recording:
    """Read a file or a bag. Errors: `TraceError` if it is damaged, has no usable poses, or has several topics without a choice."""
    requested_topics = [] if options.topic is None else [part.strip() for part in options.topic.split(",")]
    log = Log(path, requested_topics)
    log.read(bag.bag_files(path))
    log.refuse_unread_topics()
    objects = log.select_topic(OBJECT_CONVERTERS, "road users")
    log.unread.refuse_kinds(path, OBJECT_CONVERTERS, objects or log.topics.get(ODOMETRY, ()))
    parts = {topic: join_batches(batches) for topic, batches in objects.items()}
    odometry, is_centre = _ego_poses_by_topic_and_has_centre(log, options)
    parts |= odometry
    if not sum(map(len, parts.values())):
        raise _nothing_to_read_error(path, log)
    findings = log.findings
    findings += bag.lone_part_findings(path)
    findings += [] if objects else [_no_road_users_finding(log)]
    own_times = set_times_and_return_are_own_times(parts, findings)
    frames = _transform_tree(log, own_times=own_times)
    for topic in objects:
        parts[topic] = _drop_rows_without_ids(parts[topic], topic, log)
        findings += _polygon_findings(parts[topic], topic)
    used = [sorted(distinct_values(parts[topic].frames)[0]) for topic in (*odometry, *objects)]
    fixed = fixed_frame(frames, chain.from_iterable(used))
    if log.ego_frame:
        parts |= {topic: drop_unplaced_ends(parts[topic], frames, fixed, TOPICS_APART_NS) for topic in odometry}
    states: dict[str, States] = {}
    for topic in (*objects, *odometry):
        states[topic], new_findings = states_in_fixed_frame(parts[topic], frames, fixed, topic)
        findings += new_findings
    if not any(np.isfinite(part.numbers["x_m"]).any() for part in states.values()):
        raise TraceError(f"{path}: nothing can be placed: {findings[-1].message if findings else 'no positions'}")
    object_states, odometry_states = (
        next(((topic, states[topic]) for topic in source if len(states[topic])), None) for source in (objects, odometry)
    )
    is_carla = log.has_carla_messages and not objects.keys().isdisjoint(log.topics.get(CARLA_OBJECTS, ()))
    # topic of the CARLA bridge's ego info -> the ego's id in its last message
    ego_ids_by_topic = {
        topic: str(number) for topic, (table, _) in log.batches(EGO_INFO) for number in table.column("id").tolist()
    }
    ego_id = options.ego if log.ego_frame and options.ego == log.ego_frame else DEFAULT_EGO_ID
    recording = merge_ego(
        object_states,
        odometry_states,
        ego_ids_by_topic,
        findings,
        is_carla=is_carla,
        is_centre=is_centre,
        ego_id=ego_id,
    )
    recording.format = SQLITE_FORMAT if log.is_sqlite else FORMAT
    reports = _ego_reports(log, own_times=own_times)
    for ego in recording.ego_ids[:1]:
        all_states = recording.states
        if ego in all_states.ids and reports.keys() & {TURN_INDICATORS, HAZARD_LIGHTS}:
            of_ego = all_states.actor == all_states.ids.index(ego)
            all_states.codes["indicator"] = np.full(len(all_states), -1, np.int8)
            all_states.codes["indicator"][of_ego] = ros_ego.indicator_codes(all_states.t_ns[of_ego], reports)
        recording.events = ros_ego.engagement_events(reports, ego)
    _add_signals(recording, log, own_times=own_times)
    recording.lost_times = [*log.lost_times, *log.silences(objects, odometry)]
    recording.frames_ns, recording.ends_apart_ns = log.times_of_topics(parts, own_times=own_times), TOPICS_APART_NS
    recording.embedded_map, trouble = single_map_or_finding(_topic_by_map(log))
    recording.findings += trouble
    recording.frame_times, recording.utc_start_ns = frame_times_and_start(list(parts.values()))
    recording.fixed_frame = fixed
    recording.why_no_ego = log.why_no_ego and f"no {ODOMETRY}, and {log.why_no_ego}"
    recording.notes += [*log.notes, *_missing_ego_notes(log), f"positions are in the frame {fixed!r}"]
    return recording


def _add_signals(recording: Recording, log: Log, *, own_times: bool) -> None:
    """Add the states of the traffic lights, if the log has them."""
    for topic, batches in log.select_topic(TRAFFIC_LIGHT_MESSAGE_TYPES, "traffic lights").items():
        t_ns = recording.states.t_ns
        span_ns = int(t_ns.min()), int(t_ns.max())
        recording.signals, new_findings = traffic_lights.signal_states(batches, span_ns, topic, own_times=own_times)
        recording.findings += new_findings


def _transform_tree(log: Log, *, own_times: bool) -> TransformTree:
    frames = TransformTree()
    for topic, (table, log_ns) in _transforms(log):
        static = topic.endswith(STATIC_TOPIC_SUFFIX)
        ros_ego.add_transforms(frames, table, log_ns, static=static, own_times=own_times)
    return frames


def _transforms(log: Log) -> Iterator[tuple[str, tuple[Table, Times]]]:
    """Yield topic, transforms and log times of each batch; of the topics that are not static, those that the user chose, if any."""
    moving = {topic for topic in log.topics.get(TRANSFORMS, ()) if not topic.endswith(STATIC_TOPIC_SUFFIX)}
    left = moving.difference(log.requested_topics) if moving.intersection(log.requested_topics) else ()
    yield from ((topic, batch) for topic, batch in log.batches(TRANSFORMS) if topic not in left)


def _nothing_to_read_error(path: Path, log: Log) -> TraceError:
    """Return the error for a log without poses of road users or of the ego."""
    silent = silent_topics_text(bag.bag_files(path), lambda name: message_kind(name) in {*OBJECT_CONVERTERS, ODOMETRY})
    if silent or log.n_detections or not log.topics.keys().isdisjoint(OBJECT_CONVERTERS):
        why = silent or f"{', '.join(sorted(OBJECT_CONVERTERS))} are read"
        return TraceError(f"{path}: no road users and no odometry in this ROS log: {why}")
    return TraceError(f"{path}: no {ODOMETRY} and no road users: {bag.topics_text(path)}; {log.why_no_ego}")


def _missing_ego_notes(log: Log) -> list[str]:
    """Return a note if a bag of Autoware's road users has neither odometry nor transforms of its own vehicle."""
    if not log.why_no_ego or log.topics.keys().isdisjoint(MESSAGE_TYPES_OF_SAME_OBJECTS):
        return []
    note = (
        f"no {ODOMETRY}, and {log.why_no_ego}: the vehicle that recorded the bag is not among the actors: "
        f"record {MESSAGE_TYPES[ODOMETRY].topic} too"
    )
    return [note]


def _topic_by_map(log: Log) -> dict[bytes, str]:
    """Return the distinct OpenDRIVE maps of a log, each with the first topic that has it."""
    maps: dict[bytes, str] = {}
    for topic, (table, _) in log.batches(WORLD_INFO):
        for text in filter(bytes.strip, table.column("opendrive").tolist()):
            maps.setdefault(text, topic)
    return maps


def _ego_poses_by_topic_and_has_centre(log: Log, options: IngestOptions) -> tuple[dict[str, RecordedPoses], bool]:
    """Return the ego's rows by topic, and whether their positions are known to be box centres.

    In the axle's frame, the log's own vehicle box gives the centre, if there is one; otherwise the option `ego_size` does.
    """
    box, box_findings = vehicle_box(
        (table for _, (table, _) in log.batches(PARAMETER_EVENTS)),
        ((topic, table) for topic, (table, _) in log.batches(VEHICLE_DIMENSIONS)),
    )
    log.findings += box_findings
    ahead_m = 0.0 if options.ego_size is None else options.ego_size.forward_m
    rows: dict[str, RecordedPoses] = {}
    has_box_centre = False
    odometry = log.select_topic([ODOMETRY], "odometry")
    for topic, batches in odometry.items():
        rows[topic] = join_batches([ros_ego.odometry_poses(table, log_ns, box, ahead_m) for table, log_ns in batches])
        if box is not None and all(is_axle_frame(table.column("child_frame_id")).all() for table, _ in batches):
            log.findings += _centre_mismatch_findings(box, ahead_m)
            has_box_centre = True
    if not odometry:
        rows, has_box_centre = _ego_poses_by_transforms_and_has_centre(log, box, ahead_m, options.ego)
    if box is not None and rows:
        size = "{:.2f} m by {:.2f} m; its centre in the ego's frame is not stated".format(*box.size)
        log.notes.append(f"the ego's box is taken from {box.source}: {box.text() if has_box_centre else size}")
    return rows, has_box_centre or ahead_m != 0.0


def _ego_poses_by_transforms_and_has_centre(
    log: Log, box: VehicleBox | None, ahead_m: float, ego_name: str | None
) -> tuple[dict[str, RecordedPoses], bool]:
    """Return the ego's rows by the transforms of its frame, if a chain leads to it, and whether the box gave their centres."""
    ego_rows = ego_rows_or_reason(_transforms(log), box, ahead_m, STATIC_TOPIC_SUFFIX, ego_name)
    if isinstance(ego_rows, str):
        log.why_no_ego = "; ".join([ego_rows, *log.undefined_ego.texts()])
        return {}, False
    log.notes.append(f"no {ODOMETRY}: the ego is placed by the transforms of {ego_rows.frame!r} on {ego_rows.topic}")
    log.add_times(ego_rows.topic, ego_rows.rows)
    log.ego_frame = ego_rows.frame
    return {ego_rows.topic: ego_rows.rows}, ego_rows.has_box_centre


def _centre_mismatch_findings(box: VehicleBox, ahead_m: float) -> list[QualityFinding]:
    centre_m = box.centre[0]
    if ahead_m == 0.0 or abs(ahead_m - centre_m) <= MOST_UNREPORTED_SIZE_DIFFERENCE_M:
        return []
    message = (
        f"--ego-size puts the centre of the ego's box {ahead_m:g} m ahead of base_link, but the log states "
        f"{centre_m:g} m: the value of the log is used"
    )
    return [QualityFinding("ego_size", "warning", message)]


def _no_road_users_finding(log: Log) -> QualityFinding:
    """Return the finding that no other actor is known. Detections without ids do not count, because they cannot be linked to tracks."""
    n = sum(log.n_detections.values())
    cause = "no topic of this log has road users"
    if n:
        cause = (
            f"the only road users of this log, on {name_list(sorted(log.n_detections))}, are detections without ids, which form no tracks: "
            f"record {' or '.join(MESSAGE_TYPES_OF_SAME_OBJECTS)} too"
        )
    else:
        cause += (
            ", of the types that are read (drivelint docs mapping shows how messages of other types become a table)"
        )
    message = f"{cause}: rules about other actors are unknown"
    return QualityFinding("no_road_users", "warning", message, max(n, 1))


def _polygon_findings(rows: RecordedPoses, topic: str) -> list[QualityFinding]:
    if rows.outlined is None or not rows.outlined.any():
        return []
    n = int(rows.outlined.sum())
    message = f"{topic}: the shape is a polygon in {n} of {len(rows)} states: the box around the polygon is used, which is larger"
    return [QualityFinding("polygon_box", "info", message, n, int(rows.t_ns[rows.outlined].min()))]


def _drop_rows_without_ids(rows: RecordedPoses, topic: str, log: Log) -> RecordedPoses:
    nameless = rows.ids == b"" if rows.ids.dtype.kind == "S" else np.zeros(len(rows), np.bool_)
    if not nameless.any():
        return rows
    n = int(nameless.sum())
    cause = f"{topic}: objects without an id"
    finding = QualityFinding(
        "dropped_row", "error", f"{cause}: {n}: they are not judged", n, int(rows.t_ns[nameless].min())
    )
    log.findings.append(finding)
    log.lost_times += times_of_lost_rows(rows.log_ns, np.ones(len(rows), np.bool_), nameless, cause)
    return rows.take(~nameless)


def _ego_reports(log: Log, *, own_times: bool) -> dict[str, tuple[Times, NDArray[Any]]]:
    reports = {}
    for kind, column in _VALUE_FIELD_BY_REPORT.items():
        for parts in log.select_topic([kind], kind.split("/")[1]).values():
            t_ns = [stamps(table, "stamp")[0] if own_times else log_ns for table, log_ns in parts]
            values = [table.column(column) for table, _ in parts]
            reports[kind] = (np.concatenate(t_ns), np.concatenate(values))
    return reports
