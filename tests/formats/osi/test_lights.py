"""Headlights of OSI logs, which rules hear of as declared events; bulbs of traffic lights, which are joined to lights."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from drivelint.engine.batch import Drive
from tests.formats.logs import read
from tests.formats.osi import osi_log
from tests.formats.osi.bulbs import bulb, write
from tests.scenes import derived, rows, verdict_rows
from tests.shared_data import shared

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.drive.trace import Trace

UNKNOWN, OTHER, OFF, ON, AMBER = 0, 1, 2, 3, 6
NIGHT = (("light", "night"), ("road_type", "motorway"))


def events(trace: Trace) -> list[tuple[str, float, str, str | None]]:
    said = trace.tables["declared_event"].to_pylist()
    return sorted((r["actor_id"], r["t_ns"] / 1e9, r["event"], r["value"]) for r in said)


@pytest.mark.parametrize(
    ("head", "beam", "expected"),
    [
        (ON, None, "on"),
        (ON, OFF, "on"),
        (OFF, ON, "on"),
        (UNKNOWN, ON, "on"),
        (OFF, OFF, "off"),
        (OFF, None, "off"),
        (OFF, UNKNOWN, "off"),
        (OFF, OTHER, None),
        (OFF, AMBER, None),
        (UNKNOWN, OFF, None),
        (OTHER, None, None),
        (AMBER, OFF, None),
        (None, None, None),
    ],
)
def test_headlights(tmp_path: Path, head: int | None, beam: int | None, expected: str | None) -> None:
    trace = read(write(tmp_path, osi_log.drive(3, actors=1, head=head, beam=beam)))
    assert events(trace) == ([("0", 0.0, "headlights", expected)] if expected else [])


def test_only_changes_of_the_headlights_are_told_and_what_is_not_known_is_one(tmp_path: Path) -> None:
    frames = [osi_log.drive(9, actors=2, head=head)[k] for k, head in enumerate((2, 2, 3, 3, 0, 0, 3, 2, 2))]
    for truth in frames:
        truth.moving_object[1].vehicle_classification.light_state.head_light = ON
    assert events(read(write(tmp_path, frames))) == [
        ("0", 0.0, "headlights", "off"),
        ("0", 0.2, "headlights", "on"),
        ("0", 0.4, "headlights", None),
        ("0", 0.6, "headlights", "on"),
        ("0", 0.7, "headlights", "off"),
        ("1", 0.0, "headlights", "on"),
    ]


@pytest.mark.sample(1, ci=3)
@pytest.mark.parametrize(("head", "verdict"), [(ON, "pass"), (OFF, "fail"), (UNKNOWN, "unknown"), (None, "unknown")])
def test_headlights_at_night_are_judged(tmp_path: Path, head: int | None, verdict: str) -> None:
    trace = read(write(tmp_path, osi_log.drive(30, head=head)), conditions=NIGHT)
    (found,) = verdict_rows([Drive(trace, None)], rules=["ukhc.r113.headlights"])
    assert (found["verdict"], found["rule_id"]) == (verdict, "ukhc.r113.headlights")


@pytest.mark.ci
def test_headlights_that_become_unknown_are_no_pass(tmp_path: Path) -> None:
    frames = [osi_log.drive(30, head=UNKNOWN if k == 20 else ON)[k] for k in range(30)]
    (found,) = verdict_rows(
        [Drive(read(write(tmp_path, frames), conditions=NIGHT), None)], rules=["ukhc.r113.headlights"]
    )
    assert found["verdict"] == "unknown"


def test_a_log_with_lamps_declares_nothing_of_what_the_ego_means(tmp_path: Path) -> None:
    drive = Drive(read(write(tmp_path, osi_log.drive(30, head=ON))), None)
    there = {r["signal"]: r["available"] for r in rows(derived(drive, tables=["capability"]), "FROM capability")}
    assert (there["mode_headlights"], there["declared_events"]) == (True, False)


@pytest.mark.ci
def test_the_headlights_of_a_real_log() -> None:
    trace = read(shared("osi/MovingHostWithStopLineVariations.mcap"), conditions=NIGHT)
    assert events(trace) == [("0", 0.0, "headlights", "off")]
    (found,) = verdict_rows([Drive(trace, None)], rules=["ukhc.r113.headlights"])
    assert (found["verdict"], found["reason_code"]) == ("fail", "violated")
    assert "not known" not in found["reason"]


def hung(
    truth: Any, number: int, at: tuple[float, float, float], *, icon: int = 2, lane: int = 1, mode: int = 3
) -> None:
    """Add a bulb of its own: red, amber, green by the last digit of its number."""
    bulb(truth, number, 2 + number % 10, mode)
    light = truth.traffic_light[-1]
    light.base.position.x, light.base.position.y, light.base.position.z = at
    light.classification.icon = icon
    light.classification.assigned_lane_id.add().value = lane


def test_bulbs_beside_each_other_are_one_light(tmp_path: Path) -> None:
    """A light of three bulbs, its arrow beside it, and the same light of the lane beside it; only red is lit."""
    frames = osi_log.drive(2)
    for truth in frames:
        for k in range(3):
            hung(truth, 10 + k, (50.0, 5.0, 5.0 - 0.3 * k), mode=3 if k == 0 else 2)
            hung(truth, 20 + k, (50.0, 5.0, 5.0 - 0.3 * k), lane=2, mode=3 if k == 2 else 2)
        hung(truth, 32, (50.0, 4.7, 4.4), icon=7)
        hung(truth, 42, (80.0, 5.0, 5.0))
    states = read(write(tmp_path, frames)).tables["signal_state"].to_pylist()
    assert {r["signal_id"]: r["state"] for r in states if r["t_ns"] == 0} == {
        "10": "red", "20": "green", "32": "green", "42": "green",
    }  # fmt: skip


def test_a_light_that_is_out_of_service_is_dark(tmp_path: Path) -> None:
    """A bulb of the second light is out of service, and so is the whole third one, from its second frame on."""
    frames = osi_log.drive(2)
    for k, truth in enumerate(frames):
        for number, color, signal in ((10, 2, "a"), (20, 2, "b"), (21, 4, "b"), (30, 2, "c")):
            bulb(truth, number, color, 3, signal)
        for number in (20, 30)[: k + 1]:
            light = next(each for each in truth.traffic_light if each.id.value == number)
            light.classification.is_out_of_service = True
    states = read(write(tmp_path, frames)).tables["signal_state"].to_pylist()
    assert [(r["signal_id"], r["t_ns"] // 100_000_000, r["state"]) for r in states] == [
        ("a", 0, "red"), ("a", 1, "red"), ("b", 0, "green"), ("b", 1, "green"), ("c", 0, "red"), ("c", 1, "off"),
    ]  # fmt: skip
