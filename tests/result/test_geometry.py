"""Result files are GeoParquet: geopandas and DuckDB read each, and the shapes are what the other columns say."""

from __future__ import annotations

import json
import math
import re
from typing import TYPE_CHECKING, Any

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import shapely
from shapely import affinity

from drivelint.arrays import replace_columns
from drivelint.audit.worker import TABLES
from drivelint.report.outputs import write
from drivelint.resources import folder as folder_of
from drivelint.result.files import parquet_bytes
from drivelint.result.geometry import GEOMETRIES_OF_TABLE, with_geometry
from drivelint.result.load import load_result
from drivelint.result.names import TABLE_OF_FILE
from drivelint.result.schemas import empty_table
from drivelint.sql import store
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.result.model import Result

FILES = {
    stem: GEOMETRIES_OF_TABLE[table]["geom"]
    for stem, table in TABLE_OF_FILE.items()
    if "geom" in GEOMETRIES_OF_TABLE.get(table, ())
}


@pytest.fixture(scope="module")
def result(overtakes: Result) -> Result:
    return overtakes


@pytest.fixture(scope="module")
def folder(result: Result, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("out")
    write(result, out)
    return out


def geo_frame(path: Path) -> Any:
    """Return a file as geopandas reads it, which imports pandas."""
    import geopandas

    return geopandas.read_parquet(path)


@pytest.mark.parametrize("stem", FILES)
def test_geopandas_and_duckdb_read_the_same_valid_geometry(folder: Path, stem: str) -> None:
    path = folder / f"{stem}.parquet"
    frame = geo_frame(path)
    assert frame.crs is None
    assert set(frame.geom_type) == {FILES[stem].kind}
    assert len(frame) > 0
    if stem != "tracks":  # a parked car's track is a line without length
        assert frame.is_valid.all()
    with store.open_without_creating_tables() as con:
        kind = con.execute(f"SELECT DISTINCT typeof(geom) FROM '{path}'").fetchall()
        wkb = [bytes(each) for (each,) in con.execute(f"SELECT ST_AsWKB(geom) FROM '{path}'").fetchall()]
    assert kind == [("GEOMETRY",)]
    assert wkb == [shapely.to_wkb(each, byte_order=1) for each in frame.geometry]


def written_crs(path: Path) -> dict[str, object]:
    """Return what a GeoParquet file says of its column `geom`."""
    about: dict[str, object] = json.loads(pq.read_schema(path).metadata[b"geo"])["columns"]["geom"]
    return about


@pytest.mark.parametrize("stem", FILES)
def test_the_metres_of_a_map_are_never_taken_for_longitude_and_latitude(folder: Path, stem: str) -> None:
    """GeoParquet 1.1: without the key `crs`, coordinates are longitude and latitude (OGC:CRS84); with null, nothing is said of them."""
    about = written_crs(folder / f"{stem}.parquet")
    assert "crs" in about
    assert about["crs"] is None


def test_duckdb_forgets_that_there_is_no_reference(folder: Path, tmp_path: Path) -> None:
    """DuckDB 1.5.5 writes a geometry without `crs`, also after ST_Transform from one that has it: no file of ours is written by its COPY.

    If this fails, it may be. geopandas 1.2 takes such metres for degrees.
    """
    metres, moved = tmp_path / "metres.parquet", tmp_path / "moved.parquet"
    with store.open_without_creating_tables() as con:
        con.execute(f"COPY (SELECT geom FROM '{folder / 'tracks.parquet'}') TO '{metres}' (FORMAT parquet)")
        place = "ST_SetCRS(ST_Point(8.4, 49.0), 'EPSG:4326')"
        sql = f"SELECT ST_Transform({place}, 'EPSG:4326', 'EPSG:25832', always_xy := true) AS geom"
        con.execute(f"COPY ({sql}) TO '{moved}' (FORMAT parquet)")
    for path in (metres, moved):
        assert "crs" not in written_crs(path)
        assert geo_frame(path).crs.equals("OGC:CRS84")


def test_what_duckdb_writes_has_no_geometry() -> None:
    """The files of an audit's batches, which DuckDB packs, have none; nor do statements take a geometry out of ST_Transform."""
    for table in TABLES:
        assert "geom" not in empty_table(TABLE_OF_FILE[table]).column_names
    transforms = re.compile(r"\bST_Transform\(", re.IGNORECASE)
    files = [*folder_of("queries").rglob("*.sql"), *(ROOT / "src").rglob("*.py")]
    assert {path.name for path in files if transforms.search(path.read_text("utf-8"))} == {
        "position.sql",
        "geo_reference.py",
    }


@pytest.mark.parametrize("stem", FILES)
def test_a_table_without_rows_is_read(stem: str, tmp_path: Path) -> None:
    path = tmp_path / "empty.parquet"
    table = TABLE_OF_FILE[stem]
    path.write_bytes(parquet_bytes(empty_table(table), table))
    assert len(geo_frame(path)) == 0


def test_a_result_comes_back_without_the_geometry(result: Result, folder: Path) -> None:
    again = load_result(folder)
    for stem in TABLE_OF_FILE:
        assert getattr(again, stem).equals(getattr(result, stem)), stem


def test_the_shapes_are_what_the_columns_say(folder: Path) -> None:
    """Boxes by turning and moving a rectangle; lanes as wide as the road's 5.5 m or less; spaces as long as they say."""
    scenes = geo_frame(folder / "scenes.parquet")
    for scene in scenes.itertuples():
        boxes = []
        for actor in scene.actors:
            half = actor["length_m"] / 2, actor["width_m"] / 2
            flat = affinity.rotate(shapely.box(-half[0], -half[1], *half), actor["yaw_rad"], (0, 0), use_radians=True)
            boxes.append(affinity.translate(flat, actor["x_m"], actor["y_m"]))
        assert shapely.hausdorff_distance(shapely.union_all(boxes), scene.geom) < 0.001
    for lane in geo_frame(folder / "lanes.parquet").itertuples():
        ends = shapely.points([(lane.left_x_m[0], lane.left_y_m[0]), (lane.right_x_m[-1], lane.right_y_m[-1])])
        assert shapely.distance(lane.geom.boundary, ends).max() == 0
        left, right = (
            shapely.linestrings(x, y) for x, y in ((lane.left_x_m, lane.left_y_m), (lane.right_x_m, lane.right_y_m))
        )
        assert lane.geom.area == pytest.approx(shapely.distance(left, right) * left.length, rel=0.01)
    for space in geo_frame(folder / "spaces.parquet").itertuples():
        length, width = space.length_m, space.geom.area / space.length_m
        assert space.geom.length == pytest.approx(2 * (length + width), rel=0.02)


def test_tracks_are_those_of_egos_and_of_the_others_of_findings(result: Result, folder: Path) -> None:
    tracks = geo_frame(folder / "tracks.parquet")
    told = {(row["drive_id"], row["object_id"]) for row in result.findings.to_pylist() if row["object_id"]}
    told |= {
        (row["drive_id"], row["object_id"])
        for row in result.verdicts.to_pylist()
        if row["object_id"] and row["near_miss"]
    }
    egos = {(row["drive_id"], row["ego_id"]) for row in result.verdicts.to_pylist()}
    assert set(zip(tracks["drive_id"], tracks["actor_id"], strict=True)) == told | egos
    assert set(zip(tracks[tracks.is_ego]["drive_id"], tracks[tracks.is_ego]["actor_id"], strict=True)) == egos
    km = dict(zip(result.drives["drive_id"].to_pylist(), result.drives["km"].to_pylist(), strict=True))
    for drive, rows in tracks[tracks.is_ego].groupby("drive_id"):
        assert rows.geom.length.sum() == pytest.approx(1000 * km[drive], rel=0.01)
    assert all(math.isfinite(x) for xs in tracks["x_m"] for x in xs)


def blank(kind: pa.DataType, *, lists: int) -> object:
    """Return a value of a type that says nothing: unknown numbers, in lists of this length."""
    if pa.types.is_list(kind):
        return [blank(kind.value_type, lists=lists) for _ in range(lists)]
    if pa.types.is_struct(kind):
        return {field.name: blank(field.type, lists=lists) for field in kind}
    return None


@pytest.mark.parametrize("lists", [0, 1, 4])
@pytest.mark.parametrize("table", GEOMETRIES_OF_TABLE)
def test_rows_without_a_known_coordinate_stay_and_have_no_geometry(table: str, lists: int) -> None:
    """Of nothing known at all, shapely makes no geometries rather than one for each row that has none."""
    schema = empty_table(table).schema
    row = {field.name: blank(field.type, lists=lists) for field in schema}
    rows = pa.table({field.name: pa.array([row[field.name]] * 3, field.type) for field in schema})
    made = with_geometry(rows, table)
    assert made.num_rows == 3
    for column in GEOMETRIES_OF_TABLE[table]:
        assert all(shapely.from_wkb(wkb).is_empty for wkb in made[column].to_pylist() if wkb is not None)
    assert made.drop_columns(list(GEOMETRIES_OF_TABLE[table])).to_pylist() == rows.to_pylist()


@pytest.mark.parametrize(("stem", "primary"), [("findings", "geom"), ("drives", "geom_lonlat")])
def test_places_on_the_earth_are_said_to_be_so(result: Result, stem: str, primary: str, tmp_path: Path) -> None:
    """GeoParquet 1.1: longitude first; geopandas and DuckDB read the reference of each column by itself."""
    table = TABLE_OF_FILE[stem]
    rows = getattr(result, stem)
    lon, lat = [8.4 + n / 1000 for n in range(rows.num_rows)], [49.0] * (rows.num_rows - 1) + [None]
    placed = replace_columns(rows, {"lon": lon, "lat": lat})
    path = tmp_path / "placed.parquet"
    path.write_bytes(parquet_bytes(placed, table))
    frame = geo_frame(path)
    assert frame.geometry.name == primary
    assert frame["geom_lonlat"].crs.equals("OGC:CRS84")
    assert [(each.x, each.y) for each in frame["geom_lonlat"][:-1]] == list(zip(lon, lat, strict=True))[:-1]
    assert frame["geom_lonlat"][len(frame) - 1] is None
    with store.open_without_creating_tables() as con:
        said = con.execute(f"SELECT DISTINCT ST_CRS(geom_lonlat) FROM '{path}' WHERE lat IS NOT NULL").fetchall()
    assert said == [("OGC:CRS84",)]
