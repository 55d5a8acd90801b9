"""The committed scenes are what the library makes, and the rules say of them what was reviewed."""

from __future__ import annotations

import io
import runpy
from typing import Any

import pytest
import zstandard
from mcap.reader import make_reader

from tests.demo.motion import separation
from tests.demo.overtakes import overtakes
from tests.demo.scenes import all_scenes
from tests.demo.table_1 import TABLE_1
from tests.shared_data import ROOT

FOLDER = ROOT / "fixtures" / "scenes"
MAKE = runpy.run_path(str(FOLDER / "make.py"))
AGAIN = "run PYTHONPATH=. python fixtures/scenes/make.py and read what changed"
ZSTD = (1, 5, 7)  # the compressor of the committed logs: another one may pack the same messages into other bytes
MAX_BYTES = 1_500_000


def messages(content: bytes) -> list[tuple[Any, ...]]:
    reader = make_reader(io.BytesIO(content), validate_crcs=True)
    return [(s and (s.name, s.data), c.topic, c.metadata, m.log_time, m.data) for s, c, m in reader.iter_messages()]


@pytest.fixture(scope="module")
def logs() -> dict[str, bytes]:
    made: dict[str, bytes] = MAKE["logs"]()
    return made


@pytest.mark.parametrize("name", sorted(p.name for p in FOLDER.iterdir() if p.suffix in {".mcap", ".xodr"}))
def test_a_file_is_what_the_library_makes(name: str, logs: dict[str, bytes]) -> None:
    content = logs[name]
    committed = (FOLDER / name).read_bytes()
    if name.endswith(".mcap"):
        assert messages(committed) == messages(content), f"{name}: {AGAIN}"
    if not name.endswith(".mcap") or ZSTD == zstandard.ZSTD_VERSION:
        assert committed == content, f"{name}: {AGAIN}"


def test_nothing_else_is_there_and_all_of_it_is_small(logs: dict[str, bytes]) -> None:
    files = {path.name: path.stat().st_size for path in FOLDER.iterdir() if path.is_file()}
    assert files.keys() == logs.keys() | {"make.py", MAKE["VERDICTS"]}
    assert sum(files.values()) < MAX_BYTES


@pytest.fixture(scope="module")
def verdicts_text() -> str:
    text: str = MAKE["verdicts"](FOLDER)
    return text


def sections(text: str) -> dict[str, list[str]]:
    blocks = [block.splitlines() for block in text.split("\n\n")[1:]]
    return {lines[0].partition(":")[0]: [line.strip() for line in lines[1:]] for lines in blocks}


@pytest.mark.ci
def test_the_verdicts_are_those_that_were_reviewed(verdicts_text: str) -> None:
    committed = sections((FOLDER / MAKE["VERDICTS"]).read_text(encoding="utf-8"))
    now = sections(verdicts_text)
    assert now.keys() == committed.keys() == {scene.name for scene in all_scenes()}
    for name, lines in committed.items():
        assert now[name] == lines, f"{name}: {AGAIN}"


@pytest.mark.ci
@pytest.mark.parametrize("ending", ["", "-25mph"])
def test_the_nine_verdicts_come_out_at_both_speeds(verdicts_text: str, ending: str) -> None:
    found: dict[str, dict[str, str]] = {}
    for run in TABLE_1:
        for line in sections(verdicts_text)[f"{run}{ending}"]:
            verdict, rule, profile, *_ = line.split()
            if rule == "r162.safe-distance-ahead":
                found.setdefault(run, {})[profile] = verdict
    assert found == TABLE_1


@pytest.mark.parametrize("scene", overtakes(), ids=lambda scene: scene.name)
def test_the_overtakes_end_as_their_names_say(scene: Any) -> None:
    ego, parked, oncoming = scene.tracks
    least = float(separation(ego, oncoming).min())
    low, high = {"safe": (1.0, 5.0), "near-miss": (0.1, 0.5), "collision": (-0.05, 0.0)}[
        scene.name.removesuffix("-25mph")
    ]
    assert low < least < high
    assert separation(ego, parked).min() > 1.5


@pytest.mark.ci
def test_no_failure_in_the_clean_drive(verdicts_text: str) -> None:
    words = [line.split() for line in sections(verdicts_text)["clean-drive"]]
    # a log of positions and indicators has nothing of lamps and horn: it is not asked about them
    assert {word[0] for word in words} == {"pass", "not"}
