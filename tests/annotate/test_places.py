"""The drive on the earth in annotated logs, read by their own schemas, against pyproj."""

from __future__ import annotations

import json
import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from mcap.reader import SeekingReader

from drivelint.annotate import clock, places
from drivelint.annotate.tracks import Tracks
from drivelint.drive.trace import IngestOptions
from drivelint.formats import read_trace
from drivelint.formats.map_registry import load_map, read_source
from drivelint.road.geo_reference import GeoFrame
from tests.annotate.files import verify
from tests.annotate.runs import CASE, run, the
from tests.annotate.viewer import messages

KARLSRUHE = "+proj=tmerc +lat_0=49 +lon_0=8.4 +datum=WGS84"
OFFSET = (50.0, 1000.0, math.pi / 2)


def road(folder: Path, reference: str) -> Path:
    """Write the case's road with a geo reference and an offset that turns by a quarter."""
    x, y, turn = OFFSET
    said = f'vendor="drivelint demo"><geoReference>{reference}</geoReference><offset x="{x}" y="{y}" hdg="{turn}"/></header>'
    text = (CASE / "road.xodr").read_text("utf-8")
    assert 'vendor="drivelint demo"/>' in text
    (folder / "road.xodr").write_text(text.replace('vendor="drivelint demo"/>', said), "utf-8")
    return folder / "road.xodr"


def to_earth(x: Any, y: Any) -> list[tuple[float, float]]:
    """Return longitude and latitude of coordinates of the road by pyproj."""
    pyproj = pytest.importorskip("pyproj")
    there = pyproj.Transformer.from_crs(KARLSRUHE, "EPSG:4326", always_xy=True)
    east, north = OFFSET[0] - np.asarray(y), OFFSET[1] + np.asarray(x)
    return list(zip(*there.transform(east, north), strict=True))


def metres_apart(a: Any, b: Any) -> float:
    return math.hypot((a[0] - b[0]) * math.cos(math.radians(b[1])), a[1] - b[1]) * 111_195.0


@pytest.fixture(scope="module")
def annotated(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("earth")
    path = the(run(folder / "out", CASE / "near_miss.csv", map=road(folder, KARLSRUHE)), "near_miss")
    verify(path)
    return path


def ego_states() -> dict[int, tuple[float, float]]:
    trace = read_trace(CASE / "near_miss.csv", IngestOptions(mapping=str(CASE / "mapping.toml")))
    rows = trace.tables["actor_state"].to_pylist()
    return {row["t_ns"]: (row["x_m"], row["y_m"]) for row in rows if row["actor_id"] == "ego"}


def features(path: Path, kind: str) -> list[dict[str, Any]]:
    (said,) = messages(path, "geojson")
    content = json.loads(said.content.geojson)
    assert content["type"] == "FeatureCollection"
    return [feature for feature in content["features"] if feature["properties"]["kind"] == kind]


@pytest.mark.ci
def test_where_the_ego_is(annotated: Path) -> None:
    states, fixes = ego_states(), messages(annotated, "location")
    times = [said.log_time for said in fixes]
    assert times[0] == min(states)
    assert max(states) - times[-1] < 2e8
    assert set(np.diff(times)) == {200_000_000}, "the case has a state every 100 ms"
    for said in fixes:
        fix = said.content
        assert fix.timestamp.ToNanoseconds() == said.log_time
        assert metres_apart((fix.longitude, fix.latitude), *to_earth(*np.array([states[said.log_time]]).T)) < 0.01
        assert (fix.frame_id, fix.altitude, len(fix.position_covariance), fix.position_covariance_type) == (
            "base_link",
            0,
            0,
            0,
        )


@pytest.mark.ci
def test_the_messages_are_those_of_foxgloves_package(annotated: Path) -> None:
    package = pytest.importorskip("foxglove.messages", reason="the package foxglove-sdk is not installed")
    fix = messages(annotated, "location")[3].content
    stamp = package.Timestamp(sec=fix.timestamp.seconds, nsec=fix.timestamp.nanos)
    written = package.LocationFix(
        timestamp=stamp, frame_id=fix.frame_id, latitude=fix.latitude, longitude=fix.longitude
    )
    assert type(fix).FromString(written.encode()) == fix
    (layer,) = messages(annotated, "geojson")
    assert type(layer.content).FromString(package.GeoJson(geojson=layer.content.geojson).encode()) == layer.content


@pytest.mark.ci
def test_findings_are_points_on_the_map(annotated: Path) -> None:
    rows = {row["finding_id"]: row for row in pq.read_table(annotated.parents[1] / "findings.parquet").to_pylist()}
    found = features(annotated, "finding")
    assert {f["properties"]["finding_id"] for f in found} == rows.keys() != set()
    for feature in found:
        said = feature["properties"]
        row = rows[said["finding_id"]]
        assert {key: said.get(key) for key in ("rule_id", "severity", "margin", "profile")} == {
            key: row[key] for key in ("rule_id", "severity", "margin", "profile")
        }
        (there,) = to_earth([row["x_m"]], [row["y_m"]])
        assert metres_apart(feature["geometry"]["coordinates"], there) < 0.02


@pytest.mark.ci
def test_the_way_of_the_ego_is_a_line(annotated: Path) -> None:
    (way,) = features(annotated, "way")
    assert (way["geometry"]["type"], way["properties"]["name"]) == ("LineString", "ego")
    states = ego_states()
    expected = to_earth(*np.array([states[said.log_time] for said in messages(annotated, "location")]).T)
    for at, there in zip(way["geometry"]["coordinates"], expected, strict=True):
        assert metres_apart(at, there) < 0.02


@pytest.mark.ci
def test_drivable_lanes_are_polygons(annotated: Path) -> None:
    environment = load_map(read_source(CASE / "road.xodr"))
    drivable = {row["lanelet_id"] for row in environment.tables["lanelet"].to_pylist() if row["drivable"]}
    lanes = {f["properties"]["name"]: f["geometry"] for f in features(annotated, "lane")}
    assert lanes.keys() <= drivable
    assert lanes
    for name, geometry in lanes.items():
        rows = [row for row in environment.tables["lane_point"].to_pylist() if row["lanelet_id"] == name]
        (ring,) = geometry["coordinates"]
        assert ring[0] == ring[-1]
        area = sum(a[0] * b[1] - b[0] * a[1] for a, b in pairwise(ring))
        assert area > 0, "counter-clockwise, as RFC 7946 asks"
        bounds = [to_earth(*np.array([(r[f"{s}_x_m"], r[f"{s}_y_m"]) for r in rows]).T) for s in ("left", "right")]
        for at in ring:
            assert min(metres_apart(at, there) for there in bounds[0] + bounds[1]) < 0.02
        for there in (bounds[0][0], bounds[0][-1], bounds[1][0], bounds[1][-1]):
            assert min(metres_apart(at, there) for at in ring) < 0.02


@pytest.mark.sample(1, ci=1)
@pytest.mark.parametrize("reference", [None, "+proj=tmerc +lat_0=0 +lon_0=0"])
def test_without_a_usable_reference_there_is_none(tmp_path: Path, reference: str | None) -> None:
    given = road(tmp_path, reference) if reference else CASE / "road.xodr"
    path = the(run(tmp_path / "out", CASE / "near_miss.csv", map=given, rules=("ukhc.no-collision",)), "near_miss")
    with path.open("rb") as file:
        summary = SeekingReader(file).get_summary()
    assert summary is not None
    topics = {channel.topic for channel in summary.channels.values()}
    assert "/drivelint/scene" in topics
    assert not topics & {"/drivelint/location", "/drivelint/geojson"}


def test_a_way_is_not_drawn_across_a_hole() -> None:
    t_ns = np.arange(100, dtype=np.int64) * 100_000_000
    x = np.where((t_ns > 3_000_000_000) & (t_ns < 6_000_000_000), np.nan, t_ns * 1e-8)
    flat = np.zeros(100)
    ego = Tracks(["e"], ["car"], np.ones((1, 3)), [True], np.zeros(100, np.int32), t_ns, x, flat, flat, flat)
    nothing = pa.table({"lon": pa.array([], pa.float64())})
    message = places.geojson_message(nothing, ego, GeoFrame(KARLSRUHE), None, {})
    ways = json.loads(message[message.index(b"{") :])["features"]
    assert [len(way["geometry"]["coordinates"]) for way in ways] == [16, 20]
    times = [fix.log_time for fix in places.location_messages(ego, GeoFrame(KARLSRUHE), clock.of_trace(0), "")]
    assert len(times) == 36
    assert 3_000_000_000 in times
    assert not any(3_000_000_000 < t < 6_000_000_000 for t in times)
