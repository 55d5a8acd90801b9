"""The order in which reports show findings: severity, contacts first, sure before possible, the least margin, then the time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import pyarrow as pa
import pyarrow.compute as pc

from drivelint.catalogue.header import CONTACT
from drivelint.result.certainty import POSSIBLE, SURE, certainty
from drivelint.result.counts import SEVERITIES
from drivelint.result.text import seconds

if TYPE_CHECKING:
    from collections.abc import Mapping

    from drivelint.result.text import Row

_ORDER: Final = (
    "severity_no", "no_contact", "sureness", "margin_or_0",
    "t_worst_ns", "drive_id", "ego_id", "rule_id", "profile", "object_id", "occurrence",
)  # fmt: skip


def worst_first(rows: pa.Table, rules: Mapping[str, Row]) -> pa.Table:
    """Return findings, or verdicts, in this order. `rules`: rule_id -> row of the table `rule`."""
    contacts = pa.array([rule_id for rule_id, rule in rules.items() if CONTACT in rule["tags"]], pa.string())
    keys = {
        "severity_no": pc.index_in(rows["severity"], value_set=pa.array(SEVERITIES)),
        "no_contact": pc.cast(pc.invert(pc.is_in(rows["rule_id"], value_set=contacts)), pa.int8()),
        "sureness": pa.array(map(sureness, _copies(rows)), pa.int8()),
        "margin_or_0": pc.fill_null(rows["margin"], 0.0),
    }
    keyed = rows
    for name, values in keys.items():
        keyed = keyed.append_column(name, values)
    return keyed.sort_by([(name, "ascending") for name in _ORDER]).drop_columns(list(keys))


def sureness(row: Row) -> int:
    """Return 0 for a sure finding, 1 where no copies were judged (as of every verdict), 2 for one that is only possible."""
    said = None if row.get("n_copies") is None else certainty(row)
    return {SURE: 0, None: 1, POSSIBLE: 2}[said]


def _copies(rows: pa.Table) -> list[Row]:
    told = rows.select([name for name in ("n_copies", "n_stays") if name in rows.column_names])
    return told.to_pylist() if told.num_columns else [{}] * rows.num_rows


def moment_ns(row: Row, rules: Mapping[str, Row]) -> int | None:
    """Return the time that is printed for a finding: for a contact its beginning, else its worst step."""
    moment: int | None = row["t_start_ns"] if _began_before(row, rules) else row["t_worst_ns"]
    return moment


def when(row: Row, rules: Mapping[str, Row], start_ns: int | None) -> str:
    """Return in words when a finding was; of a contact when it began, and when it was worst, if that was later."""
    later = worst_later(row, rules, start_ns)
    return f"{seconds(moment_ns(row, rules), start_ns)}{f' ({later})' if later else ''}"


def worst_later(row: Row, rules: Mapping[str, Row], start_ns: int | None) -> str:
    """Return in words when a contact was deepest, if that was after it began; '' for any other finding."""
    if not _began_before(row, rules):
        return ""
    return f"{'deepest' if row['unit'] == 'm' else 'worst'} at {seconds(row['t_worst_ns'], start_ns)}"


def _began_before(row: Row, rules: Mapping[str, Row]) -> bool:
    """Whether this is a finding of a contact that began before its worst step; a verdict's stretch is no contact."""
    if "finding_id" not in row or row["rule_id"] not in rules or not is_contact(row, rules):
        return False
    return row["t_start_ns"] is not None and row["t_start_ns"] != row["t_worst_ns"]


def is_contact(row: Row, rules: Mapping[str, Row]) -> bool:
    """Whether a finding of this rule says that the ego touched something."""
    return CONTACT in rules[row["rule_id"]]["tags"]
