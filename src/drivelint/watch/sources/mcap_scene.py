"""The entities of a Foxglove scene that are still there, as messages that say only these.

How long an entity is there, and whether it stood still, follows from its last two updates (`formats.foxglove.entity_lifetime`). One that
went before a window and comes again in it is new there: its old place would be a sample of a track, which others interpolate. Schema:
https://docs.foxglove.dev/docs/visualization/message-schemas/scene-update.
"""

from __future__ import annotations

import json
from collections import defaultdict, deque
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from drivelint.formats.protobuf.scan import fields, signed
from drivelint.formats.protobuf.wire import nested

if TYPE_CHECKING:
    from drivelint.watch.sources.mcap_stream import Numbered

GONE_KEPT_NS: Final = 120_000_000_000
"""An entity that is gone is remembered for so long: one of its name that comes again has moved in between, or not."""
MOST_DOUBTFUL: Final = 1000
"""So many deletions are kept that delete nothing by the entities' own clock, and may do so by the log's, if a reader chooses that."""
_DELETIONS, _ENTITIES = 1, 2
_TIMESTAMP, _ID, _LIFETIME = 1, 3, 4
_DELETE_ALL: Final = 1
_NS: Final = 1_000_000_000


class _Entity(NamedTuple):
    """An update of an entity: `content` as it stands in its message, its time and when it expires (None: never)."""

    source: Numbered
    content: Any
    t_ns: int
    expires_ns: int | None


class _Deletion(NamedTuple):
    source: Numbered
    content: Any


@dataclass
class _Track:
    updates: deque[_Entity] = field(default_factory=lambda: deque(maxlen=2))
    is_gone: bool = False


class SceneMemory:
    """Keeps the last two updates of every entity, see `mcap_memory.Memory`. Messages that cannot be decoded say nothing."""

    def __init__(self, encoding: str) -> None:
        self._codec: _Protobuf | _Json = _Json() if encoding == "json" else _Protobuf()
        self._tracks: dict[Any, _Track] = defaultdict(_Track)
        self._doubtful: deque[_Deletion] = deque(maxlen=MOST_DOUBTFUL)
        self._latest_ns = 0

    def take(self, numbered: Numbered) -> None:
        """Take the next message."""
        try:
            entities, deletions = self._codec.parts(numbered.message.content)
            updates = [(self._codec.id_time_lifetime(content), content) for content in entities]
            gone = [(self._codec.deleted(content), content) for content in deletions]
        except (ValueError, TypeError, KeyError, AttributeError):
            return
        log_ns = numbered.message.log_ns
        for (name, stamp, lifetime), content in updates:
            t_ns = stamp or log_ns
            track = self._tracks[name]
            track.updates.append(_Entity(numbered, content, t_ns, t_ns + lifetime if lifetime > 0 else None))
            track.is_gone = False
            self._latest_ns = max(self._latest_ns, t_ns)
        for (entity_id, stamp), content in gone:
            self._delete(entity_id, stamp or self._latest_ns, _Deletion(numbered, content))

    def _delete(self, entity_id: Any, t_ns: int, deletion: _Deletion) -> None:
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
            elif not track.is_gone and (not self._doubtful or self._doubtful[-1] is not deletion):
                self._doubtful.append(deletion)

    def current_messages(self) -> list[Numbered]:
        """Return messages with the updates of the entities that are still there, each at the log time of its own."""
        for track in self._tracks.values():
            expires = track.updates[-1].expires_ns
            track.is_gone |= expires is not None and expires < self._latest_ns
        forgotten = self._latest_ns - GONE_KEPT_NS
        for name in [n for n, track in self._tracks.items() if track.is_gone and track.updates[-1].t_ns < forgotten]:
            del self._tracks[name]
        updates = [update for track in self._tracks.values() if not track.is_gone for update in track.updates]
        by_source: dict[int, tuple[Numbered, list[Any], list[Any]]] = {}
        for update in updates:
            by_source.setdefault(update.source.number, (update.source, [], []))[1].append(update.content)
        for deletion in self._doubtful:
            by_source.setdefault(deletion.source.number, (deletion.source, [], []))[2].append(deletion.content)
        return [
            source._replace(message=source.message.with_content(self._codec.encode(entities, deletions)))
            for _, (source, entities, deletions) in sorted(by_source.items(), key=lambda item: item[0])
        ]


class _Protobuf:
    """Takes a `SceneUpdate` in protobuf apart; an entity or a deletion is its bytes."""

    def parts(self, data: bytes) -> tuple[list[bytes], list[bytes]]:
        """Return entities and deletions. Errors: `ValueError`."""
        found: dict[int, list[bytes]] = {_ENTITIES: [], _DELETIONS: []}
        for each in fields(data):
            if each.number in found:
                found[each.number].append(data[each.start : each.end])
        return found[_ENTITIES], found[_DELETIONS]

    def id_time_lifetime(self, entity: bytes) -> tuple[bytes, int, int]:
        """Return id, time and lifetime of an entity; 0: none is said."""
        spans = {each.number: entity[each.start : each.end] for each in fields(entity)}
        return spans.get(_ID, b""), _time(spans.get(_TIMESTAMP, b"")), _time(spans.get(_LIFETIME, b""))

    def deleted(self, deletion: bytes) -> tuple[bytes | None, int]:
        """Return the ids that a deletion deletes (None: all), and its time."""
        found = {each.number: each for each in fields(deletion)}
        spans = {number: deletion[each.start : each.end] for number, each in found.items()}
        every = 2 in found and found[2].value == _DELETE_ALL
        return None if every else spans.get(_ID, b""), _time(spans.get(_TIMESTAMP, b""))

    def encode(self, entities: list[bytes], deletions: list[bytes]) -> bytes:
        """Return a message of these."""
        return b"".join(
            [*(nested(_DELETIONS, each) for each in deletions), *(nested(_ENTITIES, each) for each in entities)]
        )


def _time(data: bytes) -> int:
    parts = {each.number: each.value for each in fields(data)}
    return signed(parts.get(1, 0)) * _NS + signed(parts.get(2, 0))


class _Json:
    """Takes a `SceneUpdate` in JSON apart; an entity or a deletion is its object."""

    def parts(self, data: bytes) -> tuple[list[Any], list[Any]]:
        """Return entities and deletions. Errors: `ValueError` or `AttributeError`."""
        message = json.loads(data)
        return message.get("entities") or [], message.get("deletions") or []

    def id_time_lifetime(self, entity: Any) -> tuple[str, int, int]:
        """Return id, time and lifetime of an entity; 0: none is said."""
        return entity.get("id") or "", _json_time(entity.get("timestamp")), _json_time(entity.get("lifetime"))

    def deleted(self, deletion: Any) -> tuple[str | None, int]:
        """Return the ids that a deletion deletes (None: all), and its time."""
        every = deletion.get("type") in {_DELETE_ALL, "ALL"}
        return None if every else deletion.get("id") or "", _json_time(deletion.get("timestamp"))

    def encode(self, entities: list[Any], deletions: list[Any]) -> bytes:
        """Return a message of these."""
        return json.dumps({"deletions": deletions, "entities": entities}).encode()


def _json_time(value: Any) -> int:
    if not value:
        return 0
    seconds, rest = value.get("sec", value.get("seconds", 0)), value.get("nsec", value.get("nanos", 0))
    return round((seconds or 0) * _NS) + round(rest or 0)
