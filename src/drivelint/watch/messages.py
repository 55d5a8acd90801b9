"""The messages of a watch: JSON objects, one per line, each with its `type` first.

Fields `t_…_s` are seconds since the log's first step; fields `t_…_ns` are on the log's own clock.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

from drivelint.result.text import breach_title
from drivelint.watch.settled import IDENTIFYING_VERDICT_COLUMNS, OTHER_REPORTED_VERDICT_COLUMNS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from drivelint.catalogue import Rule
    from drivelint.result.text import Row
    from drivelint.watch.alarms import Alarm

Message = dict[str, Any]

_FINDING_COLUMNS: Final = (
    "profile", "severity", "object_id", "ego_id", "t_start_ns", "t_end_ns", "t_worst_ns", "t_ref_ns", "observed", "required", "margin",
    "unit", "x_m", "y_m", "lon", "lat", "lanelet_id", "closing_mps", "reason",
)  # fmt: skip


def _null_if_not_finite(value: object) -> object:
    return None if isinstance(value, float) and not math.isfinite(value) else value


def alarm(alarm: Alarm, rule: Rule, drive_start_ns: int) -> Message:
    """Return the message of a new alarm."""
    row = alarm.row
    return {
        "type": "alarm",
        "alarm": alarm.number,
        "rule_id": rule.id,
        "title": rule.title,
        "breach": breach_title({"breach": rule.breach, "title": rule.title}),
        "t_s": _seconds_since_start(row["t_start_ns"], drive_start_ns),
        "said_s": _seconds_since_start(alarm.said_ns, drive_start_ns),
        "latency_s": round(alarm.latency_s, 6),
        "is_early": alarm.is_early,
        "status": rule.status,
        **{name: _null_if_not_finite(row[name]) for name in _FINDING_COLUMNS},
    }


def over(alarm: Alarm, drive_start_ns: int) -> Message:
    """Return the message of an alarm whose rule is kept again, or has stopped being judged."""
    return {
        "type": "over",
        "alarm": alarm.number,
        "rule_id": alarm.row["rule_id"],
        "t_end_s": _seconds_since_start(alarm.t_end_ns, drive_start_ns),
        "t_end_ns": alarm.t_end_ns,
    }


def withdrawn(alarm: Alarm, now_ns: int, drive_start_ns: int) -> Message:
    """Return the message that an alarm is withdrawn."""
    return {
        "type": "withdrawn",
        "alarm": alarm.number,
        "rule_id": alarm.row["rule_id"],
        "t_s": _seconds_since_start(now_ns, drive_start_ns),
        "t_ns": now_ns,
    }


def halt(alarm: Alarm, now_ns: int, drive_start_ns: int) -> Message:
    """Return the message that an alarm halts the drive."""
    return {
        "type": "halt",
        "alarm": alarm.number,
        "rule_id": alarm.row["rule_id"],
        "t_s": _seconds_since_start(now_ns, drive_start_ns),
        "t_ns": now_ns,
        "after_s": round((now_ns - alarm.row["t_start_ns"]) / 1e9, 6),
    }


def note(text: str) -> Message:
    """Return the message with a note for the user."""
    return {"type": "note", "text": text}


def alarm_outcome(alarm: Alarm) -> Message:
    """Return the message that states which findings of the whole log confirm an alarm."""
    return {
        "type": "checked",
        "alarm": alarm.number,
        "rule_id": alarm.row["rule_id"],
        "is_finding": bool(alarm.finding_ids),
        "finding_ids": alarm.finding_ids,
    }


def settled_verdict(row: Row, drive_start_ns: int) -> Message:
    """Return the message of a verdict that is reported before the log's end."""
    values = {
        name: _null_if_not_finite(row[name]) for name in (*IDENTIFYING_VERDICT_COLUMNS, *OTHER_REPORTED_VERDICT_COLUMNS)
    }
    return {"type": "verdict", "t_s": _seconds_since_start(row["t_start_ns"], drive_start_ns), **values}


def late_verdict(row: Row) -> Message:
    """Return the message of a row of `verdicts.parquet` that was not reported before, with the names of its columns."""
    return {"type": "verdict", **{name: _null_if_not_finite(value) for name, value in row.items()}}


def revised_verdict(row: Row) -> Message:
    """Return the message of a verdict of the whole log that differs from the reported one; `verdict` None: the log has no such verdict."""
    return {"type": "revised", **{name: _null_if_not_finite(value) for name, value in row.items()}}


def end(counts: Mapping[str, int], exit_code: int, why: str) -> Message:
    """Return the last message."""
    return {"type": "end", **counts, "exit_code": exit_code, "why": why}


def _seconds_since_start(t_ns: int, drive_start_ns: int) -> float:
    return round((t_ns - drive_start_ns) / 1e9, 6)
