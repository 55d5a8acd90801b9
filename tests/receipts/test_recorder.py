"""What a run reads is in its receipt, whoever reads it and however; what it writes is not."""

from __future__ import annotations

import os
import tempfile
from glob import glob
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from drivelint.cli.receipts import OutputPathTest
from drivelint.drive.trace import IngestOptions
from drivelint.formats import expand_traces, read_trace
from drivelint.receipts.events import report_not_repeatable, report_searched_path
from drivelint.receipts.recorder import record_inputs
from tests.formats.argoverse2 import argoverse_log as av2
from tests.formats.d123 import files as d123
from tests.formats.sumo import fcd_text
from tests.receipts.opened_files import opened_below

if TYPE_CHECKING:
    from collections.abc import Callable

    from drivelint.receipts.inputs import RunInputs

NO_OUTPUTS = OutputPathTest(None)


def read_by(job: Callable[[], object], *named_paths: Path) -> RunInputs:
    with record_inputs(NO_OUTPUTS, named_paths) as recorder:
        job()
    inputs = recorder.end_recording_and_return_inputs()
    assert inputs is not None, recorder.trouble
    return inputs


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    for name in ("a/one.txt", "a/two.txt", "b/one.txt"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("old")
    return tmp_path


def _list_with_scandir(root: Path) -> None:
    with os.scandir(root / "a") as entries:
        list(entries)


READINGS: dict[str, Callable[[Path], object]] = {
    "open": lambda root: (root / "a/one.txt").open().close(),
    "os.open": lambda root: os.close(os.open(root / "a/one.txt", os.O_RDONLY)),
    "bytes": lambda root: os.close(os.open(os.fsencode(root / "a/one.txt"), os.O_RDONLY)),
}
LISTINGS: dict[str, Callable[[Path], object]] = {
    "scandir": _list_with_scandir,
    "iterdir": lambda root: list((root / "a").iterdir()),
    "Path.glob": lambda root: list((root / "a").glob("*.csv")),
    "glob": lambda root: glob(f"{root}/a/*.csv"),  # noqa: PTH207
    # of such a pattern no folder is listed in which the file is missing
    "glob below": lambda root: glob(f"{root}/*/new.csv"),  # noqa: PTH207
}


@pytest.mark.parametrize("how", READINGS)
def test_a_file_that_is_read_counts_with_its_content(tree: Path, how: str) -> None:
    file = tree / "a/one.txt"
    inputs = read_by(lambda: READINGS[how](tree))
    said = file.stat()
    file.write_text("new")
    os.utime(file, ns=(said.st_atime_ns, said.st_mtime_ns))
    assert (file.stat().st_size, file.stat().st_mtime_ns) == (said.st_size, said.st_mtime_ns)
    assert not inputs.are_unchanged(NO_OUTPUTS)
    file.write_text("old")
    assert inputs.are_unchanged(NO_OUTPUTS)
    file.unlink()
    assert not inputs.are_unchanged(NO_OUTPUTS)


@pytest.mark.parametrize("how", LISTINGS)
def test_a_folder_that_is_searched_counts_with_the_names_in_it(tree: Path, how: str) -> None:
    inputs = read_by(lambda: LISTINGS[how](tree))
    (tree / "a/two.txt").write_text("new")  # is not read
    assert inputs.are_unchanged(NO_OUTPUTS)
    (tree / "a/new.csv").write_text("")
    assert not inputs.are_unchanged(NO_OUTPUTS)


def _try_to_open(path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        path.open()


def test_a_file_that_is_missing_counts(tree: Path) -> None:
    for job in (lambda: report_searched_path(tree / "b/map"), lambda: _try_to_open(tree / "b/map")):
        inputs = read_by(job)
        (tree / "b/map").write_text("")
        assert not inputs.are_unchanged(NO_OUTPUTS)
        (tree / "b/map").unlink()
        assert inputs.are_unchanged(NO_OUTPUTS)
    inputs = read_by(lambda: None, tree / "b/map")
    (tree / "b/map").mkdir()
    assert not inputs.are_unchanged(NO_OUTPUTS)


def test_where_a_link_leads_to_counts(tree: Path) -> None:
    link = tree / "link"
    link.symlink_to(tree / "a/one.txt")
    inputs = read_by(link.read_text)
    link.unlink()
    link.symlink_to(tree / "b/one.txt")  # the same content, of another folder
    assert not inputs.are_unchanged(NO_OUTPUTS)


def test_what_changed_while_it_was_read_is_no_input(tree: Path) -> None:
    def reads_and_changes() -> None:
        (tree / "a/one.txt").read_text()
        (tree / "a/one.txt").write_text("new")

    with record_inputs(NO_OUTPUTS, []) as recorder:
        reads_and_changes()
    assert recorder.end_recording_and_return_inputs() is None


def test_a_pipe_cannot_be_looked_at_again(tree: Path) -> None:
    reads, writes = os.pipe()
    try:
        with record_inputs(NO_OUTPUTS, []) as recorder:
            os.close(os.open(f"/dev/fd/{reads}", os.O_RDONLY))
        assert recorder.end_recording_and_return_inputs() is None
    finally:
        os.close(reads)
        os.close(writes)


def test_what_depends_on_the_machine_is_not_of_its_inputs(tree: Path) -> None:
    with record_inputs(NO_OUTPUTS, []) as recorder:
        report_not_repeatable("a rule took too long")
    assert (recorder.end_recording_and_return_inputs(), recorder.trouble) == (None, "a rule took too long")


def test_what_a_run_writes_is_no_input(tree: Path) -> None:
    def writes() -> None:
        (tree / "a/mine").write_text("1")
        (tree / "a/mine").read_text()
        (tree / "a/mine").unlink()
        with tempfile.TemporaryDirectory(dir=tree) as folder:
            Path(folder, "x").write_text("1")
            list(Path(folder).iterdir())

    assert not [path for path in read_by(writes).states if path.startswith(str(tree))]


def test_nothing_is_recorded_afterwards(tree: Path) -> None:
    with record_inputs(NO_OUTPUTS, []) as recorder:
        pass
    (tree / "a/one.txt").read_text()
    inputs = recorder.end_recording_and_return_inputs()
    assert inputs is not None
    assert str(tree / "a/one.txt") not in inputs.states


def test_outputs_are_those_that_check_writes_into_its_folder(tmp_path: Path) -> None:
    for name in ("annotated/x.mcap", "earlier/verdicts.parquet", "earlier/annotated/x.mcap", "mixed/x"):
        (tmp_path / name).parent.mkdir(exist_ok=True, parents=True)
        (tmp_path / name).write_text("")
    is_output = OutputPathTest(tmp_path)
    names = (
        "summary.json",
        "report.html",
        "annotated/x.mcap",
        "annotated",
        "earlier",
        ".drivelint.work.1",
        "files.json",
    )
    assert all(is_output(str(tmp_path / name)) for name in names)
    assert not any(
        is_output(str(tmp_path / name)) for name in ("", "mixed", "log.mcap", "annotated/x.csv", "../x.mcap")
    )
    assert not is_output(str(tmp_path))
    (tmp_path / "earlier/log.mcap").write_text("")
    assert not is_output(str(tmp_path / "earlier"))
    assert not is_output(str(tmp_path / "earlier/log.mcap"))


def _sumo(folder: Path) -> None:
    folder.mkdir()
    (folder / "city.fcd.xml").write_text(fcd_text.xml())
    (folder / "city.rou.xml").write_text(fcd_text.TYPES)
    (folder / "city.tls.xml").write_text('<tlsStates><tlsState time="0.00" id="c" state="Gr"/></tlsStates>')


def _argoverse(folder: Path) -> None:
    av2.sensor_log(folder / "log", [av2.box(k) for k in range(12)], road=av2.road(av2.straight(1)))
    av2.scenario(folder / "scene", [*av2.track("AV", range(110)), *av2.track("1", range(110), y=4.0)])


def _d123(folder: Path) -> None:
    frames = [d123.Frame(t) for t in d123.times(20)]
    d123.write_log(folder / "logs/test-set_val/log", frames, d123.ego_states(20))
    _write_shared_map(folder)


def _write_shared_map(folder: Path) -> None:
    d123.write_map(folder / "maps/test-set/test-set_PIT.arrow", [d123.straight(1, 0.0, 100.0, 0.0)])


def _read_logs(folder: Path) -> None:
    for log in expand_traces([str(folder)]):
        read_trace(log, IngestOptions(ego="all"))


KINDS: dict[str, Callable[[Path], None]] = {"sumo": _sumo, "argoverse": _argoverse, "d123": _d123}


@pytest.mark.parametrize("kind", KINDS)
def test_every_file_that_a_reader_opens_is_known(tmp_path: Path, kind: str) -> None:
    """The kernel tells which files are opened, also those that a library opens behind Python's back."""
    root = tmp_path / "data"
    KINDS[kind](root)

    with opened_below(root) as paths:
        inputs = read_by(lambda: _read_logs(root / "logs" if kind == "d123" else root))
    assert len(paths) > 3
    assert paths <= inputs.states.keys()
    files = {str(path) for path in root.rglob("*") if path.is_file()}
    assert files <= paths, "each of these files counts: a reader that does not open it is not tried here"


def test_a_map_counts_that_a_log_looks_for_outside_of_its_folder(tmp_path: Path) -> None:
    _d123(tmp_path)
    shared = next(tmp_path.glob("maps/*/*"))
    shared.unlink()
    inputs = read_by(lambda: _read_logs(tmp_path / "logs"))
    assert inputs.are_unchanged(NO_OUTPUTS)
    _write_shared_map(tmp_path)
    assert not inputs.are_unchanged(NO_OUTPUTS)
