"""Waivers: who answers for a finding, until when; what is not said is refused, what does not work is told."""

from __future__ import annotations

import io
from datetime import date
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console

from drivelint.errors import ExitCode, UsageError
from drivelint.gate import Gate, GateInputs, Waiver, descriptions, waivers
from drivelint.report import junit, terminal
from drivelint.result import gate as store
from drivelint.result.model import Result, exit_status
from drivelint.result.names import GATE_FILE
from tests.report.synthetic import SECOND, drive, finding, result, rule, verdict

TODAY = date(2026, 11, 20)
WHOLE = 'rule = "ukhc.*"\nreason = "ticket 17"\nowner = "jo"\nexpires = 2027-03-31\n'


def waiver_file(tmp_path: Path, *tables: str, name: str = "w.toml") -> Path:
    file = tmp_path / name
    file.write_text("".join(f"[[waiver]]\n{table}\n" for table in tables), encoding="utf-8")
    return file


def waiver(**over: Any) -> Waiver:
    return Waiver(**({"where": "w:1", "rule": "*", "reason": "why", "owner": "jo", "expires": "2027-03-31"} | over))


def test_a_waiver_is_read_with_its_place(tmp_path: Path) -> None:
    more = 'drive = "d*"\nego = "1"\nobject = "3"\nprofile = "nominal"\nfrom_s = 7\nto_s = 9.5\n'
    file = waiver_file(tmp_path, WHOLE, WHOLE.replace("2027-03-31", '"2027-04-01"') + more)
    first, second = waivers.read(file)
    assert first == Waiver(f"{file}:1", "ukhc.*", "ticket 17", "jo", "2027-03-31")
    assert (second.where, second.expires) == (f"{file}:7", "2027-04-01")
    assert (second.drive, second.ego, second.object, second.profile) == ("d*", "1", "3", "nominal")
    assert (second.from_s, second.to_s) == (7, 9.5)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[[waiver]]\nrule = \n", r"w\.toml: not TOML: .*line 2"),
        ("", r"w\.toml: no table \[\[waiver\]\]"),
        ("x = 1\n", r"w\.toml: unknown key 'x'"),
        ("waiver = 1\n", r"w\.toml: waiver must be tables"),
        (f"# why\n[[waiver]]\n{WHOLE}ruel = 1\n", r"w\.toml:7: waiver: unknown key 'ruel'; did you mean 'rule'"),
        (f"[[waiver]]\n{WHOLE}zzz = 1\n", r"w\.toml:6: waiver: unknown key 'zzz'; known are rule, reason"),
        ('[[waiver]]\nrule = "x"\n', r"w\.toml:1: waiver: reason and owner and expires missing"),
        (f"[[waiver]]\n{WHOLE}\n[[waiver]]\n{WHOLE.replace('owner', '# owner')}", r"w\.toml:7: waiver: owner missing"),
        ("[[waiver]]\n" + WHOLE.replace('"ticket 17"', '" "'), r"w\.toml:3: waiver: reason = ' ': must be a text"),
        ("[[waiver]]\n" + WHOLE.replace('"ukhc.*"', "1"), r"w\.toml:2: waiver: rule = 1: must be a text"),
        ("[[waiver]]\n" + WHOLE.replace("2027-03-31", '"soon"'), r"w\.toml:5: waiver: expires = 'soon': must be a day"),
        ("[[waiver]]\n" + WHOLE.replace("2027-03-31", "2027-03-31T12:00:00"), r"w\.toml:5: .*must be a day"),
        ("[[waiver]]\n" + WHOLE.replace("2027-03-31", '"2027-02-30"'), r"w\.toml:5: .*must be a day"),
        (f"[[waiver]]\n{WHOLE}from_s = true\n", r"w\.toml:6: waiver: from_s = True: must be seconds"),
        (f"[[waiver]]\n{WHOLE}from_s = nan\n", r"w\.toml:6: waiver: from_s = nan: must be seconds"),
        (f"[[waiver]]\n{WHOLE}from_s = 2\nto_s = 1\n", r"w\.toml:7: waiver: to_s is before from_s"),
        # Python 3.11 takes minutes to translate such a glob
        (
            f"[[waiver]]\n{WHOLE}drive = '*{'[' * 60_000}*'\n",
            r"w\.toml:6: waiver: drive: 60002 characters: use at most 1000",
        ),
        (
            f"[[waiver]]\n{WHOLE.replace('rule = ', 'rule = ' + repr('[' * 9999) + ' #')}",
            r"w\.toml:2: waiver: rule: 9999 characters",
        ),
        ('waiver = [{rule = "x"}]\n', r"w\.toml:1: waiver: reason and owner and expires missing"),
    ],
)
def test_what_is_missing_or_misspelt_is_refused_with_file_and_line(tmp_path: Path, text: str, says: str) -> None:
    file = tmp_path / "w.toml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(UsageError, match=says):
        waivers.read(file)


def test_no_such_file(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"nowhere\.toml: no such file"):
        waivers.read(tmp_path / "nowhere.toml")


def test_beside_settings_other_keys_are_not_its_business(tmp_path: Path) -> None:
    file = tmp_path / "drivelint.toml"
    file.write_text(f'map = "road.xodr"\n[[waiver]]\n{WHOLE}[env]\nnation = "gb"\n', encoding="utf-8")
    (found,) = waivers.read(file, only_waivers=False)
    assert found.where.endswith("drivelint.toml:2")
    file.write_text('map = "road.xodr"\n', encoding="utf-8")
    assert waivers.read(file, only_waivers=False) == []


ROW = finding()  # drive d1 (d1.csv), ego 1, object 3, profile nominal, at 8 s


def waived(*given_waivers: Waiver, row: dict[str, Any] = ROW, today: date = TODAY) -> tuple[list[str], bool]:
    stated, found = waivers.states_and_matches(given_waivers, result([verdict("fail")], [row]), today)
    return [each.state for each in stated], row["finding_id"] in found


@pytest.mark.parametrize(
    ("over", "is_meant"),
    [
        ({"rule": "ukhc.r162.safe-distance-ahead"}, True),
        ({"rule": "ukhc.r162.*"}, True),
        ({"rule": "ukhc.r162"}, False),
        ({"rule": "UKHC.*"}, False),
        ({"drive": "d1"}, True),
        ({"drive": "*.csv"}, True),
        ({"drive": "d2"}, False),
        ({"ego": "1"}, True),
        ({"ego": "2"}, False),
        ({"object": "3"}, True),
        ({"object": "4"}, False),
        ({"profile": "nominal"}, True),
        ({"profile": "relaxed"}, False),
        ({"from_s": 8.0, "to_s": 8.0}, True),
        ({"from_s": 8.1}, False),
        ({"to_s": 7.9}, False),
        ({"drive": "d1", "object": "4"}, False),
    ],
)
def test_a_waiver_means_what_all_its_words_mean(over: dict[str, Any], is_meant: bool) -> None:
    assert waived(waiver(**over)) == (["active"] if is_meant else ["unmatched"], is_meant)


def test_a_stretch_that_grew_beyond_its_waiver_is_not_waived() -> None:
    """Who answered for 7 to 9 s did not answer for what followed."""
    meant = waiver(from_s=7, to_s=9)
    assert waived(meant, row=finding(t_end_ns=109 * SECOND))[1]
    assert not waived(meant, row=finding(t_end_ns=110 * SECOND))[1]


@pytest.mark.parametrize(
    ("today", "state"),
    [(date(2027, 3, 30), "active"), (date(2027, 3, 31), "active"), (date(2027, 4, 1), "expired")],
)
def test_a_waiver_counts_through_its_last_day(today: date, state: str) -> None:
    assert waived(waiver(), today=today) == ([state], state == "active")


def test_of_two_waivers_the_first_that_counts_waives_and_none_is_unmatched() -> None:
    given = (waiver(expires="2026-01-01"), waiver(owner="al"), waiver(owner="bo"))
    stated, found = waivers.states_and_matches(given, result([verdict("fail")], [ROW]), TODAY)
    assert [(each.state, each.findings) for each in stated] == [("expired", 1), ("active", 1), ("active", 1)]
    assert found == {ROW["finding_id"]: 1}


def gated(*given_waivers: Waiver, rows: list[dict[str, Any]], **more: Any) -> Result:
    return GateInputs(TODAY, waivers=given_waivers).apply_to(result([verdict("fail")], rows, **more))


def test_a_waived_finding_is_shown_and_does_not_gate() -> None:
    run = gated(waiver(), rows=[ROW])
    assert exit_status(run) == (ExitCode.OK, "nothing failed at or above severity critical (of that severity 1 waived)")
    assert run.findings.num_rows == 1
    one_more = gated(waiver(object="3"), rows=[ROW, finding(object_id="4", finding_id="x")])
    assert exit_status(one_more) == (
        ExitCode.FAILED,
        "1 finding at or above severity critical (of that severity 1 waived)",
    )


def test_an_expired_waiver_waives_nothing_and_is_told() -> None:
    run = gated(waiver(expires="2026-11-19"), waiver(rule="none.*"), rows=[ROW])
    assert exit_status(run).code is ExitCode.FAILED
    assert run.gate is not None
    assert list(descriptions.waiver_warnings(run.gate)) == [
        "w:1: expired 2026-11-19 (jo): it has no effect; 1 finding matches it",
        "w:1: no finding matches none.* (jo); correct or remove it",
    ]


@pytest.mark.parametrize(
    ("rule_id", "message"),
    [
        ("ukhc.r162.safe-distance-ahed", "no rule has this id; did you mean 'ukhc.r162.safe-distance-ahead'?"),
        ("ukhc.no-colision", "no rule has this id; did you mean 'ukhc.no-collision'?"),
        ("x", "no rule has this id; drivelint rules list shows them all"),
    ],
)
@pytest.mark.parametrize("expires", ["2026-11-19", "2027-11-19"])
def test_a_waiver_for_a_rule_that_does_not_exist_says_so(rule_id: str, message: str, expires: str) -> None:
    run = gated(waiver(rule=rule_id, expires=expires), rows=[ROW])
    assert run.gate is not None
    (line,) = descriptions.waiver_warnings(run.gate)
    assert message in line
    assert "no finding" not in line


def test_a_waiver_for_a_rule_that_was_not_run_is_only_unmatched() -> None:
    run = gated(waiver(rule="ukhc.no-collision"), rows=[ROW])
    assert run.gate is not None
    assert list(descriptions.waiver_warnings(run.gate)) == [
        "w:1: no finding matches ukhc.no-collision (jo); correct or remove it"
    ]


def test_a_failed_verdict_without_a_finding_is_never_let_through() -> None:
    rows = [verdict("fail"), verdict("fail", profile="relaxed")]
    run = GateInputs(TODAY, waivers=(waiver(),)).apply_to(result(rows, [ROW]))
    assert exit_status(run).code is ExitCode.FAILED
    assert "1 failed verdict without a finding" in exit_status(run).why


def test_drafts_and_lesser_findings_do_not_gate_with_a_gate_either() -> None:
    rows = [finding(rule_id="ukhc.draft", finding_id="d"), finding(severity="minor", finding_id="m")]
    told = [verdict("fail", rule_id="ukhc.draft"), verdict("fail", severity="minor")]
    run = result(told, rows, rules=[rule(), rule("ukhc.draft", status="draft")])
    run = GateInputs(TODAY, waivers=(waiver(),)).apply_to(run)
    why = (
        "nothing failed at or above severity critical (of that severity 0 waived); "
        "1 finding of a rule that is not stable does not count"
    )
    assert exit_status(run) == (ExitCode.OK, why)


def test_a_run_that_is_not_judged_is_not_saved_by_a_waiver() -> None:
    lost = [drive(), drive("d2", status="not_judged", status_reason="no ego")]
    assert exit_status(gated(waiver(), rows=[ROW], drives=lost)).code is ExitCode.NOT_JUDGED


def test_junit_skips_what_is_waived_and_says_why() -> None:
    text = junit.render(gated(waiver(), rows=[ROW])).decode()
    assert 'failures="0"' in text
    assert "does not gate (waived until 2027-03-31 by jo: why): 8.00 s: ego 1, object 3" in text
    other = finding(object_id="4", finding_id="x", reason="stays")
    mixed = junit.render(gated(waiver(object="3"), rows=[ROW, other])).decode()
    assert 'message="8.00 s: ego 1, object 4; observed' in mixed
    assert "waived until" in mixed


def test_junit_still_shows_the_unknown_beside_what_is_waived() -> None:
    run = GateInputs(TODAY, waivers=(waiver(),)).apply_to(
        result([verdict("fail"), verdict("unknown")], [ROW], strict=True)
    )
    text = junit.render(run).decode()
    assert '<error type="unknown"' in text
    assert "waived until" in text


def test_the_terminal_shows_what_is_let_through_and_what_to_look_at() -> None:
    console = Console(width=120, record=True, file=io.StringIO())
    console.print(terminal.render(gated(waiver(), waiver(rule="none.*"), rows=[ROW]), verbose=True))
    text = console.export_text()
    assert "Known or waived findings: they do not gate (1)" in text
    assert "FINDINGS  1 finding in 1 of 1 drive: 1 waived" in text
    assert "no finding matches none.*" in text
    assert "exit 0: nothing failed at or above severity critical (of that severity 1 waived)" in text


def test_the_file_of_a_gate_is_read_back(tmp_path: Path) -> None:
    gate = gated(waiver(from_s=1.5), rows=[ROW]).gate
    assert gate is not None
    (tmp_path / GATE_FILE).write_bytes(store.render(gate))
    assert store.load(tmp_path) == gate
    assert store.load(tmp_path / "elsewhere") is None


@pytest.mark.parametrize("content", [b"{", b'{"gate_schema": 99, "gate": {}}', b'{"gate": 1}', b"\xff"])
def test_a_file_that_is_no_gate_is_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / GATE_FILE).write_bytes(content)
    with pytest.raises(UsageError, match=r"gate\.json: .*check the drives again"):
        store.load(tmp_path)


def test_nothing_given_is_no_gate(tmp_path: Path) -> None:
    assert GateInputs.from_files(None, None, tmp_path / "drivelint.toml", TODAY, None) is None
    assert Gate().is_gating("x")
