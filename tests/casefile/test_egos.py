"""Each ego has its own rows: the cases of a table give the same rows if their egos are egos of one drive."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

import pytest

from drivelint.casefile.merged_cases import NumberedCase
from drivelint.casefile.table_cases import CompleteCase, FilledCases, read_table_cases, rows_difference
from drivelint.sql import declarations
from drivelint.sql.library import library_tables

if TYPE_CHECKING:
    from collections.abc import Container, Sequence

    from drivelint.casefile.merged_cases import Scene
    from drivelint.casefile.scene import Row

TABLES = [table for table in library_tables() if "ego_id" in declarations.column_comments()[table]]
ABOUT_ALL_ACTORS = frozenset(
    {"_common_ground", "_meeting", "capability", "crossing_passage", "forced_braking", "pair", "passage_conflict",
     "registration", "velocity_bound"}
)  # fmt: skip
"""Tables that read every actor of the drive: another ego is another actor there. Cases that give the track of their ego are left out."""


def egos_of(scene: Scene) -> set[str]:
    """Return the egos of a case: those of its rows, and the actors that are egos."""
    by_key = {row["ego_id"] for rows in scene.values() for row in rows if row.get("ego_id") is not None}
    return by_key | {row["actor_id"] for row in scene.get("actor", ()) if row.get("is_ego")}


def is_left_out(table: str, scene: Scene) -> bool:
    """Whether other egos may change the rows of this case, or its ego is an object, too."""
    egos = egos_of(scene)
    if any(row.get("object_id") in egos for rows in scene.values() for row in rows):
        return True
    tracks = (row for name, rows in scene.items() if name != "road_user" for row in rows)
    return table in ABOUT_ALL_ACTORS and any(row.get("actor_id") in egos for row in tracks)


def of_ego(row: Row, egos: Container[object]) -> bool:
    return "ego_id" in row or row.get("actor_id") in egos


def together(cases: Sequence[Scene]) -> Scene:
    """Return the cases as one: each ego has the number of its case before its id; the other rows are those of the first case."""
    merged: Scene = {}
    for no, scene in enumerate(cases):
        egos = egos_of(scene)
        for table, rows in scene.items():
            into = merged.setdefault(table, [])
            if no == 0:
                into += [row for row in rows if not of_ego(row, egos)]
            into += [
                row | {key: f"{no}:{row[key]}" for key in ("ego_id", "actor_id") if row.get(key) in egos}
                for row in rows
                if of_ego(row, egos)
            ]
    return merged


def wrong_rows(table: str) -> list[str]:
    """Return the cases of a table whose rows differ where other egos are in the same drive."""
    declared = library_tables()[table]
    groups: dict[str, list[CompleteCase]] = defaultdict(list)
    for case in read_table_cases(declared):
        scene = case.numbered.scene
        if is_left_out(table, scene):
            continue
        egos = egos_of(scene)
        others = {name: [row for row in rows if not of_ego(row, egos)] for name, rows in scene.items()}
        groups[repr(sorted((name, rows) for name, rows in others.items() if rows))].append(case)
    # a case that has no like beside it has itself
    pairs = [group if len(group) > 1 else group * 2 for group in groups.values()]
    merged = [
        group[0]._replace(numbered=NumberedCase(no, together([case.numbered.scene for case in group]), {}))
        for no, group in enumerate(pairs)
    ]
    filled = FilledCases(declared, merged)
    try:
        found = filled.rows_by_case(declared.select)
    finally:
        filled.clear()
    wrong = []
    for no, group in enumerate(pairs):
        for k, case in enumerate(group):
            mine = [
                row | {key: row[key].removeprefix(f"{k}:") for key in ("ego_id", "actor_id") if row.get(key)}
                for row in found.get(no, [])
                if row["ego_id"].startswith(f"{k}:")
            ]
            if difference := rows_difference(table, case.expected_rows, mine):
                wrong.append(f"{case.place}: {difference}")
    return wrong


@pytest.mark.ci
@pytest.mark.parametrize("table", TABLES)
def test_each_ego_has_its_own_rows(table: str) -> None:
    assert wrong_rows(table) == []
