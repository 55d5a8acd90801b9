"""Keeps the entities of a Foxglove scene that still exist, and returns messages with these entities alone.

The last two updates of an entity determine how long it exists, and whether it stood still (`formats.foxglove.entity_lifetime`). An entity
that ended before a window and returns in it is new there: a reader that got its old place would interpolate between both. Schema:
https://docs.foxglove.dev/docs/visualization/message-schemas/scene-update.
"""

from __future__ import annotations

import json
from collections import defaultdict, deque
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from drivelint.formats.protobuf.scan import fields, signed_integer
from drivelint.formats.protobuf.wire import nested

if TYPE_CHECKING:
    from drivelint.watch.sources.mcap_stream import NumberedMessage

ENDED_ENTITY_KEPT_NS: Final = 120_000_000_000
"""How long an ended entity is kept: if an entity with its id returns, the old place shows whether it has moved."""
MOST_INEFFECTIVE_DELETIONS: Final = 1000
"""The largest number of kept deletions that have no effect by the entities' own times. A reader that uses log times may apply them."""
_DELETIONS, _ENTITIES = 1, 2
_TIMESTAMP, _ID, _LIFETIME = 1, 3, 4
_DELETE_ALL: Final = 1
_NS_PER_S: Final = 1_000_000_000


class _EntityUpdate(NamedTuple):
    """An update of an entity: `content` as in its message, its time, and when it expires (None: never)."""

    source: NumberedMessage
    content: Any
    t_ns: int
    expires_ns: int | None


class _Deletion(NamedTuple):
    source: NumberedMessage
    content: Any


@dataclass
class _EntityHistory:
    updates: deque[_EntityUpdate] = field(default_factory=lambda: deque(maxlen=2))
    is_gone: bool = False


class SceneMemory:
    """Keeps the last two updates of every entity, see `mcap_memory.ChannelMemory`. Messages that cannot be decoded are ignored."""

    def __init__(self, encoding: str) -> None:
        self._codec: _ProtobufCodec | _JsonCodec = _JsonCodec() if encoding == "json" else _ProtobufCodec()
        self._tracks: dict[Any, _EntityHistory] = defaultdict(_EntityHistory)
        self._ineffective_deletions: deque[_Deletion] = deque(maxlen=MOST_INEFFECTIVE_DELETIONS)
        self._latest_ns = 0

    def add(self, numbered: NumberedMessage) -> None:
        """Add the next message."""
        try:
            entities, deletions = self._codec.entities_and_deletions(numbered.message.content)
            updates = [(self._codec.id_time_lifetime(content), content) for content in entities]
            deleted = [(self._codec.deleted_id_and_time(content), content) for content in deletions]
        except (ValueError, TypeError, KeyError, AttributeError):
            return
        log_ns = numbered.message.log_ns
        for (name, stamp, lifetime), content in updates:
            t_ns = stamp or log_ns
            track = self._tracks[name]
            track.updates.append(_EntityUpdate(numbered, content, t_ns, t_ns + lifetime if lifetime > 0 else None))
            track.is_gone = False
            self._latest_ns = max(self._latest_ns, t_ns)
        for (entity_id, stamp), content in deleted:
            self._apply_deletion(entity_id, stamp or self._latest_ns, _Deletion(numbered, content))

    def _apply_deletion(self, entity_id: Any, t_ns: int, deletion: _Deletion) -> None:
        tracks = (
            self._tracks.values()
            if entity_id is None
            else [self._tracks[entity_id]]
            if entity_id in self._tracks
            else []
        )
        for track in tracks:
            if not track.is_gone and track.updates[-1].t_ns < t_ns:
                track.is_gone = True
            elif not track.is_gone and (
                not self._ineffective_deletions or self._ineffective_deletions[-1] is not deletion
            ):
                self._ineffective_deletions.append(deletion)

    def current_messages(self) -> list[NumberedMessage]:
        """Return messages with the updates of existing entities, each at the log time of its original message."""
        for track in self._tracks.values():
            expires = track.updates[-1].expires_ns
            track.is_gone |= expires is not None and expires < self._latest_ns
        forgotten = self._latest_ns - ENDED_ENTITY_KEPT_NS
        for name in [n for n, track in self._tracks.items() if track.is_gone and track.updates[-1].t_ns < forgotten]:
            del self._tracks[name]
        updates = [update for track in self._tracks.values() if not track.is_gone for update in track.updates]
        by_source: dict[int, tuple[NumberedMessage, list[Any], list[Any]]] = {}
        for update in updates:
            by_source.setdefault(update.source.number, (update.source, [], []))[1].append(update.content)
        for deletion in self._ineffective_deletions:
            by_source.setdefault(deletion.source.number, (deletion.source, [], []))[2].append(deletion.content)
        return [
            source._replace(message=source.message.with_content(self._codec.encode(entities, deletions)))
            for _, (source, entities, deletions) in sorted(by_source.items(), key=lambda item: item[0])
        ]


class _ProtobufCodec:
    """Splits a `SceneUpdate` in protobuf into entities and deletions, each as encoded bytes."""

    def entities_and_deletions(self, data: bytes) -> tuple[list[bytes], list[bytes]]:
        """Return entities and deletions. Errors: `ValueError`."""
        parts: dict[int, list[bytes]] = {_ENTITIES: [], _DELETIONS: []}
        for item in fields(data):
            if item.number in parts:
                parts[item.number].append(data[item.start : item.end])
        return parts[_ENTITIES], parts[_DELETIONS]

    def id_time_lifetime(self, entity: bytes) -> tuple[bytes, int, int]:
        """Return id, time and lifetime of an entity; 0 for a missing time or lifetime."""
        spans = {item.number: entity[item.start : item.end] for item in fields(entity)}
        return spans.get(_ID, b""), _time_ns(spans.get(_TIMESTAMP, b"")), _time_ns(spans.get(_LIFETIME, b""))

    def deleted_id_and_time(self, deletion: bytes) -> tuple[bytes | None, int]:
        """Return the id that a deletion deletes (None: all ids), and its time."""
        item_by_number = {item.number: item for item in fields(deletion)}
        spans = {number: deletion[item.start : item.end] for number, item in item_by_number.items()}
        every = 2 in item_by_number and item_by_number[2].value == _DELETE_ALL
        return None if every else spans.get(_ID, b""), _time_ns(spans.get(_TIMESTAMP, b""))

    def encode(self, entities: list[bytes], deletions: list[bytes]) -> bytes:
        """Return a message with these entities and deletions."""
        return b"".join(
            [*(nested(_DELETIONS, part) for part in deletions), *(nested(_ENTITIES, part) for part in entities)]
        )


def _time_ns(data: bytes) -> int:
    parts = {item.number: item.value for item in fields(data)}
    return signed_integer(parts.get(1, 0)) * _NS_PER_S + signed_integer(parts.get(2, 0))


class _JsonCodec:
    """Splits a `SceneUpdate` in JSON into entities and deletions, each as a JSON object."""

    def entities_and_deletions(self, data: bytes) -> tuple[list[Any], list[Any]]:
        """Return entities and deletions. Errors: `ValueError` or `AttributeError`."""
        message = json.loads(data)
        return message.get("entities") or [], message.get("deletions") or []

    def id_time_lifetime(self, entity: Any) -> tuple[str, int, int]:
        """Return id, time and lifetime of an entity; 0 for a missing time or lifetime."""
        return entity.get("id") or "", _json_time_ns(entity.get("timestamp")), _json_time_ns(entity.get("lifetime"))

    def deleted_id_and_time(self, deletion: Any) -> tuple[str | None, int]:
        """Return the id that a deletion deletes (None: all ids), and its time."""
        every = deletion.get("type") in {_DELETE_ALL, "ALL"}
        return None if every else deletion.get("id") or "", _json_time_ns(deletion.get("timestamp"))

    def encode(self, entities: list[Any], deletions: list[Any]) -> bytes:
        """Return a message with these entities and deletions."""
        return json.dumps({"deletions": deletions, "entities": entities}).encode()


def _json_time_ns(value: Any) -> int:
    if not value:
        return 0
    seconds, rest = value.get("sec", value.get("seconds", 0)), value.get("nsec", value.get("nanos", 0))
    return round((seconds or 0) * _NS_PER_S) + round(rest or 0)
