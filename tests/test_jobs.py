"""A check by several processes comes to the same as one by a single process."""

from __future__ import annotations

import pickle
import shutil
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import pyarrow as pa
import pyarrow.compute as pc
import pytest

from drivelint import demo, errors, parallel, run
from drivelint.cli.receipts import OutputPathTest
from drivelint.engine.interruption import Interruption, NothingJudgedError
from drivelint.errors import DriveLintError, MemoryShortError, TraceError
from drivelint.receipts.recorder import record_inputs
from drivelint.report.log_notes import LogNote
from drivelint.report.outputs import working_folder, write
from drivelint.report.progress import Progress
from drivelint.result.joining import join_results
from drivelint.result.names import TABLE_OF_FILE
from tests.report.synthetic import result

if TYPE_CHECKING:
    from drivelint.result.model import Result
    from drivelint.run import CheckOptions


class Alone(NamedTuple):
    """A check by one process: its result, the folder and what was written there, what was told."""

    result: Result
    out: Path
    files: dict[str, bytes]
    counter: Counter


class Counter(Progress):
    """Counts the drives that are told to be done."""

    def __init__(self) -> None:
        self.n_done = 0
        self.notes: list[str] = []

    def advance(self, n: int = 1) -> None:
        self.n_done += n

    def note(self, text: str) -> None:
        self.notes.append(text)


@pytest.fixture(scope="module")
def options(tmp_path_factory: pytest.TempPathFactory) -> CheckOptions:
    """Return a check of six logs: one of them is damaged, one is there twice, and a mapping is noted once of all."""
    home = tmp_path_factory.mktemp("jobs")
    logs = {path.name: path for path in demo.write(home / "demo")}
    (home / "logs" / "again").mkdir(parents=True)
    for name in ("collision.mcap", "near-miss.mcap", "safe.mcap", "safe-25mph.mcap"):
        shutil.copy(logs[name], home / "logs")
    shutil.copy(logs["near-miss.mcap"], home / "logs" / "again")
    (home / "logs" / "m.mcap").write_bytes(b"\x89MCAP0\r\n" + bytes(100_000))
    mapping = home / "columns.toml"
    mapping.write_text("[columns]\n")
    return run.CheckOptions(
        (str(home / "logs"),), map=logs["road.xodr"], rules=("ukhc.no-collision",), mapping=str(mapping)
    )


def files(out: Path) -> dict[str, bytes]:
    return {path.relative_to(out).as_posix(): path.read_bytes() for path in out.rglob("*") if path.is_file()}


def write_check(options: CheckOptions, out: Path, jobs: int, progress: Progress) -> Result:
    with working_folder(out) as work:
        found = parallel.check(replace(options, out=work), jobs, progress)
        write(found, out, work)
    return found


@pytest.fixture(scope="module")
def alone(options: CheckOptions, tmp_path_factory: pytest.TempPathFactory) -> Alone:
    """Return what one process comes to, writes and tells."""
    out, counter = tmp_path_factory.mktemp("alone") / "out", Counter()
    return Alone(write_check(options, out, 1, counter), out, files(out), counter)


@pytest.mark.ci
def test_several_processes_write_the_bytes_of_one(options: CheckOptions, alone: Alone, tmp_path: Path) -> None:
    expected, out, by_one, one = alone
    two = Counter()
    shutil.rmtree(out)  # paths in the result are relative to its folder
    with record_inputs(OutputPathTest(out), []) as recorder:
        found = write_check(options, out, 2, two)
    assert files(out) == by_one
    assert sum(name.endswith(".mcap") for name in by_one) == 4
    damaged, mapping, again = "not judged: ", "collision.mcap: mapping ", "the same content as the log of "
    assert [note for note in expected.notes if note.startswith(mapping)] == list(expected.notes[:1])
    assert [sum(words in note for note in expected.notes) for words in (damaged, again)] == [1, 1]
    assert found.notes == expected.notes
    assert len(one.notes) == len(two.notes)  # which log is the first with a note is by chance on the screen
    assert two.n_done == 5
    read = {path for path in recorder._states if path.startswith(options.traces[0]) and path.endswith(".mcap")}
    assert len(read) == 6
    assert str(options.map) in recorder._states
    assert recorder.trouble is None


def test_a_log_that_two_parts_have_is_judged_once(alone: Alone) -> None:
    judged = alone.result
    assert judged.run_options is not None
    drives = sorted(judged.run_options.traces)
    notes = tuple(LogNote(Path(judged.run_options.traces[drive]), "said", once=True) for drive in drives)
    one = run.JudgedLogs(replace(judged, **_of(judged, drives[:2], inside=True)), notes[:2], (), {})
    first, second = parallel._without_duplicate_drives([one, run.JudgedLogs(judged, notes, (), {})])
    assert first is one
    assert set(second.result.drives["drive_id"].to_pylist()) == {*drives[2:], "m"}
    assert not set(second.result.verdicts["drive_id"].to_pylist()) & set(drives[:2])
    told = [note.text for note in second.notes if not note.once]
    assert [text.endswith(f" {drive}: judged once") for text, drive in zip(told, drives, strict=False)] == [True, True]
    assert len(second.notes) == len(drives)


@pytest.mark.ci
def test_an_interrupted_check_of_several_processes_says_so(options: CheckOptions) -> None:
    interruption = Interruption()
    interruption.requested = True
    with pytest.raises(NothingJudgedError):
        parallel.check(replace(options, annotate=False), 2, Progress(), interruption=interruption)


@pytest.mark.parametrize(
    ("max_parts", "parts"), [(1, ["aBcd"]), (2, ["aB", "cd"]), (3, ["a", "B", "cd"]), (9, ["a", "B", "c", "d"])]
)
def test_parts_are_neighbours_of_about_as_many_bytes(tmp_path: Path, max_parts: int, parts: list[str]) -> None:
    paths = [tmp_path / name for name in "aBcd"]
    for path in paths:
        path.write_bytes(bytes(2000 if path.name.isupper() else 1000))
    paths[2].write_bytes(bytes(1100))
    assert ["".join(path.name for path in part) for part in parallel._cut_into_parts(paths, max_parts)] == parts


def test_a_log_that_cannot_be_looked_at_is_in_a_part(tmp_path: Path) -> None:
    paths = [tmp_path / "a", tmp_path / "b"]
    assert [path for part in parallel._cut_into_parts(paths, 2) for path in part] == paths


def test_joined_results_are_those_of_one_run(alone: Alone) -> None:
    """Whatever the parts are; lanes may be in several."""
    judged = alone.result
    drives = judged.drives["drive_id"].to_pylist()
    assert judged.lanes.num_rows
    for mine in (drives[::2], drives[:1], drives[1:]):
        joined = join_results([replace(judged, **_of(judged, mine, inside=inside)) for inside in (True, False)])
        for name in TABLE_OF_FILE:
            assert getattr(joined, name).equals(getattr(judged, name)), name
    assert join_results([judged, result([], drives=[], interrupted=True)]).interrupted


def _of(whole: Result, drives: list[str], *, inside: bool) -> dict[str, pa.Table]:
    tables = {name: getattr(whole, name) for name in TABLE_OF_FILE}
    chosen = {}
    for name, table in tables.items():
        if "drive_id" in table.column_names:
            is_mine = pc.is_in(table["drive_id"], value_set=pa.array(drives, pa.string()))
            chosen[name] = table.filter(is_mine if inside else pc.invert(is_mine))
    return chosen


@pytest.mark.parametrize(
    "error",
    [MemoryShortError("x.mcap"), TraceError("x.mcap: no"), DriveLintError("no")],
    ids=lambda error: type(error).__name__,
)
def test_an_error_of_a_worker_says_the_same(error: DriveLintError) -> None:
    again = pickle.loads(pickle.dumps(error))  # noqa: S301 - its own
    assert (type(again), str(again), again.exit_code) == (type(error), str(error), error.exit_code)
    assert isinstance(again, errors.DriveLintError)
