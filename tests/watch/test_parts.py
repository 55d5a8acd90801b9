"""Commands at alarms, programs that are halted, margins that shrink."""

from __future__ import annotations

import sys
import time
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pyarrow as pa
import pytest

from drivelint import catalogue
from drivelint.engine.judging_options import JudgingOptions
from drivelint.errors import UsageError
from drivelint.run import CheckOptions
from drivelint.watch import triggers
from drivelint.watch.halting import ChildProgram
from drivelint.watch.interruption import InterruptionOfWatchOrCheck
from drivelint.watch.judge import JudgedWindow
from drivelint.watch.options import WatchOptions
from drivelint.watch.shrinking import ShrinkingMargins
from drivelint.watch.window import NS_PER_S

if TYPE_CHECKING:
    from collections.abc import Sequence

OTHER_THAN_BY_DEFAULT: dict[type, Any] = {str: "x", float: 7.5, int: 7, tuple: ("x",), type(None): "x"}
CATALOGUE = catalogue.load_rules(())
RULE = "ukhc.r126.two-second"
PYTHON = sys.executable
LIMITS = "it starts at most once in 1 s, and 4 run at a time"


def wait_for(file: Path) -> None:
    for _ in range(200):
        if file.exists():
            return
        time.sleep(0.05)
    raise AssertionError(f"{file} never came")


def is_running(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").split(")")[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


def test_a_child_that_does_not_want_to_end_is_killed_with_all_that_it_started(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("drivelint.watch.halting.GRACE_BEFORE_KILL_S", 0.5)
    script = tmp_path / "stubborn.py"
    script.write_text(
        "import os, signal, sys, time\n"
        "signal.signal(signal.SIGTERM, signal.SIG_IGN)\n"
        "child = os.fork()\n"
        "if child:\n"
        f"    open({str(tmp_path / 'pids')!r} + '.new', 'w').write(f'{{os.getpid()}} {{child}}')\n"
        f"    os.rename({str(tmp_path / 'pids')!r} + '.new', {str(tmp_path / 'pids')!r})\n"
        "time.sleep(60)\n",
        encoding="utf-8",
    )
    child = ChildProgram([PYTHON, str(script)])
    wait_for(tmp_path / "pids")
    assert child.exit_code is None
    child.end()
    assert child.exit_code == -9
    pids = [int(pid) for pid in (tmp_path / "pids").read_text(encoding="utf-8").split()]
    for _ in range(100):
        if not any(map(is_running, pids)):
            break
        time.sleep(0.05)
    assert [pid for pid in pids if is_running(pid)] == []


def test_a_child_that_ends_by_itself_is_asked_only() -> None:
    child = ChildProgram([PYTHON, "-c", "import time; time.sleep(60)"])
    child.end()
    assert child.exit_code == -15


def test_a_program_that_is_not_there() -> None:
    with pytest.raises(UsageError, match="no-such-program: cannot be started"):
        ChildProgram(["no-such-program"])


def test_a_command_runs_at_most_once_a_second(tmp_path: Path) -> None:
    (trigger,) = triggers.parse([f"{RULE}={PYTHON} -c pass"], CATALOGUE, CATALOGUE)
    for _ in range(5):
        assert trigger.run_for_alarms_and_return_note([{"rule_id": RULE}]) is None
    assert trigger.run_for_alarms_and_return_note([{"rule_id": "another"}]) is None
    assert (trigger.n_run, trigger.n_left_out) == (1, 4)
    trigger.wait_for_running_commands()


def test_alarms_that_a_command_did_not_get_are_counted_when_it_starts_again_and_at_the_end() -> None:
    (trigger,) = triggers.parse([f"{RULE}={PYTHON} -c pass"], CATALOGUE, CATALOGUE)
    told = [trigger.run_for_alarms_and_return_note([{"rule_id": RULE}] * 2) for _ in range(3)]
    trigger._last_s -= triggers.LEAST_PAUSE_BETWEEN_STARTS_S
    told += [trigger.run_for_alarms_and_return_note([{"rule_id": RULE}]), trigger.note_on_left_out_alarms()]
    assert told == [None, None, None, f"--on: {PYTHON} was not started for 4 alarms: {LIMITS}", None]
    trigger.run_for_alarms_and_return_note([{"rule_id": RULE}])
    assert trigger.note_on_left_out_alarms() == f"--on: {PYTHON} was not started for 1 alarm: {LIMITS}"
    trigger.wait_for_running_commands()


def test_a_command_gets_no_shell(tmp_path: Path) -> None:
    (trigger,) = triggers.parse([f"{RULE}=echo > {tmp_path}/b"], CATALOGUE, CATALOGUE)
    assert trigger.run_for_alarms_and_return_note([{"rule_id": RULE}]) is None
    trigger.wait_for_running_commands()
    assert not (tmp_path / "b").exists()


def test_a_command_that_is_not_there_is_told() -> None:
    (trigger,) = triggers.parse([f"{RULE}=no-such-program"], CATALOGUE, CATALOGUE)
    assert "no-such-program: cannot be started" in (trigger.run_for_alarms_and_return_note([{"rule_id": RULE}]) or "")


@pytest.mark.parametrize("text", ["true", "=true", f"{RULE}=", f"{RULE}='"])
def test_a_trigger_that_cannot_be_read(text: str) -> None:
    with pytest.raises(UsageError, match="--on"):
        triggers.parse([text], CATALOGUE, CATALOGUE)


def near(margins: Sequence[float], *, end_s: float = 10.0) -> JudgedWindow:
    """Return a window at whose end a rule has these margins, one every 0.1 s."""
    times = [round((end_s - 0.1 * k) * NS_PER_S) for k in reversed(range(len(margins)))]
    row: dict[str, Any] = {
        "finding_id": None,
        "rule_id": RULE,
        "ego_id": "1",
        "profile": None,
        "object_id": "2",
        "t_ns": times,
        "margin": margins,
    }
    kinds = pa.schema([
        ("finding_id", pa.string()), ("rule_id", pa.string()), ("ego_id", pa.string()), ("profile", pa.string()),
        ("object_id", pa.string()),
        ("t_ns", pa.list_(pa.int64())), ("margin", pa.list_(pa.float64())),
    ])  # fmt: skip
    return JudgedWindow(
        0, round(10.0 * NS_PER_S), pa.table({}), pa.table({}), pa.Table.from_pylist([row], schema=kinds)
    )


def test_a_margin_that_shrinks_is_told_once_with_the_time_that_is_left() -> None:
    edge = CATALOGUE[RULE].near_margin
    assert edge is not None
    shrinking, falling = ShrinkingMargins(), [edge * share for share in (0.9, 0.8, 0.7, 0.6, 0.5)]
    (message,) = shrinking.new_messages(near(falling), CATALOGUE, 0)
    assert message["shrinks_per_s"] == pytest.approx(edge)
    assert message["to_violation_s"] == pytest.approx(0.5)
    assert (message["t_s"], message["object_id"]) == (10.0, "2")
    assert shrinking.new_messages(near(falling), CATALOGUE, 0) == []
    assert shrinking.new_messages(near([edge * 2] * 5), CATALOGUE, 0) == []
    assert len(shrinking.new_messages(near(falling), CATALOGUE, 0)) == 1


def test_a_margin_that_grows_or_was_small_before_is_not_told() -> None:
    edge = CATALOGUE[RULE].near_margin or 0.0
    for window in (
        near([edge * 0.5, edge * 0.6, edge * 0.7]),
        near([edge * 0.6, edge * 0.5], end_s=8.0),
        near([-1.0, -2.0]),
    ):
        assert ShrinkingMargins().new_messages(window, CATALOGUE, 0) == []


def test_the_check_at_the_end_judges_by_all_options_of_the_watch() -> None:
    """Whatever option both have and somebody adds: `check` gets what `watch` got."""
    shared: dict[str, Any] = {
        each.name: not each.default if isinstance(each.default, bool) else OTHER_THAN_BY_DEFAULT[type(each.default)]
        for each in fields(JudgingOptions)
    }
    checked = CheckOptions.from_judging_options(("log",), WatchOptions(source="log", **shared), Path("out"))
    assert {name: getattr(checked, name) for name in shared} == shared
    assert (checked.traces, checked.out) == (("log",), Path("out"))
    both = {each.name for each in fields(WatchOptions)} & {each.name for each in fields(CheckOptions)}
    assert both - shared.keys() == {"out"}  # the folder of the check is another


def test_what_goes_on_when_it_is_first_asked_for_is_interrupted_alone() -> None:
    watched, checked = InterruptionOfWatchOrCheck(), InterruptionOfWatchOrCheck()
    watched.request()
    for each in (watched, checked):
        each.switch_to_check()
        each.request()
    assert (watched.of_watch.requested, watched.of_check.requested) == (True, False)  # what was recorded is checked
    assert (checked.of_watch.requested, checked.of_check.requested) == (False, True)
