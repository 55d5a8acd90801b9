#!/usr/bin/env bash
# commonroad-crime 0.4.5 (CriMe) with commonroad-io 2024.3: headway and time to collision of one encounter in one straight lane, on roads to the east,
# north-east, north and west.
#
# Expected: the same values whatever the course of the road. 30 m behind a car of 10 m/s, at 20 m/s, the time to collision is 3 s.
# Seen: 3 s to the east, 3.95 s to the north-east, none (5e16 s) to the north, 1.33 s to the west. To the west a car ahead at the ego's own speed has 1 s, and
# 30 m are 40 m. The speeds are multiplied by the cosine of the lane's course on the map, the ego's also by the sign of its x component, and half a length
# is added to x and to y. A car ahead that brakes at 6 m/s2 counts as one that speeds up: no collision to the east, instead of 3.16 s.
# Why it matters: the values are right only on a road to the east, at steady speeds. On a motorway along x, one of the two directions follows 1 s behind
# everybody; in a town, the most critical encounters are missing from the roads to the north. A test on one scenario along x passes.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3.11 -m venv --without-pip venv 2>/dev/null || python3 -m venv --without-pip venv
# Only what these two measures need; what the others, and the pictures, need is left out. With all of it the values are the same.
python3 -m pip --python venv install -q --no-compile --no-deps commonroad-crime==0.4.5 commonroad-io==2024.3 commonroad-clcs==2025.2.0 \
  commonroad-vehicle-models==3.0.2 omegaconf==2.4.0 pyyaml==6.0.4 numpy==2.4.6 scipy==1.17.1 shapely==2.2.0 rtree==1.4.1 lxml==6.1.3 iso3166==3.0.0 \
  protobuf==3.20.2

cat >seen.py <<'PY'
import importlib.machinery
import math
import sys
import warnings
from types import ModuleType

LEFT_OUT = {"casadi", "commonroad_dc", "commonroad_reach", "imageio", "matplotlib", "networkx", "osqp", "PIL", "tqdm"}


class Empty(ModuleType):
    def __getattr__(self, word):
        if word.startswith("__"):
            raise AttributeError(word)
        return type(word, (Exception,), {})


class Finder:
    def find_spec(self, name, path=None, target=None):
        return importlib.machinery.ModuleSpec(name, self, is_package=True) if name.split(".")[0] in LEFT_OUT else None

    def create_module(self, spec):
        return Empty(spec.name)

    def exec_module(self, module):
        pass


sys.meta_path.insert(0, Finder())
import numpy as np
from commonroad.geometry.shape import Rectangle
from commonroad.prediction.prediction import TrajectoryPrediction
from commonroad.scenario.lanelet import Lanelet, LaneletNetwork
from commonroad.scenario.obstacle import DynamicObstacle, ObstacleType
from commonroad.scenario.scenario import Scenario
from commonroad.scenario.state import InitialState, KSState
from commonroad.scenario.trajectory import Trajectory
from commonroad_crime.data_structure.configuration import CriMeConfiguration
from commonroad_crime.measure import HW, TTC

warnings.simplefilter("ignore")
STEPS, STEP_S, LENGTH_M, GAP_M, EGO_M_S = 31, 0.1, 5.0, 30.0, 20.0


def car(number, course, s, speed, acceleration):
    ahead = np.array([math.cos(course), math.sin(course)])

    def at(step):
        t = STEP_S * step
        return {
            "time_step": step,
            "position": (s + speed * t + acceleration * t * t / 2) * ahead,
            "orientation": course,
            "velocity": speed + acceleration * t,
        }

    shape, lanes = Rectangle(LENGTH_M, 2.0), {step: {1} for step in range(STEPS)}
    states = Trajectory(1, [KSState(**at(step), steering_angle=0.0) for step in range(1, STEPS)])
    first = InitialState(**at(0), yaw_rate=0.0, slip_angle=0.0, acceleration=acceleration)
    return DynamicObstacle(
        number,
        ObstacleType.CAR,
        shape,
        first,
        TrajectoryPrediction(states, shape, center_lanelet_assignment=lanes, shape_lanelet_assignment=lanes),
        initial_center_lanelet_ids={1},
        initial_shape_lanelet_ids={1},
    )


def seen(course, lead_m_s, lead_m_s2):
    """Headway and time to collision at the first step by CriMe, the headway also from the positions."""
    ahead = np.array([math.cos(course), math.sin(course)])
    left = np.array([-ahead[1], ahead[0]])
    centre = np.linspace(-100, 400, 101)[:, None] * ahead
    scenario = Scenario(STEP_S)
    scenario.add_objects(LaneletNetwork.create_from_lanelet_list([Lanelet(centre + 1.75 * left, centre, centre - 1.75 * left, 1)]))
    ego, lead = car(10, course, 0.0, EGO_M_S, 0.0), car(20, course, GAP_M + LENGTH_M, lead_m_s, lead_m_s2)
    scenario.add_objects([ego, lead])
    gap = float((lead.initial_state.position - ego.initial_state.position) @ ahead) - LENGTH_M
    assert abs(gap - GAP_M) < 1e-9

    def measured(measure):
        configuration = CriMeConfiguration()
        configuration.vehicle.ego_id = 10
        configuration.update(sce=scenario)
        return float(measure(configuration).compute(20, 0, verbose=False))

    return measured(HW), measured(TTC)


def right(lead_m_s, lead_m_s2):
    """The time at which the gap is 0 (the car ahead still drives then)."""
    closing = EGO_M_S - lead_m_s
    if lead_m_s2:
        return (math.sqrt(closing**2 - 2 * GAP_M * lead_m_s2) - closing) / -lead_m_s2
    return GAP_M / closing if closing > 0 else math.inf


expected = {
    "10 m/s": (3.0, 3.95, math.inf, 1.33),
    "20 m/s": (math.inf, math.inf, math.inf, 1.0),
    "20 m/s, brakes at 6 m/s2": (math.inf, math.inf, math.inf, 0.93),
}
as_seen = True
for lead, row in zip(((10.0, 0.0), (20.0, 0.0), (20.0, -6.0)), expected.items()):
    title, times = row
    print(f"car ahead: {title}; time to collision {right(*lead):.2f} s, headway {GAP_M:.0f} m")
    for course, time, headway in zip((0, 45, 90, 180), times, (30.0, 27.93, 30.0, 40.0)):
        hw, ttc = seen(math.radians(course), *lead)
        print(f"    road at {course} degrees: TTC {ttc:.4g} s, HW {hw:.2f} m")
        same = ttc > 1e9 if math.isinf(time) else abs(ttc - time) < 0.02
        as_seen = as_seen and same and abs(hw - headway) < 0.02
sys.exit(0 if as_seen else "changed: the measures by the course of the road")
PY
venv/bin/python seen.py
