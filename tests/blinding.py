"""Takes things away from a recorded drive or its map: what a checker then says must not be that all was well."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.engine.batch import Drive
from tests.ingested import ingested

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from drivelint.road.map_reader import MapTables

Span = tuple[float, float]
EVER: Span = (-1.0, 1e6)


def renamed(drive: Drive, name: str) -> Drive:
    """Return the drive under another id, so that many versions of it can be judged at once."""
    tables = {}
    for table, rows in drive.trace.tables.items():
        ids = pa.array([name] * rows.num_rows, pa.string())
        tables[table] = rows.set_column(rows.schema.get_field_index("drive_id"), "drive_id", ids)
    return Drive(replace(drive.trace, drive_id=name, tables=tables), drive.environment)


def change_table(drive: Drive, table: str, change: Callable[[pa.Table], pa.Table]) -> Drive:
    """Return the drive with one of its tables changed."""
    tables = {**drive.trace.tables, table: change(drive.trace.tables[table])}
    return Drive(replace(drive.trace, tables=tables), drive.environment)


def _hit(states: pa.Table, actor: str | None, span: Span) -> NDArray[np.bool_]:
    t = states["t_ns"].to_numpy() / 1e9
    who = np.ones(len(t), bool) if actor is None else np.array(states["actor_id"].to_pylist()) == actor
    hit: NDArray[np.bool_] = who & (t > span[0] - 1e-6) & (t < span[1] + 1e-6)
    return hit


def _with(states: pa.Table, column: str, hit: NDArray[np.bool_], new: pa.Array) -> pa.Table:
    return states.set_column(
        states.schema.get_field_index(column), column, pc.if_else(pa.array(hit), new, states[column].combine_chunks())
    )


def nulled(drive: Drive, actor: str, span: Span) -> Drive:
    """Take away the actor's positions."""

    def change(states: pa.Table) -> pa.Table:
        hit = _hit(states, actor, span)
        nothing = pa.nulls(len(hit), pa.float64())
        return _with(_with(states, "x_m", hit, nothing), "y_m", hit, nothing)

    return change_table(drive, "actor_state", change)


def dropped(drive: Drive, actor: str | None, span: Span) -> Drive:
    """Take away the actor's rows; None: everybody's, a hole in the log. An actor without any row is not in the log at all."""
    less = change_table(drive, "actor_state", lambda states: states.filter(pa.array(~_hit(states, actor, span))))
    left = pc.unique(less.trace.tables["actor_state"]["actor_id"])
    return change_table(less, "actor", lambda actors: actors.filter(pc.is_in(actors["actor_id"], left)))


def renamed_actor(drive: Drive, actor: str, t_s: float) -> Drive:
    """Give the actor another id from this time on, as a tracker does that loses an actor and finds it again."""
    new = f"{actor}b"

    def under_new_id(rows: pa.Table, hit: NDArray[np.bool_]) -> pa.Table:
        return _with(rows, "actor_id", hit, pa.array([new] * rows.num_rows, rows.schema.field("actor_id").type))

    def change(states: pa.Table) -> pa.Table:
        late = _hit(states, actor, (t_s, EVER[1]))
        return under_new_id(states, late).sort_by([("actor_id", "ascending"), ("t_ns", "ascending")])

    def repeat(actors: pa.Table) -> pa.Table:
        own = actors.filter(pc.equal(actors["actor_id"], actor))
        return pa.concat_tables([actors, under_new_id(own, np.ones(own.num_rows, bool))])

    both = change_table(change_table(drive, "actor_state", change), "actor", repeat)
    left = pc.unique(both.trace.tables["actor_state"]["actor_id"])
    return change_table(both, "actor", lambda actors: actors.filter(pc.is_in(actors["actor_id"], left)))


def move_actor(drive: Drive, actor: str, span: Span, by_m: float) -> Drive:
    """Move the actor to its left."""

    def change(states: pa.Table) -> pa.Table:
        hit = _hit(states, actor, span)
        yaw = states["yaw_rad"].to_numpy(zero_copy_only=False)
        x = states["x_m"].to_numpy(zero_copy_only=False) - by_m * np.sin(yaw)
        y = states["y_m"].to_numpy(zero_copy_only=False) + by_m * np.cos(yaw)
        return _with(_with(states, "x_m", hit, pa.array(x)), "y_m", hit, pa.array(y))

    return change_table(drive, "actor_state", change)


def turned(drive: Drive, actor: str, span: Span) -> Drive:
    """Turn the actor's heading by pi wherever it moves at more than 1 m/s, as a tracker does that takes the tail for the nose."""

    def change(states: pa.Table) -> pa.Table:
        yaw, vx, vy = (states[c].to_numpy(zero_copy_only=False) for c in ("yaw_rad", "vx_mps", "vy_mps"))
        hit = _hit(states, actor, span) & (np.hypot(vx, vy) > 1.0)
        return _with(states, "yaw_rad", hit, pa.array(np.arctan2(-np.sin(yaw), -np.cos(yaw)), from_pandas=True))

    return ingested(change_table(drive, "actor_state", change))


def frozen(drive: Drive, actor: str, span: Span) -> Drive:
    """Hold the actor's position at that of the span's first sample; its velocity goes on."""

    def change(states: pa.Table) -> pa.Table:
        hit = _hit(states, actor, span)
        rows = np.flatnonzero(hit)
        for column in ("x_m", "y_m"):
            values = states[column].to_numpy(zero_copy_only=False)
            held = np.full(len(hit), values[rows[0]] if len(rows) else np.nan)
            states = _with(states, column, hit, pa.array(held, from_pandas=True))
        return states

    return ingested(change_table(drive, "actor_state", change))


def jumped(drive: Drive, actor: str, span: Span, by_m: float = 150.0) -> Drive:
    """Move the actor that far back along its way, as where an id is given to another vehicle for a while."""

    def change(states: pa.Table) -> pa.Table:
        hit = _hit(states, actor, span)
        yaw = states["yaw_rad"].to_numpy(zero_copy_only=False)
        for column, part in (("x_m", np.cos(yaw)), ("y_m", np.sin(yaw))):
            there = states[column].to_numpy(zero_copy_only=False) - by_m * part
            states = _with(states, column, hit, pa.array(there, from_pandas=True))
        return states

    return ingested(change_table(drive, "actor_state", change))


def cut(drive: Drive, span: Span) -> Drive:
    """Keep only this part of the log."""
    return dropped(dropped(drive, None, (-1.0, span[0] - 1e-3)), None, (span[1] + 1e-3, 1e6))


def ranged(drive: Drive, range_m: float) -> Drive:
    """Say that the recorder sees only so far, and take away who was further from the ego (actor 1 of the logs)."""

    def change(states: pa.Table) -> pa.Table:
        ego = states.filter(pc.equal(states["actor_id"], "1")).select(["t_ns", "x_m", "y_m"])
        ego = ego.rename_columns(["t_ns", "ex", "ey"])
        both = states.append_column("row", pa.array(np.arange(states.num_rows))).join(ego, "t_ns").sort_by("row")
        apart = np.hypot(both["x_m"].to_numpy() - both["ex"].to_numpy(), both["y_m"].to_numpy() - both["ey"].to_numpy())
        return states.filter(pa.array(apart <= range_m))

    def say(log: pa.Table) -> pa.Table:
        return log.set_column(
            log.schema.get_field_index("sensor_range_m"), "sensor_range_m", pa.array([range_m] * log.num_rows)
        )

    return change_table(change_table(drive, "actor_state", change), "data_log", say)


def on(drive: Drive, environment: MapTables | None) -> Drive:
    """Return the drive on another map."""
    return Drive(drive.trace, environment)


def remade(environment: MapTables, name: str, /, **changes: Callable[[pa.Table], pa.Table]) -> MapTables:
    """Return the map under another id with some tables changed."""
    tables = {}
    for table, rows in environment.tables.items():
        new = changes.get(table, lambda same: same)(rows)
        ids = pa.array([name] * new.num_rows, pa.string())
        tables[table] = new.set_column(new.schema.get_field_index("environment_id"), "environment_id", ids)
    return replace(environment, environment_id=name, tables=tables)


def without_lanelet(environment: MapTables, lanelet: str, name: str) -> MapTables:
    """Return the map without this lanelet, as if it had failed to build; its neighbours still name it."""

    def drop(column: str) -> Callable[[pa.Table], pa.Table]:
        return lambda rows: rows.filter(pc.not_equal(rows[column], lanelet))

    return remade(
        environment,
        name,
        lanelet=drop("lanelet_id"),
        lane_point=drop("lanelet_id"),
        lane_boundary=drop("lanelet_id"),
        speed_limit=drop("lanelet_id"),
        lane_link=lambda links: drop("to_id")(drop("from_id")(links)),
    )


def without_links(environment: MapTables, name: str, *ends: str) -> MapTables:
    """Return the map without the links from or to these lanelets; none named: without any."""

    def drop(links: pa.Table) -> pa.Table:
        if not ends:
            return links.slice(0, 0)
        named = pa.array(ends)
        return links.filter(pc.invert(pc.or_(pc.is_in(links["from_id"], named), pc.is_in(links["to_id"], named))))

    return remade(environment, name, lane_link=drop)


def without(drive: Drive, table: str, columns: tuple[str, ...], actor: str | None = None, span: Span = EVER) -> Drive:
    """Take away columns of the actor's rows (None: of everybody's), of `actor_state` only in the span."""

    def change(rows: pa.Table) -> pa.Table:
        if "t_ns" in rows.schema.names and "actor_id" in rows.schema.names:
            hit = _hit(rows, actor, span)
        elif "t_ns" in rows.schema.names:
            t = rows["t_ns"].to_numpy() / 1e9
            hit = (t > span[0]) & (t < span[1])
        else:
            hit = np.array([actor in {None, a} for a in rows["actor_id"].to_pylist()], bool)
        for column in columns:
            rows = _with(rows, column, hit, pa.nulls(len(hit), rows.schema.field(column).type))
        return rows

    return change_table(drive, table, change)


def empty(rows: pa.Table) -> pa.Table:
    """Return the table without its rows."""
    return rows.slice(0, 0)


def of(column: str, value: str) -> Callable[[pa.Table], pa.Table]:
    """Return a change that keeps only the rows with this value."""
    return lambda rows: rows.filter(pc.equal(rows[column], value))


def unsaid(*columns: str) -> Callable[[pa.Table], pa.Table]:
    """Return a change that takes these columns away."""

    def change(rows: pa.Table) -> pa.Table:
        for column in columns:
            at, kind = rows.schema.get_field_index(column), rows.schema.field(column).type
            rows = rows.set_column(at, column, pa.nulls(len(rows), kind))
        return rows

    return change


def guessed(environment: pa.Table) -> pa.Table:
    """Return the table of the map with a side of the road that nobody said."""
    at = environment.schema.get_field_index("handedness_source")
    return environment.set_column(at, "handedness_source", pa.array(["default"]))
