"""The criticality rules against a computation that shares nothing with them: recorded and simulated logs, step by step."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from drivelint import catalogue
from drivelint.drive.trace import IngestOptions
from drivelint.engine.batch import Drive
from drivelint.formats import load_map, read_trace
from drivelint.road.map_reader import MapSource
from drivelint.sql import store
from tests import followers, scenes
from tests.shared_data import shared

if TYPE_CHECKING:
    from pathlib import Path

MEASURES = ("ttc", "thw", "drac", "ttb")
AT_ONCE = {"settle_s": 0.0}
"""The headway is compared as soon as somebody has come in; what the time after that excuses is in tests/test_ordinary.py."""
ESMINI = {
    "cut-in": ("osi/e6mini", "Ego", 440),
    "left-hand-traffic_using_road_rule": ("maps/e6mini-lht", "Ego", 190),
    "light_state": ("maps/circle_300m", "Car1", 790),
    "pedestrian_collision": ("osi/fabriksgatan", "Ego", 180),
    "slow-lead-vehicle": ("maps/straight_500m_signs", "Ego", 220),
    "two_plus_one_road": ("maps/two_plus_one", "Ego", 330),
}
"""Log -> its map, its ego, how many steps at least must have been compared."""
COMMONROAD = {
    "DEU_Gar-1_1_T-1": 80,
    "OSC_Overtake-1_1_T-1": 400,
    "OSC_PedestrianCollision-1_1_T-1": 90,
    "USA_US101-5_1_T-1": 430,
}
"""Scenario -> how many steps at least must have been compared, every vehicle being the ego in turn."""
ZIGZAG_RAD = {"USA_US101-5_1_T-1": 0.05}
"""Scenario -> how far the headings of its lanelets' middle lines jump from piece to piece: see EXPLAINED."""
EXPLAINED = {
    # The bounds of the NGSIM lanelets were sampled apart, so that their middle line zigzags by 2 to 4 degrees. The product
    # takes a box's extent along and across the lane from the lane's direction at the middle of the box, the computation
    # here from each corner's own foot point: they differ by 0.1 m for a lorry of 15 m (whether 449, alongside, is 0.11
    # or 0.00 m inside the lane), and by 0.13 m in a gap of 12.3 m.
    ("USA_US101-5_1_T-1", "462", 43),
    ("USA_US101-5_1_T-1", "464", 43),
    ("USA_US101-5_1_T-1", "477", 37),
    # The ego changes lanes: from 1.3 s to 1.9 s it comes 0.74 m/s further from the middle, as the product has it (0.71 and 0.58 m/s),
    # and is beside its lead before it reaches it. The computation here takes the heading of one piece of that zigzag.
    ("USA_US101-5_1_T-1", "507", 18),
    ("USA_US101-5_1_T-1", "507", 19),
}
"""(log, ego, step) that may differ, and why."""

StepMeasures = dict[str, tuple[str | None, bool | None, float | None]]


def measures_by_step(trace_file: Path, map_file: Path, ego: str) -> dict[tuple[str, int], StepMeasures]:
    """Return (ego, time in ns) -> measure -> object, whether it applies, and the rule's observed value."""
    trace = read_trace(trace_file, IngestOptions(ego=ego))
    environment = load_map(MapSource(map_file.name, map_file.read_bytes()))
    rules = {name: catalogue.load_rules()[f"criticality.{name}"] for name in MEASURES}
    tables = {table for rule in rules.values() for table in rule.reads}
    found: dict[tuple[str, int], StepMeasures] = {}
    with store.connect(threads=1) as con:
        scenes.derived(Drive(trace, environment), tables=tables, con=con)
        # somebody may be nearer than whoever is seen: what is free may be enough for a rule, and nobody is said to lead
        doubted = set(con.execute("SELECT ego_id, t_ns FROM vehicle_ahead WHERE nearest AND NOT known").fetchall())
        for name, rule in rules.items():
            leads = {row[:2]: row[2] for row in con.execute("SELECT ego_id, t_ns, object_id FROM lead").fetchall()}

            def rows(section: str, columns: str, rule: catalogue.Rule = rule) -> list[tuple[Any, ...]]:
                sql = f"SELECT {columns} FROM ({rule.sections[section]})"
                bound = con.extract_statements(sql)[0].named_parameters
                return con.execute(sql, {p: AT_ONCE.get(p, rule.params[p].default) for p in bound}).fetchall()

            values = {row[:3]: row[3] for row in rows("condition", "ego_id, t_ns, object_id, observed")}
            for who, t, other, applies in rows("applies", "ego_id, t_ns, object_id, applies"):
                # those whom the lead may hide are judged as well; the other reading knows the lead only
                if other != leads.get((who, t), other):
                    continue
                value = values.get((who, t, other)) if applies else None
                found.setdefault((who, t), {})[name] = (other, None if (who, t) in doubted else applies, value)
    return found


def differences(measures: StepMeasures, expected: followers.Measure) -> list[str]:
    """Return in words how a step differs: another lead, defined for one only, or apart by more than 1 %, the lane's heading and 0.01."""
    said = []
    for name in MEASURES:
        other, _, value = measures[name]
        wanted = getattr(expected, name)
        same = (
            value is None
            if wanted is None
            else value is not None and math.isclose(value, wanted, rel_tol=0.01 + 3 * expected.share, abs_tol=0.01)
        )
        if other != expected.lead or not same:
            said.append(f"{name} {value} behind {other}, expected {wanted} behind {expected.lead}")
    return said


def knows_leader(measures: StepMeasures) -> bool:
    """Whether the product knows who leads at this step."""
    return all(applies is not None for _, applies, _ in measures.values())


@pytest.mark.sample(1)
@pytest.mark.parametrize("name", sorted(ESMINI))
def test_esmini(name: str) -> None:
    road, ego, least = ESMINI[name]
    log, xodr = shared(f"esmini/{name}.csv"), shared(f"{road}.xodr")
    found = measures_by_step(log, xodr, ego)
    expected = {round(t * 1e9): m for t, m in followers.esmini(log, xodr, ego).items()}
    assert expected.keys() == {t for _, t in found}
    compared = {t: m for t, m in expected.items() if knows_leader(found[ego, t]) and not m.close_call}
    assert len(compared) >= least
    assert {t: said for t, m in compared.items() if (said := differences(found[ego, t], m))} == {}


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(COMMONROAD))
def test_commonroad(name: str) -> None:
    file = shared(f"commonroad/{name}.xml")
    scenario = followers.Scenario(file)
    found = measures_by_step(file, file, "all")
    n, wrong = 0, {}
    for ego, obstacle in scenario.obstacles.items():
        if obstacle.kind == "pedestrian":
            continue
        for k, expected in scenario.measures(ego, ZIGZAG_RAD.get(name, 0.0)).items():
            step = found[ego, round(k * scenario.step_s * 1e9)]
            if expected is None or expected.close_call or not knows_leader(step):
                continue
            n += 1
            if (name, ego, k) not in EXPLAINED and (said := differences(step, expected)):
                wrong[ego, k] = said
    assert n >= COMMONROAD[name]
    assert wrong == {}


@pytest.mark.ci
def test_whoever_stands_ahead_is_as_near_on_every_course() -> None:
    """At 20 m/s to a car that stands, braking by 8 m/s2, to a stop 2 m behind it: at v the gap is 2 m + v2 / 16 m/s2.

    omega-prime 0.3.7 has no time to collision with one that stands, and commonroad-crime 0.4.5 another one on each course: seen in
    `findings/omega-prime-ttc-of-standing-car.sh` and `findings/commonroad-crime-ttc-by-compass.sh`.
    """
    t, length = scenes.times(8.0), 4.8
    braking_s = np.clip(t - 2.0, 0.0, 20.0 / 8.0)
    s = 50.0 + 20.0 * np.minimum(t, 2.0) + 20.0 * braking_s - 4.0 * braking_s**2
    drives = []
    for degrees in (0, 45, 90, 180, 250):
        way = scenes.road(start=(0.0, 0.0, math.radians(degrees)))
        ego = scenes.moving("ego", way, t, s, way.ego_d)
        other = scenes.standing("other", way, t, s[-1] + length + 2.0, way.ego_d)
        drives.append(scenes.drive([ego, other], way.environment, drive_id=f"course {degrees:03}"))
    speed = 20.0 - 8.0 * braking_s
    least = min((s[-1] + 2.0 - s)[speed > 1.0] / speed[speed > 1.0])
    found = scenes.verdict_rows(drives, rules=["criticality.ttc"])
    assert 0.7 < least < 0.72
    assert len({row["drive_id"] for row in found}) == len(drives)
    expected = ("other", "fail", pytest.approx(least, abs=0.01))
    assert [(row["object_id"], row["verdict"], row["observed"]) for row in found] == [expected] * len(drives)


@pytest.mark.ci
def test_modified_ttc_is_what_a_simulation_finds() -> None:
    """Random pairs at constant accelerations; a braking lead stands in the end (steps of 1 ms, so to 2 ms)."""
    draw = np.random.default_rng(4)
    dt, n = 1e-3, 400
    gap, v, lead_v = draw.uniform(0.5, 40, n), draw.uniform(0, 30, n), draw.uniform(0, 30, n)
    a, lead_a = draw.uniform(-6, 3, n), draw.uniform(-8, 3, n)
    t = np.arange(0, 6, dt)[:, None]
    stop = np.where(lead_a < 0, lead_v / np.where(lead_a < 0, -lead_a, 1), np.inf)
    held = np.minimum(t, stop)
    left = gap + lead_v * held + lead_a * held**2 / 2 - v * t - a * t**2 / 2
    hit = (left <= 0).any(axis=0)
    first = np.where(hit, dt * (left <= 0).argmax(axis=0), np.inf)
    with store.connect(threads=1) as con:
        sql = "SELECT mttc_s($gap, $v, $a, $lead_v, $lead_a)"
        for i in range(n):
            row = con.execute(
                sql, {"gap": gap[i], "v": v[i], "a": a[i], "lead_v": lead_v[i], "lead_a": lead_a[i]}
            ).fetchone()
            assert row is not None
            assert row[0] == pytest.approx(first[i], abs=2 * dt) if hit[i] else row[0] > 6 - dt
    assert 50 < hit.sum() < n - 50
