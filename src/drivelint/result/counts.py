"""Counts verdicts by any column; each count has all verdicts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import pyarrow.compute as pc

if TYPE_CHECKING:
    import pyarrow as pa

VERDICTS: Final = ("pass", "fail", "unknown", "not_applicable", "error")
SEVERITIES: Final = ("critical", "major", "minor")


def total(verdicts: pa.Table) -> dict[str, int]:
    """Return verdict -> number of rows, zeros included."""
    return tally(verdicts, VERDICTS, "verdict")


def tally(rows: pa.Table, values: tuple[str, ...], column: str) -> dict[str, int]:
    """Return value -> number of rows whose `column` has it, for each of `values`."""
    found = {str(item["values"]): int(item["counts"]) for item in pc.value_counts(rows[column]).to_pylist()}
    return {value: found.get(value, 0) for value in values}


def count_assuming(verdicts: pa.Table, what: str) -> int:
    """Return the number of verdicts with this assumption in the column `assumes`."""
    return tally(verdicts, (what,), "assumes")[what]


def verdicts_by(verdicts: pa.Table, key: str) -> dict[str, dict[str, int]]:
    """Return key's value -> verdict -> number of rows; keys without rows are absent."""
    counted: dict[str, dict[str, int]] = {}
    for row in verdicts.group_by([key, "verdict"]).aggregate([([], "count_all")]).to_pylist():
        counted.setdefault(row[key], dict.fromkeys(VERDICTS, 0))[row["verdict"]] = row["count_all"]
    return counted


def verdicts_by_pack(rules: pa.Table, told: dict[str, dict[str, int]]) -> dict[str, dict[str, int]]:
    """Return pack -> verdict -> number of rows, from rule -> verdict -> number of rows; packs in the order of `rules`."""
    found: dict[str, dict[str, int]] = {}
    for rule_id, pack in zip(rules["rule_id"].to_pylist(), rules["pack"].to_pylist(), strict=True):
        sums = found.setdefault(pack, dict.fromkeys(VERDICTS, 0))
        for verdict, n in told.get(rule_id, {}).items():
            sums[verdict] += n
    return found


def rows_by(rows: pa.Table, key: str) -> dict[str, int]:
    """Return key's value -> number of rows."""
    return {item["values"]: item["counts"] for item in pc.value_counts(rows[key]).to_pylist()}
