"""Where a recorder's sensors measured the places, a miss is one that two measurements show; what was interpolated between is none."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from tests.evaluate.packs import INVARIANT, MEASURE, brief, verdicts, write

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

SQL = "SELECT drive_id, ego_id, t_ns, speed_mps AS observed, 10 AS required FROM ego_state"
PASS, FAIL, UNKNOWN = ("pass", "kept"), ("fail", "violated"), ("unknown", "one_sample")
N = 31


def scene(missed: Sequence[int], places: Any, sensors: float | None = 50.0, actor: str = "e") -> dict[str, Any]:
    """Return a scene in which the steps `missed` miss the bound by far, of an actor with these places east (n,), in m."""
    times = [i / 10 for i in range(N)]
    values = [5.0 if i in missed else 12.0 for i in range(N)]
    return {
        "data_log": {"sensor_range_m": sensors, "sha256": "log"},
        "ego_state": {"t_s": times, "speed_mps": values},
        "actor": {"actor_id": actor},
        "actor_state": {"actor_id": actor, "t_s": times, "x_m": [float(x) for x in places], "y_m": 0.0},
    }


def measured_places() -> Any:
    """Return places that were measured at each step: no three lie on a line."""
    return np.arange(N) + 0.02 * np.sin(2.5 * np.arange(N))


def interpolated(every: int = 5, shift: int = 0) -> Any:
    """Return places that were measured at each `every`-th step from `shift` on, and at both ends."""
    frames = np.unique([0, *range(shift, N, every), N - 1])
    return np.interp(np.arange(N), frames, frames + 0.3 * np.sin(1.3 * np.arange(len(frames))))


@pytest.mark.parametrize(
    ("missed", "places", "expected"),
    [
        ([12], measured_places(), UNKNOWN),
        ([0], measured_places(), UNKNOWN),
        ([12, 13], measured_places(), FAIL),
        ([12, 20], measured_places(), UNKNOWN),
        ([8, 9, 10, 11, 12, 13, 14], interpolated(), UNKNOWN),
        ([10, 11, 12, 13, 14, 15], interpolated(), FAIL),
        ([11, 12, 13, 14], interpolated(), UNKNOWN),
        ([0, 1, 2], interpolated(), UNKNOWN),
        ([0, 1, 2, 3, 4, 5], interpolated(), FAIL),
        # the places of who never bends are as good as measured
        ([12, 13], np.arange(N), FAIL),
        # bends at 0, 5, 7, 12 ...: no period
        ([8, 9], np.interp(np.arange(N), [0, 5, 7, 12, 23, N - 1], [0, 5.3, 7, 12.4, 23, N - 1]), FAIL),
        ([], interpolated(), PASS),
    ],
)
def test_two_measurements_make_a_miss(
    tmp_path: Path, missed: list[int], places: Any, expected: tuple[str, str]
) -> None:
    rule = write(tmp_path, INVARIANT | MEASURE | {"reads": '["ego_state"]'}, {"condition": SQL})
    assert brief(verdicts(rule, scene(missed, places))) == [expected]


def test_what_is_known_exactly_needs_one(tmp_path: Path) -> None:
    """Ground truth has no sensors; a contact may be over before it is seen twice."""
    rule = write(tmp_path, INVARIANT | MEASURE | {"reads": '["ego_state"]'}, {"condition": SQL})
    assert brief(verdicts(rule, scene([12], measured_places(), sensors=None))) == [FAIL]
    contact = write(
        tmp_path, INVARIANT | MEASURE | {"reads": '["ego_state"]', "tags": '["contact"]'}, {"condition": SQL}
    )
    assert brief(verdicts(contact, scene([12], measured_places()))) == [FAIL]


@pytest.mark.ci
def test_a_bound_that_is_missed_by_less_than_the_error_beside_it_is_no_second_miss(tmp_path: Path) -> None:
    rule = write(tmp_path, INVARIANT | MEASURE | {"reads": '["ego_state"]'}, {"condition": SQL})
    given = scene([12], measured_places())
    given["ego_state"]["speed_mps"][11] = 9.8
    assert brief(verdicts(rule, given)) == [("unknown", "within_error")]
    given["ego_state"]["speed_mps"][11] = 9.4
    assert brief(verdicts(rule, given)) == [FAIL]


@pytest.mark.parametrize(("missed", "expected"), [([12, 13, 14], UNKNOWN), (list(range(10, 16)), FAIL)])
def test_the_object_counts_as_the_ego_does(tmp_path: Path, missed: list[int], expected: tuple[str, str]) -> None:
    sql = "SELECT drive_id, ego_id, t_ns, object_id, distance_m AS observed, 10 AS required FROM pair"
    rule = write(tmp_path, INVARIANT | MEASURE | {"reads": '["pair"]'}, {"condition": sql})
    given = scene(missed, interpolated(), actor="car")
    steps = given.pop("ego_state")
    given["actor"]["actor_id"] = ["car", "e"]
    # the ego, which is driven by its own recorder, is measured at each step
    given["actor_state"] = {
        "actor_id": ["car"] * N + ["e"] * N,
        "t_s": steps["t_s"] * 2,
        "x_m": [*map(float, interpolated()), *map(float, measured_places() - 20)],
        "y_m": 0.0,
    }
    given["pair"] = {"object_id": "car", "t_s": steps["t_s"], "distance_m": steps["speed_mps"]}
    assert brief(verdicts(rule, given)) == [expected]


@pytest.mark.ci
@pytest.mark.parametrize(
    ("missed", "unseen", "expected"),
    [
        (12, [11, 13], FAIL),
        (0, [1], FAIL),
        (N - 1, [N - 2], FAIL),
        (12, [11], UNKNOWN),
        (12, [13], UNKNOWN),
        (12, [10, 14], UNKNOWN),
        (0, [], UNKNOWN),
    ],
)
def test_nothing_contradicts_a_detection_that_nobody_was_detected_beside(
    tmp_path: Path, missed: int, unseen: list[int], expected: tuple[str, str]
) -> None:
    rule = write(tmp_path, INVARIANT | MEASURE | {"reads": '["ego_state"]'}, {"condition": SQL})
    given = scene([missed], measured_places())
    given["actor_state"]["x_m"] = [None if i in unseen else x for i, x in enumerate(given["actor_state"]["x_m"])]
    assert brief(verdicts(rule, given)) == [UNKNOWN], "a sample without a place may be one that is not believed"
    given["quality"] = {"check_id": "assumed_motion", "severity": "warning", "message": "a film"}
    assert brief(verdicts(rule, given)) == [expected]


def test_the_sentence_has_both_numbers(tmp_path: Path) -> None:
    rule = write(tmp_path, INVARIANT | MEASURE | {"reads": '["ego_state"]'}, {"condition": SQL})
    (row,) = verdicts(rule, scene([12], measured_places()))
    assert row["reason"].startswith("Missed in one measurement only, at 1.200 s (5 m, required more than 10 m)")
