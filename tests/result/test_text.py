"""Words that all reports share."""

from __future__ import annotations

import pytest

from drivelint.result.text import ego_name


@pytest.mark.parametrize(
    ("ego_id", "name"),
    [
        ("7", "ego 7"),
        ("ego", "ego"),
        ("Ego", "Ego"),
        ("ego_vehicle", "ego_vehicle"),
        ("ego-1", "ego-1"),
        ("ego2", "ego2"),
        ("egon", "ego egon"),
        ("lego", "ego lego"),
    ],
)
def test_an_ego_is_not_named_twice(ego_id: str, name: str) -> None:
    assert ego_name(ego_id) == name
