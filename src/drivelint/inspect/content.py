"""Lists the content of a file, even if it cannot be read as a drive: channels, tables, columns, and how they are read."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from drivelint.errors import TraceError, UsageError
from drivelint.formats.film import mapping as video_mapping
from drivelint.formats.folders import drive_files
from drivelint.formats.mcap import bag
from drivelint.formats.mcap.bag_folder import is_bag
from drivelint.formats.mcap.resume import MAGIC
from drivelint.formats.mcap.storage import file_index, recorded_file
from drivelint.formats.osi.decode import FIELD_TREES
from drivelint.formats.osi.metadata import EVENT_MESSAGE
from drivelint.formats.osi.schema import OPEN_DRIVE
from drivelint.formats.ros2 import topic_mapping
from drivelint.formats.ros2.types import message_kind
from drivelint.formats.search import is_pipe_or_device
from drivelint.formats.sqlite_bag.database import MAGIC as SQLITE_MAGIC
from drivelint.formats.tables import ipc, parquet
from drivelint.formats.tables import mapping as mappings
from drivelint.formats.tables.mapped_table import open_sheet
from drivelint.formats.tables.mapping import GROUP_PLACEHOLDER, Mapping, TextLayout
from drivelint.formats.tables.sheets import CsvSheet, ParquetSheet
from drivelint.inspect.mapping_draft import draft_mapping
from drivelint.inspect.model import Channel, Column, Content, Sheet
from drivelint.pictures.frames import has_pictures

if TYPE_CHECKING:
    from collections.abc import Iterable

    from mcap import records

    from drivelint.formats.film.mapping import VideoMapping
    from drivelint.formats.mcap.reader import Container
    from drivelint.formats.mcap.summary import Summary

_HEAD_BYTES: Final = 4096
_OSI_ROLES: Final = {(name, "protobuf"): "ground truth" for name in FIELD_TREES} | {
    (OPEN_DRIVE, "protobuf"): "map",
    (EVENT_MESSAGE, "json"): "declared events",
}
_ROLES_BY_FAMILY: Final[dict[str, dict[tuple[str, str], str]]] = {
    "osi": _OSI_ROLES,
    "none": _OSI_ROLES,
    "ros2": {(name, "cdr"): role for name, role in bag.ROS_ROLE_BY_SCHEMA.items()},
    "foxglove": {
        (name, kind): role for name, role in bag.FOXGLOVE_ROLE_BY_SCHEMA.items() for kind in ("protobuf", "json")
    },
}
"""Message family -> (schema, encoding) -> how drivelint reads these messages."""


def size_bytes(path: Path) -> int:
    """Return the size in bytes of a file, or of all files of a folder that is read as one drive."""
    files = drive_files(path)
    if is_bag(path):
        files = [file for file in path.iterdir() if file.suffix.lower() in bag.SUFFIX_BY_STORAGE.values()]
    return sum(file.stat().st_size for file in files if file.is_file())


def file_content(path: Path, mapping: str | None, notes: list[str], *, has_reader: bool) -> Content:
    """Return the channels, tables and columns of a file, and how they are read.

    `mapping`: the mapping that reads a table, or None. `has_reader`: a reader recognises the file, so no mapping is drafted.
    """
    if path.is_dir():
        if is_bag(path):
            return Content(channels=_channels(path, mapping), notes=notes)
        return Content(
            sheets=[sheet for file in drive_files(path) if (sheet := _sheet_of_table_file(file))], notes=notes
        )
    if is_pipe_or_device(path):
        return Content(notes=notes)  # the reader of drives reports the fault
    with path.open("rb") as file:
        head = file.read(_HEAD_BYTES)
    if head.startswith((MAGIC[:5], SQLITE_MAGIC)):
        return Content(channels=_channels(path, mapping), notes=notes)
    return _table_content(path, head, mapping, notes, has_reader=has_reader)


def _table_content(path: Path, head: bytes, mapping: str | None, notes: list[str], *, has_reader: bool) -> Content:
    if mapping is not None and video_mapping.is_video_mapping(mapping):
        name, film = video_mapping.load(mapping)
        return Content(sheets=[_video_detections_sheet(path, film)], mapping=name, notes=notes)
    if mapping is not None:
        name, loaded = mappings.load(mapping)
        return Content(sheets=[_listing_of_mapped_table(path, loaded)], mapping=name, notes=notes)
    if head.startswith(b"PAR1"):
        sheet = _parquet_sheet(path)
        guess = (
            None
            if has_reader
            else draft_mapping(parquet.schema(path).names, lambda name: _distinct_texts(ParquetSheet(path), name))
        )
        return Content(sheets=[sheet], notes=notes, draft_mapping=guess)
    if has_reader or b"\0" in head or not head.strip() or head.lstrip()[:1] in {b"<", b"{"}:
        return Content(notes=notes)  # not a table, or a text file with a reader of its own
    table = CsvSheet(path, TextLayout())
    sheet = Sheet(name=path.name, rows=None, columns=_unread_columns(table.names))
    draft = draft_mapping(table.names, lambda name: _distinct_texts(table, name))
    return Content(sheets=[sheet], notes=notes, draft_mapping=draft)


def _distinct_texts(sheet: CsvSheet | ParquetSheet, column: str) -> list[str]:
    """Return the distinct texts of a column; empty if the column cannot be read."""
    try:
        sheet.load([column])
        return sorted(sheet.text_column(column).unique().drop_null().to_pylist())
    except TraceError:
        return []  # reading the table fails for the same reason, and reports it


def _unread_columns(names: Iterable[str]) -> list[Column]:
    return [Column(name=name, read_as=[]) for name in names]


def _parquet_sheet(path: Path) -> Sheet:
    return Sheet(name=path.name, rows=parquet.n_rows(path), columns=_unread_columns(parquet.schema(path).names))


def _sheet_of_table_file(path: Path) -> Sheet | None:
    """Return the columns of a table file in a folder; None for another file."""
    if path.suffix == ".parquet":
        return _parquet_sheet(path)
    if path.suffix in {".feather", ".arrow"}:
        names, rows = ipc.column_names_and_n_rows(path)
        return Sheet(name=path.name, rows=rows, columns=_unread_columns(names))
    return None


def _listing_of_mapped_table(path: Path, mapping: Mapping) -> Sheet:
    """Return a table's columns, first the columns that the mapping reads."""
    sheet = open_sheet(path, mapping)
    columns = _columns_of_mapping(mapping)
    shapes = [re.compile(re.escape(c.name).replace(re.escape(GROUP_PLACEHOLDER), r"\d+")) for c in columns]
    is_grouped = any(GROUP_PLACEHOLDER in c.name for c in columns)
    unread = [name for name in sheet.names if name and not any(shape.fullmatch(name) for shape in shapes)]
    names = dict.fromkeys(re.sub(r"(?<=#)\d+", GROUP_PLACEHOLDER, name) if is_grouped else name for name in unread)
    columns += _unread_columns(names)
    rows = parquet.n_rows(path) if isinstance(sheet, ParquetSheet) else None
    return Sheet(name=path.name, rows=rows, columns=columns)


def _video_detections_sheet(path: Path, film: VideoMapping) -> Sheet:
    """Return the columns of a table of video detections, first the columns that the mapping reads."""
    names = CsvSheet(path, TextLayout()).names
    meanings = {film.frames.column: ["time"]} | {
        str(actor.ahead): [f"distance ahead of {actor.id}"] for actor in film.actor
    }
    columns = [Column(name=name, read_as=read_as) for name, read_as in meanings.items()]
    columns += _unread_columns(name for name in names if name and name not in meanings)
    return Sheet(name=path.name, rows=None, columns=columns)


def _columns_of_mapping(mapping: Mapping) -> list[Column]:
    meanings: dict[str, list[str]] = {mapping.time.column: ["time"]}
    units: dict[str, str | None] = {mapping.time.column: mapping.time.unit}
    for name, spec in mappings.fields(mapping).items():
        if spec.column is not None:
            meanings.setdefault(spec.column, []).append(name)
            units[spec.column] = units.get(spec.column) or spec.unit
    for name, (words, _) in mappings.word_mappings(mapping).items():
        for column in words.columns:
            meanings.setdefault(column, []).append(name.removeprefix("actor_"))
    return [Column(name=name, read_as=read_as, unit=units.get(name)) for name, read_as in meanings.items()]


@dataclass
class _ChannelCount:
    messages: int = 0
    size: int = 0
    first_ns: int = 0
    last_ns: int = 0


def _channels(path: Path, mapping: str | None) -> list[Channel]:
    """Return every channel with its number of messages: over all parts of a bag, and the readable messages of a damaged file."""
    counts: dict[tuple[str, str, str, str], _ChannelCount] = {}
    try:
        for file in bag.bag_files(path):
            container = recorded_file(file)
            try:
                for log_message in container.messages():
                    count = counts.setdefault(
                        _channel_key(container, log_message.channel), _ChannelCount(first_ns=log_message.log_time_ns)
                    )
                    count.messages += 1
                    count.size += len(log_message.data)
                    count.first_ns = min(count.first_ns, log_message.log_time_ns)
                    count.last_ns = max(count.last_ns, log_message.log_time_ns)
            finally:
                # a channel without messages may occur only in the index
                for part in (container, file_index(file)):
                    for channel in part.channels.values():
                        counts.setdefault(_channel_key(part, channel), _ChannelCount())
    except TraceError:
        pass  # reading the drive fails for the same reason, and reports it
    mapped = _mapped_topics(mapping)
    roles = {} if mapped else _message_roles(path)
    return [_channel(key, counts[key], roles, mapped) for key in sorted(counts)]


def _mapped_topics(mapping: str | None) -> set[str]:
    """Return the topics that a mapping of messages reads; none for another mapping."""
    if mapping is None or not topic_mapping.is_message_mapping(mapping):
        return set()
    try:
        return {channel.topic for channel in topic_mapping.load(Path(mapping)).ros}
    except UsageError:
        return set()  # reading the drive reports it


def _channel_key(container: Container | Summary, channel: records.Channel) -> tuple[str, str, str, str]:
    """Return topic, schema, encoding and the schema's encoding; channels with the same key are counted together."""
    schema = container.schemas.get(channel.schema_id)
    return channel.topic, schema.name if schema else "", channel.message_encoding, schema.encoding if schema else ""


def _channel(
    key: tuple[str, str, str, str], count: _ChannelCount, roles: dict[tuple[str, str], str], mapped: set[str]
) -> Channel:
    topic, schema, encoding, schema_encoding = key
    span_s = (count.last_ns - count.first_ns) / 1e9
    return Channel(
        topic=topic,
        schema=schema or None,
        schema_encoding=schema_encoding if schema else None,
        encoding=encoding,
        messages=count.messages,
        bytes=count.size,
        rate_hz=(count.messages - 1) / span_s if span_s > 0 else None,
        read_as=("actors, by the mapping" if topic in mapped else roles.get((message_kind(schema), encoding)))
        or ("pictures" if has_pictures(topic, schema, encoding) else None),
    )


def _message_roles(path: Path) -> dict[tuple[str, str], str]:
    """Return (schema, encoding) -> how messages are read; if a log has several message families, only the best is read."""
    try:
        return _ROLES_BY_FAMILY[bag.message_family(path)]
    except TraceError:
        return _ROLES_BY_FAMILY["osi"]
