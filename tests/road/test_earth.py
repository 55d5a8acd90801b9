"""Places on the earth: header offsets, references that give none, and real maps against pyproj or their own latitudes."""

from __future__ import annotations

import math
from pathlib import Path
from struct import pack
from types import SimpleNamespace

import pytest

from drivelint.drive.trace import DriveInput, IngestOptions
from drivelint.engine.batch import drive_with_map
from drivelint.engine.map_library import MapLibrary
from drivelint.formats import read_trace
from drivelint.formats.map_registry import load_map, read_source
from drivelint.formats.safe_xml import parse_map
from drivelint.report.progress import Silent
from drivelint.result.model import Result
from drivelint.road.geo_reference import GeoFrame, why_unusable
from drivelint.road.map_reader import MapSource, MapTables
from drivelint.run import CheckOptions, check
from tests.engine.few_states import log_of, states
from tests.formats.opendrive.xodr import xodr
from tests.formats.osi import osi_log
from tests.report.pages import Parsed, page
from tests.road.earth import KARLSRUHE, UTM, geo_of, lon_lat, metres_apart, row_of
from tests.shared_data import shared

FIXTURE = Path(__file__).resolve().parents[2] / "fixtures" / "overtake"


def xodr_with(reference: str, offset: str = "") -> MapTables:
    header = '<header revMajor="1" revMinor="6"/>'
    said = f"<geoReference><![CDATA[{reference}]]></geoReference>{offset}"
    text = xodr().replace(header, header.replace("/>", f">{said}</header>"))
    return load_map(MapSource("m", text.encode()))


def test_a_header_offset_moves() -> None:
    """UTM's easting 500 km is the central meridian of the zone, 9 degrees."""
    environment = xodr_with(UTM, '<offset x="499990" y="5427990.5" z="110" hdg="0"/>')
    row = row_of(environment)
    assert [row[f"geo_offset_{part}"] for part in ("x_m", "y_m", "z_m", "yaw_rad")] == [499990.0, 5427990.5, 110.0, 0.0]
    assert row["geo_usable"]
    ((lon, lat),) = lon_lat(geo_of(environment), (10.0, 9.5))
    assert lon == pytest.approx(9.0, abs=1e-9)
    assert lat == pytest.approx(5_428_000.0 / 0.9996 / 111_195.0, abs=0.2)  # meridian arc on a sphere


def test_the_north_of_a_map_is_the_north() -> None:
    """carla 0.9.16 has this mirrored: see `findings/carla-mirrored-latitude.sh`. It also ignores a false easting and northing, and UTM.

    Source: OpenDRIVE 1.8, 8.2: in a projection x is the east and y the north. The metres are those of WGS 84 at 49 degrees.
    """
    shifted = KARLSRUHE.replace("+lon_0=8.4", "+lon_0=8.4 +x_0=500000 +y_0=100000")
    for reference, x, y in ((KARLSRUHE, 0.0, 0.0), (shifted, 500_000.0, 100_000.0)):
        begin, north, east = lon_lat(geo_of(xodr_with(reference)), (x, y), (x, y + 1000.0), (x + 1000.0, y))
        assert begin == pytest.approx((8.4, 49.0), abs=1e-9)
        assert north == pytest.approx((8.4, 49.0 + 1000.0 / 111_209.0), abs=1e-6)
        assert east == pytest.approx((8.4 + 1000.0 / 73_172.0, 49.0), abs=1e-6)


def test_a_header_offset_turns_first_and_moves_then() -> None:
    """A quarter turn: x of the file runs north, y west. Within a degree of its origin, the projection is a plane."""
    turned = xodr_with(KARLSRUHE, f'<offset x="1000" y="2000" hdg="{math.pi / 2}"/>')
    plain = lon_lat(geo_of(xodr_with(KARLSRUHE)), (1000.0 - 30.0, 2000.0 + 40.0))
    assert lon_lat(geo_of(turned), (40.0, 30.0)) == [pytest.approx(plain[0], abs=1e-11)]
    assert lon_lat(geo_of(turned), (30.0, 40.0)) != [pytest.approx(plain[0], abs=1e-6)]


def test_the_network_stays_in_its_own_coordinates() -> None:
    moved, plain = xodr_with(KARLSRUHE, '<offset x="1000" y="2000" hdg="1"/>'), xodr_with(KARLSRUHE)
    for column in ("x_m", "y_m", "tx", "left_x_m"):
        assert moved.tables["lane_point"][column].equals(plain.tables["lane_point"][column])


def test_a_map_that_was_moved_to_the_log_is_moved_back() -> None:
    """`--map-offset` is added to the map's coordinates, before the header's turn as after it."""
    said = f"<geoReference>{KARLSRUHE}</geoReference><offset x='10' y='20' hdg='0.3'/>"
    text = xodr().replace('revMinor="6"/>', f'revMinor="6">{said}</header>').encode()
    own = geo_of(load_map(MapSource("m", text)))
    moved = geo_of(load_map(MapSource("m", text), offset=(300.0, -50.0)))
    assert lon_lat(moved, (345.0, -43.0)) == [pytest.approx(lon_lat(own, (45.0, 7.0))[0], abs=1e-12)]


@pytest.mark.sample(8, ci=8)
@pytest.mark.parametrize(
    ("reference", "place", "why"),
    [
        ("+proj=tmerc +lat_0=0 +lon_0=0 +k=1 +datum=WGS84", (100.0, 9.0), "placeholder"),
        ("EPSG:3857", (100.0, -9.0), "placeholder"),
        ("EPSG:32632", (100.0, 9.0), "placeholder"),
        ("EPSG:32732", (100.0, 9.0), "placeholder"),
        ("+proj=utm +zone=32 +lat_0=37.4 +lon_0=-122.1 +datum=WGS84", (100.0, 9.0), "placeholder"),
        ("Karlsruhe", (100.0, 9.0), "cannot read"),
        ("+proj=utm", (100.0, 9.0), "cannot read"),
        ("+proj=longlat +datum=WGS84", (8.4, 49.0), "unit"),
        ("EPSG:4326", (30.0, 49.0), "unit"),
        ("+proj=tmerc +lat_0=49 +lon_0=8.4 +datum=WGS84", (1e9, 1e9), "no latitude and longitude"),
        (KARLSRUHE, (100.0, 9.0), None),
        ("+proj=tmerc +lat_0=0.3476 +lon_0=32.58 +datum=WGS84", (100.0, 9.0), None),  # Kampala, near the equator
        ("EPSG:32632", (456_000.0, 5_430_000.0), None),
        ("EPSG:3857", (935_000.0, 6_275_000.0), None),
        ("EPSG:25832", (456_000.0, 5_430_000.0), None),
        ("+proj=ortho +lat_0=49 +lon_0=8.4 +datum=WGS84", (100.0, 9.0), None),
    ],
)
def test_what_gives_positions(reference: str, place: tuple[float, float], why: str | None) -> None:
    found = why_unusable(GeoFrame(reference), *place)
    assert found is None if why is None else why in (found or "")


@pytest.mark.parametrize(
    ("reference", "offset", "phrase"),
    [
        ("+proj=tmerc +lat_0=0 +lon_0=0", "", "placeholder"),
        ("nonsense", "", "PROJ"),
        (UTM, '<offset x="a" y="0"/>', "x='a'"),
    ],
)
def test_a_map_without_positions_says_why(reference: str, offset: str, phrase: str) -> None:
    environment = xodr_with(reference, offset)
    (row,) = [r for r in environment.tables["map_quality"].to_pylist() if r["check_id"] == "geo_reference_unusable"]
    assert row["severity"] == "info"
    assert phrase in row["message"]
    assert not row_of(environment)["geo_usable"]
    library = SimpleNamespace(find=lambda log: (environment, log), doubts_on_map=lambda *_: {})
    assert drive_with_map(log_of(states(5.0)), library).geo is None  # type: ignore[arg-type]
    log = log_of(states(5.0), reference=KARLSRUHE)
    assert drive_with_map(log, library).geo == GeoFrame(KARLSRUHE)  # type: ignore[arg-type]


def test_a_map_without_a_reference_says_nothing_of_it() -> None:
    environment = load_map(MapSource("m", xodr().encode()))
    assert row_of(environment)["geo_usable"] is None
    assert "geo_reference_unusable" not in environment.tables["map_quality"]["check_id"].to_pylist()


def test_the_maps_reference_goes_before_the_logs() -> None:
    assert geo_of(xodr_with(KARLSRUHE), reference=UTM).reference == KARLSRUHE


def test_the_reference_and_offset_of_an_osi_log(tmp_path: Path) -> None:
    """Fields 14 and 20 of the first ground truth: x and y (fields 1 and 2 of the vector in field 1) and yaw (field 2)."""
    vector = b"\x09" + pack("<d", 456_000.0) + b"\x11" + pack("<d", 5_430_000.0)
    frame = b"\x0a" + bytes([len(vector)]) + vector + b"\x11" + pack("<d", 0.25)
    messages = []
    for i in range(3):
        truth = osi_log.frame(i * 50_000_000)
        osi_log.moving(truth, 0, 0.5 * i, 0.0)
        said = b"\x72" + bytes([len(UTM)]) + UTM.encode() + b"\xa2\x01" + bytes([len(frame)]) + frame
        messages.append(
            osi_log.Out("osi3.GroundTruth", "gt", i * 50_000_000, truth.SerializeToString() + (b"" if i else said))
        )
    trace = read_trace(osi_log.write(tmp_path / "log.mcap", messages), IngestOptions(ego="0"))
    assert drive_with_map(trace, MapLibrary(DriveInput())).geo == GeoFrame(UTM, 456_000.0, 5_430_000.0, yaw_rad=0.25)


def test_an_osi_log_whose_reference_is_a_placeholder(tmp_path: Path) -> None:
    truth = osi_log.frame(0)
    osi_log.moving(truth, 0, 10.0, 0.0)
    said = b"\x72" + bytes([len(UTM)]) + UTM.encode()
    path = osi_log.write(
        tmp_path / "log.mcap", [osi_log.Out("osi3.GroundTruth", "gt", 0, truth.SerializeToString() + said)]
    )
    drive = drive_with_map(read_trace(path, IngestOptions(ego="0")), MapLibrary(DriveInput()))
    assert drive.geo is None
    rows = [r for r in drive.trace.tables["quality"].to_pylist() if r["check_id"] == "geo_reference_unusable"]
    assert [row["severity"] for row in rows] == ["info"]
    assert "the log's geo reference" in rows[0]["message"]


@pytest.mark.ci
@pytest.mark.parametrize("name", ["cav_loop/loop_geo_RHD.xodr", "overtake_case_study/t_junction.xodr"])
def test_a_real_map_against_pyproj(name: str) -> None:
    pyproj = pytest.importorskip("pyproj")
    environment = load_map(read_source(shared(name)))
    points = environment.tables["lane_point"].select(["x_m", "y_m"]).to_pylist()[::50]
    to_earth = pyproj.Transformer.from_crs(row_of(environment)["geo_reference"], "EPSG:4326", always_xy=True)
    places = [(p["x_m"], p["y_m"]) for p in points]
    assert len(places) > 3
    for found, (x, y) in zip(lon_lat(geo_of(environment), *places), places, strict=True):
        assert metres_apart(found, to_earth.transform(x, y)) < 1.0


@pytest.mark.parametrize("name", ["maps/Town10HD.xodr", "maps/circle_300m.xodr", "osi/soderleden.xodr"])
def test_a_real_map_whose_reference_is_a_placeholder(name: str) -> None:
    """CARLA's town is at 0,0; esmini's roads are in a UTM zone with a latitude and longitude that are of another place."""
    row = row_of(load_map(read_source(shared(name))))
    assert row["geo_reference"]
    assert row["geo_usable"] is False


@pytest.mark.ci
def test_a_lanelet2_map_against_its_own_latitudes() -> None:
    """A node of the map that bounds a lane has a latitude and a longitude in the file, and x and y in our tables."""
    pytest.importorskip("lanelet2")
    source = read_source(shared("maps/lanelet2_mapping_example.osm"))
    environment = load_map(source, origin=(49.0, 8.4))
    nodes = [(float(n.get("lon", "nan")), float(n.get("lat", "nan"))) for n in parse_map(source).iterfind("node")]
    bounds = [(p["left_x_m"], p["left_y_m"]) for p in environment.tables["lane_point"].to_pylist() if p["k"] == 0]
    assert len(bounds) > 20
    for found in lon_lat(geo_of(environment), *bounds):
        assert min(metres_apart(found, node) for node in nodes) < 1.0


def run_on(folder: Path, reference: str) -> Result:
    """Judge the fixture's collision on its road with a geo reference and an offset."""
    said = f'vendor="drivelint demo"><geoReference>{reference}</geoReference><offset x="50" y="1000" hdg="{math.pi / 2}"/></header>'
    text = (FIXTURE / "road.xodr").read_text("utf-8")
    road = folder / "road.xodr"
    road.write_text(text.replace('vendor="drivelint demo"/>', said), "utf-8")
    log, mapping = FIXTURE / "collision.csv", str(FIXTURE / "mapping.toml")
    return check(
        CheckOptions(
            traces=(str(log),), map=road, mapping=mapping, rules=("ukhc.no-collision",), out=folder, robustness=False
        ),
        Silent(),
    )


@pytest.mark.ci
def test_a_run_puts_findings_and_the_drive_on_the_earth(tmp_path: Path) -> None:
    result = run_on(tmp_path, KARLSRUHE)
    (found, *_) = result.findings.to_pylist()
    north, east = (
        1000.0 + found["x_m"],
        50.0 - found["y_m"],
    )  # a quarter turn; beside its origin the projection is a plane
    # radii of curvature of the ellipsoid at 49 degrees: 6,372 km along the meridian, 6,390 km across
    expected = (
        8.4 + math.degrees(east / 6_390_300 / math.cos(math.radians(49.0))),
        49.0 + math.degrees(north / 6_371_800),
    )
    assert metres_apart((found["lon"], found["lat"]), expected) < 1.0
    (drive,) = result.drives.to_pylist()
    assert 49.0 < drive["lat"] < found["lat"]
    links = [link for link in Parsed(page(result)).values("href") if link and link.startswith("https:")]
    place = f"{found['lat']:.6f}/{found['lon']:.6f}"
    assert links
    assert links[0] == f"https://www.openstreetmap.org/?mlat={place.replace('/', '&mlon=')}#map=18/{place}"


@pytest.mark.slow
def test_a_run_with_a_placeholder_has_no_places(tmp_path: Path) -> None:
    result = run_on(tmp_path, "+proj=tmerc +lat_0=0 +lon_0=0")
    for table in (result.findings, result.drives):
        assert table.num_rows
        assert table["lon"].null_count == table["lat"].null_count == table.num_rows
    (drive,) = result.drives.to_pylist()
    assert [q["severity"] for q in drive["quality"] if q["check_id"] == "geo_reference_unusable"] == ["info"]
    assert "openstreetmap" not in page(result)
