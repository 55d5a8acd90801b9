"""Stories judged by every stable rule of the packs that fit their nation."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pyarrow as pa

from drivelint import catalogue
from tests.clean.chapters import CHAPTERS
from tests.clean.roads import open_road
from tests.clean.story import Story
from tests.scenes import verdict_rows

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from drivelint.engine.batch import Drive
    from tests.scenes import Row

EVERYWHERE = ("rss", "criticality", "comfort", "performance", "declared")
PACKS = {"gb": ("ukhc", *EVERYWHERE), "de": ("stvo", "alks-r157", *EVERYWHERE)}


def stable(packs: Iterable[str]) -> tuple[str, ...]:
    """Return the ids of the stable rules of packs."""
    return tuple(r.id for r in catalogue.load_rules().values() if r.status == "stable" and r.pack in packs)


def story_drive(name: str, nation: str, chapters: Iterable[str], change: Mapping[str, Any] | None = None) -> Drive:
    """Return a story of these chapters, the same change made to each, with open road before, between and after."""
    story = Story(nation)
    open_road(story)
    for chapter in chapters:
        CHAPTERS[chapter](story, **(change or {}))
        open_road(story)
    return story.drive(name)


def renamed_drive(drive: Drive, name: str) -> Drive:
    """Return the drive under another name."""
    tables = {}
    for table, rows in drive.trace.tables.items():
        column = rows.schema.get_field_index("drive_id")
        tables[table] = rows.set_column(column, "drive_id", pa.array([name] * len(rows), pa.string()))
    return replace(drive, trace=replace(drive.trace, drive_id=name, tables=tables))


def verdicts(drives: Iterable[Drive], packs: Iterable[str]) -> dict[str, list[Row]]:
    """Judge all drives in one batch; return rows by drive."""
    drives = list(drives)
    found: dict[str, list[Row]] = {drive.trace.drive_id: [] for drive in drives}
    for row in verdict_rows(drives, rules=stable(packs)):
        found[row["drive_id"]].append(row)
    return found


def broken(rows: Iterable[Row]) -> set[str]:
    """Return the rules that fail (or err)."""
    return {row["rule_id"] for row in rows if row["verdict"] in {"fail", "error"}}
