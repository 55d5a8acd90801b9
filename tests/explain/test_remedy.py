"""What would decide an unknown verdict, by its reason code."""

from __future__ import annotations

import pytest

from drivelint.conditions import GIVEN
from drivelint.explain.remedy import REMEDIES, remedy


@pytest.mark.parametrize(
    ("code", "told"),
    [
        ("lost_near_ego", "record object o for as long as the ego"),
        ("missing_map", "the signal map: drivelint inspect TRACE --rules p.r says"),
        ("missing_step", "what the reason names"),
        ("only_a_bound", "what the reason names; where it names nothing, a map that goes on"),
        ("limit_unknown", "what the reason says to give"),
        *((f"{name}_unknown", "what the reason says to give") for name in GIVEN),
    ],
)
def test_by_code(code: str, told: str) -> None:
    assert (remedy("p.r", code, "o") or "").startswith(told)


def test_without_an_object() -> None:
    assert "record the object" in (remedy("p.r", "lost_near_ego", None) or "")
    assert all("{" not in (remedy("p.r", code, None) or "{") for code in REMEDIES)
