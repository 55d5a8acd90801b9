"""The incident sheet says what the log says: its numbers are computed again from the log alone."""

from __future__ import annotations

import math
import re
import shlex
import shutil
import sys
from cmath import phase
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pytest
from markupsafe import escape

from drivelint import catalogue, cli
from drivelint.drive.finish import with_quality_finding
from drivelint.drive.trace import ASSUMED_SIZE_CHECK, QualityFinding
from drivelint.errors import UsageError
from drivelint.incident import (
    IncidentRequest,
    judge_parties_again,
    other_drives_with_named_finding,
    sheet_html,
    write_sheet,
)
from drivelint.incident.command import reproducing_commands
from drivelint.incident.finding import named_finding
from drivelint.incident.motion import MotionOfParties
from drivelint.incident.sheet import _contact_by_speed_change_sentence, template_values
from drivelint.incident.sizes import size_source_text
from drivelint.report.outputs import write
from drivelint.report.progress import Silent
from drivelint.result.load import load_result
from drivelint.run import CheckOptions
from drivelint.run import check as run_check
from tests.explain.overtake_check import OVERTAKE, check
from tests.incident.recorded import carla_log, closing_by_places, fixture_log, gap
from tests.shared_data import shared

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from tests.incident.conftest import CaseOf
    from tests.incident.recorded import Log


@pytest.fixture(scope="module")
def collision(case_of: CaseOf) -> dict[str, Any]:
    return template_values(case_of("no-collision@collision"))


@pytest.fixture(scope="module")
def recorded() -> Log:
    return fixture_log(OVERTAKE / "collision.csv")


def first_contact(log: Log) -> float:
    """Return the first time at which the boxes of ego and oncoming car overlap, from the log alone."""
    return min(t for t in log["ego"] if log["ego"][t].box.intersection(log["oncoming"][t].box).area > 0)


def numbers(text: str) -> list[float]:
    return [float(n) for n in re.findall(r"-?\d+(?:\.\d+)?", text)]


@pytest.mark.ci
def test_contact_is_where_the_boxes_first_overlap(collision: dict[str, Any], recorded: Log) -> None:
    assert collision["contact"]
    assert collision["when"] == f"{first_contact(recorded):.2f} s"
    assert collision["rests"] == ""


@pytest.mark.ci
def test_speeds_are_those_before_the_contact(collision: dict[str, Any], recorded: Log) -> None:
    at = round(first_contact(recorded) - 0.1, 3)
    for party, actor in zip(collision["parties"], ("ego", "oncoming"), strict=True):
        v = recorded[actor][at].speed
        assert v > 1  # at the contact itself they stand
        assert party["id"] == actor
        assert numbers(party["speed"])[0] == pytest.approx(v, abs=0.051)
        assert numbers(party["speed"])[1] == pytest.approx(v * 3.6, abs=0.51)
        assert numbers(party["speed"])[2] == pytest.approx(v / 0.44704, abs=0.51)
    assert numbers(collision["gap"])[0] == pytest.approx(gap(recorded["ego"][at], recorded["oncoming"][at]), abs=0.006)
    before = round(at - 0.1, 3)
    by_places = closing_by_places(recorded["ego"], recorded["oncoming"], before, at)
    assert numbers(collision["closing"])[0] == pytest.approx(by_places, abs=0.3)


@pytest.mark.ci
def test_table_second_by_second(collision: dict[str, Any], recorded: Log) -> None:
    contact = first_contact(recorded)
    rows = [row for row in collision["seconds"] if not row["last_before"]]
    assert [row["t"] for row in rows] == [float(t) for t in range(-int(contact), 3)]
    for row in rows:
        t = round(contact + row["t"], 3)
        ego, other = recorded["ego"][t], recorded["oncoming"][t]
        assert row["drive_s"] == pytest.approx(t)
        assert row["speed"] == pytest.approx([ego.speed, other.speed], abs=1e-6)
        if (apart := gap(ego, other)) > 0:
            assert row["gap"] == pytest.approx(apart, abs=1e-6)
        else:
            assert row["gap"] < 0
        if t >= 1.2:
            earlier = round(t - 1, 3)
            means = [recorded[who][t].speed - recorded[who][earlier].speed for who in ("ego", "oncoming")]
            assert row["accel"] == pytest.approx(means, abs=1e-6)
        # the road of the fixture runs east, its lanes are 3.5 m wide and the ego's middle lies at y = 1.75 m
        assert row["offset"] == pytest.approx([ego.y - 1.75, other.y - 1.75], abs=0.02)


@pytest.mark.slow
def test_both_parties_are_judged_as_ego(case_of: CaseOf) -> None:
    """The other party's conduct is what a check with --ego of that party says."""
    case = case_of("no-collision@collision")
    settings: dict[str, Any] = {"traces": (str(OVERTAKE / "collision.csv"),), "profiles": ("relaxed", "nominal")}
    settings |= {"map": OVERTAKE / "road.xodr", "mapping": str(OVERTAKE / "mapping.toml")}
    settings |= {"rules": ("ukhc", "ukhc.r112.horn", "ukhc.r113.headlights")}
    result = run_check(CheckOptions(**settings, ego="oncoming"), Silent())
    assert not isinstance(case.other_party, str)
    assert case.other_party is not None
    assert case.other_party.verdicts == result.verdicts.to_pylist()
    told = template_values(case)["conduct"]
    assert [party["id"] for party in told] == ["ego", "oncoming"]
    failed = len(set(result.findings["rule_id"].to_pylist()))
    assert told[1]["n"]["broken"] == failed > 0
    assert any("No collision" in line for line in told[1]["broken"].texts)
    total = sum(told[1]["n"].values()) + told[1]["never"]
    assert total == result.rules.num_rows


@pytest.mark.ci
def test_it_says_that_the_log_gives_the_same_finding(collision: dict[str, Any]) -> None:
    assert collision["again"]["finding_id"] == collision["row"]["finding_id"]


@pytest.mark.slow
def test_commands_give_the_same_sheet_again(
    case_of: CaseOf, collision: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("collision.csv", "road.xodr", "mapping.toml"):
        shutil.copy(OVERTAKE / name, tmp_path / name)
    monkeypatch.chdir(tmp_path)
    for command in collision["commands"]:
        monkeypatch.setattr(sys, "argv", shlex.split(command))
        with pytest.raises(SystemExit):
            cli.main()
    written = list((tmp_path / "again" / "incidents").iterdir())
    assert [file.name for file in written] == [f"{collision['row']['finding_id']}.html"]
    assert written[0].read_bytes() == sheet_html(
        case_of("no-collision@collision")
    )  # files are named without their folders


@pytest.mark.ci
def test_the_shortest_selection_of_rules(case_of: CaseOf) -> None:
    case = case_of("no-collision@collision")
    stable = case.result.rules["rule_id"].to_pylist()

    def selected(asked_for: list[str], named_rule_ids: Sequence[str] = ()) -> list[str]:
        words = shlex.split(reproducing_commands(case.run_options, case.finding, asked_for, named_rule_ids)[0])
        return [word for i, word in enumerate(words) if {"--rules", "--ignore"} & {word, words[i - 1]}]

    ukhc = {rule.id for rule in catalogue.load_rules().values() if rule.pack == "ukhc" and rule.status == "stable"}
    assert selected(sorted(ukhc)) == []
    assert selected(sorted(ukhc - {"ukhc.no-collision"})) == ["--ignore", "ukhc.no-collision"]
    assert selected(stable[:1]) == ["--rules", stable[0]]
    horn = selected(sorted(ukhc), ["ukhc.r112.horn", "ukhc.no-collision"])
    by_id = ["--rules", "ukhc,status:stable", "--rules", "ukhc.r112.horn"]
    assert horn == by_id, "if a rule is not selected by its id, it does not apply to a log without its signal"


@pytest.mark.ci
def test_what_happened_in_a_sentence(collision: dict[str, Any], recorded: Log) -> None:
    at = round(first_contact(recorded) - 0.1, 3)
    ego, other = recorded["ego"][at], recorded["oncoming"][at]
    assert (
        f"A, a car, at {ego.speed:.1f} m/s; B, a car, at {other.speed:.1f} m/s; head-on, closing at"
        in collision["story"]
    )
    first, closing = first_contact(recorded), ego.speed + other.speed
    told = re.fullmatch(
        r"A and B collided head-on at ([\d.]+) s, A in the oncoming lane, closing at ([\d.]+) m/s", collision["title"]
    )
    assert told is not None, collision["title"]
    assert [float(n) for n in told.groups()] == pytest.approx([first, closing], abs=0.3)
    left = re.search(r"A left its lane at ([\d.]+) s with ([\d.]+) m between the boxes", collision["story"])
    assert left is not None
    t, free = (float(n) for n in left.groups())
    # the line in the middle of the road is y = 0; 5 cm over it count
    over = min(t for t, state in recorded["ego"].items() if state.box.bounds[1] < -0.05)
    assert t == pytest.approx(over, abs=0.11)
    assert free == pytest.approx(gap(recorded["ego"][round(t, 3)], recorded["oncoming"][round(t, 3)]), abs=0.006)


@pytest.mark.ci
def test_rules_are_quoted_and_lay_no_blame(case_of: CaseOf) -> None:
    """A title is true where its rule is kept: unquoted, "rule broken: No collision" reads as none."""
    page = sheet_html(case_of("no-collision@collision")).decode()
    text = re.sub(r"<[^>]+>", "", page)
    assert "rule broken: \u201cNo collision\u201d" in text
    assert re.search(r"(?<!\u201c)No collision", text.partition("</style>")[2].partition("Incident sheet")[2]) is None
    assert "not who is at fault" in text
    assert "Rules of: UK Highway Code, in whatever country" in text
    assert "required 0.00 m" not in text


@pytest.mark.ci
def test_who_was_only_hit(collision: dict[str, Any]) -> None:
    told = {party["id"]: party["only_hit"] for party in collision["conduct"]}
    assert told["ego"] is False
    assert all(certain in " ".join(collision["conduct"][0]["broken"].texts) for certain in ("; sure,", " of "))


@pytest.mark.ci
def test_nobody_is_said_to_have_braked_by_the_crash(collision: dict[str, Any]) -> None:
    lines = [line for party in collision["conduct"] for line in party["broken"].texts]
    assert not any("braked" in line for line in lines)


@pytest.mark.ci
def test_sizes_that_the_log_does_not_have(case_of: CaseOf) -> None:
    case = case_of("no-collision@collision")
    trace, said = case.drive.trace, "size from the mapping 'mapping', not recorded"
    assert [size_source_text(trace, who) for who in case.finding.parties] == [said] * 2
    assert sheet_html(case).decode().count(str(escape(said))) == 2
    tables = trace.tables["quality"]
    recorded = replace(
        trace, tables={**trace.tables, "quality": tables.filter(pc.field("check_id") != ASSUMED_SIZE_CHECK)}
    )
    by_user = with_quality_finding(recorded, QualityFinding(ASSUMED_SIZE_CHECK, "info", "said", actor_id="ego"))
    assert [size_source_text(by_user, who) for who in ("ego", "other")] == ["said", ""]


@pytest.mark.ci
def test_a_clip_says_so(case_of: CaseOf) -> None:
    case = case_of("no-collision@collision")
    drive = {**case.finding.drive, "file_name": "collision-clip-0a1b2c3d.mcap"}
    page = sheet_html(replace(case, finding=replace(case.finding, drive=drive))).decode()
    assert "of a clip that was cut from the log collision" in page
    assert "of a clip" not in sheet_html(case).decode()


@pytest.mark.slow
def test_same_case_same_bytes(folder: Path, case_of: CaseOf) -> None:
    name = "safe-distance-ahead@collision"
    assert sheet_html(judge_parties_again(IncidentRequest(name, folder))) == sheet_html(case_of(name))


@pytest.mark.slow
def test_required_distance_is_drawn(case_of: CaseOf) -> None:
    told = template_values(case_of("safe-distance-ahead@collision"))
    assert not told["contact"]
    (chart,) = [chart for chart in told["strips"] if chart["title"].startswith("Gap")]
    required = [line["name"] for line in chart["lines"] if line["kind"] == "limit"]
    assert "required: \u201cSafe distance ahead before overtaking\u201d (planned as nominal)" in required
    assert "Contact" not in told["what"]
    assert told["contacts"].texts  # the same two touch later in that drive


@pytest.mark.ci
@pytest.mark.parametrize(("stays", "certainty"), [(None, "not examined"), (53, "<b>possible</b>"), (99, "<b>sure</b>")])
def test_certainty_is_told(case_of: CaseOf, stays: int | None, certainty: str) -> None:
    case = case_of("no-collision@collision")
    row = {**case.finding.row, "n_copies": None if stays is None else 100, "n_stays": stays}
    alone = replace(case.result, findings=case.result.findings.slice(0, 0))
    surest = sheet_html(replace(case, finding=replace(case.finding, row=row))).decode()
    assert ("the contact is <b>sure</b> by" in surest) is (stays == 53)  # as the speeds say
    assert "Possible contact" not in surest
    assert "A and B collided head-on" in surest
    case = replace(case, result=alone)
    page = sheet_html(replace(case, finding=replace(case.finding, row=row))).decode()
    assert certainty in page
    assert (f"{stays} of 100 copies" in page) is (stays is not None)
    assert ("Possible contact" in page) is (stays == 53)
    assert ("A and B may have collided head-on" in page) is (stays == 53)


@pytest.mark.ci
def test_the_worst_contact_needs_no_name(folder: Path) -> None:
    result = load_result(folder)
    found = named_finding(result, "contact")
    assert found.is_contact
    assert found.drive["drive_id"].startswith("collision")
    assert named_finding(result, f"contact@{found.drive['drive_id']}").row == found.row
    assert other_drives_with_named_finding(IncidentRequest("contact", folder)) == []
    with pytest.raises(UsageError, match="no finding is a contact in safe"):
        named_finding(result, "contact@safe")


@pytest.mark.ci
def test_a_result_without_a_contact_names_its_nearest_miss(folder: Path) -> None:
    result = load_result(folder)
    nothing = result.findings.slice(0, 0)
    calm = replace(result, findings=nothing, verdicts=result.verdicts.filter(pc.invert(result.verdicts["near_miss"])))
    with pytest.raises(UsageError, match=r"nothing was found there that a sheet could be about$"):
        named_finding(calm, "contact")
    row = next(row for row in result.verdicts.to_pylist() if row["rule_id"] == "ukhc.no-collision")
    just_kept = pa.Table.from_pylist([{**row, "near_miss": True, "margin": 0.46}], schema=result.verdicts.schema)
    with pytest.raises(UsageError, match=rf"report {folder} --incident ukhc.no-collision@{row['drive_id']}$"):
        named_finding(replace(result, findings=nothing, verdicts=just_kept), "contact")


@pytest.mark.ci
def test_a_verdict_that_is_no_finding(folder: Path) -> None:
    with pytest.raises(UsageError, match=r"is pass, so it has no finding: .* failed there \(ukhc\."):
        judge_parties_again(IncidentRequest("no-collision@safe", folder))


@pytest.mark.ci
def test_pdf_without_a_browser(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda _name: None)
    with pytest.raises(UsageError, match="install chromium"):
        write_sheet(IncidentRequest("no-collision@collision", folder, pdf=True))


@pytest.mark.slow
def test_a_log_that_is_gone(tmp_path: Path) -> None:
    """Without the log, the kept database does; without both, the error says what to give."""
    log = tmp_path / "collision.csv"
    shutil.copy(OVERTAKE / "collision.csv", log)
    out = tmp_path / "kept"
    for keep in (True, False):
        check(out, traces=(str(log),), rules=("ukhc.no-collision",), params=(), keep_db=keep)
        if not keep:
            (out / "drivelint.duckdb").unlink(missing_ok=True)
        moved = log.rename(tmp_path / "moved.csv")
        request = IncidentRequest("no-collision", out)
        if keep:
            assert template_values(judge_parties_again(request))["again"] is not None
        else:
            with pytest.raises(UsageError, match="--trace FILE"):
                judge_parties_again(request)
            assert (
                template_values(judge_parties_again(IncidentRequest("no-collision", out, trace=moved)))["again"]
                is not None
            )
        moved.rename(log)


@pytest.mark.slow
def test_case_study_before_the_impact(tmp_path: Path) -> None:
    log = shared("overtake_case_study/collision.csv")
    road = shared("overtake_case_study/t_junction.xodr")
    options = CheckOptions(
        (str(log),),
        map=road,
        mapping="carla-testbench",
        rules=("ukhc.contact-signature", "ukhc.no-collision"),
        out=tmp_path,
        robustness=False,
    )
    write(run_check(options, Silent()), tmp_path)
    case = judge_parties_again(IncidentRequest("contact-signature", tmp_path))
    told = template_values(case)
    recorded = carla_log(log)
    # within one step both lose far more speed than a tyre can brake
    lost = {t: recorded["3"][round(t - 0.1, 3)].speed - recorded["3"][t].speed for t in recorded["3"] if t > 1}
    impact = max(lost, key=lambda t: lost[t])
    before = round(impact - 0.1, 3)
    assert told["when"] == f"{impact:.2f} s"
    for party in told["parties"]:
        assert numbers(party["speed"])[0] == pytest.approx(recorded[party["id"]][before].speed, abs=0.051)
    for party in told["parties"]:
        mine = recorded[party["id"]]
        # magnitudes alone would hide that both were thrown back
        changes = {t: math.hypot(s.vx - mine[before].vx, s.vy - mine[before].vy) for t, s in mine.items()}
        most = max((t for t in changes if before < t < impact + 0.31), key=lambda t: changes[t])
        assert numbers(party["delta_v"])[0] == pytest.approx(changes[most], abs=0.051)
        first, last = complex(mine[before].vx, mine[before].vy), complex(mine[most].vx, mine[most].vy)
        degrees = abs(math.degrees(phase(last / first)))
        assert party["delta_v"].endswith(
            f"from \u22120.10 s to {'0 s' if most == impact else f'+{most - impact:.2f} s'}: "
            f"{abs(first):.1f} to {abs(last):.1f} m/s, direction changed by {degrees:.0f}\u00b0"
        )
        assert changes[impact] > abs(mine[before].speed - mine[impact].speed) + 1
    assert "of the speed alone" in told["what"]
    by_places = closing_by_places(recorded["1"], recorded["3"], round(before - 0.1, 3), before)
    assert numbers(told["closing"])[0] == pytest.approx(by_places, abs=0.3)
    least = min((gap(recorded["1"][t], recorded["3"][t]), t) for t in recorded["1"] if t in recorded["3"])
    assert told["least"] == f"{least[0]:.2f} m at {least[1]:.2f} s"
    at_it = min(gap(recorded["1"][t], recorded["3"][t]) for t in recorded["1"] if before - 0.05 < t < impact + 0.15)
    assert told["rests"].startswith("It is based on a sudden change of speed: the boxes do not touch at that time")
    assert numbers(told["rests"])[0] == round(at_it, 2)
    assert "sizes are assumed, not recorded" in told["rests"]
    motion = MotionOfParties.of_steps(case.ego_rows.steps, case.finding.moment_ns)
    unknown = np.full_like(motion.gap, np.nan)
    assert "whether the boxes touch is not known (no gap is known" in _contact_by_speed_change_sentence(
        case, replace(motion, gap=unknown)
    )
    one = np.where(motion.t == 0, motion.gap, unknown)
    assert "whether the boxes touch is not known (least gap" in _contact_by_speed_change_sentence(
        case, replace(motion, gap=one)
    )
    assert _contact_by_speed_change_sentence(case, replace(motion, gap=np.zeros_like(motion.gap))) == "", "they touch"


@pytest.mark.ci
def test_a_rule_that_several_drives_broke_is_said_to_mean_the_worst(folder: Path) -> None:
    """A sheet of another drive than the one that was meant must not be filed unseen."""
    every = load_result(folder).findings.select(["rule_id", "drive_id", "finding_id"]).to_pylist()
    drives = {row["drive_id"] for row in every if row["rule_id"] == "ukhc.r162.safe-distance-ahead"}
    assert len(drives) > 1
    others = other_drives_with_named_finding(IncidentRequest("safe-distance-ahead", folder))
    assert len(others) == len(drives) - 1
    assert set(others) < drives
    assert other_drives_with_named_finding(IncidentRequest("safe-distance-ahead@collision", folder)) == []
    assert other_drives_with_named_finding(IncidentRequest(every[0]["finding_id"], folder)) == []
