"""Autoware's traffic light groups: what each shows, for how long that holds, and that their ids are the map's."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from drivelint.errors import TraceError
from tests.formats.logs import quality, read
from tests.formats.ros2 import autoware_log as autoware
from tests.formats.ros2 import ros_log as ros
from tests.formats.ros2.autoware_log import (
    AMBER,
    CIRCLE,
    CROSS,
    FLASHING,
    GREEN,
    LEFT,
    OFF,
    RED,
    RIGHT,
    UP,
    WHITE,
    element,
)
from tests.formats.ros2.ros_drive import T0, ego, ticks

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from drivelint.drive.trace import Trace

OTHER_TOPIC = "/perception/traffic_light_recognition/internal/traffic_signals"


def trace_of(
    folder: Path, messages: list[ros.Message], types: dict[str, str] = autoware.TYPES, **options: Any
) -> Trace:
    return read(autoware.write(folder / "log.mcap", messages, types), **options)


def light_states(trace: Trace) -> list[tuple[str, float, str | None]]:
    """Return what is known of the lights: id, seconds since the drive began, state."""
    rows = trace.tables["signal_state"].to_pylist()
    return [(row["signal_id"], round(row["t_ns"] / 1e9 - T0, 6), row["state"]) for row in rows]


def state_of(folder: Path, elements: Sequence[dict[str, Any]], types: dict[str, str] = autoware.TYPES) -> str | None:
    """Return the state of a group that has these elements all the time."""
    trace = trace_of(folder, [*ego(), *(autoware.lights(t_s, {7: elements}) for t_s in ticks())], types)
    (state,) = {state for _, _, state in light_states(trace)}
    return state


@pytest.mark.parametrize(
    ("elements", "state"),
    [
        ([element(RED)], "red"),
        ([element(AMBER)], "amber"),
        ([element(GREEN)], "green"),
        ([element(RED), element(AMBER)], "red_amber"),
        ([element(AMBER, status=FLASHING)], "flashing"),
        ([element(RED), element(GREEN, status=OFF)], "red"),
        ([element(color, status=OFF) for color in (RED, AMBER, GREEN)], "off"),
        # a lamp that is not listed may be lit
        ([element(color, status=OFF) for color in (RED, GREEN)], None),
        ([], None),
        # lamps that cannot be lit together, or of which one flashes
        ([element(RED), element(GREEN)], None),
        ([element(RED), element(AMBER, status=FLASHING)], None),
        # an arrow is for some only: it decides nothing where it shows something else than the full light
        ([element(RED), element(GREEN, LEFT)], None),
        ([element(GREEN), element(RED, RIGHT)], None),
        ([element(GREEN, UP)], None),
        ([element(RED, LEFT)], None),
        ([element(RED), element(AMBER), element(AMBER, LEFT)], None),
        ([element(AMBER, status=FLASHING), element(GREEN, RIGHT)], None),
        ([element(GREEN, UP, FLASHING), element(RED)], None),
        ([element(GREEN), element(GREEN, LEFT)], "green"),
        ([element(RED), element(RED, UP)], "red"),
        ([element(RED), element(GREEN, LEFT, OFF)], "red"),
        # what is not known, or no light for vehicles
        ([element(0)], None),
        ([element(RED, 0)], None),
        ([element(RED, CIRCLE, 0)], None),
        ([element(RED), element(0, 0, 0)], None),
        ([element(WHITE)], None),
        ([element(RED, CROSS)], None),
        ([element(99)], None),
    ],
)  # fmt: skip
def test_states(tmp_path: Path, elements: list[dict[str, Any]], state: str | None) -> None:
    assert state_of(tmp_path, elements) == state


def test_the_numbers_are_those_of_the_logs_own_definition(tmp_path: Path) -> None:
    """Older definitions number all constants on; there 5 is a circle, which is an arrow in the newer ones."""
    older = """
        uint8 RED = 1
        uint8 AMBER = 2
        uint8 GREEN = 3
        uint8 CIRCLE = 5
        uint8 LEFT_ARROW = 6
        uint8 RIGHT_ARROW = 7
        uint8 UP_ARROW = 8
        uint8 SOLID_OFF = 13
        uint8 SOLID_ON = 14
        uint8 FLASHING = 15
        uint8 UNKNOWN = 16
    """
    types = {**autoware.TYPES, "autoware_perception_msgs/TrafficLightElement": older + autoware.LIGHT_FIELDS}
    assert state_of(tmp_path, [element(RED, 5, 14)], types) == "red"
    assert state_of(tmp_path, [element(RED, 5, 14), element(GREEN, 6, 14)], types) is None
    assert state_of(tmp_path, [element(RED, 1, 2)], types) is None
    without = {**autoware.TYPES, "autoware_perception_msgs/TrafficLightElement": autoware.LIGHT_FIELDS}
    assert state_of(tmp_path, [element(GREEN)], without) == "green"


def test_a_group_that_is_no_longer_listed_is_unknown(tmp_path: Path) -> None:
    """A message lists all that is seen then. One that is seen once must not be red for ever."""
    red, green = [element(RED)], [element(GREEN)]
    groups: list[dict[int, Any]] = [{7: red, 8: green}, {7: red}, {7: green, 9: red}, {}, {7: green}]
    messages = [autoware.lights(T0 + 0.1 * k, of) for k, of in enumerate(groups)]
    assert light_states(trace_of(tmp_path, [*ego(), *messages])) == [
        ("7", 0.0, "red"), ("7", 0.1, "red"), ("7", 0.2, "green"), ("7", 0.3, None), ("7", 0.4, "green"),
        ("8", 0.0, "green"), ("8", 0.1, None),
        ("9", 0.2, "red"), ("9", 0.3, None),
    ]  # fmt: skip


def test_a_state_holds_no_longer_than_five_seconds_without_a_message(tmp_path: Path) -> None:
    messages = [autoware.lights(T0 + t_s, {7: [element(RED)]}) for t_s in (0.0, 4.0, 10.0)]
    assert light_states(trace_of(tmp_path, [*ego(n=401), *messages])) == [
        ("7", 0.0, "red"), ("7", 4.0, "red"), ("7", 9.0, None), ("7", 10.0, "red"), ("7", 15.0, None),
    ]  # fmt: skip


def test_order_of_messages_and_groups_changes_nothing(tmp_path: Path) -> None:
    messages = [
        autoware.lights(t_s, {k: [element(RED if t_s < T0 + k / 10 else GREEN)] for k in (5, 3, 11)}) for t_s in ticks()
    ]
    expected = light_states(trace_of(tmp_path, [*ego(), *messages]))
    turned = [
        (topic, kind, t_s, {**of, "traffic_light_groups": of["traffic_light_groups"][::-1]})
        for topic, kind, t_s, of in messages
    ]
    assert light_states(trace_of(tmp_path, [*turned[::-1], *ego()])) == expected
    assert len(expected) == 3 * len(messages)


def test_a_group_that_shows_two_things_at_once(tmp_path: Path) -> None:
    """Both rows stand: where they are read, two states at one time are none."""
    topic, kind, t_s, of = autoware.lights(T0, {7: [element(RED)]})
    twice = of["traffic_light_groups"] + autoware.lights(T0, {7: [element(GREEN)]})[3]["traffic_light_groups"]
    rows = light_states(trace_of(tmp_path, [*ego(), (topic, kind, t_s, {**of, "traffic_light_groups": twice})]))
    assert rows == [("7", 0.0, "green"), ("7", 0.0, "red")]


def test_older_names_of_message_and_fields(tmp_path: Path) -> None:
    found = []
    for t_s in ticks():
        rows = [{"traffic_signal_id": 7, "elements": [element(AMBER)]}]
        found.append(
            ("/signals", "autoware_perception_msgs/TrafficSignalArray", t_s, {"stamp": ros.stamp(t_s), "signals": rows})
        )
    assert {(name, state) for name, _, state in light_states(trace_of(tmp_path, [*ego(), *found]))} == {("7", "amber")}


def test_lights_by_their_lines_are_not_read(tmp_path: Path) -> None:
    """In autoware_auto_perception_msgs an id is that of a light's line in the map, which may be a group's id, too."""
    name = "autoware_auto_perception_msgs"
    types = {
        **autoware.TYPES,
        f"{name}/TrafficLight": autoware.LIGHT_FIELDS,
        f"{name}/TrafficSignal": "int32 map_primitive_id\nTrafficLight[] lights",
        f"{name}/TrafficSignalArray": "std_msgs/Header header\nTrafficSignal[] signals",
    }
    rows = [{"map_primitive_id": 7, "lights": [element(RED)]}]
    messages = [
        ("/signals", f"{name}/TrafficSignalArray", t_s, {"header": ros.header(t_s), "signals": rows}) for t_s in ticks()
    ]
    assert light_states(trace_of(tmp_path, [*ego(), *messages], types)) == []


def test_the_usual_topic_counts(tmp_path: Path) -> None:
    final = [autoware.lights(t_s, {7: [element(GREEN)]}) for t_s in ticks()]
    raw = [autoware.lights(t_s, {7: [element(RED)]}, OTHER_TOPIC) for t_s in ticks()]
    trace = trace_of(tmp_path, [*ego(), *raw, *final])
    assert {state for *_, state in light_states(trace)} == {"green"}
    assert f"{OTHER_TOPIC} is not read" in trace.notes[0]
    assert {state for *_, state in light_states(trace_of(tmp_path, [*ego(), *raw, *final], topic=OTHER_TOPIC))} == {
        "red"
    }
    with pytest.raises(TraceError, match="traffic lights on 2 topics"):
        trace_of(tmp_path, [*ego(), *raw, *(("/x", *rest) for _, *rest in final)])  # type: ignore[list-item]


def utc(messages: list[ros.Message]) -> list[ros.Message]:
    """Move the log to the year 2023."""
    for i, (topic, kind, t_s, of) in enumerate(messages):
        of["header"]["stamp"] = ros.stamp(t_s + 1.7e9)
        messages[i] = topic, kind, t_s + 1.7e9, of
    return messages


def test_messages_without_a_time_are_left_out(tmp_path: Path) -> None:
    """A state of the year 1970 would hold for the whole drive."""
    lights = [autoware.lights(t_s + 1.7e9, {7: [element(RED)]}) for t_s in ticks()]
    for message in lights[10:20]:
        message[3]["stamp"] = {}
    trace = trace_of(tmp_path, [*utc(ego()), *lights])
    assert len(trace.tables["signal_state"]) == 30
    assert quality(trace)["signal_clock"]["n"] == 10
    for message in lights:
        message[3]["stamp"] = {}
    trace = trace_of(tmp_path, [*utc(ego()), *lights])
    assert len(trace.tables["signal_state"]) == 0
    assert "have other times" in quality(trace)["signal_clock"]["message"]


def test_another_clock(tmp_path: Path) -> None:
    lights = [autoware.lights(t_s + 1.7e9, {7: [element(RED)]}) for t_s in ticks()]
    trace = trace_of(tmp_path, [*ego(), *lights])
    assert len(trace.tables["signal_state"]) == 0
    assert quality(trace)["signal_clock"]["severity"] == "warning"


def test_times_of_the_container(tmp_path: Path) -> None:
    """Where poses have no time stamps of their own, the log's times count for all messages."""
    poses = ego()
    for *_, of in poses:
        of["header"]["stamp"] = {}
    lights = [autoware.lights(t_s, {7: [element(RED)]}) for t_s in ticks()]
    for message in lights:
        message[3]["stamp"] = {}
    rows = light_states(trace_of(tmp_path, [*poses, *lights]))
    assert [t_s for _, t_s, _ in rows] == pytest.approx([t_s - T0 for t_s in ticks()])
