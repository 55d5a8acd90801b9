"""Tiny scenes: a road as OpenDRIVE text, actors moving along it, and what the library derives from them; no files.

Roads run along their reference line: `s` metres along it, `d` metres to its left. On a two-way road driven on the right
the ego goes along +s at d = -1.75; driven on the left everything is mirrored. `Road.ego_d` is that offset, `Road.oncoming_d`
that of the oncoming lane.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple
from unittest.mock import patch

import numpy as np
import pyarrow as pa

from drivelint import catalogue
from drivelint.drive.finish import TRACE_TABLES
from drivelint.drive.trace import Trace
from drivelint.engine.batch import Drive
from drivelint.engine.derive import derive
from drivelint.engine.profiles import load_profiles, profile_table
from drivelint.engine.session import JudgingSession
from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource, MapTables
from drivelint.sql import declarations, store
from drivelint.sql.derivations import TABLES_NEEDED_FOR_RULES_ABOUT_OTHERS, derivations, needed_derivations
from tests.formats.opendrive import xodr

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    import duckdb
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]

LANE = 3.5
Row = dict[str, Any]


Pose = tuple[float, float, float]


@dataclass(frozen=True)
class Road:
    """A map, and a line on it along which actors move: pieces (length, curvature) from a pose (x, y, heading)."""

    environment: MapTables
    pieces: tuple[tuple[float, float], ...]
    start: Pose = (0.0, 0.0, 0.0)

    @property
    def ego_d(self) -> float:
        """Offset of the ego's lane."""
        return LANE / 2 * (1 if self.environment.handedness == "lht" else -1)

    @property
    def oncoming_d(self) -> float:
        """Offset of the oncoming lane."""
        return -self.ego_d

    @property
    def over(self) -> int:
        """Sign of d towards the oncoming lane."""
        return -1 if self.environment.handedness == "lht" else 1

    def at(self, s: ArrayLike, d: ArrayLike = 0.0) -> tuple[Floats, Floats, Floats]:
        """Return x, y and heading of the line at s, moved d to the left."""
        s, d = np.broadcast_arrays(np.asarray(s, float), np.asarray(d, float))
        x, y, heading = np.zeros(s.shape), np.zeros(s.shape), np.zeros(s.shape)
        pose, s0 = self.start, 0.0
        for n, (length, curvature) in enumerate(self.pieces):
            here = (s >= s0) | (n == 0)
            px, py, ph = _walk(pose, s - s0, curvature)
            x, y, heading = np.where(here, px, x), np.where(here, py, y), np.where(here, ph, heading)
            pose, s0 = _end(pose, length, curvature), s0 + length
        return x - d * np.sin(heading), y + d * np.cos(heading), heading


def _walk(pose: Pose, u: Floats, curvature: float) -> tuple[Floats, Floats, Floats]:
    x, y, heading = pose
    turned = heading + curvature * u
    if not curvature:
        return x + u * math.cos(heading), y + u * math.sin(heading), turned
    return (
        x + (np.sin(turned) - math.sin(heading)) / curvature,
        y - (np.cos(turned) - math.cos(heading)) / curvature,
        turned,
    )


def _end(pose: Pose, length: float, curvature: float) -> Pose:
    x, y, heading = _walk(pose, np.array(length), curvature)
    return float(x), float(y), float(heading)


def plan(pieces: Sequence[tuple[float, float]], pose: Pose = (0.0, 0.0, 0.0)) -> str:
    """Return the planView geometries of these pieces."""
    parts, s = [], 0.0
    for length, curvature in pieces:
        x, y, heading = pose
        shape = f'<arc curvature="{curvature!r}"/>' if curvature else "<line/>"
        place = f'x="{x!r}" y="{y!r}" hdg="{heading!r}"'
        parts.append(f'<geometry s="{s!r}" {place} length="{length!r}">{shape}</geometry>')
        pose, s = _end(pose, length, curvature), s + length
    return "".join(parts)


def linked(number: int, before: int | None = None, after: int | None = None, kind: str = "driving") -> str:
    """Return a lane that continues the lane `before` and is continued by `after` (None: the same number)."""
    ends = f'<predecessor id="{before or number}"/><successor id="{after or number}"/>'
    return xodr.lane(number, f'<link>{ends}</link><width sOffset="0" a="{LANE}"/>', kind)


def limited(mph: float | None) -> str:
    """Return the type of a rural road with this speed limit."""
    return f'<type s="0" type="rural"><speed max="{mph}" unit="mph"/></type>' if mph else ""


@cache
def road(
    pieces: tuple[tuple[float, float], ...] = ((600.0, 0.0),),
    hand: str = "rht",
    lanes: tuple[int, int] = (1, 1),
    *,
    limit_mph: float | None = 60,
    cuts: tuple[float, ...] = (),
    ring: bool = False,
    start: Pose = (0.0, 0.0, 0.0),
) -> Road:
    """Return one road; `lanes`: driving lanes to the left and right of its line; `cuts`: where lane sections end."""
    left, right = lanes
    numbers = [*range(left, 0, -1), *(-n for n in range(1, right + 1))]
    ends = ""
    if ring:
        ends = '<predecessor elementType="road" elementId="1" contactPoint="end"/>'
        ends += '<successor elementType="road" elementId="1" contactPoint="start"/>'
    text = xodr.xodr(
        xodr.road(
            geometry=plan(pieces, start),
            lanes="".join(xodr.section(s, *(linked(n) for n in numbers)) for s in (0, *cuts)),
            length=sum(length for length, _ in pieces),
            attributes=f'rule="{hand.upper()}"',
            more=limited(limit_mph),
            link=ends,
        )
    )
    return Road(load_map(MapSource("scene.xodr", text.encode())), tuple(pieces), start)


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

    def without_position(self, mask: NDArray[np.bool_]) -> Actor:
        """Return it without a position in the samples of the mask."""
        return replace(self, x=np.where(mask, np.nan, self.x), y=np.where(mask, np.nan, self.y))


def times(end: float, start: float = 0.0, period: float = 0.1) -> Floats:
    """Return the sample times from start to end, both included."""
    steps: Floats = np.arange(round((end - start) / period) + 1).astype(np.float64)
    return start + period * steps


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


def swing(way: Road, s: Floats, out: float, back: float | None, change: float = 20.0, share: float = 1.0) -> Floats:  # noqa: PLR0917
    """Return offsets d along s: from the own lane's centre over by `share` of a lane, `change` metres from `out` on.

    Back again from `back` on (None: it stays over).
    """

    def ease(u: Floats) -> Floats:
        held: Floats = np.clip(u, 0.0, 1.0)
        return held * held * (3 - 2 * held)

    over = ease((s - out) / change)
    if back is not None:
        over = over - ease((s - back) / change)
    d: Floats = way.ego_d + (way.oncoming_d - way.ego_d) * share * over
    return d


def drive(
    actors: Iterable[Actor],
    environment: MapTables | None,
    *,
    drive_id: str = "d",
    egos: Sequence[str] = ("ego",),
    sensor_range_m: float | None = None,
    in_sight: bool = False,
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
        "in_sight": in_sight,
    }  # fmt: skip
    who = [
        {
            "drive_id": drive_id, "actor_id": a.actor_id, "actor_class": a.kind, "length_m": a.length, "width_m": a.width,
            "height_m": None, "is_ego": a.actor_id in egos,
        }
        for a in actors
    ]  # fmt: skip
    tables = {name: store.arrow_schemas()[name].empty_table() for name in TRACE_TABLES}
    tables["data_log"] = pa.Table.from_pylist([log], schema=tables["data_log"].schema)
    tables["actor"] = pa.Table.from_pylist(who, schema=tables["actor"].schema)
    tables["actor_state"] = pa.table(states, schema=tables["actor_state"].schema)
    return Drive(Trace(drive_id, Path(f"{drive_id}.parquet"), tables, None, None, []), environment)


Event = tuple[float, str, str | None]


def saying(scene: Drive, events: Sequence[Event] = (), by: str = "ego", **conditions: str) -> Drive:
    """Return the drive with events (seconds, name, value) that an actor declares, and with conditions given for it."""
    tables, drive_id = dict(scene.trace.tables), scene.trace.drive_id
    said = [
        {"drive_id": drive_id, "actor_id": by, "t_ns": round(t * 1e9), "event": event, "value": value}
        for t, event, value in events
    ]
    holds = [{"drive_id": drive_id, "condition": c, "value": v, "source": "env"} for c, v in conditions.items()]
    for name, found in (("declared_event", said), ("drive_condition", holds)):
        tables[name] = pa.Table.from_pylist(found, schema=tables[name].schema)
    return replace(scene, trace=replace(scene.trace, tables=tables))


def clear(con: duckdb.DuckDBPyConnection, *, but: Iterable[str] = ()) -> None:
    """Empty every table but these."""
    filled = con.execute("SELECT table_name FROM duckdb_tables() WHERE NOT temporary AND estimated_size > 0").fetchall()
    for table in sorted({name for (name,) in filled} - set(but)):
        con.execute(f"DELETE FROM {table}")


class _Place(NamedTuple):
    """A database in which the maps of some scenes lie, and its bench."""

    con: duckdb.DuckDBPyConnection
    bench: JudgingSession
    maps: list[MapTables]


_PLACES: Final[list[_Place]] = []
"""The databases of the last few maps, the last used at the end: most of a file's scenes lie on a handful of maps."""


def _place(drives: Iterable[Drive]) -> _Place:
    """Return a database for these drives: the one in which their very maps lie already, or another, emptied."""
    maps = list({id(d.environment): d.environment for d in drives if d.environment}.values())
    found = next((p for p in _PLACES if {*map(id, p.maps)} == {*map(id, maps)}), None)
    if found:
        _PLACES.remove(found)
        clear(found.con, but=_of_the_map())
        found.con.execute("DELETE FROM profile")
        store.insert(found.con, "profile", profile_table(load_profiles(), ()))
    else:
        con = _PLACES.pop(0).con if len(_PLACES) >= 8 else store.connect(threads=1)
        clear(con)
        store.insert(con, "profile", profile_table(load_profiles(), ()))
        found = _Place(con, JudgingSession(con, (), {}, None), maps)
    _PLACES.append(found)
    return found


@cache
def _of_the_map() -> list[str]:
    return [
        table
        for table, columns in declarations.column_comments().items()
        if "environment_id" in columns and "drive_id" not in columns
    ]


def derived(
    *drives: Drive, tables: Iterable[str] = (), con: duckdb.DuckDBPyConnection | None = None
) -> duckdb.DuckDBPyConnection:
    """Return a database in which the library tables of these drives stand; none named: all.

    Without `con` it is one of a few that all scenes share, emptied before of all but the same maps.
    """
    if con:
        clear(con)
        store.insert(con, "profile", profile_table(load_profiles(), ()))
        place = _Place(con, JudgingSession(con, (), {}, None), [])
    else:
        place = _place(drives)
    con, bench, _ = place
    wanted = set(tables) or set(derivations())
    # what the engine always needs besides is not asked for here, and would take most of the time
    with patch("drivelint.sql.derivations.TABLES_NEEDED_FOR_RULES_ABOUT_OTHERS", ()):
        of_the_map = {d.table for d in needed_derivations(wanted) if d.is_of_map_only}
        if not of_the_map <= bench._tables:
            bench._tables |= of_the_map
            bench._maps = frozenset()  # all of the map once more, with these
        bench._tables |= wanted  # or they would keep the rows of the scene before
        bench._also = TABLES_NEEDED_FOR_RULES_ABOUT_OTHERS
        bench._load_drives(drives)
        derive(con, wanted, are_map_tables=False)
    return con


@cache
def _rules() -> dict[str, catalogue.Rule]:
    return catalogue.load_rules()


def rule_ids(patterns: Sequence[str]) -> list[str]:
    """Return the ids of the rules that these patterns name; none named: those that `check` judges by default."""
    return [rule.id for rule in catalogue.select_rules(_rules(), tuple(patterns), ())]


def verdict_rows(
    *batches: Sequence[Drive],
    rules: Sequence[str] = (),
    profiles: Sequence[str] = (),
    con: duckdb.DuckDBPyConnection | None = None,
    order: str = "drive_id, ego_id, rule_id, profile NULLS FIRST, object_id NULLS FIRST, occurrence",
) -> list[Row]:
    """Return the verdict rows of these batches of drives; the database keeps the results."""
    place = None
    if con is None:
        place = _place(one for batch in batches for one in batch)
        con = place.con
        con.execute("DELETE FROM profile")
    else:
        clear(con)
    store.insert(con, "profile", profile_table(load_profiles(), profiles))
    bench = JudgingSession(con, catalogue.select_rules(_rules(), tuple(rules), ()), {}, None)
    if place:
        of_the_map = {d.table for d in needed_derivations(bench._tables) if d.is_of_map_only}
        if of_the_map <= place.bench._tables:  # they stand there already
            bench._maps = place.bench._maps
        place.bench._tables |= of_the_map
        bench._tables |= place.bench._tables
    for batch in batches:
        bench.judge(batch)
    if place:
        place.bench._maps = bench._maps
    return rows(con, f"SELECT * FROM verdict ORDER BY {order}")


def rows(con: duckdb.DuckDBPyConnection, sql: str, params: Sequence[object] | Mapping[str, object] = ()) -> list[Row]:
    """Return the rows of a query as dictionaries."""
    result = con.execute(sql, params or None)
    names = [column[0] for column in result.description or ()]
    return [dict(zip(names, row, strict=True)) for row in result.fetchall()]


def seconds(rows_: Iterable[Mapping[str, Any]], column: str) -> list[float | None]:
    """Return a column of nanoseconds in seconds."""
    return [None if row[column] is None else row[column] / 1e9 for row in rows_]


@cache
def tee(hand: str = "rht") -> dict[str, Road]:
    """Return a T junction and ways through it, all along the reference lines.

    Road 1 runs east from the origin to x = 200, road 2 goes on from x = 220, road 3 leads south from (210, -10);
    connecting roads are 10 (1 to 2), 11 (1 to 3) and 12 (3 to 2). Ways: `straight` (1, 10, 2), `south` (1, 11, 3) and
    `north` (up road 3 and by 12 to 2), `home` (up road 3 and by 11 west along 1).
    """
    turn = (5 * math.pi, -0.1)
    south, north = (210.0, -10.0, -math.pi / 2), (210.0, -10.0, math.pi / 2)
    both = xodr.section(0, linked(1), linked(-1))

    def part(number: str, pieces: tuple[tuple[float, float], ...], pose: Pose, ends: str, lanes: str = both) -> str:
        junction = "5" if len(number) > 1 else "-1"
        return xodr.road(
            number, plan(pieces, pose), lanes, sum(length for length, _ in pieces), ends,
            f'rule="{hand.upper()}"', limited(60), junction,
        )  # fmt: skip

    def end(kind: str, number: str, contact: str) -> str:
        return f'<{kind} elementType="road" elementId="{number}" contactPoint="{contact}"/>'

    def at_junction(kind: str) -> str:
        return f'<{kind} elementType="junction" elementId="5"/>'

    def connection(number: int, incoming: str, connecting: str, lanes: str) -> str:
        head = (
            f'<connection id="{number}" incomingRoad="{incoming}" connectingRoad="{connecting}" contactPoint="start">'
        )
        return f"{head}{lanes}</connection>"

    same = '<laneLink from="-1" to="-1"/><laneLink from="1" to="1"/>'
    crossed = '<laneLink from="1" to="-1"/><laneLink from="-1" to="1"/>'
    text = xodr.xodr(
        part("1", ((200.0, 0.0),), (0.0, 0.0, 0.0), at_junction("successor")),
        part("2", ((200.0, 0.0),), (220.0, 0.0, 0.0), at_junction("predecessor")),
        part("3", ((150.0, 0.0),), south, at_junction("predecessor")),
        part("10", ((20.0, 0.0),), (200.0, 0.0, 0.0), end("predecessor", "1", "end") + end("successor", "2", "start")),
        part("11", (turn,), (200.0, 0.0, 0.0), end("predecessor", "1", "end") + end("successor", "3", "start")),
        part(
            "12", (turn,), north, end("predecessor", "3", "start") + end("successor", "2", "start"),
            xodr.section(0, linked(1, before=-1), linked(-1, before=1)),
        ),
        f'<junction id="5" name="tee">{connection(0, "1", "10", same)}{connection(1, "1", "11", same)}'
        f"{connection(2, '3', '12', crossed)}</junction>",
    )  # fmt: skip
    environment = load_map(MapSource("tee.xodr", text.encode()))
    up = (210.0, -160.0, math.pi / 2)
    return {
        "straight": Road(environment, ((420.0, 0.0),)),
        "south": Road(environment, ((200.0, 0.0), turn, (150.0, 0.0))),
        "north": Road(environment, ((150.0, 0.0), turn, (200.0, 0.0)), up),
        "home": Road(environment, ((150.0, 0.0), (5 * math.pi, 0.1), (200.0, 0.0)), up),
    }
