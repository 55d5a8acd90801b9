"""Finds margins that shrink although the rule is still kept, and the time until they are 0."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping

    from drivelint.catalogue import Rule
    from drivelint.watch.alarms import Key
    from drivelint.watch.judge import JudgedWindow

MARGIN_SLOPE_SPAN_NS: Final = 1_000_000_000
"""The time before the newest step from which the rate of change of a margin is computed."""

MOST_TIME_UNTIL_MARGIN_IS_ZERO_S: Final = 60.0
"""A margin that would reach 0 later than this counts as constant: the last digits of a constant margin may vary."""


class ShrinkingMargins:
    """The margins that were reported as shrinking; each is reported again only after it was above `near_margin`."""

    def __init__(self) -> None:
        self._open: dict[Key, int] = {}

    def new_messages(
        self, window: JudgedWindow, rules: Mapping[str, Rule], drive_start_ns: int
    ) -> list[dict[str, Any]]:
        """Return a message for each margin that is below its rule's `near_margin` at the newest steps, and shrinks."""
        messages: list[dict[str, Any]] = []
        newest_by_key: dict[Key, int] = {}
        for row in window.courses.to_pylist():
            if row["finding_id"] is not None:
                continue
            key = row["rule_id"], row["ego_id"], row["profile"], row["object_id"]
            t_ns, margin = np.array(row["t_ns"], np.int64), np.array(row["margin"], np.float64)
            has_margin = np.isfinite(margin)
            t_ns, margin = t_ns[has_margin], margin[has_margin]
            if not len(t_ns):
                continue
            rule = rules[row["rule_id"]]
            last = t_ns > t_ns[-1] - MARGIN_SLOPE_SPAN_NS
            is_now = t_ns[-1] >= window.t_end_ns - MARGIN_SLOPE_SPAN_NS // 2
            is_near = rule.near_margin is not None and 0 <= margin[-1] < rule.near_margin
            if not (is_now and is_near):
                continue
            newest_by_key[key] = int(t_ns[-1])
            if key in self._open or last.sum() < 2:
                continue
            per_s = np.polyfit((t_ns[last] - t_ns[-1]) / 1e9, margin[last], 1)[0]
            if per_s >= 0 or -margin[-1] / per_s > MOST_TIME_UNTIL_MARGIN_IS_ZERO_S:
                newest_by_key.pop(key)
                continue
            messages.append({
                "type": "warning",
                "rule_id": rule.id,
                "title": rule.title,
                "severity": rule.severity,
                "ego_id": row["ego_id"],
                "object_id": row["object_id"],
                "profile": row["profile"],
                "t_s": round((int(t_ns[-1]) - drive_start_ns) / 1e9, 6),
                "t_ns": int(t_ns[-1]),
                "margin": float(margin[-1]),
                "near_margin": rule.near_margin,
                "unit": rule.unit,
                "shrinks_per_s": float(-per_s),
                "to_violation_s": float(-margin[-1] / per_s),
            })  # fmt: skip
        self._open = newest_by_key
        return messages
