"""The valid files that are damaged: one small drive, in which two cars touch, in every format; small maps; text files of every kind."""

from __future__ import annotations

import io
import shutil
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq
from mcap.reader import make_reader
from mcap.writer import Writer

from drivelint.convert import ConvertRequest, convert
from tests.formats.commonroad import scenario_text
from tests.formats.foxglove import foxglove_log as fox
from tests.formats.logs import LONG, cars
from tests.formats.osi import osi_log
from tests.formats.ros2 import autoware_log, ros_drive, ros_log
from tests.formats.sqlite_bag import sqlite_log
from tests.formats.sumo import fcd_text
from tests.shared_data import ROOT

N_FRAMES = 40
CONTACT_AT = 20
PERIOD_S = 0.1
CHUNK_BYTES = 1500
"""Several messages a chunk, and many chunks a file: damage in one leaves others."""
OVERTAKE = ROOT / "fixtures" / "overtake"
SCENES = ROOT / "fixtures" / "scenes"


@dataclass(frozen=True)
class Source:
    """A valid trace: its files by name, which of them is given to the reader ('': their folder), and with which options.

    `protected`: a checksum covers whatever is read, so that a change must be seen.
    """

    name: str
    files: dict[str, bytes]
    entry: str
    options: dict[str, Any] = field(default_factory=dict)
    protected: bool = False

    def write(self, folder: Path, changes: dict[str, bytes] | None = None) -> Path:
        """Write the files, some of them changed, and return the path that is given to the reader, whose name is the folder's."""
        folder.mkdir(parents=True)
        for name, data in {**self.files, **(changes or {})}.items():
            (folder / self._name(name, folder)).write_bytes(data)
        return folder / self._name(self.entry, folder) if self.entry else folder

    def _name(self, name: str, folder: Path) -> str:
        return f"{folder.name}-{name}" if name == self.entry else name


def _single(path: Path, **more: Any) -> Source:
    options: dict[str, Any] = {key: more.pop(key) for key in ("mapping", "ego") if key in more}
    name = more.pop("name", path.stem)
    return Source(name, {path.name: path.read_bytes()}, path.name, options, **more)


def frames() -> list[Any]:
    """Return the frames of the drive: the car beside the ego comes over until both touch, and goes back."""
    found = osi_log.drive(N_FRAMES)
    for i, truth in enumerate(found):
        other, steps = truth.moving_object[1].base, i - CONTACT_AT
        other.position.y = 0.4 * min(abs(steps), 10)
        other.velocity.y = 0.0 if steps == 0 or abs(steps) > 10 else 4.0 * (1 if steps > 0 else -1)
        light = truth.traffic_light.add()
        light.id.value, light.classification.color, light.classification.mode = 5, 2 + 2 * (i > 9), 3
    return found


def osi_mcap(folder: Path) -> list[Source]:
    """Return OSI in MCAP: as recorders write it, without chunks or CRCs, and as `convert` writes it."""
    truths = osi_log.truths(frames())
    chunked = osi_log.write(folder / "chunked.mcap", truths, chunk_size=600, enable_data_crcs=False)
    one = osi_log.write(folder / "one.mcap", truths)
    flat = osi_log.write(folder / "flat.mcap", truths, use_chunking=False, enable_data_crcs=False)
    bare = osi_log.write(folder / "bare.mcap", truths, chunk_size=900, enable_crcs=False)
    made = convert(
        ConvertRequest(trace=str(chunked), to="mcap", out=folder / "made", map=SCENES / "two-lane-road.xodr")
    )
    return [
        _single(chunked, protected=True),
        _single(one, protected=True),
        _single(flat),
        _single(bare),
        _single(made.path, name="converted", protected=True),
    ]


def osi_file(folder: Path) -> list[Source]:
    """Return the drive as an OSI trace file: messages, each behind its length."""
    messages = [truth.SerializeToString() for truth in frames()]
    path = folder / "trace.osi"
    path.write_bytes(b"".join(len(data).to_bytes(4, "little") + data for data in messages))
    return [_single(path)]


def foxglove(folder: Path) -> list[Source]:
    """Return the drive as Foxglove scenes."""
    messages = [fox.transform(0.0, "map", "world", 1.0)]
    for i, truth in enumerate(frames()):
        t_s = i * PERIOD_S
        places = [(str(k), each.base.position.x, each.base.position.y) for k, each in enumerate(truth.moving_object)]
        messages.append(fox.scene(t_s, *(fox.entity(name, t_s, x, y, life=0.15) for name, x, y in places)))
    return [
        _single(rechunked(fox.write(folder / f"{encoding}.mcap", messages, encoding)), ego="0", protected=True)
        for encoding in ("protobuf", "json")
    ]


def rechunked(path: Path) -> Path:
    """Write an MCAP file anew in small chunks."""
    sink = io.BytesIO()
    writer = Writer(sink, chunk_size=CHUNK_BYTES)
    writer.start()
    schemas: dict[int, int] = {}
    channels: dict[int, int] = {}
    for schema, channel, message in make_reader(io.BytesIO(path.read_bytes())).iter_messages(log_time_order=False):
        assert schema is not None
        if schema.id not in schemas:
            schemas[schema.id] = writer.register_schema(schema.name, schema.encoding, schema.data)
        if channel.id not in channels:
            channels[channel.id] = writer.register_channel(channel.topic, channel.message_encoding, schemas[schema.id])
        writer.add_message(channels[channel.id], message.log_time, message.data, message.publish_time)
    writer.finish()  # type: ignore[no-untyped-call]
    path.write_bytes(sink.getvalue())
    return path


def ros(folder: Path) -> list[Source]:
    """Return a drive of ROS 2 as one file, and as a bag of two files."""
    messages = [
        ros_log.transform(ros_drive.T0, "map", "odom", 1.0),
        ros_log.report("TurnIndicatorsReport", ros_drive.T0, report=2),
        *ros_drive.ego(n=20),
        *ros_drive.road_users()[:20],
        *(ros_log.tracks(t_s, ros_log.track(3, 50.0 + t_s, 9.0, speed=1.0)) for t_s in ros_drive.ticks(20)),
    ]
    messages = sorted((m for m in messages if m[0] != "/perception/objects"), key=lambda message: message[2])
    one = _single(ros_log.write(folder / "ros.mcap", messages), protected=True)
    tracked = [
        *ros_drive.ego(n=20),
        *(ros_log.tracks(t_s, ros_log.track(3, 50.0 + t_s, 9.0, speed=1.0)) for t_s in ros_drive.ticks(20)),
    ]
    autoware = _single(ros_log.write(folder / "autoware.mcap", tracked), protected=True)
    predicted = [
        *autoware_log.parameters(ros_drive.T0, **autoware_log.PARAMETERS),
        *ros_drive.ego(n=20, child="base_link"),
    ]
    for t_s in ros_drive.ticks(20):
        outline = {"type": 2, "footprint": {"points": [ros_log.xyz(1.0, 1.0), ros_log.xyz(), ros_log.xyz(2.0)]}}
        someone = (
            autoware_log.prediction(3, 50.0 + t_s, 9.0, speed=1.0),
            autoware_log.prediction(4, 9.0, 9.0, shape=outline),
        )
        predicted += [autoware_log.predictions(t_s, *someone), autoware_log.lights(t_s, {7: [autoware_log.element(1)]})]
    predictions = _single(autoware_log.write(folder / "predictions.mcap", predicted), protected=True)
    names = ["drive_0.mcap", "drive_1.mcap"]
    half = len(messages) // 2
    parts = (messages[:half], messages[half:])
    files = {name: ros_log.write(folder / name, part).read_bytes() for name, part in zip(names, parts, strict=True)}
    listed = "".join(f"    - {name}\n" for name in names)
    text = f"rosbag2_bagfile_information:\n  version: 9\n  storage_identifier: mcap\n  relative_file_paths:\n{listed}"
    # its description has no checksum, but names files and no data
    return [one, autoware, predictions, Source("bag", {**files, "metadata.yaml": text.encode()}, "")]


def sqlite(folder: Path) -> list[Source]:
    """Return bags of ROS 2 in SQLite: with message definitions and without, in one file and split, and with transforms for odometry."""
    messages = sorted([*ros_drive.ego(n=20), *ros_drive.road_users()[:20]], key=lambda message: message[2])
    moving = [
        ros_log.transform(t_s, "map", "base_link", *ros_drive.along(t_s), yaw=ros_drive.TURN)
        for t_s in ros_drive.ticks(20)
    ]
    one = _single(sqlite_log.write(folder / "sqlite.db3", messages))
    old = _single(sqlite_log.write(folder / "old.db3", [*moving, *ros_drive.road_users()[:20]], definitions=False))
    split = sqlite_log.bag(folder / "split", [messages[:20], messages[20:]])
    return [one, old, Source("split", {file.name: file.read_bytes() for file in sorted(split.iterdir())}, "")]


def parquet(folder: Path) -> list[Source]:
    """Return the drive as `convert` writes it to Parquet, as one table of others, and as one to be mapped."""
    log = osi_log.write(folder / "log.mcap", osi_log.truths(frames()))
    road = SCENES / "two-lane-road.xodr"
    out = convert(ConvertRequest(trace=str(log), to="parquet", out=folder / "tables", map=road)).path
    whole = Source("folder", {file.name: file.read_bytes() for file in sorted(out.iterdir())}, "")
    states = pq.read_table(out / "actor_state.parquet", partitioning=None)
    single = folder / "states.parquet"
    pq.write_table(states, single, compression="zstd")
    plain = folder / "plain.parquet"
    pq.write_table(
        states.rename_columns(
            {"t_ns": "t", "actor_id": "id", "x_m": "x", "y_m": "y", "yaw_rad": "yaw", "vx_mps": "vx", "vy_mps": "vy"}
        ),
        plain,
        compression="none",
    )
    text = LONG.replace('column = "t"', 'column = "t"\nunit = "ns"').replace('"a"', '"0"')
    mapping = folder / "plain.toml"
    mapping.write_text(text, encoding="utf-8")
    return [whole, _single(single, ego="0"), _single(plain, mapping=str(mapping))]


def csv(folder: Path) -> list[Source]:
    """Return a table of two cars, and the fixture of an overtake that ends in a collision."""
    mapping = folder / "long.toml"
    mapping.write_text(LONG, encoding="utf-8")
    table = folder / "cars.csv"
    table.write_text("\n".join(cars(40)) + "\n", encoding="utf-8")
    film = folder / "film.csv"
    film.write_text(
        "frame_number,gap,far\n" + "".join(f"{i},{30 - i / 2},{90 - i}\n" for i in range(40)), encoding="utf-8"
    )
    film_mapping = folder / "film.toml"
    film_mapping.write_text(FILM, encoding="utf-8")
    return [
        _single(table, mapping=str(mapping)),
        _single(OVERTAKE / "collision.csv", mapping=str(OVERTAKE / "mapping.toml")),
        _single(film, mapping=str(film_mapping)),
    ]


FILM = """
description = "a film of the tests"
[frames]
rate_hz = 10.0
column = "frame_number"
not_detected = ["-"]
[road]
driven_on = "left"
[ego]
speed = { value = 36, unit = "km/h" }
[[actor]]
id = "ahead"
lane = "own"
ahead = "gap"
speed = { value = 5 }
[[actor]]
id = "other"
lane = "opposing"
ahead = "far"
speed = { value = 20 }
"""


def xml_traces(folder: Path) -> list[Source]:
    """Return SUMO's floating car data and a CommonRoad scenario with one that moves."""
    fcd = folder / "fcd.xml"
    fcd.write_text(fcd_text.xml(), encoding="utf-8")
    states = "".join(
        f"<{tag}><position><point><x>{10 + t}</x><y>0.0</y></point></position><orientation><exact>0.0</exact></orientation>"
        f"<time><exact>{t}</exact></time><velocity><exact>10.0</exact></velocity></{tag}>"
        for t, tag in [(0, "initialState")]
    )
    path = "".join(
        f"<state><position><point><x>{10 + t}</x><y>0.0</y></point></position><orientation><exact>0.0</exact></orientation>"
        f"<time><exact>{t}</exact></time><velocity><exact>10.0</exact></velocity></state>"
        for t in range(1, 20)
    )
    obstacle = (
        '<dynamicObstacle id="7"><type>car</type><shape><rectangle><length>4.5</length><width>1.8</width></rectangle></shape>'
        f"{states}<trajectory>{path}</trajectory></dynamicObstacle>"
    )
    scenario = folder / "scenario.xml"
    scenario.write_text(scenario_text.scenario(scenario_text.lanelet(1, 0.0), obstacle), encoding="utf-8")
    return [_single(fcd, ego="b.0"), _single(scenario, ego="7")]


def scratch() -> Path:
    """Return a new empty folder."""
    return Path(tempfile.mkdtemp(prefix="drivelint-fuzz-"))


def remove_folder(folder: Path) -> None:
    """Remove a folder with what it holds."""
    shutil.rmtree(folder, ignore_errors=True)
