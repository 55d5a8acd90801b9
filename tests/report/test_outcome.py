"""The first screen's words: one count of findings, a contact that is known is a contact, and a run that decided little is no pass."""

from __future__ import annotations

import html
import io
import re
from dataclasses import replace
from datetime import date
from typing import Any

import pytest
from lxml import etree
from rich.console import Console

from drivelint.drive.trace import OWN_MAP_UNUSABLE_CHECK
from drivelint.errors import ExitCode
from drivelint.gate import GateInputs, Waiver
from drivelint.report import junit, markdown, terminal
from drivelint.report.outcome import headline
from drivelint.report.terminal_summary import outcome_line
from drivelint.result.model import Result, exit_status
from tests.report.pages import page
from tests.report.synthetic import SDA, drive, finding, result, rule, verdict

TODAY = date(2026, 11, 26)
KNOWN_TEXT = "FINDINGS no new finding; 2 known (1 critical, 1 minor)"
CONTACT = rule("ukhc.no-collision", tags=["contact"], title="No collision", unit="m")
LATER = rule("ukhc.spare", title="Time to spare", severity="minor", sense="holds")


def crash(**over: Any) -> dict[str, Any]:
    return finding(rule_id="ukhc.no-collision", profile=None, observed=-0.1, required=0.0, margin=-0.1, **over)


def run(findings: list[dict[str, Any]], *more: dict[str, Any], **over: Any) -> Result:
    """Return a result of three drives in which these findings are all that failed."""
    rows = [verdict("fail", drive_id=f["drive_id"], rule_id=f["rule_id"], profile=f["profile"]) for f in findings]
    over = {"drives": [drive(), drive("d2"), drive("d3")], "rules": [rule(), CONTACT, LATER], **over}
    return result([*rows, verdict("pass", drive_id="d3"), *more], findings, **over)


def against(base: Result, new: Result, *waivers: Waiver, confidence: float | None = None) -> Result:
    return GateInputs(TODAY, base, "main", waivers, confidence).apply_to(new)


def screen(of: Result) -> list[str]:
    console = Console(file=io.StringIO(), width=120, force_terminal=False)
    console.print(terminal.render(of, "out", 120))
    return console.file.getvalue().splitlines()  # type: ignore[attr-defined, no-any-return]


def heads(of: Result) -> list[str]:
    """Return the headline as the terminal, the page and the Markdown have it, in one form."""
    (h1,) = re.findall(r"<h1>(.*?)</h1>", page(of), re.DOTALL)
    title, sentence = markdown.render(of).decode().split("\n\n")[:2]
    label = title.removeprefix("## drivelint: ").partition(", exit")[0]
    said = [
        outcome_line(of),
        re.sub(r"<[^>]+>", " ", html.unescape(h1)),
        f"{label} {sentence.replace('*', '').removesuffix('.')}",
    ]
    return [" ".join(each.split()).lower() for each in said]


MIXED = [finding(), crash(drive_id="d2"), finding(drive_id="d2", rule_id="ukhc.spare", severity="minor")]
NO_FINDING = run([])
WAIVER = Waiver("w.toml:1", SDA, "ticket 17", "jo", "2027-01-31")


@pytest.mark.parametrize(
    ("of", "words"),
    [
        (run(MIXED), "FAIL 2 critical, 1 minor findings in 2 of 3 drives; CONTACT in 1 drive"),
        (
            against(NO_FINDING, run(MIXED)),
            "FAIL 3 findings in 2 of 3 drives: 3 new (2 critical, 1 minor; 2 gate); CONTACT in 1 drive",
        ),
        (
            against(run(MIXED[:1]), run(MIXED)),
            "FAIL 3 findings in 2 of 3 drives: 2 new (1 critical, 1 minor; 1 gates), 1 known (1 critical); CONTACT in 1 drive",
        ),
        (
            against(run(MIXED[1:]), run(MIXED), WAIVER),
            f"{KNOWN_TEXT}, 1 waived (1 critical) in 2 of 3 drives; CONTACT in 1 drive (known)",
        ),
        (
            against(run([crash(drive_id="d2")]), run([crash(drive_id="d2"), crash()])),
            "FAIL 2 findings in 2 of 3 drives: 1 new (1 critical), 1 known (1 critical); CONTACT in 2 drives (1 new)",
        ),
        (
            against(run(MIXED[1:]), run([finding(n_copies=100, n_stays=53), *MIXED[1:]]), confidence=0.95),
            f"{KNOWN_TEXT}, 1 only possible (1 critical) in 2 of 3 drives; CONTACT in 1 drive (known)",
        ),
        (
            GateInputs(TODAY, confidence=0.95).apply_to(run([finding(n_copies=100, n_stays=53), *MIXED[1:]])),
            "FAIL 3 findings in 2 of 3 drives: 2 counted (1 critical, 1 minor; 1 gates), 1 only possible (1 critical); CONTACT in 1 drive",
        ),
        (
            run([finding(n_copies=100, n_stays=53), *MIXED[1:]]),
            "FAIL 2 critical, 1 minor findings in 2 of 3 drives; CONTACT in 1 drive; 1 of 3 findings only possible",
        ),
        (
            run([finding(n_copies=100, n_stays=53)]),
            "FAIL 1 critical finding in 1 of 3 drives; only possible",
        ),
        (run([]), "PASS no findings"),
    ],
)  # fmt: skip
def test_terminal_page_and_markdown_say_one_count_in_the_same_words(of: Result, words: str) -> None:
    assert heads(of) == [words.lower()] * 3


def test_each_finding_is_counted_once() -> None:
    of = against(run(MIXED[1:2]), run([*MIXED, finding(drive_id="d3", n_copies=9, n_stays=1)]), WAIVER, confidence=0.95)
    _, _, told = headline(of).parts[0].words.partition(": ")
    numbers = [int(n) for n in re.findall(r"(\d+) (?:new|known|waived|only possible)", told)]
    assert sum(numbers) == of.findings.num_rows == 4


def test_a_drive_whose_findings_are_all_known_is_not_said_to_have_none() -> None:
    lines = screen(against(run(MIXED), run(MIXED)))
    assert any(re.match(r"d2 +known: +8.00 s CONTACT", line) for line in lines)
    assert any(re.match(r"d1 +known: +8.00 s 58.00 m", line) for line in lines)
    assert [line for line in lines if "no finding " in line and not line.startswith("d3")] == []
    assert "explain  drivelint explain ukhc.no-collision@d2 --in out" in lines


def test_a_waived_contact_is_told_with_the_waiver() -> None:
    waiver = replace(WAIVER, rule="*")
    lines = screen(GateInputs(TODAY, waivers=(waiver,)).apply_to(run([crash()])))
    assert "FINDINGS  1 finding in 1 of 3 drives: 1 waived (1 critical); CONTACT in 1 drive (waived)" in lines
    assert any(re.match(r"d1 +waived: +8.00 s CONTACT", line) for line in lines)


def test_a_run_that_could_decide_little_is_no_pass() -> None:
    rules = [rule(), *(rule(f"ukhc.m{n}") for n in range(3))]
    missing = [verdict("unknown", rule_id=f"ukhc.m{n}", reason_code="missing_map") for n in range(3)]
    of = result([verdict("pass"), *missing], drives=[drive(map_name=None)], rules=rules)
    assert exit_status(of).code == ExitCode.OK
    words = (
        "mostly unknown no findings, but 3 of the 4 rules that may apply could not be judged; no "
        "map was given: 3 rules need one (--map)"
    )
    assert heads(of) == [words] * 3
    assert screen(of)[2].startswith("MOSTLY UNKNOWN")
    even = result([verdict("pass"), missing[0]], drives=[drive(map_name=None)], rules=rules)
    assert headline(even).label == "PASS"
    assert "1 rule needs one (--map)" in headline(even).sentence
    unusable = [{"check_id": OWN_MAP_UNUSABLE_CHECK, "severity": "warning", "message": "broken", "n": 1}]
    own = result([verdict("pass"), *missing], drives=[drive(map_name=None, quality=unusable)], rules=rules)
    assert "the log's own map cannot be used: 3 rules need one (--map)" in headline(own).sentence
    on_map = result([verdict("pass"), missing[0]], rules=rules)
    assert "--map" not in headline(on_map).sentence


def test_of_many_drives_most_must_be_decided() -> None:
    drives = [drive(f"d{n}") for n in range(4)]
    rows = [verdict("pass", drive_id="d0"), *(verdict("unknown", drive_id=f"d{n}") for n in range(1, 4))]
    told = headline(result(rows, drives=drives))
    words = "no findings, but 3 of the 4 rules that may apply could not be judged, counted for each drive and ego"
    assert (told.label, told.sentence) == ("MOSTLY UNKNOWN", words)
    assert headline(result(rows[:2], drives=drives)).label == "PASS"
    few = replace(result(rows[:2], drives=drives), min_judged=0.9)
    assert exit_status(few).code == ExitCode.NOT_JUDGED
    assert headline(few).label == "TOO LITTLE JUDGED", "as many rules were decided as not"
    assert "1 of the 2 rules that may apply could not be judged" in headline(few).sentence
    most = replace(result(rows, drives=drives), min_judged=0.9)
    assert headline(most).label == "TOO LITTLE JUDGED"


def test_too_little_judged_is_said_although_there_are_findings() -> None:
    rows = [verdict("fail", severity="minor"), verdict("unknown", rule_id="ukhc.other")]
    of = result(rows, [finding(severity="minor")], rules=[rule(severity="minor"), rule("ukhc.other")], min_judged=0.9)
    assert exit_status(of).code == ExitCode.NOT_JUDGED
    words = "too little judged 1 minor finding in 1 of 1 drive; 1 of the 2 rules that may apply could not be judged"
    assert [said.startswith(words) for said in heads(of)] == [True] * 3
    assert "50 % of the rules that may apply were decided, fewer than 90 % (--min-judged)" in outcome_line(of)


def test_the_terminal_names_the_known_findings_that_are_worse() -> None:
    of = against(
        run([finding(), finding(profile="observed")]),
        run([finding(margin=-7.0), finding(profile="observed", margin=-9.0)]),
    )
    lines = [line for line in screen(of) if line.startswith("worse ")]
    (line,) = lines
    name = "ukhc.r162.safe-distance-ahead [nominal]"
    assert line == f"worse    critical: d1 at 8.00 s: {name}, ego 1, object 3: margin -7.00 m, was -6.00 m"
    assert not [line for line in screen(against(run([finding()]), run([finding()]))) if line.startswith("worse ")]


def test_parameters_that_are_set_are_told_and_so_is_an_older_baseline() -> None:
    def of_margin(value: str, *, is_set: bool) -> Result:
        given = [{"name": "margin_s", "value": value, "unit": "s", "overridden": is_set}]
        return result([verdict("pass")], rules=[rule(params=given)])

    loose = of_margin("0.1", is_set=True)
    told = f"parameters: set for this run: {SDA}.margin_s = 0.1 s"
    assert told in screen(loose)
    assert told in markdown.render(loose).decode().replace("\\", "")
    assert "parameters" not in "".join(screen(of_margin("0.5", is_set=False)))
    words = f"judged by other parameters or another version of a rule than in the baseline: {SDA}"
    assert words in headline(against(of_margin("0.5", is_set=False), loose)).sentence
    assert words not in headline(against(loose, loose)).sentence


def test_a_rule_whose_signal_the_log_lacks_is_among_those_that_may_apply() -> None:
    """The headline and `--min-judged` count the same rules."""
    lacking = verdict("not_applicable", rule_id="ukhc.other", reason_code="unrecorded_indicator")
    of = result(
        [verdict("fail"), lacking], [finding()], rules=[rule(), rule("ukhc.other")], min_judged=0.9, fail_on="never"
    )
    assert headline(of).sentence.endswith("; 1 of the 2 rules that may apply could not be judged")
    assert "50 % of the rules that may apply were decided" in exit_status(of).why


@pytest.mark.parametrize(
    ("now", "why"),
    [
        ([verdict("unknown", t_start_ns=None), verdict("pass", rule_id="ukhc.spare", profile=None)], "1 unknown now"),
        ([verdict("pass", rule_id="ukhc.spare", profile=None)], "1 not judged now"),
    ],
)
def test_what_is_gone_but_not_fixed_is_no_pass(now: list[dict[str, Any]], why: str) -> None:
    of = against(result([verdict("fail")], [finding()]), result(now, rules=[rule(), LATER]))
    sentence = f"1 finding of the baseline at or above severity critical is gone but not fixed: {why}"
    assert exit_status(of) == (ExitCode.NOT_JUDGED, sentence)
    assert sentence in outcome_line(of)
    assert sentence in markdown.render(of).decode()
    suites = etree.fromstring(junit.render(of))
    (case,) = suites.findall("testsuite[@name='baseline']/testcase")
    assert (suites.get("errors"), case.get("name")) == ("1", f"{SDA} [nominal] of d1")
    assert str(case.xpath("string(error/@message)")).startswith("gone, but not fixed: critical: d1 at 8.00 s")


def test_what_is_judged_less_and_what_is_worse_stands_in_the_head_of_every_report() -> None:
    base = run([crash(drive_id="d2")], verdict("pass"))
    now = [crash(drive_id="d2") | {"margin": -0.5}]
    head = (
        "findings no new finding; 1 known (1 critical) in 1 of 2 drives; 1 known finding is worse; contact in 1 drive (known); "
        "judged less than the baseline: 1 verdict unknown that was pass or fail before (1 critical), "
        "1 drive of the baseline not checked, 1 rule of the baseline not selected"
    )
    less = run(now, verdict("unknown"), drives=[drive(), drive("d2")], rules=[rule(), CONTACT])
    assert heads(against(base, less)) == [head] * 3
    dropped = against(run([], verdict("pass")), run([], drives=[drive("d3")]))
    assert headline(dropped).sentence.startswith(
        "no findings, but not everything could be judged; judged less than the baseline: 2 drives"
    )
    assert headline(dropped).kind == "unknown"


def test_what_is_gone_gates_only_where_it_would_have() -> None:
    unknown = [verdict("unknown", t_start_ns=None), verdict("pass", occurrence=1, t_start_ns=None)]
    for before, least in ((finding(severity="minor"), "critical"), (finding(), "never")):
        of = against(result([verdict("fail")], [before]), result(unknown, fail_on=least))
        assert exit_status(of).code == ExitCode.OK
    fixed = against(result([verdict("fail")], [finding()]), result([verdict("pass")]))
    assert exit_status(fixed).code == ExitCode.OK
    worse = against(result([verdict("fail")], [finding()]), run([crash()], *unknown))
    assert exit_status(worse).code == ExitCode.FAILED


def test_what_is_missing_for_some_egos_only_says_for_how_many() -> None:
    rows = [verdict("unknown", ego_id=f"{n}", reason_code="missing_registration") for n in range(2)]
    rows += [verdict("pass", ego_id=f"{n}") for n in range(2, 22)]
    assert "not judged: 1 rule without registration (for 2 of 22 egos)" in screen(result(rows))
    rows = [verdict("unknown", drive_id="d1", reason_code="missing_horn"), verdict("pass", drive_id="d2")]
    told = screen(result(rows, drives=[drive(), drive("d2")]))
    assert "not judged: 1 rule without horn (for 1 of 2 drives)" in told


def test_the_title_of_a_broken_rule_does_not_stand_alone() -> None:
    rows = [crash(), finding(rule_id="ukhc.spare", profile=None, observed=None, required=None, margin=None)]
    lines = screen(run(rows[1:]))
    assert any("Not kept: Time to spare" in line for line in lines)
    text = page(run(rows))
    worst = re.sub(r"<[^>]+>", " ", text.partition('id="worst"')[2].partition("</section>")[0])
    worst = " ".join(worst.split())
    assert "also Not kept: Time to spare" in worst
    assert "Not kept: No collision" in worst


def test_the_end_says_that_there_is_no_baseline() -> None:
    assert any(line.startswith("exit 0: ") and line.endswith("(no baseline)") for line in screen(run([])))
    assert not any("no baseline" in line for line in screen(against(NO_FINDING, run([]))))


def test_a_near_miss_in_a_run_with_a_baseline_is_not_said_to_lack_one() -> None:
    near = result([verdict("pass", near_miss=True, margin=0.1)])
    assert "only findings are compared, and this is a near miss" in page(against(NO_FINDING, near))
    assert "no baseline was given" not in page(against(NO_FINDING, near))


def test_a_rule_that_did_not_apply_somewhere_is_not_said_to_be_judged_nowhere() -> None:
    """Of two egos one is off the map: rules that did not apply to the other are unknown for that one only."""
    rules = [rule(), *(rule(f"ukhc.{name}") for name in ("lost", "lost2", "idle", "idle2", "idle3", "never"))]
    rows = [verdict("pass"), verdict("unknown", ego_id="2")]
    rows += [verdict("unknown", rule_id=f"ukhc.{name}", ego_id=ego) for name in ("lost", "lost2") for ego in "12"]
    for name in ("idle", "idle2", "idle3"):
        rows += [
            verdict("not_applicable", rule_id=f"ukhc.{name}"),
            verdict("unknown", rule_id=f"ukhc.{name}", ego_id="2"),
        ]
    rows += [verdict("not_applicable", rule_id="ukhc.never", ego_id=ego) for ego in "12"]
    of = result(rows, rules=rules)
    assert "7 rules: 1 judged, 2 could never be judged, 1 never applied, 3 not applicable or unknown" in screen(of)
    text = " ".join(re.sub(r"<[^>]+>", "", page(of)).split())
    assert "2 of the rules could never be judged; 1 could be judged only in part." in text
    packs = " ".join(re.sub(r"<[^>]+>", " ", page(of).partition('id="rules"')[2]).split())
    assert re.findall(r"\d+ judged(?:, \d+ not)*", packs)[0] == "1 judged, 6 not"
    assert (
        "3 of the rules did not apply at some times and could not be judged at the other times. 1 never applied."
        in text
    )
    off = {"reason_code": "missing_registration", "reason": "off the map"}
    folds = [row | off if row["verdict"] == "unknown" else row for row in rows]
    text = " ".join(re.sub(r"<[^>]+>", " ", page(result(folds, rules=rules)).partition('id="rules"')[2]).split())
    found = re.findall(r"(\d) (never applied|not judged|not applicable or not judged):", text)
    assert found == [("1", "never applied"), ("3", "not applicable or not judged"), ("2", "not judged")]


def test_a_run_in_which_no_rule_applied_says_so() -> None:
    of = result([verdict("not_applicable"), verdict("not_applicable", ego_id="2")])
    words = "not applicable no findings, because no rule applied: the situations of the rules did not occur"
    assert heads(of) == [words] * 3
    assert exit_status(of).code == ExitCode.OK
    assert any(re.match(r"d1 +no rule applied ", line) for line in screen(of))
    (h1,) = re.findall(r"<h1>(.*?)</h1>", page(of), re.DOTALL)
    assert '"#k-not_applicable"' in h1
    for more in ("unknown", "error"):
        assert "NOT APPLICABLE" not in screen(result([verdict("not_applicable"), verdict(more)]))[2]


@pytest.mark.parametrize(
    ("of", "mark", "word"),
    [(against(run(MIXED), run(MIXED)), "near", "FINDINGS"), (run([], verdict("unknown")), "pass", "PASS")],
)
def test_the_mark_is_that_of_the_word(of: Result, mark: str, word: str) -> None:
    """Known findings are no pass: whoever reads only the word must not take a contact for nothing."""
    (h1,) = re.findall(r"<h1>(.*?)</h1>", page(of), re.DOTALL)
    assert f'"#k-{mark}"' in h1
    assert f'<span class="outcome o-{mark}">{word}</span>' in h1


def test_the_worst_moment_of_a_passing_page_says_that_it_is_let_through() -> None:
    known = page(against(run(MIXED), run(MIXED)))
    assert re.search(r'id="worst">The worst moment, which is known ', known)
    assert '<div class="hero k-fail k-through">' in known
    new = page(against(NO_FINDING, run(MIXED)))
    assert 'id="worst">The worst moment <' in new
    assert "k-fail k-through" not in new


def test_findings_do_not_hide_that_most_could_not_be_judged() -> None:
    rules = [rule(f"ukhc.{name}") for name in "abc"]
    rows = [
        verdict("fail", rule_id="ukhc.a"),
        *(verdict("unknown", rule_id=f"ukhc.{name}", t_start_ns=None) for name in "bc"),
    ]
    minor = [finding(rule_id="ukhc.a", severity="minor")]
    told = headline(result(rows, minor, rules=rules))
    assert (told.label, told.parts[-1]) == (
        "FINDINGS",
        ("2 of the 3 rules that may apply could not be judged", "warning"),
    )
    assert "rules that may apply" not in headline(result(rows[:2], minor, rules=rules)).sentence
