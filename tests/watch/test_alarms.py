"""The law of alarms: each is a finding of the whole log, and each finding has its alarm, whatever prefix of the log was known."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pyarrow as pa
import pytest

from drivelint.sql.store import arrow_schemas
from drivelint.watch.alarms import WARM_UP_NS, AlarmChanges, AlarmLog
from drivelint.watch.judge import JudgedWindow
from drivelint.watch.options import WatchOptions
from drivelint.watch.window import NS_PER_S
from tests.demo.scenes import all_scenes
from tests.shared_data import ROOT
from tests.watch.prefixes import finding_keys, watch

FOLDER = ROOT / "fixtures" / "scenes"
SCENES = {scene.name: scene.map_name for scene in all_scenes()}
VERDICTS = pa.schema([
    *((name, pa.string()) for name in ("drive_id", "rule_id", "ego_id", "profile", "verdict")),
    ("ref_id", pa.int32()),
    ("t_ref_ns", pa.int64()),
])  # fmt: skip
BY_CI = ("collision-25mph", "exit-omitted")


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.ci if name in BY_CI else pytest.mark.slow) for name in SCENES]
)
def test_alarms_are_the_findings(name: str) -> None:
    options = WatchOptions(source=f"{name}.mcap", map=FOLDER / f"{SCENES[name]}.xodr", every_s=0.5)
    watched = watch(options, FOLDER)
    assert [each for each in watched.windows if isinstance(each, Exception)] == []
    assert (finding_keys([alarm.row for alarm in watched.false]), finding_keys(watched.missed)) == ([], [])
    assert finding_keys(watched.revised) == []
    assert name not in BY_CI or watched.alarms


def finding(
    start_s: float, end_s: float, *, rule: str = "r", object_id: str = "1", ref_id: int | None = None
) -> dict[str, Any]:
    schema = arrow_schemas()["finding"]
    row: dict[str, Any] = dict.fromkeys(schema.names)
    row |= {field.name: "" for field in schema if not field.nullable and pa.types.is_string(field.type)}
    row |= {
        "rule_id": rule,
        "ego_id": "e",
        "object_id": object_id,
        "profile": None,
        "severity": "major",
        "ref_id": ref_id,
    }
    row |= {
        "drive_id": "d",
        "t_start_ns": round(start_s * NS_PER_S),
        "t_end_ns": round(end_s * NS_PER_S),
        "t_worst_ns": round(end_s * NS_PER_S),
    }
    return row | {"finding_id": f"{rule}-{object_id}-{start_s}"}


def window(start_s: float, end_s: float, *rows: dict[str, Any], refs: dict[int, float] | None = None) -> JudgedWindow:
    verdicts = [
        {
            "drive_id": "d",
            "rule_id": "r",
            "ego_id": "e",
            "profile": None,
            "verdict": "fail",
            "ref_id": ref,
            "t_ref_ns": round(t * NS_PER_S),
        }
        for ref, t in (refs or {}).items()
    ]
    return JudgedWindow(
        round(start_s * NS_PER_S),
        round(end_s * NS_PER_S),
        pa.Table.from_pylist(list(rows)) if rows else pa.table({}),
        pa.Table.from_pylist(verdicts, schema=VERDICTS),
        pa.table({}),
    )


def log() -> AlarmLog:
    return AlarmLog({"r": NS_PER_S}, ["nominal"])


def test_a_finding_that_goes_on_is_one_alarm_and_its_end_is_told() -> None:
    alarms = log()
    new = alarms.add_window(window(0, 10, finding(9, 10)), None, None).new
    assert [(a.row["t_start_ns"], a.latency_s) for a in new] == [(9 * NS_PER_S, 1.0)]
    assert alarms.add_window(window(0, 12, finding(9, 12)), 10 * NS_PER_S, None) == AlarmChanges([], [], [])
    change = alarms.add_window(window(0, 14, finding(9, 12.5)), 12 * NS_PER_S, None)
    assert (change.new, change.withdrawn) == ([], [])
    assert [a.t_end_ns for a in change.over] == [round(12.5 * NS_PER_S)]


def test_failing_steps_within_the_gap_of_the_rule_are_the_same_finding_and_later_ones_another() -> None:
    alarms = log()
    alarms.add_window(window(0, 10, finding(9, 10)), None, None)
    assert alarms.add_window(window(0, 12, finding(10.9, 11)), 10 * NS_PER_S, None).new == []
    assert len(alarms.add_window(window(0, 14, finding(9, 11), finding(12.5, 13)), 12 * NS_PER_S, None).new) == 1


def test_another_object_is_another_alarm() -> None:
    alarms = log()
    new = alarms.add_window(window(0, 10, finding(9, 10), finding(9, 10, object_id="2")), None, None).new
    assert [a.row["object_id"] for a in new] == ["1", "2"]


def test_what_fails_only_because_the_window_begins_there_is_no_alarm() -> None:
    alarms = log()
    cut = WARM_UP_NS / NS_PER_S - 1
    assert alarms.add_window(window(100, 130, finding(100, 100 + cut)), 129 * NS_PER_S, 0 * NS_PER_S).new == []
    assert len(alarms.add_window(window(100, 130, finding(100, 100 + cut)), 129 * NS_PER_S, None).new) == 1


def test_what_fails_at_the_newest_steps_is_an_alarm_wherever_it_began() -> None:
    alarms = log()
    assert len(alarms.add_window(window(100, 130, finding(100, 130)), 129 * NS_PER_S, 100 * NS_PER_S).new) == 1


def test_what_is_known_in_hindsight_is_an_alarm() -> None:
    alarms = log()
    (alarm,) = alarms.add_window(window(100, 130, finding(110, 111)), 129 * NS_PER_S, 100 * NS_PER_S).new
    assert alarm.latency_s == 20


def test_a_reference_point_that_moved_a_little_is_the_same() -> None:
    alarms = log()
    alarms.add_window(window(0, 10, finding(5, 5, ref_id=0), refs={0: 5}), None, None)
    assert alarms.add_window(window(0, 11, finding(5.5, 5.5, ref_id=0), refs={0: 5.5}), 10 * NS_PER_S, None).new == []
    both = window(0, 20, finding(5.5, 5.5, ref_id=0), finding(15, 15, ref_id=1), refs={0: 5, 1: 15})
    assert len(alarms.add_window(both, 11 * NS_PER_S, None).new) == 1


def test_a_profile_that_only_gives_advice_gives_no_alarm() -> None:
    alarms = log()
    row = finding(9, 10) | {"profile": "relaxed"}
    assert alarms.add_window(window(0, 10, row), None, None).new == []
    assert len(alarms.add_window(window(0, 10, row | {"profile": "nominal"}), None, None).new) == 1


def test_alarms_are_held_against_the_findings_of_the_whole_log() -> None:
    alarms = log()
    alarms.add_window(window(0, 10, finding(9, 10), finding(3, 4, object_id="2")), None, None)
    missed = alarms.assign_findings_and_return_unassigned([finding(9, 12), finding(30, 31)], window(0, 1).verdicts)
    assert [row["t_start_ns"] for row in missed] == [30 * NS_PER_S]
    assert [alarm.finding_ids for alarm in alarms.alarms] == [["r-1-9"], []]


def test_what_later_windows_do_not_show_any_more_is_withdrawn_and_may_come_again() -> None:
    alarms = log()
    (alarm,) = alarms.add_window(window(0, 10, finding(9, 9, ref_id=0), refs={0: 9}), None, None).new
    assert alarms.add_window(window(0, 11), 10 * NS_PER_S, None) == AlarmChanges([], [], [alarm])
    assert alarm.withdrawn_ns == 11 * NS_PER_S
    assert alarms.add_window(window(0, 12), 11 * NS_PER_S, None) == AlarmChanges([], [], [])
    assert len(alarms.add_window(window(0, 13, finding(9, 9, ref_id=0), refs={0: 9}), 12 * NS_PER_S, None).new) == 1


def test_an_alarm_that_the_window_cannot_know_any_more_is_not_withdrawn() -> None:
    alarms = log()
    alarms.add_window(window(100, 130, finding(110, 111)), None, 0 * NS_PER_S)
    assert alarms.add_window(window(107, 137), 130 * NS_PER_S, 107 * NS_PER_S).withdrawn == []
    assert len(alarms.add_window(window(104, 134), 130 * NS_PER_S, 104 * NS_PER_S).withdrawn) == 1


def unknown(window: JudgedWindow, verdict: str) -> JudgedWindow:
    """Return a window in which the rule says nothing."""
    row = {
        "drive_id": "d",
        "rule_id": "r",
        "ego_id": "e",
        "profile": None,
        "verdict": verdict,
        "ref_id": None,
        "t_ref_ns": None,
    }
    return replace(window, verdicts=pa.Table.from_pylist([row], schema=VERDICTS))


@pytest.mark.parametrize("verdict", ["error", "unknown"])
def test_a_rule_that_says_nothing_withdraws_nothing(verdict: str) -> None:
    alarms = log()
    alarms.add_window(window(0, 10, finding(9, 10)), None, None)
    assert alarms.add_window(unknown(window(0, 11), verdict), 10 * NS_PER_S, None).withdrawn == []
    assert alarms.add_window(window(0, 12, finding(9, 12)), 11 * NS_PER_S, None).new == []


def test_two_alarms_that_turn_out_to_be_one_finding_both_stand() -> None:
    alarms = log()
    alarms.add_window(window(0, 10, finding(5, 6), finding(9, 10)), None, None)
    assert alarms.add_window(window(0, 11, finding(5, 11)), 10 * NS_PER_S, None) == AlarmChanges([], [], [])


def test_an_alarm_that_goes_on_after_all_is_over_once_more() -> None:
    alarms = log()
    alarms.add_window(window(0, 10, finding(9, 10)), None, None)
    assert len(alarms.add_window(window(0, 12, finding(9, 10)), 10 * NS_PER_S, None).over) == 1
    assert alarms.add_window(window(0, 13, finding(9, 13)), 12 * NS_PER_S, None) == AlarmChanges([], [], [])
    assert len(alarms.add_window(window(0, 15, finding(9, 13)), 13 * NS_PER_S, None).over) == 1


def test_the_first_window_that_could_be_judged_may_lack_the_past() -> None:
    assert log().add_window(window(100, 130, finding(101, 103)), None, 100 * NS_PER_S).new == []
