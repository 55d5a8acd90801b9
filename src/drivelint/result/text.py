"""Formats numbers, times and findings identically for all reports."""

from __future__ import annotations

import math
from collections.abc import Mapping
from datetime import UTC, datetime, timedelta
from typing import Any, Final

from drivelint import phrases
from drivelint.result.certainty import doubt_words

NO_VALUE: Final = "-"
MOST_LABEL_CHARS: Final = 12
"""Largest number of characters of an id in a picture."""

Row = Mapping[str, Any]
"""One row of an output table: column -> value."""


def number(value: float | None, unit: str | None = None) -> str:
    """Return a measured value with two decimals (from 1e6 on three digits) and its unit; a dash for None."""
    if value is None:
        return NO_VALUE
    text = f"{value:.2f}" if abs(value) < 1e6 else f"{value:.3g}"
    return f"{text} {unit}" if unit else text


def breach_title(rule: Row) -> str:
    """Return the title for a breach of a rule. `rule`: a row of the table `rule`."""
    return rule["breach"] or f"Not kept: {rule['title']}"


def closing_speed_words(closing_mps: float) -> str:
    """Return in words how fast two road users approach each other, or move apart if `closing_mps` is negative."""
    apart = closing_mps < 0 and round(closing_mps, 2) != 0
    return f"{'moving apart' if apart else 'closing'} at {number(abs(closing_mps), 'm/s')}"


def non_breaking(text: str) -> str:
    """Return a number and its unit with a no-break space between them."""
    return text.replace(" ", "\u00a0", 1)


def measure(value: float | None, unit: str | None = None) -> str:
    """Return a measured value and its unit with a no-break space between them."""
    return non_breaking(number(value, unit))


def seconds(t_ns: int | None, start_ns: int | None) -> str:
    """Return a time on the log's clock as seconds since the drive's first time stamp."""
    return NO_VALUE if t_ns is None else f"{(t_ns - (start_ns or 0)) / 1e9:.2f} s"


def utc(t_ns: int | None) -> str | None:
    """Return a time since 1970 in UTC as ISO 8601, to the millisecond; None if unknown or beyond the year 9999 (another clock)."""
    try:
        at = None if t_ns is None else datetime(1970, 1, 1, tzinfo=UTC) + timedelta(microseconds=t_ns // 1000)
    except OverflowError:  # year 10,000 and beyond
        at = None
    return at.isoformat(timespec="milliseconds").replace("+00:00", "Z") if at else None


def utc_at(t_ns: int | None, drive: Row) -> str | None:
    """Return a time on a log's clock in UTC; None if the log lacks the UTC time. `drive`: the row of its drive."""
    start, since = drive["t_start_ns"], drive["utc_start_ns"]
    return None if None in {t_ns, start, since} else utc(since + t_ns - start)


def rule_name(row: Row) -> str:
    """Return the id of the rule of a verdict or finding, with the profile, if any."""
    return f"{row['rule_id']}" + ("" if row["profile"] is None else f" [{row['profile']}]")


def ego_name(ego_id: str) -> str:
    """Return an ego's name, such as "ego 7"; the id alone if it says "ego" itself, such as "Ego" or "ego_vehicle"."""
    return phrases.ego_name(ego_id)


def brief_id(actor_id: str) -> str:
    """Return an id, shortened for a picture: data sets have UUIDs of 36 characters."""
    return actor_id if len(actor_id) <= MOST_LABEL_CHARS else f"{actor_id[: MOST_LABEL_CHARS - 4]}…"


def ego_and_object_names(row: Row) -> str:
    """Return the names of the ego and, if any, the object of a verdict or finding."""
    ego = ego_name(row["ego_id"]) if row["ego_id"] else "no ego"
    return f"{ego}, object {row['object_id']}" if row["object_id"] is not None else ego


def measured_values_text(row: Row) -> str:
    """Return the observed and the required value with the margin; '' for a rule without measured values."""
    if row["observed"] is None and row["required"] is None:
        return ""
    unit = row["unit"]
    text = f"observed {number(row['observed'], unit)}, required {number(row['required'], unit)}"
    return text if row["margin"] is None else f"{text}, margin {number(row['margin'], unit)}"


def tolerance(row: Row, rule: Row) -> float | None:
    """Return the rule's tolerance within the required value, in the row's unit; None if there is none, or it is the whole value."""
    parameters = [p for p in rule["params"] if p["name"].startswith("tolerance_") and p["unit"] == row["unit"]]
    value = float(parameters[0]["value"]) if parameters else 0.0
    return None if not value or row["required"] is None or math.isclose(row["required"], value) else value


def verdict_or_finding_line(row: Row, when: str) -> str:
    """Return a verdict or finding as one line: `when`, ego and object, measured values, reason, and `doubt_words`.

    The measured values are omitted if the reason contains them.
    """
    values_text = "" if row["reason_measures"] else measured_values_text(row)
    parts = [f"{when}: {ego_and_object_names(row)}", values_text, row["reason"], doubt_words(row)]
    return "; ".join(part for part in parts if part)


def with_count(reason: str, n: int) -> str:
    """Return a reason with the number of its occurrences, if more than one."""
    return reason if n == 1 else f"{reason} ({n} times)"


def replace_non_finite(value: Any) -> Any:
    """Return nested plain data with None in place of NaN and infinity, which JSON cannot express."""
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: replace_non_finite(item) for key, item in value.items()}
    return [replace_non_finite(item) for item in value] if isinstance(value, list | tuple) else value
