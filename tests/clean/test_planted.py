"""One violation planted: exactly that rule of its pack fails, with those that it implies; without it, none does."""

from __future__ import annotations

import tomllib
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec
import pytest

from drivelint import catalogue
from drivelint.demo import memory
from drivelint.demo.scenes import library
from tests.clean.judging import EVERYWHERE, PACKS, broken, named, stable, told, verdicts

if TYPE_CHECKING:
    from collections.abc import Callable

    from drivelint.engine.batch import Drive
    from tests.scenes import Row

# stable rules that no planted violation breaks, and why
NOT_PLANTED = {
    "ukhc.contact-signature": "an impact that the boxes miss: the rule's own cases",
    "ukhc.r162.safe-distance-ahead": "no profile asks for as much as a whole overtake takes, so who breaks it has broken all the "
    "others: tests/test_case_study.py",
    "alks-r157.cut-in": "a collision after a cut-in that left time enough: the rule's own cases",
    "criticality.mttc": "it differs from ttc only while the ego speeds up towards somebody: the rule's own cases",
}


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
            self.rule: partial(told, self.rule, self.nation, [self.chapter], self.change),
            self.clean: partial(told, self.clean, self.nation, [self.chapter]),
        }


def _demo(scene: str, name: str) -> Drive:
    return named(memory.drive(next(s for s in library() if s.name == scene)), name)


PLANTED = msgspec.convert(
    tomllib.loads((Path(__file__).parent / "planted.toml").read_text(encoding="utf-8"))["planted"], list[Planted]
)


@cache
def judged(pack: str) -> dict[str, list[Row]]:
    """Return the verdicts of a pack on its planted drives (by rule), and on the same ones without (by their names)."""
    drives: dict[str, Callable[[], Drive]] = {}
    for planted in PLANTED:
        if planted.pack == pack:
            drives |= planted.drives()
    return verdicts([make() for make in drives.values()], [pack])


@pytest.mark.parametrize("planted", PLANTED, ids=lambda p: p.rule)
def test_exactly_what_is_planted_is_found(planted: Planted) -> None:
    assert broken(judged(planted.pack)[planted.rule]) == {planted.rule, *planted.implied}


@pytest.mark.parametrize("planted", PLANTED, ids=lambda p: p.rule)
def test_unchanged_nothing_is_found(planted: Planted) -> None:
    assert not broken(judged(planted.pack)[planted.clean])


def test_every_stable_rule_is_planted_or_said_not_to_be() -> None:
    packs = {*PACKS["gb"], *PACKS["de"], *EVERYWHERE}
    planted = {p.rule for p in PLANTED}
    assert not set(stable(packs)) - planted - NOT_PLANTED.keys(), (
        "plant a violation in planted.toml, or say in NOT_PLANTED why not"
    )
    assert not (planted | NOT_PLANTED.keys()) - set(stable(packs)), "these are no stable rules (any more)"
    assert not planted & NOT_PLANTED.keys()
    assert {i for p in PLANTED for i in p.implied} <= catalogue.load().keys()
