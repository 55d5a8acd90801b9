"""A road over another one."""

from __future__ import annotations

import math
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests import blinding
from tests.formats.opendrive import xodr
from tests.scenes import Road, linked, plan

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive


@cache
def bridge(hand: str = "rht", rise_m: float | None = None, turn: float = math.pi / 2) -> tuple[Road, Road]:
    """Return a road of 600 m, and another of 400 m that crosses its middle; `rise_m`: so much higher (None: the map does not say).

    No junction joins them. The slope of the lower road makes the heights worth saying.
    """
    lower, upper = (0.0, 0.0, 0.0), (300.0 - 200 * math.cos(turn), -200 * math.sin(turn), turn)
    both = xodr.section(0, linked(1), linked(-1))

    def part(number: str, length: float, pose: tuple[float, float, float], height: float, slope: float) -> str:
        profile = f'<elevationProfile><elevation s="0" a="{height}" b="{slope}" c="0" d="0"/></elevationProfile>'
        more = '<type s="0" type="rural"><speed max="60" unit="mph"/></type>' + ("" if rise_m is None else profile)
        return xodr.road(
            number, plan(((length, 0.0),), pose), both, length, "", f'rule="{hand.upper()}"', more
        )  # fmt: skip

    text = xodr.xodr(part("1", 600.0, lower, 0.0, 0.01), part("2", 400.0, upper, 3.0 + (rise_m or 0.0), 0.0))
    environment = load_map(MapSource("bridge.xodr", text.encode()))
    return Road(environment, ((600.0, 0.0),), lower), Road(environment, ((400.0, 0.0),), upper)


def lifted(scene: Drive, heights: dict[str, float], slope: float = 0.0) -> Drive:
    """Return the drive with the actors' heights recorded: that of the ground at x = 0, and how it rises along x."""

    def change(states: pa.Table) -> pa.Table:
        x = states["x_m"].to_numpy(zero_copy_only=False)
        ground = np.array([heights.get(i, np.nan) for i in states["actor_id"].to_pylist()])
        z = pa.array(ground + slope * x, from_pandas=True)
        return states.set_column(states.schema.get_field_index("z_m"), "z_m", z)

    return blinding.change_table(scene, "actor_state", change)
