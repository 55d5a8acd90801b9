"""Writes one annotated log: a copy of the log, if it is an undamaged bag or MCAP file, with scenes, verdicts and evidence added."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import count
from typing import TYPE_CHECKING, BinaryIO, Final

import duckdb
import numpy as np

from drivelint import __version__
from drivelint.annotate import (
    actor_boxes,
    clock,
    danger_spaces,
    draw,
    finding_markers,
    measures,
    places,
    result_messages,
)
from drivelint.annotate.tracks import tracks as tracks_of
from drivelint.drive.lost_time import LOST_TIME_CHECK
from drivelint.errors import ChangedLogError
from drivelint.formats.files import identify
from drivelint.formats.foxglove import messages as foxglove
from drivelint.formats.mcap.copy import copy_log, is_message_log
from drivelint.formats.mcap.writer import Sink
from drivelint.formats.sqlite_bag.database import is_sqlite
from drivelint.report import summary
from drivelint.result.schemas import OUTPUT_VERSION

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    import pyarrow as pa
    from mcap.records import Schema

    from drivelint.annotate.actor_boxes import RecordChunk
    from drivelint.annotate.result_messages import Message
    from drivelint.annotate.road import Road
    from drivelint.drive.trace import Trace
    from drivelint.result.model import Result
    from drivelint.road.geo_reference import GeoFrame

CHUNK_BYTES: Final = 1 << 20
_TRANSFORM_SCHEMAS: Final = ("FrameTransform", "FrameTransforms", "TFMessage", "tfMessage", "TransformStamped")


@dataclass(frozen=True)
class DriveToAnnotate:
    """The results of one drive that are written into its annotated log.

    `result` is the result as if the drive had been checked alone. `spaces` are the danger spaces in overtakes, `chains` the lane chains
    along which they lie. `measures` and `margins` are rows of `evidence/first_ego_measures.sql` and of `evidence/least_margin.sql`.
    `road` is None without a map. `geo` is None if neither log nor map has a usable geographic reference.
    """

    trace: Trace
    result: Result
    spaces: pa.Table
    chains: pa.Table
    measures: pa.Table
    margins: pa.Table
    road: Road | None
    geo: GeoFrame | None


def write_log(file: BinaryIO, drive: DriveToAnnotate) -> None:
    """Write the annotated log of one drive; messages of a damaged log are not copied. The same inputs give the same bytes.

    Errors: `TraceError` if the log cannot be copied.
    """
    sink = Sink(file)
    log = drive.trace.tables["data_log"].to_pylist()[0]
    if is_message_log(drive.trace.path) and not _is_damaged(drive.trace):
        path, sha256 = drive.trace.path, log["sha256"]
        copy_log(path, sha256, sink)
        if (path.is_dir() or is_sqlite(path)) and identify(path).sha256 != sha256:
            raise ChangedLogError(f"{path}: the log changed while it was judged: check it again when it is complete")
    else:
        sink.begin(f"drivelint {__version__}")
    _ChannelWriter(sink, drive, int(log["t_start_ns"])).write_all()
    sink.finish()


def _is_damaged(trace: Trace) -> bool:
    """Return whether the log lacks an end or has unreadable records, so that it cannot be copied."""
    return not {LOST_TIME_CHECK, "no_footer"}.isdisjoint(trace.tables["quality"]["check_id"].to_pylist())


class _ChannelWriter:
    """Adds the channels of one drive to a sink, which contains a copy of the log or nothing yet."""

    def __init__(self, sink: Sink, drive: DriveToAnnotate, t_start_ns: int) -> None:
        self._sink = sink
        self._drive = drive
        self._start_ns = t_start_ns
        self._tracks = tracks_of(drive.trace.tables)
        self._rules = drive.result.rules.to_pylist()
        self._sense_by_rule = {rule["rule_id"]: rule["sense"] for rule in self._rules}
        frames = drive.trace.frame_times
        self._clock = clock.of_frames(*frames) if frames else clock.of_trace(t_start_ns)
        self._prefix = _unused_topic_prefix({channel.topic for channel in sink.channels.values()})
        self._has_transforms = any(
            sink.schemas[channel.schema_id].name.endswith(_TRANSFORM_SCHEMAS)
            and not channel.topic.endswith("tf_static")
            for channel in sink.channels.values()
            if channel.schema_id in sink.schemas
        )

    def write_all(self) -> None:
        """Write every channel, then the metadata and the attachment."""
        drive, tracks, times, start = self._drive, self._tracks, self._clock, self._start_ns
        verdicts, findings, senses = drive.result.verdicts, drive.result.findings, self._sense_by_rule
        boxes, every = actor_boxes.box_rows_and_step_interval(tracks)
        scene = foxglove.schema("SceneUpdate")
        if drive.road is not None and len(boxes):
            at = times.log_time_at(start)
            lanes = drive.road.lanes_near(tracks.x[boxes], tracks.y[boxes], at)
            self._write_messages("map", scene, [result_messages.Message(at, lanes)])
        self._write_chunks(
            "scene", scene, lambda channel: actor_boxes.scene_update_chunks(tracks, boxes, times, channel)
        )
        fixed = drive.trace.fixed_frame
        if fixed not in {"", draw.MAP_FRAME, actor_boxes.EGO_FRAME}:  # else a viewer could not place the drawings
            at = times.log_time_at(start)
            link = result_messages.Message(at, actor_boxes.map_transform(fixed, at))
            self._write_messages("tf_map", foxglove.schema("FrameTransform"), [link])
        if not self._has_transforms:  # no moving transforms are added to a log that has its own
            transform = foxglove.schema("FrameTransform")
            self._write_chunks(
                "tf", transform, lambda channel: actor_boxes.ego_transform_chunks(tracks, boxes, times, channel)
            )
        self._write_messages("danger_spaces", scene, danger_spaces.messages(drive.spaces, drive.chains, tracks, times))
        markers = finding_markers.markers(verdicts, findings, senses)
        self._write_messages("markers", scene, finding_markers.messages(markers, tracks, times))
        verdict_messages = result_messages.verdict_messages(verdicts, times, start)
        self._write_messages("verdicts", result_messages.message_schema("verdict"), verdict_messages)
        self._write_messages(
            "findings", result_messages.message_schema("finding"), result_messages.finding_messages(findings, times)
        )
        self._write_messages(
            "events", foxglove.schema("Event"), result_messages.event_messages(findings, times, senses)
        )
        log_messages = result_messages.foxglove_log_messages(verdicts, findings, times, start, senses)
        self._write_messages("log", foxglove.schema("Log"), log_messages)
        self._write_messages(
            "measures", result_messages.message_schema("measures"), measures.measure_messages(drive.measures, times)
        )
        for rule, margins in measures.margin_messages(drive.margins, times).items():
            self._write_messages(measures.margin_topic(rule), result_messages.message_schema("margin"), margins)
        if drive.geo:
            self._write_geographic_channels(drive.geo)
        self._sink.add_metadata("drivelint", self._metadata(every))
        content = summary.render(drive.result)
        self._sink.add_attachment("summary.json", "application/json", content, times.log_time_at(start))

    def _write_geographic_channels(self, geo: GeoFrame) -> None:
        fixes = places.location_messages(
            self._tracks, geo, self._clock, "" if self._has_transforms else actor_boxes.EGO_FRAME
        )
        self._write_messages("location", foxglove.schema("LocationFix"), fixes)
        findings, road = self._drive.result.findings, self._drive.road
        layer = places.geojson_message(findings, self._tracks, geo, road, self._sense_by_rule)
        at = self._clock.log_time_at(self._start_ns)
        self._write_messages("geojson", foxglove.schema("GeoJSON"), [result_messages.Message(at, layer)])

    def _write_chunks(self, topic: str, schema: Schema, chunks: Callable[[int], Iterable[RecordChunk]]) -> None:
        channel = self._sink.add_channel(f"{self._prefix}/{topic}", "protobuf", schema)
        for records, index in chunks(channel):
            self._sink.add_chunk(records, {channel: index})

    def _write_messages(self, topic: str, schema: Schema, messages: list[Message]) -> None:
        encoding = "json" if schema.encoding == "jsonschema" else "protobuf"
        channel = self._sink.add_channel(f"{self._prefix}/{topic}", encoding, schema)
        for first, group in _message_groups_with_first_number(messages):
            size = np.array([len(m.data) for m in group])
            log_time = np.array([m.log_time for m in group], np.uint64)
            heads = actor_boxes.message_headers(channel, log_time, size, first)
            records = b"".join(part for head, m in zip(heads, group, strict=True) for part in (head.tobytes(), m.data))
            place = np.cumsum(size + heads.shape[1]) - size - heads.shape[1]
            self._sink.add_chunk(records, {channel: np.stack([log_time, place.astype(np.uint64)], axis=1)})

    def _metadata(self, step_interval: int) -> dict[str, str]:
        """Return the basis of the verdicts: tool, log, map, rules with their versions."""
        row = self._drive.result.drives.to_pylist()[0]
        columns = (
            "drive_id", "file_name", "sha256", "format", "environment_id", "map_name", "map_sha256", "handedness",
            "handedness_source",
        )  # fmt: skip
        shift = self._clock.shift_ns
        return {
            "tool": "drivelint",
            "version": __version__,
            "duckdb": duckdb.__version__,
            "output_schema": str(OUTPUT_VERSION),
            **{key: str(row[key]) for key in columns if row[key] is not None},
            **{f"rule {rule['rule_id']}": rule["rule_version"] for rule in self._rules},
            **({"boxes": f"every {step_interval}th step"} if step_interval > 1 else {}),
            **({"time": f"log time = time of the trace + {shift} ns"} if shift else {}),
        }


def _message_groups_with_first_number(messages: list[Message]) -> Iterator[tuple[int, list[Message]]]:
    """Yield groups of messages, each of about `CHUNK_BYTES`, with the number of its first message."""
    first, size = 0, 0
    for k, message in enumerate(messages):
        size += len(message.data)
        if size >= CHUNK_BYTES or k == len(messages) - 1:
            yield first, messages[first : k + 1]
            first, size = k + 1, 0


def _unused_topic_prefix(topics: set[str]) -> str:
    """Return the first of /drivelint, /drivelint_2, ... that no topic of the log starts with: the log may already be annotated."""
    names = ("/drivelint" if n == 1 else f"/drivelint_{n}" for n in count(1))
    return next(name for name in names if not any(t == name or t.startswith(f"{name}/") for t in topics))
