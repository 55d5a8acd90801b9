"""The comparison of the German rules with commonroad-stl-monitor 2025.1.1, on made-up numbers: the peer itself is not needed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import duckdb
import pytest
from lxml import etree

from drivelint.catalogue import load_rules

from .kinds import FACTS, kinds, load_kinds
from .scenarios import scenario_kinds, with_speed_limit
from .sides import TWINS, Pair, pairs
from .stvo import report, table

if TYPE_CHECKING:
    from pathlib import Path

KNOWN_KINDS = load_kinds()


def vehicle_ahead(gap_m: float, v_mps: float = 10.0, **more: Any) -> dict[str, Any]:
    """A vehicle ahead in the ego's lane, 4 m long as the ego."""
    return {
        "id": "o",
        "gap_m": gap_m,
        "behind_m": -gap_m - 8.0,
        "same_lane": True,
        "d_m": 0.0,
        "v_mps": v_mps,
        "a_mps2": 0.0,
        "length_m": 4.0,
        **more,
    }


def row(v_mps: float, *other_vehicles: dict[str, Any], a_mps2: float = 0.0) -> dict[str, Any]:
    return {"v_mps": v_mps, "a_mps2": a_mps2, "d_m": 0.0, "lanes": 1, "others": list(other_vehicles)}


def pair(rule: str, our_verdict: str | None, peer_result: str | None, **more: Any) -> Pair:
    return Pair("scenario", rule, "7", our_verdict, peer_result, **more)


def test_every_kind_is_computed_and_belongs_to_a_rule() -> None:
    assert {kind.name for kind in KNOWN_KINDS} == set(FACTS)
    rules = set(load_rules())
    assert {rule for kind in KNOWN_KINDS for rule in kind.rules} <= rules
    assert {rule for twins in TWINS.values() for rule in twins} <= rules
    assert {kind.breach for kind in KNOWN_KINDS} == {"peer", "ours"}


# 20 m/s behind 10 m/s: 6 m of reaction in 0.3 s and 20 m of braking, less 4.76 m: 21.24 m.
@pytest.mark.parametrize(
    ("name", "steps", "more", "is_so"),
    [
        ("swaying_cuts_in", {0: row(20, vehicle_ahead(21)), 9: row(20, vehicle_ahead(21))}, {}, True),
        ("swaying_cuts_in", {0: row(20, vehicle_ahead(21, same_lane=False)), 9: row(20, vehicle_ahead(21))}, {}, False),
        ("swaying_cuts_in", {9: row(20, vehicle_ahead(22))}, {}, False),
        ("last_step", {9: row(20)}, {"last_step": 9}, True),
        ("last_step", {9: row(20)}, {"last_step": 10}, False),
        ("longer_reaction", {9: row(20, vehicle_ahead(22))}, {}, True),
        ("longer_reaction", {9: row(20, vehicle_ahead(21))}, {}, False),
        ("reason_a_moment_ago", {0: row(20, vehicle_ahead(21)), 9: row(20, vehicle_ahead(60), a_mps2=-3)}, {}, True),
        (
            "reason_a_moment_ago",
            {0: row(20, vehicle_ahead(60, a_mps2=-1.5)), 9: row(20, vehicle_ahead(60), a_mps2=-3)},
            {},
            True,
        ),
        (
            "reason_a_moment_ago",
            {0: row(20, vehicle_ahead(60, a_mps2=-0.5)), 9: row(20, vehicle_ahead(60), a_mps2=-3)},
            {},
            False,
        ),
        ("must_brake", {9: row(20)}, {"needs": {9: 2.0}}, True),
        ("must_brake", {9: row(20)}, {"needs": {9: 1.9}}, False),
        ("peak_of_samples", {9: row(20, a_mps2=-3)}, {"values": {9: -1.9}}, True),
        ("peak_of_samples", {9: row(20, a_mps2=-3)}, {"values": {9: -2.1}}, False),
        ("peak_of_samples", {9: row(20, a_mps2=-3)}, {}, False),
        ("end_of_track", {8: row(20), 9: row(20)}, {}, True),
        ("end_of_track", {0: row(20), 9: row(20), 30: row(20)}, {}, False),
        (
            "stopped_behind_a_queue",
            {7: row(1, vehicle_ahead(5, 1)), 8: row(0, vehicle_ahead(5, 1)), 9: row(0)},
            {},
            True,
        ),
        (
            "stopped_behind_a_queue",
            {7: row(1, vehicle_ahead(5, 3)), 8: row(0, vehicle_ahead(5, 3)), 9: row(0)},
            {},
            False,
        ),
        ("rolls", {8: row(0.2), 9: row(0.2)}, {}, True),
        ("rolls", {8: row(0.0), 9: row(0.2)}, {}, False),
        ("alongside_only", {8: row(20, vehicle_ahead(0, d_m=3.5)), 9: row(20, vehicle_ahead(-2, d_m=3.5))}, {}, True),
        ("alongside_only", {8: row(20, vehicle_ahead(0, d_m=3.5)), 9: row(20, vehicle_ahead(-5, d_m=3.5))}, {}, False),
        (
            "fewer_than_three_ahead",
            {9: row(2, vehicle_ahead(5, 2), vehicle_ahead(15, 2), vehicle_ahead(25, 9))},
            {},
            True,
        ),
        (
            "fewer_than_three_ahead",
            {9: row(2, vehicle_ahead(5, 2), vehicle_ahead(15, 2), vehicle_ahead(25, 2))},
            {},
            False,
        ),
        ("faster_than_walking_pace", {9: row(2, vehicle_ahead(5, 3))}, {}, True),
        ("faster_than_walking_pace", {9: row(2, vehicle_ahead(5, 2))}, {}, False),
        ("border_within_75_cm", {9: row(2)}, {"values": {9: 0.5}}, True),
        ("border_within_75_cm", {9: row(2)}, {"values": {9: 0.8}}, False),
        ("slow_vehicle_beside", {9: row(9, vehicle_ahead(20, 9, same_lane=False, d_m=3.5))}, {}, True),
        ("slow_vehicle_beside", {9: row(9, vehicle_ahead(20, 9.1, same_lane=False, d_m=3.5))}, {}, False),
        ("slow_vehicle_beside", {9: row(9, vehicle_ahead(31, 9, same_lane=False, d_m=3.5))}, {}, False),
        ("slow_vehicle_beside", {9: row(9, vehicle_ahead(-39, 9, same_lane=False, d_m=3.5))}, {}, False),
        ("slow_vehicle_beside", {9: row(9, vehicle_ahead(20, 9, same_lane=False, d_m=16))}, {}, False),
        ("slow_vehicle_beside", {9: row(9, vehicle_ahead(40, 9))}, {}, True),
        ("time_to_speed_up", {-91: row(9, vehicle_ahead(40, 9)), 9: row(9)}, {}, True),
        ("time_to_speed_up", {-92: row(9, vehicle_ahead(40, 9)), 9: row(9)}, {}, False),
        ("time_to_speed_up", {-91: row(9, vehicle_ahead(40, 9.1)), 9: row(9)}, {}, False),
        ("time_to_speed_up", {-141: row(0.5), 9: row(9)}, {}, True),
        ("time_to_speed_up", {-142: row(0.5), 9: row(9)}, {}, False),
        ("time_to_speed_up", {8: row(0.5), 9: row(0.5)}, {}, False),
        ("limit_of_another_country", {9: row(20)}, {"fails": (9,)}, True),
        ("limit_of_another_country", {9: row(20)}, {"fails": (8,)}, False),
        ("touches_several_lanes", {9: {**row(20), "lanes": 2}}, {}, True),
        ("touches_several_lanes", {9: row(20)}, {}, False),
        ("within_tolerance", {9: row(20)}, {"values": {9: 20.0}}, True),
        ("within_tolerance", {9: row(20)}, {}, False),
    ],
)
def test_a_kind_follows_from_numbers(name: str, steps: dict[int, Any], more: dict[str, Any], is_so: bool) -> None:
    assert FACTS[name](pair("stvo.rg1", "pass", "kept", steps=steps, **more), 9) is is_so


@pytest.mark.parametrize("scenario", ["DEU_A9-1", "ZAM_Test-1", "USA_US101-4_1_T-1+60"])
def test_a_german_sign_is_known_to_the_peer(scenario: str) -> None:
    judged = Pair(scenario, "stvo.rg3", "7", "fail", "kept", fails=(9,), steps={9: row(20)})
    assert not FACTS["limit_of_another_country"](judged, 9)


def test_a_difference_is_explained_only_if_each_step_of_the_breach_is() -> None:
    steps = {k: row(20, a_mps2=-3) for k in range(30)}
    filtered = pair("stvo.rg2", "pass", "broken", breaks=(10, 11), values={10: -1.9, 11: -1.9}, steps=steps)
    assert kinds(filtered, KNOWN_KINDS) == ["peak_of_samples"]
    filtered.values[11] = -2.5
    assert kinds(filtered, KNOWN_KINDS) == []
    # The kind is one of breaches of the peer, and of this rule.
    assert kinds(pair("stvo.rg2", "fail", "kept", fails=(10,), values={10: -1.9}, steps=steps), KNOWN_KINDS) == []
    assert kinds(pair("stvo.rg1", "pass", "broken", breaks=(10,), values={10: -1.9}, steps=steps), KNOWN_KINDS) == []


def test_the_figures_and_the_bars() -> None:
    found = [pair("stvo.rg3", "pass", "kept") for _ in range(60)]
    found += [pair("stvo.rg3", "unknown", "kept", reason="no_limit", n_judged=3), pair("stvo.rg3", "pass", None)]
    found += [pair("stvo.rg3", "pass", "broken", breaks=(9,), values={9: 1.0}, steps={9: row(20)})]
    found += [pair("stvo.rg3", "not_applicable", "broken", breaks=(9,), steps={9: row(20)})]
    assert table(found, KNOWN_KINDS)[-1] == ("all", 64, 63, 62, 1, 60, 1, 1)
    text, is_met = report(found, {"s": "exit 1"})
    assert is_met
    assert "stvo.rg3 no_limit: 1" in text
    assert "UNEXPLAINED scenario stvo.rg3 vehicle 7" in text
    found.append(found[-1])
    assert not report(found, {})[1]  # 2 of 63


def test_steps_and_verdicts_of_both_sides_meet(tmp_path: Path) -> None:
    ours = duckdb.connect()
    ours.execute(
        """
        CREATE TABLE verdicts AS FROM (VALUES
            ('7', 'stvo.rg1', 'pass', 'kept', NULL, 9, 0.5::DOUBLE),
            ('7', 'stvo.rg1', 'unknown', 'applies_unknown', 'object_lost', 0, NULL),
            ('7', 'stvo.rg2', 'fail', 'violated', NULL, 9, 0.8),
            ('7', 'stvo.ri3', 'not_applicable', 'not_triggered', NULL, 0, NULL)
        ) AS v(ego_id, rule_id, verdict, reason_code, cause_code, n_judged, t_worst_s)
        """
    )
    ours.execute("CREATE TABLE margins (ego_id TEXT, rule_id TEXT, t_s DOUBLE, observed DOUBLE, margin DOUBLE)")
    ours.execute("INSERT INTO margins VALUES ('7', 'stvo.rg2', 0.8, -3.0, -1.0), ('7', 'stvo.rg2', 0.7, -1.0, 1.0)")
    told = {
        "dt_s": 0.1,
        "first_step": {"7": 3},
        "steps": {"7": [{"step": 3, **row(20)}, {"step": 4, "error": "off the road"}]},
        "robustness": {"R_G1": {"7": [0.1, -0.1, None]}, "R_G2": {"7": [0.0, 0.1]}, "R_I3": {"7": []}},
    }
    made = {each.rule: each for each in pairs(tmp_path / "s.xml", "interstate", ours, told)}
    assert set(made) == set(TWINS["interstate"])
    first, second = made["stvo.rg1"], made["stvo.rg2"]
    assert (first.our_verdict, first.reason, first.n_judged, first.peer_result, first.breaks) == (
        "unknown",
        "object_lost",
        9,
        "broken",
        (4,),
    )
    assert (first.last_step, list(first.steps), first.differ) == (6, [3], False)
    assert (second.our_verdict, second.fails, second.peer_result, second.values, second.differ) == (
        "fail",
        (8,),
        "kept",
        {8: -3.0, 7: -1.0},
        True,
    )
    assert (made["stvo.ri3"].our_verdict, made["stvo.ri3"].peer_result) == ("not_applicable", None)
    assert {each.peer_result for each in pairs(tmp_path / "s.xml", "interstate", ours, "exit 1")} == {None}


@pytest.mark.parametrize(("content", "kinds_of_scenario"), [("", 1), ('<intersection id="1"/>', 2)])
def test_rules_of_intersections_need_one(tmp_path: Path, content: str, kinds_of_scenario: int) -> None:
    scenario = tmp_path / "s.xml"
    scenario.write_text(f"<commonRoad>{content}</commonRoad>")
    assert len(scenario_kinds(scenario)) == kinds_of_scenario


@pytest.mark.parametrize(
    ("version", "sign", "is_written"),
    [("2020a", "", True), ("2018b", "", False), ("2020a", '<trafficSign id="9"/>', False)],
)
def test_a_twin_has_one_limit_for_all_lanes(tmp_path: Path, version: str, sign: str, is_written: bool) -> None:
    scenario = tmp_path / "USA_X-1.xml"
    scenario.write_text(
        f'<commonRoad benchmarkID="USA_X-1" commonRoadVersion="{version}"><lanelet id="1"/><lanelet id="2"/>{sign}</commonRoad>'
    )
    made = with_speed_limit(scenario, 60, tmp_path)
    assert (made is not None) is is_written
    if made:
        root = etree.parse(made).getroot()
        assert root.get("benchmarkID") == "DEU_X-1"
        (limit,) = root.findall("trafficSign")
        assert [ref.get("ref") for ref in root.iterfind("lanelet/trafficSignRef")] == [limit.get("id")] * 2
        assert [element.text for element in limit.iterfind("trafficSignElement/*")] == ["274", "16.6667"]
