#!/usr/bin/env bash
# commonroad-stl-monitor 2025.1.1 with commonroad-io 2024.3: the safe distance (R_G1) to a car ahead that never leaves its lane, with and without an exit
# that leaves the road 200 m before.
#
# Expected: at 20 m/s, 5 m behind a car that drives at 10 m/s, R_G1 is broken. It exempts the ego for 3 s from a car that cuts in.
# Seen: behind the exit R_G1 is kept. The robustness of `single_lane` is negative there for a car in one lane, where its own boolean is true: the lane of the
# lanelet before the fork is that of the exit. So every car that sways by 5 cm in its lane cuts in. No rule is evaluated at the last time step.
# Why it matters: the tool is the reference implementation of the German rules in temporal logic, and motorways have exits.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3.11 -m venv --without-pip venv 2>/dev/null || python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile 'setuptools<80' commonroad-io==2024.3 commonroad-clcs==2025.2.0 commonroad-drivability-checker==2025.4.0 \
  commonroad-route-planner==2025.1.0 pandas==2.3.3 ruamel.yaml typing-extensions
# What it asks for contradicts itself (two runtimes of ANTLR); torch, gpytorch and shap are for learned models, which are not used here.
python3 -m pip --python venv install -q --no-compile --no-deps commonroad-stl-monitor==2025.1.1 rtamt==0.4.10 antlr4-python3-runtime==4.9.3

cat >seen.py <<'PY'
import sys
from types import ModuleType

for name in ("", ".feature_extractor", ".feature_variables"):
    module = ModuleType("crmonitor.mpr.learning" + name)
    module.__getattr__ = lambda word: type(word, (Exception,), {})
    sys.modules[module.__name__] = module

import numpy as np
from commonroad.geometry.shape import Rectangle
from commonroad.prediction.prediction import TrajectoryPrediction
from commonroad.scenario.lanelet import Lanelet, LaneletNetwork
from commonroad.scenario.obstacle import DynamicObstacle, ObstacleType
from commonroad.scenario.scenario import Scenario
from commonroad.scenario.state import InitialState, KSState
from commonroad.scenario.trajectory import Trajectory
from crmonitor.common import World
from crmonitor.evaluation import OfflineRuleEvaluator
from crmonitor.predicates.predicate_registry import PredicateRegistry

STEPS = 11


def car(number, x, y, yaw, speed):
    def at(step):
        return {"time_step": step, "position": np.array([x + 0.1 * step * speed, y]), "orientation": yaw, "velocity": speed}

    initial = InitialState(**at(0), acceleration=0.0, yaw_rate=0.0, slip_angle=0.0)
    shape = Rectangle(length=4.5, width=1.8)
    states = [KSState(**at(step), steering_angle=0.0) for step in range(1, STEPS)]
    return DynamicObstacle(number, ObstacleType.CAR, shape, initial, TrajectoryPrediction(Trajectory(1, states), shape))


def lane(number, x, y, **links):
    left, middle, right = (np.column_stack([x, y + across]) for across in (1.75, 0.0, -1.75))
    return Lanelet(left, middle, right, number, **links)


def judged(has_exit):
    """Both cars are on lanelet 3 all the time: the ego in its middle, the other 5 cm to the left, heading a milliradian to the right."""
    before, behind = np.linspace(0.0, 100.0, 21), np.linspace(100.0, 600.0, 101)
    lanelets = [lane(3, behind, 0.0 * behind, predecessor=[1])]
    if has_exit:
        lanelets += [lane(2, behind, -0.03 * (behind - 100.0), predecessor=[1])]
    lanelets += [lane(1, before, 0.0 * before, successor=[2, 3] if has_exit else [3])]
    scenario = Scenario(0.1)
    scenario.add_objects(LaneletNetwork.create_from_lanelet_list(lanelets))
    scenario.add_objects([car(10, 300.0, 0.0, 0.0, 20.0), car(11, 309.5, 0.05, -0.001, 10.0)])
    scenario.assign_obstacles_to_lanelets()
    world = World.create_from_scenario(scenario)
    values = OfflineRuleEvaluator.create_for_rule("R_G1", dt=world.dt).evaluate(world, 10)
    single = PredicateRegistry.get_registry().get_predicate_evaluator("single_lane")()
    return values, single.evaluate_boolean(world, 2, (11,)), single.evaluate_robustness(world, 2, (11,))


seen = {has_exit: judged(has_exit) for has_exit in (False, True)}
for has_exit, (values, boolean, robustness) in seen.items():
    print(
        f"{'with' if has_exit else 'without'} the exit: R_G1 {values[0]:.4f} ({'kept' if values[0] >= 0 else 'broken'}), single_lane"
        f" {boolean} and {robustness:.4f}; values for {len(values)} of {STEPS} steps"
    )
(plain, _, near), (forked, boolean, negative) = seen[False], seen[True]
sys.exit(0 if plain[0] < 0 <= forked[0] and near > 0 > negative and boolean and len(plain) == STEPS - 1 else 1)
PY
status=0
venv/bin/python seen.py >seen.txt 2>errors.txt || status=$?
grep -v '^ANTLR runtime' seen.txt || tail -n 3 errors.txt
exit "$status"
