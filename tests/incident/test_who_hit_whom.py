"""How the sheet names the parties and their directions: head-on only for those who are in each other's way."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pytest

from drivelint.errors import UsageError
from drivelint.incident import sheet_html
from drivelint.incident.conduct import text_with_party_names
from drivelint.incident.finding import named_finding
from drivelint.incident.motion import MotionOfParties
from drivelint.incident.place import driving_side_text, simulator_text
from drivelint.incident.sheet import template_values
from drivelint.incident.words import collision_title, story_sentence
from drivelint.result.load import load_result
from tests.incident.straight import STEP_S, steps

if TYPE_CHECKING:
    from pathlib import Path

    from tests.incident.conftest import CaseOf

AT = 20


def passing(ahead_m: float, left_m: float, other_yaw_rad: float = np.pi, other_mps: float = 5.0) -> MotionOfParties:
    """Return an ego at 5 m/s and another car, which at step `AT` is `ahead_m` ahead and `left_m` to the left; boxes of 4 m by 2 m."""
    n = AT + 1
    v, x = np.full(n, 5.0), 5.0 * STEP_S * np.arange(n)
    vx = other_mps * np.cos(other_yaw_rad)
    table = steps(v, x, x[AT] + ahead_m - vx * STEP_S * AT, vx)
    turned = {
        "object_y_m": left_m, "object_yaw_rad": other_yaw_rad, "heading_diff_rad": other_yaw_rad, "object_speed_mps": other_mps,
    }  # fmt: skip
    for name, value in turned.items():
        table = table.set_column(table.column_names.index(name), name, pa.array(np.full(n, value)))
    return MotionOfParties.of_steps(table, int(AT * STEP_S * 1e9))


def title(
    motion: MotionOfParties, kinds: tuple[str | None, str | None] = ("car", "car"), *, oncoming: bool = False
) -> str:
    return collision_title(
        motion,
        AT,
        party_kinds=kinds,
        time_text="2.00 s",
        closing_mps=float(motion.closing[AT]),
        is_in_oncoming_lane=oncoming,
        is_only_possible=False,
    )


@pytest.mark.parametrize(
    ("ahead_m", "left_m", "yaw_rad", "how"),
    [
        (4.5, 0.5, np.pi, "head-on"),
        (4.5, 1.9, np.pi, "head-on"),
        (4.5, 2.1, np.pi, "in opposite directions"),
        (3.0, -2.1, np.pi, "side by side in opposite directions"),
        (-1.0, 2.5, np.radians(153.0), "side by side in opposite directions"),
        (4.5, 0.5, np.radians(153.0), "head-on"),
        (1.0, 2.2, 0.0, "side by side in the same direction"),
        (4.5, 0.2, 0.0, "in the same direction"),
        (4.5, 2.2, np.pi / 2, "at 90\u00b0 to each other"),
    ],
)
def test_only_those_in_each_others_way_meet_head_on(ahead_m: float, left_m: float, yaw_rad: float, how: str) -> None:
    """The touch of the overtake's near miss, flank to flank, was called head-on: an insurer reads another accident."""
    motion = passing(ahead_m, left_m, yaw_rad, other_mps=4.0)
    short = "side by side" if how.startswith("side by side") else how
    assert title(motion).startswith(f"A and B collided {short} at 2.00 s")
    story = story_sentence(
        motion, AT, [[], []], party_kinds=["car", "car"], manoeuvre_text="", closing_mps=None, moment_from_start_s=2.0
    )
    assert f"; {how}, relative speed" in story


def test_the_speed_of_those_who_pass_is_their_relative_speed() -> None:
    assert title(passing(4.5, 0.5)).endswith(", closing at 9.9 m/s")
    assert title(passing(1.0, 2.5)).endswith(", relative speed 10.0 m/s")


def test_a_title_takes_one_line() -> None:
    for motion, said in ((passing(4.5, 0.5), True), (passing(4.5, 2.1), False), (passing(3.0, 2.1), False)):
        told = title(motion, oncoming=True)
        assert len(told) <= 86
        assert ("A in the oncoming lane" in told) is said


def test_parties_of_two_kinds_are_named_by_their_kinds() -> None:
    motion = passing(4.5, 0.5, np.pi / 2)
    assert title(motion, ("vehicle", "pedestrian")).startswith("Vehicle A and pedestrian B collided at 90\u00b0")
    assert title(motion, (None, "pedestrian")).startswith("A and B collided")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("the ego and 3 ran into each other", "A and B ran into each other"),
        ("object 3 came 0.3 s after the ego", "B came 0.3 s after A"),
        ("gap with 3: 0.39 m (3 times, 3 of 3; 1.3 to 3 s)", "gap with B: 0.39 m (3 times, 3 of 3; 1.3 to 3 s)"),
        ("gap with 33: 1 m; object 3.1; with -3: 1", "gap with 33: 1 m; object 3.1; with -3: 1"),
        (
            "\u201cthe ego and object 3\u201d: 3 braked at 2.0 m/s2",
            "\u201cthe ego and object 3\u201d: B braked at 2.0 m/s2",
        ),
    ],
)
def test_the_other_party_has_one_name(text: str, expected: str) -> None:
    assert text_with_party_names(text, "A", ("3", "B")) == expected


@pytest.mark.ci
def test_a_sheet_names_the_parties_by_letters_only(case_of: CaseOf) -> None:
    for name in ("no-collision@collision", "no-collision@near_miss"):
        told = template_values(case_of(name))
        ids = [party["id"] for party in told["parties"]]
        lines = [line for each in told["conduct"] for part in ("broken", "kept") for line in each[part].texts]
        assert not any(f"with {who}:" in line or f"{who} ran into" in line for who in ids for line in lines), lines
        assert any(f"with {letter}:" in line or f"and {letter} ran" in line for letter in "AB" for line in lines), lines
        assert "the ego" not in told["what"]
        assert not any("the ego" in chart["title"] for chart in told["strips"])


def test_the_side_of_the_road_is_told_whoever_states_it() -> None:
    told = {"handedness": "lht", "handedness_source": "attribute"}
    assert driving_side_text(told) == "Left-hand traffic."
    assert driving_side_text({**told, "handedness_source": "option"}) == "Left-hand traffic."
    assert driving_side_text({**told, "handedness_source": "default"}).startswith("Left-hand traffic: assumed")
    assert driving_side_text({**told, "handedness": None}) == ""


@pytest.mark.parametrize(
    ("kind", "simulator"), [("esmini", "esmini"), ("carla-testbench", "CARLA"), ("sumo-fcd", "SUMO"), ("osi-mcap", "")]
)
def test_a_simulator_is_named(kind: str, simulator: str) -> None:
    told = simulator_text({"format": kind})
    assert told == (
        f"The log has the format of the simulator {simulator}: probably a simulated drive" if simulator else ""
    )


@pytest.mark.ci
def test_the_sheet_says_what_no_log_tells_and_which_simulator_it_was(case_of: CaseOf) -> None:
    case = case_of("no-collision@collision")
    assert "Injuries, damage and intent are in no log." in sheet_html(case).decode()
    assert "of the simulator" not in sheet_html(case).decode()
    of_esmini = {**case.finding.drive, "format": "esmini"}
    page = sheet_html(replace(case, finding=replace(case.finding, drive=of_esmini))).decode()
    assert "The log has the format of the simulator esmini: probably a simulated drive." in page


@pytest.mark.ci
def test_nothing_found_in_a_drive_that_was_not_judged_is_no_comfort(folder: Path) -> None:
    result = load_result(folder)
    kept = result.verdicts.filter(pc.invert(pc.fill_null(result.verdicts["near_miss"], False)))
    status, reason = (result.drives.column_names.index(name) for name in ("status", "status_reason"))
    n = result.drives.num_rows
    drives = result.drives.set_column(status, "status", pa.array(["not_judged"] * n))
    drives = drives.set_column(reason, "status_reason", pa.array(["no ego: use --ego ID"] * n))
    unjudged = replace(result, findings=result.findings.slice(0, 0), verdicts=kept, drives=drives)
    with pytest.raises(UsageError, match=rf"is a contact, but not judged: {n} of {n} drives \(no ego: use --ego ID\)$"):
        named_finding(unjudged, "contact")


@pytest.mark.ci
def test_a_near_miss_that_is_no_distance_says_how_much_was_left(case_of: CaseOf) -> None:
    case = case_of("no-collision@near_miss")
    rule = {**case.finding.rule, "tags": []}
    told = template_values(replace(case, finding=replace(case.finding, rule=rule)))
    assert "was kept by" in told["title"]
