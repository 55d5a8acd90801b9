"""Verdicts and findings as messages: JSON with the columns of `verdicts.parquet` and `findings.parquet`, and lines of a log."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import msgspec
from mcap.records import Schema

from drivelint.formats.foxglove import messages as foxglove
from drivelint.formats.protobuf import wire
from drivelint.resources import folder
from drivelint.result.text import finite

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pyarrow as pa

    from drivelint.annotate.clock import LogClock


class Message(NamedTuple):
    """One message: its log time and content."""

    log_time: int
    data: bytes


_LEVELS: Final = {"fail": foxglove.WARNING, "error": foxglove.ERROR, "unknown": foxglove.INFO, "pass": foxglove.WARNING}


@cache
def schema(name: str) -> Schema:
    """Return the MCAP schema record (still without id) of our message `verdict` or `finding`."""
    content = (folder("schemas") / f"{name}-message.schema.json").read_bytes()
    return Schema(id=0, name=f"drivelint.{name.title()}", encoding="jsonschema", data=content)


def verdict_messages(rows: pa.Table, clock: LogClock, t_start_ns: int) -> list[Message]:
    """Return every verdict at its reference point, else at its worst step, else where its interval begins."""
    return _in_order([_json(row, clock.at(display_time(row, t_start_ns))) for row in rows.to_pylist()])


def finding_messages(rows: pa.Table, clock: LogClock) -> list[Message]:
    """Return every finding where its failing stretch begins."""
    return _in_order([_json(row, clock.at(row["t_start_ns"])) for row in rows.to_pylist()])


def log_messages(rows: pa.Table, clock: LogClock, t_start_ns: int, sense_by_rule: Mapping[str, str]) -> list[Message]:
    """Return a `foxglove.Log` line for every verdict that a person should look at: fails, near misses, unknowns, errors."""
    lines = []
    for row in rows.to_pylist():
        if row["verdict"] in {"fail", "error", "unknown"} or row["near_miss"]:
            time = clock.at(display_time(row, t_start_ns))
            critical = (row["verdict"], row["severity"]) == ("fail", "critical")
            level = foxglove.ERROR if critical else _LEVELS[row["verdict"]]
            said = wire.text(3, f"{headline(row, sense_by_rule)}. {row['reason']}") + wire.text(4, row["rule_id"])
            lines.append(Message(time, wire.time(1, time) + wire.integer(2, level) + said))
    return _in_order(lines)


def display_time(row: dict[str, Any], t_start_ns: int) -> int:
    """Return the one time (ns, the trace's clock) at which a verdict is shown; the drive's start if it has none."""
    times = (row["t_ref_ns"], row["t_worst_ns"], row["t_start_ns"], t_start_ns)
    return int(next(t for t in times if t is not None))


def headline(row: dict[str, Any], sense_by_rule: Mapping[str, str]) -> str:
    """Return a verdict or finding in a few words: what, which rule, with whom, how much.

    `sense_by_rule`: rule -> relation that must hold.
    """
    word = "NEAR MISS" if row.get("near_miss") else row.get("verdict", "fail").upper().replace("_", " ")
    profile = f" [{row['profile']}]" if row["profile"] else ""
    who = f", {row['object_id']}" if row["object_id"] else ""
    start = f"{word} {row['rule_id'].partition('.')[2]}{profile}{who}"
    if row["observed"] is None or row["required"] is None:
        return start
    unit = f" {row['unit']}" if row["unit"] else ""
    return f"{start}: {row['observed']:.2f}{unit}, must be {sense_by_rule[row['rule_id']]} {row['required']:.2f}"


def _json(row: dict[str, Any], log_time: int) -> Message:
    # what is not known is left out: viewers refuse a schema that allows null
    known = {key: value for key, value in row.items() if finite(value) is not None}
    return Message(log_time, msgspec.json.encode(known))


def _in_order(messages: list[Message]) -> list[Message]:
    return sorted(messages, key=lambda m: m.log_time)
