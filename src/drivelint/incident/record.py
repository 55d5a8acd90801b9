"""Compares a log with the two lists in `elements.toml` of elements that an automated vehicle should record."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec
import pyarrow.compute as pc

from drivelint.facts import toml_beside

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pyarrow as pa


class _Source(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    title: str


class _Element(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    source: str
    name: str
    held_by: list[str]
    derived_by: str | None = None


class _Elements(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    source: dict[str, _Source]
    element: list[_Element]


class HeldElements(NamedTuple):
    """The elements of one list: elements that the log contains, elements that are computed from others, and absent elements."""

    title: str
    present: list[str]
    derived: list[str]
    absent: list[str]


@cache
def _elements() -> _Elements:
    return msgspec.convert(toml_beside(__file__, "elements.toml"), _Elements)


def held_elements(tables: Mapping[str, pa.Table], log: Mapping[str, Any], actor_id: str) -> list[HeldElements]:
    """Return, for each list, which of its elements a drive contains.

    `tables`: the tables of `schemas/model.sql`; `log`: the drive's row, with columns of `data_log`; `actor_id`: the first party.
    """
    checks = set(tables["quality"]["check_id"].to_pylist())
    found = []
    for name, about in _elements().source.items():
        told = HeldElements(about.title, [], [], [])
        for element in (each for each in _elements().element if each.source == name):
            held = any(_holds(place, tables, log, actor_id) for place in element.held_by)
            kind = told.absent if not held else told.derived if element.derived_by in checks else told.present
            kind.append(element.name)
        found.append(told)
    return found


def _holds(place: str, tables: Mapping[str, pa.Table], log: Mapping[str, Any], actor_id: str) -> bool:
    kind, _, name = place.partition(":")
    if name:
        table, column = {"event": ("declared_event", "event"), "condition": ("drive_condition", "condition")}[kind]
        return bool(pc.any(pc.equal(tables[table][column], name)).as_py())
    if place == "others":
        return bool(tables["actor"].num_rows > 1)
    table, _, column = place.partition(".")
    if table == "data_log":
        return log.get(column) is not None
    rows = tables[table]
    mine = rows.filter(pc.equal(rows["actor_id"], actor_id))
    return bool(mine.num_rows > mine[column].null_count)
