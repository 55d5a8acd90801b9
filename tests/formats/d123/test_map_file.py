"""Where the map of a 123D log lies: beside its files, or under the data root for its place."""

from __future__ import annotations

from pathlib import Path

from drivelint.formats.files import identify
from tests.formats.d123.files import Box, Frame, crosswalk, ego_states, straight, times, write_log, write_map
from tests.formats.logs import quality, read

LANE = [straight(1, -50, 90, 0.0)]


def write(folder: Path, *, dataset: str = "nuplan", location: str | None = "us-ma-boston") -> Path:
    frames = [Frame(t, [Box("p", 50.0, 9.0)]) for t in times(3)]
    return write_log(folder, frames, ego_states(3), dataset=dataset, location=location)


def test_a_map_of_its_own(tmp_path: Path) -> None:
    folder = write(tmp_path / "logs" / "nuplan_val" / "log")
    without = identify(folder)
    path = write_map(folder / "map.arrow", LANE)
    write_map(tmp_path / "maps" / "nuplan" / "nuplan_us-ma-boston.arrow", [straight(2, -50, 90, 0.0)])
    assert read(folder).embedded_map == path.read_bytes()
    assert identify(folder) != without


def test_the_map_of_its_place(tmp_path: Path) -> None:
    folder = write(tmp_path / "logs" / "nuplan_val" / "log")
    path = write_map(tmp_path / "maps" / "nuplan" / "nuplan_us-ma-boston.arrow", LANE)
    trace = read(folder)
    assert trace.embedded_map == path.read_bytes()
    assert any("the map of the place is nuplan_us-ma-boston.arrow" in note for note in trace.notes)


def test_no_map(tmp_path: Path) -> None:
    trace = read(write(tmp_path / "logs" / "nuplan_val" / "log"))
    assert trace.embedded_map is None
    (note,) = (note for note in trace.notes if "no map" in note)
    assert str(tmp_path / "logs" / "nuplan_val" / "log" / "map.arrow") in note
    assert str(tmp_path / "maps" / "nuplan" / "nuplan_us-ma-boston.arrow") in note


def test_no_map_and_no_place(tmp_path: Path) -> None:
    (note,) = (n for n in read(write(tmp_path / "log", location=None)).notes if "no map" in n)
    assert note.count(".arrow") == 1


def test_a_place_that_is_no_name_leads_nowhere(tmp_path: Path) -> None:
    folder = write(tmp_path / "a" / "logs" / "nuplan_val" / "log", location="/../../../secret")
    write_map(tmp_path / "secret.arrow", LANE)
    assert read(folder).embedded_map is None


def test_a_map_that_cannot_be_used(tmp_path: Path) -> None:
    folder = write(tmp_path / "logs" / "nuplan_val" / "log")
    (folder / "map.arrow").write_bytes(b"ARROW1 and no more")
    assert "not readable" in quality(read(folder))["own_map_unusable"]["message"]
    write_map(folder / "map.arrow", LANE, version="3.0.0")
    assert "py123d 3.0.0 wrote the file" in quality(read(folder))["own_map_unusable"]["message"]
    write_map(folder / "map.arrow", [crosswalk(1, 0, 0, 1, 1)])
    trace = read(folder)
    assert trace.embedded_map is None
    assert "map.arrow has no lanes" in quality(trace)["own_map_unusable"]["message"]
