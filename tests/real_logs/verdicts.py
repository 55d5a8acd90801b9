"""Judges a log of the reference data, and compares two sets of results."""

from __future__ import annotations

import subprocess
import sys
from typing import TYPE_CHECKING, NamedTuple

import duckdb

from tests.false_alarms.count import REAL
from tests.shared_data import DATA

if TYPE_CHECKING:
    from pathlib import Path

PROFILES = ("nominal", "relaxed", "aggressive", "observed")
_WORST = """
    SELECT drive_id, ego_id, rule_id, coalesce(profile, '') AS profile, min({
        'rank': list_position(['error', 'fail', 'unknown', 'pass', 'not_applicable'], verdict), 'verdict': verdict, 'reason': reason
    }) AS worst
    FROM read_parquet(?) GROUP BY ALL
"""


class Change(NamedTuple):
    """How many (drive, ego, profile) of a log went from one verdict on a rule to another, with one of them."""

    log: str
    rule: str
    before: str | None
    after: str | None
    n: int
    example: str


def judge(name: str, folder: Path) -> str:
    """Check a log of `REAL` into a folder of its name; return how that ended."""
    log, road, options = REAL[name]
    command = [
        sys.executable,
        "-m",
        "drivelint",
        "check",
        str(DATA / log),
        *(("--map", str(DATA / road)) if road else ()),
        *options,
    ]
    command += [part for profile in PROFILES for part in ("--profile", profile)]
    command += [
        "--rules",
        "all",
        "--ego",
        "all",
        "--fail-on",
        "never",
        "--no-annotate",
        "--quiet",
        "--out",
        str(folder / _file(name)),
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    said = done.stderr.strip().splitlines()
    return f"exit {done.returncode}{': ' + said[-1] if done.returncode and said else ''}"


def changes(old: Path, new: Path) -> list[Change]:
    """Return what differs between the results in two folders, by log and rule."""
    found = []
    for name in REAL:
        before, after = (folder / _file(name) / "verdicts.parquet" for folder in (old, new))
        if before.exists() and after.exists():
            with duckdb.connect() as con:
                con.execute(f"CREATE TABLE a AS {_WORST}", [str(before)])
                con.execute(f"CREATE TABLE b AS {_WORST}", [str(after)])
                rows = con.execute(
                    """
                    SELECT rule_id, a.worst.verdict, b.worst.verdict, count(*),
                        min(drive_id || ' ' || ego_id || ': ' || coalesce(a.worst.reason, '-') || ' | ' || coalesce(b.worst.reason, '-'))
                    FROM a FULL JOIN b USING (drive_id, ego_id, rule_id, profile)
                    WHERE a.worst.verdict IS DISTINCT FROM b.worst.verdict
                    GROUP BY ALL ORDER BY ALL
                    """
                ).fetchall()
            found += [Change(name, *row) for row in rows]
    return found


def _file(name: str) -> str:
    return "".join(letter if letter.isalnum() else "-" for letter in name)
