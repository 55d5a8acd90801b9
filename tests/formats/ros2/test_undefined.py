"""Odometry and transforms whose message definition is unknown are named, also if the user chose another topic."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

from drivelint.errors import TraceError
from tests.formats.logs import quality, read
from tests.formats.ros2 import ros_log as ros
from tests.formats.ros2.ros_drive import TURN, along, ego, ticks

if TYPE_CHECKING:
    from pathlib import Path

OBJECTS, ODOMETRY = "/perception/objects", "/carla/hero/odometry"


def log(folder: Path, messages: list[ros.Message], *undefined: str) -> Path:
    """Write a log in which the types of the topics `undefined` have no definitions, as after a conversion of an old bag."""
    whole, out = ros.write(folder / "whole.mcap", messages), folder / "log.mcap"
    with whole.open("rb") as source, out.open("wb") as file:
        writer = Writer(file, compression=CompressionType.NONE)
        writer.start(profile="ros2")
        channels: dict[str, int] = {}
        for schema, channel, message in make_reader(source).iter_messages():
            assert schema is not None
            if channel.topic not in channels:
                known = channel.topic not in undefined
                number = writer.register_schema(schema.name, "ros2msg" if known else "", schema.data if known else b"")
                channels[channel.topic] = writer.register_channel(channel.topic, "cdr", number)
            writer.add_message(channels[channel.topic], message.log_time, message.data, message.publish_time)
        writer.finish()  # type: ignore[no-untyped-call]
    return out


def cars() -> list[ros.Message]:
    return [ros.tracks(t_s, ros.track(3, 50.0, 9.0), ros.track(4, 60.0, 9.0)) for t_s in ticks()]


def moving() -> list[ros.Message]:
    return [ros.transform(t_s, "map", "base_link", *along(t_s), yaw=TURN) for t_s in ticks()]


@pytest.mark.parametrize(
    ("messages", "topic", "kind"),
    [(ego(), ODOMETRY, "nav_msgs/Odometry"), (moving(), "/tf", "tf2_msgs/TFMessage")],
)
def test_the_choice_of_a_topic_does_not_hide_the_ego(
    tmp_path: Path, messages: list[ros.Message], topic: str, kind: str
) -> None:
    path = log(tmp_path, [*messages, *cars()], topic)
    text = f"topic '{topic}' (40 messages of {kind}) has no message definitions in the log, and none is known for it"
    with pytest.raises(TraceError, match=f"no message definition of .* on '{topic}'"):
        read(path)
    with pytest.raises(TraceError, match=f"does not name the ego .*{re.escape(text)}") as error:
        read(path, topic=OBJECTS)
    assert "\n" not in str(error.value)
    trace = read(path, topic=OBJECTS, need_ego=False)
    assert quality(trace)["unread_topic"]["message"] == f"{text}: its content is unknown"
    assert any(text in note for note in trace.notes)


def test_transforms_that_are_read_place_the_ego_beside_undefined_odometry(tmp_path: Path) -> None:
    trace = read(log(tmp_path, [*ego(), *moving(), *cars()], ODOMETRY), topic=OBJECTS)
    assert any("the ego is placed by the transforms of 'base_link' on /tf" in note for note in trace.notes)
    assert ODOMETRY in quality(trace)["unread_topic"]["message"]


def test_odometry_that_the_user_chose_needs_no_other(tmp_path: Path) -> None:
    other = [("/other/odometry", *message[1:]) for message in ego()]
    path = log(tmp_path, [*ego(), *other, *cars()], "/other/odometry")
    assert "unread_topic" not in quality(read(path, topic=f"{ODOMETRY},{OBJECTS}"))
