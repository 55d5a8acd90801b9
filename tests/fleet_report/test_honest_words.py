"""What the fleet page says of fleets made by hand: findings beside a rate, copies, contacts, reasons, rules that nothing decided."""

from __future__ import annotations

import re
from pathlib import Path

import duckdb
import pytest

from drivelint.audit.compact import RECEIPT_SCHEMA
from drivelint.audit.store import LocalFolder
from drivelint.audit.unpacked import AuditProgress
from drivelint.fleet.missing_signals import missing_signals
from drivelint.fleet_report import content as content_
from drivelint.fleet_report import page
from drivelint.fleet_report.audit_views import Audit
from tests.fleet import audits
from tests.fleet.audits import drive_finding, drive_verdict, ego_drive
from tests.fleet_report.fleet_page import FleetPage, contact, words
from tests.report.synthetic import rule

pytestmark = pytest.mark.ci


def test_findings_where_not_all_was_judged_do_not_look_like_none() -> None:
    """One site has two contacts, in a drive that has unknowns too; the other has none."""
    drives = [
        ego_drive("a", tags={"site": "x"}),
        ego_drive("b", tags={"site": "y"}),
        ego_drive("c", tags={"site": "x"}),
    ]
    fleet_page = FleetPage(
        drives,
        [*words("a", "fail"), *words("a", "unknown"), *words("b"), *words("c")],
        [contact("a"), contact("a", 1)],
        "site",
    )
    (partly, none) = (fleet_page.row("//section[@aria-labelledby='by-1']", site) for site in ("x", "y"))
    assert none.xpath(".//*[contains(@class, 'none')]")
    assert not partly.xpath(".//*[contains(@class, 'none')]")
    assert partly.xpath(".//rect[@class='open']")
    assert "at least 0.121over all" in partly.text_content()
    in_rates = fleet_page.row("//div[contains(@class, 'rate-table')]", "z-contact")
    assert not in_rates.xpath(".//*[contains(@class, 'none')]")
    assert re.search(r"z-contact.*at least 0\.0807 over all", fleet_page.markdown), (
        "two findings in 300 km, Garwood's lower end"
    )


def test_at_least_counts_a_touch_of_two_egos_once_and_nothing_that_is_only_possible() -> None:
    both = [contact("a", n, ego_id=ego, object_id=other) for n, ego, other in ((0, "1", "2"), (1, "2", "1"))]
    way = ego_drive("a")["exposure"]
    drives = [ego_drive("a", exposure=[*way, {**way[0], "ego_id": "2"}])]
    verdicts = [row for ego in "12" for word in ("fail", "unknown") for row in words("a", word, ego_id=ego)]
    for findings, n_sure in ((both, 1), ([{**row, "n_copies": 100, "n_stays": 30} for row in both], 0)):
        fleet_page = FleetPage(drives, verdicts, findings, robustness=True)
        (rate,) = [each for each in fleet_page.content.rates if each.rule_id == "z-contact"]
        assert (rate.findings_of_unknown, rate.events_sure) == (2, n_sure)
        assert fleet_page.content.headline[1] == "1 critical finding in 1 of 1 drives"
        assert rate.at_least_per_100km == pytest.approx(0.0253178 / 2 * n_sure)
    assert (
        "no lower bound over all km"
        in fleet_page.row("//div[contains(@class, 'rate-table')]", "z-contact").text_content()
    )


def test_the_header_names_contacts_and_how_sure_they_are() -> None:
    drives, verdicts = [ego_drive("a"), ego_drive("b")], [*words("a", "fail"), *words("b", "fail")]
    findings = [contact("a", n_copies=100, n_stays=100), contact("b", n_copies=100, n_stays=30)]
    fleet_page = FleetPage(drives, verdicts, findings, robustness=True)
    said_ = "CONTACT in 1 drive; possible contact in 1 drive; certainty of the findings: examined: 1 only possible"
    assert said_ in fleet_page.header
    assert said_ in fleet_page.markdown
    assert "| 2 (1 possible) |" in fleet_page.markdown
    fleet_page = FleetPage(drives, verdicts, [contact("a"), contact("b")], robustness=False)
    assert "CONTACT in 2 drives; certainty of the findings: not examined: use audit --robustness" in fleet_page.header


def test_rules_of_contacts_stand_above_others_of_their_severity() -> None:
    fleet_page = FleetPage(
        [ego_drive("a")],
        words("a", "fail"),
        [drive_finding("a", n_copies=None), drive_finding("a", occurrence=1), contact("a")],
    )
    assert [each.rule_id for each in fleet_page.content.rates] == ["z-contact", "a-room"]


def test_the_hours_of_the_header_are_those_of_the_egos() -> None:
    way = ego_drive("a")["exposure"]
    fleet_page = FleetPage(
        [ego_drive("a", exposure=[*way, {**way[0], "ego_id": "2"}], duration_s=7200.0)],
        [*words("a"), *words("a", ego_id="2")],
        [],
    )
    assert "200 km by 2 egos in 4.00 h" in fleet_page.header
    assert sum(each.hours for each in fleet_page.content.coverage.situations if each.situation == "weather") == 4.0


def test_logs_of_one_content_count_once_everywhere() -> None:
    drives = [ego_drive(name, sha256="same") for name in "abc"] + [ego_drive("d")]
    verdicts = [row for name in "abcd" for row in words(name, "fail" if name != "d" else "pass")]
    fleet_page = FleetPage(drives, verdicts, [contact(name) for name in "abc"])
    assert fleet_page.content.headline[1] == "1 critical finding in 1 of 2 drives"
    assert "2 of 2 drives were judged: 200 km by 2 egos" in fleet_page.header
    assert (
        "2 more logs have the same content as another log: logs with the same content count once" in fleet_page.header
    )
    assert "2 more logs have the same content as another log" in fleet_page.markdown
    (rate,) = [each for each in fleet_page.content.rates if each.rule_id == "z-contact"]
    assert (rate.findings, rate.km, len(fleet_page.content.worst)) == (1, 200, 1)
    assert fleet_page.content.verdicts == {"pass": 2, "fail": 2, "unknown": 0, "not_applicable": 0, "error": 0}


def test_a_drive_that_was_not_judged_is_in_no_denominator() -> None:
    lost = ego_drive("c", status="not_judged", status_reason="log of c: not mcap", log="log of c", exposure=[])
    fleet_page = FleetPage([ego_drive("a"), ego_drive("b"), lost], [*words("a", "fail"), *words("b")], [contact("a")])
    assert fleet_page.content.headline[1] == "1 critical finding in 1 of 2 judged drives"
    assert "2 of 3 drives were judged" in fleet_page.header
    (row,) = fleet_page.html.xpath("//table[caption[contains(., 'not judged at all')]]/tbody/tr")
    assert row.xpath("./td")[0].text_content() == "not mcap", "the log stands beside it"


def test_a_situation_that_is_not_known_is_not_in_the_table_as_the_page_says() -> None:
    fleet_page = FleetPage([ego_drive("a")], words("a", "fail"), [contact("a")])
    section = fleet_page.html.xpath("//section[@aria-labelledby='coverage']")[0]
    assert "Not known for any drive, and therefore not in the table: " in section.text_content()
    assert "weather" not in [each.text_content() for each in section.xpath(".//tbody/tr/th")]
    fleet_page = FleetPage([ego_drive("a", tags={"weather": "wet"}), ego_drive("b")], [*words("a"), *words("b")], [])
    section = fleet_page.html.xpath("//section[@aria-labelledby='coverage']")[0]
    values = [row.xpath("./td")[0].text_content() for row in section.xpath(".//tbody/tr[th = 'weather']")]
    assert values == ["wet", "not known"], "known for one drive"


def test_the_page_says_why_rates_of_profiles_are_more_than_the_findings() -> None:
    def page_of_profiles(*profiles: str | None) -> FleetPage:
        verdicts = [drive_verdict("a", "fail", rule_id="z-contact", profile=each) for each in profiles]
        return FleetPage([ego_drive("a")], verdicts, [contact("a", n, profile=each) for n, each in enumerate(profiles)])

    why = "counts in both, and once in the headline"
    both = page_of_profiles("nominal", "observed")
    assert both.content.headline[1].startswith("1 ")
    assert sum(each.findings for each in both.content.rates) == 2
    assert why in both.html.text_content()
    assert why in both.markdown
    assert why not in page_of_profiles(None).html.text_content()


def test_a_copy_that_was_judged_by_other_options_hides_nothing() -> None:
    drives = [ego_drive(name, sha256="same") for name in "ab"]
    fleet_page = FleetPage(drives, [*words("a"), *words("b", "fail"), *words("b", "unknown")], [contact("b")])
    assert fleet_page.content.headline[1] == "1 critical finding in 1 of 1 drives"
    assert "1 finding of these logs counts for no rate, because it was judged with other options" in fleet_page.header
    assert not fleet_page.content.is_all_decided


def test_a_rule_that_nothing_decided_says_in_how_many_drives_it_was_unknown() -> None:
    verdicts = [*words("a", "unknown"), *words("b", "not_applicable", reason_code="not_triggered")]
    fleet_page = FleetPage([ego_drive("a"), ego_drive("b")], verdicts, [])
    coverage = " ".join(fleet_page.html.xpath("//section[@aria-labelledby='coverage']")[0].text_content().split())
    assert "unknown each time" not in coverage
    assert "Never decided: no verdict passed or failed, some are unknown (2)" in coverage
    assert "No collision (unknown in 1 of 2 drives)" in coverage
    assert "`z-contact` (unknown in 1 of 2 drives)" in fleet_page.markdown
    assert "100 did not apply" in " ".join(
        fleet_page.row("//div[contains(@class, 'rate-table')]", "z-contact").xpath(
            "./td[@data-label='km judged']//text()"
        )
    )


def test_what_would_decide_it_names_the_rule_and_its_own_words() -> None:
    verdicts = [
        *words("a", "unknown", reason_code="null_value", cause_code="margin", reason="the width of 7 is not known"),
        *words("b", "unknown", reason_code="null_value", cause_code="speed", reason="the speed of 9 is not known"),
    ]
    fleet_page = FleetPage([ego_drive("a"), ego_drive("b")], verdicts, [])
    for why in ("a-room: the width of 7 is not known", "a-room: the speed of 9 is not known"):
        assert why in fleet_page.html.xpath("//section[@aria-labelledby='open']")[0].text_content()
        assert why in fleet_page.markdown
    assert "null value (margin)" in fleet_page.markdown


def test_a_signal_is_advised_in_the_formats_that_lack_it() -> None:
    def fleet(log_format: str) -> str:
        lack = [{"ego_id": "1", "signal": "indicator", "reason_code": "missing_indicator", "reason": ""}]
        needs = rule("a-room", profiles=[], requires=["indicator"])
        with duckdb.connect() as con:
            row = ego_drive("a", not_judged=lack, format=log_format)
            audits.add_rows(
                con,
                [row],
                [drive_verdict("a", "unknown", rule_id="a-room", reason_code="missing_indicator")],
                [],
                [needs],
            )
            (each,) = missing_signals(con).signals
        return page._advice_on_signal(each)

    assert fleet("commonroad") != fleet("mapped")
    assert "mapping" not in fleet("commonroad")


def test_a_signal_that_decides_nothing_alone_is_not_told_with_zeros() -> None:
    lack = [
        {"ego_id": "1", "signal": name, "reason_code": f"missing_{name}", "reason": ""} for name in ("indicator", "map")
    ]
    drives = [ego_drive("a", not_judged=lack)]
    with duckdb.connect() as con:
        needs = rule("a-room", profiles=[], requires=["indicator", "map"])
        audits.add_rows(
            con, drives, [drive_verdict("a", "unknown", rule_id="a-room", reason_code="missing_map")], [], [needs]
        )
        con.register("receipts", RECEIPT_SCHEMA.empty_table())
        audit = Audit("out", LocalFolder(Path("out")), {"settings": {}}, AuditProgress("d"))
        text = page.markdown(content_.fleet_content(con, audit, None, ())).decode()
    assert "no judgement by itself, 1 judgement together with other signals" in text
    assert "at most 0" not in text


def test_a_worst_drive_has_its_finding_the_time_and_the_command_that_explains_it() -> None:
    findings = [drive_finding("a", margin=-50.0, t_worst_s=1.0), contact("a", object_id="439", margin=-0.1)]
    fleet_page = FleetPage([ego_drive("a")], words("a", "fail"), findings)
    (row,) = fleet_page.html.xpath("//div[contains(@class, 'worst-table')]//tbody/tr")
    assert "No collision at 12.50 s, object 439" in " ".join(row.text_content().split()).replace(
        "collisionat", "collision at"
    )
    assert "drivelint explain a-0 --in drives/a" in row.xpath(".//code[@class='command']")[1].text_content()
    assert "No collision at 12.50 s" in fleet_page.markdown


def test_the_worst_finding_says_what_went_wrong_and_occasions_judged_in_part_are_beside_the_share() -> None:
    whole, partly = words("a"), [{**row, "n_judged": 1, "n_expected": 2} for row in words("b", "fail")]
    fleet_page = FleetPage([ego_drive("a"), ego_drive("b")], [*whole, *partly], [contact("b")])
    (rate,) = [each for each in fleet_page.content.rates if each.rule_id == "z-contact"]
    assert (rate.occasions, rate.occasions_failed, rate.occasions_partly) == (1, 0, 1)
    assert "+ 1 judged in part" in fleet_page.row("//div[contains(@class, 'rate-table')]", "z-contact").text_content()
    assert ", + 1 judged in part |" in fleet_page.markdown
    worst = fleet_page.row("//div[contains(@class, 'worst-table')]", "b").text_content()
    assert worst.count("Not kept: No collision") == 2, "the worst finding, and the broken rules"
    assert "Not kept: No collision at 12.50 s" in fleet_page.markdown
