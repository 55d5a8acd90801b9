"""A log and a map of different geo references are brought together: the same drive, moved by pyproj, gives the same verdicts."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from drivelint.convert import ConvertRequest, convert
from drivelint.drive.trace import IngestOptions
from drivelint.errors import MapError
from drivelint.formats import read_trace
from drivelint.report.progress import Silent
from drivelint.run import CheckOptions, check
from tests.engine.frames import (
    BORDER,
    CASE,
    FRAMES,
    KARLSRUHE,
    LOCAL,
    LOG,
    MAPPING,
    TURN,
    UTM32,
    UTM33,
    drive_on_map,
    in_frame,
    numbers,
    origin,
    plain,
    road,
    turned,
    with_numbers,
)

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive


def quality_messages(drive: Drive) -> dict[str, tuple[str, str]]:
    rows = drive.trace.tables["quality"].to_pylist()
    return {row["check_id"]: (row["severity"], row["message"]) for row in rows}


@pytest.mark.sample(2, ci=2)
@pytest.mark.parametrize(("reference", "offset"), FRAMES)
def test_states_are_those_of_the_maps_frame(tmp_path: Path, reference: str, offset: tuple[float, float, float]) -> None:
    here, drive = numbers(plain()), drive_on_map(in_frame(reference, offset), road(tmp_path))
    for name, values in numbers(drive.trace).items():
        apart = values - here[name]
        if name == "yaw_rad":
            apart = np.remainder(apart + math.pi, math.tau) - math.pi
        assert np.array_equal(np.isnan(values), np.isnan(here[name])), name
        assert np.nanmax(np.abs(apart), initial=0.0) < 1e-4, name
    severity, message = quality_messages(drive)["moved_to_map"]
    assert severity == "info"
    assert reference in message
    assert "geo_reference_differs" not in quality_messages(drive)


def verdicts(folder: Path, road: Path) -> list[dict[str, Any]]:
    options = CheckOptions(
        (str(LOG),), map=road, mapping=MAPPING, rules=("ukhc",), profiles=("nominal",), out=folder, robustness=False
    )
    return list(check(options, Silent()).verdicts.to_pylist())


@pytest.mark.slow
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
        drive_on_map(in_frame(UTM33, place=KARLSRUHE), road(tmp_path, KARLSRUHE))


def test_a_frame_out_of_shape_is_refused(tmp_path: Path) -> None:
    """Of this one, the metre to the east is right at 12 degrees of latitude, and the one to the north is 2 % off at 49."""
    flat = "+proj=cea +lat_ts=49 +lon_0=12 +datum=WGS84"
    with pytest.raises(MapError, match="out of shape"):
        drive_on_map(in_frame(flat, place=(12.0, 49.2)), road(tmp_path, (12.0, 49.2)))


def test_a_reference_that_leads_away_from_the_map_is_not_followed(tmp_path: Path) -> None:
    """The log has the map's own coordinates, and says a projection in which they would be elsewhere."""
    here = replace(plain(), geo_reference=LOCAL)
    drive = drive_on_map(here, road(tmp_path, (12.5, 49.0)))
    assert drive.trace.tables["actor_state"].equals(here.tables["actor_state"])
    assert quality_messages(drive)["geo_reference_differs"][0] == "warning"
    assert "moved_to_map" not in quality_messages(drive)


def test_the_same_reference_with_the_files_own_coordinates(tmp_path: Path) -> None:
    here = replace(plain(), geo_reference=UTM32)
    drive = drive_on_map(here, road(tmp_path))
    assert drive.trace.tables["actor_state"].equals(here.tables["actor_state"])
    assert not quality_messages(drive).keys() & {"geo_reference_differs", "moved_to_map"}


def test_a_small_offset_of_the_map_is_not_taken_for_a_shift_of_the_log(tmp_path: Path) -> None:
    """Moved by 20 m along the road, the drive would be on it too."""
    text = (CASE / "road.xodr").read_text("utf-8")
    header = f'vendor="drivelint demo"><geoReference>{LOCAL}</geoReference><offset x="20" y="0"/></header>'
    given = tmp_path / "small.xodr"
    given.write_text(text.replace('vendor="drivelint demo"/>', header), "utf-8")
    here = replace(plain(), geo_reference=LOCAL)
    drive = drive_on_map(here, given)
    assert drive.trace.tables["actor_state"].equals(here.tables["actor_state"])
    own = drive_on_map(replace(here, geo_offset=(1.0, 0.0, 0.0)), given)
    np.testing.assert_allclose(numbers(own.trace)["x_m"], numbers(here)["x_m"] - 19.0, atol=1e-3)


def test_the_same_reference_with_its_full_coordinates(tmp_path: Path) -> None:
    drive = drive_on_map(in_frame(UTM32), road(tmp_path))
    np.testing.assert_allclose(numbers(drive.trace)["x_m"], numbers(plain())["x_m"], atol=1e-3)
    assert "moved_to_map" in quality_messages(drive)


def test_full_coordinates_of_a_log_that_says_no_reference(tmp_path: Path) -> None:
    """They lie on the map; those of another zone do not."""
    drive = drive_on_map(replace(in_frame(UTM32), geo_reference=None), road(tmp_path))
    apart = {name: values - numbers(plain())[name] for name, values in numbers(drive.trace).items()}
    assert max(np.abs(apart["x_m"]).max(), np.abs(apart["y_m"]).max(), np.abs(np.sin(apart["yaw_rad"])).max()) < 1e-3
    assert quality_messages(drive)["fits_projection"][0] == "info"
    with pytest.raises(MapError, match="of another place"):
        drive_on_map(replace(in_frame(UTM33), geo_reference=None), road(tmp_path))


def test_the_same_reference_in_other_words_moves_nothing(tmp_path: Path) -> None:
    here = replace(plain(), geo_reference="+proj=utm +zone=32 +ellps=WGS84", geo_offset=(*origin(BORDER), TURN))
    drive = drive_on_map(here, road(tmp_path))
    assert drive.trace.tables["actor_state"].equals(here.tables["actor_state"])
    assert not quality_messages(drive).keys() & {"geo_reference_differs", "moved_to_map"}


def test_what_the_user_says_goes_before_the_references(tmp_path: Path) -> None:
    """By its reference, the log would be moved 100 m along the road, which is longer."""
    x, y = turned(100.0, 0.0, TURN)
    here = replace(plain(), geo_reference=UTM32, geo_offset=(origin(BORDER)[0] + x, origin(BORDER)[1] + y, TURN))
    assert "moved_to_map" in quality_messages(drive_on_map(here, road(tmp_path)))
    drive = drive_on_map(here, road(tmp_path), (0.5, 0.0))
    assert drive.trace.tables["actor_state"].equals(here.tables["actor_state"])


def test_who_has_no_place_is_turned_with_the_others(tmp_path: Path) -> None:
    log = in_frame(UTM33)
    x = numbers(log)["x_m"]
    x[3] = np.nan
    drive = drive_on_map(with_numbers(log, {"x_m": x}), road(tmp_path))
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
    drive_on_map(written, given)
