"""One violation planted: exactly that rule of its pack fails, with those that it implies; without it, none does."""

from __future__ import annotations

import pytest

from drivelint import catalogue
from tests.clean.judging import EVERYWHERE, PACKS, broken, stable
from tests.clean.planted import PLANTED, Planted, planted_verdicts

# stable rules that no planted violation breaks, and why
NOT_PLANTED = {
    "ukhc.contact-signature": "an impact that the boxes miss: the rule's own cases",
    "ukhc.r162.safe-distance-ahead": "no profile asks for as much as a whole overtake takes, so who breaks it has broken all the "
    "others: tests/test_case_study.py",
    "alks-r157.cut-in": "a collision after a cut-in that left time enough: the rule's own cases",
    "criticality.mttc": "it differs from ttc only while the ego speeds up towards somebody: the rule's own cases",
}


@pytest.mark.ci
@pytest.mark.parametrize("planted", PLANTED, ids=lambda p: p.rule)
def test_exactly_what_is_planted_is_found(planted: Planted) -> None:
    assert broken(planted_verdicts(planted.pack)[planted.rule]) == {planted.rule, *planted.implied}


@pytest.mark.ci
@pytest.mark.parametrize("planted", PLANTED, ids=lambda p: p.rule)
def test_unchanged_nothing_is_found(planted: Planted) -> None:
    assert not broken(planted_verdicts(planted.pack)[planted.clean])


def test_every_stable_rule_is_planted_or_said_not_to_be() -> None:
    packs = {*PACKS["gb"], *PACKS["de"], *EVERYWHERE}
    planted = {p.rule for p in PLANTED}
    assert not set(stable(packs)) - planted - NOT_PLANTED.keys(), (
        "plant a violation in planted.toml, or say in NOT_PLANTED why not"
    )
    assert not (planted | NOT_PLANTED.keys()) - set(stable(packs)), "these are no stable rules (any more)"
    assert not planted & NOT_PLANTED.keys()
    assert {i for p in PLANTED for i in p.implied} <= catalogue.load_rules().keys()
