"""The sheet of a near miss says that the rule was kept, and by how much."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING

import pyarrow.compute as pc
import pytest

from drivelint.errors import UsageError
from drivelint.incident import IncidentRequest, other_drives_with_named_finding, possible_sheet_ids, sheet_html
from drivelint.incident.finding import named_finding, near_misses
from drivelint.incident.sheet import template_values
from drivelint.pack import sheets
from drivelint.result import request as run_request
from drivelint.result.load import load_result
from tests.explain.overtake_check import OVERTAKE
from tests.incident.recorded import closing_by_places, fixture_log, gap

if TYPE_CHECKING:
    from pathlib import Path

    from tests.incident.conftest import CaseOf

NAME = "no-collision@near_miss"
pytestmark = pytest.mark.ci


def test_it_says_that_the_rule_was_kept_and_by_how_much(case_of: CaseOf) -> None:
    log = fixture_log(OVERTAKE / "near_miss.csv")
    least, at = min((gap(log["ego"][t], log["oncoming"][t]), t) for t in log["ego"] if t in log["oncoming"])
    told = template_values(case_of(NAME))
    apart = f"A and B were {least:.2f} m apart"
    assert told["title"] == f"Near miss at {at:.2f} s: {apart}; \u201cNo collision\u201d was kept"
    assert told["what"].endswith(f"kept by {least:.2f} m")
    assert told["near"]
    assert not told["contact"]
    assert told["before"] is None
    text = re.sub(r"<[^>]+>", "", sheet_html(case_of(NAME)).decode().partition("</style>")[2])
    assert "Near miss: the rule \u201cNo collision\u201d was not broken; it was kept by less than 0.50 m." in text
    assert "Other rules were broken around this time: see page 2." in text
    assert "the same near miss." in text
    assert "missed by" not in text
    assert "collided" not in text


def test_it_has_the_closing_speed_of_its_moment(case_of: CaseOf) -> None:
    log = fixture_log(OVERTAKE / "near_miss.csv")
    case = case_of(NAME)
    at = (case.finding.moment_ns - case.finding.drive_start_ns) / 1e9
    beside = [round(at + shift, 3) for shift in (-0.1, 0.1)]
    by_places = closing_by_places(log["ego"], log["oncoming"], *beside)
    assert case.finding.row["closing_mps"] == pytest.approx(by_places, abs=0.3)


def test_its_id_names_it_and_its_sheet_is_of_the_result(folder: Path, case_of: CaseOf) -> None:
    result, row = load_result(folder), case_of(NAME).finding.row
    again = named_finding(result, row["finding_id"], with_near_misses=True)
    assert (again.row["rule_id"], again.row["drive_id"], again.is_near_miss) == (row["rule_id"], row["drive_id"], True)
    assert f"--incident {row['finding_id']}" in template_values(case_of(NAME))["commands"][1]
    assert row["finding_id"] in possible_sheet_ids(result)
    with pytest.raises(UsageError, match="no near miss has an id"):
        named_finding(result, "near-miss-x", with_near_misses=True)


def test_its_sheet_is_packed(folder: Path, case_of: CaseOf) -> None:
    page = folder / "incidents" / f"{case_of(NAME).finding.row['finding_id']}.html"
    page.parent.mkdir(exist_ok=True)
    page.write_bytes(sheet_html(case_of(NAME)))
    packed = sheets.sheets_of_result(folder, load_result(folder), run_request.load(folder))
    assert packed == {f"data/incidents/{page.name}": page.read_bytes()}
    page.unlink()


def test_a_finding_comes_before_a_near_miss(folder: Path) -> None:
    result = load_result(folder)
    rule = near_misses(result)[0]["rule_id"]
    assert not named_finding(result, rule, with_near_misses=True).is_near_miss
    kept = replace(result, findings=result.findings.slice(0, 0))
    kept = replace(kept, verdicts=kept.verdicts.filter(pc.equal(kept.verdicts["verdict"], "pass")))
    assert named_finding(kept, rule, with_near_misses=True).is_near_miss
    with pytest.raises(UsageError, match="is pass, so it has no finding"):
        named_finding(kept, rule)


def test_other_drives_with_near_misses_are_named(folder: Path) -> None:
    assert other_drives_with_named_finding(IncidentRequest(NAME, folder)) == []
