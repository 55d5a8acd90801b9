"""Geo references: which map of a folder is the log's by them, and a doubt where map and log say other places."""

from __future__ import annotations

from pathlib import Path

import pytest

from drivelint.drive.trace import DriveInput, IngestOptions
from drivelint.engine.map_library import MapLibrary
from drivelint.formats import read_trace
from drivelint.road import geo_reference
from drivelint.road.map_reader import MapSource
from tests.engine.few_states import log_of, states
from tests.formats.opendrive.xodr import xodr
from tests.formats.osi import osi_log

UTM = "+proj=utm +zone=32 +ellps=GRS80 +units=m +no_defs"
KARLSRUHE = "+proj=tmerc +lat_0=49 +lon_0=8.4 +k=1 +x_0=0 +y_0=0 +datum=WGS84"


@pytest.mark.parametrize(
    ("first", "second", "same", "comparable"),
    [
        (UTM, "+units=m   +proj=utm +ellps=GRS80 +zone=32.0", True, False),
        (KARLSRUHE, "+proj=tmerc +lat_0=49.0000000000001 +lon_0=8.40 +datum=WGS84 +vunits=m", True, False),
        (KARLSRUHE, KARLSRUHE.replace("8.4", "8.5"), False, True),
        (KARLSRUHE, KARLSRUHE.replace("x_0=0", "x_0=500"), False, True),
        (UTM, KARLSRUHE, False, True),
        (UTM, "EPSG:32632", False, False),
        ("EPSG:32632", " EPSG:32632\n", True, False),
    ],
)
def test_references(first: str, second: str, same: bool, comparable: bool) -> None:
    assert (geo_reference.is_same_reference(first, second), geo_reference.is_conflicting_reference(first, second)) == (
        same,
        comparable,
    )
    assert geo_reference.is_same_reference(second, first) == same


def with_reference(text: str | None) -> str:
    header = '<header revMajor="1" revMinor="6"/>'
    assert xodr().count(header) == 1
    said = "" if text is None else f"<geoReference><![CDATA[{text}]]></geoReference>"
    return xodr().replace(header, header.replace("/>", f">{said}</header>"))


def test_the_reference_of_a_map() -> None:
    found = [
        geo_reference.opendrive_geo_reference(MapSource("m", with_reference(text).encode()))
        for text in (UTM, None, " ")
    ]
    assert found == [UTM, None, None]
    assert (
        geo_reference.opendrive_geo_reference(MapSource("m", f"<header><geoReference>\n{UTM}</geoReference>".encode()))
        == UTM
    )


def put(folder: Path, **references: str | None) -> MapLibrary:
    for name, text in references.items():
        (folder / f"{name}.xodr").write_text(with_reference(text), "utf-8")
    return MapLibrary(DriveInput(map_dir=folder, handedness="rht"))


def test_the_map_of_the_logs_reference(tmp_path: Path) -> None:
    """All lie at the same coordinates: the place does not tell them apart."""
    library = put(tmp_path, here=KARLSRUHE, there=UTM, nowhere=None)
    found, _ = library.find(log_of(states(5.0), reference=KARLSRUHE + " +no_defs"))
    assert found is not None
    assert found.environment_id.startswith("here")
    assert library.doubts_on_map(log_of(states(5.0), reference=KARLSRUHE), found) == {}
    assert library.doubts_on_map(log_of(states(5.0), reference=None), found) == {}
    doubt = library.doubts_on_map(log_of(states(5.0), reference=UTM), found)
    assert doubt.keys() == {"geo_reference_differs"}
    assert "+lat_0=49" in doubt["geo_reference_differs"]
    assert library.doubts_on_map(log_of(states(5.0), reference="EPSG:32632"), found) == {}


def test_the_reference_of_an_osi_log(tmp_path: Path) -> None:
    """Field 14 of the first ground truth, in a file's own schema or in none."""
    messages = []
    for i in range(3):
        truth = osi_log.frame(i * 50_000_000)
        osi_log.moving(truth, 0, 10.0 * i, 0.0)
        said = b"\x72" + bytes([len(UTM)]) + UTM.encode() if i == 0 else b""
        messages.append(osi_log.Out("osi3.GroundTruth", "gt", i * 50_000_000, truth.SerializeToString() + said))
    path = osi_log.write(tmp_path / "log.mcap", messages)
    assert read_trace(path, IngestOptions(ego="0")).geo_reference == UTM
    raw = tmp_path / "log.osi"
    raw.write_bytes(b"".join(len(m.data).to_bytes(4, "little") + m.data for m in messages))
    assert read_trace(raw, IngestOptions(ego="0")).geo_reference == UTM
