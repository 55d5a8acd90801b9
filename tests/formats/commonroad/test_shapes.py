"""Where the box of a CommonRoad obstacle lies against the place of its states.

Figures of peers were read with commonroad-io 2026.1 (originXShift, truckShape) and 2024.3 (center, orientation): the centre of
`occupancy_at_time(step)`, which is the box that the library looks for collisions with. 2026.1 ignores center and orientation.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import pytest
import shapely
from lxml import etree

from drivelint.report.progress import Silent
from drivelint.run import CheckOptions, check
from tests.formats.commonroad.scenario_text import state
from tests.formats.logs import actors, at, put, quality, read
from tests.shared_data import shared

if TYPE_CHECKING:
    from pathlib import Path

RADIUS_M, YAW_RATE = 40.0, 0.2
SIZE = "<length>4.5</length><width>1.8</width>"
REAR_AXLE = f"<rectangle>{SIZE}<originXShift>-1.4</originXShift></rectangle>"
TRUCK = (
    "<truckShape><truckDims><length>6.0</length><width>2.5</width><wheelbase>3.6</wheelbase>"
    "<distFromRearToRearAxle>0.5</distFromRearToRearAxle><cabinLength>2.5</cabinLength>"
    "<distFromRearAxleToHitch>0.45</distFromRearAxleToHitch></truckDims><originXShift>-2.5</originXShift></truckShape>"
)
POLYGON = "<polygon>{}</polygon>".format(
    "".join(f"<point><x>{x}</x><y>{y}</y></point>" for x, y in ((-1, -1), (-1, 1), (3, 1), (3, -1)))
)


def centre(x: float, y: float) -> str:
    return f"<center><x>{x}</x><y>{y}</y></center>"


def turning(shape: str, *, yaw_rate: float = YAW_RATE) -> str:
    """Return an obstacle whose origin goes with 8 m/s over 3 s, from (0, 0) to the east, then to the left."""
    path = []
    for step in range(30):
        yaw = yaw_rate * 0.1 * step
        place = (RADIUS_M * math.sin(yaw), RADIUS_M * (1 - math.cos(yaw))) if yaw_rate else (0.8 * step, 0.0)
        path.append(state("state" if step else "initialState", step, *place, yaw))
    return (
        f'<dynamicObstacle id="1"><type>car</type><shape>{shape}</shape>{path[0]}<trajectory>{"".join(path[1:])}'
        "</trajectory></dynamicObstacle>"
    )


def standing(shape: str) -> str:
    inner = f"<type>parkedVehicle</type><shape>{shape}</shape>" + state("initialState", 0, 60.0, 5.0, 1.0)
    return f'<staticObstacle id="50">{inner}</staticObstacle>'


def write(tmp_path: Path, *parts: str) -> Path:
    return put(tmp_path / "a.xml", f'<commonRoad timeStepSize="0.1">{"".join(parts)}</commonRoad>')


@pytest.mark.parametrize(
    ("shape", "start", "later"),
    [
        (f"<rectangle>{SIZE}</rectangle>", (0.0, 0.0), (15.576734, 3.157560)),
        (REAR_AXLE, (1.4, 0.0), (16.866219, 3.702746)),
        (TRUCK, (2.5, 0.0), (17.879386, 4.131106)),
        ("<circle><radius>0.5</radius></circle>", (0.0, 0.0), (15.576734, 3.157560)),
    ],
)
def test_boxes_of_moving_obstacles(
    shape: str, start: tuple[float, float], later: tuple[float, float], tmp_path: Path
) -> None:
    """By commonroad-io 2026.1, at steps 0 and 20."""
    trace = read(write(tmp_path, turning(shape)), ego="1")
    for time_s, expected in ((0.0, start), (2.0, later)):
        row = at(trace, "1", time_s)
        assert (row["x_m"], row["y_m"], row["yaw_rad"]) == pytest.approx((*expected, YAW_RATE * time_s), abs=1e-6)
    assert not {"no_box", "shape_origin", "velocity_mismatch", "no_position"} & set(quality(trace))


def test_the_velocity_is_that_of_the_centre(tmp_path: Path) -> None:
    row = at(read(write(tmp_path, turning(REAR_AXLE)), ego="1"), "1", 2.0)
    along, across = 8.0, YAW_RATE * 1.4
    yaw = row["yaw_rad"]
    expected = (along * math.cos(yaw) - across * math.sin(yaw), along * math.sin(yaw) + across * math.cos(yaw))
    assert (row["vx_mps"], row["vy_mps"]) == pytest.approx(expected, abs=1e-3)


def test_a_standing_obstacle_has_its_box_ahead_of_its_origin_and_stands(tmp_path: Path) -> None:
    """By commonroad-io 2026.1."""
    trace = read(write(tmp_path, turning(REAR_AXLE), standing(REAR_AXLE)), ego="1")
    row = at(trace, "50", 2.0)
    assert (row["x_m"], row["y_m"], row["vx_mps"], row["vy_mps"]) == pytest.approx(
        (60.756423, 6.178059, 0.0, 0.0), abs=1e-6
    )


@pytest.mark.parametrize(
    ("shape", "expected"),
    [
        (f"<rectangle>{SIZE}<orientation>0.3</orientation>{centre(1.4, 0.2)}</rectangle>", (9.4, 0.2, 0.3)),
        (f"<circle><radius>0.5</radius>{centre(1.0, 0.0)}</circle>", (9.0, 0.0, 0.0)),
        (POLYGON, (9.0, 0.0, 0.0)),
    ],
)
def test_a_centre_counts_where_it_need_not_turn(
    shape: str, expected: tuple[float, float, float], tmp_path: Path
) -> None:
    """By commonroad-io 2024.3: the origin is at (8, 0), and the obstacle drives straight to the east."""
    row = at(read(write(tmp_path, turning(shape, yaw_rate=0.0)), ego="1"), "1", 1.0)
    assert (row["x_m"], row["y_m"], row["yaw_rad"]) == pytest.approx(expected, abs=1e-9)


def test_both_spellings_of_one_shape_are_one_place(tmp_path: Path) -> None:
    """The middle is 1.4 m ahead by `originXShift` of 2026.1 and by `center` of 2024.3; where it is turned, the latter is doubtful."""
    shapes = {"shift": REAR_AXLE, "centre": f"<rectangle>{SIZE}{centre(1.4, 0.0)}</rectangle>"}
    for yaw, expected in (
        (0.0, {"shift": 61.4, "centre": 61.4}),
        (0.7, {"shift": 60.0 + 1.4 * math.cos(0.7), "centre": None}),
    ):
        for name, shape in shapes.items():
            text = standing(shape).replace("<exact>1.0</exact>", f"<exact>{yaw}</exact>")
            trace = read(write(tmp_path, turning(f"<rectangle>{SIZE}</rectangle>"), text), ego="1")
            assert at(trace, "50", 0.0)["x_m"] == pytest.approx(expected[name]), name


@pytest.mark.parametrize(
    "shape",
    [
        f"<rectangle>{SIZE}{centre(1.4, 0.2)}</rectangle>",
        f"<circle><radius>0.5</radius>{centre(1.0, 0.0)}</circle>",
        POLYGON,
    ],
)
def test_a_centre_that_may_or_may_not_turn_leaves_the_place_unknown(shape: str, tmp_path: Path) -> None:
    """At step 20 commonroad-io 2024.3 adds the centre as it is: (16.977, 3.358) for the rectangle; turned it is (16.788, 3.887)."""
    trace = read(write(tmp_path, turning(shape)), ego="1")
    assert at(trace, "1", 0.0)["x_m"] == pytest.approx(1.4 if "1.4" in shape else 1.0)
    row = at(trace, "1", 2.0)
    assert (row["x_m"], row["y_m"]) == (None, None)
    assert "turns with the obstacle" in quality(trace)["shape_origin"]["message"]


@pytest.mark.parametrize(
    "shift",
    [
        "<originXShift>behind</originXShift>",
        "<originXShift>nan</originXShift>",
        "<originXShift>-2.3</originXShift>",
        f"<originXShift>-1</originXShift>{centre(1.0, 0.0)}",
    ],
)
def test_an_origin_that_cannot_be_is_not_known(shift: str, tmp_path: Path) -> None:
    trace = read(write(tmp_path, turning(f"<rectangle>{SIZE}{shift}</rectangle>", yaw_rate=0.0)), ego="1")
    assert at(trace, "1", 1.0)["x_m"] is None
    assert {"shape_origin", "no_position"} <= set(quality(trace))


@pytest.mark.parametrize(
    ("shape", "place", "phrase"),
    [
        ("<semiTrailerTruckShape>" + TRUCK + "</semiTrailerTruckShape>", (10.5, 0.0), "a truck with its trailer"),
        (f"<rectangle>{SIZE}</rectangle><rectangle>{SIZE}</rectangle>", (None, None), "several shapes"),
        (f"<shapeGroup><shape><rectangle>{SIZE}</rectangle></shape></shapeGroup>", (None, None), "several shapes"),
        ("", (8.0, 0.0), "a shape that is not supported"),
    ],
)
def test_what_is_no_box_has_no_size(
    shape: str, place: tuple[float | None, float | None], phrase: str, tmp_path: Path
) -> None:
    trace = read(write(tmp_path, turning(shape, yaw_rate=0.0)), ego="1")
    row = at(trace, "1", 1.0)
    assert (row["x_m"], row["y_m"]) == (pytest.approx(place[0]), pytest.approx(place[1]))
    assert (actors(trace)["1"]["length_m"], actors(trace)["1"]["width_m"]) == (None, None)
    assert quality(trace)["no_box"]["message"].startswith(phrase)


def test_a_place_given_as_an_area_is_not_known_and_named(tmp_path: Path) -> None:
    area = f"<position><rectangle>{SIZE}{centre(8.0, 0.0)}</rectangle></position>"
    text = turning(f"<rectangle>{SIZE}</rectangle>", yaw_rate=0.0)
    point = "<position><point><x>{}</x><y>0.0</y></point></position>"
    one = text.replace(point.format("8.0"), area)
    every = text
    for step in range(30):
        every = every.replace(point.format(repr(0.8 * step)), area)
    for written, n in ((one, 1), (every, 30)):
        trace = read(write(tmp_path, written), ego="1")
        assert at(trace, "1", 1.0)["x_m"] is None
        assert quality(trace)["uncertain_value"]["message"].startswith(
            f"values of obstacles given as intervals or areas: {n}"
        )


def test_an_unknown_heading_leaves_a_shifted_box_without_a_place(tmp_path: Path) -> None:
    unsure = "<orientation><intervalStart>0</intervalStart><intervalEnd>1</intervalEnd></orientation>"
    for shape, x in ((REAR_AXLE, None), (f"<rectangle>{SIZE}</rectangle>", 8.0)):
        text = turning(shape, yaw_rate=0.0).replace("<orientation><exact>0.0</exact></orientation>", unsure)
        trace = read(write(tmp_path, text), ego="1")
        assert at(trace, "1", 1.0)["x_m"] == x
        assert "shape_origin" not in quality(trace)


def test_obstacles_without_states_are_named(tmp_path: Path) -> None:
    phantom = f'<phantomObstacle id="9"><shape><rectangle>{SIZE}</rectangle></shape><occupancySet/></phantomObstacle>'
    still = turning(f"<rectangle>{SIZE}</rectangle>")
    areas = standing(f"<rectangle>{SIZE}</rectangle>").replace("staticObstacle", "dynamicObstacle")
    areas = areas.replace("</initialState>", "</initialState><occupancySet/>")
    trace = read(write(tmp_path, still, areas, phantom), ego="1")
    assert sorted(actors(trace)) == ["1", "50"]
    assert "not read: 9" in quality(trace)["unread_obstacle"]["message"]
    assert "of 50 only the initial state" in quality(trace)["uncertain_value"]["message"]


def boxes(path: Path, step: int) -> list[shapely.Polygon]:
    """Return the boxes of a scenario at a step by a decode of its own: corners about the origin, turned and moved."""
    found = []
    for obstacle in etree.parse(path).getroot().iterfind("dynamicObstacle"):
        rectangle = obstacle.find("shape/rectangle")
        assert rectangle is not None
        length, width, shift = (
            float(rectangle.findtext(name) or "nan") for name in ("length", "width", "originXShift")
        )
        for s in (*obstacle.iterfind("initialState"), *obstacle.iterfind("trajectory/state")):
            if s.findtext("time/exact") == str(step):
                x, y, yaw = (
                    float(s.findtext(p) or "nan") for p in ("position/point/x", "position/point/y", "orientation/exact")
                )
                box = shapely.box(-length / 2 - shift, -width / 2, length / 2 - shift, width / 2)
                turned = shapely.affinity.rotate(box, yaw, origin=(0, 0), use_radians=True)
                found.append(shapely.affinity.translate(turned, x, y))
    return found


@pytest.mark.ci
def test_the_scenario_of_a_public_report_has_no_contact() -> None:
    """By commonroad-io 2026.1: box centres 20 and 126.8 m at step 0, 218 and 225.8 m at step 99, where the boxes are 1.00 m apart."""
    path = shared("reported/commonroad_origin_shift/A_free.xml")
    trace = read(path, ego="101")
    for time_s, places in ((0.0, (20.0, 126.8)), (5.0, (120.0, 176.8)), (9.9, (218.0, 225.8))):
        assert [at(trace, name, time_s)["x_m"] for name in ("101", "102")] == pytest.approx(places, abs=1e-9)
        decoded = [box.centroid.x for box in boxes(path, round(10 * time_s))]
        assert decoded == pytest.approx(places, abs=1e-9)
    assert shapely.distance(*boxes(path, 99)) == pytest.approx(1.0)
    result = check(
        CheckOptions((str(path),), rules=("ukhc.no-collision",), ego="101", handedness="rht", robustness=False),
        Silent(),
    )
    (verdict,) = result.verdicts.to_pylist()
    assert (verdict["verdict"], verdict["observed"]) == ("pass", pytest.approx(1.0))
