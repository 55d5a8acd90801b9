"""Run by the peer's Python, which has no drivelint: `stvo_peer.py SCENARIO KIND OUT`, one scenario into one JSON file.

KIND is the peer's kind of scenario: `interstate` (R_G and R_I) or `intersection` (R_IN); `limited` is interstate with the rules of speed.

The file has `robustness` by rule and vehicle (per time step; the peer does not evaluate the last one), `errors` by rule and vehicle,
and `steps` by vehicle: what the peer itself sees of the vehicle and of those near it, so that a difference can be traced to numbers.
"""

from __future__ import annotations

import json
import math
import sys
from importlib import import_module, metadata
from pathlib import Path
from types import ModuleType
from typing import Any

RULES = {
    "interstate": ("R_G1", "R_G2", "R_G3", "R_G4", "R_I1", "R_I3", "R_I4", "R_I5", "R_I2"),
    "limited": ("R_G3", "R_G4"),
    "intersection": ("R_IN1",),
}
NEAR_M = 200.0


class _NoLearning(ModuleType):
    """Stands for the peer's learned models, which need torch, gpytorch and shap and are not used here."""

    def __getattr__(self, name: str) -> type:
        if name.startswith("__"):
            raise AttributeError(name)
        return type(name, (Exception,), {})


for _name in ("", ".feature_extractor", ".feature_variables"):
    sys.modules[f"crmonitor.mpr.learning{_name}"] = _NoLearning("crmonitor.mpr.learning" + _name)


def _remember_predicates() -> None:
    """Let the peer compute a predicate of the same vehicles and step once: its nested quantifiers ask for each many times."""
    interface = import_module("crmonitor.evaluation.predicate_interface").SinglePredicateEvaluationInterface
    plain = interface.evaluate_robustness
    known: dict[tuple[str, int, tuple[int, ...]], Any] = {}

    def remembered(self: Any, world: Any, time_step: int, vehicle_ids: tuple[int, ...]) -> Any:
        key = (self.predicate_name, time_step, tuple(vehicle_ids))
        if key not in known:
            known[key] = plain(self, world, time_step, vehicle_ids)
        return known[key]

    interface.evaluate_robustness = remembered


def _number(value: Any) -> float | None:
    return None if value is None or not math.isfinite(value) else round(float(value), 6)


def _other_vehicles(world: Any, ego: Any, step: int) -> list[dict[str, Any]]:
    """Return the vehicles near the ego at a step, in the ego's lane as the peer sees it; `gap_m` is from bumper to bumper."""
    lane = ego.lane_at_time_step(step)
    seen = []
    for other in sorted(world.vehicles, key=lambda vehicle: vehicle.id):
        if other is ego or not other.is_valid(step):
            continue
        try:
            gap = other.rear_s(step, lane) - ego.front_s(step, lane)
            state = other.get_lon_state(step, lane)
            d_m = other.get_lat_state(step, lane).d
        except Exception:  # noqa: BLE001, S112 - beyond the peer's coordinates of this lane
            continue
        if abs(gap) <= NEAR_M:
            same = bool(ego.lane_ids_at_time_step(step) & other.lane_ids_at_time_step(step))
            seen.append(
                {
                    "id": str(other.id),
                    "gap_m": _number(gap),
                    "same_lane": same,
                    "d_m": _number(d_m),
                    "v_mps": _number(state.v),
                    "a_mps2": _number(state.a),
                    "length_m": _number(other.shape.length),
                    "behind_m": _number(ego.rear_s(step, lane) - other.front_s(step, lane)),
                }
            )
    return seen


def _steps(world: Any, ego: Any) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = []
    for step in range(ego.start_time, ego.end_time + 1):
        try:
            state = ego.get_lon_state(step)
            rows.append(
                {
                    "step": step,
                    "v_mps": _number(state.v),
                    "a_mps2": _number(state.a),
                    "d_m": _number(ego.get_lat_state(step).d),
                    "length_m": _number(ego.shape.length),
                    "lanes": len(ego.lanelet_ids_at_time_step(step)),
                    "others": _other_vehicles(world, ego, step),
                }
            )
        except Exception as problem:  # noqa: BLE001 - said in the file
            rows.append({"step": step, "error": f"{type(problem).__name__}: {problem}"[:120]})
    return rows


def main(scenario_file: str, kind: str, out: str) -> None:
    """Evaluate every rule for every vehicle of a scenario."""
    _remember_predicates()
    scenario, _ = (
        import_module("commonroad.common.file_reader").CommonRoadFileReader(scenario_file).open(lanelet_assignment=True)
    )
    types = import_module("crmonitor.common.scenario_type").ScenarioType
    worlds = import_module("crmonitor.common.world")
    config = worlds.WorldConfig(scenario_type=types.INTERSECTION if kind == "intersection" else types.INTERSTATE)
    world = worlds.World.create_from_scenario(scenario, config)
    evaluators = import_module("crmonitor.evaluation").OfflineRuleEvaluator
    told: dict[str, Any] = {
        "version": metadata.version("commonroad-stl-monitor"),
        "dt_s": scenario.dt,
        "steps": {str(vehicle.id): _steps(world, vehicle) for vehicle in world.vehicles},
        "first_step": {str(vehicle.id): vehicle.start_time for vehicle in world.vehicles},
        "robustness": {},
        "errors": {},
    }
    for rule in RULES[kind]:
        told["robustness"][rule], told["errors"][rule] = {}, {}
        # One evaluator for all: it is stateless, and parses a monitor for each vehicle once. Parsing takes most of the time.
        evaluator = evaluators.create_for_rule(rule, dt=world.dt)
        for vehicle in sorted(world.vehicle_ids()):
            try:
                values = evaluator.evaluate(world, vehicle)
                told["robustness"][rule][str(vehicle)] = [_number(value) for value in values]
            except Exception as problem:  # noqa: BLE001 - the peer's own failure is a result
                told["errors"][rule][str(vehicle)] = f"{type(problem).__name__}: {problem}"[:120]
    Path(out).write_text(json.dumps(told, sort_keys=True) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:4])
