"""What would decide an unknown verdict, by its reason code."""

from __future__ import annotations

import pytest

from drivelint.conditions import GIVEN
from drivelint.explain.remedy import REMEDIES, remedy

BOUND = "Not decided: only a bound is known at 8.100 s (14.6 m, required at least 15.5 m)."


@pytest.mark.parametrize(
    ("code", "reason", "told"),
    [
        ("lost_near_ego", "-", "record object o for as long as the ego"),
        ("missing_map", "-", "the signal map: drivelint inspect TRACE --rules p.r says"),
        ("missing_step", "-", "what the reason names"),
        ("only_a_bound", BOUND, "more of the road"),
        ("only_a_bound", "actor 431 was lost from the log nearby", "what the reason names"),
        ("limit_unknown", "-", "what the reason says to give"),
        *((f"{name}_unknown", "-", "what the reason says to give") for name in GIVEN),
    ],
)
def test_by_code(code: str, reason: str, told: str) -> None:
    assert (remedy("p.r", code, reason, "o") or "").startswith(told)


def test_without_an_object() -> None:
    assert "record the object" in (remedy("p.r", "lost_near_ego", "-", None) or "")
    assert all("{" not in (remedy("p.r", code, BOUND, None) or "{") for code in REMEDIES)
