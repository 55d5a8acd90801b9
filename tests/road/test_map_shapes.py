"""The geometries of a map: as large as the lanes, where their stations say, and the same lanes as the grid finds."""

from __future__ import annotations

import math
from functools import cache
from typing import TYPE_CHECKING

import pyarrow as pa
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from drivelint.engine.derive import derive
from drivelint.formats import load_map, read_source
from drivelint.sql import store
from drivelint.sql.derivations import derivations
from drivelint.sql.statements import statement
from tests.shared_data import ROOT, shared

if TYPE_CHECKING:
    from pathlib import Path

    import duckdb

pytestmark = pytest.mark.ci

FIXTURES = [
    f"fixtures/scenes/{name}.xodr" for name in ("exit-road", "overtake-at-junction", "overtake-on-bend", "clean-drive")
]
SHARED = ("maps/Town10HD.xodr", "maps/parking_demo.xodr", "maps/autoware_zalazone_smart_city.osm")
SLACK_M = 0.05
"""How far a lanelet's segments reach beyond its ends, see `lane_segment`."""
SIDEWAYS_M = 0.02
"""How far beyond its bounds, see `lane_occupancy`."""
CENTIMETRE = 0.01


@cache
def loaded(path: Path) -> duckdb.DuckDBPyConnection:
    """Return a database with a map, its geometries, and all tables derived from it that the tests ask."""
    con = store.connect(threads=1)
    environment = load_map(read_source(path))
    for table, rows in environment.tables.items():
        store.insert(con, table, rows)
    derive(con, ["_lane_cell", "junction_area", "road_surface"], are_map_tables=True)
    con.execute(
        "INSERT INTO data_log BY NAME SELECT 'd' AS drive_id, 'd' AS file_name, '' AS sha256, '' AS format, ? AS environment_id, "
        "0 AS t_start_ns, 0 AS t_end_ns, 0 AS n_states, false AS has_indicator, false AS has_brake_light, "
        "false AS has_acceleration, true AS in_sight",
        [environment.environment_id],
    )
    return con


def maps() -> list[object]:
    return [*(ROOT / name for name in FIXTURES), *SHARED]


def open_map(name: Path | str) -> duckdb.DuckDBPyConnection:
    return loaded(shared(name) if isinstance(name, str) else name)


@pytest.mark.parametrize("name", maps(), ids=str)
def test_every_shape_has_a_place(name: Path | str) -> None:
    """To a shape that is empty or has a coordinate of NaN, DuckDB 1.5.5 says the distance 0, which is that of a contact."""
    con = open_map(name)
    columns = con.execute(
        "SELECT table_name, column_name FROM duckdb_columns() WHERE data_type LIKE 'GEOMETRY%'"
    ).fetchall()
    assert {table for table, _ in columns} >= {"lanelet", "crossing", "road_object", "junction_area", "road_surface"}
    for table, column in columns:
        assert con.execute(f"SELECT count(*) FROM {table} WHERE has_no_place({column})").fetchall() == [(0,)], table


@pytest.mark.parametrize("name", maps(), ids=str)
def test_areas_are_those_of_the_lanes(name: Path | str) -> None:
    con = open_map(name)
    n, made, valid, worst = con.execute(
        "SELECT count(*), count(geom), bool_and(ST_IsValid(geom)), max(abs(ST_Area(geom) - area_m2) / area_m2) FROM lanelet"
    ).fetchall()[0]
    assert n > 0
    assert (made, valid) == (n, True)
    assert worst < 1e-9
    for table in ("crossing", "stop_line", "road_object", "traffic_signal"):
        assert con.execute(f"SELECT count(*) FROM {table} WHERE geom IS NULL OR NOT ST_IsValid(geom)").fetchall() == [
            (0,)
        ]


@pytest.mark.parametrize("name", SHARED)
def test_crossings_and_stop_lines_lie_across_their_lanes(name: str) -> None:
    con = open_map(name)
    crossings = con.execute(
        "SELECT ST_Area(c.geom), (c.s_end_m - c.s_start_m) * l.width_m, ST_Covers(ST_Buffer(l.geom, 0.001), c.geom) "
        "FROM crossing c JOIN lanelet l USING (environment_id, lanelet_id)"
    ).fetchall()
    for area, expected, inside in crossings:
        assert area == pytest.approx(expected, rel=0.35, abs=0.5)  # lanes become wider and narrower
        assert inside
    lines = con.execute(
        "SELECT apart_m(ST_StartPoint(s.geom), ST_Boundary(l.geom)), apart_m(ST_EndPoint(s.geom), ST_Boundary(l.geom)), "
        "ST_Length(s.geom), l.width_m FROM stop_line s JOIN lanelet l USING (environment_id, lanelet_id)"
    ).fetchall()
    for start, end, length, width in lines:
        assert max(start, end) < CENTIMETRE
        assert length == pytest.approx(width, rel=0.7)  # they flare at junctions
    assert crossings or lines


@pytest.mark.parametrize("name", FIXTURES[:2])
def test_junctions_and_roads_are_the_ground_of_their_lanes(name: str) -> None:
    con = open_map(ROOT / name)
    lanes = "SELECT sum(area_m2), max(area_m2) FROM lanelet WHERE drivable AND {}"
    for table, key in (("junction_area", "junction_id"), ("road_surface", "road_id")):
        found = con.execute(f"SELECT {key}, ST_Area(geom) FROM {table}").fetchall()
        assert found
        for which, area in found:
            whole, largest = con.execute(lanes.format(f"{key} = ?"), [which]).fetchall()[0]
            assert largest - CENTIMETRE <= area
            if table == "junction_area":
                assert area <= whole + CENTIMETRE
    assert con.execute("SELECT count(*) FROM lanelet l JOIN junction_area j USING (environment_id, junction_id) "
                       "WHERE drivable AND NOT ST_Covers(ST_Buffer(j.geom, 0.001), l.geom)").fetchall() == [(0,)]  # fmt: skip


places = st.lists(st.tuples(st.floats(0, 1), st.floats(0, 1), st.floats(-1.3, 1.3)), min_size=1, max_size=60)


@pytest.mark.parametrize("name", FIXTURES)
@given(places)
@settings(max_examples=25, deadline=None)
def test_the_grid_finds_the_lanes_that_contain_a_point(
    name: str, drawn_places: list[tuple[float, float, float]]
) -> None:
    """Places are drawn by lanelet, share of its length, and offset in half widths; ST_Intersects is the other opinion."""
    con = open_map(ROOT / name)
    shapes = con.execute(
        "SELECT lanelet_id, list(x_m ORDER BY k), list(y_m ORDER BY k), list(tx ORDER BY k), list(ty ORDER BY k), "
        "list(half_width_m ORDER BY k) FROM lane_point GROUP BY ALL ORDER BY lanelet_id"
    ).fetchall()
    xs, ys = [], []
    for which, along, across in drawn_places:
        _, x, y, tx, ty, half = shapes[min(int(which * len(shapes)), len(shapes) - 1)]
        k = min(int(along * (len(x) - 1)), len(x) - 2)
        u = along * (len(x) - 1) - k
        xs.append(x[k] + u * (x[k + 1] - x[k]) - across * half[k] * ty[k])
        ys.append(y[k] + u * (y[k + 1] - y[k]) + across * half[k] * tx[k])
    con.execute("DELETE FROM state_dynamics; DELETE FROM lane_occupancy")
    ids = [str(n) for n in range(len(xs))]
    rows = {"drive_id": ["d"] * len(xs), "actor_id": ids, "t_ns": pa.array([0] * len(xs)), "x_m": xs, "y_m": ys}
    store.insert(con, "state_dynamics", pa.table(rows))
    con.execute(f"INSERT INTO lane_occupancy BY NAME {derivations()['lane_occupancy'].sql}")
    missed = con.execute(f"""
        SELECT s.actor_id, l.lanelet_id FROM state_dynamics s
        JOIN lanelet l ON ST_Intersects(l.geom, ST_Point(s.x_m, s.y_m))
        ANTI JOIN lane_occupancy o ON o.actor_id = s.actor_id AND o.lanelet_id = l.lanelet_id
        WHERE ST_Distance(ST_Point(s.x_m, s.y_m), ST_Boundary(l.geom)) > {CENTIMETRE}
    """).fetchall()
    assert missed == []
    too_far = con.execute(f"""
        SELECT o.actor_id, o.lanelet_id FROM lane_occupancy o
        JOIN state_dynamics s USING (actor_id)
        JOIN lanelet l USING (lanelet_id)
        WHERE apart_m(ST_Point(s.x_m, s.y_m), l.geom) > {math.hypot(SLACK_M, SIDEWAYS_M) + CENTIMETRE}
    """).fetchall()
    assert too_far == []


def test_objects_are_areas_lines_and_points_in_one_map() -> None:
    """DuckDB 1.5.5 evaluates what two branches of a CASE share for every row: a polygon of two corners ends the statement."""
    outlines = {
        "area": ([0, 4, 4, 0], [0, 0, 2, 2]),
        "line": ([0, 3, 6], [1, 1, 1]),
        "two": ([0, 3], [1, 1]),
        "none": ([], []),
    }
    con = store.connect(threads=1)
    for name, (x, y) in outlines.items():
        con.execute(
            "INSERT INTO road_object BY NAME SELECT 'm' AS environment_id, ? AS object_id, 'obstacle' AS kind, '1' AS road_id, "
            "0.0 AS road_s_m, 7.0 AS x_m, 8.0 AS y_m, ?::DOUBLE[] AS outline_x_m, ?::DOUBLE[] AS outline_y_m",
            [name, x, y],
        )
    con.execute(statement("map_shapes/road_object"))
    found = dict(con.execute("SELECT object_id, ST_GeometryType(geom)::VARCHAR FROM road_object").fetchall())
    assert found == {"area": "POLYGON", "line": "LINESTRING", "two": "POINT", "none": "POINT"}
