"""Numbers for a viewer's plots: measures of the ego at each step, and the margins around findings and near misses."""

from __future__ import annotations

import re
from itertools import groupby
from typing import TYPE_CHECKING, Final, NamedTuple

import msgspec
import numpy as np

from drivelint.annotate.result_messages import Message
from drivelint.result.counts import SEVERITIES
from drivelint.result.text import replace_non_finite

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from typing import Any

    import pyarrow as pa

    from drivelint.annotate.clock import LogClock

MAX_WRITTEN_STEPS: Final = 50_000
"""If a drive has more steps, only every second, third ... step is written: no plot shows more points."""


class MarginSeries(NamedTuple):
    """The margins of one rule and profile: a line of a plot. Series are ordered by severity, then rule."""

    severity: int
    rule_id: str
    profile: str
    unit: str


def measure_messages(rows: pa.Table, clock: LogClock) -> list[Message]:
    """Return the measures of one drive, one message per step; `rows`: result of `evidence/first_ego_measures.sql`, in time order."""
    every = max(1, -(-len(rows) // MAX_WRITTEN_STEPS))
    return _json_messages(rows.drop_columns("drive_id").to_pylist()[::every], clock)


def margin_messages(rows: pa.Table, clock: LogClock) -> dict[str, list[Message]]:
    """Return rule -> its margins in time order; `rows`: one drive's rows of `evidence/least_margin.sql`."""
    margin_rows = rows.drop_columns("drive_id").to_pylist()
    by_rule = groupby(margin_rows, key=lambda row: str(row["rule_id"]))
    return {
        rule: sorted(_json_messages(list(steps), clock), key=lambda message: message.log_time)
        for rule, steps in by_rule
    }


def margin_topic(rule_id: str) -> str:
    """Return the topic of a rule's margins without the prefix. It has no dots, as viewers do not allow them in the path of a message."""
    return "margins/" + re.sub(r"[^\w/-]", "_", rule_id.replace(".", "/"))


def margin_series(rows: pa.Table, rules: Iterable[Mapping[str, Any]]) -> set[MarginSeries]:
    """Return the series that have margins; `rows`: result of `evidence/least_margin.sql`."""
    about = {rule["rule_id"]: rule for rule in rules}
    margin_rows = rows.filter(rows["margin"].is_valid()).select(["rule_id", "profile"])
    keys = margin_rows.group_by(["rule_id", "profile"]).aggregate([]).to_pylist()
    return {
        MarginSeries(SEVERITIES.index(rule["severity"]), rule["rule_id"], key["profile"] or "", rule["unit"] or "")
        for key in keys
        for rule in [about[key["rule_id"]]]
    }


def _json_messages(rows: list[dict[str, Any]], clock: LogClock) -> list[Message]:
    times = clock.log_times(np.array([row["t_ns"] for row in rows], np.int64)).tolist()
    known_rows = ({key: value for key, value in row.items() if replace_non_finite(value) is not None} for row in rows)
    return [Message(time, msgspec.json.encode(row)) for time, row in zip(times, known_rows, strict=True)]
