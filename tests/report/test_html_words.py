"""What the page says to a reader who is no engineer: words explained, measures named, whose finding it is, the paper's tables."""

from __future__ import annotations

import hashlib
import re
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pyarrow as pa
import pytest

from drivelint.report.html.explanations import notes_on_published_logs
from drivelint.report.html.incidents import involved_actors
from drivelint.result.model import Result
from tests.report.pages import Parsed, page
from tests.report.synthetic import drive, finding, result, verdict
from tests.shared_data import shared


@pytest.fixture(scope="module")
def text(overtakes: Result) -> str:
    return page(overtakes)


def test_the_first_page_explains_the_words_it_uses(overtakes: Result, text: str) -> None:
    told = Parsed(text).text
    words = told.partition("Words used here")[2].partition("Overtakes")[0]
    assert "Danger space" in words
    assert "RSS" not in words, "no rule of that pack was asked for"
    assert "Words used here" not in page(result([verdict("pass")]))


def test_an_ego_whose_id_says_so_is_named_once() -> None:
    rows = [finding(ego_id=ego_id, object_id="7") for ego_id in ("ego", "3")]
    lines: Any = [SimpleNamespace(row=row, kind="fail") for row in rows]
    assert [party["name"] for party in involved_actors(lines, {})] == ["ego 3", "ego", "object 7"]


def test_what_happened_names_the_measure_and_the_parties(overtakes: Result, text: str) -> None:
    told = Parsed(text).text.replace("\u00a0", " ")
    rows = [r for r in overtakes.findings.to_pylist() if r["rule_id"] == "ukhc.r162.safe-distance-ahead"]
    row = min(rows, key=lambda r: r["margin"])
    assert f"distance ahead {row['observed']:.2f} m, must be more than {row['required']:.2f} m" in told
    assert re.search(r"reach into the oncoming vehicle's danger space \d+\.\d\d m, must be none", told)
    assert re.search(r"; also: [^.]*\bCollision\b", told), "a finding's title says what happened"
    assert "Not kept: No collision" not in told
    assert "Involved: ego" in told


def test_with_several_egos_each_finding_says_whose_it_is() -> None:
    rows = [finding(), finding(ego_id="9", finding_id="x")]
    several = page(result([verdict("fail"), verdict("fail", ego_id="9")], rows))
    assert '<th scope="col">ego</th>' in several
    assert '<td class="actor" data-label="ego">9</td>' in several
    assert '<th scope="col">ego</th>' not in page(result([verdict("fail")], rows[:1]))


def test_the_drive_is_named_where_there_are_several(text: str) -> None:
    assert '<th scope="col">drive</th><th scope="col" class="num">when</th>' in text
    one = page(result([verdict("fail")], [finding()]))
    assert '<th scope="col">drive</th><th scope="col" class="num">when</th>' not in one


TABLE_1 = "17be8a04c5126c316f44070ff7b758308e61b5e4a0138ad3fc8b1585e620432b"
TABLE_2 = "517679d844fca426b466d6b86ed5ee3d570cb5cfe527b74acfd6e71503da0857"


@pytest.mark.parametrize(
    ("sha256", "difference"),
    [
        pytest.param(TABLE_1, "some 2 m less", id="table 1"),
        pytest.param(TABLE_2, "no vehicle was detected, but one may have been there", id="table 2"),
        pytest.param("ab" * 32, "", id="no log of theirs"),
    ],
)
def test_differences_from_the_paper_are_named_on_its_own_logs_only(
    overtakes: Result, sha256: str, difference: str
) -> None:
    hashes = pa.array([sha256] * overtakes.drives.num_rows)
    place = overtakes.drives.column_names.index("sha256")
    told = Parsed(page(replace(overtakes, drives=overtakes.drives.set_column(place, "sha256", hashes)))).text
    assert ("the paper's Table" in told) == bool(difference)
    assert difference in told


def test_the_logs_of_the_paper_are_the_ones_that_the_differences_are_about() -> None:
    for name in ("safe", "near_miss", "collision"):
        assert notes_on_published_logs([{"sha256": _hash(shared(f"overtake_case_study/{name}.csv"))}])[0][
            "title"
        ].endswith("distances")
    assert (
        "Table 2" in notes_on_published_logs([{"sha256": _hash(shared("video_case_study/detections.csv"))}])[0]["title"]
    )


def _hash(file: Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()


def test_of_a_crowd_the_worst_have_charts_and_the_page_says_so(
    overtakes: Result, text: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert text.count('<svg class="chart"') > 2
    assert "Charts over time are drawn" not in text
    monkeypatch.setattr("drivelint.report.html.page.MAX_CHARTS", 5)
    few = page(overtakes)
    assert 0 < few.count('<svg class="chart"') <= 5
    assert "Charts over time are drawn for the worst 5" in few


def test_overtakes_are_counted_though_no_rule_about_them_was_asked_for(overtakes: Result) -> None:
    bare = [row | {"profiles": [], "stretches": []} for row in overtakes.overtakes.to_pylist()]
    unasked = replace(overtakes, overtakes=pa.Table.from_pylist(bare, schema=overtakes.overtakes.schema))
    assert f"Overtakes {len(bare)}" in " ".join(Parsed(page(unasked)).text.split())


def test_kilometres_of_several_egos_are_of_several() -> None:
    assert "km by 25 vehicles in" in Parsed(page(result([verdict("pass")], drives=[drive(n_egos=25)]))).text
    assert "vehicles in" not in Parsed(page(result([verdict("pass")]))).text


def test_a_contact_stands_on_top(overtakes: Result, text: str) -> None:
    told = Parsed(text).text.partition("The worst moment")[0].replace("\u00a0", " ")
    rows = [r for r in overtakes.findings.to_pylist() if r["rule_id"] == "ukhc.no-collision"]
    drives = {row["drive_id"] for row in rows}
    assert len(drives) == 1
    assert told.count("and object") == 1, "found by its boxes and by its speeds, it is one contact"
    assert drives.pop() in told.partition("shows a contact:")[2]
    assert f"{-rows[0]['observed']:.2f} m deep" in told
    assert "there was a contact" not in page(result([verdict("fail")], [finding()]))


def test_an_acceleration_has_its_unit_typeset(text: str) -> None:
    told = Parsed(text).text.replace("\u00a0", " ")
    assert re.search(r"\d m/s\u00b2", told)
    assert not re.search(r"\d m/s2", told)
