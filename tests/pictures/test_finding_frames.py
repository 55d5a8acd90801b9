"""The frames of a bag's cameras beside its findings: the nearest in time, the time told, few and small; without cameras, nothing."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import drivelint
from drivelint.drive.trace import FrameTimes
from drivelint.inspect.content import file_content
from drivelint.pictures.clock import DriveClock
from drivelint.report import html
from drivelint.result.load import load_result
from tests.pictures.camera_bag import FRONT, LEFT, T0, number_in, taken_s, write_bag
from tests.report.browser import CHROMIUM, Page

pytest.importorskip("rosbags", reason="rosbags is not installed: pip install rosbags")

RULES = ["ukhc.no-collision"]
EGO = "4.5,1.8"
OFF_S = {"before": -1.0, "at": 0.0, "after": 1.0}


def result_folder(bag: Path, out: Path, **more: object) -> Path:
    options: dict[str, object] = {"rules": RULES, "ego_size": EGO, "robustness": False, "annotate": False, **more}
    drivelint.check(bag, out=out, overwrite=True, **options)  # type: ignore[arg-type]
    return out


@pytest.fixture(scope="module")
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_bag(tmp_path_factory.mktemp("cameras") / "bag")


@pytest.fixture(scope="module")
def out(bag: Path) -> Path:
    return result_folder(bag, bag.parent / "results")


def test_each_picture_is_the_frame_that_was_taken_nearest_in_time(out: Path) -> None:
    rows = load_result(out).pictures.to_pylist()
    assert_nearest(rows)


@pytest.mark.ci
def test_a_frame_is_late_though_the_states_are_logged_without_delay(tmp_path: Path) -> None:
    """A claims handler saw a frame of 0.05 s earlier "at the moment": the drive's own times were equal to its log times."""
    bag = write_bag(tmp_path / "bag", states_late_s=0.0)
    assert_nearest(load_result(result_folder(bag, tmp_path / "results")).pictures.to_pylist())


def test_a_drive_by_log_times_has_the_log_times_of_its_frames() -> None:
    times = FrameTimes(np.array([5, 6]), np.array([5, 6], np.uint64))
    assert DriveClock(times, uses_log_times=True).is_log_clock
    assert not DriveClock(times).is_log_clock
    assert DriveClock(None).is_log_clock


def assert_nearest(rows: list[dict[str, Any]]) -> None:
    assert {(row["camera"], row["shot"]) for row in rows} == {(c, s) for c in (FRONT, LEFT) for s in OFF_S}
    assert [row["camera"] for row in rows if row["camera_no"] == 0] == [FRONT] * 3
    for row in rows:
        taken = taken_s(row["camera"])
        wanted_s = row["t_ns"] / 1e9 - T0 + OFF_S[row["shot"]]
        nearest = int(abs(taken - wanted_s).argmin())
        assert number_in(row["jpeg"]) == nearest
        assert row["t_frame_ns"] / 1e9 - T0 == pytest.approx(taken[nearest], abs=1e-3)
        assert (row["width_px"], row["height_px"]) == (640, 360)


def test_the_report_shows_them_with_their_times_and_each_once(out: Path) -> None:
    result = load_result(out)
    page = (out / "report.html").read_text(encoding="utf-8")
    assert page.count("data:image/jpeg;base64,") == result.pictures.num_rows
    for row in result.pictures.to_pylist():
        off_s = (row["t_frame_ns"] - row["t_ns"]) / 1e9
        told = f"{off_s:+.2f} s".replace("-", "\u2212")
        assert f'<span class="shot-time">{told}</span>' in page
    assert re.search(r'alt="Camera /camera/front/image_raw/compressed, .0\.0\d s 4\.\d\d.s"', page)


def test_inspect_says_that_a_camera_is_read_as_pictures(bag: Path) -> None:
    read = {channel.topic: channel.read_as for channel in file_content(bag, None, [], has_reader=True).channels}
    assert (read[FRONT], read[LEFT]) == ("pictures", "pictures")


@pytest.mark.ci
def test_without_pictures_the_page_is_that_of_a_log_without_cameras(bag: Path, out: Path, tmp_path: Path) -> None:
    plain = result_folder(bag, tmp_path / "plain", pictures=False)
    assert not (plain / "pictures.parquet").exists()
    result = load_result(out)
    drivelint_page = html.render(load_result(plain))
    assert b"shot" not in drivelint_page
    assert b"data:image/jpeg" not in drivelint_page
    assert result.findings.equals(load_result(plain).findings)


@pytest.mark.ci
def test_a_log_without_cameras_leaves_nothing_and_imports_no_pillow(tmp_path: Path) -> None:
    bag = write_bag(tmp_path / "bag", cameras=False)
    code = (
        "import sys, drivelint\n"
        f"drivelint.check({str(bag)!r}, out={str(tmp_path / 'out')!r}, rules={RULES!r}, ego_size={EGO!r}, robustness=False)\n"
        "print('PIL' in sys.modules)"
    )
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert told.stdout.strip() == "False"
    files = json.loads((tmp_path / "out" / "files.json").read_text(encoding="utf-8"))["written_by_drivelint"]
    assert "report.html" in files
    assert "pictures.parquet" not in files


@pytest.mark.ci
def test_a_damaged_frame_is_told_and_the_others_are_shown(tmp_path: Path) -> None:
    bag = write_bag(tmp_path / "bag", damaged={42})
    result = load_result(result_folder(bag, tmp_path / "out"))
    shown = {(row["camera"], row["shot"]) for row in result.pictures.to_pylist()}
    assert (FRONT, "at") not in shown
    assert {(FRONT, "before"), (FRONT, "after"), (LEFT, "at")} <= shown
    assert [note for note in result.notes if FRONT in note] == [
        f"bag: camera {FRONT}: no picture of an image that is no JPEG, PNG or WebP"
    ]


@pytest.mark.ci
def test_the_sheet_has_a_page_of_them(bag: Path, out: Path) -> None:
    from drivelint.incident import IncidentRequest, write_sheet

    (sheet,) = write_sheet(IncidentRequest("ukhc.no-collision", out))
    page = sheet.read_text(encoding="utf-8")
    assert page.count("data:image/jpeg;base64,") == load_result(out).pictures.num_rows
    assert page.count("of 3</span>") == 3
    assert "Faces and number plates are shown as they are in the log" in page, "whoever sends the page must think of it"
    assert page.count("made smaller") == 1
    assert "img-src data:" in page


@pytest.mark.ci
def test_twenty_findings_of_noise_make_a_page_of_under_six_megabytes(tmp_path: Path) -> None:
    """What they take of a run's time is in `python -m tests.bench pictures`."""
    bag = write_bag(tmp_path / "bag", noise=True, contacts=20)
    out = result_folder(bag, tmp_path / "out", rules=None)
    result = load_result(out)
    assert result.findings.num_rows >= 20
    assert result.pictures.num_rows > 100
    assert (out / "report.html").stat().st_size < 6_000_000


@pytest.mark.ci
@pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")
@pytest.mark.parametrize("width", [1440, 390])
def test_a_browser_shows_them_and_nothing_is_too_wide(out: Path, tmp_path: Path, width: int) -> None:
    with Page(tmp_path, (out / "report.html").as_uri(), width) as page:
        page.call(
            "Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=width < 500
        )
        assert page.complaints() == []
        assert page.value("[...document.images].every(image => image.complete && image.naturalWidth > 0)")
        assert page.value("document.images.length") == load_result(out).pictures.num_rows
        assert page.value("document.documentElement.scrollWidth <= window.innerWidth")
        shown = page.value("document.querySelector('.hero').parentElement.querySelectorAll('.shot img').length")
        assert shown == 6
