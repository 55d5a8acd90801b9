"""Findings joined to their verdicts, as the guide shows it, against the overlap in time of both."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

import drivelint
from tests.shared_data import shared

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.ci

LISTED_FINDINGS = """SELECT v.rule_id, v.ego_id, v.profile, v.object_id, v.occurrence, f.finding_id
    FROM verdicts v JOIN findings f ON list_contains(v.finding_ids, f.finding_id)"""
OVERLAPPING = """SELECT v.rule_id, v.ego_id, v.profile, v.object_id, v.occurrence, f.finding_id
    FROM verdicts v JOIN findings f ON v.drive_id = f.drive_id AND v.ego_id = f.ego_id AND v.rule_id = f.rule_id
        AND v.profile IS NOT DISTINCT FROM f.profile AND v.object_id IS NOT DISTINCT FROM f.object_id
        AND v.ref_id IS NOT DISTINCT FROM f.ref_id AND v.t_start_ns <= f.t_end_ns AND f.t_start_ns <= v.t_end_ns
    WHERE v.verdict = 'fail'"""


@pytest.fixture(params=["demo", *(pytest.param(log, marks=pytest.mark.slow) for log in ("case study", "US101"))])
def check_result(request: pytest.FixtureRequest, tmp_path: Path) -> drivelint.CheckResult:
    options: dict[str, Any] = {"rules": "all", "robustness": False, "fail_on": "never"}
    if request.param == "demo":
        logs = drivelint.write_demo(tmp_path)
        return drivelint.check([log for log in logs if log.suffix == ".mcap"], map=tmp_path / "road.xodr", **options)
    if request.param == "case study":
        study = shared("overtake_case_study")
        logs = [study / f"{name}.csv" for name in ("safe", "near_miss", "collision")]
        return drivelint.check(logs, mapping="carla-testbench", map=study / "t_junction.xodr", **options)
    return drivelint.check(shared("commonroad/USA_US101-5_1_T-1.xml"), ego="all", **options)


def test_the_named_findings_are_those_that_overlap(check_result: drivelint.CheckResult) -> None:
    named = check_result.sql(f"{LISTED_FINDINGS} ORDER BY ALL").rows()
    assert named == check_result.sql(f"{OVERLAPPING} ORDER BY ALL").rows()
    assert {row["finding_id"] for row in named} == set(check_result.findings["finding_id"]), (
        "every finding has a verdict"
    )
    assert not check_result.sql("FROM verdicts WHERE verdict <> 'fail' AND len(finding_ids) > 0").rows()
    by_counter = "SELECT count(*) AS n FROM findings f JOIN verdicts v USING (drive_id, ego_id, rule_id, occurrence)"
    same = "v.profile IS NOT DISTINCT FROM f.profile AND v.object_id IS NOT DISTINCT FROM f.object_id"
    wrong = f"{by_counter} WHERE {same} AND NOT list_contains(v.finding_ids, f.finding_id)"
    assert check_result.sql(wrong).rows()[0]["n"] > 0, "the two counters are not one"
