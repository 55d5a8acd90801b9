"""`summary.json`: all counts, the inputs, and the exit code with its reason. The same run gives the same bytes."""

from __future__ import annotations

import json
from collections import Counter
from typing import TYPE_CHECKING, Any, Final

import duckdb

from drivelint import __version__
from drivelint.gate import descriptions
from drivelint.report.outcome import one_finding_per_event_and_status
from drivelint.result import counts
from drivelint.result.model import exit_status
from drivelint.result.schemas import OUTPUT_VERSION
from drivelint.result.text import replace_non_finite

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pyarrow as pa

    from drivelint.result.model import Result
    from drivelint.result.text import Row

_RULE_COLUMNS: Final = ["rule_id", "rule_version", "title", "severity", "status", "profiles", "params"]
_DRIVE_COLUMNS: Final = [
    "drive_id", "file_name", "sha256", "format", "map_name", "map_sha256", "handedness", "handedness_source",
    "status", "status_reason", "lossy", "duration_s", "km", "n_states", "n_steps", "n_egos",
    "conditions", "quality", "not_judged",
]  # fmt: skip


def render(result: Result) -> bytes:
    """Return the summary as UTF-8 JSON with a final newline."""
    return (
        json.dumps(replace_non_finite(content(result)), indent=2, ensure_ascii=False, allow_nan=False) + "\n"
    ).encode()


def content(result: Result) -> dict[str, Any]:
    """Return the summary as plain data; counts of verdicts include kinds that did not occur, with 0."""
    end = exit_status(result)
    near = result.verdicts.filter(result.verdicts["near_miss"])
    events = one_finding_per_event_and_status(result.gate, result.findings.to_pylist())
    return {
        "output_schema": OUTPUT_VERSION,
        "tool": {"name": "drivelint", "version": __version__, "duckdb": duckdb.__version__},
        "exit": {"code": int(end.code), "name": end.code.name.lower(), "why": end.why},
        "fail_on": result.fail_on,
        "strict": result.strict,
        "required": list(result.required),
        "interrupted": result.interrupted,
        **{name: why for name in ("min_judged", "halted", "ended_early") if (why := getattr(result, name)) is not None},
        "notes": list(result.notes),
        "gate": None if result.gate is None else descriptions.gate_counts(result.gate),
        "verdicts": counts.verdict_counts(result.verdicts),
        "near_misses": near.num_rows,
        "findings": counts.tally(result.findings, counts.SEVERITIES, "severity"),
        "events": {name: sum(row["severity"] == name for row in events) for name in counts.SEVERITIES},
        "packs": [
            {"pack": pack, "verdicts": verdict_counts}
            for pack, verdict_counts in counts.verdict_counts_by_pack(result.rules, result.verdicts).items()
        ],
        "rules": _rows_with_counts(result, result.rules.select(_RULE_COLUMNS), near, events),
        "drives": _rows_with_counts(result, result.drives.select(_DRIVE_COLUMNS), near, events),
    }


def _rows_with_counts(
    result: Result, rows: pa.Table, near_misses_table: pa.Table, events: Sequence[Row]
) -> list[dict[str, Any]]:
    """Return the rows with the numbers of their verdicts, near misses, findings and events; the first column is the id.

    A finding under two profiles is two rows of the table of findings, but one event.
    """
    key = rows.column_names[0]
    verdicts = counts.verdict_counts_by(result.verdicts, key)
    near_misses, findings = (Counter(table[key].to_pylist()) for table in (near_misses_table, result.findings))
    n_events = Counter(row[key] for row in events)
    return [
        {
            **row,
            "verdicts": verdicts[row[key]],
            "near_misses": near_misses[row[key]],
            "findings": findings[row[key]],
            "events": n_events[row[key]],
        }
        for row in rows.to_pylist()
    ]
