"""Live on SUMO with planted faults: each halts the simulation at the step that `check` finds; drivers without a fault are not halted."""

from __future__ import annotations

import importlib.util
from typing import TYPE_CHECKING, Any, NamedTuple

import pytest

from drivelint import run
from drivelint.drive.time_span import cut_trace
from drivelint.drive.trace import IngestOptions
from drivelint.engine.interruption import Interruption
from drivelint.formats import read_trace
from drivelint.report.progress import Silent
from drivelint.watch.ending import check_recording
from drivelint.watch.judge import JudgedWindow, WindowJudge
from drivelint.watch.options import WatchOptions
from drivelint.watch.run import Watch
from drivelint.watch.sources import sumo
from drivelint.watch.window import NS_PER_S
from tests.sumo import world
from tests.watch import faults
from tests.watch.prefixes import finding_keys, watch
from tests.watch.sumo_processes import processes

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.result.model import Result
    from drivelint.result.text import Row
    from drivelint.watch.alarms import Alarm
    from tests.watch.faults import Fault, Scenario

pytestmark = pytest.mark.skipif(
    world.tool("sumo") is None or world.tool("netconvert") is None or importlib.util.find_spec("traci") is None,
    reason="SUMO or traci is not installed (pip install 'drivelint[sumo]')",
)
EVERY_S = 1.0
QUICK = "red-light"
HOUR_S, HOUR_SHARE = 3600, 0.2
"""A fifth of the vehicles that `world.ORDINARY` has: 4 minutes on two cores; with all of them it would take a quarter of an hour."""
SOUND_EVERY_S = 2.5
ORDINARY_S = 60


@pytest.fixture(scope="module")
def places(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("places")
    faults.build(folder)
    return folder


class Live(NamedTuple):
    """What came of a watch: what was said, the alarms, the one that halted, the last step that was recorded, and its check."""

    messages: list[dict[str, Any]]
    alarms: list[Alarm]
    halted: Alarm | None
    last_ns: int
    result: Result

    def of_type(self, kind: str) -> list[dict[str, Any]]:
        return [each for each in self.messages if each["type"] == kind]


def live(scenario: Scenario, folder: Path, *rules: str, halt_on: str, every_s: float = EVERY_S) -> Live:
    """Watch a scenario while SUMO simulates it."""
    options = WatchOptions(
        source=str(scenario.config), map=scenario.map, ego="ego", rules=rules, halt_on=halt_on, every_s=every_s,
        robustness=False,
    )  # fmt: skip
    messages: list[dict[str, Any]] = []
    interruption = Interruption()
    source = sumo.open(options.source, folder, span_s=every_s)
    try:
        with Watch(options, source, messages.append, interruption) as watching:
            halted = watching.watch().halted
            assert halted is None or not processes(str(scenario.config))
            source.close()
            result = check_recording(
                options, source.recording, None, watching, folder=folder, progress=Silent(), interruption=interruption
            )
            watching.alarms.assign_findings_and_return_unassigned(result.findings.to_pylist(), result.verdicts)
    finally:
        source.close()
    times = read_trace(source.recording, IngestOptions(ego="ego")).tables["actor_state"]["t_ns"].to_numpy()
    return Live(messages, watching.alarms.alarms, halted, int(times.max()), result)


def finding(log: Path, scenario: Scenario, rule: str) -> Row:
    """Return the first finding of `check` in the log that SUMO alone writes."""
    asked = run.CheckOptions(
        traces=(str(log),), map=scenario.map, ego="ego", rules=(rule,), mapping=str(scenario.routes), robustness=False
    )
    return min(run.check(asked, Silent()).findings.to_pylist(), key=lambda row: int(row["t_start_ns"]))


def known_ns(log: Path, scenario: Scenario, rule: str, from_ns: int, until_ns: int) -> int:
    """Return the first step with which the log is long enough to have a finding of a rule."""
    trace = read_trace(log, IngestOptions(ego="ego", mapping=str(scenario.routes)))
    ends = range(from_ns, until_ns + 1, round(faults.STEP_S * NS_PER_S))
    with WindowJudge(WatchOptions(source=str(log), map=scenario.map, ego="ego", rules=(rule,))) as judge:
        judged = judge.judge([cut_trace(trace, 0, end) for end in ends])
    return next(w.t_end_ns for w in judged if isinstance(w, JudgedWindow) and w.findings.num_rows)


@pytest.mark.parametrize(
    "fault", [pytest.param(f, id=f.name, marks=[] if f.name == QUICK else pytest.mark.slow) for f in faults.FAULTS]
)
def test_a_fault_halts_the_simulation(fault: Fault, places: Path, tmp_path: Path) -> None:
    scenario = faults.write(places, fault, fault.faulty)
    log = faults.simulate(scenario)
    row = finding(log, scenario, fault.rule)
    assert row["severity"] == fault.severity

    came = live(scenario, tmp_path, fault.rule, halt_on=fault.severity)
    assert came.halted is not None
    same = ("rule_id", "severity", "object_id", "t_start_ns")
    assert [came.halted.row[name] for name in same] == [row[name] for name in same]
    since_ns = (
        row["t_start_ns"]
        if fault.at_once
        else known_ns(log, scenario, fault.rule, row["t_start_ns"], came.halted.said_ns)
    )
    assert 0 <= came.halted.said_ns - since_ns <= EVERY_S * NS_PER_S

    (halt,) = came.of_type("halt")
    assert halt["t_ns"] == came.halted.said_ns == came.last_ns  # SUMO went no further
    (note,) = (text for text in came.result.notes if text.startswith("halted at"))
    assert f"by an alarm of {fault.rule} at" in note
    assert came.halted.finding_ids


@pytest.mark.slow
@pytest.mark.parametrize("fault", [pytest.param(f, id=f.name) for f in faults.FAULTS])
def test_the_same_scenario_without_the_fault_is_not_halted(fault: Fault, places: Path, tmp_path: Path) -> None:
    came = live(
        faults.write(places, fault, fault.sound), tmp_path, fault.rule, halt_on=fault.severity, every_s=SOUND_EVERY_S
    )
    assert came.halted is None
    assert came.alarms == []
    assert came.last_ns > 10 * NS_PER_S


@pytest.mark.slow
@pytest.mark.parametrize("overtakes", [False, True])
def test_ordinary_traffic_is_not_halted(places: Path, tmp_path: Path, *, overtakes: bool) -> None:
    """All stable rules of ukhc, SUMO's default drivers with their own speeds, a minute live."""
    scenario = faults.ordinary(places, ORDINARY_S, overtakes=overtakes)
    came = live(scenario, tmp_path, halt_on="critical")
    assert came.halted is None
    assert came.last_ns == ORDINARY_S * NS_PER_S - round(faults.STEP_S * NS_PER_S)
    assert {row["verdict"] for row in came.result.verdicts.to_pylist()} >= {"pass"}
    law = [alarm for alarm in came.alarms if alarm.withdrawn_ns is None and not alarm.finding_ids]
    assert finding_keys([alarm.row for alarm in law]) == []


@pytest.mark.slow
def test_an_hour_of_ordinary_traffic_has_no_alarm_that_check_does_not_find(tmp_path: Path) -> None:
    """Every vehicle is an ego. What SUMO's drivers do wrong by themselves is alarmed, too, and is a finding of `check`."""
    kinds = {name: (said, rate * HOUR_SHARE) for name, (said, rate) in world.ORDINARY.items()}
    files = world.simulate(tmp_path, seconds=HOUR_S, kinds=kinds)
    options = WatchOptions(
        source=files.log.name, map=files.map, ego="all", mapping=str(files.routes), window_s=15.0, every_s=5.0,
        robustness=False,
    )  # fmt: skip
    watched = watch(options, tmp_path, at_once=180)
    assert [each for each in watched.windows if isinstance(each, Exception)] == []
    assert len(watched.windows) >= HOUR_S / options.every_s - 5
    assert (finding_keys([alarm.row for alarm in watched.false]), finding_keys(watched.missed)) == ([], [])
    # an alarm that is withdrawn later would have halted all the same
    assert [alarm.number for alarm in watched.withdrawn if alarm.row["severity"] == "critical"] == []
