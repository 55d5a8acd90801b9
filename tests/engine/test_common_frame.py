"""A log and a map of different geo references are brought together: the same drive, moved by pyproj, gives the same verdicts."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pytest

from drivelint.convert import ConvertRequest, convert
from drivelint.drive.trace import DriveInput, IngestOptions, Trace
from drivelint.engine.batch import drive_with_map
from drivelint.engine.map_library import MapLibrary
from drivelint.errors import MapError
from drivelint.formats import read_trace
from drivelint.report.progress import Silent
from drivelint.run import CheckOptions, check

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive

CASE = Path(__file__).resolve().parents[2] / "fixtures" / "overtake"
LOG, MAPPING = CASE / "near_miss.csv", str(CASE / "mapping.toml")
UTM32, UTM33 = (f"+proj=utm +zone={zone} +datum=WGS84 +units=m +no_defs" for zone in (32, 33))
LOCAL = "+proj=tmerc +lat_0=49 +lon_0=12 +k=1 +datum=WGS84"
BORDER, KARLSRUHE = (12.02, 49.0), (8.4, 49.0)
TURN = 0.3
WHOLE = (0.0, 0.0, 0.0)
FRAMES = [(UTM33, WHOLE), (UTM33, (330_000.0, 5_400_000.0, -2.0)), (LOCAL, WHOLE), (LOCAL, (5.0, -7.0, 0.2))]
NUMBERS = ("x_m", "y_m", "yaw_rad", "vx_mps", "vy_mps", "ax_mps2", "ay_mps2")
pyproj = pytest.importorskip("pyproj")


def origin(place: tuple[float, float]) -> tuple[float, float]:
    x, y = pyproj.Transformer.from_crs("EPSG:4326", UTM32, always_xy=True).transform(*place)
    return x, y


def road(folder: Path, place: tuple[float, float] = BORDER) -> Path:
    """Write the case's road so that its 0,0 is at a longitude and latitude, turned against the projection."""
    x, y = origin(place)
    said = f'<geoReference>{UTM32}</geoReference><offset x="{x!r}" y="{y!r}" hdg="{TURN}"/>'
    text = (CASE / "road.xodr").read_text("utf-8")
    assert 'vendor="drivelint demo"/>' in text
    text = text.replace('vendor="drivelint demo"/>', f'vendor="drivelint demo">{said}</header>')
    (folder / "road.xodr").write_text(text, "utf-8")
    return folder / "road.xodr"


def plain() -> Trace:
    return read_trace(LOG, IngestOptions(mapping=MAPPING))


def numbers(trace: Trace) -> dict[str, Any]:
    return {name: np.array(trace.tables["actor_state"][name].to_numpy(), np.float64) for name in NUMBERS}


def with_numbers(trace: Trace, number: dict[str, Any]) -> Trace:
    states = trace.tables["actor_state"]
    for name, values in number.items():
        at = states.schema.get_field_index(name)
        states = states.set_column(at, states.schema.field(at), pa.array(values, from_pandas=True))
    return replace(trace, tables={**trace.tables, "actor_state": states})


def turned(x: Any, y: Any, angle: Any) -> tuple[Any, Any]:
    return x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)


def in_frame(reference: str, offset: tuple[float, float, float] = WHOLE, place: tuple[float, float] = BORDER) -> Trace:
    """Return the case's drive in another frame, moved by pyproj, turned by PROJ's meridian convergences."""
    number, (x0, y0) = numbers(plain()), origin(place)
    x, y = turned(number["x_m"], number["y_m"], TURN)
    lon, lat = pyproj.Transformer.from_crs(UTM32, "EPSG:4326", always_xy=True).transform(x + x0, y + y0)
    x, y = pyproj.Transformer.from_crs(UTM32, reference, always_xy=True).transform(x + x0, y + y0)
    north, other = (np.radians(pyproj.Proj(r).get_factors(lon, lat).meridian_convergence) for r in (UTM32, reference))
    angle = TURN + other - north - offset[2]
    number["x_m"], number["y_m"] = turned(x - offset[0], y - offset[1], -offset[2])
    number["yaw_rad"] = np.remainder(number["yaw_rad"] + angle + math.pi, math.tau) - math.pi
    for a, b in (("vx_mps", "vy_mps"), ("ax_mps2", "ay_mps2")):
        number[a], number[b] = turned(number[a], number[b], angle)
    return replace(with_numbers(plain(), number), geo_reference=reference, geo_offset=offset)


def judged(trace: Trace, road: Path, offset: tuple[float, float] | None = None) -> Drive:
    return drive_with_map(trace, MapLibrary(DriveInput(map=road, map_offset=offset)))


def said(drive: Drive) -> dict[str, tuple[str, str]]:
    rows = drive.trace.tables["quality"].to_pylist()
    return {row["check_id"]: (row["severity"], row["message"]) for row in rows}


@pytest.mark.parametrize(("reference", "offset"), FRAMES)
def test_states_are_those_of_the_maps_frame(tmp_path: Path, reference: str, offset: tuple[float, float, float]) -> None:
    here, drive = numbers(plain()), judged(in_frame(reference, offset), road(tmp_path))
    for name, values in numbers(drive.trace).items():
        apart = values - here[name]
        if name == "yaw_rad":
            apart = np.remainder(apart + math.pi, math.tau) - math.pi
        assert np.array_equal(np.isnan(values), np.isnan(here[name])), name
        assert np.nanmax(np.abs(apart), initial=0.0) < 1e-4, name
    severity, message = said(drive)["moved_to_map"]
    assert severity == "info"
    assert reference in message
    assert "geo_reference_differs" not in said(drive)


def verdicts(folder: Path, road: Path) -> list[dict[str, Any]]:
    options = CheckOptions((str(LOG),), map=road, mapping=MAPPING, rules=("ukhc",), profiles=("nominal",), out=folder)
    return list(check(options, Silent()).verdicts.to_pylist())


def test_the_same_drive_in_another_zone_gives_the_same_verdicts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    given = road(tmp_path)
    expected = verdicts(tmp_path / "own", given)
    assert {row["verdict"] for row in expected} >= {"pass", "fail"}
    for n, (reference, offset) in enumerate((FRAMES[0], FRAMES[3])):
        elsewhere = in_frame(reference, offset)
        monkeypatch.setattr("drivelint.engine.batch.read_trace", lambda *_, log=elsewhere: log)
        for one, other in zip(verdicts(tmp_path / str(n), given), expected, strict=True):
            for name in ("rule_id", "verdict", "ego_id", "object_id", "profile", "t_ref_ns", "cause_code"):
                assert one.get(name) == other.get(name), (one["rule_id"], name)
            if other["margin"] is not None:
                assert one["margin"] == pytest.approx(other["margin"], abs=0.01)


def test_a_stretch_of_lengths_is_refused(tmp_path: Path) -> None:
    """At Karlsruhe, zone 33 is 6.6 degrees from its meridian: 100 m of its grid are 99.7 of zone 32's."""
    with pytest.raises(MapError, match=r"cannot be moved into the map's .* 100 m would be 99\.7"):
        judged(in_frame(UTM33, place=KARLSRUHE), road(tmp_path, KARLSRUHE))


def test_a_frame_out_of_shape_is_refused(tmp_path: Path) -> None:
    """Of this one, the metre to the east is right at 12 degrees of latitude, and the one to the north is 2 % off at 49."""
    flat = "+proj=cea +lat_ts=49 +lon_0=12 +datum=WGS84"
    with pytest.raises(MapError, match="out of shape"):
        judged(in_frame(flat, place=(12.0, 49.2)), road(tmp_path, (12.0, 49.2)))


def test_a_reference_that_leads_away_from_the_map_is_not_followed(tmp_path: Path) -> None:
    """The log has the map's own coordinates, and says a projection in which they would be elsewhere."""
    here = replace(plain(), geo_reference=LOCAL)
    drive = judged(here, road(tmp_path, (12.5, 49.0)))
    assert drive.trace.tables["actor_state"].equals(here.tables["actor_state"])
    assert said(drive)["geo_reference_differs"][0] == "warning"
    assert "moved_to_map" not in said(drive)


def test_the_same_reference_with_the_files_own_coordinates(tmp_path: Path) -> None:
    here = replace(plain(), geo_reference=UTM32)
    drive = judged(here, road(tmp_path))
    assert drive.trace.tables["actor_state"].equals(here.tables["actor_state"])
    assert not said(drive).keys() & {"geo_reference_differs", "moved_to_map"}


def test_a_small_offset_of_the_map_is_not_taken_for_a_shift_of_the_log(tmp_path: Path) -> None:
    """Moved by 20 m along the road, the drive would be on it too."""
    text = (CASE / "road.xodr").read_text("utf-8")
    header = f'vendor="drivelint demo"><geoReference>{LOCAL}</geoReference><offset x="20" y="0"/></header>'
    given = tmp_path / "small.xodr"
    given.write_text(text.replace('vendor="drivelint demo"/>', header), "utf-8")
    here = replace(plain(), geo_reference=LOCAL)
    drive = judged(here, given)
    assert drive.trace.tables["actor_state"].equals(here.tables["actor_state"])
    own = judged(replace(here, geo_offset=(1.0, 0.0, 0.0)), given)
    np.testing.assert_allclose(numbers(own.trace)["x_m"], numbers(here)["x_m"] - 19.0, atol=1e-3)


def test_the_same_reference_with_its_full_coordinates(tmp_path: Path) -> None:
    drive = judged(in_frame(UTM32), road(tmp_path))
    np.testing.assert_allclose(numbers(drive.trace)["x_m"], numbers(plain())["x_m"], atol=1e-3)
    assert "moved_to_map" in said(drive)


def test_the_same_reference_in_other_words_moves_nothing(tmp_path: Path) -> None:
    here = replace(plain(), geo_reference="+proj=utm +zone=32 +ellps=WGS84", geo_offset=(*origin(BORDER), TURN))
    drive = judged(here, road(tmp_path))
    assert drive.trace.tables["actor_state"].equals(here.tables["actor_state"])
    assert not said(drive).keys() & {"geo_reference_differs", "moved_to_map"}


def test_what_the_user_says_goes_before_the_references(tmp_path: Path) -> None:
    """By its reference, the log would be moved 100 m along the road, which is longer."""
    x, y = turned(100.0, 0.0, TURN)
    here = replace(plain(), geo_reference=UTM32, geo_offset=(origin(BORDER)[0] + x, origin(BORDER)[1] + y, TURN))
    assert "moved_to_map" in said(judged(here, road(tmp_path)))
    drive = judged(here, road(tmp_path), (0.5, 0.0))
    assert drive.trace.tables["actor_state"].equals(here.tables["actor_state"])


def test_who_has_no_place_is_turned_with_the_others(tmp_path: Path) -> None:
    log = in_frame(UTM33)
    x = numbers(log)["x_m"]
    x[3] = np.nan
    drive = judged(with_numbers(log, {"x_m": x}), road(tmp_path))
    found, here = numbers(drive.trace), numbers(plain())
    assert np.isnan(found["x_m"]).nonzero()[0].tolist() == [3]
    for name in ("vx_mps", "vy_mps", "yaw_rad"):
        assert found[name][3] == pytest.approx(here[name][3], abs=1e-3)


def test_a_converted_log_is_in_the_frame_of_its_map(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It has no reference by which it could be moved later."""
    given, elsewhere = road(tmp_path), in_frame(UTM33)
    monkeypatch.setattr("drivelint.convert.read_trace", lambda *_: elsewhere)
    made = convert(ConvertRequest(trace=str(LOG), to="parquet", out=tmp_path / "made", map=given, mapping=MAPPING))
    written = read_trace(made.path, IngestOptions())
    np.testing.assert_allclose(numbers(written)["x_m"], numbers(plain())["x_m"], atol=1e-3)
    judged(written, given)
