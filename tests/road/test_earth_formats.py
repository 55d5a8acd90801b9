"""Geo references of SUMO nets and CommonRoad maps, against pyproj, sumolib and the nodes that netconvert was given."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from drivelint.formats.map_registry import load_map, read_source
from drivelint.road.map_reader import MapSource, MapTables
from tests.formats.commonroad.scenario_text import lanelet, scenario
from tests.road.earth import KARLSRUHE, UTM, geo_of, lon_lat, metres_apart, row_of
from tests.sumo import world

MUNICH = (11.5755, 48.1374)


def by_pyproj(reference: str, x: float, y: float) -> tuple[float, float]:
    pyproj = pytest.importorskip("pyproj")
    lon, lat = pyproj.Transformer.from_crs(reference, "EPSG:4326", always_xy=True).transform(x, y)
    return lon, lat


def reasons(environment: MapTables) -> list[str]:
    rows = environment.tables["map_quality"].to_pylist()
    return [row["message"] for row in rows if row["check_id"] == "geo_reference_unusable"]


def sumo_net(location: str) -> MapTables:
    lane = '<lane id="e_0" index="0" speed="13.89" length="50" shape="0.00,0.00 50.00,0.00"/>'
    text = f'<net version="1.20">{location}<edge id="e" from="a" to="b">{lane}</edge></net>'
    return load_map(MapSource("small.net.xml", text.encode()))


def test_the_offset_of_a_net_was_added_to_the_projection() -> None:
    environment = sumo_net(f'<location netOffset="-691000.00,-5334000.00" projParameter="{UTM}"/>')
    assert row_of(environment)["geo_usable"]
    (found,) = lon_lat(geo_of(environment), (30.0, -4.0))
    assert metres_apart(found, by_pyproj(UTM, 691_030.0, 5_333_996.0)) < 0.01


@pytest.mark.parametrize(
    ("location", "phrase"),
    [
        ("", None),
        ('<location netOffset="0.00,0.00" projParameter="!"/>', None),
        ('<location netOffset="0.00,0.00" projParameter="-"/>', "PROJ"),
        (f'<location netOffset="0.00" projParameter="{UTM}"/>', "its netOffset is '0.00'"),
        (f'<location netOffset="0.00,0.00" projParameter="{UTM}"/>', "placeholder"),
    ],
)
def test_a_net_without_places(location: str, phrase: str | None) -> None:
    environment = sumo_net(location)
    assert not row_of(environment)["geo_usable"]
    found = reasons(environment)
    assert len(found) == (phrase is not None)
    assert (phrase or "") in "".join(found)


@pytest.mark.skipif(world.tool("netconvert") is None, reason="SUMO is not installed")
def test_a_net_that_netconvert_makes_of_longitudes_and_latitudes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its edge is 200 m of a parallel: at its ends, the middle of the lane is half a lane's width south of the nodes."""
    tool = world.tool("netconvert")
    assert tool is not None
    ends = (MUNICH, (MUNICH[0] + 200.0 / 74_400.0, MUNICH[1]))
    nodes = "".join(f'<node id="{name}" x="{lon}" y="{lat}"/>' for name, (lon, lat) in zip("ab", ends, strict=True))
    (tmp_path / "n.nod.xml").write_text(f"<nodes>{nodes}</nodes>")
    (tmp_path / "e.edg.xml").write_text('<edges><edge id="e" from="a" to="b" numLanes="1"/></edges>')
    made = tmp_path / "made.net.xml"
    given = ["-n", str(tmp_path / "n.nod.xml"), "-e", str(tmp_path / "e.edg.xml"), "--proj.utm", "-o", str(made)]
    subprocess.run([tool, *given], check=True, capture_output=True)
    environment = load_map(read_source(made))
    points = environment.tables["lane_point"].select(["x_m", "y_m"]).to_pylist()
    found = lon_lat(geo_of(environment), *((p["x_m"], p["y_m"]) for p in points))
    for place, node in ((found[0], ends[0]), (found[-1], ends[1])):
        assert metres_apart(place, (node[0], node[1] - 1.6 / 111_195.0)) < 0.5
    monkeypatch.syspath_prepend(str(Path(pytest.importorskip("sumo").SUMO_HOME) / "tools"))
    sumolib = pytest.importorskip("sumolib")
    theirs = sumolib.net.readNet(str(made))
    for place, point in zip(found, points, strict=True):
        assert metres_apart(place, theirs.convertXY2LonLat(point["x_m"], point["y_m"])) < 0.01


def commonroad(location: str) -> MapTables:
    return load_map(MapSource("a.xml", scenario(f"<location>{location}</location>", lanelet(1, 0.0)).encode()))


def geo_transformation(reference: str, **more: str) -> str:
    inner = "".join(f"<{name}>{value}</{name}>" for name, value in more.items())
    inner = f"<additionalTransformation>{inner}</additionalTransformation>" if more else ""
    return f"<geoTransformation><geoReference>{reference}</geoReference>{inner}</geoTransformation>"


def test_the_translation_of_a_commonroad_map_leads_to_the_projection() -> None:
    moved = commonroad(
        geo_transformation(UTM, xTranslation="691000", yTranslation="5334000.5", zRotation="0.0", scaling="1.0")
    )
    (found,) = lon_lat(geo_of(moved), (30.0, -4.0))
    assert metres_apart(found, by_pyproj(UTM, 691_030.0, 5_333_996.5)) < 0.01
    plain = commonroad(geo_transformation(KARLSRUHE))
    (found,) = lon_lat(geo_of(plain), (30.0, -4.0))
    assert metres_apart(found, by_pyproj(KARLSRUHE, 30.0, -4.0)) < 0.01


@pytest.mark.parametrize(
    ("location", "phrase"),
    [
        ("<gpsLatitude>44.86833</gpsLatitude><gpsLongitude>13.84806</gpsLongitude>", None),
        ("<gpsLatitude>999</gpsLatitude><gpsLongitude>999</gpsLongitude>", None),
        (geo_transformation(""), None),
        (geo_transformation(KARLSRUHE, zRotation="0.2"), "zRotation"),
        (geo_transformation(KARLSRUHE, scaling="2"), "scaling"),
        (geo_transformation(KARLSRUHE, xTranslation="east"), "xTranslation"),
        (geo_transformation("Karlsruhe"), "PROJ"),
    ],
)
def test_a_commonroad_map_without_places(location: str, phrase: str | None) -> None:
    environment = commonroad(location)
    assert not row_of(environment)["geo_usable"]
    found = reasons(environment)
    assert len(found) == (phrase is not None)
    assert (phrase or "") in "".join(found)
