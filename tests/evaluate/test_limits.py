"""A rule that takes time or memory without end is an error within twice its limit, and nothing else changes."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from threading import Event, Thread, get_native_id
from time import process_time, sleep, thread_time
from typing import TYPE_CHECKING, cast

import duckdb
import pyarrow.parquet as pq
import pytest

from drivelint import computing
from drivelint.errors import ExitCode
from drivelint.evaluate import limits
from drivelint.report.progress import Silent
from drivelint.result.model import exit_status
from drivelint.run import CheckOptions, check
from tests.evaluate.bombs import BOMBS, write_pack
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    import pyarrow as pa

OVERTAKE = ROOT / "fixtures" / "overtake"
SHIPPED = "ukhc.r162.safe-distance-ahead"


def options(pack: Path, *traces: str, seconds: float = 0.5) -> CheckOptions:
    return CheckOptions(
        traces=tuple(str(OVERTAKE / f"{name}.csv") for name in traces),
        map=OVERTAKE / "road.xodr",
        mapping=str(OVERTAKE / "mapping.toml"),
        rules=("bomb", SHIPPED),
        rules_dirs=(pack,),
        rule_timeout=seconds,
        robustness=False,
    )


def harmless_rows(verdicts: pa.Table) -> list[dict[str, object]]:
    """Return the rows of the rules that are no bombs."""
    return [row for row in verdicts.to_pylist() if row["rule_id"] in {"bomb.harmless", SHIPPED}]


def reasons(verdicts: pa.Table) -> dict[tuple[str, str], tuple[str, str, str]]:
    rows = [row for row in verdicts.to_pylist() if row["rule_id"] not in {"bomb.harmless", SHIPPED}]
    return {
        (row["rule_id"].partition(".")[2], row["drive_id"].partition("-")[0]): (
            row["verdict"],
            row["reason_code"],
            row["reason"],
        )
        for row in rows
    }


@pytest.mark.ci
def test_a_rule_without_end_is_an_error_and_the_others_are_as_without_it(tmp_path: Path) -> None:
    names = ("cross_join", "rows", "long_code", "long_reason")
    found = check(options(write_pack(tmp_path / "bad", names[:3]), "safe", seconds=1.0), Silent()).verdicts
    alone = check(options(write_pack(tmp_path / "good", ()), "safe"), Silent()).verdicts
    assert harmless_rows(found) == harmless_rows(alone)
    late = "took more than 1.0 s of computing: make its SQL cheaper, or allow it more time with --rule-timeout"
    long = "Invalid Input Error: it returned a text of more than 10,000 bytes"
    assert reasons(found) == {
        ("cross_join", "safe"): ("error", "rule_timeout", f"rule bomb.cross_join: {late}"),
        ("rows", "safe"): ("error", "rule_timeout", f"rule bomb.rows: {late}"),
        ("long_code", "safe"): ("error", "rule_error", f"rule bomb.long_code: {long}"),
    }


@pytest.mark.slow
def test_a_rule_loses_its_turn_after_three_times(tmp_path: Path) -> None:
    """Once for the batch, then for two of its drives alone: the time that a bomb takes does not grow with the drives."""
    drives = ("collision", "near_miss", "safe")
    found = check(options(write_pack(tmp_path / "bad", ("rows",)), *drives, seconds=2.0), Silent()).verdicts
    alone = check(options(write_pack(tmp_path / "good", ()), *drives), Silent()).verdicts
    assert harmless_rows(found) == harmless_rows(alone)
    tried = [("earlier in this run" not in reason) for _, _, reason in reasons(found).values()]
    assert tried == [True, True, False]
    assert {(verdict, code) for verdict, code, _ in reasons(found).values()} == {("error", "rule_timeout")}


def drivelint(*args: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "drivelint", *args],
        capture_output=True,
        text=True,
        check=False,
        timeout=500,
        env={**os.environ, "PYTHONPATH": str(ROOT / "src"), "COLUMNS": "120"},
    )


def by_command(pack: Path, out: Path, *more: str) -> subprocess.CompletedProcess[str]:
    args = ["--map", str(OVERTAKE / "road.xodr"), "--mapping", str(OVERTAKE / "mapping.toml"), "--out", str(out)]
    args += ["--rules-dir", str(pack), "--rules", "bomb", "--rules", SHIPPED, "--memory", "400MB", *more]
    return drivelint("check", str(OVERTAKE / "safe.csv"), *args)


def assert_contained(tmp_path: Path, names: tuple[str, ...]) -> subprocess.CompletedProcess[str]:
    found = by_command(write_pack(tmp_path / "bad", names), tmp_path / "a", "--rule-timeout", "2")
    alone = by_command(write_pack(tmp_path / "good", ()), tmp_path / "b")
    # what only takes too much is not judged; a text without end is a fault of the rule
    code = 2 if {"long_code", "long_reason", "many_long_reasons"} & set(names) else 4
    assert (found.returncode, alone.returncode) == (code, 0), found.stderr + alone.stderr
    verdicts = pq.read_table(tmp_path / "a" / "verdicts.parquet")
    assert harmless_rows(verdicts) == harmless_rows(pq.read_table(tmp_path / "b" / "verdicts.parquet"))
    told = reasons(verdicts)
    assert {name for name, _ in told} == set(names)
    assert {verdict for verdict, _, _ in told.values()} == {"error"}
    assert {code for _, code, _ in told.values()} <= {"rule_timeout", "out_of_memory", "rule_error"}
    assert not [path.name for path in (tmp_path / "a").iterdir() if path.name.startswith(".")]
    return found


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="a process cannot be replaced here")
def test_the_command_starts_again_without_a_rule_that_heeds_no_interrupt(tmp_path: Path) -> None:
    found = assert_contained(tmp_path, ("nested_lambda",))
    # which of its limits it meets first depends on what else the machine does
    beyond = ("takes longer than --rule-timeout", "takes more memory than is available")
    said = {
        f"drivelint: rule bomb.nested_lambda {what} and cannot be stopped: the run starts again without this rule"
        for what in beyond
    }
    assert sum(line in said for line in found.stderr.splitlines()) == 1


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="a process cannot be replaced here")
def test_a_pack_of_bombs_is_contained(tmp_path: Path) -> None:
    assert len(BOMBS) > 20
    assert_contained(tmp_path, tuple(BOMBS))


@pytest.mark.parametrize("excess", ["out_of_memory", "rule_timeout"])
def test_a_rule_that_takes_much_more_after_its_interrupt_is_not_waited_for(
    excess: limits.Excess, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whichever limit it was interrupted for. Its time is over at the first look, or never."""
    bytes_now = iter(range(0, 1_000_000, 100))
    now = 61.0 if excess == "rule_timeout" else 1.0
    found: list[tuple[str, int]] = []
    ended = Event()

    class DeafHandler:
        @staticmethod
        def exceeded_limits(_task: str) -> dict[str, limits.Excess]:
            return {}

        @staticmethod
        def restart_without(_task: str, _rule_id: str, excess: limits.Excess) -> None:
            found.append((excess, next(bytes_now)))
            ended.set()

    monkeypatch.setattr(computing.ProcessorClock, "seconds", lambda _work: now)
    monkeypatch.setattr(limits, "resident_bytes", lambda: next(bytes_now))
    monkeypatch.setattr(limits, "_RULE_LIMIT_CHECK_PERIOD_S", 0.001)
    monkeypatch.setattr(limits, "_GRACE_AFTER_MEMORY_EXCESS_S", 60.0)
    held_to = limits.RuleLimits(60.0, unstoppable_rule_handler=cast("limits.UnstoppableRuleHandler", DeafHandler))
    held_to.memory = lambda: 1_000
    with duckdb.connect() as con, held_to.limit_statements(con, "mine.grows", alone=True) as held:
        assert ended.wait(30.0)
    assert held.excess == excess
    assert found[0] == (excess, 1_400)


def test_a_rule_that_takes_too_long_is_not_judged_and_no_mistake_of_the_user(tmp_path: Path) -> None:
    found = check(options(write_pack(tmp_path, ("rows",)), "safe", seconds=0.3), Silent())
    status = exit_status(found)
    assert status.code is ExitCode.NOT_JUDGED
    assert status.why == "1 verdict in error: exceeded its limits: bomb.rows"


@pytest.mark.ci
def test_only_the_work_of_a_rule_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither what others do with the machine, nor a thread that reads logs meanwhile."""
    ends = Event()

    def spin() -> None:
        while not ends.is_set():
            sum(range(1000))

    reader = Thread(target=spin)
    work = computing.ProcessorClock(get_native_id())
    reader.start()
    began = process_time()
    while process_time() - began < 0.5:
        sleep(0.05)
    assert work.seconds() < 0.25
    ends.set()
    reader.join()
    work, began = computing.ProcessorClock(get_native_id()), thread_time()
    while thread_time() - began < 0.3:
        sum(range(1000))
    assert 0.25 < work.seconds() < 0.6


def test_a_drive_of_several_batches_may_take_as_many_times_as_long() -> None:
    held_to = limits.RuleLimits(30.0)
    assert held_to.allowed_cpu_s == 30.0
    held_to.batches = 9.0
    assert held_to.allowed_cpu_s == 270.0
    held_to.batches = 0.01
    assert held_to.allowed_cpu_s == 30.0
    assert limits.RuleLimits(None).allowed_cpu_s is None


BOMB_SCRIPT = """
import json, os, sys, time
from drivelint.evaluate import limits
from drivelint.report.progress import Silent
from drivelint.run import check
from tests.evaluate.test_limits import options
from pathlib import Path

def told(how):
    print(json.dumps({"how": how, "cpu_s": time.process_time() - began, "grown": limits.resident_bytes() - before}), flush=True)
    os._exit(0)

class DeafHandler:
    exceeded_limits = staticmethod(lambda task: {})
    restart_without = staticmethod(lambda task, rule, excess: told("deaf " + excess))

rule = limits.RuleLimits.limit_statements
def limit_statements(self, con, rule_id, *, alone):
    global began, before
    if rule_id == "bomb." + sys.argv[1]:
        began, before = time.process_time(), limits.resident_bytes()
    return rule(self, con, rule_id, alone=alone)
limits.RuleLimits.limit_statements = limit_statements
from drivelint.evaluate.evaluation import Evaluation
blame = Evaluation._record_error
Evaluation._record_error = lambda self, binding, error, excess: told(excess or str(error).splitlines()[0])
check(options(Path(sys.argv[2]), "safe", seconds=2.0), Silent(), None, DeafHandler)
"""


@pytest.mark.slow
@pytest.mark.parametrize("name", BOMBS)
def test_a_bomb_ends_within_twice_its_limit(name: str, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", BOMB_SCRIPT, name, str(write_pack(tmp_path, (name,)))],
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
        env={**os.environ, "PYTHONPATH": f"{ROOT / 'src'}{os.pathsep}{ROOT}"},
    )
    assert done.stdout, done.stderr
    told = json.loads(done.stdout)
    assert told["cpu_s"] < 2 * 2.0 + 0.5, told  # and half a second until the watch is scheduled
    assert told["grown"] < 3 * 1_200_000_000, told
