"""The packed tables of an audit of many drives that nobody drove, written straight as chunks: to measure what reads them."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from drivelint.audit.compact import DRIVES_PER_CHUNK, RECEIPT_SCHEMA
from drivelint.audit.driver import empty_tables
from drivelint.audit.identity import rule_table, run_id, versions
from drivelint.audit.model import JudgeSettings
from drivelint.audit.run import AUDIT_FILE, RULES_FILE
from drivelint.audit.sealed import seal
from drivelint.audit.store import LocalFolder
from drivelint.result.files import parquet_bytes

if TYPE_CHECKING:
    from pathlib import Path

Row = dict[str, Any]

SITES: Final = ("leeds", "york", "hull")
PLACES: Final = np.array([[-1.549, 53.801], [-1.082, 53.958], [-0.336, 53.745]])
WORST: Final = 40
"""Findings that the first judged drive has more than the others, of the first rule."""
SECOND: Final = 1_000_000_000


class Lake(NamedTuple):
    """What was put into an audit: numbers that a report must have."""

    folder: Path
    n_drives: int
    n_not_judged: int
    n_findings: int
    worst_log: str


class _Drives(NamedTuple):
    """The judged drives of a chunk: arrays of one length; `at`: longitude and latitude."""

    numbers: Any
    keys: Any
    km: Any
    site: Any
    at: Any

    @property
    def names(self) -> Any:
        return np.array([f"drive-{n:06d}" for n in self.numbers])


def write(folder: Path, n_drives: int, seed: int = 0, settings: JudgeSettings | None = None) -> Lake:
    """Write an audit of drives of 1 to 40 km in three towns.

    Every third rule has findings, every fifth is never triggered, every fourth is unknown in Hull, where the logs have no
    indicators. One drive in a hundred was not judged.
    """
    settings = settings or JudgeSettings()
    rules = rule_table(settings)
    folder.mkdir(parents=True)
    told = {"run_id": run_id(settings), "versions": versions(), "settings": vars(settings), "fail_on": "critical"}
    (folder / "audit.json").write_text(json.dumps(told, default=str), encoding="utf-8")
    (folder / "rules.parquet").write_bytes(parquet_bytes(rules, "rule"))
    rng = np.random.Generator(np.random.PCG64(seed))
    n_lost = n_findings = 0
    worst: list[str] = []
    for first in range(0, n_drives, DRIVES_PER_CHUNK):
        numbers = np.arange(first, min(first + DRIVES_PER_CHUNK, n_drives))
        tables, drives = _chunk(rng, numbers, rules.to_pylist(), seed)
        worst.append(f"logs/{drives.names[0]}.mcap")
        n_lost += len(numbers) - len(drives.numbers)
        n_findings += tables["findings"].num_rows
        for name, rows in tables.items():
            path = folder / "tables" / name / f"{first:08d}.parquet"
            path.parent.mkdir(parents=True, exist_ok=True)
            pq.write_table(rows, path, compression="zstd")
    seal_anew(folder, seed)
    return Lake(folder, n_drives, n_lost, n_findings, worst[0])


def seal_anew(folder: Path, seed: int = 0) -> None:
    """List the files of an audit as they are, as after its end."""
    seal(LocalFolder(folder), [AUDIT_FILE, RULES_FILE], json.dumps({"digest": f"{seed:064d}"}).encode())


def _chunk(rng: np.random.Generator, numbers: Any, rules: list[Row], seed: int) -> tuple[dict[str, pa.Table], _Drives]:
    n = len(numbers)
    lost = rng.uniform(size=n) < 0.01
    site = numbers % 3
    keys = np.array([f"{seed:032d}{each:032d}" for each in numbers])
    whole = _Drives(numbers, keys, rng.uniform(1, 40, n), site, PLACES[site] + rng.normal(0, 0.02, (n, 2)))
    logs = [f"logs/{name}.mcap" for name in whole.names]
    lacking = {"ego_id": "0", "signal": "indicator", "reason_code": "missing_indicator", "reason": "no indicators"}
    drives = _table(
        "drives", n, key=keys, drive_id=whole.names, file_name=[f"{name}.mcap" for name in whole.names], log=logs, sha256=keys,
        format="osi-mcap", map_name="town.xodr", map_sha256="cd" * 32, handedness="lht", t_start_ns=0, duration_s=whole.km * 90.0,
        km=np.where(lost, 0.0, whole.km), n_states=5_000, n_steps=1_000, n_egos=1, lossy=False, lon=whole.at[:, 0], lat=whole.at[:, 1],
        tags=[[("release", f"v{each % 4}"), ("site", SITES[each % 3]), ("vehicle", f"car {each % 97}")] for each in numbers],
        exposure=[[] if bad else [_exposure(km)] for bad, km in zip(lost, whole.km, strict=True)],
        status=np.where(lost, "not_judged", "judged"),
        status_reason=[f"{log}: cannot be read" if bad else None for log, bad in zip(logs, lost, strict=True)],
        conditions=[[]] * n, occasions=[[]] * n, quality=[[]] * n,
        not_judged=[[lacking] if town == 2 and not bad else [] for town, bad in zip(site, lost, strict=True)],
    )  # fmt: skip
    status = ["refused" if bad else "judged" for bad in lost]
    known = {"key": pa.array(keys), "log": drives["log"], "status": pa.array(status)}
    known["options"] = pa.repeat('{"map":"town.xodr"}', n)
    receipts = [known[each.name] if each.name in known else pa.nulls(n, each.type) for each in RECEIPT_SCHEMA]
    judged = _Drives(*(column[~lost] for column in whole))
    parts = [
        _of_rule(rng, number, {**rule, "profile": profile}, judged)
        for number, rule in enumerate(rules)
        for profile in rule["profiles"] or [None]
    ]
    tables = {"verdicts": pa.concat_tables(p for p, _ in parts), "findings": pa.concat_tables(p for _, p in parts)}
    return {"drives": drives, **tables, "receipts": pa.table(receipts, schema=RECEIPT_SCHEMA)}, judged


def _of_rule(rng: np.random.Generator, number: int, rule: Row, drives: _Drives) -> tuple[pa.Table, pa.Table]:
    """Return verdicts and findings of one rule."""
    n = len(drives.numbers)
    many = rng.poisson(drives.km * per_km(number)) if number % 3 == 0 else np.zeros(n, int)
    many[0] += WORST if number == 0 and drives.numbers[0] < DRIVES_PER_CHUNK else 0
    unknown = (drives.site == 2) & (number % 4 == 1)
    idle = np.full(n, number % 5 == 4)
    many[unknown | idle] = 0
    words = np.select([unknown, idle, many > 0], ["unknown", "not_applicable", "fail"], "pass")
    codes = np.select([unknown, idle], ["missing_indicator", "not_triggered"], words)
    names = ("rule_id", "rule_version", "kind", "severity", "unit", "profile")
    same = {name: rule[name] for name in names} | {"ego_id": "0", "reason_measures": False}
    said = _table(
        "verdicts", n, **same, key=drives.keys, drive_id=drives.names, occurrence=0, verdict=words, reason_code=codes, reason=codes,
        observed=rng.uniform(0, 4, n), required=2.0, margin=rng.uniform(-2, 2, n), near_miss=False, n_expected=10,
        n_judged=np.where(unknown, 0, 10), t_start_ns=0, t_end_ns=9 * SECOND, t_worst_ns=5 * SECOND,
    )  # fmt: skip
    which = np.repeat(np.arange(n), many)
    nth = np.arange(len(which)) - np.repeat(np.cumsum(many) - many, many)
    spot = drives.at[which] + rng.normal(0, 0.004, (len(which), 2))
    ids = [f"{number}-{rule['profile']}-{i}-{k}" for i, k in zip(drives.numbers[which], nth, strict=True)]
    found = _table(
        "findings", len(which), **same, key=drives.keys[which], drive_id=drives.names[which], occurrence=nth, reason="too near",
        finding_id=ids, observed=1.0, required=2.0, margin=-1.0, t_start_ns=nth * 10 * SECOND, t_end_ns=(nth * 10 + 1) * SECOND,
        t_worst_ns=nth * 10 * SECOND, t_start_s=nth * 10.0, t_worst_s=nth * 10.0, x_m=0.0, y_m=0.0, lon=spot[:, 0], lat=spot[:, 1],
    )  # fmt: skip
    return said, found


def per_km(number: int) -> float:
    """Return how many findings the rule of a number has per km, in truth."""
    return 0.002 * (1 + number % 7)


def _exposure(km: float) -> Row:
    hours = km / 40
    return {"ego_id": "0", "km": km, "hours": hours, "engaged_km": km, "engaged_hours": hours, "n_steps": 1_000}


def _table(name: str, n: int, **columns: Any) -> pa.Table:
    """Return rows of a table of an audit; a single value is that of every row, a column that is not named is NULL."""
    schema = empty_tables()[name].schema
    made = []
    for each in schema:
        value = columns.pop(each.name, None)
        if value is None:
            made.append(pa.nulls(n, each.type))
        elif isinstance(value, str | int | float):
            made.append(pa.repeat(pa.scalar(value, each.type), n))
        else:
            made.append(pa.array(value, each.type))
    assert not columns, f"no such columns in {name}: {sorted(columns)}"
    return pa.table(made, schema=schema)
