"""What would decide an unknown verdict, by its reason code."""

from __future__ import annotations

import pytest

from drivelint.drive.conditions import DRIVE_CONDITION_VALUES
from drivelint.reasons.reason_text import sentence_if_it_has_advice
from drivelint.reasons.signals import REMEDIES, remedy


@pytest.mark.parametrize(
    ("code", "advice"),
    [
        ("lost_near_ego", "record object o for as long as the ego"),
        ("missing_map", "the road as OpenDRIVE: --map FILE"),
        ("missing_indicator", "the ego's indicators: a column of off, left, right and hazard"),
        ("missing_step", "what is NULL, or has no row, in the rows"),
        ("only_a_bound", "a map that goes on"),
        ("limit_unknown", "a map with speed limits"),
        ("road_type_unknown", "a map with road types"),
        ("engaged_unknown", "whether the automated driver drives: --env engaged=yes or no"),
        ("light_unknown", "daylight or darkness: --env light=day"),
        ("a_code_of_a_rule_of_somebody_else", "what is NULL, or has no row, in the rows"),
    ],
)
def test_by_code(code: str, advice: str) -> None:
    assert remedy(code, "o", "carla-testbench").startswith(advice)


@pytest.mark.parametrize(
    ("code", "cause_advice", "advice"),
    [
        ("null_value", "the track of object 3 ends: record it for longer", "the track of object 3 ends: record it for longer"),
        ("only_a_bound", None, "a map that goes on, or a longer --sensor-range of check; for a duration, a log that begins earlier"),
        ("null_value", None, "what is NULL, or has no row, in the rows that it was judged on"),
    ],
)  # fmt: skip
def test_the_advice_of_the_cause_is_repeated(code: str, cause_advice: str | None, advice: str) -> None:
    assert remedy(code, None, "osi-mcap", cause_advice).startswith(advice)


def test_an_ego_that_is_no_vehicle_is_not_the_maps_fault() -> None:
    assert remedy("missing_registration", None, "osi-mcap").startswith("the map of this place (--map)")
    arguments = {"actor_class": "pedestrian", "n_on_lane": 3, "n_steps": 40}
    assert sentence_if_it_has_advice("seldom_on_lane", arguments) is None
    told = remedy("missing_registration", None, "osi-mcap", sentence_if_it_has_advice("ego_not_a_vehicle", arguments))
    assert "3 of 40 steps, so it may not be the vehicle under test: choose the ego with --ego ID" in told
    assert "--map" not in told


def test_the_words_of_the_format() -> None:
    assert "indicator_state of the host vehicle" in remedy("missing_indicator", None, "osi-mcap")
    assert "the column indicator of actor_state.parquet" in remedy("missing_indicator", None, "canonical-parquet")


def test_every_condition_has_its_own() -> None:
    told = {name: remedy(f"{name}_unknown", None, "") for name in DRIVE_CONDITION_VALUES}
    assert len(set(told.values())) == len(told)
    assert not any(text.startswith("see what the rules") for text in told.values())


def test_without_an_object() -> None:
    assert "record the object" in remedy("lost_near_ego", None, "")
    assert all("{" not in remedy(code, None, "") for code in REMEDIES)
