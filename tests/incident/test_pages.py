"""The sheet in a browser: two A4 pages with everything on them, large enough to read, and the same as PDF."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pytest

from drivelint.drive.finish import with_quality_finding
from drivelint.drive.trace import ASSUMED_SIZE_CHECK, QualityFinding
from drivelint.incident import IncidentRequest, judge_parties_again, pdf, sheet_html
from drivelint.incident.sheet import template_values
from drivelint.report.outputs import write
from drivelint.report.progress import Silent
from drivelint.road.geo_reference import tangent_plane_frame
from drivelint.run import CheckOptions, check
from tests.report.browser import CHROMIUM, Page
from tests.shared_data import shared

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.incident.case import Case
    from tests.incident.conftest import CaseOf

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")
A4_PX = (794, 1123)
LEAST_PX = 8 / 72 * 96  # 8 pt
NAMES = ("no-collision@collision", "safe-distance-ahead@collision", "no-collision@near_miss")
S = 1_000_000_000


def fits(page: Page, n_pages: int = 2) -> None:
    """Check that all pages are A4 on screen and in print, and that all of a page but its foot stands within its margins."""
    for media in ("screen", "print"):
        page.call("Emulation.setEmulatedMedia", media=media)
        shown = page.value(
            "[...document.querySelectorAll('.page')].map(p => { const q = p.getBoundingClientRect(), s = getComputedStyle(p),"
            " all = [...p.querySelectorAll(':not(svg *)')].filter(e => !e.closest('.foot')).map(e => e.getBoundingClientRect());"
            " return [p.offsetWidth, p.offsetHeight, p.scrollWidth, p.scrollHeight,"
            " Math.max(...all.map(e => e.bottom)) - q.bottom + parseFloat(s.paddingBottom),"
            " Math.max(...all.map(e => e.right)) - q.right + parseFloat(s.paddingRight),"
            " p.querySelector('.foot').getBoundingClientRect().top - q.bottom + parseFloat(s.paddingBottom)]})"
        )
        assert len(shown) == n_pages
        for width, height, inner_width, inner_height, below, beside, foot in shown:
            assert (width, height) == pytest.approx(A4_PX, abs=1)
            assert inner_width <= width
            assert inner_height <= height
            assert below <= 1 < foot
            assert beside <= 1


def is_legible(page: Page) -> None:
    """Check that every text is 8 pt or more, and that labels of the plan view are not too large and call the parties A and B."""
    texts = page.value(
        "[...document.querySelectorAll('.page *')].filter(e => [...e.childNodes].some(n => n.nodeType === 3 && n.data.trim()))"
        ".map(e => [e.textContent, parseFloat(getComputedStyle(e).fontSize) * (e.getScreenCTM ? e.getScreenCTM().a : 1)])"
    )
    assert len(texts) > 100
    assert [(text, px) for text, px in texts if px < LEAST_PX] == []
    shown = page.value(
        "[...document.querySelectorAll('.view .name')].map(e =>"
        " [e.textContent, parseFloat(getComputedStyle(e).fontSize) * e.getScreenCTM().a])"
    )
    assert {"A", "B"} <= {text for text, _ in shown}
    assert all(px < 20 for _, px in shown), shown


@pytest.mark.sample(0, ci=1)
@pytest.mark.parametrize("name", NAMES)
def test_everything_is_on_two_pages(case_of: CaseOf, tmp_path: Path, name: str) -> None:
    html = tmp_path / "sheet.html"
    html.write_bytes(sheet_html(case_of(name)))
    with Page(tmp_path / "profile", html.as_uri()) as page:
        fits(page)
        is_legible(page)
        assert page.complaints() == []
        assert page.requests() == [html.as_uri()]


@pytest.mark.ci
def test_a_phone_shows_a_page_in_its_whole_width(case_of: CaseOf, tmp_path: Path) -> None:
    html = tmp_path / "sheet.html"
    html.write_bytes(sheet_html(case_of(NAMES[0])))
    with Page(tmp_path / "profile", html.as_uri()) as page:
        page.call("Emulation.setDeviceMetricsOverride", width=390, height=844, deviceScaleFactor=2, mobile=True)
        width, shown = page.value("[document.querySelector('.page').offsetWidth, document.documentElement.clientWidth]")
        assert shown >= width
        page.call("Emulation.clearDeviceMetricsOverride")
        fits(page)


@pytest.mark.slow
@pytest.mark.parametrize("run", ["near_miss", "collision"])
def test_a_real_contact_is_on_two_pages_with_all_that_was_broken(run: str, tmp_path: Path) -> None:
    data = shared("overtake_case_study")
    asked = CheckOptions(
        (str(data / f"{run}.csv"),), map=data / "t_junction.xodr", mapping="carla-testbench", out=tmp_path
    )
    write(check(asked, Silent()), tmp_path)
    case = judge_parties_again(IncidentRequest("contact-signature", tmp_path))
    assert [told["broken"].more for told in template_values(case)["conduct"]] == [0, 0]
    html = tmp_path / "sheet.html"
    html.write_bytes(sheet_html(case))
    with Page(tmp_path / "profile", html.as_uri()) as page:
        fits(page)
        is_legible(page)


def crowded(case: Case, *, all_broken: bool) -> Case:
    """Return a case in which no rule is decided for both parties, each for a long reason of its own; or every other rule was broken."""
    finding = case.ego_rows.findings[0]
    reason = "a reason of many words, as a rule may write it about one of many objects " * 3
    rules = case.result.rules.to_pylist()
    broken = rules[::2] if all_broken else []
    findings = [{**finding, "rule_id": rule["rule_id"], "reason": reason} for rule in broken]
    verdicts = [
        {**case.ego_rows.verdicts[0], "rule_id": rule["rule_id"], "verdict": "unknown", "t_start_ns": None,
         "reason_code": f"code_{n}", "reason": f"{rule['title']}: {reason}", "near_miss": False}
        for n, rule in enumerate(rules[1::2])
    ]  # fmt: skip
    judged = replace(case.ego_rows, verdicts=verdicts, findings=[*case.ego_rows.findings, *findings])
    asked = replace(case.run_options, env=("weather=wet", "light=night", "nation=gb-eng"), map_offset=(1.25, -3.5))
    other_party = judged if all_broken else replace(judged, findings=[])
    return replace(case, ego_rows=judged, other_party=other_party, run_options=asked)


@pytest.mark.ci
def test_a_case_with_many_reasons_fits(case_of: CaseOf, tmp_path: Path) -> None:
    html = tmp_path / "sheet.html"
    page_bytes = sheet_html(crowded(case_of(NAMES[0]), all_broken=False))
    html.write_bytes(page_bytes)
    assert re.search(rb"and \d+ more reasons", page_bytes)
    with Page(tmp_path / "profile", html.as_uri()) as page:
        fits(page)
        is_legible(page)


@pytest.mark.ci
def test_what_does_not_fit_is_on_further_pages(case_of: CaseOf, tmp_path: Path) -> None:
    """Nothing that was broken is left out or printed small."""
    case = crowded(case_of(NAMES[0]), all_broken=True)
    told, html = template_values(case), tmp_path / "sheet.html"
    n_pages = 2 + len(told["further"])
    assert n_pages > 2
    for party in told["conduct"]:
        further = [part for parts in told["further"] for part in parts if part.party is party]
        texts = [*party["broken"].texts, *(text for part in further if part.part == "broken" for text in part.texts)]
        assert len(texts) == party["n"]["broken"]
        assert len(set(texts)) == len(texts)
    html.write_bytes(sheet_html(case))
    with Page(tmp_path / "profile", html.as_uri()) as page:
        fits(page, n_pages)
        is_legible(page)
        heads = page.value("[...document.querySelectorAll('#page-2 ~ .page > h2')].map(e => e.textContent)")
        assert heads == [f"What each party did, continued from page {no}" for no in range(2, n_pages)]
        shown = page.value("document.body.textContent")
        assert f"page {n_pages} of {n_pages}" in shown
        assert "more on page 3" in shown


def crowded_first_page(case: Case) -> Case:
    """Return a case of a contact shown by the speeds alone, with as much to say of it on page 1 as a log may give."""
    finding, steps = case.finding, case.ego_rows.steps
    saw = pa.array(10.0 + np.abs(np.arange(steps.num_rows) % 20 - 10.0))
    for name, column in (
        ("clearance_m", pa.array(np.full(steps.num_rows, 0.19))),
        ("speed_mps", saw),
        ("object_speed_mps", saw),
    ):
        steps = steps.set_column(steps.column_names.index(name), name, column)
    row = {
        **finding.row,
        "n_copies": 100,
        "n_stays": 53,
        "t_start_ns": finding.row["t_start_ns"] - 2 * S,
    }
    drive = {**finding.drive, "file_name": f"{'a-long-name-of-a-log-' * 4}-clip-0123abcd.csv", "map_name": "a-long-name-of-a-map.xodr" * 2,
             "utc_start_ns": 1_700_000_000 * S}  # fmt: skip
    rows = case.result.findings
    touched = rows.filter(pc.equal(rows["rule_id"], "ukhc.no-collision"))
    for name in ("n_copies", "n_stays"):
        n = pa.array([100] * touched.num_rows, touched[name].type)
        touched = touched.set_column(touched.column_names.index(name), touched.schema.field(name), n)
    result = replace(case.result, findings=pa.concat_tables([rows, touched, touched, touched]))
    ego_rows = replace(case.ego_rows, steps=steps)
    said = QualityFinding(ASSUMED_SIZE_CHECK, "info", f"size by the option {'of the user ' * 5}, not recorded")
    trace = with_quality_finding(case.drive.trace, said)
    again_drive = replace(case.drive, trace=trace, geo=tangent_plane_frame(52.946849, 2.907433))
    return replace(
        case, result=result, ego_rows=ego_rows, drive=again_drive, finding=replace(finding, row=row, drive=drive)
    )


@pytest.mark.slow
def test_a_crowded_first_page_fits(case_of: CaseOf, tmp_path: Path) -> None:
    html = tmp_path / "sheet.html"
    page_bytes = sheet_html(crowded_first_page(case_of("contact-signature@collision")))
    for said in (
        b"It is based on",
        b"earlier<br>",
        b"Contact also",
        b"more contacts",
        b"this finding is <b>possible",
        b"UTC",
        b"geo reference, doubtful: in the sea",
    ):
        assert said in page_bytes
    html.write_bytes(page_bytes)
    with Page(tmp_path / "profile", html.as_uri()) as page:
        fits(page)
        is_legible(page)


@pytest.mark.ci
def test_pdf_has_two_pages_and_no_clock(case_of: CaseOf) -> None:
    html = sheet_html(case_of(NAMES[0]))
    browser = pdf.find_browser()
    printed = pdf.pdf_of_page(html, browser)
    assert printed.startswith(b"%PDF")
    assert len(re.findall(rb"/Type\s*/Page\b(?!s)", printed)) == 2
    assert re.findall(rb"/MediaBox\s*\[0 0 (\d+)", printed)[0] in {b"595", b"594", b"596"}
    assert pdf.pdf_of_page(html, browser) == printed
