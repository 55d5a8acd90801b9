"""The page's first screen: the line on map and logs, the worst moment with its strips, how sure it is, and what lies beside it."""

from __future__ import annotations

import html
import io
import re
from dataclasses import replace
from datetime import date
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from rich.console import Console

from drivelint.gate import GateInputs
from drivelint.report import terminal
from drivelint.report.html import render
from drivelint.report.html.contact import speeds_before_contact
from drivelint.report.html.moment_charts import LEFT, RIGHT, charts_below_plan_view
from drivelint.report.html.svg import axis_for_deciding_values
from drivelint.report.outputs import working_folder, write
from drivelint.result.model import Result
from tests.report.pages import Parsed, page
from tests.report.synthetic import SECOND, drive, finding, result, rule, verdict

EGO = [{"ego_id": "1", "km": 0.1, "hours": 0.1, "engaged_km": 0.0, "engaged_hours": 0.0, "n_steps": 250}]
OFF = {"ego_id": "1", "signal": "registration", "reason_code": "seldom_on_lane", "reason": "27 of 181 steps on a lane"}
ASSUMED = {
    "check_id": "assumed_motion", "severity": "warning", "actor_id": None, "n": 1, "t_first_ns": None,
    "message": "mapping 'film' assumes speeds; only distances are measured",
}  # fmt: skip
SIZES = {
    **ASSUMED,
    "check_id": "assumed_size",
    "severity": "info",
    "message": "size from the mapping 'm', not recorded",
}
ASIDE = {**ASSUMED, "check_id": "aside_of_lane", "actor_id": "1", "message": "ego 1 keeps 1.10 m beside the middle"}
ONE_OF_FIVE = "1 of 5 egos drive far from the middle of their lanes"
TWO_ASIDE = "2 egos drive far from the middle of their lanes: the map may be shifted: correct it with --map-offset"
WAY = {"ego_id": "1", "km": 1.0, "hours": 0.1, "engaged_km": 1.0, "engaged_hours": 0.1, "n_steps": 9}
WHOLE = "complete, as far as the format .csv shows it"
CONTACT = rule("ukhc.no-collision", tags=["contact"], title="No collision", unit="m")


def plain(markup: str) -> str:
    return " ".join(html.unescape(re.sub(r"<[^>]+>", " ", markup)).replace("\u00a0", " ").split())


def section(text: str, name: str) -> str:
    return text.partition(f'id="{name}"')[2].partition("</section>")[0]


@pytest.mark.parametrize(
    ("run", "line"),
    [
        (
            result([verdict("pass")], drives=[drive(file_name="a.mcap"), drive("d2", file_name="b.parquet")]),
            "map: road.xodr fits 2 of 2 drives | log: complete | not judged: nothing",
        ),
        (result([verdict("pass")]), f"map: road.xodr fits 1 of 1 drive | log: {WHOLE} | not judged: nothing"),
        (
            result([verdict("pass")], drives=[drive(file_name="A.OSI"), drive("d2"), drive("d3", file_name="c.mcap")]),
            "map: road.xodr fits 3 of 3 drives | log: complete, as far as the format .csv, .osi shows it | not judged: nothing",
        ),
        (
            result([verdict("unknown", reason_code="missing_registration")], drives=[drive(exposure=EGO, not_judged=[OFF])]),
            f"map: road.xodr fits 0 of 1 drive (27 of 181 steps on a lane) | log: {WHOLE} | not judged: 1 rule without registration",
        ),
        (
            result(
                [verdict("pass"), verdict("unknown", reason_code="log_hole")],
                drives=[drive(lossy=True, quality=[ASSUMED], map_name=None), drive("d2", status="not_judged", status_reason="x")],
            ),
            "map: none | log: parts lost in d1; mapping 'film' assumes speeds; 1 warning (assumed motion) | not judged: 1 drive; 1 verdict",
        ),
        (
            result([verdict("pass")], drives=[drive(quality=[SIZES]), drive("d2", quality=[SIZES])]),
            f"map: road.xodr fits 2 of 2 drives | log: {WHOLE}; size from the mapping 'm', not recorded | not judged: nothing",
        ),
        (
            result([verdict("pass")], drives=[drive(exposure=[*EGO, EGO[0] | {"ego_id": "2"}], not_judged=[OFF])]),
            f"map: road.xodr fits 1 of 1 drive, but not 1 of 2 egos | log: {WHOLE} | not judged: nothing",
        ),
        (
            result([verdict("pass")], drives=[drive(quality=[ASIDE]), drive("d2")]),
            f"map: road.xodr fits 2 of 2 drives, but ego 1 keeps 1.10 m beside the middle | log: {WHOLE} | not judged: nothing",
        ),
        (
            result([verdict("pass")], drives=[drive(quality=[ASIDE]), drive("d2", quality=[ASIDE])]),
            f"map: road.xodr fits 2 of 2 drives, but {TWO_ASIDE} | log: {WHOLE} | not judged: nothing",
        ),
        (
            result([verdict("pass")], drives=[drive(quality=[ASIDE], exposure=[{**WAY, "ego_id": str(k)} for k in range(5)])]),
            f"map: road.xodr fits 1 of 1 drive, but {ONE_OF_FIVE} | log: {WHOLE} | not judged: nothing",
        ),
        (
            result([verdict("pass")], drives=[drive(name, sha256="same" if name < "d" else name) for name in "abcd"]),
            f"map: road.xodr fits 4 of 4 drives | log: {WHOLE}; copies, counted again: b of a, c of a | not judged: nothing",
        ),
    ],
)  # fmt: skip
def test_page_and_terminal_say_the_same_of_map_and_logs(run: Result, line: str) -> None:
    console = Console(file=io.StringIO(), width=300, force_terminal=False)
    console.print(terminal.render(run, "out", 300))
    printed = console.file.getvalue()  # type: ignore[attr-defined]
    # the terminal's first line has the reason why the map does not fit
    lines = line.replace(f" ({OFF['reason']})", "") if OFF["reason"] in printed.partition("map: ")[0] else line
    assert "\n" + lines.replace(" | ", "\n") + "\n" in printed
    (told,) = re.findall(r'<p class="inputs">(.*?)</p>', page(run), re.DOTALL)
    assert plain(told) == line


def test_a_wrong_map_is_no_green_page() -> None:
    text = page(result([verdict("unknown"), verdict("pass")], drives=[drive(exposure=EGO, not_judged=[OFF])]))
    head = plain(text.partition("<h1>")[2].partition("</header>")[0])
    assert "NOT JUDGED" in head
    assert "exit 4 : the map does not fit 1 of 1 drive: 27 of 181 steps on a lane" in head


def test_drives_that_were_not_judged_were_not_compared() -> None:
    lost = drive("d4", status="not_judged", status_reason="broken", km=0.0, duration_s=None)
    told = Parsed(page(result([verdict("pass")], drives=[drive(), drive("d2"), drive("d3"), lost]))).text
    assert "3 of 4 recorded drives" in told
    assert "1 could not be judged" in told
    assert "4 recorded drives" not in told.replace("3 of 4 recorded drives", "")


def test_the_worst_moment_is_the_contact_with_the_speeds_before_it(overtakes: Result) -> None:
    shown = plain(section(page(overtakes), "worst"))
    rows = [
        r for r in overtakes.findings.to_pylist() if r["rule_id"].split(".")[1] in {"no-collision", "contact-signature"}
    ]
    worst = min(rows, key=lambda r: r["margin"])
    assert f"{worst['observed']:.2f}" in shown
    speeds = re.search(
        r"closing at ([\d.]+) m/s just before the contact; at ([\d.]+) s: (\S+) at ([\d.]+) m/s, (\S+) at ([\d.]+) m/s",
        shown,
    )
    assert speeds
    closing, time_s, *parties = speeds.groups()
    assert closing == f"{worst['closing_mps']:.2f}"
    (scene,) = [
        s
        for s in overtakes.scenes.to_pylist()
        if (s["drive_id"], s["t_ns"]) == (worst["drive_id"], worst["t_worst_ns"])
    ]
    ways = {a["actor_id"]: a["path"] for a in scene["actors"]}
    start = overtakes.start_times[worst["drive_id"]] or 0
    at = start + round(float(time_s) * 1e9)
    assert at < worst["t_start_ns"] <= at + SECOND
    for who, said in (parties[:2], parties[2:]):
        t = np.array([p["t_ns"] for p in ways[who]])
        i = int(np.flatnonzero(t == at)[0])
        x, y = (np.array([p[axis] for p in ways[who]]) for axis in ("x_m", "y_m"))
        moved = np.hypot(x[i] - x[i - 1], y[i] - y[i - 1]) / (t[i] - t[i - 1]) * 1e9
        assert float(said) == pytest.approx(moved, abs=0.3)
    # head on: the speeds add up
    assert float(closing) == pytest.approx(float(parties[1]) + float(parties[3]), abs=0.3)
    assert "at 0.0 m/s" not in shown


def test_long_after_the_contact_began_nothing_is_said_of_the_speeds_before_it() -> None:
    path = [{"t_ns": (100 + k) * SECOND, "x_m": float(k), "y_m": 0.0, "speed_mps": 1.0} for k in range(6)]
    scene = {"actors": [{"actor_id": "1", "path": path}, {"actor_id": "3", "path": path}]}
    assert speeds_before_contact(scene, finding(t_start_ns=104 * SECOND, closing_mps=None), 100 * SECOND) is not None
    assert speeds_before_contact(scene, finding(t_start_ns=110 * SECOND), 100 * SECOND) is None
    assert speeds_before_contact(scene, finding(t_start_ns=99 * SECOND), 100 * SECOND) is None
    assert speeds_before_contact(scene, finding(object_id=None), 100 * SECOND) is None


def test_the_strips_draw_what_the_scene_and_the_course_have(overtakes: Result) -> None:
    row = next(r for r in overtakes.findings.to_pylist() if r["rule_id"] == "ukhc.r126.ds-av-out-of-ov")
    (scene,) = [
        s for s in overtakes.scenes.to_pylist() if (s["drive_id"], s["t_ns"]) == (row["drive_id"], row["t_worst_ns"])
    ]
    course = next(c for c in overtakes.courses.to_pylist() if c["finding_id"] == row["finding_id"])
    drawn = charts_below_plan_view(scene, row, course, "reach", overtakes.start_times[row["drive_id"]] or 0)
    assert drawn is not None
    assert [s["title"].partition(" ")[0] for s in drawn["strips"]] == ["speed", "acceleration", "offset", "reach"]
    way = scene["actors"][0]["path"]
    t, v = (np.array([p[name] for p in way]) for name in ("t_ns", "speed_mps"))
    (d,) = [d for kind, d in drawn["strips"][0]["lines"] if kind == "ego"]
    x, y = np.array(re.findall(r"(-?[\d.]+),(-?[\d.]+)", d), float).T
    np.testing.assert_allclose(x, LEFT + (t - t[0]) / (t[-1] - t[0]) * (RIGHT - LEFT), atol=0.06)
    assert np.corrcoef(-y, v)[0, 1] > 0.999
    assert f"observed {row['observed']:.2f}, required {row['required']:.2f}" == drawn["strips"][-1]["at_worst"]
    assert drawn["strips"][-1]["spans"]


def test_a_chart_shows_the_margin_that_decides() -> None:
    axis, cut = axis_for_deciding_values([-47.0, -20.0, 0.58, 0.3], [0.58, 0.0], 100.0, 0.0)
    assert abs(axis.at(0.58) - axis.at(0.0)) > 20
    assert cut == [-47.0]
    whole, none = axis_for_deciding_values([-1.0, 0.58], [0.58, 0.0], 100.0, 0.0)
    assert none == []
    assert whole.low < -1 < 0.58 < whole.high
    assert axis_for_deciding_values([1.0, 2.0], [], 100.0, 0.0)[1] == []


def test_a_finding_that_few_copies_keep_is_only_possible() -> None:
    rows = [
        finding(rule_id="ukhc.no-collision", profile=None, n_copies=100, n_stays=53, finding_id="a"),
        finding(n_copies=100, n_stays=97, finding_id="b"),
    ]
    text = page(result([verdict("fail")], rows, rules=[rule(), CONTACT]))
    told = Parsed(text).text
    assert "A contact is possible:" in told
    assert "The recording shows a contact" not in told
    assert "1 of 2 findings only possible" in told
    assert "possible: it is also a finding in only 53 of 100 copies of the drive" in plain(
        section(text, "worst")
    ).replace("possible :", "possible:")
    table = plain(section(text, "findings"))
    assert "possible, 53 of 100" in table
    assert "sure, 97 of 100" in table
    assert '<select name="sure">' in text
    untested = page(result([verdict("fail")], [finding(rule_id="ukhc.no-collision")], rules=[rule(), CONTACT]))
    assert "not tested" in plain(section(untested, "worst"))
    assert "The recording shows a contact" in Parsed(untested).text


def test_how_sure_a_near_miss_is_was_not_examined() -> None:
    near = verdict("pass", near_miss=True)
    alone = page(result([near], rules=[rule()]))
    assert "how sure not examined: only findings are examined, and this is a near miss" in plain(
        section(alone, "worst")
    )
    both = page(result([verdict("fail"), near], [finding(n_copies=100, n_stays=97)], rules=[rule()]))
    assert "not examined" in plain(section(both, "findings"))


def test_a_near_miss_names_the_command_of_its_sheet(tmp_path: Path) -> None:
    run = result([verdict("pass", near_miss=True)])
    write(run, tmp_path)
    name = "{rule_id}@{drive_id}".format(**run.verdicts.to_pylist()[0])
    shown = plain(section((tmp_path / "report.html").read_text(), "worst"))
    assert f"drivelint explain {name} --in . drivelint report . --incident {name}" in " ".join(shown.split())


def test_findings_are_sorted_by_severity_then_contact_then_margin() -> None:
    rows = [
        finding(finding_id="minor", severity="minor", margin=-99.0),
        finding(finding_id="little", margin=-1.0),
        finding(finding_id="much", margin=-2.0),
        finding(finding_id="contact", rule_id="ukhc.no-collision", margin=-0.1),
    ]
    text = page(result([verdict("fail")], rows, rules=[rule(), CONTACT]))
    assert re.findall(r'href="#finding-(\w+)"', section(text, "findings")) == ["contact", "much", "little", "minor"]


def test_what_a_baseline_lets_through_is_not_the_worst_moment() -> None:
    old, new = finding(finding_id="old", margin=-9.0), finding(finding_id="new", margin=-1.0, occurrence=1)
    before = result([verdict("fail")], [old])
    run = GateInputs(date(2026, 11, 20), before, "main").apply_to(result([verdict("fail")], [old, new]))
    shown = section(page(run), "worst")
    assert "The worst moment among the new findings" in plain(shown)
    assert 'href="#finding-new"' in shown


def test_what_lies_beside_the_page_is_linked_only_if_it_is_there(tmp_path: Path) -> None:
    run = result([verdict("fail")], [finding(finding_id="abc")])
    write(run, tmp_path)
    assert not [
        h for h in Parsed((tmp_path / "report.html").read_text()).values("href") if h[0] != "#" and h != "data:,"
    ]
    for name in ("annotated/d1.mcap", "incidents/abc.html"):
        (tmp_path / name).parent.mkdir()
        (tmp_path / name).touch()
    write(run, tmp_path)
    links = Parsed((tmp_path / "report.html").read_text()).values("href")
    assert {"annotated/d1.mcap", "incidents/abc.html"} <= set(links)
    assert "drivelint explain abc --in ." in plain(section((tmp_path / "report.html").read_text(), "worst"))


def test_what_an_earlier_run_left_beside_the_page_is_not_linked(tmp_path: Path) -> None:
    run = result([verdict("fail")], [finding(finding_id="abc")])
    write(run, tmp_path / "fresh")
    (tmp_path / "again" / "annotated").mkdir(parents=True)
    (tmp_path / "again" / "annotated" / "d1.mcap").touch()
    with working_folder(tmp_path / "again", overwrite=True) as work:
        write(run, tmp_path / "again", work, overwrite=True)
    assert (tmp_path / "again" / "report.html").read_bytes() == (tmp_path / "fresh" / "report.html").read_bytes()


def test_a_contact_names_the_command_of_its_sheet_and_both_its_times() -> None:
    times = {"t_start_ns": 111 * SECOND, "t_worst_ns": 112 * SECOND, "t_end_ns": 113 * SECOND}
    touch = finding(rule_id="ukhc.no-collision", profile=None, finding_id="abc", unit="m", **times)
    run = result([verdict("fail")], [touch], rules=[rule(), CONTACT])
    shown = plain(section(page(run), "worst"))
    assert "drivelint report . --incident abc" in shown
    assert "11.00 s (deepest at 12.00 s)" in shown
    alone = render(run, in_result_folder=False).decode()
    assert "--in ." not in plain(section(alone, "worst")), "a page beside no result has no command for its folder"


def test_a_safe_distance_without_end_is_no_number(overtakes: Result) -> None:
    rows = overtakes.overtakes.to_pylist()
    far = {"sda_m": 265062.45, "spare_m": 30.0 - 265062.45}
    rows[0]["profiles"] = [rows[0]["profiles"][0] | far, *rows[0]["profiles"][1:]]
    text = page(replace(overtakes, overtakes=pa.Table.from_pylist(rows, schema=overtakes.overtakes.schema)))
    told = plain(section(text, "overtakes"))
    assert "265062" not in told
    assert "265032" not in told
    assert "needs more than 2.00 km: the ego is hardly faster than the vehicle that it passes" in told
    ticks = re.findall(r'text-anchor="middle">(\d+)</text>', text.partition('class="zones"')[2].partition("</svg><")[0])
    assert max(map(int, ticks[:7])) < 1000, "one overtake does not shrink the plot of all others"


def test_passing_an_obstruction_names_the_vehicle_that_came(overtakes: Result) -> None:
    rows = [r for r in overtakes.findings.to_pylist() if r["rule_id"] == "ukhc.r163.obstruction-give-way"]
    assert rows
    for row in rows:
        assert row["object_id"] == "parked"
        assert "oncoming" in row["reason"]


SIGNATURE = rule(rule_id="ukhc.contact-signature", title="No contact in the speeds", tags=["contact"])


def one_contact_by_two_rules(**signature: Any) -> Result:
    """Return a result with a contact that the boxes only possibly show, and the speeds surely, unless told otherwise."""
    boxes = finding(
        rule_id="ukhc.no-collision",
        profile=None,
        n_copies=100,
        n_stays=61,
        margin=-9.0,
        finding_id="boxes",
        closing_mps=-0.3,
    )
    speeds = {"margin": -4.0, "n_copies": 32, "n_stays": 32, "finding_id": "speeds", "closing_mps": 10.43, **signature}
    found = [boxes, finding(rule_id="ukhc.contact-signature", profile=None, **speeds)]
    return result([verdict("fail")], found, rules=[rule(), CONTACT, SIGNATURE])


def test_a_contact_is_as_sure_as_its_surest_finding() -> None:
    run = one_contact_by_two_rules()
    text = page(run)
    worst = plain(section(text, "worst"))
    assert "No contact in the speeds" in worst
    assert "sure : it is also a finding in 32 of 32 copies" in worst
    assert "the same contact is only possible by ukhc.no-collision, in 61 of 100 copies" in worst
    assert "the contact itself is sure by ukhc.contact-signature, in 32 of 32 copies" in text
    told = plain(text)
    assert "closing at 10.43 m/s" in told
    assert "possibly ego" not in told
    console = Console(file=io.StringIO(), width=160, force_terminal=False)
    console.print(terminal.render(run, "out", 160))
    assert "CONTACT object" in console.file.getvalue()  # type: ignore[attr-defined]
    assert "possible contact" not in console.file.getvalue()  # type: ignore[attr-defined]
    assert "; CONTACT in 1" in console.file.getvalue()  # type: ignore[attr-defined]


def test_contacts_at_other_times_say_nothing_of_each_other() -> None:
    later = 200 * SECOND
    text = page(one_contact_by_two_rules(t_start_ns=later, t_worst_ns=later, t_end_ns=later))
    assert "the contact itself is sure" not in text
    assert "the same contact is only possible" not in text


def test_parties_that_draw_apart_are_said_to() -> None:
    run = one_contact_by_two_rules(closing_mps=-0.3)
    console = Console(file=io.StringIO(), width=160, force_terminal=False)
    console.print(terminal.render(run, "out", 160))
    for text in (plain(page(run)), console.file.getvalue()):  # type: ignore[attr-defined]
        assert "moving apart at 0.30 m/s" in text
        assert "closing at" not in text


def test_the_page_says_how_large_the_errors_are() -> None:
    text = plain(page(one_contact_by_two_rules()))
    assert (
        "assumed errors (0.1 m in every actor's position, 0.05 s in its clock, 0.1 m in the position of the map)"
        in text
    )
