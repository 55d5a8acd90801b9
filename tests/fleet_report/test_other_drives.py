"""Two audits of other drives: their findings are not new faults, their rates are compared."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import duckdb
import pytest

from drivelint.audit.store import LocalFolder
from drivelint.audit.unpacked import AuditProgress
from drivelint.errors import ExitCode
from drivelint.fleet.rate_change import rate_changes
from drivelint.fleet.rates import rates
from drivelint.fleet_report import difference_text
from drivelint.fleet_report.audit_views import Audit
from drivelint.fleet_report.difference import AuditDifference, difference
from drivelint.fleet_report.figures import number_text
from tests.fleet import audits
from tests.fleet.audits import drive_finding, drive_verdict, ego_drive
from tests.report.synthetic import rule

pytestmark = pytest.mark.ci

RULES = [rule(name, profiles=[]) for name in ("follow", "overtake", "silent", "still")]
N = {"r1": (2, 22), "r2": (17, 24)}
"""Release -> failed overtakes, and all of them."""


def fleet(con: duckdb.DuckDBPyConnection, of: str, release: str, also: tuple[str, ...] = ()) -> None:
    """Write an audit of one drive of 100 km with these overtakes, and of further ones without any."""
    failed, n = N[release]
    name = f"drive-{release}"
    drives = [ego_drive(each, tags={"release": release}) for each in (name, *also)]
    verdicts = [
        drive_verdict(name, "fail" if k < failed else "pass", rule_id="overtake", occurrence=k, ref_id=None)
        for k in range(n)
    ]
    verdicts += [drive_verdict(each, "pass", rule_id="follow", ref_id=None) for each in (name, *also)]
    verdicts += [drive_verdict(name, "pass", rule_id=each, ref_id=None) for each in ("silent", "still")]
    findings = [
        drive_finding(
            name, rule_id="overtake", occurrence=k, finding_id=f"{name}-{k}", t_start_ns=k * 10**10, t_end_ns=k * 10**10
        )
        for k in range(failed)
    ]
    audits.add_rows(con, drives, verdicts, findings, RULES, of=of)


def compared(base_also: tuple[str, ...] = (), new_also: tuple[str, ...] = ()) -> AuditDifference:
    with duckdb.connect() as con:
        fleet(con, "base_", "r1", base_also)
        fleet(con, "", "r2", new_also)
        sides = [
            Audit(name, LocalFolder(Path(name)), {"fail_on": "critical"}, AuditProgress("d"))
            for name in ("new", "base")
        ]
        return difference(con, sides[0], sides[1], 50)


@pytest.fixture(scope="module")
def disjoint() -> AuditDifference:
    return compared()


def test_audits_without_a_common_drive_are_told_as_such(disjoint: AuditDifference) -> None:
    for markdown in (False, True):
        text = difference_text.to_text(disjoint, None, markdown=markdown)
        assert "the two audits have no drive in common: findings cannot be matched; compare rates" in text
        assert "17 new" not in text
        assert "the drive was not checked" not in text


def test_their_rates_gate_unless_findings_are_asked_for(disjoint: AuditDifference) -> None:
    def code(fail_on: str | None) -> ExitCode:
        return difference_text.exit_code(disjoint, difference_text.gating_severity(disjoint, fail_on))

    assert code(None) == ExitCode.FAILED
    assert code("critical") == ExitCode.FAILED
    assert code("never") == ExitCode.OK
    told = json.loads(difference_text.to_json(disjoint, None))["exit"]
    said = "overtake per occasion 7.79 times, overtake per 100 km 8.50 times"
    assert told["code"] == 1
    assert told["why"].startswith(f"rates at or above severity critical are higher than chance explains: {said}; ")
    assert difference_text.changes_sentence(disjoint).endswith(f"differ by more than chance explains: {said}")


def test_a_headline_names_rates_also_if_some_drives_are_in_both(disjoint: AuditDifference) -> None:
    shared = replace(disjoint, comparison=disjoint.comparison._replace(drives_both=1))
    assert difference_text.changes_sentence(shared).startswith(
        "rates that differ by more than chance explains: overtake per occasion 7.79 times, overtake per 100 km 8.50 times; 17 new"
    )
    other = [replace(each, profile=name) for each in disjoint.rates for name in ("a", "b", "c", "d")]
    assert "d] per occasion" not in (told := difference_text.changes_sentence(replace(shared, rates=other)))
    assert "overtake [c] per occasion 7.79 times and 1 more rule; 17 new" in told


def test_a_rate_that_fell_or_that_does_not_gate_is_no_failure(disjoint: AuditDifference) -> None:
    minor = replace(disjoint, gating_rules={"overtake": "minor"})
    assert difference_text.exit_code(minor, None) == ExitCode.OK
    assert "exit 0: no rate at or above severity critical is higher" in difference_text.to_text(minor, None)
    with duckdb.connect() as con:
        fleet(con, "base_", "r2")
        fleet(con, "", "r1")
        sides = [Audit(name, LocalFolder(Path(name)), {}, AuditProgress("d")) for name in ("new", "base")]
        fell = difference(con, sides[0], sides[1], 50)
    assert fell.significant_changes
    assert difference_text.exit_code(fell, None) == ExitCode.OK


def test_audits_without_rates_or_without_an_end_are_no_pass(disjoint: AuditDifference) -> None:
    nothing = replace(disjoint, rates=[])
    assert difference_text.exit_code(nothing, None) == ExitCode.NOT_JUDGED
    assert "no rule has a rate in both" in difference_text.to_text(nothing, None)
    unfinished = replace(disjoint.new, standing=AuditProgress(None, 1, 1))
    running = replace(disjoint, new=unfinished, gating_rules={})
    assert difference_text.exit_code(running, None) == ExitCode.NOT_JUDGED


def test_findings_that_the_newer_audit_did_not_look_at_are_no_pass() -> None:
    with duckdb.connect() as con:
        fleet(con, "base_", "r1", ("shared",))
        audits.add_rows(con, [ego_drive("shared")], [drive_verdict("shared", "pass")], [], RULES)
        sides = [Audit(name, LocalFolder(Path(name)), {}, AuditProgress("d")) for name in ("new", "base")]
        told = difference(con, sides[0], sides[1], 50)
    assert told.counts["lost"] == 2
    assert difference_text.exit_code(told, "critical") == ExitCode.NOT_JUDGED
    assert (
        "exit 4: no new finding at or above severity critical, but 2 earlier findings gone"
        in difference_text.to_text(told, "critical")
    )
    assert difference_text.exit_code(told, "never") == ExitCode.OK


def test_findings_of_added_drives_are_told_apart() -> None:
    told = compared(base_also=("shared",), new_also=("shared",))
    assert told.headline.startswith("17 new (17 in drives that the base does not contain), ")
    assert difference_text.gating_severity(told, None) == "critical"


FOUR_DRIVES = ("shared", "lone-1", "lone-2", "lone-3")


def test_fleets_with_few_common_drives_are_compared_by_rates() -> None:
    told = compared(FOUR_DRIVES, ("shared", "other-1", "other-2", "other-3"))
    assert told.headline == (
        "only 1 drive is in both audits: there 0 new, no earlier finding; 17 findings in 4 drives of the newer audit alone, "
        "2 findings in 4 drives of the base alone; compare rates"
    )
    for markdown in (False, True):
        text = difference_text.to_text(told, "critical", markdown=markdown)
        assert "1 drive in both audits, 4 only in the newer audit, 4 only in the base" in text
        assert "the drive was not checked" not in text
        assert "Findings in drives that only one audit has are not listed" in text
        assert (
            "exit 1: 17 new findings at or above severity critical, 17 of them in drives that the base does not contain; "
            in text
        )
        assert (
            "rates at or above severity critical are higher than chance explains: overtake per occasion 7.79 times"
            in text
        )
    assert difference_text.exit_code(told, "critical") == ExitCode.FAILED
    assert len(json.loads(difference_text.to_json(told, "critical"))["entries"]) == 17 + 2


def test_new_findings_of_the_few_common_drives_are_still_listed() -> None:
    with duckdb.connect() as con:
        fleet(con, "base_", "r1", FOUR_DRIVES)
        names = ("shared", *(f"other-{n}" for n in range(60)))
        verdicts = [drive_verdict(name, "fail", rule_id="overtake", ref_id=None) for name in names]
        findings = [drive_finding(name, rule_id="overtake", finding_id=f"{name}-0") for name in names]
        audits.add_rows(con, [ego_drive(name) for name in names], verdicts, findings, RULES)
        sides = [Audit(name, LocalFolder(Path(name)), {}, AuditProgress("d")) for name in ("new", "base")]
        told = difference(con, sides[0], sides[1], 50)
    assert told.headline.startswith(
        "only 1 drive is in both audits: there 1 new, no earlier finding; 60 findings in 60 drives"
    )
    text = difference_text.to_text(told, "critical")
    assert "New (1, in drives of both audits)\n  critical: shared " in text
    assert "Rows of findings that differ, by what else differs between the audits:\n  software: 1 new\n" in text


@pytest.mark.ci
def test_a_tag_that_all_drives_of_an_audit_share_is_the_software_of_drives_that_only_it_has() -> None:
    for told in (compared(), compared(base_also=("shared",), new_also=("shared",))):
        assert set(told.causes) == {("drive", "software")}
        assert set(told.causes_not_known) == {"tool"}, (
            "nothing is asked of the log and the map of a drive that only one has"
        )
        assert "software" not in told.causes_not_known


def test_rates_are_tested_per_occasion_too(disjoint: AuditDifference) -> None:
    from scipy.stats import fisher_exact

    (change,) = disjoint.significant_changes
    tests = {each.per: each for each in change.tests}
    assert change.rule_id == "overtake"
    expected = fisher_exact([[2, 20], [17, 7]])[1]
    assert tests["occasion"].p_value == pytest.approx(expected)
    assert tests["occasion"].corrected == pytest.approx(2 * expected), "two tests of the one rule that has findings"
    assert tests["occasion"].ratio == pytest.approx(17 / 24 / (2 / 22))
    text = difference_text.to_text(disjoint, None)
    assert "Rates of 1 rule differ significantly (2 exact tests" in text
    assert "  differs: overtake per occasion: 2 of 22, 9.09 %" in text
    assert f"7.79 times, p {number_text(expected)}, corrected {number_text(2 * expected)}" in text


def test_the_nearest_candidates_are_shown_where_nothing_is_called() -> None:
    with duckdb.connect() as con:
        fleet(con, "", "r1")
        fleet(con, "base_", "r1")
        same = rate_changes(rates(con), rates(con, of="base_"))
    assert not any(each.is_significant for each in same)
    assert [(each.rule_id, len(each.tests)) for each in same] == [
        ("follow", 0), ("overtake", 2), ("silent", 0), ("still", 0)
    ]  # fmt: skip
    assert {test.ratio for each in same for test in each.tests} == {1.0}


def test_a_rate_of_which_the_base_has_no_event_has_no_ratio() -> None:
    def rates_with_findings(n: int) -> Any:
        with duckdb.connect() as con:
            row = ego_drive("a")
            audits.add_rows(
                con, [row], [drive_verdict("a", "fail" if n else "pass")], [drive_finding("a")] * n, [rule(profiles=[])]
            )
            return rates(con)

    (change,) = rate_changes(rates_with_findings(0), rates_with_findings(1))
    assert [difference_text.ratio_text(each) for each in change.tests] == ["none before"] * 2
