"""The order of messages in a log, and of actors in a message, changes no table."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
from mcap.reader import make_reader
from mcap.writer import Writer

from drivelint.drive.trace import IngestOptions
from drivelint.formats import read_trace
from drivelint.formats.osi.schema import GROUND_TRUTH, descriptor_set
from tests.formats.sumo.fcd_text import ROWS, TYPES, csv, xml
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    import pyarrow as pa

FIXTURES = ROOT / "fixtures" / "scenes"


def tables(path: Path, **options: Any) -> dict[str, pa.Table]:
    """Return what is read, without what only the file's own bytes say."""
    trace = read_trace(path, IngestOptions(**options))
    return {
        name: table.drop([c for c in ("drive_id", "sha256", "file_name") if c in table.schema.names])
        for name, table in trace.tables.items()
    }


def shuffled(content: bytes, random: np.random.Generator) -> bytes:
    """Return an OSI log in MCAP with its messages, and the actors in each, in another order."""
    pool = descriptor_pool.DescriptorPool()
    for file in descriptor_pb2.FileDescriptorSet.FromString(descriptor_set()).file:
        pool.Add(file)
    truth: Any = message_factory.GetMessageClass(pool.FindMessageTypeByName(GROUND_TRUTH))
    found = [(c.topic, m.log_time, m.data) for _, c, m in make_reader(io.BytesIO(content)).iter_messages()]
    sink = io.BytesIO()
    writer = Writer(sink)
    writer.start()
    schema = writer.register_schema(GROUND_TRUTH, "protobuf", descriptor_set())
    channel = writer.register_channel(found[0][0], "protobuf", schema)
    for k in random.permutation(len(found)):
        _, time, data = found[k]
        frame = truth.FromString(data)
        actors = list(frame.moving_object)
        del frame.moving_object[:]
        frame.moving_object.extend(actors[n] for n in random.permutation(len(actors)))
        writer.add_message(channel, time, frame.SerializeToString(), time)
    writer.finish()  # type: ignore[no-untyped-call]
    return sink.getvalue()


@pytest.mark.parametrize("name", ["near-miss", "signal-late", "overtake-two-in-one-go"])
def test_messages_and_actors_of_an_osi_log(name: str, tmp_path: Path) -> None:
    log = FIXTURES / f"{name}.mcap"
    other = tmp_path / f"{name}.mcap"
    other.write_bytes(shuffled(log.read_bytes(), np.random.default_rng(1)))
    before, after = tables(log), tables(other)
    assert before["actor_state"].num_rows > 100
    # that the clock goes back is said, and all that it changes
    assert "backward steps of the clock" in after.pop("quality")["message"][0].as_py()
    assert before.pop("quality").num_rows == 0
    assert before == after


@pytest.mark.parametrize("seed", range(3))
def test_rows_of_sumo_s_logs(seed: int, tmp_path: Path) -> None:
    (tmp_path / "r.rou.xml").write_text(TYPES, "utf-8")
    rows = [ROWS[k] for k in np.random.default_rng(seed).permutation(len(ROWS))]
    read = []
    for name, text in (("a.csv", csv(ROWS)), ("b.csv", csv(rows)), ("c.xml", xml(ROWS)), ("d.xml", xml(rows))):
        (tmp_path / name).write_text(text, "utf-8")
        read.append(tables(tmp_path / name, ego="a.0"))
    assert read[0] == read[1] == read[2] == read[3]
