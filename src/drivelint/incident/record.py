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


class _SourceOfDataElements(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    title: str


class _DataElement(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    source: str
    name: str
    held_by: list[str]
    derived_by: str | None = None


class _DataElementsFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    source: dict[str, _SourceOfDataElements]
    element: list[_DataElement]


class DataElementsByPresence(NamedTuple):
    """The elements of one list: elements that the log contains, elements that are computed from others, and absent elements."""

    title: str
    present: list[str]
    derived: list[str]
    absent: list[str]


@cache
def _read_data_elements_file() -> _DataElementsFile:
    return msgspec.convert(toml_beside(__file__, "elements.toml"), _DataElementsFile)


def data_elements_by_presence(
    tables: Mapping[str, pa.Table], drive_row: Mapping[str, Any], actor_id: str
) -> list[DataElementsByPresence]:
    """Return, for each list, which of its elements a drive contains.

    `tables`: the tables of `schemas/model.sql`; `drive_row`: the drive's row, with columns of `data_log`; `actor_id`: the first party.
    """
    checks = set(tables["quality"]["check_id"].to_pylist())
    lists = []
    for name, about in _read_data_elements_file().source.items():
        elements = DataElementsByPresence(about.title, [], [], [])
        for element in (entry for entry in _read_data_elements_file().element if entry.source == name):
            is_held = any(_has_data_at(place, tables, drive_row, actor_id) for place in element.held_by)
            kind = (
                elements.absent
                if not is_held
                else elements.derived
                if element.derived_by in checks
                else elements.present
            )
            kind.append(element.name)
        lists.append(elements)
    return lists


def _has_data_at(data_place: str, tables: Mapping[str, pa.Table], drive_row: Mapping[str, Any], actor_id: str) -> bool:
    kind, _, name = data_place.partition(":")
    if name:
        table, column = {"event": ("declared_event", "event"), "condition": ("drive_condition", "condition")}[kind]
        return bool(pc.any(pc.equal(tables[table][column], name)).as_py())
    if data_place == "others":
        return bool(tables["actor"].num_rows > 1)
    table, _, column = data_place.partition(".")
    if table == "data_log":
        return drive_row.get(column) is not None
    rows = tables[table]
    actor_rows = rows.filter(pc.equal(rows["actor_id"], actor_id))
    return bool(actor_rows.num_rows > actor_rows[column].null_count)
