"""Messages in an encoding that is not read, and topics that are not there: what depends on them is unknown."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

import drivelint
from tests.faults import drives
from tests.formats.foxglove import foxglove_log as fox
from tests.formats.osi import osi_log
from tests.formats.ros2 import ros_log
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from pathlib import Path

EGO_ONLY = drives.drive(cars=1)
ODOMETRY = [ros_log.odometry(t_s, ego.x, ego.y, 0.0, drives.SPEED) for t_s, (ego,) in EGO_ONLY]
LIGHTS = [ros_log.report("TurnIndicatorsReport", t_s, report=1) for t_s, _ in EGO_ONLY]
ROAD = (ROOT / "fixtures" / "overtake" / "road.xodr").read_text(encoding="utf-8")
WITHOUT = {"/other", "other", "map", "/tf", "/vehicle/TurnIndicatorsReport", "/carla/objects"}
"""The topics whose encoding is not read."""


def osi(path: Path, *, second: bool) -> Path:
    """Write ground truth, and a second topic of it or a map."""
    messages = osi_log.truths(drives.truths(EGO_ONLY if second else drives.drive()))
    road = osi_log.message("MapAsamOpenDrive")
    road.open_drive_xml_content = ROAD
    other = osi_log.truths(drives.truths(drives.drive()), "other")
    messages += other if second else [osi_log.Out("osi3.MapAsamOpenDrive", "map", 0, road.SerializeToString())]
    return osi_log.write(path, messages)


def foxglove(path: Path, *, second: bool) -> Path:
    """Write a scene, and a second one or its frame."""
    other = [("/other", *message[1:]) for message in drives.scenes(drives.drive())]
    frame = [fox.transform(0.0, "odom", "map")]
    return fox.write(path, [*drives.scenes(EGO_ONLY if second else drives.drive()), *(other if second else frame)])


def ros(path: Path, *, second: bool) -> Path:
    """Write odometry with road users, or all of them with the ego's indicators."""
    objects = drives.things(drives.drive())
    if not second:
        objects = [("/objects", *message[1:]) for message in objects]
    return ros_log.write(path, [*ODOMETRY, *objects, *([] if second else LIGHTS)])


LOGS = {"osi": osi, "foxglove": foxglove, "ros": ros}
TOPICS = {"osi": "ground_truth", "foxglove": "/scene", "ros": "/carla/hero/odometry"}


def in_another_encoding(path: Path) -> Path:
    """Return the log with the topics of `WITHOUT` said to be in another encoding."""
    found = path.with_name("bad.mcap")
    with path.open("rb") as source, found.open("wb") as file:
        writer = Writer(file, compression=CompressionType.NONE)
        writer.start()
        channels: dict[str, int] = {}
        for schema, channel, message in make_reader(source).iter_messages():
            if channel.topic not in channels:
                assert schema is not None
                number = writer.register_schema(schema.name, schema.encoding, schema.data)
                encoding = "xcdr" if channel.topic in WITHOUT else channel.message_encoding
                channels[channel.topic] = writer.register_channel(channel.topic, encoding, number)
            writer.add_message(channels[channel.topic], message.log_time, message.data, message.publish_time)
        writer.finish()  # type: ignore[no-untyped-call]
    return found


@pytest.fixture
def good(tmp_path: Path) -> Path:
    return drives.osi_mcap(tmp_path / "good", drives.drive(drives.N + 1))


def check_outcome(
    logs: list[Path], name: str, **options: Any
) -> tuple[int, dict[str, dict[str, Any]], dict[str, set[str]]]:
    """Return the exit code, the rows of the drives by file, and the verdicts of each rule on the bad one."""
    if name != "ros":
        options["ego"] = "0"
    rules = ["ukhc.no-collision", "ukhc.r124.speed-limit", "ukhc.r116.hazards"]
    result = drivelint.check(
        logs, rules=rules, annotate=False, robustness=False, ego_size=(drives.LENGTH, drives.WIDTH), **options
    )
    drives_by_name = {row["file_name"]: row for row in result.drives.arrow().to_pylist()}
    verdicts: dict[str, set[str]] = {}
    for row in result.verdicts.arrow().to_pylist():
        assert row["verdict"] != "fail"
        if row["drive_id"].startswith("bad"):
            verdicts.setdefault(row["rule_id"], set()).add(row["reason_code"])
    return result.exit_code, drives_by_name, verdicts


@pytest.mark.sample(1, ci=2)
@pytest.mark.parametrize("name", LOGS)
def test_a_topic_of_road_users_refuses_the_log(name: str, tmp_path: Path, good: Path) -> None:
    """Each topic may hold whom the other does not."""
    log = in_another_encoding(LOGS[name](tmp_path / "whole.mcap", second=True))
    code, found, _ = check_outcome([log, good], name)
    assert code == 4
    assert "(40 messages of " in found["bad.mcap"]["status_reason"]
    assert "is in 'xcdr', which is not read: its actors are unknown" in found["bad.mcap"]["status_reason"]
    assert found["bad.mcap"]["status_reason"].endswith(f"--topic {TOPICS[name]}")
    assert found["good.mcap"]["status"] == "judged"


@pytest.mark.sample(1, ci=2)
@pytest.mark.parametrize("name", LOGS)
def test_a_topic_may_be_chosen(name: str, tmp_path: Path) -> None:
    log = in_another_encoding(LOGS[name](tmp_path / "whole.mcap", second=True))
    code, found, verdicts = check_outcome([log], name, topic=TOPICS[name])
    alone = {"missing_road_users"} if name == "ros" else {"not_triggered"}  # who chooses a topic says who is there
    assert (code, found["bad.mcap"]["lossy"]) == (4 if name == "ros" else 0, False)  # 4: nothing is decided
    assert verdicts["ukhc.no-collision"] == alone


@pytest.mark.sample(1, ci=2)
@pytest.mark.parametrize("name", LOGS)
def test_another_topic_is_passed_over(name: str, tmp_path: Path, good: Path) -> None:
    """What it would say is unknown, the rest is judged, and the exit code tells that something is lost."""
    log = in_another_encoding(LOGS[name](tmp_path / "whole.mcap", second=False))
    code, found, verdicts = check_outcome([log, good], name)
    assert (code, found["bad.mcap"]["lossy"], found["good.mcap"]["lossy"]) == (3, True, False)
    (told,) = (each for each in found["bad.mcap"]["quality"] if each["check_id"] == "unread_topic")
    assert told["message"].endswith("is in 'xcdr', which is not read: its content is unknown")
    assert verdicts["ukhc.no-collision"] == {"kept"}
    assert verdicts["ukhc.r124.speed-limit"] == {"missing_map"}
    assert verdicts["ukhc.r116.hazards"] == {"missing_indicator"}


def test_without_road_users_nobody_is_claimed_absent(tmp_path: Path) -> None:
    log = ros_log.write(tmp_path / "bad.mcap", [*ODOMETRY, *LIGHTS])
    _, found, verdicts = check_outcome([log], "ros")
    assert verdicts["ukhc.no-collision"] == {"missing_road_users"}
    assert "missing_road_users" not in verdicts["ukhc.r116.hazards"] | verdicts["ukhc.r124.speed-limit"]
    assert "no_road_users" in {each["check_id"] for each in found["bad.mcap"]["quality"]}
