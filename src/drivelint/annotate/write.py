"""One annotated log: the original's bytes, or a generated scene, with the verdicts and what they stand on beside it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import count
from typing import TYPE_CHECKING, BinaryIO, Final

import duckdb
import numpy as np

from drivelint import __version__
from drivelint.annotate import actor_boxes, clock, danger_spaces, finding_markers, places, result_messages
from drivelint.annotate.tracks import tracks
from drivelint.formats.foxglove import messages as foxglove
from drivelint.formats.mcap.copy import Original, is_mcap
from drivelint.formats.mcap.writer import Sink
from drivelint.result.schemas import OUTPUT_VERSION

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from mcap.records import Schema

    from drivelint.annotate.actor_boxes import RecordChunk
    from drivelint.annotate.evidence import Evidence
    from drivelint.annotate.result_messages import Message
    from drivelint.annotate.road import Road
    from drivelint.drive.trace import Trace
    from drivelint.road.geo_reference import GeoFrame

CHUNK_BYTES: Final = 1 << 20
_TRANSFORMS: Final = ("FrameTransform", "FrameTransforms", "TFMessage", "tfMessage", "TransformStamped")


@dataclass(frozen=True)
class Annotation:
    """One drive's evidence and summary, which are written beside the log.

    `road` is None without a map. `geo` is None if neither log nor map has a usable reference.
    `versions` and `sense_by_rule` are rule id -> hash of its file, rule id -> relation that must hold.
    """

    trace: Trace
    evidence: Evidence
    road: Road | None
    geo: GeoFrame | None
    versions: Mapping[str, str]
    sense_by_rule: Mapping[str, str]
    summary: bytes


def write(file: BinaryIO, said: Annotation) -> None:
    """Write the annotated log of one drive. Same inputs, same bytes. Errors: `TraceError` where the log cannot be copied."""
    sink = Sink(file)
    log = said.trace.tables["data_log"].to_pylist()[0]
    if is_mcap(said.trace.path):
        with Original(said.trace.path, log["sha256"]) as original:
            original.copy(sink)
    else:
        sink.begin(f"drivelint {__version__}")
    _Writer(sink, said, int(log["t_start_ns"])).run()
    sink.finish()


class _Writer:
    """Adds the channels of one drive to a sink that holds the original, or nothing yet."""

    def __init__(self, sink: Sink, said: Annotation, t_start_ns: int) -> None:
        self._sink = sink
        self._said = said
        self._start_ns = t_start_ns
        self._tracks = tracks(said.trace.tables)
        frames = said.trace.frame_times
        self._clock = clock.of_frames(*frames) if frames else clock.of_trace(t_start_ns)
        self._prefix = _free_prefix({channel.topic for channel in sink.channels.values()})
        self._moves = any(schema.name.endswith(_TRANSFORMS) for schema in sink.schemas.values())

    def run(self) -> None:
        """Write every channel, then metadata and attachment."""
        evidence, times, start = self._said.evidence, self._clock, self._start_ns
        boxes = actor_boxes.select_boxes(self._tracks)
        sense_by_rule = self._said.sense_by_rule
        scene = foxglove.schema("SceneUpdate")
        if self._said.road is not None and len(boxes.rows):
            at = times.at(start)
            lanes = self._said.road.lanes_near(self._tracks.x[boxes.rows], self._tracks.y[boxes.rows], at)
            self._few("map", scene, [result_messages.Message(at, lanes)])
        self._many("scene", scene, lambda channel: actor_boxes.messages(boxes, times, channel))
        if not self._moves:  # the log's own frames are not ours to speak of
            transform = foxglove.schema("FrameTransform")
            self._many("tf", transform, lambda channel: actor_boxes.ego_transforms(boxes, times, channel))
        self._few("danger_spaces", scene, danger_spaces.messages(evidence, self._tracks, times))
        self._few("markers", scene, finding_markers.messages(evidence, self._tracks, times, sense_by_rule))
        verdicts = result_messages.verdict_messages(evidence.verdicts, times, start)
        self._few("verdicts", result_messages.schema("verdict"), verdicts)
        findings = result_messages.finding_messages(evidence.findings, times)
        self._few("findings", result_messages.schema("finding"), findings)
        lines = result_messages.log_messages(evidence.verdicts, times, start, sense_by_rule)
        self._few("log", foxglove.schema("Log"), lines)
        if self._said.geo:
            self._on_earth(self._said.geo)
        self._sink.add_metadata("drivelint", self._facts(boxes.every))
        self._sink.add_attachment("summary.json", "application/json", self._said.summary, times.at(start))

    def _on_earth(self, geo: GeoFrame) -> None:
        frame = "" if self._moves else actor_boxes.EGO_FRAME
        fixes = places.location_messages(self._tracks, geo, self._clock, frame)
        self._few("location", foxglove.schema("LocationFix"), fixes)
        said = self._said
        layer = places.geojson(said.evidence.findings, self._tracks, geo, said.road, said.sense_by_rule)
        at = self._clock.at(self._start_ns)
        self._few("geojson", foxglove.schema("GeoJSON"), [result_messages.Message(at, layer)])

    def _many(self, topic: str, schema: Schema, chunks: Callable[[int], Iterable[RecordChunk]]) -> None:
        channel = self._sink.add_channel(f"{self._prefix}/{topic}", "protobuf", schema)
        for records, index in chunks(channel):
            self._sink.add_chunk(records, {channel: index})

    def _few(self, topic: str, schema: Schema, messages: list[Message]) -> None:
        encoding = "json" if schema.encoding == "jsonschema" else "protobuf"
        channel = self._sink.add_channel(f"{self._prefix}/{topic}", encoding, schema)
        for first, group in _cut(messages):
            size = np.array([len(m.data) for m in group])
            log_time = np.array([m.log_time for m in group], np.uint64)
            heads = actor_boxes.message_headers(channel, log_time, size, first)
            records = b"".join(part for head, m in zip(heads, group, strict=True) for part in (head.tobytes(), m.data))
            place = np.cumsum(size + heads.shape[1]) - size - heads.shape[1]
            self._sink.add_chunk(records, {channel: np.stack([log_time, place.astype(np.uint64)], axis=1)})

    def _facts(self, every: int) -> dict[str, str]:
        """Return what the verdicts stand on: tool, log, map, rules with their versions."""
        row = self._said.evidence.drive.to_pylist()[0]
        known = (
            "drive_id", "file_name", "sha256", "format", "environment_id", "map_name", "map_sha256", "handedness",
            "handedness_source",
        )  # fmt: skip
        shift = self._clock.shift_ns
        return {
            "tool": "drivelint",
            "version": __version__,
            "duckdb": duckdb.__version__,
            "output_schema": str(OUTPUT_VERSION),
            **{key: str(row[key]) for key in known if row[key] is not None},
            **{f"rule {rule}": version for rule, version in self._said.versions.items()},
            **({"boxes": f"every {every}th step"} if every > 1 else {}),
            **({"time": f"log time = time of the trace + {shift} ns"} if shift else {}),
        }


def _cut(messages: list[Message]) -> Iterator[tuple[int, list[Message]]]:
    """Yield messages in groups of about a chunk, each with the number of its first."""
    first, size = 0, 0
    for k, message in enumerate(messages):
        size += len(message.data)
        if size >= CHUNK_BYTES or k == len(messages) - 1:
            yield first, messages[first : k + 1]
            first, size = k + 1, 0


def _free_prefix(topics: set[str]) -> str:
    """Return the first of /drivelint, /drivelint_2, ... under which the log has no topic: it may be annotated already."""
    names = ("/drivelint" if n == 1 else f"/drivelint_{n}" for n in count(1))
    return next(name for name in names if not any(t == name or t.startswith(f"{name}/") for t in topics))
