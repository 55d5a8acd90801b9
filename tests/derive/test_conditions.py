"""The conditions of a step, and the modes that a log declares."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
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
    tee,
    times,
)

if TYPE_CHECKING:
    import duckdb

    from drivelint.engine.batch import Drive

CONDITIONS = ("road_type", "carriageway", "area", "nation", "weather", "light", "vehicle_class", "limit_mps", "engaged")


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


def test_in_a_junction_the_carriageway_is_not_known() -> None:
    way = tee()["straight"]
    t = times(30.0)
    ego = moving("ego", way, t, 5 + 10 * t, way.own)
    con = derived(drive([ego], way.environment), tables=["ego_condition"])
    seen = rows(
        con, "SELECT DISTINCT in_junction, carriageway FROM ego_condition JOIN ego_state USING (drive_id, ego_id, t_ns)"
    )
    assert {(row["in_junction"], row["carriageway"]) for row in seen} == {(False, "single"), (True, None)}


def test_without_a_map_the_road_is_not_known_and_the_rest_is() -> None:
    con = derived(drive([ride(kind="bus")], None), tables=["ego_condition"])
    assert [only(con, c) for c in CONDITIONS] == [None, None, None, None, None, None, "bus", None, True]


def test_off_the_lanes_the_road_is_not_known() -> None:
    way = road()
    con = derived(drive([ride(way, d=-30.0)], way.environment), tables=["ego_condition"])
    assert [only(con, c) for c in ("road_type", "carriageway", "area", "limit_mps")] == [None] * 4


@pytest.mark.parametrize(
    ("kind", "expected"),
    [
        ("car", "car"),
        ("motorcycle", "motorcycle"),
        ("bus", "bus"),
        ("van", None),
        ("truck", None),
        ("vehicle", None),
        (None, None),
    ],
)
def test_the_class_of_the_ego_is_told_only_where_it_says_enough(kind: str | None, expected: str | None) -> None:
    """A van may be a car-derived one or a goods vehicle; a lorry may be of any weight."""
    con = derived(drive([ride(kind=kind)], None), tables=["ego_condition"])
    assert only(con, "vehicle_class") == expected


@pytest.mark.ci
def test_what_is_given_for_the_drive_overrides_the_map_and_the_log() -> None:
    way = highway("town", *BOTH)
    given = {
        "road_type": "rural", "carriageway": "dual", "area": "built_up", "nation": "gb-sct", "weather": "wet",
        "light": "night", "vehicle_class": "goods_7t5", "engaged": "no",
    }  # fmt: skip
    told = saying(drive([ride(way)], way.environment), [(0.0, "engaged", "on")], **given)
    con = derived(told, tables=["ego_condition"])
    assert {c: only(con, c) for c in given} == {**given, "engaged": False}
    # the area follows a road type that is given, too
    con = derived(saying(drive([ride(way)], way.environment), road_type="motorway"), tables=["ego_condition"])
    assert [only(con, c) for c in ("road_type", "carriageway", "area")] == ["motorway", "single", "open"]


def test_a_mode_holds_from_its_declaration_to_the_next() -> None:
    said: list[Event] = [
        (0.25, "engaged", "ON"), (0.6, "engaged", "false"), (0.8, "engaged", "perhaps"), (0.9, "engaged", "true"),
        (0.5, "headlights", "on"),
        (0.1, "mirror_check", None), (0.2, "target_speed", "30"),
    ]  # fmt: skip
    con = derived(saying(drive([ride()], None), said), tables=["ego_condition"])
    expected = [None] * 3 + [True] * 3 + [False] * 2 + [None] + [True] * 2
    assert conditions(con, "engaged") == expected
    modes = rows(con, "FROM ego_mode ORDER BY mode, t_ns")
    assert [row["is_on"] for row in modes if row["mode"] == "engaged"] == expected
    assert [row["is_on"] for row in modes if row["mode"] == "headlights"] == [None] * 5 + [True] * 6
    assert {row["mode"] for row in modes} == {"engaged", "headlights"}


def test_two_declarations_at_once_are_not_known() -> None:
    said: list[Event] = [(0.0, "engaged", "on"), (0.5, "engaged", "on"), (0.5, "engaged", "off")]
    con = derived(saying(drive([ride()], None), said), tables=["ego_condition"])
    assert conditions(con, "engaged") == [True] * 5 + [None] * 6


def test_what_another_actor_declares_is_not_the_egos() -> None:
    other = replace(ride(), actor_id="other")
    told = saying(drive([ride(), other], None), [(0.0, "engaged", "off")], by="other")
    con = derived(told, tables=["ego_condition"])
    assert only(con, "engaged") is True
    assert rows(con, "FROM ego_mode") == []


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


@pytest.mark.ci
def test_what_the_log_declares_can_be_required() -> None:
    quiet = drive([ride()], None)
    assert not any(there for signal, there in signals(quiet).items() if signal.startswith(("mode", "declared")))
    loud = saying(quiet, [(0.0, "horn", "on"), (0.5, "overtake_go", None)])
    said = signals(loud)
    assert [said[s] for s in ("declared_events", "modes", "mode_horn", "mode_engaged")] == [True, True, True, False]
    assert not signals(saying(quiet, [(0.0, "overtake_go", None)]))["modes"]
    given = signals(saying(quiet, (), engaged="yes"))
    assert [given["mode_engaged"], given["mode_horn"]] == [True, False]


@pytest.mark.ci
def test_what_the_others_are_is_known_if_it_is_of_any_of_them_or_nobody_is_there() -> None:
    def known(*kinds: str | None) -> bool:
        others = [replace(ride(kind=kind), actor_id=f"o{n}") for n, kind in enumerate(kinds)]
        return signals(drive([ride(), *others], None))["actor_classes"]

    assert [known(), known("vehicle"), known(None), known(None, "bicycle"), known("car", "vehicle")] == [
        True, False, False, True, True,
    ]  # fmt: skip


@pytest.mark.ci
def test_a_road_type_may_be_given_where_the_map_has_none() -> None:
    def known(kind: str | None, **given: str) -> bool:
        way = highway(kind, *BOTH)
        return signals(saying(drive([ride(way)], way.environment), (), **given))["road_types"]

    assert [known("rural"), known(None), known(None, road_type="rural"), known(None, area="open")] == [
        True, False, True, False,
    ]  # fmt: skip
    assert signals(saying(drive([ride()], None), road_type="rural"))["road_types"]


def test_states_of_traffic_lights_count_only_if_one_is_known() -> None:
    scene = drive([ride()], None)
    for state, expected in ((None, False), ("red", True)):
        tables = dict(scene.trace.tables)
        row = {"drive_id": "d", "signal_id": "s", "t_ns": 0, "state": state}
        tables["signal_state"] = pa.Table.from_pylist([row], schema=tables["signal_state"].schema)
        assert signals(replace(scene, trace=replace(scene.trace, tables=tables)))["signals"] is expected


@pytest.mark.ci
def test_junctions_of_the_map_are_a_signal() -> None:
    way, plain = tee()["straight"], highway("rural", *BOTH)
    assert signals(drive([ride(way)], way.environment))["junctions"]
    assert not signals(drive([ride(plain)], plain.environment))["junctions"]


@pytest.mark.ci
def test_where_no_ways_meet_there_is_nothing_to_light_or_to_record() -> None:
    """But a map with junctions that has no lights may leave them out, and without a map nobody knows."""
    way, plain = tee()["straight"], highway("rural", *BOTH)
    told = [
        signals(scene)
        for scene in (
            drive([ride(plain)], plain.environment),
            drive([ride(way)], way.environment),
            drive([ride()], None),
        )
    ]
    assert [(said["traffic_lights"], said["signals"]) for said in told] == [
        (True, True),
        (False, False),
        (False, False),
    ]


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
