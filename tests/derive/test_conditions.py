"""The conditions of a step, and the signals that a log and its map have."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from drivelint import catalogue
from drivelint.formats import load_map
from drivelint.inspect.advice import SIGNALS_NEEDING_MAP
from drivelint.reasons.reason_text import sentence
from drivelint.road.map_reader import MapSource
from tests.derive.marked import shouldered
from tests.formats.opendrive import xodr
from tests.scenes import (
    LANE,
    Actor,
    Event,
    Road,
    derived,
    drive,
    judged,
    linked,
    moving,
    plan,
    road,
    rows,
    saying,
    times,
)

if TYPE_CHECKING:
    import duckdb

    from drivelint.engine.batch import Drive


def ride(way: Road | None = None, d: float | None = None, seconds: float = 1.0, **more: Any) -> Actor:
    way = way or road()
    t = times(seconds)
    return replace(moving("ego", way, t, 5 + 10 * t, way.own if d is None else d), **more)


def conditions(con: duckdb.DuckDBPyConnection, column: str) -> list[Any]:
    found = rows(con, "FROM ego_condition ORDER BY t_ns")
    assert len(found) == rows(con, "SELECT count(*) AS n FROM step")[0]["n"]
    return [row[column] for row in found]


def only(con: duckdb.DuckDBPyConnection, column: str) -> Any:
    (value,) = set(conditions(con, column))
    return value


def highway(kind: str | None, *lanes: tuple[int, str]) -> Road:
    """Return a straight road of this type with these lanes: number and lane type."""
    line = ((200.0, 0.0),)
    section = xodr.section(0, *(linked(number, kind=what) for number, what in sorted(lanes, reverse=True)))
    types = f'<type s="0" type="{kind}"/>' if kind else ""
    text = xodr.xodr(xodr.road("1", plan(line), section, 200.0, "", 'rule="RHT"', types))
    return Road(load_map(MapSource("way.xodr", text.encode())), line)


BOTH = ((1, "driving"), (-1, "driving"))
ONE_WAY = ((-1, "driving"), (-2, "shoulder"))
MEDIAN = ((2, "driving"), (1, "median"), (-1, "driving"))
APART = ((2, "driving"), (1, "restricted"), (-1, "driving"))


@pytest.mark.sample(0, ci=5)
@pytest.mark.parametrize(
    ("kind", "lanes", "carriageway", "area"),
    [
        ("rural", BOTH, "single", "open"),
        ("rural", ONE_WAY, "dual", "open"),
        ("rural", MEDIAN, "dual", "open"),
        ("rural", APART, None, "open"),
        ("rural", ((1, "bidirectional"), (-1, "shoulder")), "single", "open"),
        ("motorway", ONE_WAY, "dual", "open"),
        ("motorway", APART, "dual", "open"),
        ("town", BOTH, "single", "built_up"),
        ("town", ONE_WAY, None, "built_up"),
        ("townLocal", BOTH, "single", "built_up"),
        ("townExpressway", BOTH, "single", None),
        ("lowSpeed", BOTH, "single", "built_up"),
        ("unknown", BOTH, "single", None),
        (None, ONE_WAY, None, None),
        (None, BOTH, "single", None),
    ],
)
def test_carriageway_and_area_by_the_road(
    kind: str | None, lanes: Any, carriageway: str | None, area: str | None
) -> None:
    way = highway(kind, *lanes)
    d = LANE / 2 if lanes[0][1] == "bidirectional" else -LANE / 2
    con = derived(drive([ride(way, d)], way.environment), tables=["ego_condition"])
    assert (only(con, "carriageway"), only(con, "area")) == (carriageway, area)
    assert only(con, "road_type") == (None if kind == "unknown" else kind)
    assert (only(con, "nation"), only(con, "weather"), only(con, "light")) == (None, None, None)


def signals(scene: Drive) -> dict[str, bool]:
    return {row["signal"]: row["available"] for row in capabilities(scene)}


@pytest.mark.parametrize("hand", ["rht", "lht"])
def test_the_hard_shoulder_is_a_part_of_the_motorway(hand: str) -> None:
    """The ego stops on it and reverses by 25 m: the road is known there, and reversing is no manoeuvre that is excused."""
    way, t = shouldered(hand), times(20.0)
    v = np.interp(t, [0, 4, 10, 12, 19, 20], [20, 20, 0, -4, -4, 0])
    s = 50 + np.concatenate([[0.0], np.cumsum((v[1:] + v[:-1]) / 2 * np.diff(t))])
    side = 1 if hand == "lht" else -1
    ego = moving("ego", way, t, s, side * LANE * (0.5 + np.clip((t - 2) / 4, 0, 1)))
    # backwards its nose still points the way that it came
    ego = replace(ego, yaw=0 * t, vx=v, vy=0 * t)
    scene = drive([ego], way.environment)
    assert only(derived(scene, tables=["ego_condition"]), "road_type") == "motorway"
    found = judged([scene], rules=["ukhc.r143.direction", "ukhc.r263.no-reverse"])
    assert {row["rule_id"]: row["verdict"] for row in found} == {
        "ukhc.r143.direction": "fail", "ukhc.r263.no-reverse": "fail",
    }  # fmt: skip


def capabilities(scene: Drive) -> list[dict[str, Any]]:
    return rows(derived(scene, tables=["capability"]), "FROM capability")


def test_every_signal_that_a_rule_requires_is_answered_for_whatever_the_log() -> None:
    required = {signal for rule in catalogue.load_rules().values() for signal in rule.requires}
    assert required <= signals(drive([ride()], None)).keys()


@pytest.mark.ci
def test_every_signal_says_why_it_is_there_or_what_to_provide() -> None:
    way = highway("rural", *BOTH)
    for scene in (drive([ride()], None), drive([ride(way)], way.environment)):
        for row in capabilities(scene):
            assert row["reason"], row
    nothing = {row["signal"]: sentence(row["reason"]) for row in capabilities(drive([ride()], None))}
    assert {nothing[signal] for signal in {"map", *SIGNALS_NEEDING_MAP} - {"registration"}} == {
        "no map: provide one with --map"
    }


def test_exposure_tells_the_way_and_time_of_the_automated_driver() -> None:
    """Engaged at the steps from 0.4 s on, and not known from 0.8 s on."""
    (all_of_it,) = rows(derived(drive([ride()], None), tables=["exposure"]), "FROM exposure")
    assert all_of_it["engaged_km"] == pytest.approx(all_of_it["km"]) == pytest.approx(0.01)
    assert all_of_it["engaged_hours"] == all_of_it["hours"] == pytest.approx(1 / 3600)
    said: list[Event] = [(0.0, "engaged", "off"), (0.35, "engaged", "on"), (0.75, "engaged", "?")]
    (part,) = rows(derived(saying(drive([ride()], None), said), tables=["exposure"]), "FROM exposure")
    assert (part["km"], part["hours"], part["n_steps"]) == (all_of_it["km"], all_of_it["hours"], 11)
    assert part["engaged_km"] == pytest.approx(0.004)
    assert part["engaged_hours"] == pytest.approx(0.4 / 3600)
