"""Drives with one planted fault each, and what is found in them."""

from __future__ import annotations

import tomllib
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from tests.clean.judging import renamed_drive, story_drive, verdicts
from tests.demo import scene_drive
from tests.demo.scenes import all_scenes

if TYPE_CHECKING:
    from collections.abc import Callable

    from drivelint.engine.batch import Drive
    from tests.scenes import Row


class Planted(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One entry of planted.toml."""

    rule: str
    chapter: str = ""
    change: dict[str, Any] = {}
    scene: str = ""
    unchanged: str = ""
    nation: str = "gb"
    implied: dict[str, str] = {}

    @property
    def pack(self) -> str:
        """Return the pack of the rule."""
        return self.rule.partition(".")[0]

    @property
    def clean(self) -> str:
        """Return the name of the drive without the violation."""
        return self.unchanged or f"{self.nation} {self.chapter}"

    def drives(self) -> dict[str, Callable[[], Drive]]:
        """Return the drive with the violation, named like the rule, and the one without."""
        if self.scene:
            return {
                self.rule: partial(_demo, self.scene, self.rule),
                self.clean: partial(_demo, self.unchanged, self.clean),
            }
        return {
            self.rule: partial(story_drive, self.rule, self.nation, [self.chapter], self.change),
            self.clean: partial(story_drive, self.clean, self.nation, [self.chapter]),
        }


def _demo(scene: str, name: str) -> Drive:
    return renamed_drive(scene_drive.drive_of_scene(next(s for s in all_scenes() if s.name == scene)), name)


PLANTED = msgspec.convert(
    tomllib.loads((Path(__file__).parent / "planted.toml").read_text(encoding="utf-8"))["planted"], list[Planted]
)


@cache
def planted_verdicts(pack: str) -> dict[str, list[Row]]:
    """Return the verdicts of a pack on its planted drives (by rule), and on the same ones without (by their names)."""
    drives: dict[str, Callable[[], Drive]] = {}
    for planted in PLANTED:
        if planted.pack == pack:
            drives |= planted.drives()
    return verdicts([make() for make in drives.values()], [pack])
