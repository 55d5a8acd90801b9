"""Reads the tables of maps back as plain rows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from drivelint.road.map_reader import MapTables


def rows(environment: MapTables, table: str, **where: Any) -> list[dict[str, Any]]:
    """Return the rows of a table in which the columns have these values."""
    found: list[dict[str, Any]] = environment.tables[table].drop_columns("environment_id").to_pylist()
    return [row for row in found if all(row[name] == value for name, value in where.items())]


def values(environment: MapTables, table: str, columns: str, *, digits: int = 6, **where: Any) -> list[Any]:
    """Return the named columns of such rows: of one column its values, of several tuples; numbers are rounded."""
    found = [
        tuple(round(row[name], digits) if isinstance(row[name], float) else row[name] for name in columns.split())
        for row in rows(environment, table, **where)
    ]
    return found if " " in columns else [value for (value,) in found]


def lanelets(environment: MapTables) -> dict[str, dict[str, Any]]:
    return {row["lanelet_id"]: row for row in rows(environment, "lanelet")}


def lanelet(environment: MapTables, name: str, columns: str) -> tuple[Any, ...]:
    """Return the named columns of a lanelet."""
    return tuple(lanelets(environment)[name][column] for column in columns.split())


def links(environment: MapTables) -> list[tuple[str, str]]:
    return values(environment, "lane_link", "from_id to_id")


def hand(environment: MapTables) -> tuple[str, str]:
    """Return the side that is driven on, and what tells it."""
    return environment.handedness, environment.handedness_source


def points(environment: MapTables) -> dict[str, list[dict[str, Any]]]:
    found: dict[str, list[dict[str, Any]]] = {}
    for row in rows(environment, "lane_point"):
        found.setdefault(row["lanelet_id"], []).append(row)
    return found


def checks(environment: MapTables) -> dict[str, list[str | None]]:
    """Return check -> the lanelets that it names."""
    found: dict[str, list[str | None]] = {}
    for row in rows(environment, "map_quality"):
        found.setdefault(row["check_id"], []).append(row["lanelet_id"])
    return found


def messages(environment: MapTables, check: str) -> list[str]:
    return values(environment, "map_quality", "message", check_id=check)
