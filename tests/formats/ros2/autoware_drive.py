"""A drive of twenty seconds as Autoware records it: through a junction with a light, on a Lanelet2 map, among others."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from tests.formats.lanelet2.test_reader import Drawing
from tests.formats.ros2 import autoware_log as autoware
from tests.formats.ros2 import ros_log as ros

if TYPE_CHECKING:
    from pathlib import Path

T0, SECONDS = 1_700_000_000.0, 20.0
SPEED = 8.0
AHEAD = 1.345
"""How far the centre of the sample vehicle's box lies ahead of its rear axle: half of 2.79 + 1.0 - 1.1."""
START = 20.0
STOP_LINE = 148.0
IN, OUT = 150.0, 165.0


class Scene(NamedTuple):
    """The map's text and the id of the regulatory element that is the light."""

    text: str
    light: int


class _Map(Drawing):
    def lane(self, a: tuple[float, float], b: tuple[float, float], more: str = "", **tags: str) -> int:
        """Draw a lanelet of 3.5 m whose middle runs from a to b."""
        along = math.atan2(b[1] - a[1], b[0] - a[0])
        off = 1.75 * -math.sin(along), 1.75 * math.cos(along)

        def bound(side: int) -> int:
            return self.way(
                [(round(x + side * off[0], 3), round(y + side * off[1], 3)) for x, y in (a, b)], "line_thin", "solid"
            )

        return self.lanelet(bound(1), bound(-1), more, speed_limit="50", **tags)


def scene() -> Scene:
    """Draw a road along x with a lane each way, another across it, and a light with a stop line for who drives east."""
    drawing = _Map(local=True)
    line = drawing.way([(STOP_LINE, 0.0), (STOP_LINE, -3.5)], "stop_line", "")
    head = drawing.way([(OUT + 3.0, -3.0), (OUT + 3.0, -4.0)], "traffic_light", "red_yellow_green")
    light = drawing.element(refers=[head], ref_line=[line]).replace("", "")
    number = drawing.count
    drawing.parts[-1] = drawing.parts[-1].replace('v="traffic_sign"', 'v="traffic_light"')
    for y, ends in ((-1.75, (0.0, IN, OUT, 400.0)), (1.75, (400.0, OUT, IN, 0.0))):
        for k in range(3):
            more = light if y < 0 and k == 0 else ""
            drawing.lane((ends[k], y), (ends[k + 1], y), more)
    for x, ends in ((155.0, (60.0, 6.0, -6.0, -60.0)), (159.5, (-60.0, -6.0, 6.0, 60.0))):
        for k in range(3):
            drawing.lane((x, ends[k]), (x, ends[k + 1]))
    drawing.lanelet(
        drawing.way([(OUT + 20.0, -9.0), (OUT + 20.0, 9.0)], "zebra_marking"),
        drawing.way([(OUT + 23.0, -9.0), (OUT + 23.0, 9.0)], "zebra_marking"),
        subtype="crosswalk",
    )
    return Scene(drawing.text() if hasattr(drawing, "text") else _text(drawing), number)


def _text(drawing: Drawing) -> str:
    order = sorted(drawing.parts, key=lambda part: ["<n", "<w", "<r"].index(part[:2]))
    return f"<?xml version='1.0'?><osm version='0.6'>{''.join(order)}</osm>"


def moment(k: int, hertz: float) -> float:
    return T0 + k / hertz


def others(t_s: float, n: int) -> list[dict[str, object]]:
    """Return a lead, somebody who comes, a pedestrian that stands by, and so many that stand far off, as predicted objects."""
    way = SPEED * (t_s - T0)
    found = [
        autoware.prediction(1, START + 40.0 + way, -1.75, 0.0, SPEED),
        autoware.prediction(2, 380.0 - way, 1.75, math.pi, SPEED),
        autoware.prediction(
            3,
            OUT + 21.0,
            -7.0,
            classes=[{"label": 7, "probability": 0.9}],
            shape={"type": 1, "dimensions": ros.xyz(0.6, 0.6, 1.7)},
        ),
    ]
    return [*found, *(autoware.prediction(10 + k, 10.0 * k, 30.0 + k) for k in range(n - len(found)))]


def messages(light: int, n: int = 3) -> list[ros.Message]:
    """Return the messages in the order of their times."""
    found = autoware.parameters(T0 - 1.0, **autoware.PARAMETERS)
    for k in range(int(SECONDS * 50) + 1):
        t_s = moment(k, 50)
        place = START + SPEED * (t_s - T0) - AHEAD, -1.75
        found.append(ros.odometry(t_s, *place, 0.0, SPEED, child="base_link", topic="/localization/kinematic_state"))
    for k in range(int(SECONDS * 10) + 1):
        t_s = moment(k, 10)
        color = autoware.RED if t_s - T0 < 9.0 else autoware.GREEN
        found += [
            autoware.predictions(t_s, *others(t_s, n)),
            autoware.lights(t_s, {light: [autoware.element(color)]}),
            ros.report("TurnIndicatorsReport", t_s, report=1),
        ]
    return sorted(found, key=lambda message: message[2])


def write(folder: Path, n: int = 3) -> tuple[Path, Path]:
    """Write the log and its map."""
    drawn = scene()
    (folder / "map.osm").write_text(drawn.text, encoding="utf-8")
    return autoware.write(folder / "drive.mcap", messages(drawn.light, n)), folder / "map.osm"
