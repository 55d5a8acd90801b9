"""A short run over all kinds, and that the fuzzer notices what it is for. `python -m tests.fuzz` runs as many as are wanted."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from drivelint.drive.trace import QualityFinding
from drivelint.errors import InternalError, TraceError
from tests.fuzz import judging, sources, traces
from tests.fuzz.__main__ import JOBS_PER_ROUND, jobs, logged, main, table
from tests.fuzz.driver import Driver
from tests.fuzz.mutations import BINARY, TEXT, XML, generator
from tests.fuzz.outcome import BAD, Outcome, of_error
from tests.fuzz.worker import KINDS, Bench, Job

if TYPE_CHECKING:
    from multiprocessing.connection import Connection

JUDGED_KINDS = ("osi-mcap",)


@pytest.mark.slow
def test_two_hundred_damaged_files_are_refused_flagged_or_as_before() -> None:
    with Driver() as driver:
        work = [*jobs(200, KINDS, 17, is_judged=False), *jobs(20, JUDGED_KINDS, 18)]
        found = [outcome for job in work for outcome in driver.run(job)]
    assert [each for each in found if each.outcome in BAD] == []
    assert {each.kind for each in found} == set(KINDS)
    assert len({(each.kind, each.number) for each in found}) >= 200
    assert {"same", "refused", "lossy", "unprotected", "other"} <= {each.outcome for each in found}, table(found)


def test_a_case_is_the_same_each_time() -> None:
    data = (sources.SCENES / "two-lane-road.xodr").read_bytes()
    for way in {*BINARY, *XML}:
        changed = [way(data, generator(7)) for _ in range(2)]
        assert changed[0] == changed[1]
    assert sum(way(data, generator(n)) != data for n in range(20) for way in (*BINARY, *TEXT)) > 400
    for way in (*BINARY, *XML):
        way(b"", generator(1))


@pytest.mark.parametrize(
    ("error", "outcome"),
    [
        (TraceError("a: is damaged"), "refused"),
        (InternalError("a: IndexError"), "crash"),
        (IndexError("x"), "crash"),
        (MemoryError(), "memory"),
        (TraceError("x" * 100_000), "refused"),
    ],
)
def test_what_is_no_refusal_is_a_bug(error: BaseException, outcome: str) -> None:
    assert of_error(error)[0] == outcome
    assert len(str(error)) <= 4000


def _died(connection: Connection, log: str) -> None:
    job: Job = connection.recv()
    connection.send(job.first)
    if job.first == 1:
        time.sleep(60)
    os.kill(os.getpid(), signal.SIGSEGV)


@pytest.mark.slow
def test_a_process_that_dies_or_hangs_is_a_finding_and_the_rest_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tests.fuzz.driver.serve", _died)
    monkeypatch.setattr("tests.fuzz.driver.START_LIMIT_S", 4.0)
    with Driver(time_limit_s=1.0) as driver:
        found = list(driver.run(Job("csv", 1, 0, 3, is_judged=False)))
    assert [(each.number, each.outcome) for each in found] == [(0, "died"), (1, "hang"), (2, "died")]
    assert "SIGSEGV" in found[0].detail


@pytest.fixture(scope="module")
def bench() -> Bench:
    return Bench()


def test_other_content_that_nobody_says_is_silent(
    bench: Bench, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    chunked = next(source for source in bench.of("osi-mcap") if source.name == "chunked")
    whole = bench.whole_content("osi-mcap", chunked)
    other = osi_with_another_place(tmp_path)
    outcome, detail, _ = traces.read_case(other, chunked, whole, rewritten=False)
    assert (outcome, detail) == ("silent", "tables ['actor_state'], others []")
    assert traces.read_case(other, chunked, whole, rewritten=True)[0] == "unprotected"


def osi_with_another_place(folder: Path) -> Path:
    """Return the drive with one position changed, and right checksums."""
    from tests.formats.osi import osi_log

    found = sources.frames()
    found[3].moving_object[2].base.position.x += 0.001
    return osi_log.write(folder / "other.mcap", osi_log.truths(found), chunk_size=600, enable_data_crcs=False)


def test_a_table_that_does_not_say_that_it_has_no_checksums_is_a_bug(
    bench: Bench, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cars = next(source for source in bench.of("csv") if source.name == "cars")
    whole = bench.whole_content("csv", cars)
    path = cars.write(tmp_path / "a", {"cars.csv": cars.files["cars.csv"].replace(b",3.0000,", b",3.0001,", 1)})
    assert traces.read_case(path, cars, whole, rewritten=False)[0] == "unprotected"
    monkeypatch.setattr("drivelint.formats.registry.UNPROTECTED_FINDING", QualityFinding("gap", "info", "x"))
    assert traces.read_case(path, cars, whole, rewritten=False)[0] == "unsaid"


def test_a_pass_over_a_failure_is_a_contradiction() -> None:
    def row(verdict: str, start: int, end: int, worst: int) -> dict[str, Any]:
        return {
            "verdict": verdict, "rule_id": "r", "object_id": "1", "t_start_ns": start, "t_end_ns": end, "t_worst_ns": worst,
        }  # fmt: skip

    whole = [row("fail", 5, 9, 7)]
    assert judging.contradiction([row("fail", 5, 9, 8), row("pass", 0, 6, 1), row("unknown", 0, 9, 7)], whole) is None
    assert "pass" in str(judging.contradiction([row("pass", 0, 9, 1)], whole))
    assert "fail" in str(judging.contradiction([row("fail", 0, 4, 2)], whole))


def test_a_run_goes_on_after_what_its_log_has(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ran: list[Job] = []

    def run(_: Driver, job: Job) -> list[Outcome]:
        ran.append(job)
        return [Outcome(job.kind, number, "a", "refused") for number in range(job.first, job.first + job.n)]

    monkeypatch.setattr(Driver, "run", run)
    log = tmp_path / "log"
    words = ["500", "--only", "csv", "--only", "rule", "--log", str(log)]
    assert (main(words), len(ran)) == (0, 6)
    text = log.read_text(encoding="utf-8")
    assert (main(words), len(ran)) == (0, 6)
    log.write_text(text[:-40], encoding="utf-8")  # killed while it wrote the last one
    assert (main(words), ran[6:]) == (0, [ran[5]])
    outcomes, ended = logged(log)
    assert (len(outcomes), len(ended)) == (500, 6)


def test_a_run_that_is_ended_early_has_tried_all_kinds() -> None:
    work = list(jobs(100_000, KINDS, 1))
    assert {job.kind for job in work[: JOBS_PER_ROUND * len(KINDS)]} == set(KINDS)
    assert sum(job.n for job in work) == 100_000


def test_the_table_counts_cases() -> None:
    found = [
        Outcome("csv", 1, "cars", "same"),
        Outcome("csv", 2, "cars", "lossy"),
        Outcome("csv", 2, "cars", "rule error"),
    ]
    assert [line.split() for line in table(found).splitlines()] == [
        ["kind", "cases", "same", "lossy", "rule", "error"], ["csv", "2", "1", "1", "1"],
    ]  # fmt: skip
