"""Reads the messages of a SQLite file of a bag, one by one, in the order in which they were recorded."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

from mcap.records import Channel, Schema

from drivelint.drive.trace import QualityFinding
from drivelint.errors import TraceError
from drivelint.formats.mcap.reader import Container, LogMessage, MessageError
from drivelint.formats.mcap.summary import Summary
from drivelint.formats.ros2.cdr import Decoder
from drivelint.formats.ros2.messages import MESSAGE_TYPES
from drivelint.formats.ros2.types import short_type_name
from drivelint.formats.sqlite_bag.database import (
    DEFINITIONS_TABLE,
    check_pages,
    damage_error,
    has_definitions,
    is_repaired_with_losses,
    open_database,
)
from drivelint.formats.sqlite_bag.definitions import candidate_definitions

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterator
    from pathlib import Path

    from drivelint.formats.protobuf.descriptors import FieldTree

MOST_TOPICS: Final = (1 << 16) - 1
"""MCAP numbers schemas and channels with 16 bits."""
NO_DEFINITION_ENCODING: Final = ""
"""The encoding of a schema whose message definition is not known."""
_MOST_SAMPLE_MESSAGES: Final = 20
"""The definition of a type that has several is chosen by so many of its longest messages."""
_LATEST_TIME_NS: Final = (1 << 63) - 1
_GAPS_TEXT: Final = (
    "gaps in the row numbers of messages: {}: rows there were deleted, or lost in a repair: "
    "if you know of neither, copy the log again"
)
"""Recorders number rows without gaps, but a bag from which a user deleted a topic has gaps too: they prove no loss."""


class RowMessage(LogMessage):
    """A message of a SQLite file. `offset`: its row."""

    def error(self, path: Path, problem: str) -> MessageError:
        """Return the error that names this message's topic, time and row, and the problem."""
        where = f"topic {self.channel.topic!r}, log time {self.log_time_ns} ns, row {self.offset} of messages"
        return MessageError(f"{path}: {where}: {problem}: record or copy the log again")


class AssumedDefinitionMessage(RowMessage):
    """A message whose definition is not in its bag."""

    def error(self, path: Path, problem: str) -> MessageError:
        """Return the error of `RowMessage`, with the remedy for a definition that does not fit."""
        text = str(super().error(path, problem)).removesuffix(": record or copy the log again")
        return MessageError(f"{text}: the bag has no message definitions: {CONVERSION_REMEDY}")


CONVERSION_REMEDY: Final = (
    "convert it where ROS and its packages are installed, with ros2 bag convert and storage_id: mcap: that adds them"
)


@dataclass
class SqliteFile(Container):
    """A SQLite file of a bag, with the interface of an MCAP file. `assumed_kinds`: types whose definitions are not in the file."""

    assumed_kinds: set[str] = field(default_factory=set)
    _numbers: dict[Any, int] = field(default_factory=dict)

    def messages(self) -> Iterator[LogMessage]:
        """Yield every message in the order of recording; only the first of each channel in `counts.unread_channels` has its data.

        Errors: `TraceError` if the file is damaged, or has more data than bytes.
        """
        size = self.path.stat().st_size
        with open_database(self.path) as connection:
            check_pages(self.path, connection)
            self._read_topics(connection)
            rows = connection.execute("SELECT rowid, topic_id, timestamp FROM messages ORDER BY rowid")
            is_repaired = is_repaired_with_losses(connection)
            n_bytes = last = n_gaps = 0
            for row, topic, t_ns in rows:
                number = self._numbers.get(topic)
                if number is None or type(t_ns) is not int or not 0 <= t_ns <= _LATEST_TIME_NS:
                    raise damage_error(
                        self.path, f"row {row} of messages has the topic {topic!r} and the time {t_ns!r}"
                    )
                data = b"" if number in self.counts.unread_channels else self._message_data(connection, row)
                n_bytes += len(data) + 1
                if n_bytes > size:
                    raise damage_error(self.path, f"its messages are longer than its {size} bytes")
                if row > last + 1:
                    n_gaps += 1
                    if is_repaired:
                        self._add_lost_rows(last + 1, f"to {row - 1} are")
                last = row
                channel = self.channels[number]
                self.counts.add(number, t_ns)
                self.losses.bound_loss_times_by_message(t_ns)
                is_assumed = self.schemas[channel.schema_id].name in self.assumed_kinds
                yield (AssumedDefinitionMessage if is_assumed else RowMessage)(channel, t_ns, data, row)
        if is_repaired:
            self._add_lost_rows(last + 1, "on may be")
        elif n_gaps:
            self.findings.append(QualityFinding("index_mismatch", "info", _GAPS_TEXT.format(n_gaps), n_gaps))
        message = "a SQLite file has no checksums: damage may remain undetected"
        self.findings.append(QualityFinding("unprotected", "info", message))

    def index(self) -> Summary:
        """Return the topics and their types. Errors: `TraceError`."""
        with open_database(self.path) as connection:
            self._read_topics(connection)
        return Summary(schemas=self.schemas, channels=self.channels)

    def _add_lost_rows(self, row: int, range_and_verb: str) -> None:
        """Add as a loss the rows of messages from `row` on, which the repair of the file did not find."""
        cause = f"the file was repaired (it has a table lost_and_found), and rows of messages from {row} {range_and_verb} missing"
        self.losses.add(row, row, cause)

    def _message_data(self, connection: sqlite3.Connection, row: int) -> bytes:
        message_row = connection.execute("SELECT data FROM messages WHERE rowid = ?", (row,)).fetchone()
        if message_row is None or not isinstance(message_row[0], bytes):
            raise damage_error(self.path, f"row {row} of messages has no data")
        return message_row[0]

    def _read_topics(self, connection: sqlite3.Connection) -> None:
        definitions = self._definitions_in_file(connection)
        names = {name for _, name, *_ in connection.execute("PRAGMA table_xinfo(topics)")}
        qos = "offered_qos_profiles" if "offered_qos_profiles" in names else "''"
        rows = connection.execute(f"SELECT id, name, type, serialization_format, {qos} FROM topics ORDER BY id")
        of_kind: dict[str, int] = {}
        for key, topic, kind, encoding, profiles in rows:
            if not all(isinstance(cell, str) for cell in (topic, kind, encoding)) or len(self._numbers) >= MOST_TOPICS:
                raise damage_error(self.path, f"row {key} of topics is not as rosbag2 writes it")
            if kind not in of_kind:
                of_kind[kind] = len(of_kind) + 1
                self.schemas[of_kind[kind]] = self._schema(connection, of_kind[kind], kind, definitions)
            number = self._numbers.setdefault(key, len(self._numbers))
            metadata = {"offered_qos_profiles": profiles} if isinstance(profiles, str) and profiles else {}
            self.channels[number] = Channel(number, topic, encoding, metadata, of_kind[kind])

    def _definitions_in_file(self, connection: sqlite3.Connection) -> dict[str, tuple[str, bytes]]:
        """Return type -> encoding and text of the definitions in the file."""
        if not has_definitions(self.path, connection):
            return {}
        definitions: dict[str, tuple[str, bytes]] = {}
        rows = connection.execute(
            f"SELECT topic_type, encoding, encoded_message_definition FROM {DEFINITIONS_TABLE} ORDER BY rowid"
        )
        n_bytes, size = 0, self.path.stat().st_size
        for kind, encoding, text in rows:
            if not all(isinstance(cell, str) for cell in (kind, encoding, text)):
                raise damage_error(self.path, f"the definition of {kind!r} is not text")
            n_bytes += len(text) + 1
            if n_bytes > size:
                raise damage_error(self.path, f"its message definitions are longer than its {size} bytes")
            if text:
                definitions.setdefault(kind, (encoding, text.encode()))
        return definitions

    def _schema(
        self, connection: sqlite3.Connection, number: int, kind: str, definitions: dict[str, tuple[str, bytes]]
    ) -> Schema:
        """Return the schema of a type: the file's own, else the one that is known, else one without a definition."""
        if kind in definitions:
            encoding, text = definitions[kind]
            return Schema(id=number, name=kind, encoding=encoding, data=text)
        candidates = [
            Schema(id=number, name=kind, encoding="ros2msg", data=text.encode())
            for text in candidate_definitions(short_type_name(kind))
        ]
        if not candidates:
            return Schema(id=number, name=kind, encoding=NO_DEFINITION_ENCODING, data=b"")
        self.assumed_kinds.add(kind)
        message_type = MESSAGE_TYPES.get(short_type_name(kind))
        if len(candidates) == 1 or message_type is None:  # nothing reads messages of another type
            return candidates[0]
        samples = self._longest_messages(connection, kind, number)
        # messages of one object also fit the oldest definition, so of those that fit equally many the newest is taken
        return max(candidates, key=lambda candidate: self._n_fitting(candidate, message_type.fields, samples))

    def _longest_messages(self, connection: sqlite3.Connection, kind: str, schema_id: int) -> list[LogMessage]:
        """Return the longest messages of a type, which contain most objects."""
        rows = connection.execute(
            "SELECT messages.rowid, data FROM messages JOIN topics ON topics.id = topic_id WHERE type = ? "
            "ORDER BY length(data) DESC, messages.rowid LIMIT ?",
            (kind, _MOST_SAMPLE_MESSAGES),
        )
        channel = Channel(0, "", "cdr", {}, schema_id)
        return [RowMessage(channel, 0, data, row) for row, data in rows if isinstance(data, bytes)]

    def _n_fitting(self, schema: Schema, fields: FieldTree, samples: list[LogMessage]) -> int:
        """Return how many of the messages a definition fits."""
        decoder, n = Decoder(self.path, schema, fields), 0
        for sample in samples:
            with suppress(TraceError):
                decoder.table([sample])
                n += 1
        return n
