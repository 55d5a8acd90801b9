"""Things that do not move and are no actors: an ego that touches the outline of one neither passes `no-collision` nor fails it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from drivelint.report.progress import Silent
from drivelint.run import CheckOptions, check
from drivelint.watch.sources.osi_static import StaticContent
from tests.formats.commonroad.scenario_text import state
from tests.formats.logs import actors, put, quality, read
from tests.formats.osi import osi_file

if TYPE_CHECKING:
    from pathlib import Path

BRIDGE, OTHER, PYLON, TREE, SPEED_BUMP = 2, 1, 5, 7, 17
PERIOD_NS = 50_000_000


def stand(
    frame: Any,
    kind: int,
    x: float,
    y: float = 1.5,
    *,
    z: float = 0.5,
    size: tuple[float, float, float] = (0.3, 0.3, 1.0),
) -> Any:
    """Add a stationary object to a ground truth, and return it."""
    item = frame.stationary_object.add()
    item.id.value, item.classification.type = 41, kind
    item.base.position.x, item.base.position.y, item.base.position.z = x, y, z
    item.base.dimension.length, item.base.dimension.width, item.base.dimension.height = size
    return item


def drive(n: int = 20, period_ns: int = PERIOD_NS) -> list[Any]:
    """A car at y = 1.5 m from x = 0 to 9.5 m, 1.8 m wide, and a person far ahead."""
    frames = [osi_file.truth(i * period_ns) for i in range(n)]
    for frame in frames:
        for item in frame.moving_object:
            item.base.position.z = 0.75
    return frames


def verdict(path: Path) -> tuple[str, str]:
    """Return the verdict of no-collision and its reason."""
    options = CheckOptions((str(path),), rules=("ukhc.no-collision",), ego_size=None, robustness=False)
    (row,) = check(options, Silent()).verdicts.to_pylist()
    return row["verdict"], row["reason"]


@pytest.mark.parametrize(
    ("kind", "place", "expected"),
    [
        (PYLON, {"x": 8.0}, "unknown"),
        (PYLON, {"x": 8.0, "y": 2.5}, "unknown"),
        (PYLON, {"x": 8.0, "y": 2.6}, "pass"),
        (PYLON, {"x": 15.0}, "pass"),
        (TREE, {"x": 8.0, "y": 4.0, "z": 2.0, "size": (4.0, 4.0, 4.0)}, "unknown"),
        (TREE, {"x": 8.0, "y": 4.0, "z": 4.0, "size": (4.0, 4.0, 4.0)}, "pass"),
        (OTHER, {"x": 8.0, "z": 5.0}, "pass"),
        (OTHER, {"x": 8.0, "z": -5.0}, "pass"),
        (OTHER, {"x": 8.0, "z": 0.0}, "unknown"),
        (BRIDGE, {"x": 8.0, "size": (10.0, 10.0, 1.0)}, "pass"),
        (SPEED_BUMP, {"x": 8.0, "size": (0.5, 4.0, 0.1)}, "pass"),
    ],
)
def test_an_outline_that_the_ego_touches_leaves_a_contact_unknown(
    kind: int, place: dict[str, Any], expected: str, tmp_path: Path
) -> None:
    frames = drive()
    stand(frames[0], kind, **place)
    path = osi_file.write(tmp_path / "a.osi", frames)
    assert sorted(actors(read(path))) == ["0", "7"]
    outcome, reason = verdict(path)
    assert outcome == expected
    assert ("touches the outline of" in reason) == (expected == "unknown")


def test_the_finding_names_the_thing_and_the_first_time(tmp_path: Path) -> None:
    frames = drive()
    for frame in frames[3:]:
        stand(frame, PYLON, 8.0)
    row = quality(read(osi_file.write(tmp_path / "a.osi", frames)))["outline_contact"]
    assert "the box of 0 touches the outline of pylon 41" in row["message"]
    # the front is at x + 2.25 m, and the pylon begins at 7.85 m: the step from 5.5 to 6.0 m touches it
    assert (row["actor_id"], row["t_first_ns"], row["n"]) == ("0", 11 * PERIOD_NS, 9)


def test_a_post_between_two_steps_is_touched(tmp_path: Path) -> None:
    frames = drive(3, 1_000_000_000)
    stand(frames[0], PYLON, 5.0)
    assert verdict(osi_file.write(tmp_path / "a.osi", frames))[0] == "unknown"


def test_the_polygon_of_the_base_counts_instead_of_the_box(tmp_path: Path) -> None:
    frames = drive()
    item = stand(frames[0], PYLON, 8.0, 4.0, size=(1.0, 4.0, 1.0))
    item.base.orientation.yaw = 3.141592653589793
    for x, y in ((-0.5, -2.0), (0.5, -2.0), (0.0, -1.0)):  # turned by half a turn, at the far side
        corner = item.base.base_polygon.add()
        corner.x, corner.y = x, y
    assert verdict(osi_file.write(tmp_path / "a.osi", frames))[0] == "pass"
    del item.base.base_polygon[:]
    assert verdict(osi_file.write(tmp_path / "b.osi", frames))[0] == "unknown"


def test_a_thing_without_a_position_is_named(tmp_path: Path) -> None:
    frames = drive()
    stand(frames[0], PYLON, 8.0).base.ClearField("position")
    assert quality(read(osi_file.write(tmp_path / "a.osi", frames)))["unread_obstacle"]["n"] == 1


def scenario(tmp_path: Path, shape: str) -> Path:
    """A car from (0, 0) to (23.2, 0), another far away, and a building."""
    box = "<shape><rectangle><length>4.5</length><width>1.8</width></rectangle></shape>"
    path = [state("state" if step else "initialState", step, 0.8 * step, 0.0, 0.0) for step in range(30)]
    car = f'<dynamicObstacle id="1"><type>car</type>{box}{path[0]}<trajectory>{"".join(path[1:])}</trajectory></dynamicObstacle>'
    other = f'<staticObstacle id="2"><type>parkedVehicle</type>{box}{state("initialState", 0, 0.0, 50.0, 0.0)}</staticObstacle>'
    building = f'<environmentObstacle id="9"><type>building</type><shape>{shape}</shape></environmentObstacle>'
    return put(tmp_path / "a.xml", f'<commonRoad timeStepSize="0.1">{car}{other}{building}</commonRoad>')


def corners(*points: tuple[float, float]) -> str:
    return "<polygon>{}</polygon>".format("".join(f"<point><x>{x}</x><y>{y}</y></point>" for x, y in points))


@pytest.mark.parametrize(
    ("shape", "expected"),
    [
        ("<rectangle><length>4</length><width>1</width><center><x>10</x><y>0</y></center></rectangle>", "unknown"),
        ("<rectangle><length>4</length><width>1</width><center><x>10</x><y>2</y></center></rectangle>", "pass"),
        (
            "<rectangle><length>4</length><width>1</width><orientation>1.5708</orientation><center><x>10</x><y>2</y></center></rectangle>",
            "unknown",
        ),
        ("<circle><radius>1.2</radius><center><x>10</x><y>2</y></center></circle>", "unknown"),
        ("<circle><radius>1.0</radius><center><x>10</x><y>2</y></center></circle>", "pass"),
        (corners((10, 0), (12, 5), (8, 5)), "unknown"),
        (corners((10, 1), (12, 5), (-50, 5), (-50, 1)), "pass"),
        # the box around it holds the road, the polygon does not
        (corners((-50, 2), (50, 2), (50, -40), (51, -40), (51, 3), (-50, 3)), "pass"),
    ],
)
def test_buildings_of_a_scenario(shape: str, expected: str, tmp_path: Path) -> None:
    path = scenario(tmp_path, shape)
    options = CheckOptions((str(path),), rules=("ukhc.no-collision",), ego="1", handedness="rht", robustness=False)
    (row,) = check(options, Silent()).verdicts.to_pylist()
    assert row["verdict"] == expected
    assert "unread_obstacle" not in quality(read(path, ego="1"))


@pytest.mark.parametrize("shape", ["<ellipse/>", "<circle><radius>wide</radius></circle>", corners((0, 0), (1, 1)), ""])
def test_a_building_without_a_shape_is_named(shape: str, tmp_path: Path) -> None:
    assert "not read: 9" in quality(read(scenario(tmp_path, shape), ego="1"))["unread_obstacle"]["message"]


def test_a_later_window_of_a_watched_log_has_the_things_of_the_first_message(tmp_path: Path) -> None:
    frames = drive()
    stand(frames[0], PYLON, 8.0)
    stand(frames[5], PYLON, 8.0)
    content = StaticContent(frames[0].SerializeToString(), "osi3.GroundTruth")
    for begin in (4, 5):
        first = osi_file.message("GroundTruth")
        first.ParseFromString(content.add_to_message(frames[begin].SerializeToString()))
        row = quality(read(osi_file.write(tmp_path / "a.osi", [first, *frames[begin + 1 :]])))["outline_contact"]
        assert row["message"].count("pylon 41") == 1
        assert row["n"] == 9
