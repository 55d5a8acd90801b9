"""Markdown for a comment: read back as GitHub's tables, with hostile words in it, and never too long."""

from __future__ import annotations

from datetime import date
from typing import Any

import pytest
from markdown_it import MarkdownIt

from drivelint.gate import GateInputs, Waiver, compare_results
from drivelint.report import markdown
from drivelint.result.model import Result
from tests.report.synthetic import SDA, SECOND, drive, finding, result, rule, verdict

PARSER = MarkdownIt("commonmark").enable(["table", "strikethrough"])
MIXED = [
    verdict("pass", profile="aggressive"),
    verdict("fail"),
    verdict("unknown", profile="observed", reason="the oncoming vehicle was lost"),
    verdict("not_applicable", profile="relaxed"),
]


def tables(text: str) -> list[list[list[str]]]:
    """Return the tables of a document: rows of cells, as a reader sees them."""
    found: list[list[list[str]]] = []
    cell = False
    for token in PARSER.parse(text):
        if token.type == "table_open":
            found.append([])
        elif token.type == "tr_open":
            found[-1].append([])
        elif token.type in {"th_open", "td_open", "th_close", "td_close"}:
            cell = token.type.endswith("open")
        elif cell:
            seen = (
                child.content for child in token.children or [] if child.type in {"text", "code_inline", "text_special"}
            )
            found[-1][-1].append("".join(seen))
    return found


def markdown_text(run: Result, **more: Any) -> str:
    return markdown.render(run, **more).decode()


def test_counts_stand_beside_each_other_per_pack() -> None:
    rules = [rule(), rule("rss.along", pack="rss")]
    counted, *_ = tables(
        markdown_text(result([*MIXED, verdict("pass", rule_id="rss.along")], [finding()], rules=rules))
    )
    assert counted == [
        ["pack", "pass", "fail", "unknown", "not applicable", "error"],
        ["ukhc", "1", "1", "1", "1", "0"],
        ["rss", "1", "0", "0", "0", "0"],
    ]


def test_a_finding_is_a_row_that_links_to_the_report() -> None:
    text = markdown_text(result(MIXED, [finding()]), base_url="https://ci.example/run 1/")
    _, found, _ = tables(text)
    assert found[1] == [
        "critical", "d1", "8.00 s", f"{SDA} [nominal]", "ego 1, object 3", "58.00 m", "> 64.00 m",
    ]  # fmt: skip
    links = [c.attrGet("href") for t in PARSER.parse(text) for c in t.children or [] if c.type == "link_open"]
    assert links == [
        f"https://ci.example/run%201/report.html#finding-d1-{SDA}-nominal-0", "https://ci.example/run%201/report.html",
    ]  # fmt: skip
    assert text.startswith(
        "## drivelint: FAIL, exit 1\n\n1 critical finding in 1 of 1 drive.\n\nexit 1: 1 finding at or above"
    )
    assert (
        "map: road.xodr fits 1 of 1 drive / log: complete, as far as the format .csv shows it / not judged: "
        in text.partition("| pack |")[0]
    )


def test_the_link_is_an_anchor_of_the_report() -> None:
    from drivelint.report import html

    run = result(MIXED, [finding(finding_id="0123456789abcdef")])
    assert "https://ci.example/report.html#finding-0123456789abcdef" in markdown_text(
        run, base_url="https://ci.example"
    )
    assert 'id="finding-0123456789abcdef"' in html.render(run).decode()


def test_without_a_base_url_nothing_is_linked() -> None:
    """A relative link in a comment on a pull request would lead into the repository."""
    run = result(MIXED, [finding()])
    for text in (
        markdown_text(run),
        markdown.render_difference(*compare_results(run, run, ("a", "b"), "critical"), "critical"),
    ):
        assert not [c for t in PARSER.parse(text) for c in t.children or [] if c.type == "link_open"]
    assert tables(markdown_text(run))[1][1][3] == f"{SDA} [nominal]"


def test_unknown_is_told_with_its_reason() -> None:
    rows = [*MIXED, *(verdict("unknown", occurrence=n, reason="no lights", rule_id=f"ukhc.r{n}") for n in range(1, 6))]
    text = markdown_text(result(rows, [finding()]))
    assert "Could not be judged: 6 verdicts, for 2 reasons" in text
    assert tables(text)[-1][1:] == [
        ["unknown", "ukhc.r1, ukhc.r2, ukhc.r3 and 2 more", "no lights (5 times)"],
        ["unknown", SDA, "the oncoming vehicle was lost"],
    ]


def test_drives_that_were_not_judged_are_told() -> None:
    lost = drive("d2", status="not_judged", status_reason="d2.csv: no ego")
    text = markdown_text(result([verdict("pass")], drives=[drive(), lost]))
    assert "### Drives that could not be judged (1)\n\n* `d2`: d2.csv: no ego" in text
    assert text.startswith("## drivelint: NOT JUDGED, exit 4")


@pytest.mark.parametrize(
    ("row", "over", "why"),
    [
        ({}, {"status": "draft"}, "draft"),
        ({"severity": "minor"}, {}, "below --fail-on critical"),
    ],
)
def test_what_does_not_gate_is_apart_with_the_reason(row: dict[str, Any], over: dict[str, Any], why: str) -> None:
    text = markdown_text(result([verdict("pass")], [finding(**row)], rules=[rule(**over)]))
    assert "<details><summary>Findings that do not gate (1)</summary>" in text
    assert tables(text)[1][1][-1] == why


HOSTILE = "a|b <img src=x> [x](y) *b* _i_ `c` ~~s~~ @team #12 https://evil.example www.evil.example &amp; \\ !"


@pytest.mark.parametrize("where", ["reason", "drive_id", "object_id"])
def test_words_of_a_log_are_shown_as_they_are(where: str) -> None:
    row = {where: HOSTILE}
    other = row if where == "drive_id" else {}
    run = result([verdict("unknown", **row)], [finding(**row)], drives=[drive(**other)])
    text = markdown_text(run)
    kinds = {c.type for t in PARSER.parse(text) for c in t.children or []}
    assert kinds <= {"text", "code_inline", "link_open", "link_close", "softbreak", "text_special"}
    assert all(len(row_) == len(table[0]) for table in tables(text) for row_ in table)
    assert "evil.example](" not in text
    for mention in ("@team", "#12", "://evil", "www.evil"):
        plain = [
            line for line in text.splitlines() if mention in line and f"`{HOSTILE[:3]}" not in line.replace("\\|", "|")
        ]
        assert plain == [], "an id stands in code, words are kept from GitHub's eye"


@pytest.mark.parametrize("words", ["- x", "+ x", "# x", "> x", "1 * 2", "x\n\ny", "-1.50 s"])
def test_words_begin_no_list_and_no_heading(words: str) -> None:
    (token,) = [t for t in PARSER.parse(markdown.escape_markdown(words)) if t.type == "inline"]
    assert "".join(c.content for c in token.children or []) == " ".join(words.split())
    assert [t.type for t in PARSER.parse(markdown.escape_markdown(words))] == [
        "paragraph_open",
        "inline",
        "paragraph_close",
    ]


def gated(base: list[dict[str, Any]], new: list[dict[str, Any]]) -> Result:
    waiver = Waiver("w.toml:1", "*", "ticket 17", "jo", "2027-01-31", object="4")
    expired = Waiver("w.toml:9", "none", "old", "al", "2026-01-31")
    keeper = GateInputs(date(2026, 11, 20), result([verdict("fail")], base), waivers=(waiver, expired))
    return keeper.apply_to(result([verdict("fail"), verdict("unknown", object_id="6")], new))


def test_a_baseline_tells_what_is_new_and_what_is_not_fixed() -> None:
    late = finding(finding_id="late", t_start_ns=115 * SECOND, t_end_ns=115 * SECOND, t_worst_ns=115 * SECOND)
    gone = finding(finding_id="gone", object_id="6")
    text = markdown_text(gated([finding(), gone], [finding(), late, finding(object_id="4", finding_id="w")]))
    assert "3 findings in 1 of 1 drive: 1 new (1 critical), 1 known (1 critical), 1 waived (1 critical)." in text
    assert "Of the baseline's findings: 1 unchanged; gone but not fixed: 1 unknown now." in text
    assert "### New findings (1)" in text
    assert tables(text)[1][1][2] == "15.00 s"
    assert [row[-1] for row in tables(text)[2][1:]] == [
        "known: the baseline contains it", "waived until 2027-01-31 by jo: ticket 17",
    ]  # fmt: skip
    assert "### Not fixed: now unknown (1)" in text
    assert "### Verdicts that are unknown now and were not before (1)" in text
    assert (
        "### Waivers that need attention\n\n* w.toml:9: expired 2026-01-31 (al): it has no effect; no rule has this id"
        in text
    )


def test_new_findings_that_do_not_gate_are_called_new_and_worse_ones_worse() -> None:
    minor = finding(
        finding_id="m", severity="minor", t_start_ns=115 * SECOND, t_end_ns=115 * SECOND, t_worst_ns=115 * SECOND
    )
    late = finding(finding_id="l", t_start_ns=120 * SECOND, t_end_ns=120 * SECOND, t_worst_ns=120 * SECOND)
    text = markdown_text(gated([finding(margin=-14.07)], [finding(margin=-26.07), minor, late]))
    assert "### New findings (1); 1 more new findings, listed below, do not gate" in text
    assert "Findings that do not gate (2): 1 new" in text
    assert [row[-1] for row in tables(text)[2][1:]] == [
        "known: the baseline contains it; worse now: margin -26.07 m, was -14.07 m", "new, below --fail-on critical",
    ]  # fmt: skip
    assert "1 known finding is worse" in text


def test_a_flood_is_cut_and_says_so() -> None:
    many = [finding(finding_id=f"f{n}", occurrence=n) for n in range(500)]
    text = markdown_text(result([verdict("fail")], many))
    assert "### Findings (the first 40 of 500)" in text
    assert len(text) < 65_536


def test_a_comment_has_room_for_it_whatever_the_names_are() -> None:
    long = "x" * 3000
    rows = [verdict("unknown", reason=f"{n}", rule_id=f"r{n}.{long}") for n in range(60)]
    text = markdown_text(
        result(rows, [finding(drive_id=long, finding_id=str(n)) for n in range(50)], drives=[drive(long)])
    )
    assert len(text) < 65_536
    assert "parts left out to keep this comment short" in text
    assert text.endswith("The complete report is report.html in the folder of the results.\n")


def test_a_difference_as_markdown() -> None:
    late = finding(finding_id="late", t_start_ns=115 * SECOND, t_end_ns=115 * SECOND, t_worst_ns=115 * SECOND)
    base = result([verdict("fail")], [finding(object_id="6")])
    new = result([verdict("fail"), verdict("unknown", object_id="6")], [late])
    found, failing = compare_results(base, new, ("main", "pull|request"), "critical")
    text = markdown.render_difference(found, failing, "critical", None)
    assert text.startswith("## drivelint diff: 1 new, gone but not fixed: 1 unknown now")
    assert "exit 1: 1 new finding at or above severity critical." in text
    assert tables(text)[0][1:] == [["main", "0", "1", "0", "0", "0"], ["pull|request", "0", "1", "1", "0", "0"]]
    assert "### New (1)\n\n* critical: d1 at 15.00 s:" in text
    assert "### Not fixed: now unknown (1)" in text


def test_a_time_is_in_utc_too_where_the_log_has_one() -> None:
    _, found, *_ = tables(
        markdown_text(result(MIXED, [finding()], drives=[drive(utc_start_ns=1_700_000_000_250_000_000)]))
    )
    assert [row[2] for row in found] == ["time", "8.00 s, 2023-11-14T22:13:28.250Z"]
    _, found, *_ = tables(markdown_text(result(MIXED, [finding()])))
    assert found[1][2] == "8.00 s"
