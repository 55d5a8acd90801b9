"""Tiny scenes: a road as OpenDRIVE text, actors moving along it, and what the library derives from them; no files.

Roads run along their reference line: `s` metres along it, `d` metres to its left. On a two-way road driven on the right the ego goes
along +s at d = -1.75; driven on the left everything is mirrored: d = +1.75. `Road.own` is that offset, `Road.other` the oncoming one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa

from drivelint import catalogue, store
from drivelint.batch import Drive
from drivelint.derive import derivations, derive
from drivelint.ingest import Trace
from drivelint.ingest.finish import SCHEMAS
from drivelint.judge import Bench
from drivelint.maps import Environment, MapSource, load_map
from drivelint.profiles import load_profiles, profile_table
from tests.maps import xodr

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    import duckdb
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]

LANE = 3.5
Row = dict[str, Any]


@dataclass(frozen=True)
class Road:
    """A map whose main road has the reference line of `pieces` (length, curvature) from the origin eastwards."""

    environment: Environment
    pieces: tuple[tuple[float, float], ...]

    @property
    def own(self) -> float:
        """Offset of the ego's lane."""
        return LANE / 2 * (1 if self.environment.handedness == "lht" else -1)

    @property
    def other(self) -> float:
        """Offset of the oncoming lane."""
        return -self.own

    @property
    def over(self) -> int:
        """Sign of d towards the oncoming lane."""
        return -1 if self.environment.handedness == "lht" else 1

    def at(self, s: ArrayLike, d: ArrayLike = 0.0) -> tuple[Floats, Floats, Floats]:
        """Return x, y and heading of the reference line at s, moved d to the left."""
        s, d = np.broadcast_arrays(np.asarray(s, float), np.asarray(d, float))
        x, y, heading = np.zeros(s.shape), np.zeros(s.shape), np.zeros(s.shape)
        x0 = y0 = h0 = s0 = 0.0
        for n, (length, curvature) in enumerate(self.pieces):
            here = (s >= s0) | (n == 0)
            u = s - s0
            if curvature:
                px = x0 + (np.sin(h0 + curvature * u) - math.sin(h0)) / curvature
                py = y0 - (np.cos(h0 + curvature * u) - math.cos(h0)) / curvature
            else:
                px, py = x0 + u * math.cos(h0), y0 + u * math.sin(h0)
            x, y = np.where(here, px, x), np.where(here, py, y)
            heading = np.where(here, h0 + curvature * u, heading)
            x0, y0, h0 = _end(x0, y0, h0, length, curvature)
            s0 += length
        return x - d * np.sin(heading), y + d * np.cos(heading), heading


def _end(x: float, y: float, heading: float, length: float, curvature: float) -> tuple[float, float, float]:
    if not curvature:
        return x + length * math.cos(heading), y + length * math.sin(heading), heading
    turned = heading + curvature * length
    return (
        x + (math.sin(turned) - math.sin(heading)) / curvature,
        y - (math.cos(turned) - math.cos(heading)) / curvature,
        turned,
    )


def plan(pieces: Sequence[tuple[float, float]], x: float = 0.0, y: float = 0.0, heading: float = 0.0) -> str:
    """Return the planView geometries of these pieces."""
    parts, s = [], 0.0
    for length, curvature in pieces:
        shape = f'<arc curvature="{curvature!r}"/>' if curvature else "<line/>"
        parts.append(
            f'<geometry s="{s!r}" x="{x!r}" y="{y!r}" hdg="{heading!r}" length="{length!r}">{shape}</geometry>'
        )
        x, y, heading = _end(x, y, heading, length, curvature)
        s += length
    return "".join(parts)


@cache
def road(
    pieces: tuple[tuple[float, float], ...] = ((600.0, 0.0),),
    hand: str = "rht",
    left: int = 1,
    right: int = 1,
    limit_mph: float | None = 60,
    link: str = "",
    turned: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> Road:
    """Return one road; `left` and `right`: driving lanes on either side of its reference line; `turned`: where it begins."""
    numbers = [*range(left, 0, -1), *(-n for n in range(1, right + 1))]
    limit = f'<type s="0" type="rural"><speed max="{limit_mph}" unit="mph"/></type>' if limit_mph else ""
    text = xodr.xodr(
        xodr.road(
            geometry=plan(pieces, *turned),
            lanes=xodr.section(0, *(xodr.lane(n) for n in numbers)),
            length=sum(length for length, _ in pieces),
            attributes=f'rule="{hand.upper()}"',
            more=limit,
            link=link,
        )
    )
    return Road(load_map(MapSource("scene.xodr", text.encode())), tuple(pieces))


@dataclass(frozen=True)
class Actor:
    """One actor's samples, arrays of one length; NaN stands for unknown, indicator `None` likewise."""

    actor_id: str
    t_s: Floats
    x: Floats
    y: Floats
    yaw: Floats
    vx: Floats
    vy: Floats
    length: float | None = 4.8
    width: float | None = 1.8
    kind: str | None = "car"
    indicator: tuple[str | None, ...] = field(default=(), repr=False)

    def keep(self, mask: NDArray[np.bool_]) -> Actor:
        """Return it with only the samples of the mask."""
        lights = tuple(np.array(self.indicator, object)[mask]) if self.indicator else ()
        arrays = {name: getattr(self, name)[mask] for name in ("t_s", "x", "y", "yaw", "vx", "vy")}
        return replace(self, **arrays, indicator=lights)

    def lost(self, mask: NDArray[np.bool_]) -> Actor:
        """Return it without a position in the samples of the mask."""
        return replace(self, x=np.where(mask, np.nan, self.x), y=np.where(mask, np.nan, self.y))


def times(end: float, start: float = 0.0, period: float = 0.1) -> Floats:
    """Return the sample times from start to end, both included."""
    return start + period * np.arange(round((end - start) / period) + 1)


def moving(actor_id: str, way: Road, t: Floats, s: ArrayLike, d: ArrayLike, **more: Any) -> Actor:
    """Return an actor at (s, d) of the road's reference line at each time; heading and velocity follow from its way."""
    s, d = np.broadcast_arrays(np.asarray(s, float), np.asarray(d, float))
    x, y, heading = way.at(s, d)
    vx, vy = np.gradient(x, t), np.gradient(y, t)
    yaw = np.where(np.hypot(vx, vy) > 1e-6, np.arctan2(vy, vx), heading)
    return Actor(actor_id, t, x, y, yaw, vx, vy, **more)


def standing(actor_id: str, way: Road, t: Floats, s: float, d: float, *, turned: float = 0.0, **more: Any) -> Actor:
    """Return an actor that stands at (s, d), its heading the road's plus `turned`."""
    x, y, heading = (np.full(t.shape, v) for v in way.at(s, d))
    return Actor(actor_id, t, x, y, heading + turned, np.zeros(t.shape), np.zeros(t.shape), **more)


def swing(s: Floats, out: float, back: float | None, own: float, other: float, change: float = 20.0) -> Floats:
    """Return offsets d along s: over from `out` on within `change` metres, back again from `back` on (None: it stays)."""

    def ease(u: Floats) -> Floats:
        u = np.clip(u, 0.0, 1.0)
        return u * u * (3 - 2 * u)

    share = ease((s - out) / change)
    if back is not None:
        share = share - ease((s - back) / change)
    return own + (other - own) * share


def drive(
    actors: Iterable[Actor],
    environment: Environment | None,
    *,
    drive_id: str = "d",
    egos: Sequence[str] = ("ego",),
    sensor_range_m: float | None = None,
) -> Drive:
    """Return one drive, ready for the bench."""
    actors = sorted(actors, key=lambda a: a.actor_id)
    n = sum(len(a.t_s) for a in actors)
    t = np.concatenate([np.round(a.t_s * 1e9).astype(np.int64) for a in actors])
    lit = [light for a in actors for light in (a.indicator or (None,) * len(a.t_s))]

    def numbers(name: str) -> pa.Array:
        return pa.array(np.concatenate([getattr(a, name) for a in actors]), from_pandas=True)

    nothing = pa.nulls(n, pa.float64())
    states = {
        "drive_id": [drive_id] * n, "actor_id": [a.actor_id for a in actors for _ in a.t_s], "t_ns": t,
        "x_m": numbers("x"), "y_m": numbers("y"), "z_m": nothing, "yaw_rad": numbers("yaw"),
        "vx_mps": numbers("vx"), "vy_mps": numbers("vy"), "ax_mps2": nothing, "ay_mps2": nothing,
        "indicator": lit, "brake_light": pa.nulls(n, pa.string()),
    }  # fmt: skip
    known = any(a.actor_id in egos and any(a.indicator) for a in actors)
    log = {
        "drive_id": drive_id, "file_name": f"{drive_id}.parquet", "sha256": f"hash of {drive_id}", "format": "scene",
        "environment_id": None, "t_start_ns": int(t.min()), "t_end_ns": int(t.max()), "utc_start_ns": None, "n_states": n,
        "sensor_range_m": sensor_range_m, "has_indicator": known, "has_brake_light": False, "has_acceleration": False,
    }  # fmt: skip
    who = [
        {
            "drive_id": drive_id, "actor_id": a.actor_id, "actor_class": a.kind, "length_m": a.length, "width_m": a.width,
            "height_m": None, "is_ego": a.actor_id in egos,
        }
        for a in actors
    ]  # fmt: skip
    tables = {
        name: pa.table({c: [] for c in columns}, schema=pa.schema(list(columns.items())))
        for name, columns in SCHEMAS.items()
    }
    tables["data_log"] = pa.Table.from_pylist([log], schema=tables["data_log"].schema)
    tables["actor"] = pa.Table.from_pylist(who, schema=tables["actor"].schema)
    tables["actor_state"] = pa.table(states, schema=tables["actor_state"].schema)
    return Drive(Trace(drive_id, Path(f"{drive_id}.parquet"), tables, None, None, []), environment)


@cache
def _database() -> duckdb.DuckDBPyConnection:
    return store.connect(threads=1)


def clear(con: duckdb.DuckDBPyConnection) -> None:
    """Empty every table."""
    for table in store.schema():
        con.execute(f"DELETE FROM {table}")


def derived(
    *drives: Drive, tables: Iterable[str] = (), con: duckdb.DuckDBPyConnection | None = None
) -> duckdb.DuckDBPyConnection:
    """Return a database (one for all scenes, emptied before) in which the library tables of these drives stand; none named: all."""
    con = con or _database()
    clear(con)
    store.insert(con, "profile", profile_table(load_profiles(), ()))
    bench = Bench(con, (), {}, None)
    bench._tables = set(tables) or set(derivations())
    bench._load(drives)
    derive(con, bench._tables, of_the_map=False)
    return con


def judged(
    *batches: Sequence[Drive],
    rules: Sequence[str] = (),
    profiles: Sequence[str] = (),
    con: duckdb.DuckDBPyConnection | None = None,
    order: str = "drive_id, ego_id, rule_id, profile NULLS FIRST, object_id NULLS FIRST, occurrence",
) -> list[Row]:
    """Return the verdict rows of these batches of drives; the database keeps `verdict`, `finding` and the rest of the results."""
    con = con or _database()
    clear(con)
    store.insert(con, "profile", profile_table(load_profiles(), profiles))
    bench = Bench(con, catalogue.select(catalogue.load(), tuple(rules), ()), {}, None)
    for batch in batches:
        bench.judge(batch)
    return rows(con, f"SELECT * FROM verdict ORDER BY {order}")


def rows(con: duckdb.DuckDBPyConnection, sql: str, params: Sequence[object] | Mapping[str, object] = ()) -> list[Row]:
    """Return the rows of a query as dictionaries."""
    result = con.execute(sql, params or None)
    names = [column[0] for column in result.description or ()]
    return [dict(zip(names, row, strict=True)) for row in result.fetchall()]


def seconds(rows_: Iterable[Mapping[str, Any]], column: str) -> list[float | None]:
    """Return a column of nanoseconds in seconds."""
    return [None if row[column] is None else row[column] / 1e9 for row in rows_]
