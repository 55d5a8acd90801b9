"""One violation planted: exactly that rule of its pack fails, with those that it implies; without it, none does."""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec
import pytest

from drivelint import catalogue
from tests.clean.judging import EVERYWHERE, PACKS, broken, stable, told, verdicts

if TYPE_CHECKING:
    from tests.scenes import Row

# stable rules that no planted violation breaks, and why
NOT_PLANTED = {
    "ukhc.contact-signature": "an impact that boxes miss: tests/test_case_study.py and the rule's own cases",
    "ukhc.exit-sign-signal": "the way has no exit: tests/demo has the exits",
    "ukhc.signal-then-leaves": "the way has no exit: tests/demo has the exits",
    "ukhc.r162.safe-distance-ahead": "a profile asks for less than a real overtake takes: who breaks it collides, see tests/test_case_study.py",
    "ukhc.r191.crossing-overtake": "no chapter overtakes at a crossing",
    "alks-r157.cut-in": "a collision after a cut-in that left time: the rule's own cases",
    "criticality.mttc": "differs from ttc only while the ego speeds up towards somebody: tests of criticality against an oracle",
}


class Planted(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One entry of planted.toml."""

    rule: str
    chapter: str
    change: dict[str, Any] = {}  # noqa: RUF012 - msgspec copies it
    nation: str = "gb"
    implied: dict[str, str] = {}  # noqa: RUF012

    @property
    def pack(self) -> str:
        """Return the pack of the rule."""
        return self.rule.partition(".")[0]


PLANTED = msgspec.convert(
    tomllib.loads((Path(__file__).parent / "planted.toml").read_text(encoding="utf-8"))["planted"], list[Planted]
)


@cache
def judged(pack: str) -> dict[str, list[Row]]:
    """Return the verdicts of a pack on its planted drives (by rule), and on the same chapters unchanged (by chapter)."""
    mine = [p for p in PLANTED if p.pack == pack]
    drives = [told(p.rule, p.nation, [p.chapter], p.change) for p in mine]
    chapters = sorted({(p.nation, p.chapter) for p in mine})
    drives += [told(f"{nation} {chapter}", nation, [chapter]) for nation, chapter in chapters]
    return verdicts(drives, [pack])


@pytest.mark.parametrize("planted", PLANTED, ids=lambda p: p.rule)
def test_exactly_what_is_planted_is_found(planted: Planted) -> None:
    assert broken(judged(planted.pack)[planted.rule]) == {planted.rule, *planted.implied}


@pytest.mark.parametrize("planted", PLANTED, ids=lambda p: p.rule)
def test_unchanged_nothing_is_found(planted: Planted) -> None:
    assert not broken(judged(planted.pack)[f"{planted.nation} {planted.chapter}"])


def test_every_stable_rule_is_planted_or_said_not_to_be() -> None:
    packs = {*PACKS["gb"], *PACKS["de"], *EVERYWHERE}
    planted = {p.rule for p in PLANTED}
    assert not set(stable(packs)) - planted - NOT_PLANTED.keys(), (
        "plant a violation in planted.toml, or say in NOT_PLANTED why not"
    )
    assert not (planted | NOT_PLANTED.keys()) - set(stable(packs)), "these are no stable rules (any more)"
    assert not planted & NOT_PLANTED.keys()
    assert {i for p in PLANTED for i in p.implied} <= catalogue.load().keys()
