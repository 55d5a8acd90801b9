"""What drivelint says of a simulated log, against the independent reading."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections import Counter
from typing import TYPE_CHECKING, Any, NamedTuple

import duckdb

from tests.sumo.contacts import Contact
from tests.sumo.reading import PROFILES, Overtake, edges, jumps

if TYPE_CHECKING:
    from collections.abc import Collection
    from pathlib import Path

    from tests.sumo.reading import Log
    from tests.sumo.world import Files

DA_M = 0.5
OVERTAKES, COLLISIONS = "ukhc.r162.safe-distance-ahead", "ukhc.no-collision"
OPEN_M = 400.0  # so near to the road's end a vehicle that comes in soon leaves the distance open


class CheckResult(NamedTuple):
    """What a run found: overtakes by (ego, step, VBP), contacts, how often those are unknown, and the seconds taken."""

    overtakes: dict[tuple[str, int, str], dict[str, Any]]
    contacts: list[tuple[str, str, int, int]]
    unknown: int
    states: int
    seconds: float


def check(files: Files, out: Path, *, rules: tuple[str, ...] = (OVERTAKES, COLLISIONS)) -> CheckResult:
    """Check a log with every vehicle as ego."""
    begin = time.monotonic()
    command = [sys.executable, "-m", "drivelint", "check", str(files.log), "--map", str(files.map), "--ego", "all"]
    command += [part for rule in rules for part in ("--rules", rule)]
    command += [part for name in PROFILES for part in ("--profile", name)]
    command += ["--mapping", str(files.routes), "--out", str(out), "--keep-db", "--no-annotate", "--quiet"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=os.environ)
    if done.returncode not in {0, 1}:
        raise RuntimeError(f"drivelint ended with {done.returncode}: {done.stderr}")
    seconds = time.monotonic() - begin
    with duckdb.connect(str(out / "drivelint.duckdb"), read_only=True) as con:
        states = con.execute("SELECT count(*) FROM actor_state").fetchall()[0][0]
        found = con.execute(
            "SELECT ego_id, object_id, t_start_ns, t_end_ns FROM finding WHERE rule_id = ? ORDER BY ALL", [COLLISIONS]
        ).fetchall()
        unknown = con.execute(
            "SELECT count(*) FROM verdict WHERE rule_id = ? AND verdict = 'unknown'", [COLLISIONS]
        ).fetchall()[0][0]
        touched = [(ego, other, round(a / 1e8), round(b / 1e8)) for ego, other, a, b in found]
        return CheckResult(_overtakes(con), touched, unknown, states, seconds)


def _overtakes(con: duckdb.DuckDBPyConnection) -> dict[tuple[str, int, str], dict[str, Any]]:
    rows = con.execute(
        """
        SELECT o.ego_id, o.t0_ns, o.vbp_id, o.ov_id, o.da_m, o.t3_ns, o.passed, s.profile, s.sda_m, v.verdict, v.reason, v.cause_args,
            (SELECT list(u.object_id) FROM unplaced u WHERE u.ego_id = o.ego_id AND u.t_ns = o.t0_ns) AS unplaced
        FROM overtake o
        JOIN overtake_sda s USING (drive_id, ego_id, occurrence)
        LEFT JOIN (
            -- several vehicles passed in one go share the time and the oncoming vehicle, and stand in the same order
            SELECT *, row_number() OVER (PARTITION BY ego_id, profile, t_ref_ns ORDER BY occurrence) AS n
            FROM verdict WHERE rule_id = $rule AND verdict <> 'not_applicable'
        ) v ON v.ego_id = o.ego_id AND v.profile = s.profile AND v.t_ref_ns = o.t0_ns AND v.n = (
            SELECT count(*) FROM overtake b WHERE b.ego_id = o.ego_id AND b.t0_ns = o.t0_ns AND b.occurrence <= o.occurrence
        )
        WHERE list_contains($profiles, s.profile)
        """,
        {"rule": OVERTAKES, "profiles": list(PROFILES)},
    ).fetchall()
    found: dict[tuple[str, int, str], dict[str, Any]] = {}
    for ego, t0, vbp, ov, da, t3, passed, profile, sda, verdict, reason, cause, unplaced in rows:
        row = found.setdefault(
            (ego, round(t0 / 1e8), vbp),
            {
                "ov": ov,
                "da_m": da,
                "t3": None if t3 is None else t3 / 1e9,
                "passed": passed,
                "unplaced": set(unplaced or ()),
                "sda_m": {},
                "verdicts": {},
            },
        )
        row["sda_m"][profile], row["verdicts"][profile] = sda, (verdict, reason, _innermost(cause))
    return found


def known_by(overtake: Overtake) -> tuple[str, int, str]:
    """Return what an overtake is known by: the ego, the step of t0, the VBP."""
    return overtake.ego, round(overtake.t0 * 10), overtake.vbp


def differences(read_overtakes: list[Overtake], result: CheckResult, log: Log) -> tuple[list[str], Counter[str]]:
    """Return what differs, and a count of what was compared."""
    moves, ends = jumps(log), edges(log)
    counts: Counter[str] = Counter()
    expected = {known_by(o): o for o in read_overtakes}
    found = [
        f"{key}: only {'read' if key in expected else 'found by drivelint'}"
        for key in sorted(expected.keys() ^ result.overtakes.keys())
    ]
    for key in sorted(expected.keys() & result.overtakes.keys()):
        mine, theirs = expected[key], result.overtakes[key]
        counts["overtakes"] += 1
        counts["passed" if mine.passed else "not passed"] += 1
        if (mine.ov, mine.passed) != (theirs["ov"], theirs["passed"]):
            found.append(f"{key}: {mine.ov}, {mine.passed} read, {theirs['ov']}, {theirs['passed']} found")
        if abs(mine.da_m - theirs["da_m"]) > DA_M:
            found.append(f"{key}: DA {mine.da_m:.2f} m read, {theirs['da_m']:.2f} m found")
        counts[f"back {_later(mine.t3, theirs['t3'])}"] += 1
        for profile in PROFILES:
            verdict, reason, cause = theirs["verdicts"][profile]
            counts[f"{profile}: {verdict}"] += 1
            if verdict == mine.verdicts[profile]:
                continue
            # near its end the road beyond is not told: somebody came in over it soon after
            if (
                (mine.verdicts[profile], verdict) == ("pass", "unknown")
                and cause.get("lack") == "appeared"
                and mine.end_m < OPEN_M
            ):
                counts["open, near the road's end"] += 1
                continue
            # drivelint takes the place of a vehicle that SUMO moves for unknown then
            moved = any(who in theirs["unplaced"] and abs(step - key[1]) <= 1 for who, step in moves)
            if (mine.verdicts[profile], verdict) == ("pass", "unknown") and moved:
                counts["SUMO moves somebody just then"] += 1
                continue
            # and does not know how far off another entered or left, as the ego is moved just then
            at_edge = any(
                (cause.get("object_id"), cause.get("lack")) == (other, what) and abs(step - at) <= 1
                for who, step in moves
                if who == key[0]
                for other, both in ends.items()
                for what, at in zip(("appeared", "lost"), both, strict=True)
            )
            if (mine.verdicts[profile], verdict) == ("pass", "unknown") and at_edge:
                counts["SUMO moves the ego as somebody enters or leaves"] += 1
                continue
            found.append(f"{key} {profile}: {mine.verdicts[profile]} read, {verdict} found ({reason})")
    return found, counts


def _innermost(cause_args: str | None) -> dict[str, Any]:
    """Return the arguments of a cause; where its `lack` is a reason of its own, those of that."""
    args: dict[str, Any] = json.loads(cause_args or "{}")
    lack = args.get("lack") or ""
    return _innermost(json.dumps(json.loads(lack)["args"])) if lack.startswith("{") else args


def _later(read_s: float | None, found_s: float | None) -> str:
    """Say how the end of an overtake compares: a step apart is the polyline's millimetre at the line."""
    if read_s is None or found_s is None:
        return "not seen" if read_s is found_s else "differs"
    return {0: "at the same step", 1: "one step apart"}.get(abs(round(10 * (read_s - found_s))), "differs")


def other_contacts(
    read_contacts: list[Contact],
    found_contacts: list[tuple[str, str, int, int]],
    moves: set[tuple[str, int]],
    still: Collection[tuple[str, int]] = (),
) -> tuple[list[str], int]:
    """Return the contacts that only one of the two knows, and how many differ by steps at which SUMO moves a vehicle.

    Each contact is one of both vehicles. A place that contradicts the velocity is unknown to drivelint, so a contact may begin
    later and end earlier by steps at which one of both is moved. Boxes that overlap while both stand show no contact: it may end earlier
    by these steps, too.
    """
    both = {(a, b, c.first, c.last) for c in read_contacts for a, b in ((c.id_a, c.id_b), (c.id_b, c.id_a))}
    only_read, only_found = both - set(found_contacts), set(found_contacts) - both
    moved = set()
    for one, other, first, last in sorted(only_read):
        for there in sorted(c for c in only_found if c[:2] == (one, other) and first <= c[2] <= c[3] <= last):
            left_out = [*range(first, there[2]), *range(there[3] + 1, last + 1)]
            # a jump contradicts the place before it as it does the one after it
            if all(
                moves & {(who, at) for who in (one, other) for at in (step, step + 1)}
                or (step > there[3] and (one, step) in still and (other, step) in still)
                for step in left_out
            ):
                moved |= {(one, other, first, last), there}
    differ = sorted((only_read | only_found) - moved)
    return [f"{c}: contact only {'read' if c in both else 'found'}" for c in differ], len(moved) // 2
