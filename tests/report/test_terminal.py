"""The terminal summary says what a person must know, in wide and narrow windows."""

from __future__ import annotations

import io
import re

import msgspec
import pytest
from rich.console import Console, RenderableType

from drivelint.catalogue import load_rules
from drivelint.catalogue.header import Conditions
from drivelint.errors import ExitCode
from drivelint.report import rules_text, terminal
from drivelint.result.model import Result, exit_status
from tests.report.synthetic import drive, finding, result, rule, verdict

WARNING = {
    "check_id": "yaw_mismatch", "severity": "warning", "actor_id": "3", "n": 4, "t_first_ns": 0,
    "message": "4 headings differ from the motion",
}  # fmt: skip
INFO = WARNING | {"severity": "info", "check_id": "note", "message": "nothing to worry about"}


def screen_text(run: Result, width: int = 120, *, verbose: bool = True) -> str:
    console = Console(file=io.StringIO(), width=width, force_terminal=False)
    console.print(terminal.render(run, "out", width, verbose=verbose))
    text = console.file.getvalue()  # type: ignore[attr-defined]
    assert max(len(line) for line in text.splitlines()) <= width
    return str(text)


@pytest.mark.parametrize("width", [120, 72])
def test_everything_is_told(width: int) -> None:
    run = result(
        [
            verdict("fail"),
            verdict("pass", profile="relaxed", near_miss=True, observed=101.5, required=101.0, margin=0.5),
            verdict("unknown", rule_id="ukhc.signal", profile=None, reason="the log has no indicators"),
        ],
        [finding()],
        drives=[drive(quality=[WARNING, INFO]), drive("d2", status="not_judged", status_reason="d2.csv: no ego")],
        rules=[rule(), rule("ukhc.signal", status="draft", severity="minor")],
    )
    text = " ".join(screen_text(run, width).split())
    for part in ("8.00 s", "58.00 m", "64.00 m", "-6.00 m", "[nominal]", "Findings (1)", "Near misses", "101.50 m"):
        assert part in text
    assert "Could not be judged (2)" in text
    assert "the log has no indicators" in text
    assert "d2.csv: no ego" in text
    assert "4 headings differ" in text
    assert "nothing to worry about" not in text
    assert "(draft)" in text
    assert "exit 1: 1 finding at or above severity critical" in text


def summary(run: Result, width: int = 120) -> list[str]:
    return screen_text(run, width, verbose=False).splitlines()


def collision(drive_id: str, **over: object) -> dict[str, object]:
    more = {"profile": None, "observed": -0.1, "required": 0.0, "margin": -0.1, **over}
    return finding(drive_id=drive_id, rule_id="ukhc.no-collision", **more)


COLLISION = rule("ukhc.no-collision", tags=["contact"], title="No collision")


def test_the_summary_fits_one_screen_whatever_the_catalogue() -> None:
    names = [f"drive-{n}" for n in range(6)]
    rules = [rule(f"ukhc.r{n}", severity=["critical", "major", "minor"][n % 3]) for n in range(300)]
    failed = [(name, each) for name in names for each in rules[::10]]
    verdicts = [
        verdict("fail", drive_id=name, rule_id=each["rule_id"], severity=each["severity"]) for name, each in failed
    ]
    verdicts += [
        verdict(
            "unknown", drive_id=name, rule_id=rules[n]["rule_id"], reason_code=f"code_{n}", reason=f"unknown at {n} s"
        )
        for name in names
        for n in range(90)
    ]
    findings = [finding(drive_id=name, rule_id=each["rule_id"], severity=each["severity"]) for name, each in failed]
    assert len(findings) == 180
    lines = summary(result(verdicts, findings, drives=[drive(name) for name in names], rules=rules))
    assert len(lines) <= 40
    assert all(sum(name in line for line in lines) >= 1 for name in names)
    assert any(line.startswith("FAIL  60 critical, 60 major, 60 minor findings in 6 of 6 drives") for line in lines)
    assert "300 rules: 30 judged, 81 could never be judged, 189 never applied" in lines


def test_the_worst_drive_and_rule_stand_first() -> None:
    findings = [
        finding(),
        collision("d2"),
        finding(drive_id="d2", severity="minor"),
        finding(drive_id="d3", margin=-9.0),
    ]
    drives = [
        drive(),
        drive("d2"),
        drive("d3"),
        drive("d4"),
        drive("d5", status="not_judged", status_reason="d5: no ego"),
    ]
    verdicts = [verdict("fail", drive_id=name) for name in ("d1", "d2", "d3")] + [verdict("pass", drive_id="d4")]
    lines = summary(result(verdicts, findings, drives=drives, rules=[rule(), COLLISION]))
    first = [line.split()[0] for line in lines if re.match(r"d\d ", line)]
    assert first == ["d5", "d2", "d1", "d3", "d4"]
    assert [line for line in lines if line.startswith("FAIL")] == [
        "FAIL  3 critical, 1 minor findings in 3 of 5 drives; CONTACT in 1 drive"
    ]
    assert any("CONTACT -0.10 m, needs 0.00 m; object 3" in line for line in lines)
    assert any("58.00 m, needs 64.00 m [nominal]; Not kept: room to overtake; object 3" in line for line in lines)
    broken = [line.split() for line in lines if line.startswith(("critical", "major", "minor"))]
    assert broken == [
        ["critical", "ukhc.no-collision", "1", "1", "-0.10", "m"],
        ["critical", rule()["rule_id"], "3", "3", "-9.00", "m"],
    ]
    assert "explain  drivelint explain ukhc.no-collision@d2 --in out" in lines


def test_a_rule_says_how_many_of_its_findings_are_only_possible() -> None:
    kept = [finding(finding_id=f"{n:016}", n_copies=100, n_stays=stays) for n, stays in enumerate((100, 53, 40))]
    others = [finding(finding_id=f"{9:016}", rule_id="ukhc.signal", n_copies=32, n_stays=32)]
    lines = summary(result([verdict("fail")], [*kept, *others], rules=[rule(), rule("ukhc.signal")]))
    (head,) = [line.split() for line in lines if line.startswith("broken rule")]
    assert head[:5] == ["broken", "rule", "findings", "possible", "drives"]
    told = {line.split()[1]: line.split()[2:5] for line in lines if line.startswith("critical")}
    assert told == {"ukhc.r162.safe-distance-ahead": ["3", "2", "1"], "ukhc.signal": ["1", "·", "1"]}
    sure = summary(result([verdict("fail")], kept[:1], rules=[rule()]))
    assert not any("possible" in line for line in sure)


def test_what_must_be_less_is_not_said_to_need_as_much() -> None:
    less = rule("ukhc.contact-signature", sense="<", tags=["contact"], unit="m/s2")
    found = finding(rule_id="ukhc.contact-signature", observed=43.21, required=12.0, margin=-31.21, unit="m/s2")
    lines = summary(result([verdict("fail")], [found], rules=[rule(), less]))
    assert any("CONTACT 43.21 m/s2, at most 12.00 m/s2" in line for line in lines)


def test_a_limit_with_a_tolerance_says_so() -> None:
    param = {"name": "tolerance_mps", "value": "0.45", "unit": "m/s", "overridden": False}
    found = finding(rule_id="ukhc.limit", profile=None, observed=20.0, required=18.33, margin=-1.67, unit="m/s")
    for params, words in (
        ([param], "20.00 m/s, at most 18.33 m/s with tolerance;"),
        ([], "20.00 m/s, at most 18.33 m/s;"),
    ):
        limit = rule("ukhc.limit", sense="<=", unit="m/s", params=params)
        assert any(words in line for line in summary(result([verdict("fail")], [found], rules=[rule(), limit])))


def test_a_contact_is_told_by_how_fast_both_came_nearer() -> None:
    found = finding(rule_id="ukhc.no-collision", observed=-0.1, required=0.0, closing_mps=10.44)
    lines = summary(result([verdict("fail")], [found], rules=[rule(), COLLISION]))
    assert any("CONTACT object 3; closing at 10.44 m/s" in line for line in lines)


def test_warnings_of_the_data_are_named() -> None:
    quality = [
        {"check_id": name, "severity": "warning", "actor_id": None, "n": 1, "t_first_ns": None, "message": name}
        for name in ("teleport", "assumed_motion", "malformed_row", "no_position")
    ]
    lines = summary(result([verdict("pass")], drives=[drive(quality=quality)]))
    assert any("log: assumed_motion; 4 warnings (assumed motion, malformed row and 2 more)" in line for line in lines)


def test_unknown_verdicts_are_grouped_by_what_is_missing() -> None:
    rows = [verdict("unknown", rule_id=name, reason_code="missing_mode_headlights") for name in ("ukhc.a", "ukhc.b")]
    rows.append(verdict("unknown", rule_id="ukhc.c", reason_code="missing_indicator"))
    rows += [verdict("unknown", reason_code="log_hole", reason=f"a hole at {n} s") for n in range(90)]
    rules = [rule(name) for name in ("ukhc.a", "ukhc.b", "ukhc.c")] + [rule()]
    lines = summary(result([*rows, verdict("pass", rule_id="ukhc.a")], rules=rules))
    assert [line for line in lines if line.startswith("unknown")] == [
        f"unknown ({rule()['rule_id']}, 90 times): a hole at 0 s"
    ]
    told = " ".join(" ".join(lines).split())
    assert " not judged: 2 rules without headlights, 1 rule without indicator; 90 other verdicts" in told
    assert "4 rules: 1 judged, 3 could never be judged" in lines


def test_a_run_that_decided_nothing_is_no_pass() -> None:
    assert any(line.startswith("UNKNOWN  no findings") for line in summary(result([verdict("unknown")])))
    assert any(line.startswith("PASS  no findings") for line in summary(result([verdict("pass")])))
    assert any(re.match(r"d1 +nothing was judged ", line) for line in summary(result([verdict("unknown")])))
    assert any(re.match(r"d1 +no finding ", line) for line in summary(result([verdict("pass")])))


def test_findings_that_do_not_gate_are_no_pass() -> None:
    lines = summary(result([verdict("fail")], [finding()], fail_on="never"))
    assert any(line.startswith("FINDINGS  1 critical finding in 1 of 1 drive") for line in lines)
    assert any(line.startswith("exit 0: ") for line in lines)
    assert not any(line.startswith("PASS") for line in lines)


def test_a_map_that_does_not_fit_is_said_and_is_exit_code_4() -> None:
    ego = [{"ego_id": "1", "km": 0.1, "hours": 0.1, "engaged_km": 0.0, "engaged_hours": 0.0, "n_steps": 250}]
    lost = [
        {
            "ego_id": "1",
            "signal": "registration",
            "reason_code": "seldom_on_lane",
            "reason": "on a lane in only 27 of 181 steps",
        }
    ]
    off = drive("off", exposure=ego, not_judged=lost)
    run = result([verdict("unknown", drive_id="off"), verdict("pass")], drives=[drive(exposure=ego), off])
    assert exit_status(run).code == ExitCode.NOT_JUDGED
    lines = summary(run)
    assert any(
        line.startswith(
            "NOT JUDGED  no findings, but not everything could be judged; the map does not fit 1 of 2 drives: on"
        )
        for line in lines
    )
    assert any(re.match("off +no finding, but the map does not fit ", line) for line in lines)
    assert any(line.startswith("map: road.xodr fits 1 of 2 drives") for line in lines)
    assert any(line.startswith("exit 4: the map does not fit 1 of 2 drives (no baseline)") for line in lines)
    assert " ".join(" ".join(lines).split()).count("on a lane in only 27 of 181 steps") == 1, "a reason is said once"
    second = [*ego, ego[0] | {"ego_id": "2"}]
    assert exit_status(result([verdict("pass")], drives=[drive(exposure=second, not_judged=lost)])).code == ExitCode.OK
    other = drive(exposure=ego, not_judged=[lost[0] | {"reason_code": "ego_without_position"}])
    assert exit_status(result([verdict("pass")], drives=[other])).code == ExitCode.OK


def test_packs_are_counted_apart() -> None:
    rules = [rule(), rule("rss.along", pack="rss"), rule("rss.across", pack="rss")]
    rows = [verdict("pass"), verdict("fail", rule_id="rss.along"), verdict("pass", rule_id="rss.across")]
    lines = [
        line.split() for line in screen_text(result(rows, [finding(rule_id="rss.along")], rules=rules)).splitlines()
    ]
    assert ["all", "of", "ukhc", "1", "·", "·", "·", "·"] in lines
    assert ["all", "of", "rss", "1", "1", "·", "·", "·"] in lines
    assert not [line for line in lines if line[:1] == ["all"] and line[1:2] != ["of"]]
    alone = [line.split() for line in screen_text(result([verdict("pass")])).splitlines()]
    assert ["all", "1", "·", "·", "·", "·"] in alone


def test_the_conditions_that_were_given_are_told() -> None:
    wet = [{"condition": "weather", "value": "wet", "source": "env"}]
    assert "judged in: weather=wet" in screen_text(result([verdict("pass")], drives=[drive(conditions=wet)]))
    assert "judged in" not in screen_text(result([verdict("pass")]))


def test_nothing_to_report_is_short() -> None:
    text = screen_text(result([verdict("pass")]))
    for section in ("Findings", "Near misses", "Could not be judged", "Data quality"):
        assert section not in text
    assert "exit 0" in text


def test_long_sections_are_cut_and_say_so() -> None:
    many = [finding(occurrence=n) for n in range(25)]
    text = screen_text(result([verdict("fail")], many))
    assert "Findings (first 20 of 25)" in text
    assert text.count("observed 58.00 m") + text.count("  58.00 m") == 20


def test_of_many_rules_with_one_reason_the_first_ten_are_named() -> None:
    rules = [f"rss.r{n:02}" for n in range(8)] + [f"ukhc.r{n:02}" for n in range(8)]
    rows = [verdict("unknown", rule_id=rule_id, reason="no map", profile=None) for rule_id in rules]
    text = screen_text(result([*rows, verdict("unknown", rule_id="stvo.r00", reason="no class", profile=None)]))
    _, _, told = text.partition("Could not be judged")
    assert [rule_id in told for rule_id in rules] == [True] * 10 + [False] * 6
    assert "and 6 more of ukhc" in told
    assert "stvo.r00" in told


@pytest.mark.parametrize("width", [120, 60])
def test_a_logs_words_are_text_not_markup(width: int) -> None:
    text = screen_text(
        result([verdict("unknown", reason="[red]lost[/red]")], [finding(object_id="[bold]3[/bold]", reason="[x]")]),
        width,
    )
    assert "[red]lost[/red]" in text
    assert "[bold]3[/bold]" in text


def test_the_end_says_where_to_look_next() -> None:
    assert "open     out/report.html" in screen_text(result([verdict("pass")]))
    assert "drivelint inspect" not in screen_text(result([verdict("pass")]))
    assert "drivelint inspect TRACE" in screen_text(result([verdict("unknown")]))
    console = Console(file=io.StringIO(), width=120)
    console.print(terminal.render(result([verdict("pass")])))
    assert "--out DIR" in console.file.getvalue()  # type: ignore[attr-defined]


def test_eighty_columns_tear_no_id_and_no_number_apart() -> None:
    narrow = screen_text(result([verdict("fail")], [finding(rule_id="ukhc.r162.safe-distance-ahead")]), 80)
    assert "ukhc.r162.safe-distance-ahead [nominal]" in narrow
    assert "observed 58.00 m, required 64.00 m, margin -6.00 m" in narrow
    rules = list(load_rules().values())
    console = Console(file=io.StringIO(), width=80)
    console.print(rules_text.rules_table(rules, 80))
    listed = console.file.getvalue()  # type: ignore[attr-defined]
    assert all(rule.id in listed for rule in rules)
    assert all(word in listed.split() for rule in rules for word in rule.title.split())


def test_the_page_of_a_rule_has_every_key_that_its_header_sets() -> None:
    """The keys that most rules do not set stand there only where they are set."""
    rules = load_rules()
    shown = {
        rule.id: {row.split("  ")[0] for row in text_of_part(rules_text.rule_details(rule)).splitlines()}
        for rule in rules.values()
    }
    for words, is_set in (
        ("law", lambda rule: rule.law),
        ("window", lambda rule: rule.window_s is not None),
        ("quantifier", lambda rule: rule.subtype),
        ("combine", lambda rule: rule.combine != "each"),
        ("applies", lambda rule: rule.applies.restricted_conditions or rule.applies.has_speed_limit_condition),
        ("exempt after", lambda rule: rule.exempt_after_s),
        ("merge gap", lambda rule: rule.merge_gap_s != 1),
        ("observes", lambda rule: rule.observes),
        ("near margin", lambda rule: rule.near_margin is not None),
        ("tags", lambda rule: rule.tags),
        ("pass requires", lambda rule: rule.pass_requires),
        ("without time", lambda rule: rule.without_time),
        ("without anchor", lambda rule: rule.without_anchor),
    ):
        there = {rule.id for rule in rules.values() if is_set(rule)}
        assert {rule_id for rule_id, keys in shown.items() if words in keys} == there, words


def test_the_page_of_a_rule_names_the_parameter_that_holds_a_time() -> None:
    rule = load_rules()["ukhc.r103.signal-off"]
    assert re.search(r"^window +5 s \(off_s\) *$", text_of_part(rules_text.rule_details(rule)), re.MULTILINE)
    limited = msgspec.structs.replace(rule, applies=Conditions(road_type=("rural", "town"), limit_max_mps=13.4))
    assert "road_type rural or town, limit_max_mps 13.4" in text_of_part(rules_text.rule_details(limited))


def text_of_part(part: RenderableType) -> str:
    console = Console(file=io.StringIO(), width=200)
    console.print(part)
    return console.file.getvalue()  # type: ignore[attr-defined, no-any-return]


def test_the_worst_of_a_drive_of_several_egos_names_its_ego() -> None:
    rows = [verdict("fail", ego_id="394"), verdict("pass", ego_id="2")]
    found = [finding(ego_id="394")]
    assert any(re.search(r"^d1 .* s ego 394 ", line) for line in summary(result(rows, found, drives=[drive(n_egos=2)])))
    assert not any("ego 394" in line for line in summary(result(rows[:1], found, drives=[drive()])))


def test_parameters_that_were_set_are_named() -> None:
    given = [
        {"name": "gap_m", "value": "3.0", "unit": "m", "overridden": True},
        {"name": "time_s", "value": "2.0", "unit": "s", "overridden": False},
    ]
    text = screen_text(result([verdict("pass")], rules=[rule(params=given)]), verbose=False)
    assert f"set for this run: {rule()['rule_id']}.gap_m = 3.0 m\n" in re.sub(r" +\n", "\n", text)
    assert "time_s" not in text
    assert "set for this run" not in screen_text(result([verdict("pass")]), verbose=False)


def test_without_findings_the_command_explains_an_unknown_verdict() -> None:
    unknown = verdict("unknown", reason_code="null_value", reason="the speed is not known")
    text = screen_text(result([verdict("pass", occurrence=1), unknown]), verbose=False)
    assert f"explain  drivelint explain {unknown['rule_id']}@{unknown['drive_id']} --in out" in text
    assert "drivelint explain" not in screen_text(result([verdict("pass")]), verbose=False)


def test_findings_of_draft_rules_are_counted_beside_the_exit_code() -> None:
    drafts = [rule("ukhc.a", status="draft"), rule("ukhc.b", status="draft"), rule()]
    failed = [verdict("fail", rule_id=name) for name in ("ukhc.a", "ukhc.b")]
    found = [finding(rule_id=name, finding_id=name) for name in ("ukhc.a", "ukhc.b")]
    run = result([*failed, verdict("pass")], found, rules=drafts)
    assert exit_status(run) == (
        ExitCode.OK, "nothing failed at or above severity critical; 2 findings of rules that are not stable do not count"
    )  # fmt: skip


@pytest.mark.parametrize("width", [80, 100, 120])
def test_what_happened_and_what_to_do_is_whole(width: int) -> None:
    contact = finding(
        drive_id="d2", rule_id="ukhc.no-collision", observed=-0.1, required=0.0, closing_mps=22.35, object_id="0a-1b"
    )
    long = rule(breach="Too little clear road ahead to overtake another vehicle before the oncoming one is there")
    reason = "The log does not show the ego back in its lane after it overtook the vehicle: record it until it is."
    rows = [verdict("fail"), verdict("fail", drive_id="d2"), verdict("unknown", reason_code="log_end", reason=reason)]
    lost = drive("d3", status="not_judged", status_reason="d3.csv: no column 'length', which mapping 'table' needs")
    run = result(rows, [finding(), contact], drives=[drive(), drive("d2"), lost], rules=[long, COLLISION])
    lines = summary(run, width)
    text = "\n".join(lines)
    assert "…" not in text
    told = " ".join(text.split())
    assert "CONTACT object 0a-1b; closing at 22.35 m/s" in told
    assert f"unknown ({long['rule_id']}): {reason}" in told
    for sentence in (long["breach"], lost["status_reason"]):
        assert set(sentence.split()) <= set(told.replace(";", "").split())


def test_a_command_that_a_narrow_terminal_breaks_can_be_copied() -> None:
    name = "d" * 60
    lines = summary(result([verdict("fail", drive_id=name)], [finding(drive_id=name)], drives=[drive(name)]), 120)
    (at,) = [n for n, line in enumerate(lines) if line.startswith("explain  ")]
    assert lines[at].endswith(f"ukhc.r162.safe-distance-ahead@{name} \\")
    assert lines[at + 1].strip() == "--in out"


def test_one_cause_of_several_rules_is_one_line() -> None:
    cause = "the log does not show the ego back in its lane: record it until it is"
    rows = [
        verdict("unknown", rule_id="ukhc.a", reason_code="no_time", reason=f"{cause[0].upper()}{cause[1:]}."),
        verdict("unknown", rule_id="ukhc.b", reason_code="no_anchor", reason=cause),
        verdict("unknown", rule_id="ukhc.c", reason_code="null_value", reason=f"the gap is not known: {cause}"),
        verdict("unknown", rule_id="ukhc.d", reason_code="log_hole", reason="a hole at 3 s"),
        verdict("error", rule_id="ukhc.e", reason_code="no_time", reason=cause),
    ]
    lines = summary(result([*rows, verdict("pass")], rules=[rule(f"ukhc.{name}") for name in "abcde"] + [rule()]))
    told = [line for line in lines if line.startswith(("unknown", "error"))]
    assert len(told) == 3
    assert told[0] == f"unknown (3 rules, 3 times): {cause}"
