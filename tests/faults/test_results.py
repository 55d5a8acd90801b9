"""A result whose files are not those of one run is refused, before anything is compared or judged again."""

from __future__ import annotations

import json
import shutil
from typing import TYPE_CHECKING

import pytest

import drivelint
from drivelint.errors import DriveLintError, ExitCode
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

OVERTAKE = ROOT / "fixtures" / "overtake"
RULES = "ukhc.r162.safe-distance-ahead"


def check(out: Path, name: str, road: Path = OVERTAKE / "road.xodr") -> Path:
    drivelint.check(
        [OVERTAKE / f"{name}.csv"], rules=RULES, map=road, mapping=OVERTAKE / "mapping.toml", out=out, annotate=False,
        robustness=False,
    )  # fmt: skip
    return out


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    folder = tmp_path_factory.mktemp("results")
    return check(folder / "fails", "collision"), check(folder / "passes", "safe")


def cut(folder: Path, _: Path) -> None:
    data = (folder / "findings.parquet").read_bytes()
    (folder / "findings.parquet").write_bytes(data[:-20])


def flipped(folder: Path, _: Path) -> None:
    data = bytearray((folder / "verdicts.parquet").read_bytes())
    data[len(data) // 2] ^= 1
    (folder / "verdicts.parquet").write_bytes(data)


def of_another_run(folder: Path, other_run: Path) -> None:
    shutil.copy(other_run / "verdicts.parquet", folder / "verdicts.parquet")


def other_summary(folder: Path, _: Path) -> None:
    summary = json.loads((folder / "summary.json").read_bytes())
    (folder / "summary.json").write_text(json.dumps(summary | {"fail_on": "never"}))


def other_version(folder: Path, _: Path) -> None:
    summary = json.loads((folder / "summary.json").read_bytes())
    (folder / "summary.json").write_text(json.dumps(summary | {"output_schema": 0}))


@pytest.mark.parametrize("spoil", [cut, flipped, of_another_run, other_summary, other_version])
def test_a_result_that_is_not_of_one_run(
    spoil: Callable[[Path, Path], None], tmp_path: Path, results: tuple[Path, Path]
) -> None:
    folder = tmp_path / "spoilt"
    shutil.copytree(results[0], folder)
    assert drivelint.open(folder).exit_code == 1
    spoil(folder, results[1])
    says = "cannot be read|was changed since drivelint check wrote it|written with output schema 0"
    for act in (lambda: drivelint.open(folder), lambda: drivelint.diff(results[0], folder)):
        with pytest.raises(DriveLintError, match=says) as caught:
            act()
        assert caught.value.exit_code is ExitCode.USAGE


@pytest.mark.ci
def test_a_map_that_is_another_now(tmp_path: Path) -> None:
    road = tmp_path / "road.xodr"
    shutil.copy(OVERTAKE / "road.xodr", road)
    check(tmp_path / "out", "collision", road)
    road.write_text(road.read_text(encoding="utf-8").replace('a="3.5"', 'a="3.6"'), encoding="utf-8")
    with pytest.raises(DriveLintError, match=r"map road\.xodr has changed since collision-\w+ was judged"):
        drivelint.open(tmp_path / "out").explain("r162")
