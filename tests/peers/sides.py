"""Both sides' verdicts on a scenario, and the facts of the steps at which they were given."""

from __future__ import annotations

import json
import resource
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import duckdb

TWINS = {
    "interstate": {
        "stvo.rg1": "R_G1",
        "stvo.rg2": "R_G2",
        "stvo.rg3": "R_G3",
        "stvo.rg4": "R_G4",
        "stvo.ri1": "R_I1",
        "stvo.ri2": "R_I2",
        "stvo.ri3": "R_I3",
        "stvo.ri4": "R_I4",
        "stvo.ri5": "R_I5",
    },
    "limited": {"stvo.rg3": "R_G3", "stvo.rg4": "R_G4"},
    "intersection": {"stvo.rin1": "R_IN1"},
}
"""Our rules and the peer's, by the peer's kind of scenario. R_IN3 to R_IN5 have no rule here."""
CPU_S, MEMORY_BYTES = 900, 4_000_000_000
"""A peer that takes more for one scenario is stopped, and decides nothing in it."""
RANK = ("fail", "unknown", "pass", "not_applicable")


@dataclass
class Pair:
    """A rule and a vehicle of a scenario. `our_verdict`: the worst one, None without one. `peer_result`: kept or broken, None without one.

    `fails` and `breaks` are the time steps at which the rule is broken for us and for the peer, `n_judged` how many steps ours has judged.
    By step: `values` is what ours has measured, `needs` the deceleration by which, for us, somebody in the way asks the ego to brake, and
    `steps` what the peer sees.
    """

    scenario: str
    rule: str
    vehicle: str
    our_verdict: str | None
    peer_result: str | None
    reason: str | None = None
    fails: tuple[int, ...] = ()
    n_judged: int = 0
    breaks: tuple[int, ...] = ()
    last_step: int | None = None
    dt_s: float = 0.1
    values: dict[int, float] = field(default_factory=dict)
    needs: dict[int, float] = field(default_factory=dict)
    steps: dict[int, dict[str, Any]] = field(default_factory=dict)

    @property
    def ours_decides(self) -> bool:
        return self.our_verdict in ("pass", "fail", "not_applicable")

    @property
    def both_decide(self) -> bool:
        return self.ours_decides and self.peer_result is not None

    @property
    def differ(self) -> bool:
        return self.both_decide and (self.our_verdict == "fail") != (self.peer_result == "broken")


def _limited() -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_S, CPU_S))
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))


def peer_result(python: Path, scenario: Path, kind: str, out: Path) -> dict[str, Any] | str:
    """Run the peer on a scenario, unless the file is there already; return what it wrote, or the last line that it said."""
    if not out.exists():
        done = subprocess.run(
            [str(python), str(Path(__file__).with_name("stvo_peer.py")), str(scenario), kind, str(out)],
            capture_output=True,
            text=True,
            check=False,
            preexec_fn=_limited,
        )
        if not out.exists():
            said = done.stderr.strip().splitlines()
            return f"exit {done.returncode}" + (f": {said[-1]}" if said else "")
    told: dict[str, Any] = json.loads(out.read_text(encoding="utf-8"))
    return told


def our_result(scenario: Path, kind: str, out: Path) -> duckdb.DuckDBPyConnection:
    """Check a scenario with every vehicle as ego, unless that is done already; return its database, with `verdicts` and `margins`."""
    if not (out / "drivelint.duckdb").exists():
        command = [sys.executable, "-m", "drivelint", "check", str(scenario), "--ego", "all", "--env", "nation=de"]
        command += [part for rule in TWINS[kind] for part in ("--rules", rule)]
        command += ["--env", "road_type=motorway"] if kind != "intersection" else []
        command += ["--margins", "--keep-db", "--fail-on", "never", "--no-annotate", "--quiet", "--out", str(out)]
        subprocess.run(command, capture_output=True, text=True, check=False)
    con = duckdb.connect()
    con.execute(f"ATTACH '{out / 'drivelint.duckdb'}' AS kept (READ_ONLY)")
    for table in ("verdicts", "margins"):
        con.execute(f"CREATE VIEW {table} AS FROM read_parquet('{out / (table + '.parquet')}')")
    return con


def pairs(
    scenario: Path, kind: str, our_database: duckdb.DuckDBPyConnection, peer_answer: dict[str, Any] | str
) -> list[Pair]:
    """Return the pairs of a scenario; without a result of the peer each of our vehicles has pairs that it does not decide."""
    told = {} if isinstance(peer_answer, str) else peer_answer
    dt_s = told.get("dt_s", 0.1)
    rows = our_database.execute(
        """
        SELECT v.ego_id, v.rule_id, list({'verdict': verdict, 'reason': coalesce(cause_code, reason_code)}) AS found
        FROM verdicts v GROUP BY ALL ORDER BY ALL
        """
    ).fetchall()
    failed = our_database.execute(
        "SELECT ego_id, rule_id, list(t_s ORDER BY t_s) FROM margins WHERE margin < 0 GROUP BY ALL"
    ).fetchall()
    measured: dict[tuple[str, str], dict[int, float]] = {}
    for ego, rule, at_s, value in our_database.execute(
        "SELECT ego_id, rule_id, t_s, observed FROM margins WHERE observed IS NOT NULL"
    ).fetchall():
        measured.setdefault((ego, rule), {})[round(at_s / dt_s)] = value
    needs: dict[str, dict[int, float]] = {}
    if our_database.execute(
        "SELECT 1 FROM duckdb_tables() WHERE database_name = 'kept' AND table_name = 'in_way'"
    ).fetchone():
        query = """
            SELECT w.ego_id, (w.t_ns - c.t_begin_ns) / 1e9, w.need_mps2
            FROM kept.in_way w CROSS JOIN (SELECT min(t_start_ns) AS t_begin_ns FROM kept.clock) c WHERE w.need_mps2 > 0
        """
        for ego, at_s, need in our_database.execute(query).fetchall():
            needs.setdefault(ego, {})[round(at_s / dt_s)] = need
    counts = our_database.execute(
        "SELECT ego_id, rule_id, sum(n_judged)::INTEGER FROM verdicts GROUP BY ALL"
    ).fetchall()
    n_judged = {(ego, rule): n for ego, rule, n in counts}
    moments = our_database.execute(
        "SELECT ego_id, rule_id, list(t_worst_s) FROM verdicts WHERE verdict = 'fail' GROUP BY ALL"
    ).fetchall()
    times: dict[tuple[str, str], list[float]] = {}
    for ego, rule, at in [*failed, *moments]:
        times.setdefault((ego, rule), []).extend(value for value in at if value is not None)
    verdicts = {(ego, rule): found for ego, rule, found in rows}
    vehicles = {ego for ego, _ in verdicts} | set(told.get("first_step", {}))
    made = []
    for rule, twin in TWINS[kind].items():
        for vehicle in sorted(vehicles):
            found = verdicts.get((vehicle, rule), [])
            worst = min(found, key=lambda row: RANK.index(row["verdict"]), default=None)
            values = told.get("robustness", {}).get(twin, {}).get(vehicle)
            first = told.get("first_step", {}).get(vehicle, 0)
            # Robustness of a rule that is kept by nothing is 0 or more.
            breaks = tuple(first + k for k, value in enumerate(values or ()) if value is not None and value < 0)
            made.append(
                Pair(
                    scenario.stem,
                    rule,
                    vehicle,
                    our_verdict=worst["verdict"] if worst else None,
                    peer_result=None if not values else "broken" if breaks else "kept",
                    reason=worst["reason"] if worst and worst["verdict"] == "unknown" else None,
                    fails=tuple(sorted({round(at / dt_s) for at in times.get((vehicle, rule), [])})),
                    n_judged=n_judged.get((vehicle, rule)) or 0,
                    breaks=breaks,
                    last_step=first + len(values) if values else None,
                    dt_s=dt_s,
                    values=measured.get((vehicle, rule), {}),
                    needs=needs.get(vehicle, {}),
                    steps={row["step"]: row for row in told.get("steps", {}).get(vehicle, []) if "error" not in row},
                )
            )
    return made
