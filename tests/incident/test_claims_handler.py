"""What a claims handler missed on the sheet of a contact."""

from __future__ import annotations

import html
import re
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pyarrow as pa
import pyarrow.compute as pc
import pytest

from drivelint.drive.trace import TURNED_FRAME_CHECK
from drivelint.incident import sheet_html
from drivelint.incident.conduct import conduct_with_party_name
from drivelint.incident.fitting import UndecidedReason, fit_conduct_lists_and_return_further_pages
from drivelint.incident.judge import EgoRows
from drivelint.incident.place import coordinates_source_text, driving_side_text
from drivelint.incident.sheet import template_values

if TYPE_CHECKING:
    from tests.incident.conftest import CaseOf


@pytest.fixture(scope="module")
def collision(case_of: CaseOf) -> dict[str, Any]:
    return template_values(case_of("no-collision@collision"))


@pytest.fixture(scope="module")
def text(case_of: CaseOf) -> str:
    page = sheet_html(case_of("no-collision@collision")).decode().partition("</style>")[2]
    return html.unescape(re.sub(r"\s+", " ", re.sub(r"<[^>]+>", "", page)))


@pytest.mark.ci
def test_nothing_is_kept_that_the_sheet_contradicts(collision: dict[str, Any], text: str) -> None:
    for party in collision["conduct"]:
        assert not any("ollision" in line or "ithin its lane" in line for line in party["kept"].texts)
    assert "Kept:" not in text


@pytest.mark.ci
def test_both_parties_breaches_have_their_certainty(collision: dict[str, Any]) -> None:
    for party in collision["conduct"]:
        lines = [line for line in party["broken"].texts if ", critical" in line or ", major" in line]
        assert lines
        assert all(re.search(r"(sure|possible), \d+ of \d+$|findings: .*\d (sure|possible)", line) for line in lines)


@pytest.mark.ci
def test_assumed_errors_are_named(text: str) -> None:
    assert "0.1 m in every actor's position, 0.05 s in its clock, 0.1 m in the position of the map" in text
    assert "95% of the copies or more" in text


@pytest.mark.ci
def test_when_the_recording_begins_and_ends(collision: dict[str, Any], case_of: CaseOf, text: str) -> None:
    finding = case_of("no-collision@collision").finding
    before, after = (float(collision["span"][name]) for name in ("before", "after"))
    moment_s = (finding.moment_ns - finding.drive_start_ns) / 1e9
    assert before == pytest.approx(min(15.0, moment_s), abs=0.051)
    assert after == pytest.approx(min(7.0, finding.drive["duration_s"] - moment_s), abs=0.051)
    assert f"from {before} s before to {after} s after" in text
    assert f"The recording lasts {finding.drive['duration_s']:.2f} s" in text
    assert "local time and its zone: not in the log" in text


@pytest.mark.ci
def test_overtake_lanes_and_who_else_was_there(collision: dict[str, Any], text: str) -> None:
    (overtaken,) = re.findall(r"A was overtaking car (\w+), in the oncoming lane; A left its lane", collision["story"])
    assert overtaken not in {party["id"] for party in collision["parties"]}
    ego, other = (party["lane"] for party in collision["parties"])
    assert ego.startswith("centre in the oncoming lane; left its lane at ")
    assert other == "centre in a lane of its direction"
    assert re.search(rf"Others: {overtaken}: car, [\d.]+ x [\d.]+ m, (standing|at [\d.]+ m/s), [\d.]+ m from A", text)


@pytest.mark.ci
def test_no_unit_is_written_in_two_ways(text: str) -> None:
    assert "m/s2" not in text.partition("To check it")[0]


@pytest.mark.slow
def test_each_required_distance_has_its_name_at_its_dot(case_of: CaseOf) -> None:
    told = template_values(case_of("safe-distance-ahead@collision"))
    (chart,) = [chart for chart in told["strips"] if chart["title"].startswith("Gap")]
    limits = [line for line in chart["lines"] if line["kind"] == "limit"]
    assert len({line["label"] for line in limits}) == len(limits) > 1
    assert all(line["labels"] for line in limits)
    assert sum(bool(line["legend"]) for line in limits) == 1


@pytest.mark.ci
def test_a_party_that_was_no_ego_is_not_in_the_report(case_of: CaseOf) -> None:
    case = case_of("no-collision@collision")
    assert [party["in_report"] for party in template_values(case)["conduct"]] == [True, False]
    assert "not examined" in template_values(replace(case, other_party=None))["parties"][1]["lane"]


@pytest.mark.ci
def test_everything_that_was_not_decided_is_told(collision: dict[str, Any], case_of: CaseOf, text: str) -> None:
    """What the log or the map lacks, it lacks for both parties, and is told once."""
    case = case_of("no-collision@collision")
    parts = [*collision["conduct"], collision["of_both"]]
    assert [part["reasons"].more for part in parts] == [0, 0, 0]
    for party, judged in zip(collision["conduct"], (case.ego_rows, case.other_party), strict=True):
        assert isinstance(judged, EgoRows)
        undecided = {row["rule_id"] for row in judged.verdicts if row["verdict"] in {"unknown", "error"}}
        told = " ".join([*party["reasons"].texts, *collision["of_both"]["reasons"].texts])
        titles = [rule["title"] for rule in case.result.rules.to_pylist() if rule["rule_id"] in undecided]
        assert titles
        assert all(f"\u201c{title}\u201d" in told for title in titles)
    shared = [reason.partition(": ")[2] for reason in collision["of_both"]["reasons"].texts]
    assert shared
    assert all(text.count(reason) == 1 for reason in shared)
    assert "Not decided for either party, for the same reasons: " in text


@pytest.mark.ci
def test_warnings_that_do_not_fit_are_counted(case_of: CaseOf) -> None:
    case = case_of("no-collision@collision")
    checks = [{"check_id": "c", "severity": "warning", "message": f"warning {n}: {'word ' * 20}"} for n in range(9)]
    drive = {**case.finding.drive, "quality": [*checks, {**checks[0], "message": "word " * 200}]}
    page = sheet_html(replace(case, finding=replace(case.finding, drive=drive))).decode()
    assert re.search(r"warning 1: [word ]+; and 8 more in report.html", page)
    drive = {**drive, "quality": drive["quality"][-1:]}
    page = sheet_html(replace(case, finding=replace(case.finding, drive=drive))).decode()
    assert "word ... (in full in report.html)</p>" in page


@pytest.mark.ci
def test_contacts_that_do_not_fit_are_counted(case_of: CaseOf) -> None:
    case = case_of("safe-distance-ahead@collision")
    rows = case.result.findings
    touched = rows.filter(pc.is_in(rows["rule_id"], pa.array(["ukhc.contact-signature"])))
    more = replace(case, result=replace(case.result, findings=pa.concat_tables([rows, touched, touched])))
    n = len(template_values(case)["contacts"].texts)
    assert template_values(more)["contacts"].more == n + 2 * touched.num_rows - 2 > 0
    assert f"And {n + 2 * touched.num_rows - 2} more contact" in sheet_html(more).decode()


@pytest.mark.ci
def test_sheet_of_a_clip_prints_the_hash_of_the_log(case_of: CaseOf) -> None:
    case = case_of("no-collision@collision")
    said = "cut from collision.csv, SHA-256 0123abcd: 0.00 s to 9.00 s of it"
    check = {"check_id": "clip", "severity": "info", "message": said}
    drive = {**case.finding.drive, "quality": [*case.finding.drive["quality"], check]}
    page = sheet_html(replace(case, finding=replace(case.finding, drive=drive))).decode()
    assert said in page
    assert "Warnings on the log" not in page  # it is none


@pytest.mark.ci
def test_coordinates_are_the_logs_unless_its_frame_was_turned(case_of: CaseOf) -> None:
    case = case_of("no-collision@collision")
    assert coordinates_source_text(case).startswith("the recording's coordinates")
    assert "turned" not in coordinates_source_text(case)
    check = {"check_id": TURNED_FRAME_CHECK, "severity": "info", "message": "turned"}
    drive = {**case.finding.drive, "quality": [*case.finding.drive["quality"], check]}
    turned = replace(case, finding=replace(case.finding, drive=drive))
    assert (
        coordinates_source_text(turned)
        == "the recording's coordinates with the sign of y changed, as its frame is left-handed"
    )
    assert coordinates_source_text(turned) in html.unescape(sheet_html(turned).decode())
    drive = {**drive, "quality": [*drive["quality"], {**check, "check_id": "clip"}]}
    assert (
        coordinates_source_text(replace(case, finding=replace(case.finding, drive=drive))) == "the clip's coordinates"
    )


@pytest.mark.ci
def test_coordinates_of_a_map_that_was_moved(case_of: CaseOf) -> None:
    case = case_of("no-collision@collision")
    assert case.drive.environment is not None
    tables = case.drive.environment.tables
    place = tables["environment"]
    for name, by in (("offset_x_m", 2.618), ("offset_y_m", -3.113)):
        place = place.set_column(place.column_names.index(name), name, pa.array([by]))
    road = replace(case.drive.environment, tables={**tables, "environment": place})
    moved = coordinates_source_text(replace(case, drive=replace(case.drive, environment=road)))
    assert moved.endswith("(the map was moved by +2.618 m, \u22123.113 m)")


@pytest.mark.parametrize(
    ("source", "is_stated"), [("junctions", True), ("default", True), ("option", False), ("attribute", False)]
)
def test_side_of_the_road_that_nobody_gave(source: str, *, is_stated: bool) -> None:
    told = driving_side_text({"handedness": "lht", "handedness_source": source})
    assert told.startswith("Left-hand traffic: ") is is_stated


@pytest.mark.ci
def test_every_rule_is_counted_and_the_ego_is_named_by_its_letter(collision: dict[str, Any], text: str) -> None:
    for party in collision["conduct"]:
        n = sum(party["n"].values()) + len(party["beside"]) + party["elsewhere"] + party["never"]
        assert n == collision["n_rules"]
        if party["beside"]:
            assert f"{len(party['beside'])} not counted, " in text
    told = text.partition("What each party did")[2].partition("To check it")[0]
    assert "the ego" not in re.sub("\u201c[^\u201d]*\u201d", "", told).lower()
    assert conduct_with_party_name({"kept": ["\u201cOut of the ego's space\u201d: the ego's own"]}, "B")["kept"] == [
        "\u201cOut of the ego's space\u201d: B's own"
    ]


@pytest.mark.parametrize("used_characters", [0, 600, 1200])
def test_what_was_broken_is_told_before_anything_else(used_characters: int) -> None:
    """However much room hashes and warnings take, kept rules and reasons give way first."""
    parties: list[dict[str, Any]] = [
        {
            "broken": [f"{n} " + "b" * 140 for n in range(7)],
            "kept": ["k" * 60] * 7,
            "excused": ["e" * 30] * 3,
            "reasons": [UndecidedReason(f"{n} " + "r" * 80, ("t" * 30,) * 3) for n in range(6)],
        },
        {"broken": ["b" * 140], "kept": ["k" * 60] * 8, "excused": [], "reasons": []},
    ]
    fit_conduct_lists_and_return_further_pages(parties, 2, used_characters)
    assert [told["broken"].more for told in parties] == [0, 0]
    assert (parties[0]["kept"].more > 0) is (used_characters > 0)
