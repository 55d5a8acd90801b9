"""What happens between two steps: logs of few samples a second hide a contact from every step, and must not hide it from the verdict."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from tests.scenes import Road, derived, drive, moving, road, rows, times, verdict_rows

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive
    from tests.scenes import Floats, Row

RATES = (1.0, 2.0, 5.0, 10.0)


def line(heading: float = 0.0) -> Road:
    """Return a straight way without a map."""
    return Road(None, ((1000.0, 0.0),), (0.0, 0.0, heading))  # type: ignore[arg-type]


def between(scene: Drive) -> list[Row]:
    return rows(derived(scene, tables=["between_steps"]), "FROM between_steps ORDER BY drive_id, object_id, t_ns")


def verdict(*scenes: Drive, rule: str = "ukhc.no-collision") -> list[str]:
    """Return what the rule says of each drive: the worst of its rows."""
    found: dict[str, str] = {}
    for row in verdict_rows(list(scenes), rules=[rule]):
        if RANK[row["verdict"]] > RANK[found.get(row["drive_id"], "")]:
            found[row["drive_id"]] = row["verdict"]
    return [found[scene.trace.drive_id] for scene in scenes]


RANK = {"": -1, "not_applicable": 0, "pass": 1, "unknown": 2, "fail": 3}


def crossing(rate: float, late_m: float, *, side: float = 1.0, phase: float = 0.0) -> Drive:
    """Return two at 15 m/s whose ways cross at right angles at 4 s; the other is `late_m` behind."""
    t = times(8.0, period=1 / rate) + phase
    ego = moving("ego", line(), t, 15 * (t - 4), 0.0)
    other = moving("o", line(side * math.pi / 2), t, 15 * (t - 4) - late_m, 0.0)
    return drive([ego, other], None)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("rate", RATES)
def test_a_crash_at_a_crossing_is_found_at_every_rate(rate: float, side: float) -> None:
    """In the middle of two steps: at 1 Hz they are 7.5 m before it and 7.5 m past it, at 2 Hz still apart."""
    scene = crossing(rate, 0.0, side=side, phase=0.5 / rate)
    assert verdict(scene) == ["fail"]
    assert bool(between(scene)) is (rate <= 2)


# ---- beside each other in no step


def cyclist(rate: float, gap: float, *, hand: str = "rht", phase: float = 0.0) -> Drive:
    """Return the ego at 13 m/s past a cyclist at 3 m/s in the lane beside, `gap` metres between the two."""
    way = road(((600.0, 0.0),), hand, (2, 1) if hand == "lht" else (1, 2))
    t = times(12.0, period=1 / rate) + phase
    side = math.copysign(1.0, way.ego_d)
    ego = moving("ego", way, t, 200 + 13 * (t - 6), way.ego_d)
    rider = moving(
        "c", way, t, 200 + 3 * (t - 6), way.ego_d + side * (0.9 + gap + 0.3), kind="bicycle", length=1.8, width=0.6
    )
    return drive([ego, rider], way.environment)


@pytest.mark.ci
@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("hand", ["rht", "lht"])
@pytest.mark.parametrize("rule", ["ukhc.r163.cyclist"])
def test_a_cyclist_passed_between_two_steps_was_passed(rate: float, hand: str, rule: str) -> None:
    """At 1 Hz the ego is behind it at one step and before it at the next."""
    shift = 0.5 / rate
    assert verdict(cyclist(rate, 0.8, hand=hand, phase=shift), rule=rule) == ["fail"]
    assert verdict(cyclist(rate, 2.6, hand=hand, phase=shift), rule=rule) == ["pass"]
    assert verdict(cyclist(rate, 1.6, hand=hand, phase=shift), rule=rule) == ["pass" if rate >= 5 else "unknown"]


# ---- the law


class Meeting(NamedTuple):
    """The ego goes straight on; the other comes at an angle and both change their speeds on the way, within what tyres give."""

    degrees: int
    v: float
    late_m: float
    swing: float
    brake: float
    phase: float

    def drive(self, every: int, drive_id: str) -> Drive:
        """Return it with one of `every` samples of a log of 20 Hz."""
        t = times(8.0, period=0.05)

        def stations(v: float, brake: float, at: float) -> Floats:
            u = np.clip(t - at, 0.0, v / max(brake, 1e-9))
            s: Floats = v * (t - 4) - brake * u**2 / 2 - brake * u * np.clip(t - at - u, 0.0, None)
            return s

        ego = moving("ego", line(), t, stations(15.0, self.brake, 3.6), 0.3 * np.sin(self.swing * t))
        s = stations(self.v, self.brake / 2, 4.2) - self.late_m
        other = moving("o", line(math.radians(self.degrees)), t, s, 0.2 * np.sin(self.swing * t))
        first = int(self.phase * every) % every
        mask = np.arange(len(t)) % every == first
        return drive([ego.keep(mask), other.keep(mask)], None, drive_id=drive_id)


MEETINGS = st.builds(
    Meeting,
    st.one_of(st.integers(20, 180), st.integers(-180, -20)),
    st.floats(5, 25),
    st.floats(-9, 9),
    st.floats(0, 2.0),
    st.floats(0, 7),
    st.floats(0, 0.99),
)


@pytest.mark.slow
@settings(max_examples=4)
@given(st.lists(MEETINGS, min_size=12, max_size=12))
@example([Meeting(90, 15.0, late, 0.0, 0.0, 0.5) for late in np.linspace(-6, 6, 25)])
@example([Meeting(180, 20.0, late, 1.0, 3.0, 0.5) for late in np.linspace(-6, 6, 13)])
def test_fewer_samples_never_turn_a_fail_into_a_pass(meetings: list[Meeting]) -> None:
    every = (1, 2, 4, 10, 20)
    scenes = [m.drive(n, f"{no:02}-{n}") for no, m in enumerate(meetings) for n in every]
    told = verdict(*scenes)
    for no, each in enumerate(meetings):
        fine, *coarse = told[no * len(every) : (no + 1) * len(every)]
        if fine == "fail":
            assert set(coarse) <= {"fail", "unknown"}, (each, coarse)
        else:
            # nor do they make one up
            assert "fail" not in coarse, (each, fine, coarse)
