"""Places on the road: lanelets, the ego's lane, its chain, and its box in the corridor."""

from __future__ import annotations

import math

import numpy as np
import pytest
from shapely import affinity
from shapely.geometry import LineString, Point, box

from tests.scenes import LANE, derived, drive, moving, road, rows, standing, tee, times


@pytest.mark.parametrize("way", ["straight", "south"])
def test_in_a_junction_it_is_on_the_lanelet_that_leads_on(way: str) -> None:
    """Lanes of the straight and of the turning road lie on each other; which one is driven shows behind the junction."""
    path = tee()[way]
    t = times(12.0)
    con = derived(
        drive([moving("ego", path, t, 150 + 6 * t, path.ego_d)], path.environment), tables=["ego_lane", "chain"]
    )
    lanes = [row["lanelet_id"] for row in rows(con, "FROM ego_lane ORDER BY t_ns")]
    expected = {"straight": ["1.0.-1", "10.0.-1", "2.0.-1"], "south": ["1.0.-1", "11.0.-1", "3.0.-1"]}[way]
    assert list(dict.fromkeys(lanes)) == expected
    assert sorted(lanes, key=expected.index) == lanes  # no flicker between them
    chain = [row["lanelet_id"] for row in rows(con, "FROM chain WHERE t_first_ns IS NOT NULL ORDER BY seq")]
    assert chain == expected
    assert rows(con, "SELECT count(DISTINCT chain_id) AS n FROM chain")[0]["n"] == 1


def test_several_laps_of_a_ring_are_one_way() -> None:
    """800 m round along the reference line; the ego's lane lies 1.75 m outside of it and is longer by 11 m."""
    way = road(((800.0, 2 * math.pi / 800.0),), ring=True)
    t = times(100.0, period=0.2)
    con = derived(drive([moving("ego", way, t, 5 + 20 * t, way.ego_d)], way.environment), tables=["ego_state"])
    state = rows(con, "FROM ego_state ORDER BY t_ns")
    longer = (800 / (2 * math.pi) + LANE / 2) / (800 / (2 * math.pi))
    assert [row["s_m"] for row in state] == pytest.approx(list((5 + 20 * t) * longer), abs=0.2)
    assert {row["chain_id"] for row in state} == {0}
    assert max(abs(row["d_m"]) for row in state) < 0.02
    visits = rows(con, "FROM chain WHERE t_first_ns IS NOT NULL ORDER BY seq")
    assert [row["t_first_ns"] / 1e9 for row in visits] == pytest.approx([0.0, 39.75, 79.75], abs=0.21)


@pytest.mark.parametrize("curvature", [1 / 60, -1 / 60])
@pytest.mark.parametrize(("d", "turned"), [(0.0, 0.0), (0.6, 0.2), (-1.6, -0.35), (1.2, 0.6)])
def test_the_box_in_a_bend(curvature: float, d: float, turned: float) -> None:
    """Corners against the boundaries as lines: a bend must not tilt the box. Positive: over the boundary."""
    way = road(((30.0, 0.0), (150.0, curvature), (30.0, 0.0)))
    ego = standing("ego", way, times(0.2), 100.0, way.ego_d + d, turned=turned)
    con = derived(drive([ego], way.environment), tables=["ego_corridor"])
    found = rows(con, "FROM ego_corridor WHERE chain_id = 0")[0]
    x, y, heading = (float(v) for v in way.at(100.0, way.ego_d + d))
    outline = affinity.translate(
        affinity.rotate(box(-2.4, -0.9, 2.4, 0.9), heading + turned, origin=(0, 0), use_radians=True), x, y
    )
    corners = [Point(c) for c in outline.exterior.coords[:-1]]
    fine = np.linspace(60, 140, 4001)

    def beyond(offset: float, sign: int) -> list[float]:
        """Signed distance of each corner from the line at this offset, positive on its `sign` side."""
        line = LineString(np.column_stack(way.at(fine, offset)[:2]))
        inner = LineString(np.column_stack(way.at(fine, offset - sign * 8)[:2]))
        return [line.distance(c) * (1 if inner.distance(c) > 8 else -1) for c in corners]

    left, right = beyond(way.ego_d + LANE / 2, 1), beyond(way.ego_d - LANE / 2, -1)
    assert found["left_out_m"] == pytest.approx(max(left), abs=0.02)
    assert found["left_in_m"] == pytest.approx(min(left), abs=0.02)
    assert found["right_out_m"] == pytest.approx(max(right), abs=0.02)
    assert found["right_in_m"] == pytest.approx(min(right), abs=0.02)
    assert found["d_m"] == pytest.approx(d, abs=0.02)
    assert found["heading_diff_rad"] == pytest.approx(turned, abs=0.01)
    centre = LineString(np.column_stack(way.at(np.linspace(0, 210, 9001), way.ego_d)[:2]))
    stations = [centre.project(c) for c in corners]
    assert found["front_s_m"] == pytest.approx(max(stations), abs=0.05)
    assert found["rear_s_m"] == pytest.approx(min(stations), abs=0.05)
