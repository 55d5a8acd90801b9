"""Writes a scene as ASAM OSI ground truth in MCAP, as a simulator would: chunked, compressed, with checksums, no clock."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Final

import numpy as np
from mcap.writer import CompressionType, Writer

from drivelint.demo.opendrive import MAKER
from drivelint.demo.states import HOST_ID, states
from drivelint.drive.trace import SIZE_COLUMNS, STATE_COLUMNS
from drivelint.formats.osi.encode import Objects, ground_truth_head, moving_objects
from drivelint.formats.osi.schema import GROUND_TRUTH, VERSION, descriptor_set

if TYPE_CHECKING:
    from collections.abc import Iterator

    from drivelint.demo.scene import Scene

TOPIC: Final = "ground_truth"


def osi_mcap(scene: Scene) -> bytes:
    """Return the scene's log: one `osi3.GroundTruth` per sample, log time = sample time, the same bytes every time."""
    sink = io.BytesIO()
    writer = Writer(sink, compression=CompressionType.ZSTD, enable_crcs=True, enable_data_crcs=True)
    writer.start(library=MAKER)
    version = ".".join(map(str, VERSION))
    schema = writer.register_schema(GROUND_TRUTH, "protobuf", descriptor_set())
    channel = writer.register_channel(TOPIC, "protobuf", schema, {"net.asam.osi.trace.channel.osi_version": version})
    bounds = dict.fromkeys(("version", "min_osi_version", "max_osi_version"), version)
    writer.add_metadata("net.asam.osi.trace", {**bounds, "description": scene.shows})
    for t_ns, message in _frames(scene):
        writer.add_message(channel, t_ns, message, t_ns)
    writer.finish()  # type: ignore[no-untyped-call]
    return sink.getvalue()


def _frames(scene: Scene) -> Iterator[tuple[int, bytes]]:
    """Yield time and message of every sample."""
    said = states(scene)
    actors, n = len(said.ids), len(said) // len(said.ids)
    by_frame = (np.arange(n)[:, None] + n * np.arange(actors)).ravel()
    unknown = np.full(len(said), np.nan)
    objects = Objects(
        said.actor[by_frame].astype(np.uint64) + np.uint64(HOST_ID),
        {name: said.numbers.get(name, unknown)[by_frame] for name in (*STATE_COLUMNS, *SIZE_COLUMNS)},
        {name: codes[by_frame] for name, codes in said.codes.items()},
        heights=True,
    )
    data, starts = moving_objects(objects)
    content = data.tobytes()
    for k in range(n):
        t_ns = int(said.t_ns[k])
        yield t_ns, ground_truth_head(t_ns, HOST_ID) + content[starts[k * actors] : starts[(k + 1) * actors]]
