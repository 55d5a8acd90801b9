"""The page: what it says, that it is escaped, closed to the outside, and the same bytes for the same result."""

from __future__ import annotations

import base64
import hashlib
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from drivelint.errors import UsageError
from drivelint.report.html.reasons import VerdictReason, summarise_reasons, verdict_reason
from drivelint.report.outputs import write
from drivelint.result.load import load_result
from drivelint.result.model import Result
from drivelint.result.names import TABLE_OF_FILE
from tests.report.pages import NASTY, Parsed, nasty, page
from tests.report.synthetic import SECOND, drive, finding, result, rule, verdict


@pytest.fixture(scope="module")
def text(overtakes: Result) -> str:
    return page(overtakes)


def test_markup_in_names_stays_text() -> None:
    plain = Parsed(page(result([verdict("pass")])))
    parsed = Parsed(page(nasty()))
    assert parsed.text.count(NASTY) > 20
    assert [attrs.get("type") for tag, attrs in plain.tags if tag == "script"] == [None]
    assert [attrs.get("type") for tag, attrs in parsed.tags if tag == "script"] == ["application/json", None]
    assert not [tag for tag, _ in parsed.tags if tag == "img"]
    assert not [name for _, attrs in parsed.tags for name in attrs if name.startswith("on")]
    ids = parsed.values("id")
    assert all(re.fullmatch(r"[A-Za-z][\w.-]*", name) for name in ids)


def test_the_policy_allows_our_style_and_script_and_nothing_from_outside(text: str) -> None:
    parsed = Parsed(text)
    (policy,) = [
        a["content"] for t, a in parsed.tags if t == "meta" and a.get("http-equiv") == "Content-Security-Policy"
    ]
    assert policy is not None
    assert "default-src 'none'" in policy
    assert "unsafe" not in policy
    assert {a.get("type") for tag, a in parsed.tags if tag == "script"} == {None, "application/json"}  # ours, and data
    for tag in ("style", "script"):
        (body,) = re.findall(rf"<{tag}>(.*?)</{tag}>", text, re.DOTALL)
        digest = base64.b64encode(hashlib.sha256(body.encode()).digest()).decode()
        assert f"{tag}-src 'sha256-{digest}'" in policy
    assert not parsed.values("style")
    assert not parsed.values("src")
    assert all(link.startswith(("#", "data:,")) for link in parsed.values("href"))
    assert not re.search(r"(?:https?:)?//[a-z]|@import|url\((?!#)", text)


def test_the_same_result_gives_the_same_bytes(overtakes: Result, text: str) -> None:
    def pieces(rows: pa.Table) -> pa.Table:
        return pa.concat_tables([rows.slice(0, 1), rows.slice(1)])

    again = Result(
        pieces(overtakes.verdicts),
        pieces(overtakes.findings),
        pieces(overtakes.drives),
        pieces(overtakes.rules),
        *(pieces(getattr(overtakes, name)) for name in list(TABLE_OF_FILE)[4:]),
    )
    assert page(again) == text


def test_every_finding_has_its_anchor_its_row_and_a_picture(overtakes: Result, text: str) -> None:
    parsed = Parsed(text)
    ids, links = parsed.values("id"), parsed.values("href")
    assert len(ids) == len(set(ids))
    for row in overtakes.findings.to_pylist():
        assert f"finding-{row['finding_id']}" in ids
        assert links.count(f"#finding-{row['finding_id']}") >= 2  # from the table and from the timeline
    assert {link[1:] for link in links if link.startswith("#")} <= set(ids)
    moments = text.split('<details class="moment')[1:]
    assert len(moments) == overtakes.scenes.num_rows
    assert all('<svg class="plan"' in moment and "b-ego" in moment for moment in moments)
    assert text.count('class="space ') > 0


def test_a_page_of_a_typical_drive_is_small(text: str) -> None:
    assert len(text) < 700_000


def test_what_a_moment_says_is_what_was_measured(overtakes: Result, text: str) -> None:
    (row,) = [
        r for r in overtakes.findings.to_pylist()
        if r["drive_id"].startswith("collision") and r["profile"] == "relaxed" and "r162" in r["rule_id"]
    ]  # fmt: skip
    (block,) = re.findall(rf'id="finding-{row["finding_id"]}">(.*?)</p>', text, re.DOTALL)
    said = " ".join(re.sub(r"<[^>]+>", " ", block).split())
    assert f"{row['observed']:.2f} m must be more than {row['required']:.2f} m missed by {-row['margin']:.2f} m" in said


def test_unknown_is_told_with_its_reason_and_never_as_a_pass() -> None:
    rows = [
        verdict("unknown", reason="no map: give one", t_ref_ns=None, t_start_ns=None, t_end_ns=None, t_worst_ns=None)
    ]
    parsed = Parsed(page(result(rows)))
    assert "No findings, because nothing could be decided" in parsed.text
    assert "No map: give one" in parsed.text
    assert "No rule was broken" not in parsed.text


def test_the_headline() -> None:
    def headline(run: Result) -> str:
        (found,) = re.findall(r"<h1>(.*?)</h1>", page(run), re.DOTALL)
        return re.sub(r"<[^>]+>", "", found).strip()

    assert headline(result([verdict("pass")])) == "PASS No findings"
    assert (
        headline(result([verdict("pass"), verdict("unknown")]))
        == "PASS No findings, but not everything could be judged"
    )
    lost = [drive("d2", status="not_judged", status_reason="broken")]
    assert (
        headline(result([verdict("pass")], drives=[drive(), *lost]))
        == "NOT JUDGED No findings, but not everything could be judged"
    )
    others = [rule(), rule("ukhc.a"), rule("ukhc.b")]
    mostly = result(
        [verdict("pass"), verdict("unknown", rule_id="ukhc.a"), verdict("unknown", rule_id="ukhc.b")], rules=others
    )
    assert headline(mostly) == "MOSTLY UNKNOWN No findings, but 2 of the 3 rules that may apply could not be judged"
    assert "2 of the rules could never be judged." in Parsed(page(mostly)).text
    partly = result([verdict("pass"), verdict("unknown"), verdict("unknown", occurrence=1)])
    assert headline(partly).startswith("PASS ")
    assert "1 of the rules could be judged only in part" in Parsed(page(partly)).text
    assert headline(result([], drives=lost)) == "NOT JUDGED Nothing was judged"
    assert headline(result([verdict("fail")], [finding()])) == "FAIL 1 critical finding in 1 of 1 drive"


def test_a_crowd_is_cut_to_the_worst_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    from drivelint.report.html import page as module

    monkeypatch.setattr(module, "MAX_FINDINGS", 3)
    monkeypatch.setattr(module, "MAX_DRIVE_SECTIONS", 1)
    rows: list[dict[str, Any]] = [
        finding(drive_id=f"d{k}", severity="critical" if k == 7 else "minor", t_worst_ns=(108 + k) * SECOND)
        for k in range(9)
    ]
    run = result([verdict("fail")], rows, drives=[drive(f"d{k}") for k in range(9)])
    parsed = Parsed(page(run))
    assert sum(name.startswith("finding-") for name in parsed.values("id")) <= 3
    assert "The 3 most severe are shown" in parsed.text
    assert "Another 8 drives have no section here" in parsed.text
    assert f"finding-d7-{rows[7]['rule_id']}-nominal-0" in parsed.values("id")
    links = {link[1:] for link in parsed.values("href") if link.startswith("#")}
    assert links <= set(parsed.values("id"))


def rows_of(text: str, table: str) -> list[list[str]]:
    """Return the cells of a table's rows as text."""
    (found,) = re.findall(rf'<table class="{table}".*?</table>', text, re.DOTALL)
    rows = re.findall(r"<tr.*?</tr>", found, re.DOTALL)
    return [[plain(cell) for cell in re.findall(r"<t[hd].*?</t[hd]>", row, re.DOTALL)] for row in rows]


def plain(markup: str) -> str:
    return " ".join(re.sub(r"<[^>]+>", " ", markup).split())


def test_the_table_of_safe_distances_is_the_rules_verdicts(overtakes: Result, text: str) -> None:
    head, *rows = rows_of(text, "list sda")
    assert head == ["overtake", "distance ahead", "relaxed", "nominal", "aggressive", "observed (what-if)"]
    names = {"pass": "kept", "fail": "not kept"}
    said = {
        (row["drive_id"], row["profile"]): row
        for row in overtakes.verdicts.to_pylist()
        if row["rule_id"] == "ukhc.r162.safe-distance-ahead"
    }
    assert len(rows) == len({drive_id for drive_id, _ in said}) == 3
    for name, *cells in rows:
        for profile, cell in zip(head[2:5], cells[1:4], strict=True):
            row = said[name.split()[0], profile]
            assert cell.startswith(f"{names[row['verdict']]} zone ")
            assert f"needs more than {row['required']:.2f} m" in cell
            assert f"{'spare' if row['margin'] > 0 else 'short by'} {abs(row['margin']):.2f} m" in cell
            assert cells[0] == f"{row['observed']:.2f} m"


def test_the_stage_table_is_the_verdicts_of_the_runtime_assertions(overtakes: Result, text: str) -> None:
    names = {"pass": "kept", "fail": "not kept", "unknown": "unknown"}
    order = ["ds-vbp-out-of-av", "ds-ov-out-of-av", "ds-av-out-of-ov", "ds-disjoint"]
    blocks = re.findall(r'<details class="overtake".*?</details>', text, re.DOTALL)
    compared = 0
    for block in blocks:
        drive_id = plain(block).split("Stages: ")[1].split()[0].rstrip(",")
        head, *rows = rows_of(block, "list stage-table")
        for name, (_, *cells) in zip(order, rows, strict=True):
            for stage, cell in zip(head[1:], cells, strict=True):
                said = {
                    row["verdict"]
                    for row in overtakes.verdicts.to_pylist()
                    if (row["drive_id"], row["rule_id"]) == (drive_id, f"ukhc.r126.{name}")
                    and row["reason"].startswith(stage)
                }
                if said:
                    assert cell.startswith(names[min(said, key=["fail", "unknown", "pass"].index)])
                    compared += 1
    assert len(blocks) == 3
    assert compared > 20


def test_the_zone_plot_has_a_dot_per_overtake_and_profile_in_its_zone(overtakes: Result, text: str) -> None:
    known = [
        (row, p) for row in overtakes.overtakes.to_pylist() for p in row["profiles"]
        if p["da_m"] is not None and p["sda_m"] is not None
    ]  # fmt: skip
    dots = re.findall(r'<svg x="([\d.]+)" y="([\d.]+)" class="dot z-(\w)"><title>(.*?)</title>', text)
    assert len(dots) == len(known) >= 9
    for row, p in known:
        (dot,) = [d for d in dots if d[3].startswith(row["drive_id"]) and f", {p['profile']}:" in d[3]]
        assert dot[2] == p["zone"]
    x, y = ([float(d[i]) for d in dots] for i in (0, 1))
    sda, da = ([p[name] for _, p in known] for name in ("sda_m", "da_m"))
    assert np.corrcoef(sorted(x), sorted(sda))[0, 1] == pytest.approx(1, abs=1e-5)
    assert np.corrcoef(sorted(y), sorted(-v for v in da))[0, 1] == pytest.approx(1, abs=1e-5)


def test_a_finding_over_time_shows_what_was_judged(overtakes: Result, text: str) -> None:
    courses = {row["finding_id"]: row for row in overtakes.courses.to_pylist() if row["finding_id"]}
    charts = 0
    for row in overtakes.findings.to_pylist():
        course = courses[row["finding_id"]]
        at = course["t_ns"].index(row["t_worst_ns"])
        assert (course["observed"][at], course["margin"][at], course["holds"][at]) == (
            row["observed"],
            row["margin"],
            False,
        )
        (block,) = re.findall(rf'id="finding-{row["finding_id"]}">(.*?)(?:id="finding-|</details>)', text, re.DOTALL)
        if len(course["t_ns"]) > 2 and row["observed"] is not None:
            assert '<path class="seen-line"' in block
            assert '<rect class="span sp-fail"' in block
            charts += 1
    assert charts > 5


def test_reasons_are_grouped_by_what_is_to_be_provided() -> None:
    times = [
        verdict(
            "unknown",
            occurrence=k,
            reason_code="applies_unknown",
            reason=f"Whether it applies is not known at {k}.600 s.",
        )
        for k in range(5)
    ]
    signal = verdict(
        "unknown", rule_id="x.y", reason_code="missing_indicator", reason="the log has no indicators of the ego"
    )
    shown = page(result([*times, signal], rules=[rule(), rule("x.y", title="signals")]))
    provide, silent = re.findall(r"<caption>(?:Data that would|Data that the recordings).*?</table>", shown, re.DOTALL)
    assert "The log has no indicators of the ego signals 1 1" in plain(provide)
    assert plain(silent).count("Whether it applies is not known") == 1
    assert "Whether it applies is not known at 0.600 s (and 4 similar) room to overtake 5 1" in plain(silent)


@pytest.mark.parametrize(
    ("reasons", "summary"),
    [
        ([("no_size", "the ego has no size")] * 2, "The ego has no size"),
        (
            [
                ("no_limit", "the map gives no limit for lanelet 7: give one"),
                ("no_limit", "the map gives no limit for lanelet 12: give one"),
            ],
            "The map gives no limit for lanelet 7: give one (and 1 similar)",
        ),
        ([("lost", "Lost."), ("late", "It began late."), ("short", "It ended soon.")], "Lost (and 2 other reasons)"),
        (
            [
                ("row", "No row at 1 s."),
                ("row", "No row at 12 s."),
                ("row", "No row at 13 s."),
                ("else", "Something else."),
            ],
            "No row at 1 s (and 2 similar and 1 other reason)",
        ),
    ],
)
def test_a_shown_reason_is_one_that_was_given(reasons: list[tuple[str, str]], summary: str) -> None:
    told = [VerdictReason(("null_value", code, ""), text) for code, text in reasons]
    assert summarise_reasons(told) == summarise_reasons(reversed(told)) == summary


def test_reasons_are_alike_by_their_codes() -> None:
    row = {"reason_code": "null_value", "cause_code": "no_limit", "reason": "lanelet 7"}
    assert verdict_reason(row).kind == verdict_reason(row | {"reason": "lanelet 12"}).kind
    assert verdict_reason(row).kind != verdict_reason(row | {"cause_code": "ego_off_lanes"}).kind
    own = row | {"cause_code": "text"}
    assert verdict_reason(own).kind != verdict_reason(own | {"reason": "lanelet 12"}).kind


def test_rules_that_were_not_judged_are_folded_by_reason() -> None:
    ids = [f"ukhc.r{k}" for k in range(30)]
    rows = [verdict("pass")] + [
        verdict(
            "not_applicable",
            rule_id=i,
            t_start_ns=None,
            t_end_ns=None,
            t_worst_ns=None,
            t_ref_ns=None,
            reason="It never came.",
        )
        for i in ids
    ]
    shown = page(result(rows, rules=[rule(), *(rule(i, title=i) for i in ids)]))
    assert shown.count('<details class="fold">') == 2  # in the drive and in the list of rules
    assert shown.count('<div class="tl" ') + shown.count('<div class="tl kept" ') == 1
    assert all(f'id="rule-{i}"' in shown for i in ids)


def test_a_crowd_stays_small() -> None:
    from drivelint.report.html import page as module

    names = [f"d{k:03d}" for k in range(300)]
    rows = [verdict("fail" if k % 3 == 0 else "pass", drive_id=d) for k, d in enumerate(names)]
    found = [finding(drive_id=d) for k, d in enumerate(names) if k % 3 == 0]
    shown = page(result(rows, found, drives=[drive(d) for d in names]))
    assert shown.count('<details class="drive ') <= module.MAX_DRIVE_SECTIONS
    assert len(shown) < 1_000_000


def test_a_result_read_back_gives_the_same_page(overtakes: Result, text: str, tmp_path: Path) -> None:
    write(overtakes, tmp_path)
    assert page(load_result(tmp_path)) == text


@pytest.mark.ci
def test_the_command_writes_the_page_into_the_folder(overtakes: Result, text: str, tmp_path: Path) -> None:
    write(overtakes, tmp_path)
    command = [sys.executable, "-m", "drivelint", "report", str(tmp_path), "--to", "html"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout.strip()) == (0, str(tmp_path / "report.html"))
    assert (tmp_path / "report.html").read_text(encoding="utf-8") == text
    done = subprocess.run([*command[:4], str(tmp_path / "absent")], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith("drivelint: error: ")
    assert len(done.stderr.splitlines()) == 1


def test_a_folder_without_a_result_is_one_clear_error(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="no result of drivelint check"):
        load_result(tmp_path)
    write(result([verdict("pass")]), tmp_path)
    (tmp_path / "findings.parquet").write_bytes(b"cut")
    with pytest.raises(UsageError, match=r"findings\.parquet: cannot be read"):
        load_result(tmp_path)
    (tmp_path / "summary.json").write_text('{"output_schema": 99, "fail_on": "never", "strict": false}')
    with pytest.raises(UsageError, match="output schema 99"):
        load_result(tmp_path)


def test_a_finding_has_its_time_in_utc_where_the_log_has_one() -> None:
    text = page(result([verdict("fail")], [finding()], drives=[drive(utc_start_ns=1_700_000_000_250_000_000)]))
    assert Parsed(text).values("datetime") == ["2023-11-14T22:13:28.250Z"] * 2  # of the worst moment, and in its drive
    assert ">2023-11-14T22:13:28.250Z<" in text
    assert "<time" not in page(result([verdict("fail")], [finding()]))
