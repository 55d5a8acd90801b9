#!/usr/bin/env bash
# commonroad-io 2026.1: `Scenario.translate_rotate(translation, angle)`, which moves and turns a scenario with its road network and obstacles, as a map is
# brought from UTM to the origin of a recording.
#
# Expected: map, cars and what the map answers are where they have been moved to, by an exact rotation.
# Seen, without a word:
#   1. `find_lanelet_by_position` and `assign_obstacles_to_lanelets` answer for the place where the lanelets were before: moved by the width of a lane, each car
#      is in the lane beside its own; moved from UTM to the origin, it is in none. The polygons of the lanelets are right.
#   2. The occupancies of a trajectory stay behind if somebody has read one of them before (a drawing, an assignment to lanelets); at the first step, and in
#      `state_at_time`, the car has moved. The two are as far apart as the scenario was moved.
#   3. Up to 0.05 rad (2.9 degrees) the rotation is (1, -angle; angle, 1), for lanelets and trajectories; sets of occupancies and goals it turns exactly. At 0.0489 rad
#      (2.8 degrees) and 3 km from the origin the road is 3.6 m beside its place, by one lane, and longer by 0.12 %. At 2.9 degrees all of it is exact.
# Why it matters: lanes, and with them limits, overtaking and leaving the lane, are of the neighbour or of nobody, collisions are missed or found where nobody is,
# by what was called before. Between the north of UTM and true north it is such an angle, at most 2.5 degrees up to 56 N. In a file that is written and read again, 1 and
# 2 are gone.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3.11 -m venv --without-pip venv 2>/dev/null || python3 -m venv --without-pip venv
# Only what scenarios need; pictures and files are left out.
python3 -m pip --python venv install -q --no-compile --no-deps commonroad-io==2026.1 numpy==2.4.6 shapely==2.2.0 omegaconf==2.4.0 antlr4-python3-runtime==4.13.2 \
  pyyaml==6.0.4 iso3166==3.0.0

cat >seen.py <<'PY'
import math
import sys

import numpy as np
import shapely
from commonroad.geometry.obstacle_shapes.rect_obstacle_shape import RectObstacleShape
from commonroad.geometry.occupancy.rect_occupancy import RectOccupancy
from commonroad.prediction.prediction import SetBasedPrediction, TrajectoryPrediction
from commonroad.scenario.lanelet import Lanelet, LaneletNetwork
from commonroad.scenario.obstacle import DynamicObstacle, ObstacleType
from commonroad.scenario.scenario import Scenario
from commonroad.scenario.state import InitialState, KSState
from commonroad.scenario.trajectory import Trajectory

WIDTH, RIGHT, LEFT = 3.5, 1, 2
CAR = RectObstacleShape(width=2.0, length=4.5)


def road(x, y):
    """Two lanes to the north; the border between them begins at x, y."""
    scenario = Scenario(0.1)
    border = np.array([[x, y + 10.0 * k] for k in range(31)])
    for number, centre in ((RIGHT, WIDTH / 2), (LEFT, -WIDTH / 2)):
        left, right = border + [centre - WIDTH / 2, 0], border + [centre + WIDTH / 2, 0]
        scenario.add_objects(Lanelet(left_vertices=left, center_vertices=(left + right) / 2, right_vertices=right, lanelet_id=number))
    return scenario


def add_car(scenario, number, x, y, as_sets=False):
    """North at 10 m/s from x, y."""
    begin = InitialState(
        time_step=0, position=np.array([x, y]), orientation=math.pi / 2, velocity=10.0, acceleration=0.0, yaw_rate=0.0, slip_angle=0.0
    )
    if as_sets:
        way = {k: RectOccupancy(rect_center=shapely.Point(x, y + k), width=2.0, length=4.5, orientation=math.pi / 2) for k in range(1, 101)}
        prediction = SetBasedPrediction(1, way)
    else:
        states = [KSState(time_step=k, position=np.array([x, y + k]), orientation=math.pi / 2, velocity=10.0) for k in range(1, 101)]
        prediction = TrajectoryPrediction(Trajectory(1, states), CAR)
    car = DynamicObstacle(number, ObstacleType.CAR, CAR, begin, prediction)
    scenario.add_objects(car)
    return car


def of_polygons(network, position):
    return [lanelet.lanelet_id for lanelet in network.lanelets if lanelet.polygon.shapely_object.contains(shapely.Point(position))]


def found(scenario, position):
    """The lanelets at a position: by the map, by the polygons of its lanelets, and by a new map of the same lanelets."""
    network = scenario.lanelet_network
    new = LaneletNetwork.create_from_lanelet_list(network.lanelets)
    return network.find_lanelet_by_position([position])[0], of_polygons(network, position), new.find_lanelet_by_position([position])[0]


results = {}
for title, begin, move in (("by a lane", (0.0, 0.0), (-WIDTH, 0.0)), ("from UTM", (692000.0, 5338000.0), (-692000.0, -5338000.0))):
    scenario = road(*begin)
    car = add_car(scenario, 10, begin[0] + WIDTH / 2, begin[1] + 20.0)
    scenario.translate_rotate(np.array(move), 0.0)
    position = car.state_at_time(50).position
    scenario.assign_obstacles_to_lanelets(time_steps=[50], use_center_only=True)
    assigned = sorted(car.prediction.center_lanelet_assignment.get(50) or [])
    results[title] = (*found(scenario, position), assigned)
    print(f"1. moved {title}, a car in lanelet {RIGHT}: found in {results[title][0]}, assigned to {assigned}; polygons {results[title][1]}, new map {results[title][2]}")

apart = {}
for read in (False, True):
    scenario = road(0.0, 0.0)
    car = add_car(scenario, 10, WIDTH / 2, 20.0)
    if read:
        car.occupancy_at_time(1)
    scenario.translate_rotate(np.array([100.0, 0.0]), 0.0)
    for step in (0, 50):
        centre = car.occupancy_at_time(step).center
        apart[read, step] = math.dist((centre.x, centre.y), car.state_at_time(step).position)
        print(f"2. moved by 100 m, occupancies {'read' if read else 'not read'} before: at step {step} the occupancy is {apart[read, step]:.1f} m from the state")

off = {}
for degrees in (1.0, 2.0, 2.8, 2.9):
    angle = math.radians(degrees)
    scenario = road(3000.0, 0.0)
    by_states = add_car(scenario, 10, 3000.0 + WIDTH / 2, 20.0)
    by_sets = add_car(scenario, 11, 3000.0 + WIDTH / 2, 20.0, as_sets=True)
    scenario.translate_rotate(np.array([0.0, 0.0]), angle)
    x, y = 3000.0 + WIDTH / 2, 70.0
    right = np.array([x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle)])
    sets = by_sets.occupancy_at_time(50).center
    line = scenario.lanelet_network.find_lanelet_by_id(RIGHT).center_vertices
    off[degrees] = (
        shapely.LineString(line).distance(shapely.Point(right)),
        math.dist(by_states.state_at_time(50).position, right),
        math.dist((sets.x, sets.y), right),
        found(scenario, right)[2],
        float(np.linalg.norm(line[-1] - line[0])),
    )
    print("3. turned by {} degrees, 3 km from the origin: lane {:.2f} m off, trajectory {:.2f} m, sets {:.2f} m; lanelet {}, length {:.2f} m".format(degrees, *off[degrees]))
before = results["by a lane"] == ([LEFT], [RIGHT], [RIGHT], [LEFT]) and results["from UTM"] == ([], [RIGHT], [RIGHT], [])
behind = apart[True, 50] > 99 and max(apart[False, 0], apart[False, 50], apart[True, 0]) < 1e-6
linear = off[2.8][0] > 3.5 and off[2.8][1] > 3.5 and off[2.8][2] < 1e-6 and off[2.8][3] == [LEFT] and off[2.8][4] > 300.3
exact = max(off[2.9][:3]) < 1e-6 and off[2.9][3] == [RIGHT]
sys.exit(0 if before and behind and linear and exact else "changed: what a moved scenario holds")
PY
venv/bin/python seen.py
