"""A fleet of short drives on the ring road of the benchmarks, some of which drive through a parked car, and their manifest."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv
import pyarrow.parquet as pq

from tests.bench.traffic import LANE, LAP, place, ring

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

SECONDS, HERTZ = 4.0, 5
RULE = "ukhc.no-collision"
"""The rule that the planted drives break."""
LITTLE_BYTES = 600_000_000
_MUCH = 4_000_000
"""Rows of a log whose reading takes more than that."""
_SITES = ("leeds", "york", "hull")


class Fleet(NamedTuple):
    """The manifest of a fleet, its road, and the names of the logs with a planted contact."""

    manifest: Path
    road: Path
    planted: frozenset[str]

    def command(self, out: Path, *more: str) -> list[str]:
        """Return the arguments of `drivelint` that audit the fleet."""
        asked = ("audit", str(self.manifest), "--map", str(self.road), "--rules", RULE, "--out", str(out), "--quiet")
        return [*asked, *more]


def write(home: Path, n_drives: int, seed: int = 0) -> Fleet:
    """Write a fleet: each drive another, one in seven with a contact."""
    home.mkdir(parents=True, exist_ok=True)
    road = home / "ring.xodr"
    road.write_text(ring(), encoding="utf-8")
    rng = np.random.Generator(np.random.PCG64(seed))
    starts, contacts = rng.uniform(0, LAP, n_drives), rng.uniform(size=n_drives) < 1 / 7
    rows = []
    for n in range(n_drives):
        name = f"drive-{n:05d}.parquet"
        _write_drive(home / "logs" / name, float(starts[n]), contact=bool(contacts[n]))
        rows.append({"log": f"logs/{name}", "release": f"v{n % 2}", "site": _SITES[n % 3]})
    manifest = home / "fleet.csv"
    pa_csv.write_csv(pa.Table.from_pylist(rows), manifest)
    planted = frozenset(f"drive-{n:05d}.parquet" for n in np.flatnonzero(contacts))
    return Fleet(manifest, road, planted)


def write_exhausting(log: Path, of: Path) -> None:
    """Write a log of the columns of another one whose reading takes more memory than a worker with `LITTLE_BYTES` may."""
    states = pq.read_table(of)
    columns = {name: np.resize(states[name].to_numpy(zero_copy_only=False), _MUCH) for name in states.column_names}
    columns["t_ns"] = np.arange(_MUCH) // 3 * 10_000_000
    pq.write_table(pa.table(columns, schema=states.schema), log)


def _write_drive(path: Path, start: float, *, contact: bool) -> None:
    """Write one drive as a table of states: the ego, a car ahead of it, and one that is parked beside or in its way."""
    t = np.arange(round(SECONDS * HERTZ)) / HERTZ
    ways = (start + 12.0 * t, start + 60.0 + 12.0 * t, start + 25.0 + 0 * t)
    sides = (LANE / 2, LANE / 2, LANE / 2 if contact else LANE + 2.0)
    states = [_states(str(n), s, side + 0 * t, t) for n, (s, side) in enumerate(zip(ways, sides, strict=True))]
    path.parent.mkdir(parents=True, exist_ok=True)
    pq.write_table(pa.concat_tables(states), path)


def _states(actor: str, s: NDArray[np.float64], d: NDArray[np.float64], t: NDArray[np.float64]) -> pa.Table:
    x, y, heading = place(s, d)
    columns = {"x_m": x, "y_m": y, "yaw_rad": heading, "vx_mps": np.gradient(x, t), "vy_mps": np.gradient(y, t)}
    n = len(t)
    fixed = {"actor_id": [actor] * n, "actor_class": ["car"] * n, "is_ego": [actor == "0"] * n}
    sizes = {"length_m": [4.8] * n, "width_m": [1.8] * n}
    return pa.table({**fixed, "t_ns": np.round(t * 1e9).astype(np.int64), **columns, **sizes})
