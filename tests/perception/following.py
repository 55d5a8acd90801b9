"""`python -m tests.perception.following DIR...`: how many following episodes the results of `check --keep-db` there decide.

An episode is a run of steps in which one object is in the strip that the ego's box really swept, at most 3 s ahead of its front.
It is found here with numpy from the recorded boxes alone, not by the program's own tables of who is ahead. A rule decides it if
its verdicts at that time are pass or fail, or if it does not apply, and none of them is unknown.

Where `tests.trial` judged every vehicle of a log, its recorder's episodes count alone.
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import duckdb
import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

RULES: Final = (
    "criticality.thw", "criticality.ttc", "criticality.drac", "criticality.ttb", "criticality.mttc", "ukhc.r126.thinking-gap",
)  # fmt: skip
HEADWAY_S: Final = 3.0
LEAST_STEPS: Final = 5
SLOWEST_MPS: Final = 0.5


def swept(way: Floats, k: int, half_m: float, box: Floats) -> float:
    """Return how far ahead along the way (n, 2) from its point k the box (4, 2) meets the strip of that half width; inf: it does not."""
    start, chord = way[k:-1], np.diff(way[k:], axis=0)
    length = np.hypot(*chord.T)
    moved = length > 0
    start, chord, length = start[moved], chord[moved], length[moved]
    if not len(start):
        return float("inf")
    unit = chord / length[:, None]
    station = np.concatenate([[0.0], np.cumsum(length)[:-1]])
    sides = np.concatenate(
        [box + (np.roll(box, -1, axis=0) - box) * share for share in np.linspace(0, 1, 8, endpoint=False)]
    )
    away = sides[:, None] - start
    along, aside = (away * unit).sum(axis=2), np.abs(away[..., 1] * unit[:, 0] - away[..., 0] * unit[:, 1])
    met = (along >= 0) & (along <= length) & (aside <= half_m)
    return float((station + along)[met].min()) if met.any() else float("inf")


def corners(x: float, y: float, yaw: float, length: float, width: float) -> Floats:
    """Return the corners (4, 2) of a box."""
    c, s = np.cos(yaw), np.sin(yaw)
    local = np.array([[1, 1], [1, -1], [-1, -1], [-1, 1]]) * [length / 2, width / 2]
    found: Floats = np.array([x, y]) + local @ np.array([[c, s], [-s, c]])
    return found


def episodes(con: duckdb.DuckDBPyConnection, recorders: list[str] | None) -> Iterator[tuple[str, str, str, int, int]]:
    """Yield drive, ego, object, first and last time of each episode. `recorders`: the only egos that count; None: all do."""
    for drive_id, ego_id in con.execute("SELECT DISTINCT drive_id, ego_id FROM step ORDER BY ALL").fetchall():
        if recorders is not None and ego_id not in recorders:
            continue
        select = """
            SELECT t_ns, x_m, y_m, speed_mps, length_m, width_m FROM ego_state
            WHERE drive_id = ? AND ego_id = ? AND x_m IS NOT NULL ORDER BY t_ns
        """
        ego = con.execute(select, [drive_id, ego_id]).fetchnumpy()
        way = np.column_stack([ego["x_m"], ego["y_m"]]).astype(float)
        index = {int(t): k for k, t in enumerate(ego["t_ns"])}
        select = """
            SELECT object_id, t_ns, x_m, y_m, yaw_rad, length_m, width_m FROM pair
            WHERE drive_id = ? AND ego_id = ? AND distance_m < 120 AND x_m + y_m + yaw_rad + length_m + width_m IS NOT NULL
                AND actor_class IN ('car', 'truck', 'bus', 'van', 'motorcycle', 'bicycle', 'trailer', 'vehicle') ORDER BY object_id, t_ns
        """
        run: list[int] = []
        of = ""
        for object_id, t_ns, *box in con.execute(select, [drive_id, ego_id]).fetchall():
            k = index.get(t_ns)
            if k is None:
                continue
            v = float(ego["speed_mps"][k])
            front, half = float(ego["length_m"][k]) / 2, float(ego["width_m"][k]) / 2
            gap = swept(way, k, half, corners(*box)) - front if v > SLOWEST_MPS else np.inf
            if object_id != of or (run and k != run[-1] + 1) or not 0 <= gap <= HEADWAY_S * v:
                if len(run) >= LEAST_STEPS:
                    yield drive_id, ego_id, of, int(ego["t_ns"][run[0]]), int(ego["t_ns"][run[-1]])
                run, of = [], object_id
            if 0 <= gap <= HEADWAY_S * v:
                run.append(k)
        if len(run) >= LEAST_STEPS:
            yield drive_id, ego_id, of, int(ego["t_ns"][run[0]]), int(ego["t_ns"][run[-1]])


def outcome(verdicts: list[dict[str, Any]], object_id: str, start: int, end: int) -> str:
    """Return the worst of a rule's verdicts about the object, or nobody in particular, then: unknown, fail, pass or not_applicable."""
    mine = [row for row in verdicts if row["object_id"] in {None, object_id}]
    at_that_time = {
        row["verdict"]
        for row in mine
        if row["t_start_ns"] is None or (row["t_start_ns"] <= end and row["t_end_ns"] >= start)
    }
    return next((word for word in ("unknown", "fail", "pass") if word in at_that_time), "not_applicable")


def main(folders: list[str]) -> int:
    """Print, by rule, how many episodes pass, fail, stay unknown and are outside the rule's conditions."""
    sums: dict[str, Counter[str]] = {rule: Counter() for rule in RULES}
    for folder in folders:
        known = Path(folder) / "recorders.json"
        recorders = json.loads(known.read_text(encoding="utf-8")) if known.exists() else None
        with duckdb.connect(str(Path(folder) / "drivelint.duckdb"), read_only=True) as con:
            found = list(episodes(con, recorders))
            columns = "rule_id, verdict, object_id, t_start_ns, t_end_ns, drive_id, ego_id"
            rows = con.execute(f"SELECT {columns} FROM verdict").to_arrow_table().to_pylist()
        for drive_id, ego_id, object_id, start, end in found:
            for rule, counts in sums.items():
                mine = [r for r in rows if (r["rule_id"], r["drive_id"], r["ego_id"]) == (rule, drive_id, ego_id)]
                counts[outcome(mine, object_id, start, end)] += 1
    print(f"{'rule':26}{'episodes':>9}{'pass':>6}{'fail':>6}{'n/a':>6}{'unknown':>9}{'decided':>9}")
    for rule, counts in sums.items():
        n = counts.total()
        share = f"{(n - counts['unknown']) / n:.0%}" if n else "-"
        numbers = (counts[word] for word in ("pass", "fail", "not_applicable"))
        print(f"{rule:26}{n:>9}" + "".join(f"{number:>6}" for number in numbers) + f"{counts['unknown']:>9}{share:>9}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
