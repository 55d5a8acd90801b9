"""The value that is named as the nearest with another verdict is the nearest, however far from the value as it is."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import pytest

from drivelint.explain.change import _search_changes, _VariedNumber

if TYPE_CHECKING:
    from collections.abc import Sequence


def nearest(now: float, turns_at: float) -> tuple[float, int]:
    """Return what is found where the verdict changes at and below `turns_at`, and how many values were judged."""
    judged: list[float] = []

    def judge(tried_values: Sequence[tuple[_VariedNumber, float]]) -> list[str]:
        judged.extend(value for _, value in tried_values)
        return ["not_applicable" if value <= turns_at else "fail" for _, value in tried_values]

    (change,) = _search_changes(
        [_VariedNumber("near_m", "nearer than this", "m", now, math.inf, None, 2)], "fail", judge
    )
    assert change.beyond
    assert change.nearest_value is not None
    return change.nearest_value, len(judged)


@pytest.mark.parametrize("now", [2.31, 2.5, 3.0, 5.0, 20.0, 400.0])
def test_the_nearest_value_is_named(now: float) -> None:
    found, judged = nearest(now, 2.3)
    assert 0.99 * 2.3 <= found <= 2.3
    assert judged < 40


def test_the_named_value_is_short() -> None:
    assert nearest(20.0, 2.3)[0] == 2.29
    assert nearest(1.0, 0.0)[0] == 0.0


def test_the_first_of_two_other_verdicts_is_named() -> None:
    """Nearer than 0.21 m nobody is hit hard any more, and at 0.14 m and less nobody is near at all."""

    def judge(tried_values: Sequence[tuple[_VariedNumber, float]]) -> list[str]:
        return ["not_applicable" if value <= 0.14 else "pass" if value < 0.21 else "fail" for _, value in tried_values]

    (change,) = _search_changes([_VariedNumber("within_m", "within reach", "m", 0.5, math.inf, None, 2)], "fail", judge)
    assert (change.becomes, change.beyond) == ("pass", False)
    assert change.nearest_value == pytest.approx(0.21, abs=0.003)
    assert change.nearest_value is not None
    assert change.nearest_value < 0.21
