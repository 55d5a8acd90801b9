"""Cuts a map as if somebody had cut it out of a larger one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np
import pyarrow as pa

from tests.blinding import remade

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from drivelint.road.map_reader import MapTables

    Floats = NDArray[np.float64]

Row = dict[str, Any]
Inside: TypeAlias = "Callable[[Floats, Floats], NDArray[np.bool_]]"
_ALONG = ("lane_boundary", "speed_limit", "crossing")  # from s_start_m to s_end_m; other tables have lane_s_m


class Span(NamedTuple):
    """What is left of a lanelet, by its old stations, and which of its ends were cut off."""

    first: float
    last: float
    begin_cut: bool
    end_cut: bool


def beyond(x: float, y: float, heading: float, by: float) -> Inside:
    """Return what of the plane is left of a map that ends `by` metres ahead of a place; negative: that begins so far behind it."""
    cos, sin = np.cos(heading), np.sin(heading)

    def inside(px: Floats, py: Floats) -> NDArray[np.bool_]:
        along: Floats = (px - x) * cos + (py - y) * sin
        return along <= by if by > 0 else along >= by

    return inside


def cropped(environment: MapTables, name: str, inside: Inside) -> MapTables:
    """Return the map as if somebody had cut it out of a larger one: lanelets end at its edge, and nothing says that they went on."""
    points, spans = _points(environment.tables["lane_point"], inside)

    def crop(table: str) -> Callable[[pa.Table], pa.Table]:
        def change(rows: pa.Table) -> pa.Table:
            if table == "lane_point":
                return pa.Table.from_pylist([{"environment_id": name, **row} for row in points], rows.schema)
            left = (_left(table, row, spans, inside) for row in rows.to_pylist())
            return pa.Table.from_pylist([row for row in left if row], rows.schema)

        return change

    return remade(environment, name, **{table: crop(table) for table in environment.tables})


def _points(table: pa.Table, inside: Inside) -> tuple[list[Row], dict[str, Span]]:
    """Return the points that are left, with new ones at the edge, and what is left of each lanelet."""
    table = table.sort_by([("lanelet_id", "ascending"), ("k", "ascending")])
    names = np.array(table["lanelet_id"].to_pylist())
    others = {"environment_id", "lanelet_id", "k"}
    columns = {c: table[c].to_numpy().astype(float) for c in table.schema.names if c not in others}
    kept: list[Row] = []
    spans: dict[str, Span] = {}
    for lanelet in np.unique(names).tolist():
        own = names == lanelet
        s = columns["s_m"][own]
        fine = np.unique(np.concatenate([s, np.linspace(s[0], s[-1], int(np.ceil(s[-1] - s[0])) + 2)]))
        at = {c: np.interp(fine, s, v[own]) for c, v in columns.items()}
        norm = np.hypot(at["tx"], at["ty"])
        at |= {"tx": at["tx"] / norm, "ty": at["ty"] / norm}
        there = inside(at["x_m"], at["y_m"])
        runs = np.split(np.arange(len(fine)), np.flatnonzero(np.diff(there.astype(int))) + 1)
        best: list[int] = max((r.tolist() for r in runs if there[r[0]]), key=len, default=[])
        if len(best) < 2:
            continue
        first, last = float(fine[best[0]]), float(fine[best[-1]])
        spans[lanelet] = Span(first, last, begin_cut=first > s[0], end_cut=last < s[-1])
        for n, k in enumerate(k for k in best if fine[k] in {first, last} or fine[k] in s):
            row: Row = {c: None if np.isnan(v[k]) else float(v[k]) for c, v in at.items()}
            kept.append(row | {"k": n, "lanelet_id": lanelet, "s_m": float(fine[k]) - first})
    return kept, spans


def _left(table: str, row: Row, spans: dict[str, Span], inside: Inside) -> Row | None:
    """Return what is left of a row of another table."""
    if table in {"lane_link", "road_object"}:
        one, other = spans.get(row.get("from_id", "")), spans.get(row.get("to_id", ""))
        linked = one and other and not one.end_cut and not other.begin_cut
        there = linked if table == "lane_link" else inside(np.array(row["x_m"]), np.array(row["y_m"]))
        return row if there else None
    if table == "map_quality" or "lanelet_id" not in row:
        return row
    span = spans.get(row["lanelet_id"])
    if not span:
        return None
    if table == "lanelet":
        gone = [side for side in ("left", "right") if row[f"{side}_id"] not in spans]
        return (
            row
            | {"length_m": span.last - span.first}
            | {f"{side}_{c}": None for side in gone for c in ("id", "against")}
        )
    if table in _ALONG:
        start, end = (min(max(row[c], span.first), span.last) - span.first for c in ("s_start_m", "s_end_m"))
        return row | {"s_start_m": start, "s_end_m": end} if start < end else None
    return row | {"lane_s_m": row["lane_s_m"] - span.first} if span.first <= row["lane_s_m"] <= span.last else None
