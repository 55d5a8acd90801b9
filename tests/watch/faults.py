"""Faults planted into small SUMO scenarios: a parameter of one driver makes a rule fail; with SUMO's own driver it is kept.

A scenario lies on the two-way road of `tests.sumo.world` or on the crossroads of `tests.sumo.crossroads`. Its ego is the vehicle "ego".
Source of the parameters: SUMO's documentation of "Definition of Vehicles, Vehicle Types, and Routes".
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

from tests.sumo import crossroads, world

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

STEP_S = 0.1
SIZE = 'length="4.6" width="1.8"'
EXACT = f'{SIZE} speedFactor="1" speedDev="0"'
"""SUMO's default driver, whose wish is the speed limit and no other speed."""
LORRY = 'length="9.5" width="2.4" maxSpeed="10"'
_IGNORES = 'jmIgnoreFoeProb="1" jmIgnoreFoeSpeed="100" jmIgnoreJunctionFoeProb="1"'
_RUNS_RED = 'jmDriveAfterRedTime="1000" jmDriveRedSpeed="20"'
_OPTIONS = {
    "step-length": STEP_S,
    "time-to-teleport": -1,
    "collision.action": "warn",
    "collision.mingap-factor": 0,
    "collision.check-junctions": "true",
    "lanechange.duration": 3,
}
_PLACES = {"road": (world.NET, world.MAP), "crossroads": ("c.net.xml", "c.xodr")}


class Car(NamedTuple):
    """A vehicle: its name, the second in which it departs, the edges that it drives along, and its vType."""

    name: str
    depart: float
    route: str
    type: str = "other"
    more: str = 'departSpeed="max"'
    stop: str = ""


class Fault(NamedTuple):
    """`faulty`: what the vType of the faulty driver is told; `sound`: the same for a driver without the fault.

    `rule`: the rule that breaks, `severity`: its severity. `at_once`: the first failing step is enough to know it; else the rule waits for
    what comes after. `others_type`: what the vType of everybody else is told.
    """

    name: str
    place: Literal["road", "crossroads"]
    rule: str
    severity: Literal["critical", "major"]
    faulty: str
    cars: tuple[Car, ...]
    end_s: int
    sound: str = EXACT
    others_type: str = EXACT
    at_once: bool = True


FAULTS = (
    Fault(
        "red-light", "crossroads", "ukhc.r175.red", "critical", f"{EXACT} {_RUNS_RED}",
        (Car("ego", 0, "win eout", "driver", 'departSpeed="max" departPos="110"'),), 20,
    ),
    Fault(
        "speeding", "road", "ukhc.r124.speed-limit", "major", f'{SIZE} speedFactor="1.25" speedDev="0"',
        (Car("ego", 0, "ab", "driver", 'departSpeed="20"'),), 15,
    ),
    Fault(
        "too-close", "road", "ukhc.r126.thinking-gap", "critical", f'{EXACT} tau="0.1" minGap="0.5" lcOpposite="0"',
        (Car("lead", 0, "ab"), Car("ego", 6, "ab", "driver")), 25,
        sound=f'{EXACT} lcOpposite="0"', others_type=f'{SIZE} maxSpeed="15"',
    ),
    Fault(
        "rear-end", "road", "ukhc.no-collision", "critical",
        f'{SIZE} maxSpeed="18" actionStepLength="3" tau="0.1" minGap="0.5" lcOpposite="0"',
        (
            Car("lead", 0, "ab", stop='<stop lane="ab_0" endPos="250" duration="30"/>'),
            Car("ego", 2, "ab", "driver"),
        ), 30,
        sound=f'{SIZE} maxSpeed="18" lcOpposite="0"', others_type=f'{SIZE} maxSpeed="18" decel="9" emergencyDecel="9"',
    ),
    Fault(
        "turn-across", "crossroads", "ukhc.r180.right-turn-gap", "critical", f"{EXACT} {_IGNORES}",
        (
            Car("ego", 0, "sin wout", "driver", 'departSpeed="max" departLane="best"'),
            *(Car(f"oncoming-{n}", n, "nin sout", more='departSpeed="max" departLane="0"') for n in range(0, 12, 2)),
        ), 25, at_once=False,
    ),
    Fault(
        "hit-at-junction", "crossroads", "ukhc.no-collision", "critical", f"{EXACT} {_RUNS_RED} {_IGNORES}",
        (
            Car("other", 2.7, "win eout", "driver", 'departSpeed="max" departLane="0"'),
            Car("ego", 3, "sin nout", more='departSpeed="max" departLane="0"'),
        ), 22,
    ),
    Fault(
        "head-on", "road", "ukhc.r162.safe-distance-ahead", "critical",
        f'{EXACT} maxSpeed="16" lcOpposite="20" lcAssertive="3"',
        (
            Car("lorry", 0, "ab", "lorry", 'departSpeed="max" departPos="70"'),
            Car("ego", 0, "ab", "driver", 'departSpeed="15" departPos="30"'),
            Car("oncoming", 0, "ba", more='departSpeed="max" departPos="3600"'),
        ), 20, at_once=False,  # a driver who speeds up may have enough room
        sound=f'{EXACT} maxSpeed="16" lcOpposite="0"',
    ),
)  # fmt: skip


class Scenario(NamedTuple):
    """Where a scenario lies."""

    config: Path
    routes: Path
    map: Path


def build(folder: Path) -> None:
    """Make the road and the crossroads."""
    world.simulate(folder / "road", seconds=1, kinds=world.ORDINARY)
    crossroads.simulate(folder / "crossroads", seconds=1)


def write(folder: Path, fault: Fault, driver: str) -> Scenario:
    """Write a fault's scenario with a driver, in a place that `build` made."""
    name = f"{fault.name}-{'faulty' if driver == fault.faulty else 'sound'}"
    types = {"driver": driver, "other": fault.others_type, "lorry": LORRY}
    told = (f'<vType id="{kind}" {said}/>' for kind, said in types.items())
    return scenario(folder / fault.place, name, [*told, *map(_vehicle, fault.cars)], fault.end_s)


def ordinary(folder: Path, end_s: int, *, overtakes: bool) -> Scenario:
    """Write SUMO's default drivers on the road that `build` made: traffic both ways, and a lorry that the ego comes up to and overtakes."""
    kinds = "".join(f'<vType id="{kind}" {said}/>' for kind, (said, _) in world.ORDINARY.items())
    cars = [
        *([Car("lorry", 0, "ab", "lorry", 'departSpeed="max" departPos="150"')] if overtakes else []),
        Car("ego", 0, "ab", "car"),
        *(
            Car(f"oncoming-{n}", n, "ba", "car", f'departSpeed="max" departPos="{2400 if n == 0 else 0}"')
            for n in range(0, end_s, 15)
        ),
        *(Car(f"behind-{n}", n, "ab", "car") for n in range(8, end_s, 12)),
    ]
    cars.sort(key=lambda car: car.depart)
    return scenario(folder / "road", f"ordinary-{overtakes}", [kinds, *map(_vehicle, cars)], end_s)


def scenario(place: Path, name: str, traffic: Sequence[str], end_s: int) -> Scenario:
    """Write a configuration with this traffic."""
    net, road = _PLACES[place.name]
    config, routes = place / f"{name}.sumocfg", place / f"{name}.rou.xml"
    routes.write_text(f"<routes>{''.join(traffic)}</routes>", "utf-8")
    options = {"net-file": net, "route-files": routes.name, "end": end_s, **_OPTIONS}
    said = "".join(f'<{key} value="{value}"/>' for key, value in options.items())
    config.write_text(f"<configuration>{said}</configuration>", "utf-8")
    return Scenario(config, routes, place / road)


def simulate(scenario_files: Scenario) -> Path:
    """Let SUMO alone simulate a scenario; return its floating car data."""
    name = scenario_files.config.stem
    more = scenario_files.config.with_name(f"{name}.add.xml")
    lights = f'<timedEvent type="SaveTLSStates" source="c" dest="{name}.tls.xml"/>'
    more.write_text(
        f"<additional>{lights if scenario_files.config.parent.name == 'crossroads' else ''}</additional>", "utf-8"
    )
    log = scenario_files.config.with_name(f"{name}.fcd.xml")
    world.run(
        "sumo", "-c", str(scenario_files.config), "-a", str(more), "--fcd-output", str(log), "--fcd-output.signals",
        "--fcd-output.acceleration", "--precision", "4", "--no-step-log", cwd=scenario_files.config.parent,
    )  # fmt: skip
    return log


def _vehicle(car: Car) -> str:
    way = f'<route edges="{car.route}"/>{car.stop}'
    return f'<vehicle id="{car.name}" type="{car.type}" depart="{car.depart}" {car.more}>{way}</vehicle>'
