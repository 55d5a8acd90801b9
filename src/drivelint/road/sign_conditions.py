"""Signs whose plates restrict them to times, weather or vehicles, for which no table has a column: a check names their lanes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from drivelint.road.quality import MapQuality

KINDS_WITH_UNREAD_CONDITIONS: Final = frozenset({"no_overtaking"})
"""The kinds of signs for which a rule looks at this check."""


def add_unread_condition(quality: MapQuality, lanelet_id: str, description: str, plates: str) -> None:
    """Add that a sign has plates, and that it is therefore not known when it applies on a lane."""
    message = f"{description} applies only as its plates state ({plates}): when it applies is not known"
    quality.add("sign_condition_unread", "warning", lanelet_id, message)
