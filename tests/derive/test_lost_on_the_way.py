"""What is not known of a contact: an actor that is lost on its way to the ego, and an ego that is not seen before it is touched."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from tests import scenes
from tests.derive.overtake_scene import scene
from tests.scenes import Road, derived, drive, moving, road, rows, standing, times

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive

NO_COLLISION = "ukhc.no-collision"
WAY: Road = road(((400.0, 0.0),))


def lost(drive_: Drive) -> list[tuple[str, str]]:
    found = rows(derived(drive_, tables=["lost_object"]), "FROM lost_object ORDER BY object_id")
    return [(row["object_id"], row["code"]) for row in found]


@pytest.mark.ci
@pytest.mark.parametrize("in_sight", [True, False])
def test_who_is_lost_on_its_way_to_the_ego_may_have_touched_it(in_sight: bool) -> None:
    """The oncoming car is lost 79 m ahead, where the ego is about to pass a slower car, which hides part of the road later."""
    way, (ego, vbp, ov) = scene()
    told = drive([ego, vbp, ov.keep(ov.t_s < 22.0)], way.environment, in_sight=in_sight)
    assert lost(told) == [("ov", "lost_on_road")]
    found = [row for row in scenes.judged([told], rules=[NO_COLLISION]) if row["object_id"] == "ov"]
    assert [(row["verdict"], row["reason_code"]) for row in found] == [("pass", "kept"), ("unknown", "lost_on_road")]
    (signature,) = (row for row in scenes.judged([told], rules=["ukhc.contact-signature"]) if row["object_id"] == "ov")
    assert signature["verdict"] == "unknown"


def test_who_is_lost_far_behind_on_its_way_off_has_not() -> None:
    """The two met at 26 s; the other is lost 69 m behind."""
    way, (ego, vbp, ov) = scene(end=40.0)
    assert lost(drive([ego, vbp, ov.keep(ov.t_s < 29.0)], way.environment)) == []


def struck(hole: tuple[float, float] | None = None, start: float = 0.0) -> dict[str, Any]:
    """Judge an ego that stands, and a car that drives into it from behind at 8 s."""
    way, t = WAY, times(12.0)
    ego = standing("ego", way, t, 100.0, way.own)
    other = moving("o", way, t, np.minimum(95.3, 95.3 + 5 * (t - 8)), way.own)
    seen = t >= start - 0.01
    if hole is not None:
        seen &= (t < hole[0]) | (t > hole[1])
    (row,) = (
        r
        for r in scenes.judged([drive([a.keep(seen) for a in (ego, other)], way.environment)], rules=[NO_COLLISION])
        if r["verdict"] == "fail"
    )
    return row


@pytest.mark.ci
def test_who_stood_for_3_s_was_struck() -> None:
    assert "the ego was hit" in struck()["reason"]
    assert "the ego was hit" in struck(start=4.9)["reason"]
    assert "the ego was hit" in struck(hole=(2.0, 4.5))["reason"]


@pytest.mark.ci
@pytest.mark.parametrize("unseen", [{"hole": (5.0, 7.55)}, {"hole": (5.0, 8.25)}, {"start": 7.0}])
def test_who_struck_whom_is_not_known_of_an_ego_that_is_not_seen_for_the_3_s_before(unseen: dict[str, Any]) -> None:
    assert "it is not known which of the two hit the other" in struck(**unseen)["reason"]
    assert math.isclose(struck(**unseen)["observed"], struck()["observed"])
