"""The conditions of a step, and the signals that a log and its map have."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from drivelint import catalogue
from drivelint.formats import load_map
from drivelint.inspect.advice import SIGNALS_NEEDING_MAP
from drivelint.reasons.reason_text import sentence
from drivelint.road.map_reader import MapSource
from tests.formats.opendrive import xodr
from tests.scenes import (
    Actor,
    Road,
    derived,
    drive,
    linked,
    moving,
    plan,
    road,
    rows,
    times,
)

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive


def ride(way: Road | None = None) -> Actor:
    way, t = way or road(), times(1.0)
    return moving("ego", way, t, 5 + 10 * t, way.ego_d)


def highway(kind: str | None, *lanes: tuple[int, str]) -> Road:
    """Return a straight road of this type with these lanes: number and lane type."""
    line = ((200.0, 0.0),)
    section = xodr.section(0, *(linked(number, kind=what) for number, what in sorted(lanes, reverse=True)))
    types = f'<type s="0" type="{kind}"/>' if kind else ""
    text = xodr.xodr(xodr.road("1", plan(line), section, 200.0, "", 'rule="RHT"', types))
    return Road(load_map(MapSource("way.xodr", text.encode())), line)


BOTH_LANES = ((1, "driving"), (-1, "driving"))


def signals(scene: Drive) -> dict[str, bool]:
    return {row["signal"]: row["available"] for row in capabilities(scene)}


def capabilities(scene: Drive) -> list[dict[str, Any]]:
    return rows(derived(scene, tables=["capability"]), "FROM capability")


def test_every_signal_that_a_rule_requires_is_answered_for_whatever_the_log() -> None:
    required = {signal for rule in catalogue.load_rules().values() for signal in rule.requires}
    assert required <= signals(drive([ride()], None)).keys()


@pytest.mark.ci
def test_every_signal_says_why_it_is_there_or_what_to_provide() -> None:
    way = highway("rural", *BOTH_LANES)
    for scene in (drive([ride()], None), drive([ride(way)], way.environment)):
        for row in capabilities(scene):
            assert row["reason"], row
    nothing = {row["signal"]: sentence(row["reason"]) for row in capabilities(drive([ride()], None))}
    assert {nothing[signal] for signal in {"map", *SIGNALS_NEEDING_MAP} - {"registration"}} == {
        "no map: provide one with --map"
    }
