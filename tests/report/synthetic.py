"""Small results made by hand: verdict rows as prose, everything else filled in."""

from __future__ import annotations

from typing import Any

import pyarrow as pa

from drivelint.result.model import Result
from drivelint.sql.store import arrow_schemas

SECOND = 1_000_000_000
SDA = "ukhc.r162.safe-distance-ahead"


def table(name: str, rows: list[dict[str, Any]]) -> pa.Table:
    """Return a schema table from rows that name only some columns; the others are NULL."""
    schema = arrow_schemas()[name]
    unknown = {key for row in rows for key in row} - set(schema.names)
    assert not unknown, f"no such columns in {name}: {unknown}"
    return pa.Table.from_pylist(rows, schema=schema)


def verdict(word: str, **over: Any) -> dict[str, Any]:
    """Return one verdict row of the nominal overtake rule, 8.3 s into drive `d1`."""
    return {
        "drive_id": "d1", "ego_id": "1", "rule_id": SDA, "rule_version": "v", "kind": "execution", "profile": "nominal",
        "severity": "critical", "object_id": "3", "occurrence": 0, "ref_id": 0, "t_ref_ns": 108 * SECOND,
        "t_start_ns": 108 * SECOND, "t_end_ns": 108 * SECOND, "t_worst_ns": 108 * SECOND, "verdict": word,
        "reason_code": word, "reason": f"because {word}", "reason_measures": False,
        "observed": 58.0, "required": 64.0, "margin": -6.0,
        "unit": "m", "near_miss": False, "assumes": None, "n_expected": 1, "n_judged": 1, "finding_ids": [],
    } | over  # fmt: skip


def finding(**over: Any) -> dict[str, Any]:
    """Return the finding of a failing `verdict`."""
    row = verdict("fail", **over)
    row = {"finding_id": f"{row['drive_id']}-{row['rule_id']}-{row['profile']}-{row['occurrence']}"} | row
    return {key: row[key] for key in arrow_schemas()["finding"].names if key in row}


def recorded(*actors: str, start_s: float = 100.0, end_s: float = 125.0) -> list[dict[str, Any]]:
    """Return what a drive says of actors that are recorded from one time of the log's clock to another."""
    times = {"t_from_ns": round(start_s * SECOND), "t_to_ns": round(end_s * SECOND)}
    return [{"actor_id": actor} | times for actor in actors]


def drive(drive_id: str = "d1", **over: Any) -> dict[str, Any]:
    """Return the row of a judged drive of 25 s, with four actors, whose clock starts at 100 s."""
    sha256 = "ab" * 32 if drive_id == "d1" else f"{drive_id.encode().hex():0>64}"
    start_s = over.get("t_start_ns", 100 * SECOND) / SECOND
    return {
        "drive_id": drive_id, "file_name": f"{drive_id}.csv", "sha256": sha256, "format": "canonical-csv",
        "environment_id": "road-1@lht", "map_name": "road.xodr", "map_sha256": "cd" * 32, "handedness": "lht",
        "handedness_source": "attribute", "t_start_ns": 100 * SECOND, "duration_s": 25.0, "km": 0.12, "n_states": 750,
        "n_steps": 250, "n_egos": 1, "status": "judged", "lossy": False, "conditions": [], "exposure": [], "occasions": [], "quality": [],
        "not_judged": [], "recorded": recorded(*"1234", start_s=start_s, end_s=start_s + 25),
    } | over  # fmt: skip


def rule(rule_id: str = SDA, **over: Any) -> dict[str, Any]:
    """Return the row of a stable critical rule."""
    return {
        "rule_id": rule_id, "rule_version": "v", "pack": "ukhc", "pack_title": "UK Highway Code", "law": [], "tags": [],
        "title": "room to overtake", "clause": "Rule 162",
        "hypothesis": "is there room?", "kind": "execution", "derivation": "model", "severity": "critical",
        "legal": "should", "status": "stable", "is_named": False, "sense": ">", "unit": "m", "requires": [], "profiles": ["nominal"],
        "params": [],
    } | over  # fmt: skip


def result(
    verdicts: list[dict[str, Any]],
    findings: list[dict[str, Any]] | None = None,
    drives: list[dict[str, Any]] | None = None,
    rules: list[dict[str, Any]] | None = None,
    **settings: Any,
) -> Result:
    """Return a result; one judged drive and one stable rule unless said otherwise."""
    return Result(
        table("verdict", verdicts),
        table("finding", findings or []),
        table("drive", drives or [drive()]),
        table("rule", rules or [rule()]),
        **settings,
    )
