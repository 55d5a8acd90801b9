"""Logs with one fault each: what spoils the sound drive's frames, and what spoils the file that was written."""

from __future__ import annotations

import math
import struct
from typing import TYPE_CHECKING, Final, NamedTuple

import pyarrow.parquet as pq
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

from tests.faults.drives import WRITERS, Car, Frame, N, drive, table
from tests.formats.mcap.damage import CHUNK, FOOTER, STATISTICS, places, replaced, with_index_crc

if TYPE_CHECKING:
    from collections.abc import Callable, Collection
    from pathlib import Path

    Spoil = Callable[[list[Frame]], list[Frame]]
    Damage = Callable[[bytes], bytes]


class BadLog(NamedTuple):
    """A log with a fault: what comes of a check of it.

    `verdicts`: those of the two other cars, if the log is judged. `frames` spoils the drive, `damage` the bytes of the file or of the
    bag's second one, `rewrite` the file as a whole.
    """

    fault: int
    format: str
    exit_code: int
    phrase: str
    damage: Damage | None = None
    frames: Spoil | None = None
    rewrite: Callable[[Path], None] | None = None
    verdicts: Collection[str] = ("pass",)

    def write(self, folder: Path, name: str = "bad") -> Path:
        """Write the log into a folder."""
        frames = drive() if self.frames is None else self.frames(drive())
        path = WRITERS[self.format](folder / name, frames)
        if self.damage:
            file = path / ("b.mcap" if self.format == "bag" else "actor_state.parquet") if path.is_dir() else path
            file.write_bytes(self.damage(file.read_bytes()))
        if self.rewrite:
            self.rewrite(path)
        return path


def each_car(change: Callable[[int, Car], Car]) -> Spoil:
    """Return what changes each car at each frame."""
    return lambda frames: [
        frame._replace(cars=[change(i, car) for car in frame.cars]) for i, frame in enumerate(frames)
    ]


def late(frames: list[Frame]) -> list[Frame]:
    return [*frames[:20], frames[21], frames[20], *frames[22:]]


def again(frames: list[Frame]) -> list[Frame]:
    """Return the drive and behind it another over the same time."""
    return [*frames, *each_car(lambda _, car: car._replace(x=car.x + 300.0))(frames)]


def gap(frames: list[Frame]) -> list[Frame]:
    return [frame._replace(t_s=frame.t_s + 5.0) if i >= N // 2 else frame for i, frame in enumerate(frames)]


def twice(frames: list[Frame]) -> list[Frame]:
    """Return the drive with car 1 in two places at one time."""
    frame = frames[10]
    return [*frames[:10], frame._replace(cars=[*frame.cars, frame.cars[1]._replace(y=60.0)]), *frames[11:]]


def of_car_1(x: float) -> Spoil:
    return each_car(lambda i, car: car._replace(x=x) if car.name == "1" and i in {10, 11} else car)


def no_footer(data: bytes) -> bytes:
    return data[: places(data, FOOTER)[0][0]]


def last_chunk_changed(data: bytes) -> bytes:
    return replaced(data, places(data, CHUNK)[-1][0] + 9 + 24, b"\1\2\3\4")


def more_counted(data: bytes) -> bytes:
    ((at, _),) = places(data, STATISTICS)
    (n,) = struct.unpack_from("<Q", data, at + 9)
    return with_index_crc(replaced(data, at + 9, struct.pack("<Q", n + 3)))


def index_changed(data: bytes) -> bytes:
    return replaced(data, places(data, FOOTER)[0][1] - 4, b"\1\2\3\4")


def footer_beyond(data: bytes) -> bytes:
    return replaced(data, places(data, FOOTER)[0][0] + 9, struct.pack("<QQ", 2**50, 2**50))


def second_frame_garbled(data: bytes) -> bytes:
    """Return an OSI file whose second message is no protobuf."""
    start = 4 + int.from_bytes(data[:4], "little") + 4
    return replaced(data, start, b"\xff" * 12)


def line_garbled(data: bytes) -> bytes:
    lines = data.split(b"\n")
    return b"\n".join([*lines[:31], b"oops", *lines[32:]])


def row_without_time(path: Path) -> None:
    rows = table(drive()).to_pylist()
    rows[31]["t_ns"] = None
    pq.write_table(table(drive()).from_pylist(rows), path)


def message_garbled(content: bytes) -> Callable[[Path], None]:
    """Return what gives an MCAP file other content in one message."""

    def rewrite(path: Path) -> None:
        messages = []
        with path.open("rb") as file:
            messages += list(make_reader(file).iter_messages())
        with path.open("wb") as file:
            writer = Writer(file, compression=CompressionType.NONE)
            writer.start()
            channels: dict[str, int] = {}
            for k, (schema, channel, message) in enumerate(messages):
                if channel.topic not in channels:
                    assert schema is not None
                    number = writer.register_schema(schema.name, schema.encoding, schema.data)
                    channels[channel.topic] = writer.register_channel(channel.topic, channel.message_encoding, number)
                data = content if k == 10 else message.data
                writer.add_message(channels[channel.topic], message.log_time, data, message.publish_time)
            writer.finish()  # type: ignore[no-untyped-call]

    return rewrite


def second_file(format_: str) -> Callable[[Path], None]:
    """Return what puts the file of another drive behind one."""

    def rewrite(path: Path) -> None:
        other = WRITERS[format_](path.parent / "other", each_car(lambda _, car: car._replace(x=car.x + 300.0))(drive()))
        path.write_bytes(path.read_bytes() + other.read_bytes())

    return rewrite


def _html(_: bytes) -> bytes:
    return b"<html>404 Not Found</html>"


def _half(data: bytes) -> bytes:
    return data[: len(data) // 2 + 7]


def _half_zero(data: bytes) -> bytes:
    return _half(data) + bytes(len(data) // 2)


def _longer(data: bytes) -> bytes:
    return data + b"more"


_IS_LOST: Final = ("pass", "unknown")
_UNKNOWN: Final = ("pass", "unknown")
"""Car 1 is unknown, car 2 is not concerned."""
_DEGREES: Final = each_car(lambda _, car: car._replace(yaw=34.0))
_CENTIMETRES: Final = each_car(lambda _, car: car._replace(x=100.0 * car.x, y=100.0 * car.y))

BAD_LOGS: Final = (
    BadLog(1, "bag", 4, "b.mcap, a part of this bag, is empty", lambda _: b""),
    BadLog(1, "canonical", 4, "it is empty (0 bytes)", lambda _: b""),
    BadLog(1, "csv", 4, "the file is empty (0 bytes)", lambda _: b""),
    BadLog(2, "bag", 4, "begins with b'<html>404", _html),
    BadLog(2, "canonical", 4, "it begins b'<html>404", _html),
    BadLog(2, "csv", 4, "begins with b'<html>404", _html),
    BadLog(3, "osi-file", 3, "to the end is lost", _half),
    BadLog(3, "foxglove", 4, "at byte 42: the log is damaged or cut off", _half),
    BadLog(3, "ros", 3, "to the end is lost", _half),
    BadLog(3, "bag", 3, "b.mcap: ", _half),
    BadLog(3, "parquet", 4, "not readable as Parquet", _half),
    BadLog(3, "csv", 3, "line 62: the number of cells differs from the 7 cells", _half, verdicts=_IS_LOST),
    BadLog(4, "bag", 0, "nothing is lost", no_footer),
    BadLog(5, "osi-file", 3, "to the end is lost", _half_zero),
    BadLog(5, "bag", 3, "no record (zero bytes)", _half_zero),
    BadLog(5, "csv", 3, "zero bytes from byte", _half_zero, verdicts=_IS_LOST),
    BadLog(6, "foxglove", 4, "a chunk with a wrong CRC (its content changed) at byte 42: the log", last_chunk_changed),
    BadLog(6, "bag", 3, "wrong CRC", last_chunk_changed),
    BadLog(7, "csv", 0, "damage may remain undetected"),
    BadLog(7, "parquet", 0, "damage may remain undetected"),
    BadLog(8, "bag", 3, "the index counts 23 messages, the file has 20", more_counted),
    BadLog(9, "bag", 0, "the index has a wrong CRC", index_changed),
    BadLog(10, "osi-mcap", 0, "the index has a wrong CRC", footer_beyond),
    BadLog(11, "bag", 4, "b.mcap: a second MCAP file begins at byte", lambda data: data + data),
    BadLog(11, "parquet", 4, "a second Parquet file begins at byte", rewrite=second_file("parquet")),
    BadLog(11, "canonical", 4, "a second Parquet file begins at byte", lambda data: data + data),
    BadLog(11, "osi-file", 3, "repeats the same time", rewrite=second_file("osi-file"), verdicts=("unknown",)),
    BadLog(11, "csv", 3, "repeats the same time", rewrite=second_file("csv"), verdicts=("unknown",)),
    BadLog(12, "foxglove", 0, "4 bytes follow the end of the log", _longer),
    BadLog(12, "osi-file", 3, "10 bytes from byte", lambda data: data + b"more bytes", verdicts=_IS_LOST),
    BadLog(12, "parquet", 4, "not readable as Parquet", _longer),
    BadLog(12, "csv", 3, "line 122: the number of cells differs from the 7 cells", _longer, verdicts=_IS_LOST),
    BadLog(17, "osi-file", 3, "bytes from byte 341 on", second_frame_garbled, verdicts=_IS_LOST),
    BadLog(17, "foxglove", 3, "log time 1000000000 ns", rewrite=message_garbled(b"\xff" * 40), verdicts=_IS_LOST),
    BadLog(17, "foxglove-json", 3, "log time 1000000000 ns", rewrite=message_garbled(b"{no"), verdicts=_IS_LOST),
    BadLog(17, "ros", 3, "log time 1000000000 ns", rewrite=message_garbled(b"\0\1\0\0\xff"), verdicts=_IS_LOST),
    BadLog(17, "csv", 3, "line 32: the number of cells differs from the 7 cells", line_garbled, verdicts=_IS_LOST),
    BadLog(17, "parquet", 3, "rows without actor or time: 1", rewrite=row_without_time, verdicts=_IS_LOST),
    BadLog(18, "foxglove", 0, "backward steps of the clock of /scene: 1, the first to 2 s", frames=late),
    BadLog(18, "ros", 0, "backward steps of the clock of /carla/objects: 1, the first to 2 s", frames=late),
    BadLog(18, "osi-file", 0, "backward steps of the clock: 1, the first to 2 s", frames=late),
    BadLog(18, "foxglove", 3, "repeats the same time", frames=again, verdicts=("unknown",)),
    BadLog(18, "parquet", 3, "repeats the same time", frames=again, verdicts=("unknown",)),
    BadLog(19, "foxglove", 3, "the longest 5.1 s, the first from 1.9 s", frames=gap, verdicts=_IS_LOST),
    BadLog(19, "csv", 3, "the longest 5.1 s, the first from 1.9 s", frames=gap, verdicts=_IS_LOST),
    BadLog(20, "osi-file", 3, "in 1 states (1), which differ", frames=twice, verdicts=_UNKNOWN),
    BadLog(20, "foxglove", 3, "in 1 states (1), which differ", frames=twice, verdicts=_UNKNOWN),
    BadLog(20, "parquet", 3, "in 1 states (1), which differ", frames=twice, verdicts=_UNKNOWN),
    BadLog(21, "foxglove", 0, "2 of 120 states (1)", frames=of_car_1(math.nan), verdicts=_UNKNOWN),
    BadLog(21, "foxglove-json", 0, "2 of 120 states (1)", frames=of_car_1(math.nan), verdicts=_UNKNOWN),
    BadLog(21, "ros", 0, "2 of 120 states (1)", frames=of_car_1(math.inf), verdicts=_UNKNOWN),
    BadLog(21, "canonical", 0, "NaN or infinity in 2 of 120", frames=of_car_1(math.nan), verdicts=_UNKNOWN),
    BadLog(21, "csv", 0, "NaN or infinity in 2 of 120", frames=of_car_1(math.inf), verdicts=_UNKNOWN),
    BadLog(22, "osi-file", 4, "of the heading is wrong", frames=_DEGREES),
    BadLog(22, "csv", 4, "which is not an angle in radians", frames=_DEGREES),
    BadLog(22, "osi-file", 4, "speed is beyond 150 m/s", frames=_CENTIMETRES),
    BadLog(22, "canonical", 4, "speed is beyond 150 m/s", frames=_CENTIMETRES),
    BadLog(22, "csv", 4, "the unit of position, speed or time is wrong", frames=_CENTIMETRES),
)  # fmt: skip
"""What is shown by a log of one format; what another test shows of MCAP with OSI is not shown again."""
