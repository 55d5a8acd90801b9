"""Pipes, devices, names without end, a terminal that is gone, a limit of memory: one line at once, with its exit code."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from drivelint.cli import streams
from drivelint.drive.trace import IngestOptions
from drivelint.engine.batch import sorted_logs
from drivelint.errors import (
    DriveLintError,
    ExitCode,
    MapError,
    MemoryShortError,
    TraceError,
    UsageError,
    describe_machine_error,
)
from drivelint.formats import read_trace
from drivelint.formats.files import expand_traces, identify
from drivelint.formats.film import mapping as film_mapping
from drivelint.formats.map_registry import read_source
from drivelint.formats.search import why_unreadable
from drivelint.formats.tables import mapping
from drivelint.gate import waivers
from drivelint.watch.sources.growing_file import GrowingFile
from tests.fuzz import sources
from tests.shared_data import ROOT

pytestmark = pytest.mark.skipif(os.name != "posix", reason="there are no such pipes here")
LONG = "a" * 300
SCENES = ROOT / "fixtures" / "scenes"


@pytest.fixture(params=["pipe", "device"])
def place(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """Return what never begins, or never ends."""
    path = tmp_path / "x.mcap"
    if request.param == "pipe":
        os.mkfifo(path)
    else:
        path.symlink_to("/dev/zero")
    return path


@pytest.mark.timeout(60)
def test_it_is_no_log_no_map_no_mapping_and_no_file_of_waivers(place: Path) -> None:
    for read in (lambda: read_trace(place, IngestOptions()), lambda: identify(place)):
        with pytest.raises(TraceError, match="a pipe or a device, but a log is read more than once"):
            read()
    with pytest.raises(MapError, match="a pipe or a device"):
        read_source(place)
    with pytest.raises(UsageError, match="a pipe or a device"):
        mapping.load(str(place))
    assert not film_mapping.is_video_mapping(str(place))
    with pytest.raises(UsageError, match="waivers must be in a file"):
        waivers.read(place)
    with pytest.raises(TraceError, match="a pipe, a device or a folder"):
        GrowingFile(place, idle_s=None).read(1.0)
    assert expand_traces([str(place)]) == [place]
    assert sorted_logs([place, place]) == [place, place]


@pytest.mark.timeout(60)
def test_a_part_of_a_drive_that_is_a_pipe_is_not_there(tmp_path: Path) -> None:
    folder = sources.parquet(tmp_path)[0].write(tmp_path / "drive")
    (folder / "actor.parquet").unlink()
    os.mkfifo(folder / "actor.parquet")
    with pytest.raises(TraceError, match=r"actor\.parquet|no ego"):
        read_trace(folder, IngestOptions())


def test_a_name_that_no_file_can_have() -> None:
    with pytest.raises(UsageError, match="neither a file nor a shipped mapping"):
        mapping.load(LONG)
    assert not film_mapping.is_video_mapping(LONG)
    assert why_unreadable(Path(LONG)) is None
    with pytest.raises(OSError, match="too long") as met:
        Path(LONG).stat()
    said, code = describe_machine_error(met.value) or ("", ExitCode.OK)
    assert (said, code) == (f"{LONG}: the name is too long for this system: choose a shorter one", ExitCode.USAGE)


@pytest.mark.parametrize(
    "error", [MemoryError(), ImportError("x.so: Cannot allocate memory"), RuntimeError("can't start new thread")]
)
def test_no_memory_is_no_fault_of_the_program(error: Exception) -> None:
    assert (describe_machine_error(error) or ("", None))[1] == ExitCode.TEMPFAIL
    assert describe_machine_error(IndexError("x")) is None


def test_what_does_not_fit_ends_the_run_where_a_limit_is_set(monkeypatch: pytest.MonkeyPatch) -> None:
    assert not MemoryShortError("a").is_about_whole_run
    monkeypatch.setattr("drivelint.errors.memory_limit_of_process_bytes", lambda: 10**9)
    error: DriveLintError = MemoryShortError("a")
    assert error.is_about_whole_run
    assert "ulimit -v" in str(error)


@pytest.mark.parametrize(("columns", "expected"), [("0", None), ("00", None), ("", None), ("80", "80")])
def test_a_terminal_without_columns_is_one_of_unknown_width(
    columns: str, expected: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", columns)
    streams.make_stdout_and_stderr_writable()
    assert os.environ.get("COLUMNS") == expected


def command(*args: str) -> list[str]:
    return [sys.executable, "-m", "drivelint", *args]


ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT / "src")}
CHECK = (
    "check",
    str(SCENES / "safe.mcap"),
    "--map",
    str(SCENES / "overtake-road.xodr"),
    "--rules",
    "ukhc.no-collision",
)


@pytest.mark.ci
@pytest.mark.parametrize("kilobytes", [400_000, 2_500_000])
def test_a_limit_of_addresses_is_75(kilobytes: int) -> None:
    shell = ["bash", "-c", f'ulimit -v {kilobytes}; exec "$0" "$@"', *command(*CHECK)]
    done = subprocess.run(shell, capture_output=True, text=True, check=False, env=ENVIRONMENT, timeout=300)
    assert done.returncode == 75, done.stderr
    assert "Traceback" not in done.stderr
    assert "ulimit -v" in done.stderr.splitlines()[-1]


@pytest.mark.ci
def test_a_terminal_that_is_gone_ends_a_command_as_sigterm_does(tmp_path: Path) -> None:
    with subprocess.Popen(
        command("watch", str(tmp_path / "never.mcap"), "--idle", "0", *CHECK[2:4]),
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=ENVIRONMENT, cwd=tmp_path,
    ) as process:  # fmt: skip
        caught = Path(f"/proc/{process.pid}/status")
        while not int(caught.read_text().split("SigCgt:")[1].split()[0], 16) >> (signal.SIGHUP - 1) & 1:
            assert process.poll() is None
            time.sleep(0.1)  # a busy machine starts Python slowly
        process.send_signal(signal.SIGHUP)
        _, said = process.communicate(timeout=300)
    assert process.returncode > 0, said
    assert "interrupted" in said


AN_IMPORT_THAT_A_SIGNAL_ENDS = """
import importlib, os, signal, sys
app = importlib.import_module("drivelint.cli.app")

def command(_name):
    def run(**_options):
        try:
            os.kill(os.getpid(), signal.SIGTERM)
            signal.sigwait([signal.SIGUSR1])
        except KeyboardInterrupt:
            pass
        raise ImportError("initialization failed")
    return run

app._app_with_command = command
sys.argv = ["drivelint", "check"]
app.main()
"""


@pytest.mark.parametrize("signalled", [True, False])
def test_an_import_that_a_signal_ends_is_an_interruption(signalled: bool) -> None:
    """An extension module makes an ImportError of the exception that ends its import."""
    text = AN_IMPORT_THAT_A_SIGNAL_ENDS
    text = text if signalled else text.replace("os.kill(os.getpid(), signal.SIGTERM)", "raise KeyboardInterrupt")
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == (130 if signalled else 4), done.stderr
    assert ("interrupted" in done.stderr, "internal error" in done.stderr) == (signalled, not signalled)
