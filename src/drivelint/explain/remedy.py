"""What would have decided an unknown verdict, by its reason code: what to record, or to provide."""

from __future__ import annotations

from typing import Final

from drivelint.conditions import GIVEN

_LONGER = "a log that shows what the reason names: one that begins earlier, or goes on for longer"
_NAMED = (
    "what the reason names: where the log lacks it, record it (position, heading, size, class and speed of every actor near, "
    "without holes); where the map lacks it, give a map that has it. It is the first step that is not known: others may lack something else"
)
REMEDIES: Final = {
    "lost_near_ego": "record {object} for as long as the ego, or until it is out of the ego's reach",
    "lost_in_range": "record {object} for as long as the ego, or say with --sensor-range how far the recorder sees",
    "lost_on_road": "record {object} for as long as the ego",
    "window_truncated": "a log in which the ego, and whoever is near it, is recorded over the whole window",
    "log_hole": "a log without that hole",
    "reference_time_unknown": _LONGER,
    "anchor_unknown": _LONGER,
    "only_a_bound": "more of the road: a map that goes on, or sensors that reach further (--sensor-range, if they do)",
    "beyond_sensor_range": "sensors that reach further (--sensor-range, if they do)",
    "ego_not_placed": "the ego's position and heading at every step",
    "indicator_unknown": "the ego's indicators at every step",
    "missing_step": _NAMED,
    "null_value": _NAMED,
    "applies_unknown": _NAMED,
}
"""Reason code -> what to do."""


def remedy(rule_id: str, code: str, reason: str, object_id: str | None) -> str | None:
    """Return what would decide an unknown verdict with this reason code; None where the reason says it."""
    if code.startswith("missing_") and code not in REMEDIES:
        signal = code.removeprefix("missing_")
        return f"the signal {signal}: drivelint inspect TRACE --rules {rule_id} says how to provide it"
    if code.removesuffix("_unknown") in GIVEN or code == "limit_unknown":
        return "what the reason says to give, to drivelint check"
    if code == "only_a_bound" and not reason.startswith("Not decided: only a bound"):
        code = "null_value"  # the rule's own reason names the cause
    found = REMEDIES.get(code)
    return found and found.format(object="the object" if object_id is None else f"object {object_id}")
