"""New, known and waived findings on the page, and waivers that do not do what they are for."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from datetime import date
from pathlib import Path

import pyarrow.compute as pc
import pytest

from drivelint.gate import GateInputs, Waiver
from drivelint.report.outputs import write
from drivelint.result.counts import one_finding_per_event
from drivelint.result.load import load_result
from drivelint.result.model import Result
from tests.report.browser import CHROMIUM, Page
from tests.report.pages import NASTY, Parsed, page
from tests.report.synthetic import finding, result, verdict

TODAY = date(2026, 11, 20)
WAIVERS = (
    Waiver("w.toml:1", "ukhc.r162.*", "a prop of the track", "jo@example.org", "2027-01-31", drive="near_miss-*"),
    Waiver("w.toml:7", "ukhc.*", "old", "al@example.org", "2026-01-31"),
    Waiver("w.toml:12", "no.such.rule", "a slip of the pen", "kim@example.org", "2027-01-31"),
)


@pytest.fixture(scope="module")
def gated(overtakes: Result) -> Result:
    """Return the three overtakes, held against an earlier result without the collision, and waivers."""
    now = overtakes
    parts = {
        name: (table := getattr(now, name)).filter(pc.invert(pc.starts_with(table["drive_id"], "collision")))
        for name in ("verdicts", "findings", "drives")
    }
    return GateInputs(TODAY, replace(now, **parts), "main", WAIVERS).apply_to(now)


@pytest.fixture(scope="module")
def browser_page(gated: Result, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    folder = tmp_path_factory.mktemp("page")
    (folder / "report.html").write_text(page(gated), encoding="utf-8")
    with Page(folder / "profile", (folder / "report.html").as_uri()) as shown:
        yield shown


def kinds(run: Result) -> Counter[str]:
    """Return how many findings are new, known and waived, worked out from the gate."""
    assert run.gate is not None
    ids = run.findings["finding_id"].to_pylist()
    return Counter(
        "waived" if run.gate.waiver(name) else "known" if run.gate.is_in_baseline(name) else "new" for name in ids
    )


def test_each_finding_says_how_it_stands(gated: Result) -> None:
    told = kinds(gated)
    assert min(told["new"], told["known"], told["waived"]) > 0
    text = page(gated)
    parsed = Parsed(text)
    for part in ("findings", "drives"):
        section = text.partition(f'id="{part}"')[2].partition("</section>")[0]
        for kind, n_rows in told.items():
            assert section.count(f'class="stands st-{kind}"') == n_rows, "once in the table, once at its moment"
    assert 'class="stands st-new"' in text.partition('id="worst"')[2].partition("</section>")[0]
    assert 'class="stands st-new"' in text.partition('id="story"')[2].partition("</section>")[0]
    gate = gated.gate
    assert gate is not None
    rows = gated.findings.to_pylist()
    n_events = {
        kind: len(one_finding_per_event(r for r in rows if gate.status_at_gate(r["finding_id"]) == kind))
        for kind in told
    }
    assert n_events["new"] < told["new"], "one overtake under several profiles"
    assert f"{n_events['new']} new, {n_events['known']} known, {n_events['waived']} waived." in parsed.text
    assert f": {n_events['new']} new (" in parsed.text.partition("Skip to")[2]
    assert (
        f"{len(rows)} rows, {sum(n_events.values())} findings: an overtake under two profiles counts once."
        in parsed.text
    )
    assert "waived until 2027-01-31 by jo@example.org: a prop of the track" in parsed.text


def test_waivers_that_waive_nothing_are_shown_first(gated: Result) -> None:
    text = Parsed(page(gated)).text
    places = [text.index(word) for word in ("expired: it has no effect", "matches no finding", "in force")]
    assert places == sorted(places)
    assert "al@example.org" in text
    assert "no.such.rule" in text


def test_what_is_gone_but_not_fixed_is_told() -> None:
    before = result([verdict("fail")], [finding()])
    now = GateInputs(TODAY, before, "main").apply_to(result([verdict("unknown", t_start_ns=None)]))
    text = Parsed(page(now)).text
    assert "Not fixed: now unknown" in text
    assert "1 more verdict is unknown than in main" in text


def test_the_baselines_verdict_on_a_new_finding_is_called_the_one_before() -> None:
    kept = result([verdict("pass", reason="Distance ahead: kept by 1.7 m.")])
    now = GateInputs(TODAY, kept, "main").apply_to(result([verdict("fail")], [finding(margin=-1.92)]))
    text = Parsed(page(now)).text
    assert "before: pass: Distance ahead: kept by 1.7 m." in text
    assert text.count("kept by 1.7 m") == text.count("before: pass: Distance ahead: kept by 1.7 m")


def test_without_an_earlier_result_and_waivers_the_page_says_nothing_of_them() -> None:
    text = page(result([verdict("fail")], [finding()]))
    assert 'class="stands' not in text
    assert 'id="gate"' not in text
    assert 'name="standing"' not in text


def test_with_waivers_alone_nothing_is_called_new() -> None:
    run = GateInputs(TODAY, None, "", WAIVERS).apply_to(result([verdict("fail")], [finding()]))
    parsed = Parsed(page(run))
    assert "1 finding in 1 of 1 drive: 1 not waived (1 critical)" in parsed.text
    assert '"stands st-new"' not in page(run)
    assert "New and known findings" not in parsed.text
    assert "1 not waived, 0 waived" in parsed.text


def test_markup_in_waivers_stays_text() -> None:
    waiver = Waiver(NASTY, "*", NASTY, NASTY, "2027-01-31")
    run = GateInputs(TODAY, result([]), NASTY, (waiver,)).apply_to(result([verdict("fail")], [finding()]))
    parsed = Parsed(page(run))
    assert sum(tag == "script" for tag, _ in parsed.tags) == 1
    assert not any(tag == "img" for tag, _ in parsed.tags)


def test_a_page_made_later_from_the_folder_is_the_same(gated: Result, tmp_path: Path) -> None:
    write(gated, tmp_path)
    assert page(load_result(tmp_path)) == (tmp_path / "report.html").read_text(encoding="utf-8")


@pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")
@pytest.mark.parametrize("kind", ["new", "known", "waived"])
def test_the_filter_shows_only_one_kind(gated: Result, browser_page: Page, kind: str) -> None:
    browser_page.value(
        f"(() => {{ const s = document.querySelector('select[name=standing]'); s.value = 'gate-{kind}';"
        " s.dispatchEvent(new Event('change', {bubbles: true})); })()"
    )
    shown = "[...document.querySelectorAll('#findings-table tbody tr')].filter(r => r.offsetHeight > 0)"
    assert browser_page.value(f"{shown}.length") == kinds(gated)[kind] > 0
    assert browser_page.value(f"{shown}.every(r => r.querySelector('.st-{kind}'))")
    lines = "[...document.querySelectorAll('.timeline .tl[data-k], .moment[data-k]')].filter(r => !r.hidden)"
    assert browser_page.value(f"{lines}.length") > 0
    assert browser_page.value(f"{lines}.every(r => r.dataset.k.split(' ').includes('gate-{kind}'))")
    assert browser_page.complaints() == []
