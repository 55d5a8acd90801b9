"""`summary.json`: all counts, the inputs, the exit code and why; no clock, so the same run writes the same bytes."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

import duckdb

from drivelint import __version__
from drivelint.gate import descriptions
from drivelint.result import counts
from drivelint.result.model import exit_status
from drivelint.result.schemas import OUTPUT_VERSION

if TYPE_CHECKING:
    from drivelint.result.model import Result


def render(result: Result) -> bytes:
    """Return the summary as UTF-8 JSON with a final newline."""
    return (json.dumps(_finite(content(result)), indent=2, ensure_ascii=False, allow_nan=False) + "\n").encode()


def content(result: Result) -> dict[str, Any]:
    """Return the summary as plain data; verdict counts hold every verdict, zeros included."""
    end = exit_status(result)
    near = result.verdicts.filter(result.verdicts["near_miss"])
    return {
        "output_schema": OUTPUT_VERSION,
        "tool": {"name": "drivelint", "version": __version__, "duckdb": duckdb.__version__},
        "exit": {"code": int(end.code), "name": end.code.name.lower(), "why": end.why},
        "fail_on": result.fail_on,
        "strict": result.strict,
        "gate": None if result.gate is None else descriptions.gate_counts(result.gate),
        "verdicts": counts.total(result.verdicts),
        "near_misses": near.num_rows,
        "findings": counts.tally(result.findings, counts.SEVERITIES, "severity"),
        "packs": [
            {"pack": pack, "verdicts": told}
            for pack, told in counts.verdicts_by_pack(
                result.rules, counts.verdicts_by(result.verdicts, "rule_id")
            ).items()
        ],
        "rules": _rules(result, counts.rows_by(near, "rule_id")),
        "drives": _drives(result, counts.rows_by(near, "drive_id")),
    }


def _rules(result: Result, near: dict[str, int]) -> list[dict[str, Any]]:
    verdicts, findings = counts.verdicts_by(result.verdicts, "rule_id"), counts.rows_by(result.findings, "rule_id")
    columns = ["rule_id", "rule_version", "title", "severity", "status", "profiles", "params"]
    return [
        {
            **rule,
            "verdicts": verdicts.get(rule["rule_id"], dict.fromkeys(counts.VERDICTS, 0)),
            "near_misses": near.get(rule["rule_id"], 0),
            "findings": findings.get(rule["rule_id"], 0),
        }
        for rule in result.rules.select(columns).to_pylist()
    ]


def _drives(result: Result, near: dict[str, int]) -> list[dict[str, Any]]:
    verdicts, findings = counts.verdicts_by(result.verdicts, "drive_id"), counts.rows_by(result.findings, "drive_id")
    columns = [
        "drive_id", "file_name", "sha256", "format", "map_name", "map_sha256", "handedness", "handedness_source",
        "status", "status_reason", "lossy", "duration_s", "km", "n_states", "n_steps", "n_egos",
        "conditions", "quality", "not_judged",
    ]  # fmt: skip
    return [
        {
            **drive,
            "verdicts": verdicts.get(drive["drive_id"], dict.fromkeys(counts.VERDICTS, 0)),
            "near_misses": near.get(drive["drive_id"], 0),
            "findings": findings.get(drive["drive_id"], 0),
        }
        for drive in result.drives.select(columns).to_pylist()
    ]


def _finite(value: Any) -> Any:
    """Return plain data with NaN and infinity as null: neither is JSON."""
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    return [_finite(item) for item in value] if isinstance(value, list) else value
