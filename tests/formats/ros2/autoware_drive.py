"""A drive of twenty seconds as Autoware records it: through a junction with a light, on a Lanelet2 map, among others."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

from tests.formats.lanelet2.drawing import Drawing
from tests.formats.ros2 import autoware_log as autoware
from tests.formats.ros2 import ros_log as ros

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

T0, SECONDS = 1_700_000_000.0, 20.0
HERTZ = 50
SPEED = 8.0
AHEAD = 1.345
"""How far the centre of the sample vehicle's box lies ahead of its rear axle: half of 2.79 + 1.0 - 1.1."""
START = 20.0
"""Where that centre is first."""
STOP_LINE = 148.0
IN, OUT = 150.0, 165.0
RED_S = 9.0
"""The light is red for so long, then green; the ego is at its line after some 16 s."""
Elements = list[dict[str, Any]]


class Scene(NamedTuple):
    """The map's text and the id of the regulatory element that is the light."""

    text: str
    light: int


class _Street(Drawing):
    def lane(self, a: tuple[float, float], b: tuple[float, float], more: str = "") -> int:
        """Draw a lanelet of 3.5 m whose middle runs straight from a to b."""
        along = math.atan2(b[1] - a[1], b[0] - a[0])
        left = -1.75 * math.sin(along), 1.75 * math.cos(along)

        def bound(side: int) -> int:
            points = [(round(x + side * left[0], 3), round(y + side * left[1], 3)) for x, y in (a, b)]
            return self.way(points, "line_thin", "solid")

        return self.lanelet(bound(1), bound(-1), more, speed_limit="50")


def scene() -> Scene:
    """Draw a road along x with a lane each way, another across it, and a light with a stop line for who drives east."""
    street = _Street(local=True)
    line = street.way([(STOP_LINE, 0.0), (STOP_LINE, -3.5)], "stop_line", "")
    head = street.way([(OUT + 3.0, -3.0), (OUT + 3.0, -4.0)], "traffic_light", "red_yellow_green")
    light = street.element("traffic_light", refers=[head], ref_line=[line])
    number = street.count
    for y, ends in ((-1.75, (0.0, IN, OUT, 400.0)), (1.75, (400.0, OUT, IN, 0.0))):
        for k in range(3):
            street.lane((ends[k], y), (ends[k + 1], y), light if y < 0.0 and k == 0 else "")
    for x, ends in ((155.0, (60.0, 6.0, -6.0, -60.0)), (159.5, (-60.0, -6.0, 6.0, 60.0))):
        for k in range(3):
            street.lane((x, ends[k]), (x, ends[k + 1]))
    left, right = (street.way([(x, -9.0), (x, 9.0)], "zebra_marking") for x in (OUT + 20.0, OUT + 23.0))
    street.lanelet(left, right, subtype="crosswalk")
    return Scene(street.text(), number)


def road_users(t_s: float, n: int, **paths: int) -> Sequence[dict[str, Any]]:
    """Return a lead, somebody who comes, a pedestrian that stands by, and more that stand far off: n predicted objects."""
    way = SPEED * (t_s - T0)
    standing: dict[str, Any] = {
        "classes": [{"label": 7, "probability": 0.9}],
        "shape": {"type": 1, "dimensions": ros.xyz(0.6, 0.6, 1.7)},
    }
    near = [
        autoware.prediction(1, START + 40.0 + way, -1.75, 0.0, SPEED, **paths),
        autoware.prediction(2, 380.0 - way, 1.75, math.pi, SPEED, **paths),
        autoware.prediction(3, OUT + 21.0, -7.0, **standing, **paths),
    ]
    return [*near, *(autoware.prediction(10 + k, 10.0 * k, 30.0 + k, **paths) for k in range(n - len(near)))]


def changing(t_s: float) -> Elements:
    """Return what the light shows: red, then green."""
    return [autoware.element(autoware.RED if t_s - T0 < RED_S else autoware.GREEN)]


def messages(light: int, n: int = 3, shows: Callable[[float], Elements] = changing) -> list[ros.Message]:
    """Return the messages in the order of their times."""
    found = autoware.parameters(T0 - 1.0, **autoware.PARAMETERS)
    for k in range(int(SECONDS * HERTZ) + 1):
        t_s = T0 + k / HERTZ
        place = START + SPEED * (t_s - T0) - AHEAD, -1.75
        found.append(ros.odometry(t_s, *place, 0.0, SPEED, child="base_link", topic="/localization/kinematic_state"))
        if k % (HERTZ // 10) == 0:
            found += [
                autoware.predictions(t_s, *road_users(t_s, n)),
                autoware.lights(t_s, {light: shows(t_s)}),
                ros.report("TurnIndicatorsReport", t_s, report=1),
            ]
    return sorted(found, key=lambda message: message[2])


def write(folder: Path, n: int = 3, shows: Callable[[float], Elements] = changing) -> tuple[Path, Path]:
    """Write the log and its map."""
    drawn = scene()
    (folder / "map.osm").write_text(drawn.text, encoding="utf-8")
    return autoware.write(folder / "drive.mcap", messages(drawn.light, n, shows)), folder / "map.osm"
