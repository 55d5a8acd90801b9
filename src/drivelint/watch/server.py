"""Shows the running watch to viewers: a Foxglove WebSocket server with the road users, the alarms and the margins.

Where annotated logs have the same content, topics and messages are the same, so that one layout shows both.
"""

from __future__ import annotations

import json
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Final

import msgspec
import numpy as np
import pyarrow.compute as pc

from drivelint.annotate import actor_boxes, draw, measures, result_messages
from drivelint.annotate.clock import LogClock, of_trace
from drivelint.annotate.tracks import tracks
from drivelint.errors import UsageError
from drivelint.formats.foxglove import messages as foxglove_messages
from drivelint.phrases import one_line
from drivelint.result.text import replace_non_finite
from drivelint.watch.sources.transports import LOOPBACK, is_loopback

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from mcap.records import Schema

    from drivelint.annotate.actor_boxes import RecordChunk
    from drivelint.drive.trace import Trace

TOPIC_PREFIX: Final = "/drivelint"
ALARMS_TOPIC: Final = f"{TOPIC_PREFIX}/alarms"
_ALARM_FIELDS: Final = {
    "type": ("string", "alarm"),
    "alarm": ("integer", "its number in this watch"),
    "title": ("string", "what the rule demands"),
    "breach": ("string", "what happened instead"),
    "t_s": ("number", "when the rule was broken, seconds since the log's first step"),
    "said_s": ("number", "when it was printed"),
    "latency_s": ("number", "seconds of the log between both"),
    "status": ("string", "that of the rule"),
}
"""The fields of an alarm in addition to the columns of a finding."""


@contextmanager
def open_server(
    address: str | None, rule_ids: Iterable[str], origins: Sequence[str] = ()
) -> Iterator[LiveServer | None]:
    """Serve viewers at `HOST:PORT` as long as the block runs; None: start no server. `:PORT` serves this machine alone.

    `rule_ids`: the judged rules; `origins`: the origins of web pages that may connect. Errors: `UsageError`.
    """
    if address is None:
        yield None
        return
    host, _, port = address.rpartition(":")
    if not port.isdecimal() or int(port) > 65535:
        raise UsageError(f"--serve {address}: write a host and a port, such as 127.0.0.1:8765")
    server = LiveServer(host.strip("[]") or LOOPBACK, int(port), rule_ids, origins)
    try:
        yield server
    finally:
        server.close()


class LiveServer:
    """Serves viewers at `ws://host:port`. Port 0: any free port. `rule_ids`: the rules that may have margins.

    `origins`: the origins of web pages that may connect. Errors: `UsageError` if the extra `live` is missing or the server cannot start.
    """

    def __init__(self, host: str, port: int, rule_ids: Iterable[str] = (), origins: Sequence[str] = ()) -> None:
        try:
            from drivelint.watch.viewer_server import ViewerServer
        except ImportError as error:
            raise UsageError(
                f"--serve {host}:{port}: {error.name} is not installed: pip install 'drivelint[live]'"
            ) from error
        try:
            self._server = ViewerServer(host, port, origins)
        except OSError as error:
            raise UsageError(f"--serve {host}:{port}: the server cannot start there: {one_line(str(error))}") from error
        self._notes = (
            [] if is_loopback(host) else [f"--serve {host}:{port}: every machine that reaches this address can connect"]
        )
        self._channels: dict[str, int] = {}
        self._clock: LogClock | None = None
        scene, transform = foxglove_messages.schema("SceneUpdate"), foxglove_messages.schema("FrameTransform")
        # announced at once, so that a viewer can subscribe before the first message
        self._scene = self._add_channel(f"{TOPIC_PREFIX}/scene", "protobuf", scene)
        self._transform = self._add_channel(f"{TOPIC_PREFIX}/tf", "protobuf", transform)
        self._alarms = self._add_channel(ALARMS_TOPIC, "json", alarm_schema())
        for rule_id in rule_ids:
            self._margin_channel(rule_id)

    @property
    def port(self) -> int:
        """The port that is served."""
        return self._server.port

    def notes(self) -> list[str]:
        """Return the new notes on the address and on refused clients."""
        own_notes, self._notes = self._notes, []
        return [*own_notes, *self._server.notes()]

    def publish_scene(self, trace_window: Trace) -> None:
        """Publish the boxes of all actors at the newest step of a window; they replace the boxes shown before."""
        states = trace_window.tables["actor_state"]
        if not len(states):
            return
        newest = pc.max(states["t_ns"])
        there = tracks({**trace_window.tables, "actor_state": states.filter(pc.equal(states["t_ns"], newest))})
        rows, _ = actor_boxes.box_rows_and_step_interval(there)
        clock = self._clock_for(newest.as_py())
        at = clock.log_time_at(newest.as_py())
        boxes = b"".join(_message_contents(actor_boxes.scene_update_chunks(there, rows, clock, 0)))
        self._server.publish(self._scene, draw.deletion_of_all(at) + boxes, at)
        for content in _message_contents(actor_boxes.ego_transform_chunks(there, rows, clock, 0)):
            self._server.publish(self._transform, content, at)

    def publish_alarm(self, message: Mapping[str, Any]) -> None:
        """Publish an alarm of `drivelint.watch.messages`, at the time at which its rule was broken."""
        self._publish_json(self._alarms, message, message["t_start_ns"])

    def publish_margins(self, rows: Sequence[Mapping[str, Any]]) -> None:
        """Publish judged steps, each on the topic of its rule; `rows` have columns of `margins.parquet`."""
        for row in rows:
            content = {name: value for name, value in row.items() if name != "drive_id"}
            self._publish_json(self._margin_channel(row["rule_id"]), content, row["t_ns"])

    def close(self) -> None:
        """Disconnect the viewers and end the server. May be called twice."""
        self._server.close()

    def _margin_channel(self, rule_id: str) -> int:
        topic = f"{TOPIC_PREFIX}/{measures.margin_topic(rule_id)}"
        return self._channels.get(topic) or self._add_channel(topic, "json", result_messages.message_schema("margin"))

    def _add_channel(self, topic: str, encoding: str, schema: Schema) -> int:
        self._channels[topic] = number = self._server.add_channel(topic, encoding, schema)
        return number

    def _publish_json(self, channel: int, message: Mapping[str, Any], t_ns: int) -> None:
        # viewers refuse a schema that allows null, so a message leaves out fields with unknown values
        content = {name: value for name, value in message.items() if replace_non_finite(value) is not None}
        self._server.publish(channel, msgspec.json.encode(content), self._clock_for(t_ns).log_time_at(t_ns))

    def _clock_for(self, t_ns: int) -> LogClock:
        """Return the clock of the log times. It is kept for the whole watch, unless a time would be negative with it."""
        if self._clock is None or t_ns + self._clock.shift_ns < 0:
            self._clock = of_trace(t_ns)
        return self._clock


def alarm_schema() -> Schema:
    """Return the schema of alarms: the columns of a finding, and the fields of `_ALARM_FIELDS`."""
    finding = result_messages.message_schema("finding")
    content = json.loads(finding.data)
    own_fields = {name: {"type": kind, "description": meaning} for name, (kind, meaning) in _ALARM_FIELDS.items()}
    content |= {
        "title": "drivelint.Alarm",
        "description": "A rule fails for the first time in a watched drive. Left out: what is not known.",
        "properties": {**own_fields, **content["properties"]},
        "required": ["alarm", "rule_id", "t_start_ns"],
        "additionalProperties": True,
    }
    return type(finding)(id=0, name="drivelint.Alarm", encoding=finding.encoding, data=json.dumps(content).encode())


def _message_contents(chunks: Iterable[RecordChunk]) -> Iterator[bytes]:
    """Yield the message of each chunk, which contains one record, without the record's header."""
    no_number = np.zeros(0, np.uint64)
    head = actor_boxes.message_headers(0, no_number, no_number.astype(np.int64), 0).shape[1]
    for records, index in chunks:
        assert len(index) == 1  # noqa: S101 - all boxes are of one step
        yield bytes(records[head:])
