"""Rates of a fleet as a reader meets them: the gravest rule first, and no 0 where findings were left out."""

from __future__ import annotations

import duckdb

from drivelint.fleet.rates import rates
from drivelint.fleet_report.by_tag import rates_by_tag
from drivelint.fleet_report.figures import lower_bound_instead_of_zero
from tests.fleet import audits
from tests.fleet.audits import drive_finding, drive_verdict, ego_drive
from tests.report.synthetic import rule

RULES = [
    rule("a.minor", severity="minor", profiles=[]),
    rule("b.contact", severity="critical", profiles=[]),
    rule("c.critical", severity="critical", profiles=[]),
]


def test_by_a_tag_the_gravest_rule_is_first_and_of_these_the_most_frequent() -> None:
    n_findings = {"a.minor": 5, "b.contact": 1, "c.critical": 2}
    findings = [
        drive_finding(
            "d", rule_id=rule_id, finding_id=f"{rule_id}{n}", severity="minor" if rule_id == "a.minor" else "critical"
        )
        | {"t_start_ns": n, "t_end_ns": n}
        for rule_id, k in n_findings.items()
        for n in range(k)
    ]
    with duckdb.connect() as con:
        audits.add_rows(
            con, [ego_drive("d")], [drive_verdict("d", "fail", rule_id=name) for name in n_findings], findings, RULES
        )
        told = rates_by_tag(con, "release")
    assert [each.rule_id for each in told.rules] == ["c.critical", "b.contact", "a.minor"]


def test_a_rate_that_leaves_findings_out_is_told_by_its_lower_bound() -> None:
    drives = [ego_drive("a"), ego_drive("b", km=50.0)]
    verdicts = [
        drive_verdict(name, word, rule_id="b.contact")
        for name, word in (("a", "pass"), ("b", "fail"), ("b", "unknown"))
    ]
    for of, is_told in (("b", True), ("a", False)):
        with duckdb.connect() as con:
            rows = verdicts if is_told else [*verdicts, drive_verdict("a", "fail", rule_id="b.contact")]
            audits.add_rows(con, drives, rows, [drive_finding(of, rule_id="b.contact")], RULES[1:2])
            (rate,) = rates(con)
        told = lower_bound_instead_of_zero(rate)
        assert (told is not None) == is_told
        if told is not None:
            assert told[0].startswith("at least 0.0")
            assert told[1].startswith("over all km; fully judged: 0 (0 to ")
            assert told[1].endswith(")")
