"""ASAM's own reader, qc_baselib 1.1.0 (PyPI: asam-qc-baselib), reads our checker results and finds in them what we wrote.

It refuses a whole file in which a checker has an issue of a rule that it does not address, so ours addresses every rule that it ran. It
looks bundles up by their names, so each drive's has its own.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from lxml import etree

from drivelint.report import xqar
from tests.report.synthetic import SDA, drive, finding, result, rule, verdict

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.result.model import Result

GAP = "ukhc.r126.gap"
UID = xqar.rule_uid(SDA, "ukhc")


def run() -> Result:
    """Return the result of two rules over two drives: one breaks a rule and leaves it unknown, the other was not judged."""
    rows = [verdict("fail"), verdict("unknown", occurrence=1), verdict("not_applicable", rule_id=GAP)]
    drives = [drive(), drive("d2", status="not_judged", status_reason="no ego", sha256=None)]
    return result(rows, [finding(x_m=1.5, y_m=-2.0)], drives=drives, rules=[rule(), rule(rule_id=GAP)])


def read_back(content: bytes, tmp_path: Path) -> Any:
    qc_baselib = pytest.importorskip("qc_baselib", reason="qc_baselib is not installed (pip install asam-qc-baselib)")
    path = tmp_path / "results.xqar"
    path.write_bytes(content)
    found = qc_baselib.Result()
    found.load_from_file(str(path))
    return found


def test_every_rule_is_addressed_by_its_checker() -> None:
    checkers = list(etree.fromstring(xqar.render(run())).iter("Checker"))
    assert [each.get("checkerId") for each in checkers] == [SDA, GAP] * 2
    for checker in checkers:
        addressed = {each.get("ruleUID") for each in checker.iter("AddressedRule")}
        assert addressed == {xqar.rule_uid(checker.get("checkerId", ""), "ukhc")}
        assert {each.get("ruleUID") for each in checker.iter("Issue")} <= addressed


def test_asams_reader_finds_what_we_wrote(tmp_path: Path) -> None:
    found = read_back(xqar.render(run()), tmp_path)
    assert found.get_result_version() == "1.0.0"
    assert found.get_checker_bundle_names() == ["drivelint d1", "drivelint d2"]
    assert [found.get_checker_ids(bundle) for bundle in found.get_checker_bundle_names()] == [[SDA, GAP]] * 2
    statuses = [[each.status.value for each in bundle.checkers] for bundle in found.get_checker_bundle_results()]
    assert statuses == [["completed", "skipped"], ["skipped", "skipped"]]
    issues = sorted(found.get_issues_by_rule_uid(UID), key=lambda issue: int(issue.issue_id))
    assert [(issue.issue_id, issue.level.value) for issue in issues] == [(0, 1), (1, 3)]
    (place,) = issues[0].locations
    assert place.inertial_location[0].x == 1.5
    assert place.time_location[0].time == 108.0
    assert found.get_issue_count() == 2, "of bundles of one name it would count the first one's twice"


def test_asams_reader_refuses_an_issue_of_a_rule_that_is_not_addressed(tmp_path: Path) -> None:
    """If this fails, the reader has become milder: the law stays."""
    root = etree.fromstring(xqar.render(run()))
    for addressed in list(root.iter("AddressedRule")):
        addressed.getparent().remove(addressed)  # type: ignore[union-attr]
    with pytest.raises(ValueError, match=r"(?i)rule"):
        read_back(etree.tostring(root), tmp_path)
