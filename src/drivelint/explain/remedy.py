"""What would have decided an unknown verdict, by its reason code: what to record, or to provide."""

from __future__ import annotations

from typing import Final

from drivelint.conditions import GIVEN

_LONGER = "a log that shows what the reason names"
_NAMED = "what the reason names; it does so of the first step that is not known, and others may lack something else"
REMEDIES: Final = {
    "lost_near_ego": "record {object} for as long as the ego, or until it is out of the ego's reach",
    "lost_in_range": "record {object} for as long as the ego, or say with check --sensor-range how far the recorder sees",
    "lost_on_road": "record {object} for as long as the ego",
    "window_truncated": "a log in which the ego, and whoever is near it, is recorded over the whole window",
    "log_hole": "a log without that hole",
    "reference_time_unknown": _LONGER,
    "anchor_unknown": _LONGER,
    "only_a_bound": "what the reason names; where it names nothing, a map that goes on, or a longer --sensor-range of check",
    "beyond_sensor_range": "sensors that reach further (check --sensor-range, if they do)",
    "ego_not_placed": "the ego's position and heading at every step",
    "indicator_unknown": "the ego's indicators at every step",
    "missing_step": _NAMED,
    "null_value": _NAMED,
    "applies_unknown": _NAMED,
}
"""Reason code -> what to do."""


def remedy(rule_id: str, code: str, object_id: str | None) -> str | None:
    """Return what would decide an unknown verdict with this reason code; None where the reason says it."""
    if code.startswith("missing_") and code not in REMEDIES:
        signal = code.removeprefix("missing_")
        return f"the signal {signal}: drivelint inspect TRACE --rules {rule_id} says how to provide it"
    if code.removesuffix("_unknown") in GIVEN or code == "limit_unknown":
        return "what the reason says to give, to drivelint check"
    found = REMEDIES.get(code)
    return found and found.format(object="the object" if object_id is None else f"object {object_id}")
