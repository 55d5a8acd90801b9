"""Coverage: rules and situations that never occurred. Missing signals: the forecast holds when the signal is supplied."""

from __future__ import annotations

from typing import Any

import duckdb
import pyarrow.parquet as pq
import pytest

from drivelint.fleet.coverage import STANDINGS, coverage
from drivelint.fleet.missing_signals import SignalGaps, missing_signals
from drivelint.fleet.rates import rates
from tests.fleet import audits
from tests.fleet.conftest import RunCheck
from tests.report.synthetic import drive, rule, verdict


def test_each_rule_has_one_standing() -> None:
    names = ("a-decided", "b-undecided", "c-elsewhere", "d-silent", "e-absent")
    words = [
        verdict("pass", rule_id="a-decided"), verdict("unknown", rule_id="a-decided"), verdict("unknown", rule_id="b-undecided"),
        verdict("not_applicable", rule_id="c-elsewhere", reason_code="other_nation"),
        verdict("not_applicable", rule_id="d-silent", reason_code="not_triggered"),
    ]  # fmt: skip
    words = [row | {"profile": None} for row in words]
    with duckdb.connect() as con:
        audits.add_rows(con, [drive()], words, [], [rule(name, profiles=[]) for name in names])
        found = coverage(con)
    expected = ("decided", "never_decided", "never_in_force", "never_triggered", "not_run")
    assert [(each.rule_id, each.standing) for each in found.rules] == list(zip(names, expected, strict=True))
    assert set(expected) == set(STANDINGS)
    assert found.rules_with_standing("never_triggered")[0].drives_not_triggered == 1
    assert (found.rules[0].drives_unknown, found.rules[0].occasions) == (1, 1)


def test_a_log_that_is_there_twice_is_one_drive() -> None:
    words = [verdict("fail", drive_id=name, profile=None) for name in ("a", "b")]
    with duckdb.connect() as con:
        twice = [drive("a", sha256="same"), drive("b", sha256="same")]
        audits.add_rows(con, twice, words, [], [rule(profiles=[])])
        (found,) = coverage(con).rules
    assert (found.drives, found.drives_failed) == (1, 1)


def test_situations_that_never_occurred_and_drives_that_do_not_say() -> None:
    way = {"ego_id": "1", "km": 60.0, "hours": 1.0, "engaged_km": 60.0, "engaged_hours": 1.0, "n_steps": 9}
    drives = [
        drive("a", sha256="a", exposure=[way], tags={"weather": "wet"}, n_states=9, n_steps=9),
        drive("b", sha256="b", exposure=[way], tags={"weather": "hail"}),
        drive("c", sha256="c", exposure=[way]),
    ]
    words = [verdict("fail", drive_id="a"), verdict("pass", drive_id="a"), verdict("unknown", drive_id="c")]
    words += [verdict("not_applicable", drive_id="b")]
    with duckdb.connect() as con:
        audits.add_rows(con, drives, words, [], [rule()])
        found = coverage(con)
    weather = {each.value: each for each in found.situations if each.situation == "weather"}
    assert list(weather) == ["dry", "wet", "ice", "hail", None]
    assert (weather["wet"].km, weather["wet"].occasions, weather["wet"].occasions_failed) == (60, 2, 1)
    assert (weather[None].egos, weather[None].occasions_unknown) == (1, 1)
    never = [(each.situation, each.value) for each in found.never_occurred()]
    assert ("weather", "dry") in never
    assert ("weather", "wet") not in never
    assert ("speed_band", "60 to 90 km/h") not in never
    assert ("speed_band", "0 to 15 km/h") in never
    untold = found.situations_never_known()
    assert "light" in untold
    assert "weather" not in untold
    assert not set(untold) & {situation for situation, _ in never}, "of what nobody knows nothing is said"
    traffic = {each.value: each.egos for each in found.situations if each.situation == "traffic"}
    assert traffic == {"less than 1 other": 1, "1 to 5 others": 2, "5 to 20 others": 0, "20 others and more": 0}
    assert found.cannot_tell


def test_a_tag_does_not_hide_the_condition_of_the_same_name() -> None:
    way = {"ego_id": "1", "km": 60.0, "hours": 1.0, "engaged_km": 60.0, "engaged_hours": 1.0, "n_steps": 9}
    said = [{"condition": "weather", "value": "wet", "source": "env"}]
    with duckdb.connect() as con:
        rainy = drive("a", sha256="a", exposure=[way], tags={"weather": "rain"}, conditions=said)
        audits.add_rows(con, [rainy], [verdict("pass", drive_id="a")], [], [rule()])
        found = coverage(con)
        (tagged,) = {each.tag_value for each in rates(con, by="weather")}
    assert [each.value for each in found.situations if each.situation == "weather" and each.egos] == ["wet"]
    assert ("weather", "wet") not in [(each.situation, each.value) for each in found.never_occurred()]
    assert tagged == "rain", "--by asks for the tag"


@pytest.mark.slow
def test_coverage_and_rates_of_a_real_check_agree_with_its_tables(run_check: RunCheck) -> None:
    folder = run_check()
    verdicts = pq.read_table(folder / "verdicts.parquet").to_pylist()
    occasions = {
        (each["rule_id"], each["profile"]): each["n_judged"]
        for row in pq.read_table(folder / "drives.parquet").to_pylist()[:1]
        for each in row["occasions"]
    }
    first = min(row["drive_id"] for row in verdicts)
    with duckdb.connect() as con:
        audits.add_results(con, folder, tags=lambda row: {"scene": row["drive_id"]})
        found, counted, by_scene = coverage(con), rates(con), rates(con, "scene")
    decided = {row["rule_id"] for row in verdicts if row["verdict"] in {"pass", "fail"}}
    # a fleet counts a signal that few logs record as unknown: its auditor asks what to record
    undecided = {
        row["rule_id"]
        for row in verdicts
        if row["verdict"] in {"unknown", "error"} or row["reason_code"].startswith("unrecorded_")
    }
    assert undecided - decided, "no log of this fleet records headlights"
    assert {each.rule_id for each in found.rules_with_standing("decided")} == decided
    assert {each.rule_id for each in found.rules_with_standing("never_decided")} == undecided - decided
    assert found.rules_with_standing("never_triggered")
    assert sum(r.n_fail for r in counted) == sum(row["verdict"] == "fail" for row in verdicts)
    assert (
        sum(r.findings + r.findings_of_unknown for r in counted)
        == pq.read_metadata(folder / "findings.parquet").num_rows
    )
    of_first = {(r.rule_id, r.profile): r.occasions + r.occasions_partly for r in by_scene if r.tag_value == first}
    assert {rule_: n for rule_, n in of_first.items() if n} == {rule_: n for rule_, n in occasions.items() if n}


def of_check(folder: Any) -> SignalGaps:
    with duckdb.connect() as con:
        audits.add_results(con, folder)
        return missing_signals(con)


@pytest.mark.slow
@pytest.mark.parametrize("rules", ["alks-r157"])
def test_the_forecast_of_a_signal_is_what_is_judged_when_it_is_supplied(run_check: RunCheck, rules: str) -> None:
    before, after = run_check("--rules", rules), run_check("--rules", rules, "--env", "engaged=yes")
    (signal,) = [each for each in of_check(before).signals if each.signal == "mode_engaged"]
    assert 0 < signal.judgements_alone < signal.judgements, "some of these rules need more than that signal"
    assert signal.drives == signal.drives_alone == 3

    def lacking(folder: Any) -> set[tuple[str, str]]:
        rows = pq.read_table(folder / "verdicts.parquet").to_pylist()
        return {(r["drive_id"], r["rule_id"]) for r in rows if r["reason_code"].startswith(("missing_", "unrecorded_"))}

    decided = lacking(before) - lacking(after)
    assert len(decided) == signal.judgements_alone
    assert len({name for _, name in decided}) == signal.rules_alone
    assert "mode_engaged" not in {each.signal for each in of_check(after).signals}


def test_other_reasons_stand_beside() -> None:
    words = [verdict("unknown", reason_code="ego_not_placed"), verdict("unknown", reason_code="missing_map")]
    lack = [{"ego_id": "1", "signal": "map", "reason_code": "no_map", "reason": ""}]
    way = {"ego_id": "1", "km": 6.0, "hours": 1.0, "engaged_km": 6.0, "engaged_hours": 1.0, "n_steps": 9}
    with duckdb.connect() as con:
        audits.add_rows(con, [drive(not_judged=lack, exposure=[way])], words, [], [rule(requires=["map", "speeds"])])
        found = missing_signals(con)
    assert [(each.reason_code, each.verdicts) for each in found.other_reasons] == [("ego_not_placed", 1)]
    assert [(each.signal, each.rules_alone, each.km_alone) for each in found.signals] == [("map", 1, 6.0)]
