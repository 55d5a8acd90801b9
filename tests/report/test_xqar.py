"""ASAM's checker results: a checker that judged nothing must not read as one that found nothing."""

from __future__ import annotations

import re
from datetime import date
from typing import Any

import pytest
from lxml import etree

from drivelint.gate import GateInputs, Waiver
from drivelint.report import xqar
from drivelint.result.model import Result
from tests.report.synthetic import SDA, SECOND, drive, finding, result, rule, verdict
from tests.shared_data import shared

UID = re.compile(r"((\w+(\.\w+)+)):(([a-z]+)):(([0-9]+(\.[0-9]+)+)):((([a-z][\w_]*)\.)*)([a-z][\w_]*)")
"""As ASAM's rule UID schema has it."""
HOSTILE = result(
    [
        verdict("pass"),
        verdict("unknown", reason='<b>"&\x00\x0b\ud7ff</b>', profile="<x>"),
        verdict("error", drive_id="d3"),
    ],
    [finding(x_m=1.5, y_m=-2.0, object_id="\x01<", margin=float("-inf"))],
    drives=[drive(), drive("d2", status="not_judged", status_reason="no ego", sha256=None), drive("d3", map_name=None)],
    rules=[rule(params=[{"name": "p", "value": "1.5", "unit": "s", "overridden": False}])],
)


def parsed(run: Result) -> Any:
    return etree.fromstring(xqar.render(run))


def checker(run: Result) -> Any:
    (found,) = parsed(run).iter("Checker")
    return found


@pytest.mark.parametrize("run", [pytest.param(result([]), id="nothing"), pytest.param(HOSTILE, id="hostile")])
def test_the_results_are_valid_xqar(run: Result) -> None:
    schema = etree.XMLSchema(etree.parse(shared("standards/xqar_result_format.xsd")))
    schema.assertValid(parsed(run))


@pytest.mark.parametrize(
    ("verdicts", "status", "issues"),
    [
        (["pass"], "completed", 0),
        (["not_applicable"], "skipped", 0),
        (["unknown"], "skipped", 0),
        (["unknown", "not_applicable"], "skipped", 0),
        (["pass", "unknown"], "completed", 1),
        (["pass", "unknown", "error"], "error", 2),
        ([], "skipped", 0),
    ],
)
def test_only_what_judged_something_completed(verdicts: list[str], status: str, issues: int) -> None:
    found = checker(result([verdict(each, occurrence=n) for n, each in enumerate(verdicts)]))
    assert found.get("status") == status
    assert len(found.findall("Issue")) == issues, "and what was skipped must have none, by ASAM's reader"
    assert {data.get("key"): int(data.get("value")) for data in found.iter("Metadata")} == {
        each: verdicts.count(each) for each in ("pass", "fail", "unknown", "not_applicable", "error")
    }


def test_a_skipped_rule_says_why() -> None:
    rows = [verdict("unknown", reason="no lights"), verdict("unknown", occurrence=1, reason="no lights")]
    assert checker(result(rows)).get("summary") == (
        "0 pass, 0 fail, 2 unknown, 0 not applicable, 0 error; no lights (2 times)"
    )


def test_a_finding_is_an_issue_with_time_place_and_id() -> None:
    found = checker(result([verdict("fail")], [finding(x_m=1.5, y_m=-2.0, lanelet_id="117")]))
    (issue,) = found.iter("Issue")
    assert (issue.get("level"), issue.get("issueId")) == ("1", "0")
    assert issue.get("description").startswith("profile nominal: 8.00 s: ego 1, object 3; observed 58.00 m")
    place = issue.find("Locations")
    assert dict(place.find("InertialLocation").attrib) == {"x": "1.5", "y": "-2.0", "z": "0.0"}
    assert float(place.find("TimeLocation").get("time")) == 108.0
    assert issue.find("DomainSpecificInfo/Finding").get("finding_id") == f"d1-{SDA}-nominal-0"
    assert issue.get("ruleUID") == found.find("AddressedRule").get("ruleUID")


def test_issues_are_numbered_through_the_file() -> None:
    rows = [finding(), finding(finding_id="x", occurrence=1), finding(drive_id="d2", t_worst_ns=109 * SECOND)]
    told = [verdict("fail"), verdict("fail", drive_id="d2"), verdict("unknown", drive_id="d2")]
    root = parsed(result(told, rows, drives=[drive(), drive("d2")]))
    assert [issue.get("issueId") for issue in root.iter("Issue")] == ["0", "1", "2", "3"]
    assert [bundle.find("Param").get("value") for bundle in root] == ["d1.csv", "d2.csv"]


def test_a_drive_that_was_not_judged_completed_nothing() -> None:
    bundle = parsed(HOSTILE)[1]
    assert bundle.get("summary") == "not judged: no ego"
    assert [(each.get("status"), each.get("summary")) for each in bundle.iter("Checker")] == [
        ("skipped", "the drive was not judged")
    ]


@pytest.mark.parametrize(
    ("severity", "status", "object_id", "level"),
    [
        ("critical", "stable", "3", "1"), ("major", "stable", "3", "2"), ("minor", "stable", "3", "3"),
        ("critical", "draft", "3", "3"), ("critical", "stable", "4", "3"),
    ],
)  # fmt: skip
def test_what_does_not_gate_is_information(severity: str, status: str, object_id: str, level: str) -> None:
    run = result([verdict("fail")], [finding(severity=severity, object_id=object_id)], rules=[rule(status=status)])
    waiver = Waiver("w:1", "*", "ticket 17", "jo", "2027-01-31", object="4")
    (issue,) = checker(GateInputs(date(2026, 11, 20), waivers=(waiver,)).apply_to(run)).iter("Issue")
    assert issue.get("level") == level
    assert ("waived until 2027-01-31 by jo: ticket 17" in issue.get("description")) == (object_id == "4")
    assert ("draft, does not gate" in issue.get("description")) == (status == "draft")


def test_what_the_baseline_has_is_told() -> None:
    run = GateInputs(date(2026, 11, 20), result([verdict("fail")], [finding()])).apply_to(
        result([verdict("fail")], [finding()])
    )
    (issue,) = checker(run).iter("Issue")
    assert issue.get("description").endswith("(known: the baseline contains it)")


@pytest.mark.parametrize(
    ("rule_id", "pack", "name"),
    [
        (SDA, "ukhc", "r162.safe_distance_ahead"),
        ("my-2nd_pack.Über.5m", "my-2nd_pack", "r_ber.r5m"),
        ("9.x", "9", "x"),
    ],
)
def test_rule_uids_are_as_asam_writes_them(rule_id: str, pack: str, name: str) -> None:
    uid = xqar.rule_uid(rule_id, pack)
    assert UID.fullmatch(uid), uid
    assert uid.endswith(f":{name}")


def test_the_same_result_gives_the_same_bytes() -> None:
    assert xqar.render(HOSTILE) == xqar.render(HOSTILE)
