"""A DuckDB without drivelint gives the numbers of every finding: of the demo's drives, and of logs that others recorded."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyarrow.parquet as pq
import pytest

from drivelint import demo
from drivelint.pack import VerifyRequest, verify
from drivelint.result.counts import one_finding_per_event
from tests.demo.overtakes import PROFILES
from tests.explain.overtake_check import check
from tests.pack.packed import make_pack, numbers_without_drivelint
from tests.shared_data import shared

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.slow


def check_every_finding(pack: Path, at_least: int) -> None:
    findings = pq.read_table(pack / "data/result/findings.parquet").to_pylist()
    assert len(findings) >= at_least
    told = numbers_without_drivelint(pack)
    assert sorted(told) == sorted(row["finding_id"] for row in findings)
    for row in findings:
        (found,) = told[row["finding_id"]]
        assert found["holds"] is False
        names = ("observed", "required", "margin")
        # to the last bit: JSON gives a float back as it was
        assert [found[name] for name in names] == [row[name] for name in names], row["rule_id"]
    # the same without running what is in the pack
    verified = verify(VerifyRequest(pack))
    assert verified.problems == []
    assert f"{len(one_finding_per_event(findings))} findings gave their numbers" in verified.notes[0]


def test_of_the_demo(tmp_path: Path) -> None:
    paths = demo.write(tmp_path / "demo")
    check(
        tmp_path / "result",
        traces=tuple(str(path) for path in paths if path.suffix == ".mcap"),
        map=tmp_path / "demo" / demo.ROAD_FILE,
        mapping=None,
        rules=("all",),
        params=(),
        profiles=(*PROFILES, "observed"),
        robustness=False,
    )
    check_every_finding(make_pack(tmp_path / "result", tmp_path / "pack"), at_least=77)


@pytest.mark.parametrize(
    ("log", "road", "at_least"),
    [
        ("commonroad/USA_US101-4_1_T-1.xml", None, 93),
        ("osi/pedestrian.osi", "osi/fabriksgatan.xodr", 3),
        ("overtake_case_study/collision.csv", "overtake_case_study/t_junction.xodr", 20),
    ],
)
def test_of_a_log_of_others(log: str, road: str | None, at_least: int, tmp_path: Path) -> None:
    """Vehicles of the US-101 as NGSIM filmed them, a pedestrian of esmini in OSI, and the paper's collision in CARLA."""
    check(
        tmp_path / "result",
        traces=(str(shared(log)),),
        map=None if road is None else shared(road),
        mapping=None,
        rules=("all",),
        params=(),
        profiles=(),
        ego="all",
        robustness=False,
    )
    check_every_finding(make_pack(tmp_path / "result", tmp_path / "pack"), at_least)
