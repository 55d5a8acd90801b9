"""A whole drive of Autoware on its Lanelet2 map: which rules it can decide, and that its light is the map's."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

pytest.importorskip("lanelet2", reason="the package lanelet2 is not installed (extra 'lanelet2')")

import drivelint
from drivelint.formats import load_map, read_source
from drivelint.inspect import InspectRequest, inspect
from drivelint.road.map_reader import MapSource
from tests.formats.logs import actors, at, read, states
from tests.formats.ros2 import autoware_drive as drive
from tests.formats.ros2 import autoware_log as autoware
from tests.formats.ros2.autoware_log import GREEN, LEFT, RED, element
from tests.shared_data import shared

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from drivelint.inspect.model import Drive
    from tests.formats.ros2 import ros_log as ros

NEW = (
    "autoware_perception_msgs/PredictedObjects", "autoware_perception_msgs/TrafficLightGroupArray", "rcl_interfaces/ParameterEvent",
)  # fmt: skip


@pytest.fixture(scope="module")
def scene() -> drive.Scene:
    return drive.scene()


@pytest.fixture(scope="module")
def whole(scene: drive.Scene) -> list[ros.Message]:
    return drive.messages(scene.light)


def inspected(folder: Path, scene: drive.Scene, messages: list[ros.Message]) -> Drive:
    """Return what `inspect` says of a log on the map."""
    (folder / "map.osm").write_text(scene.text, encoding="utf-8")
    log = autoware.write(folder / "drive.mcap", messages)
    found = inspect(InspectRequest(str(log), map=folder / "map.osm")).drive
    assert found is not None
    return found


def without(messages: list[ros.Message], *kinds: str) -> list[ros.Message]:
    return [message for message in messages if message[1] not in kinds]


def lacking(drive: Drive) -> dict[str, set[str]]:
    """Return the rules that `check` runs by itself and that cannot be decided, each with what it waits for."""
    (ego,) = drive.egos
    return {rule.rule_id: set(rule.missing_signals) for rule in ego.cannot if rule.rule_id not in drive.drafts}


@pytest.mark.ci
def test_what_can_be_decided(tmp_path: Path, scene: drive.Scene, whole: list[ros.Message]) -> None:
    """What is lacking is in no bag of Autoware: headlights, the horn, the kind of vehicle, the light of day; and footways in this map."""
    found = inspected(tmp_path, scene, whole)
    assert set().union(*lacking(found).values()) == {
        "light",
        "mode_headlights",
        "mode_horn",
        "vehicle_class",
        "lane_types",
    }
    before = inspected(tmp_path, scene, without(whole, *NEW))
    of = len(found.rules) - len(found.drafts)
    assert (of - len(lacking(found)), of - len(lacking(before))) == (of - 6, 5)
    assert lacking(found).keys() < lacking(before).keys()


@pytest.mark.ci
@pytest.mark.parametrize(("left_out", "signal"), [*zip(NEW, ("road_users", "signals", "ego_size"), strict=True)])
def test_each_topic_counts(
    tmp_path: Path, scene: drive.Scene, whole: list[ros.Message], left_out: str, signal: str
) -> None:
    assert signal in set().union(*lacking(inspected(tmp_path, scene, without(whole, left_out))).values())


def test_the_drive(tmp_path: Path) -> None:
    log, road = drive.write(tmp_path)
    trace = read(log)
    assert {name[-1]: row["actor_class"] for name, row in actors(trace).items()} == {
        "1": "car", "2": "car", "3": "pedestrian", "o": "vehicle",
    }  # fmt: skip
    here = at(trace, "ego", drive.T0 + 10.0)
    assert (here["x_m"], here["y_m"], here["indicator"]) == (
        pytest.approx(drive.START + 10.0 * drive.SPEED),
        -1.75,
        "off",
    )
    assert len(states(trace, "ego")) == 1001
    of_map = load_map(read_source(road)).tables["traffic_signal"].to_pylist()
    assert {row["signal_id"] for row in of_map if row["kind"] == "traffic_light"} == {
        row["signal_id"] for row in trace.tables["signal_state"].to_pylist()
    }
    assert [row["state"] for row in trace.tables["signal_state"].to_pylist()] == ["red"] * 90 + ["green"] * 111


def red(_: float) -> list[dict[str, Any]]:
    return [element(RED)]


def red_but_for_the_left(_: float) -> list[dict[str, Any]]:
    return [element(RED), element(GREEN, LEFT)]


@pytest.mark.ci
@pytest.mark.parametrize(
    ("shows", "verdict"), [(drive.changing, "pass"), (red, "fail"), (red_but_for_the_left, "unknown")]
)
def test_a_light_is_judged(tmp_path: Path, shows: Callable[[float], list[dict[str, Any]]], verdict: str) -> None:
    log, road = drive.write(tmp_path, shows=shows)
    result = drivelint.check(log, map=road, rules="ukhc.r175.red", annotate=False, robustness=False)
    assert [row["verdict"] for row in result.verdicts.arrow().to_pylist()] == [verdict]


def test_the_ids_of_a_real_map_are_those_of_its_regulatory_elements() -> None:
    """Each light of the map is one relation of the file, of subtype traffic_light."""
    path = shared("maps/lanelet2_mapping_example.osm")
    from lxml import etree

    root = etree.parse(path).getroot()
    elements = {
        relation.get("id")
        for relation in root.iterfind("relation[tag]")
        if relation.find("tag[@k='subtype'][@v='traffic_light']") is not None
    }
    of_map = load_map(MapSource(path.name, path.read_bytes()), origin=(49.0, 8.4)).tables["traffic_signal"].to_pylist()
    found = {row["signal_id"] for row in of_map if row["kind"] == "traffic_light"}
    assert found
    assert found <= elements
