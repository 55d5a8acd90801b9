"""Annotating a large log: how fast its bytes are copied, and whether they stay what they were."""

from __future__ import annotations

import hashlib
import os
import random
import shutil
from functools import partial
from typing import TYPE_CHECKING

from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

from tests.bench import stages, traffic
from tests.bench.clock import by_stage, repeat
from tests.bench.table import Bar, Row
from tests.formats.osi import osi_log

if TYPE_CHECKING:
    from pathlib import Path

    from tests.bench.place import Place

PICTURE = 250_000


def copying(place: Place) -> list[Row]:
    """Measure the annotated log of a log that is mostly camera pictures."""
    log = _log(place)
    size = log.stat().st_size / 1e6
    out = place.home / "copied"
    runs = place.sizes.slow_runs
    # `check` reads and judges the log too: only the annotation counts here
    taken = by_stage(partial(stages.check, [str(log)], place.road, out), runs)["annotate"]
    (annotated,) = (out / "annotated").glob("*.mcap")
    topics, told = _topics_and_hash(log)
    if _topics_and_hash(annotated, topics)[1] != told:
        raise AssertionError(f"{annotated}: the messages of the original are not what they were")
    plain = repeat(partial(_copy, log, place.home / "plain.mcap"), runs)
    note = f"{size:.0f} MB, checked with CRCs by the stock reader: messages identical; median of {runs}"
    rows = [
        Row(
            "annotated log",
            "copied with verdicts",
            size / taken.wall,
            "MB/s",
            cpu=taken.cpu,
            bar=Bar(200.0, at_least=True),
            note=note,
        ),
        Row(
            "annotated log", "a plain copy, for comparison", size / plain.wall, "MB/s", cpu=plain.cpu, note="with fsync"
        ),
    ]
    log.unlink()
    shutil.rmtree(out)
    return rows


def _log(place: Place) -> Path:
    """Write the states of a short drive with pictures beside them, in chunks of 4 MB as recorders do."""
    path = place.home / "large.mcap"
    drive = traffic.write_osi(place.home / "small.mcap", place.sizes.short)
    noise = random.Random(0)  # noqa: S311 - pictures do not compress, nor does this
    with drive.open("rb") as small, path.open("wb") as file:
        writer = Writer(file, compression=CompressionType.NONE, chunk_size=4 << 20)
        writer.start()
        truth = writer.register_channel(
            "ground_truth", "protobuf", writer.register_schema("osi3.GroundTruth", "protobuf", osi_log.DESCRIPTOR_SET)
        )
        camera = writer.register_channel("camera", "raw", 0)
        messages = [message for _, _, message in make_reader(small).iter_messages()]
        each = max(1, round(place.sizes.megabytes * 1e6 / PICTURE / len(messages)))
        for message in messages:
            writer.add_message(truth, message.log_time, message.data, message.publish_time)
            for _ in range(each):
                writer.add_message(camera, message.log_time, noise.randbytes(PICTURE), message.log_time)
        writer.finish()  # type: ignore[no-untyped-call]
    return path


def _topics_and_hash(path: Path, only: frozenset[str] | None = None) -> tuple[frozenset[str], str]:
    """Return the topics of a log, and a hash of every message on them (on `only`, if given) in the order of the file."""
    digest = hashlib.sha256()
    topics = set()
    with path.open("rb") as file:
        for _, channel, m in make_reader(file, validate_crcs=True).iter_messages(only, log_time_order=False):
            topics.add(channel.topic)
            digest.update(f"{channel.topic} {m.log_time} {m.publish_time} {m.sequence} {len(m.data)}\n".encode())
            digest.update(m.data)
    return frozenset(topics), digest.hexdigest()


def _copy(source: Path, target: Path) -> None:
    with source.open("rb") as read, target.open("wb") as write:
        shutil.copyfileobj(read, write, 4 << 20)
        write.flush()
        os.fsync(write.fileno())
