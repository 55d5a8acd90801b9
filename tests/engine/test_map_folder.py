"""A folder of maps: which one a log gets."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from drivelint.drive.trace import DriveInput
from drivelint.engine.map_folder import MapFolder
from drivelint.engine.map_library import MapLibrary
from drivelint.errors import MapError, UsageError
from tests.engine.few_states import log_of, states
from tests.formats.argoverse2.argoverse_log import points, road, segment
from tests.formats.commonroad.scenario_text import lanelet, scenario


def put(folder: Path, name: str, x: float = 0.0) -> None:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(scenario(lanelet(1, 0.0, x=x), benchmark="DEU_T-1"))


def map_name(folder: Path, log: str = "logs/drive.mcap", x: float = 5.0, embedded: bytes | None = None) -> str:
    library = MapLibrary(DriveInput(map_dir=folder))
    environment, _ = library.find(log_of(states(x), Path(log), embedded=embedded))
    assert environment is not None
    return environment.environment_id.split("-")[0]


def test_the_manifest_comes_first(tmp_path: Path) -> None:
    put(tmp_path, "drive.xml")
    put(tmp_path, "deep/other.xml")
    (tmp_path / "maps.csv").write_text("log, map\nx*.mcap, drive.xml\ndri*.mcap, deep/other.xml\n")
    assert map_name(tmp_path) == "other"


def test_then_the_logs_name_and_its_folders(tmp_path: Path) -> None:
    put(tmp_path, "drive.xml")
    put(tmp_path, "logs.xml")
    assert map_name(tmp_path) == "drive"
    assert map_name(tmp_path, "logs/b.mcap") == "logs"


def test_then_the_logs_own_map(tmp_path: Path) -> None:
    put(tmp_path, "a.xml")
    embedded = scenario(lanelet(1, 0.0), benchmark="GBR_T-1").encode()
    assert map_name(tmp_path, embedded=embedded) == "embedded"


def test_then_the_only_one_of_the_place(tmp_path: Path) -> None:
    put(tmp_path, "a.xml", x=0.0)
    put(tmp_path, "b.xml", x=1000.0)
    assert (map_name(tmp_path, x=5.0), map_name(tmp_path, x=1005.0)) == ("a", "b")


def test_without_a_map_of_the_place_a_drive_has_none_and_says_so(tmp_path: Path) -> None:
    put(tmp_path, "a.xml")
    library, log = MapLibrary(DriveInput(map_dir=tmp_path)), log_of(states(5000.0))
    environment, _ = library.find(log)
    assert environment is None
    assert library.doubts_on_map(log, environment) == {
        "map_not_in_folder": f"no map in {tmp_path.name} is of the place of drive.mcap: it is judged without one: name its map in maps.csv"
    }
    assert not library.doubts_on_map(log_of(states(5.0), Path("logs/other.mcap")), None)


def test_two_of_the_place_is_an_error_that_says_what_to_do(tmp_path: Path) -> None:
    put(tmp_path, "a.xml")
    put(tmp_path, "b.xml", x=10.0)
    with pytest.raises(
        MapError, match=r"a\.xml, b\.xml are all of the place of drive\.mcap: name its map in .*maps\.csv"
    ):
        map_name(tmp_path, x=12.0)


def test_maps_of_argoverse_are_searched_and_other_json_is_not(tmp_path: Path) -> None:
    archive = road(segment(1, points((0, 2), (50, 2)), points((0, -2), (50, -2))))
    (tmp_path / "log_map_archive_s.json").write_text(json.dumps(archive))
    (tmp_path / "scene.json").write_text('{"objects": []}')
    put(tmp_path, "a.xml", x=1000.0)
    assert MapFolder(tmp_path).sources()[1].name == "log_map_archive_s.json"
    assert [map_name(tmp_path, x=x) for x in (5.0, 1005.0)] == ["log_map_archive_s", "a"]


def test_a_map_that_cannot_be_read_is_passed_over_where_another_is_of_the_place(tmp_path: Path) -> None:
    put(tmp_path, "a.xml")
    (tmp_path / "broken.xodr").write_text("<OpenDRIVE/>")
    library, log = MapLibrary(DriveInput(map_dir=tmp_path)), log_of(states(5.0))
    environment, _ = library.find(log)
    assert environment is not None
    assert environment.environment_id.startswith("a-")
    assert "1 cannot, the first: " in library.doubts_on_map(log, environment)["map_unread"]
    (tmp_path / "broken.xodr").unlink()
    assert not MapLibrary(DriveInput(map_dir=tmp_path)).doubts_on_map(log, environment)
    (tmp_path / "broken.xodr").write_text("<OpenDRIVE/>")
    library, log = MapLibrary(DriveInput(map_dir=tmp_path)), log_of(states(5000.0))
    assert library.find(log)[0] is None
    assert "(1 could not be read, the first: " in library.doubts_on_map(log, None)["map_not_in_folder"]


@pytest.mark.parametrize(
    ("manifest", "why"),
    [
        ("name,map\na,b\n", "write the columns log,map"),
        ("log,map\na.mcap,gone.xodr\n", r"maps\.csv:2: there is no map 'gone\.xodr'"),
        ("log,map\n" + "[" * 60_000 + ",a.xml\n", r"maps\.csv:2: the glob in the column log has 60000 characters"),
    ],
)
def test_a_manifest_that_cannot_be_understood(tmp_path: Path, manifest: str, why: str) -> None:
    put(tmp_path, "a.xml")
    (tmp_path / "maps.csv").write_text(manifest)
    with pytest.raises(MapError, match=why):
        MapFolder(tmp_path)


def test_a_folder_without_maps(tmp_path: Path) -> None:
    (tmp_path / "notes.xml").write_text("<notes/>")
    with pytest.raises(MapError, match="no map in this folder"):
        MapFolder(tmp_path)
    with pytest.raises(MapError, match="no such folder"):
        MapFolder(tmp_path / "gone")


def test_one_map_or_many(tmp_path: Path) -> None:
    put(tmp_path, "a.xml")
    with pytest.raises(UsageError, match="exclude each other"):
        MapLibrary(DriveInput(map=tmp_path / "a.xml", map_dir=tmp_path))
