"""Writes a trace as an MCAP log of ASAM OSI ground truth, with drivelint's metadata records and declared events."""

from __future__ import annotations

from typing import TYPE_CHECKING, BinaryIO, Final

import msgspec
import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
from mcap.writer import CompressionType, Writer

from drivelint.arrays import floats
from drivelint.drive.trace import ACTOR_CLASSES, BRAKE_LIGHTS, INDICATORS, SIZE_COLUMNS, STATE_COLUMNS
from drivelint.formats.osi import metadata
from drivelint.formats.osi.encode import encode_ground_truths, encode_traffic_light, moving_objects
from drivelint.formats.osi.schema import GROUND_TRUTH, OPEN_DRIVE, WRITTEN_OSI_VERSION, descriptor_set
from drivelint.formats.protobuf.wire import nested

if TYPE_CHECKING:
    from collections.abc import Iterator

    from drivelint.arrays import Codes
    from drivelint.drive.trace import Trace
    from drivelint.road.map_reader import MapSource

GROUND_TRUTH_TOPIC: Final = "ground_truth"
MAP_TOPIC: Final = "ground_truth_map"
EVENT_TOPIC: Final = "declared_event"
STATES_PER_BATCH: Final = 200_000
"""This many states, in whole frames, are encoded at a time, which bounds the memory."""
_MAX_OSI_ID: Final = (1 << 64) - 1


def write_and_count_messages(
    sink: BinaryIO, trace: Trace, map_source: MapSource | None, *, as_recorded: bool = False
) -> int:
    """Write the log, and return the number of ground-truth messages: one per time of any actor or signal, and per empty frame.

    The same trace and map give the same bytes. `map_source` must be UTF-8, as OSI's text fields are. A vector with an unknown x or y is
    left out as a whole.
    """
    osi_ids = assign_osi_ids(trace.tables["actor"]["actor_id"].to_pylist())
    writer = Writer(sink, compression=CompressionType.ZSTD, enable_crcs=True, enable_data_crcs=True)
    writer.start(library=metadata.CONVERTED_LOG_LIBRARY)
    version = ".".join(map(str, WRITTEN_OSI_VERSION))
    bounds = dict.fromkeys(("version", "min_osi_version", "max_osi_version"), version)
    writer.add_metadata("net.asam.osi.trace", {**bounds, "description": trace.path.name})
    for name, content in metadata.metadata_records(trace, osi_ids, as_recorded=as_recorded).items():
        writer.add_metadata(name, content)
    described = {"net.asam.osi.trace.channel.osi_version": version}
    truth = writer.register_channel(
        GROUND_TRUTH_TOPIC, "protobuf", writer.register_schema(GROUND_TRUTH, "protobuf", descriptor_set()), described
    )
    times = [pc.min(trace.tables[name]["t_ns"]).as_py() for name in ("actor_state", "signal_state", "declared_event")]
    earliest = int(min(t for t in (*times, *trace.times_without_actors_ns.tolist()) if t is not None))
    if map_source is not None:
        schema = writer.register_schema(OPEN_DRIVE, "protobuf", descriptor_set())
        channel = writer.register_channel(MAP_TOPIC, "protobuf", schema, described)
        message = nested(1, map_source.name.encode()) + nested(2, map_source.content)
        writer.add_message(channel, max(earliest, 0), message, max(earliest, 0))
    shift_ns = min(earliest, 0)  # log times are unsigned, while times of states may be negative
    count = 0
    for t_ns, message in _frame_messages(trace, osi_ids):
        writer.add_message(truth, t_ns - shift_ns, message, t_ns - shift_ns)
        count += 1
    _write_events(writer, trace, shift_ns)
    writer.finish()  # type: ignore[no-untyped-call]
    return count


def assign_osi_ids(actors: list[str]) -> dict[str, int]:
    """Return actor id -> OSI id: the same number if all ids are numbers, otherwise 1, 2, ... in the order of the sorted ids."""
    if all(
        name.isascii() and name.isdigit() and str(int(name)) == name and int(name) <= _MAX_OSI_ID for name in actors
    ):
        return {name: int(name) for name in actors}
    return {name: number for number, name in enumerate(sorted(actors), 1)}


def _frame_messages(trace: Trace, osi_ids: dict[str, int]) -> Iterator[tuple[int, bytes]]:
    """Yield time and message of every frame, in the order of time; in the log's order if its clock restarts."""
    states = trace.tables["actor_state"]
    t_ns = states["t_ns"].to_numpy()
    lights = _encoded_lights_by_time(trace.tables["signal_state"])
    actorless_ns = np.concatenate([np.fromiter(lights, np.int64, len(lights)), trace.times_without_actors_ns])
    if trace.in_log_order:
        order = np.arange(len(t_ns))
        starts = np.flatnonzero(np.r_[True, np.diff(t_ns) != 0])
        actorless_ns = np.setdiff1d(actorless_ns, t_ns)
        times = np.r_[t_ns[starts], actorless_ns]
        bounds = np.r_[starts, np.full(len(actorless_ns) + 1, len(t_ns))]
    else:
        order = np.argsort(t_ns, kind="stable")  # a stable sort keeps the table's order of actors within a frame
        times = np.unique(np.concatenate([t_ns, actorless_ns]))
        bounds = np.append(np.searchsorted(t_ns[order], times), len(order))
    objects = _objects_of_states(trace, osi_ids)
    egos = [osi_ids[row["actor_id"]] for row in trace.tables["actor"].to_pylist() if row["is_ego"]]
    host = min(egos, key=str, default=None)
    begin = 0
    while begin < len(times):
        end = max(int(np.searchsorted(bounds, bounds[begin] + STATES_PER_BATCH, side="right")) - 1, begin + 1)
        starts = bounds[begin : end + 1]
        some = objects.take(pa.array(order[starts[0] : starts[-1]]))
        messages = encode_ground_truths(times[begin:end], host, some, starts - starts[0]).to_pylist()
        for t, message in zip(times[begin:end].tolist(), messages, strict=True):
            yield t, b"".join((message, *lights.pop(t, ())))
        begin = end


def _objects_of_states(trace: Trace, osi_ids: dict[str, int]) -> pa.StructArray:
    states, actors = trace.tables["actor_state"], trace.tables["actor"]
    row = pc.index_in(states["actor_id"], value_set=actors["actor_id"].combine_chunks()).to_numpy()
    ids = np.array([osi_ids[name] for name in actors["actor_id"].to_pylist()], np.uint64)
    columns = {name: floats(states[name]) for name in STATE_COLUMNS}
    columns |= {name: floats(actors[name])[row] for name in SIZE_COLUMNS}
    codes = {
        "actor_class": _codes_of_words(actors["actor_class"], ACTOR_CLASSES)[row],
        "indicator": _codes_of_words(states["indicator"], INDICATORS),
        "brake_light": _codes_of_words(states["brake_light"], BRAKE_LIGHTS),
    }
    return moving_objects(ids[row], columns, codes, log_has_heights=not bool(np.isnan(columns["z_m"]).all()))


def _codes_of_words(column: pa.ChunkedArray, words: tuple[str, ...]) -> Codes:
    codes = pc.index_in(column, value_set=pa.array(words, pa.string()))
    return np.asarray(pc.fill_null(codes, -1).to_numpy(), np.int8)


def _encoded_lights_by_time(signals: pa.Table) -> dict[int, list[bytes]]:
    """Return time -> the encoded traffic lights of that frame."""
    place = {name: 2 * k + 1 for k, name in enumerate(sorted(set(signals["signal_id"].to_pylist())))}
    t_ns, *columns = (signals[name].to_pylist() for name in ("t_ns", "signal_id", "state"))
    lights = list(zip(*columns, strict=True))
    encoded = {
        (name, state): encode_traffic_light(name, state, (place[name], place[name] + 1)) for name, state in set(lights)
    }
    frames: dict[int, list[bytes]] = {}
    for t, light in zip(t_ns, lights, strict=True):
        frames.setdefault(t, []).append(encoded[light])
    return frames


def _write_events(writer: Writer, trace: Trace, shift_ns: int) -> None:
    rows = trace.tables["declared_event"].drop_columns("drive_id").to_pylist()
    if not rows:
        return
    schema = writer.register_schema(metadata.EVENT_MESSAGE, "jsonschema", metadata.EVENT_SCHEMA)
    channel = writer.register_channel(EVENT_TOPIC, "json", schema)
    for row in rows:
        writer.add_message(channel, row["t_ns"] - shift_ns, msgspec.json.encode(row), row["t_ns"] - shift_ns)
