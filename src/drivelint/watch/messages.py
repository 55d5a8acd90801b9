"""The messages of a watch: JSON objects, one per line, each with its `type` first. Times in seconds count from the log's first step."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

from drivelint.watch.settled import KEY, SAID

if TYPE_CHECKING:
    from collections.abc import Mapping

    from drivelint.catalogue import Rule
    from drivelint.result.text import Row
    from drivelint.watch.alarms import Alarm

Message = dict[str, Any]

_OF_ROW: Final = (
    "profile", "severity", "object_id", "ego_id", "t_start_ns", "t_end_ns", "t_worst_ns", "t_ref_ns", "observed", "required", "margin",
    "unit", "x_m", "y_m", "lon", "lat", "lanelet_id", "closing_mps", "reason",
)  # fmt: skip


def _plain(value: object) -> object:
    return None if isinstance(value, float) and not math.isfinite(value) else value


def alarm(each: Alarm, rule: Rule, start_ns: int) -> Message:
    """Return the message of a new alarm."""
    row = each.row
    return {
        "type": "alarm",
        "alarm": each.number,
        "rule_id": rule.id,
        "title": rule.title,
        "t_s": _seconds(row["t_start_ns"], start_ns),
        "said_s": _seconds(each.said_ns, start_ns),
        "latency_s": round(each.latency_s, 6),
        "is_early": each.is_early,
        "status": rule.status,
        **{name: _plain(row[name]) for name in _OF_ROW},
    }


def over(each: Alarm, start_ns: int) -> Message:
    """Return the message of an alarm whose rule is kept again, or is not judged any more."""
    return {
        "type": "over",
        "alarm": each.number,
        "rule_id": each.row["rule_id"],
        "t_end_s": _seconds(each.t_end_ns, start_ns),
        "t_end_ns": each.t_end_ns,
    }


def withdrawn(each: Alarm, now_ns: int, start_ns: int) -> Message:
    """Return the message that what is known now does not show an alarm any more."""
    return {
        "type": "withdrawn",
        "alarm": each.number,
        "rule_id": each.row["rule_id"],
        "t_s": _seconds(now_ns, start_ns),
        "t_ns": now_ns,
    }


def halt(each: Alarm, now_ns: int, start_ns: int) -> Message:
    """Return the message that an alarm halts the drive."""
    return {
        "type": "halt",
        "alarm": each.number,
        "rule_id": each.row["rule_id"],
        "t_s": _seconds(now_ns, start_ns),
        "t_ns": now_ns,
        "after_s": round((now_ns - each.row["t_start_ns"]) / 1e9, 6),
    }


def note(text: str) -> Message:
    """Return the message of something that a person should know."""
    return {"type": "note", "text": text}


def confirmed(each: Alarm) -> Message:
    """Return what the check of the whole log made of an alarm."""
    return {
        "type": "checked",
        "alarm": each.number,
        "rule_id": each.row["rule_id"],
        "is_finding": bool(each.finding_ids),
        "finding_ids": each.finding_ids,
    }


def settled(row: Row, start_ns: int) -> Message:
    """Return the message of a verdict that is said before the log's end."""
    said = {name: _plain(row[name]) for name in (*KEY, *SAID)}
    return {"type": "verdict", "t_s": _seconds(row["t_start_ns"], start_ns), **said}


def verdict(row: Row) -> Message:
    """Return the message of a row of `verdicts.parquet` that was not said before, with the names that it has there."""
    return {"type": "verdict", **{name: _plain(value) for name, value in row.items()}}


def revised(row: Row) -> Message:
    """Return the message of a verdict of the whole log that is another than was said; `verdict` None: the whole log has none."""
    return {"type": "revised", **{name: _plain(value) for name, value in row.items()}}


def end(counts: Mapping[str, int], exit_code: int, why: str) -> Message:
    """Return the last message."""
    return {"type": "end", **counts, "exit_code": exit_code, "why": why}


def _seconds(t_ns: int, start_ns: int) -> float:
    return round((t_ns - start_ns) / 1e9, 6)
