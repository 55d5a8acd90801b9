"""Verdicts and findings as messages: JSON with the columns of `verdicts.parquet` and `findings.parquet`, events, and lines of text."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import msgspec
from mcap.records import Schema

from drivelint.formats.foxglove import messages as foxglove
from drivelint.formats.protobuf import wire
from drivelint.resources import folder
from drivelint.result.certainty import POSSIBLE, certainty
from drivelint.result.text import replace_non_finite

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pyarrow as pa

    from drivelint.annotate.clock import LogClock


class Message(NamedTuple):
    """One message: its log time and content."""

    log_time: int
    data: bytes


_EVENT_FACTS: Final = ("rule_id", "profile", "severity", "ego_id", "object_id", "reason", "finding_id")
_LEVEL_OF_VERDICT: Final = {
    "fail": foxglove.WARNING,
    "error": foxglove.ERROR,
    "unknown": foxglove.INFO,
    "pass": foxglove.WARNING,
}


@cache
def message_schema(name: str) -> Schema:
    """Return the MCAP schema record, without an id, of a message of drivelint: `verdict`, `finding`, `measures` or `margin`."""
    content = (folder("schemas") / f"{name}-message.schema.json").read_bytes()
    return Schema(id=0, name=f"drivelint.{name.title()}", encoding="jsonschema", data=content)


def verdict_messages(rows: pa.Table, clock: LogClock, t_start_ns: int) -> list[Message]:
    """Return a message per verdict, at its reference point, else at its worst step, else at the start of its interval."""
    return _sort_by_log_time(
        [_json_message(row, clock.log_time_at(display_time_ns(row, t_start_ns))) for row in rows.to_pylist()]
    )


def finding_messages(rows: pa.Table, clock: LogClock) -> list[Message]:
    """Return a message per finding, at its first failing step."""
    return _sort_by_log_time([_json_message(row, clock.log_time_at(row["t_start_ns"])) for row in rows.to_pylist()])


def event_messages(rows: pa.Table, clock: LogClock, sense_by_rule: Mapping[str, str]) -> list[Message]:
    """Return a `foxglove.Event` for every finding, with its first and last failing step, and its facts as text."""
    events = []
    for row in rows.to_pylist():
        start, end = clock.log_time_at(row["t_start_ns"]), clock.log_time_at(row["t_end_ns"])
        unit = f" {row['unit']}" if row["unit"] else ""
        facts = {key: row[key] for key in _EVENT_FACTS}
        facts |= {key: f"{row[key]:.2f}{unit}" for key in ("observed", "required", "margin") if row[key] is not None}
        facts |= {"finding": headline(row, sense_by_rule), "certainty": certainty(row)}
        pairs = (wire.text(1, key) + wire.text(2, str(fact)) for key, fact in facts.items() if fact is not None)
        content = wire.time(1, start) + wire.time(2, end) + b"".join(wire.nested(3, pair) for pair in pairs)
        events.append(Message(start, content))
    return _sort_by_log_time(events)


def foxglove_log_messages(
    verdicts: pa.Table, findings: pa.Table, clock: LogClock, t_start_ns: int, sense_by_rule: Mapping[str, str]
) -> list[Message]:
    """Return `foxglove.Log` lines for a person: each finding once, at its start; near misses, unknown verdicts and errors."""
    rows = [{**row, "verdict": "fail", "t_ns": row["t_start_ns"]} for row in findings.to_pylist()]
    rows += [
        {**row, "t_ns": display_time_ns(row, t_start_ns)}
        for row in verdicts.to_pylist()
        if row["verdict"] in {"error", "unknown"} or row["near_miss"]
    ]
    return _sort_by_log_time(
        [_foxglove_log_message(row, clock.log_time_at(row["t_ns"]), sense_by_rule) for row in rows]
    )


def _foxglove_log_message(row: dict[str, Any], time: int, sense_by_rule: Mapping[str, str]) -> Message:
    critical = (row["verdict"], row["severity"]) == ("fail", "critical")
    level = foxglove.ERROR if critical else _LEVEL_OF_VERDICT[row["verdict"]]
    # a reason that states the numbers needs no headline with the same numbers
    opening = f"{_outcome_rule_and_object(row)}:" if row["reason_measures"] else f"{headline(row, sense_by_rule)}."
    text = f"{opening} {row['reason'][:1].upper()}{row['reason'][1:]}"
    return Message(
        time, wire.time(1, time) + wire.integer(2, level) + wire.text(3, text) + wire.text(4, row["rule_id"])
    )


def display_time_ns(row: dict[str, Any], t_start_ns: int) -> int:
    """Return the time (ns, the trace's clock) at which a verdict is shown; the drive's start if the verdict has no time."""
    times = (row["t_ref_ns"], row["t_worst_ns"], row["t_start_ns"], t_start_ns)
    return int(next(t for t in times if t is not None))


def headline(row: dict[str, Any], sense_by_rule: Mapping[str, str]) -> str:
    """Return a verdict or finding in a few words: outcome, rule, object and numbers.

    `sense_by_rule`: rule -> relation that must hold.
    """
    start = _outcome_rule_and_object(row)
    if row["observed"] is None or row["required"] is None:
        return start
    unit = f" {row['unit']}" if row["unit"] else ""
    return f"{start}: {row['observed']:.2f}{unit}, must be {sense_by_rule[row['rule_id']]} {row['required']:.2f}"


def _outcome_rule_and_object(row: dict[str, Any]) -> str:
    """Return the outcome, the rule and the object in words; "possible" if too few copies of the drive have the finding."""
    word = "NEAR MISS" if row.get("near_miss") else row.get("verdict", "fail").upper().replace("_", " ")
    possible = "POSSIBLE " if "n_copies" in row and certainty(row) == POSSIBLE else ""
    profile = f" [{row['profile']}]" if row["profile"] else ""
    object_words = f", {row['object_id']}" if row["object_id"] else ""
    return f"{possible}{word} {row['rule_id'].partition('.')[2]}{profile}{object_words}"


def _json_message(row: dict[str, Any], log_time: int) -> Message:
    # viewers refuse a schema that allows null, so a message leaves out fields with unknown values
    known_fields = {key: value for key, value in row.items() if replace_non_finite(value) is not None}
    return Message(log_time, msgspec.json.encode(known_fields))


def _sort_by_log_time(messages: list[Message]) -> list[Message]:
    return sorted(messages, key=lambda m: m.log_time)
