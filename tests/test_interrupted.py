"""Ctrl-C during a check keeps what was judged until then, and the result says that it is partial."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from threading import Event, Thread
from typing import TYPE_CHECKING

import pyarrow.compute as pc
import pytest

from drivelint.engine import batch
from drivelint.engine.barrier import RefusedLog
from drivelint.engine.interruption import Interruption
from drivelint.errors import TraceError
from drivelint.report.outputs import write
from drivelint.report.progress import Silent
from drivelint.result.load import load_result
from drivelint.run import CheckOptions, check
from tests.evaluate.packs import invariant
from tests.fleet_report.command import ran
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator

OVERTAKE = ROOT / "fixtures" / "overtake"
TRACES = tuple(str(OVERTAKE / f"{name}.csv") for name in ("collision", "near_miss", "safe"))
"""In the order in which they are judged."""
SECOND = "(SELECT DISTINCT drive_id::VARCHAR AS name FROM ego_state WHERE starts_with(drive_id::VARCHAR, 'near_miss'))"
ENDLESS = f"""SELECT count(*) FROM {SECOND} JOIN range(1000000) a(i) ON sin(a.i) < 2 + length(name)
JOIN range(1000000) b(i) ON sin(a.i + b.i) > 2 + length(name)"""
"""A billion rows a second would take a quarter of an hour, and without that drive there is none."""
RULE = invariant(
    "SELECT drive_id, ego_id, t_ns, speed_mps AS observed, 10.0::DOUBLE AS required FROM ego_state\n"
    f"WHERE ({ENDLESS}) = 0"
)


@pytest.fixture
def pack(tmp_path: Path) -> Path:
    """Return a folder with a rule that never comes to an end on the second drive."""
    (tmp_path / "packs" / "mine").mkdir(parents=True)
    (tmp_path / "packs" / "mine" / "slow.sql").write_text(RULE, encoding="utf-8")
    return tmp_path / "packs"


class Stopper(Silent):
    """Interrupts a run some time after so many drives were judged, as the command line does: again and again."""

    def __init__(self, after: int, *, later_s: float = 0.0) -> None:
        self.interruption, self._left, self._later_s, self._over = Interruption(), after, later_s, Event()

    def advance(self, n: int = 1) -> None:
        """Count a drive."""
        self._left -= n
        if self._left == 0 and not self._later_s:
            self.interruption.request()

    @contextmanager
    def acting(self) -> Iterator[None]:
        """Interrupt in the background while the block runs."""

        def act() -> None:
            while not self._over.wait(0.05):
                if self._left <= 0:
                    time.sleep(self._later_s)
                    self.interruption.request()

        thread = Thread(target=act)
        thread.start()
        try:
            yield
        finally:
            self._over.set()
            thread.join()


def options(pack: Path, traces: tuple[str, ...] = TRACES, out: Path | None = None) -> CheckOptions:
    return CheckOptions(
        traces=traces,
        map=OVERTAKE / "road.xodr",
        mapping=str(OVERTAKE / "mapping.toml"),
        rules=("mine", "ukhc.r162.safe-distance-ahead"),
        rules_dirs=(pack,),
        out=out,
        margins=out is not None,
        keep_db=out is not None,
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    "later_s",
    [pytest.param(0.0, id="between two drives", marks=pytest.mark.slow), pytest.param(1.0, id="while one is judged")],
)
def test_the_drives_that_were_judged_are_as_if_they_had_been_checked_alone(
    pack: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, later_s: float
) -> None:
    monkeypatch.setattr(batch, "MAX_BATCH_STATES", 1)  # each drive is a batch
    stopper = Stopper(1, later_s=later_s)
    with stopper.acting():
        partial = check(options(pack, out=tmp_path / "a"), stopper, stopper.interruption)
    alone = check(options(pack, TRACES[:1], tmp_path / "b"), Silent())
    assert partial.interrupted
    for name in ("verdicts", "findings", "courses", "tracks", "scenes"):
        assert getattr(partial, name).equals(getattr(alone, name)), name
    assert set(partial.verdicts["verdict"].to_pylist()) <= {"pass", "fail", "unknown", "not_applicable"}
    rows = partial.drives.select(["file_name", "status", "status_reason"]).to_pylist()
    why = "the run was interrupted before this drive was judged"
    assert sorted(tuple(row.values()) for row in rows) == [
        ("collision.csv", "judged", None), ("near_miss.csv", "not_judged", why), ("safe.csv", "not_judged", why),
    ]  # fmt: skip
    assert partial.drives.filter(pc.equal(partial.drives["status"], "judged")).equals(alone.drives)
    assert partial.margins_file is not None
    assert alone.margins_file is not None
    assert partial.margins_file.read_bytes() == alone.margins_file.read_bytes()
    assert partial.run_options is not None
    write(partial, tmp_path / "out")
    assert load_result(tmp_path / "out").interrupted


@pytest.mark.ci
def test_before_any_drive_is_judged_there_is_no_result(pack: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(batch, "MAX_BATCH_STATES", 1)
    stopper = Stopper(0, later_s=0.01)
    with stopper.acting(), pytest.raises(KeyboardInterrupt):
        check(options(pack, TRACES[1:]), stopper, stopper.interruption)


def run(code: str, *args: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", f"{code}\nfrom drivelint.cli import main\nmain()", *args],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT / "src"), "COLUMNS": "120"},
    )


@pytest.mark.parametrize("sign", [signal.SIGINT, pytest.param(signal.SIGTERM, marks=pytest.mark.slow)])
def test_ctrl_c_leaves_a_partial_result_that_says_so(sign: signal.Signals, pack: Path, tmp_path: Path) -> None:
    if signal.getsignal(sign) is signal.SIG_IGN:
        pytest.skip("the signal is ignored where these tests run")
    out = tmp_path / "out"
    args = ["--map", str(OVERTAKE / "road.xodr"), "--mapping", str(OVERTAKE / "mapping.toml"), "--out", str(out)]
    args += ["--rules-dir", str(pack), "--rules", "mine", "--rules", "ukhc.r162.*", "--no-robustness"]
    with run("from drivelint.engine import batch\nbatch.MAX_BATCH_STATES = 1", "check", *TRACES, *args) as process:
        try:
            until = time.monotonic() + 60
            while not list(out.glob(".drivelint.work.*/annotated/collision*.mcap")) and time.monotonic() < until:
                time.sleep(0.1)
            time.sleep(1)
            process.send_signal(sign)
            said, err = process.communicate(timeout=30)
        finally:
            process.kill()
    assert process.returncode == 130, err
    assert "drivelint: interrupted: finishing what is begun" in err
    assert f"drivelint: kept 1 of 3 drives in {out}" in err.splitlines()
    sentence = "partial: 1 of 3 drives judged, interrupted"
    assert said.splitlines()[2].startswith("PARTIAL")
    assert f"exit 130: {sentence}" in said
    assert json.loads((out / "summary.json").read_text())["exit"]["why"] == sentence
    assert sentence in (out / "report.html").read_text()
    assert [path.name.partition("-")[0] for path in (out / "annotated").glob("*.mcap")] == ["collision"]
    assert not [path.name for path in out.iterdir() if path.name.startswith(".")]
    name = f"ukhc.r162.safe-distance-ahead@{json.loads((out / 'run.json').read_text())['traces'].popitem()[0]}"
    for asks in (["report", out, "--to", "markdown"], ["diff", out, out]):
        assert f"{out}: {sentence}" in ran(*asks).err, asks
    assert sentence in (out / "report.md").read_text()
    told = ran("explain", name, "--in", out, "--samples", 0)
    assert (told.code, sentence in told.err) == (0, True), told.err


@pytest.mark.ci
@pytest.mark.skipif(signal.getsignal(signal.SIGINT) is signal.SIG_IGN, reason="Ctrl-C is ignored where these tests run")
@pytest.mark.parametrize("earlier", [True, False])
def test_ctrl_c_before_anything_is_judged_says_so_and_keeps_an_earlier_result_aside(
    pack: Path, tmp_path: Path, *, earlier: bool
) -> None:
    out = tmp_path / "out"
    out.mkdir()
    if earlier:
        (out / "summary.json").write_text("earlier", encoding="utf-8")
        (out / "files.json").write_text('{"written_by_drivelint": ["summary.json"]}', encoding="utf-8")
    before = {path.name: path.read_bytes() for path in out.iterdir()}
    args = ["--map", str(OVERTAKE / "road.xodr"), "--mapping", str(OVERTAKE / "mapping.toml"), "--out", str(out)]
    with run("", "check", TRACES[1], *args, "--rules-dir", str(pack), "--rules", "mine") as process:
        try:
            until = time.monotonic() + 60
            while not list(out.glob(".drivelint.work.*")) and time.monotonic() < until:
                time.sleep(0.1)
            time.sleep(1)
            process.send_signal(signal.SIGINT)
            said, err = process.communicate(timeout=30)
        finally:
            process.kill()
    assert (process.returncode, said) == (130, ""), err
    assert f"drivelint: nothing was judged yet; {out} contains no result" in err.splitlines()
    told = f"drivelint: the result of an earlier run is now in {out / 'earlier'}"
    assert (told in err.splitlines()) is earlier
    assert not [line for line in err.splitlines() if line.startswith("drivelint: kept")]
    aside = out / "earlier"
    assert [path.name for path in out.iterdir()] == (["earlier"] if earlier else [])
    assert {path.name: path.read_bytes() for path in aside.glob("*")} == before


@pytest.fixture
def scratch(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the folder in which the commands of a test make their temporary ones."""
    folder = tmp_path / "scratch"
    folder.mkdir()
    monkeypatch.setenv("TMPDIR", str(folder))
    return folder


@pytest.mark.ci
@pytest.mark.skipif(signal.getsignal(signal.SIGINT) is signal.SIG_IGN, reason="Ctrl-C is ignored where these tests run")
def test_ctrl_c_ends_the_check_at_the_end_of_a_watch(pack: Path, tmp_path: Path, scratch: Path) -> None:
    out = tmp_path / "out"
    args = ["--map", str(OVERTAKE / "road.xodr"), "--mapping", str(OVERTAKE / "mapping.toml"), "--out", str(out)]
    args += ["--rules-dir", str(pack), "--rules", "mine", "--replay", "0", "--every", "20"]
    with run("", "watch", TRACES[1], *args) as process:
        try:
            assert process.stderr is not None
            # the rule comes to an end on windows, which have another name than the drive
            told = next(line for line in process.stderr if "judged, each in" in line)
            time.sleep(1)
            process.send_signal(signal.SIGINT)
            said, err = process.communicate(timeout=25)  # the rule alone would take 30 s
        finally:
            process.kill()
    assert process.returncode == 130, told + err
    end = json.loads(said.splitlines()[-1])
    assert end == {"type": "end", "exit_code": 130, "why": "interrupted before the recording was judged"}
    assert f"drivelint: nothing was judged yet; {out} contains no result" in err.splitlines()
    assert not list(scratch.iterdir())


@pytest.mark.ci
@pytest.mark.skipif(signal.getsignal(signal.SIGINT) is signal.SIG_IGN, reason="Ctrl-C is ignored where these tests run")
def test_a_second_ctrl_c_leaves_no_temporary_folder(tmp_path: Path, scratch: Path) -> None:
    stuck = "import time\nfrom drivelint.watch.run import Watch\nWatch.watch = lambda self: time.sleep(600)"
    with run(stuck, "watch", str(tmp_path / "log.mcap"), "--rules", "ukhc.no-collision") as process:
        try:
            until = time.monotonic() + 60
            while len(list(scratch.iterdir())) < 4 and time.monotonic() < until:
                time.sleep(0.1)
            before = [path.name for path in scratch.iterdir()]
            process.send_signal(signal.SIGINT)
            assert process.stderr is not None
            told = next(line for line in process.stderr if "interrupted" in line)
            process.send_signal(signal.SIGINT)
            _, err = process.communicate(timeout=30)
        finally:
            process.kill()
    assert "press Ctrl-C again to stop at once" in told
    assert process.returncode == 130, err
    assert len(before) == 4
    assert not list(scratch.iterdir())


LOST_INTERRUPT = """
import os, signal
from drivelint.cli import watching
class Collected:
    def __del__(self):
        os.kill(os.getpid(), signal.SIGTERM)
        sum(range(1000))
def bar(quiet, before=watching.bar):
    Collected()
    return before(quiet)
watching.bar = bar
"""
"""A signal comes while Python collects an object: what is raised there is printed, and nobody gets it."""


@pytest.mark.ci
def test_a_signal_whose_interrupt_is_lost_ends_a_watch_all_the_same(tmp_path: Path) -> None:
    with run(
        LOST_INTERRUPT, "watch", str(tmp_path / "never.mcap"), "--idle", "0", "--rules", "ukhc.no-collision"
    ) as process:
        try:
            _, err = process.communicate(timeout=120)
        finally:
            process.kill()
    assert "Exception ignored" in err
    assert "drivelint: interrupted: finishing what is begun" in err
    assert process.returncode == 4, err


class Watcher(Silent):
    """Notes what a person who waits is told."""

    def __init__(self) -> None:
        self.told: list[str | int] = []

    def stage(self, name: str, total: int | None = None) -> None:
        """Note the stage of copies and how many findings it has."""
        if "copies" in name:
            self.told += [name, f"of {total}"]

    def doing(self, activity: str, units_since_advance: float = 0.0) -> None:
        """Note what is done."""
        self.told += [activity, f"{units_since_advance:g}"] if units_since_advance else [activity]

    def advance(self, n: int = 1) -> None:
        """Note the units done."""
        self.told.append(n)


@pytest.mark.slow
def test_the_bar_tells_what_is_read_and_what_is_judged(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(batch, "FIRST_BATCH_DRIVES", 1)
    watcher = Watcher()
    check(replace(options(Path(), TRACES), rules_dirs=(), rules=("ukhc.r162.safe-distance-ahead",)), watcher)
    assert watcher.told == [
        "reading 1/3", "reading 2/3", "judging 1 drive: deriving tables", "judging 1 drive: rule 1 of 1", "0.5", 1,
        "reading 3/3", "reading 3/3", "judging 2 drives: deriving tables", "judging 2 drives: rule 1 of 1", "1", 2,
        "2 critical findings; judging copies", "of 2", 1, 1,
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("n", "sizes"),
    [(6, [6]), (17, [16, 1]), (40, [16, 24]), (200, [16, 96, 88])],
)
def test_the_first_batches_of_a_run_are_small(n: int, sizes: list[int]) -> None:
    refused = [RefusedLog(Path(f"{k}.csv"), TraceError("broken")) for k in range(n)]
    assert [len(each) for each in batch.cut_batches(refused)] == sizes


def test_the_first_batches_have_few_states(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(batch.Drive, "size_in_states_or_pairs", 40_000)
    drives = [batch.Drive(None, None) for _ in range(30)]  # type: ignore[arg-type]
    assert [len(each) for each in batch.cut_batches(drives)] == [2, 10, 10, 8]
