"""Damaged traces: read, and held against the tables of the whole file."""

from __future__ import annotations

import io
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from mcap.records import Channel, Message, Schema
from mcap.stream_reader import StreamReader
from mcap.writer import CompressionType, Writer

from drivelint.drive.trace import LOSS_CHECKS, IngestOptions, Trace
from drivelint.formats import read_trace
from tests.fuzz import sources
from tests.fuzz.mutations import BINARY, EXTREMES, NUMBERS, TEXT, XML, mutated
from tests.fuzz.outcome import of_error

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path
    from random import Random

    from tests.fuzz.sources import Source

    Changed = dict[str, bytes]

_TEXT_SUFFIXES: Final = (".csv", ".yaml", ".toml")
_XML_SUFFIXES: Final = (".xml", ".xodr")
_OF_THE_FILE: Final = ("file_name", "sha256")


def content_of(trace: Trace) -> tuple[Any, ...]:
    """Return all that a trace says of its drive, but for the name and hash of its file and what is wrong with it."""
    tables = {
        name: table.drop_columns([c for c in ("drive_id", *_OF_THE_FILE) if c in table.schema.names])
        for name, table in trace.tables.items()
        if name != "quality"
    }
    return tables, trace.embedded_map, trace.map_offset, trace.geo_reference, trace.geo_offset


def read(path: Path, source: Source) -> Trace:
    """Read a trace with the options of its source."""
    return read_trace(path, IngestOptions(**source.options))


@dataclass
class DamagedTrace:
    """A damaged trace that was read: where it lies, what was found."""

    path: Path
    source: Source
    is_lossy: bool
    is_unprotected: bool


def read_case(
    path: Path, source: Source, whole: tuple[Any, ...], *, rewritten: bool
) -> tuple[str, str, DamagedTrace | None]:
    """Read a damaged trace; return the outcome, its detail, and the trace where it is to be judged.

    `rewritten`: the content was changed and new checksums were made: it is another drive.
    """
    try:
        trace = read(path, source)
    except (KeyboardInterrupt, SystemExit):
        raise
    except BaseException as error:  # noqa: BLE001 - a panic of a compiled library is no Exception
        return *of_error(error), None
    findings = trace.tables["quality"].to_pylist()
    lossy = any(row["severity"] == "error" or row["check_id"] in LOSS_CHECKS for row in findings)
    unprotected = any(row["check_id"] == "unprotected" for row in findings)
    if content_of(trace) == whole:
        return "same", "", None
    found = DamagedTrace(path, source, lossy, unprotected)
    if lossy:
        return "lossy", "", found
    if unprotected or rewritten:
        return "unprotected", "", found
    return ("silent" if source.protected else "unsaid"), _difference(content_of(trace), whole), found


def _difference(content: tuple[Any, ...], whole: tuple[Any, ...]) -> str:
    names = [name for name, table in content[0].items() if table != whole[0][name]]
    others = [i for i, (a, b) in enumerate(zip(content[1:], whole[1:], strict=True)) if a != b]
    return f"tables {names}, others {others}"


def damaged(source: Source, rng: Random) -> Changed:
    """Damage one file of a source."""
    name = rng.choice(sorted(source.files))
    ways = XML if name.endswith(_XML_SUFFIXES) else TEXT if name.endswith(_TEXT_SUFFIXES) else BINARY
    return {name: mutated(source.files[name], rng, ways)}


def with_other_messages(source: Source, rng: Random) -> Changed:
    """Change messages, a schema or a channel of an MCAP file, and write it anew with right checksums: a recorder's mistake."""
    name = rng.choice(sorted(name for name in source.files if name.endswith(".mcap")))
    records = list(StreamReader(io.BytesIO(source.files[name])).records)
    messages = [i for i, record in enumerate(records) if isinstance(record, Message)]
    others = [i for i, record in enumerate(records) if isinstance(record, Schema | Channel)]
    chosen = set(rng.sample(messages, min(len(messages), rng.choice((1, 1, 3, 20)))))
    if rng.random() < 0.15:
        chosen = {rng.choice(others)}
    sink = io.BytesIO()
    writer = Writer(sink, compression=CompressionType.NONE, chunk_size=sources.CHUNK_BYTES)
    writer.start()
    schemas: dict[int, int] = {}
    channels: dict[int, int] = {}
    for i, record in enumerate(records):
        change = i in chosen
        if isinstance(record, Schema) and record.id not in schemas:
            data = mutated(record.data, rng, (*BINARY, *TEXT)) if change else record.data
            schemas[record.id] = writer.register_schema(record.name, record.encoding, data)
        elif isinstance(record, Channel) and record.id not in channels:
            topic = mutated(record.topic.encode(), rng, TEXT).decode(errors="replace") if change else record.topic
            encoding = rng.choice(("json", "protobuf", "cdr", "")) if change else record.message_encoding
            channels[record.id] = writer.register_channel(
                topic, encoding, schemas.get(record.schema_id, 0), record.metadata
            )
        elif isinstance(record, Message):
            data = _other_message(record.data, rng) if change else record.data
            time = rng.choice((0, 2**63, 2**64 - 1)) if change and rng.random() < 0.1 else record.log_time
            writer.add_message(channels[record.channel_id], time, data, record.publish_time)
    writer.finish()  # type: ignore[no-untyped-call]
    return {name: sink.getvalue()}


def _other_message(data: bytes, rng: Random) -> bytes:
    return mutated(data, rng, TEXT if data[:1] == b"{" else BINARY)


def with_other_cells(source: Source, rng: Random) -> Changed:
    """Change cells, columns or rows of a Parquet file, and write it anew."""
    name = rng.choice(sorted(name for name in source.files if name.endswith(".parquet")))
    table = pq.read_table(io.BytesIO(source.files[name]))
    for _ in range(rng.choice((1, 1, 2, 4))):
        table = rng.choice(TABLE_CHANGES)(table, rng)
    sink = io.BytesIO()
    pq.write_table(table, sink)
    return {name: sink.getvalue()}


def _set_cells(table: pa.Table, rng: Random) -> pa.Table:
    if not table.num_rows:
        return table
    i = rng.randrange(table.num_columns)
    column, field = table.column(i), table.schema.field(i)
    values = column.to_pylist()
    for _ in range(rng.choice((1, 3, len(values)))):
        values[rng.randrange(len(values))] = _cell(field.type, rng)
    return table.set_column(i, field.with_nullable(True), pa.array(values, field.type))


def _cell(kind: pa.DataType, rng: Random) -> Any:
    if rng.random() < 0.2:
        return None
    if pa.types.is_floating(kind):
        return rng.choice(EXTREMES)
    if pa.types.is_integer(kind):
        bits = kind.bit_width
        least, most = (
            (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) if pa.types.is_signed_integer(kind) else (0, 2**bits - 1)
        )
        return rng.choice((least, most, 0, 1, least + 1, most // 2))
    if pa.types.is_boolean(kind):
        return rng.random() < 0.5
    if pa.types.is_string(kind) or pa.types.is_large_string(kind):
        return rng.choice((*NUMBERS, "\0", "\x1b[2J", "a" * 10_000, "red", "left", "car", "error"))
    return None


def _set_type(table: pa.Table, rng: Random) -> pa.Table:
    i = rng.randrange(table.num_columns)
    kinds = (
        pa.string(), pa.float32(), pa.int8(), pa.timestamp("us"), pa.duration("s"), pa.bool_(), pa.binary(), pa.decimal128(38, 3),
        pa.list_(pa.float64()), pa.dictionary(pa.int32(), pa.string()), pa.null(), pa.date32(), pa.large_string(), pa.float16(),
    )  # fmt: skip
    kind = rng.choice(kinds)
    try:
        column = table.column(i).cast(kind, safe=False)
    except pa.ArrowException:
        column = pa.nulls(table.num_rows, kind)
    return table.set_column(i, table.schema.field(i).name, column)


def _change_rows(table: pa.Table, rng: Random) -> pa.Table:
    order = np.arange(table.num_rows)
    if not len(order):
        return table
    match rng.randrange(4):
        case 0:
            order = order[: rng.randrange(len(order) + 1)]
        case 1:
            order = np.array([rng.randrange(len(order)) for _ in order])
        case 2:
            order = np.delete(order, rng.randrange(len(order)))
        case _:
            order = order[::-1]
    return table.take(pa.array(order, pa.int64()))


def _change_columns(table: pa.Table, rng: Random) -> pa.Table:
    names = list(table.schema.names)
    i, j = rng.randrange(len(names)), rng.randrange(len(names))
    match rng.randrange(3):
        case 0:
            return table.remove_column(i) if len(names) > 1 else table
        case 1:
            return table.append_column(names[i], table.column(j))
        case _:
            names[i] = rng.choice((names[j], "", "x_m", "T_NS", "\0"))
            return table.rename_columns(names)


TABLE_CHANGES: Final[tuple[Callable[[pa.Table, Random], pa.Table], ...]] = (
    _set_cells, _set_cells, _set_cells, _set_type, _change_rows, _change_columns,
)  # fmt: skip

DAMAGED: Final[dict[str, Callable[[Path], list[Source]]]] = {
    "osi-mcap": sources.osi_mcap,
    "foxglove": sources.foxglove,
    "ros": sources.ros,
    "sqlite": sources.sqlite,
    "osi-file": sources.osi_file,
    "parquet": sources.parquet,
    "csv": sources.csv,
    "xml-trace": sources.xml_traces,
}
"""Kind of trace -> the valid ones."""
