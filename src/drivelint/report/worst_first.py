"""The order of findings in reports: by severity, contacts first, sure before possible, then by margin and time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import pyarrow as pa
import pyarrow.compute as pc

from drivelint.catalogue.header import CONTACT_TAG
from drivelint.result.certainty import POSSIBLE, SURE, certainty
from drivelint.result.counts import SEVERITIES
from drivelint.result.text import seconds

if TYPE_CHECKING:
    from collections.abc import Mapping

    from drivelint.result.text import Row

_SORT_COLUMNS: Final = (
    "severity_no", "no_contact", "sureness", "margin_or_0",
    "t_worst_ns", "drive_id", "ego_id", "rule_id", "profile", "object_id", "occurrence",
)  # fmt: skip


def worst_first(rows: pa.Table, rules: Mapping[str, Row]) -> pa.Table:
    """Return findings or verdicts in the order of reports. `rules`: the rows of the table `rule` by `rule_id`."""
    contacts = pa.array([rule_id for rule_id, rule in rules.items() if CONTACT_TAG in rule["tags"]], pa.string())
    keys = {
        "severity_no": pc.index_in(rows["severity"], value_set=pa.array(SEVERITIES)),
        "no_contact": pc.cast(pc.invert(pc.is_in(rows["rule_id"], value_set=contacts)), pa.int8()),
        "sureness": pa.array(map(certainty_rank, _copy_counts(rows)), pa.int8()),
        "margin_or_0": pc.fill_null(rows["margin"], 0.0),
    }
    keyed = rows
    for name, values in keys.items():
        keyed = keyed.append_column(name, values)
    return keyed.sort_by([(name, "ascending") for name in _SORT_COLUMNS]).drop_columns(list(keys))


def certainty_rank(row: Row) -> int:
    """Return 0 for a sure finding, 2 for a finding that is only possible, and 1 for a verdict or if no copies were judged."""
    word = None if row.get("n_copies") is None else certainty(row)
    return {SURE: 0, None: 1, POSSIBLE: 2}[word]


def _copy_counts(rows: pa.Table) -> list[Row]:
    count_columns = rows.select([name for name in ("n_copies", "n_stays") if name in rows.column_names])
    return count_columns.to_pylist() if count_columns.num_columns else [{}] * rows.num_rows


def moment_ns(row: Row, rules: Mapping[str, Row]) -> int | None:
    """Return the time that reports print for a finding: the beginning of a contact, else the worst step."""
    moment: int | None = row["t_start_ns"] if _has_begun_before_worst(row, rules) else row["t_worst_ns"]
    return moment


def when(row: Row, rules: Mapping[str, Row], start_ns: int | None) -> str:
    """Return the time of a finding in words; for a contact, its beginning, and its worst time if that was later."""
    later = worst_time_words(row, rules, start_ns)
    return f"{seconds(moment_ns(row, rules), start_ns)}{f' ({later})' if later else ''}"


def worst_time_words(row: Row, rules: Mapping[str, Row], start_ns: int | None) -> str:
    """Return in words when a contact was worst, if that was after it began; '' for other findings."""
    if not _has_begun_before_worst(row, rules):
        return ""
    return f"{'deepest' if row['unit'] == 'm' else 'worst'} at {seconds(row['t_worst_ns'], start_ns)}"


def _has_begun_before_worst(row: Row, rules: Mapping[str, Row]) -> bool:
    """Return whether this is a finding of a contact that began before its worst step; False for a verdict."""
    if "finding_id" not in row or row["rule_id"] not in rules or not is_contact(row, rules):
        return False
    return row["t_start_ns"] is not None and row["t_start_ns"] != row["t_worst_ns"]


def is_contact(row: Row, rules: Mapping[str, Row]) -> bool:
    """Return whether the finding's rule detects that the ego touched something."""
    return CONTACT_TAG in rules[row["rule_id"]]["tags"]
