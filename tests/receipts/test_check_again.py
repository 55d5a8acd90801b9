"""A second `check` of the same inputs writes and prints the same without judging; whatever counts and changes is judged anew."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import pytest

from drivelint import demo, run
from drivelint.cli import main
from drivelint.errors import ExitCode
from drivelint.formats import expand_traces
from drivelint.receipts import program, store
from drivelint.receipts.events import report_not_repeatable
from drivelint.report.outputs import write
from drivelint.resources import folder
from drivelint.result.request import RunRequest
from tests.report.synthetic import drive, result, verdict
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from contextlib import AbstractContextManager

    from drivelint.engine.interruption import Interruption
    from drivelint.result.model import Result

pytestmark = pytest.mark.ci

RULE = "ukhc/r162.safe-distance-ahead.sql"
WAIVER = '[[waiver]]\nrule = "{}"\nreason = "ticket 17"\nowner = "jo"\nexpires = 2099-03-31\n'
ARGUMENTS = (
    *("check", "logs", "--map", "road.xodr", "--rules-dir", "rules", "--rules", "mine", "--mapping", "columns.toml"),
    *("--baseline", "before", "--waivers", "waivers.toml", "--today", "2026-11-29", "--no-robustness", "--margins"),
    *("--out", "out", "--cache"),
)


class JudgedAnew(BaseException):
    """What `run.check` raises where it must not be called."""


class Ran(NamedTuple):
    exit_code: int
    stdout: str
    stderr: str


def files(out: Path) -> dict[str, bytes]:
    return {path.relative_to(out).as_posix(): path.read_bytes() for path in out.rglob("*") if path.is_file()}


def drivelint(*args: str) -> Ran:
    """Run the command line in this process."""
    with pytest.MonkeyPatch.context() as patch, _captured() as streams:
        patch.setattr(sys, "argv", ["drivelint", *args])
        with pytest.raises(SystemExit) as ended:
            main()
    return Ran(int(str(ended.value.code)), *(stream.read_text(encoding="utf-8") for stream in streams))


@contextmanager
def _captured() -> Iterator[tuple[Path, Path]]:
    home = Path(os.environ["DRIVELINT_TEST_STREAMS"])
    places = (home / "stdout", home / "stderr")
    with (
        pytest.MonkeyPatch.context() as patch,
        places[0].open("w", encoding="utf-8") as out,
        places[1].open("w", encoding="utf-8") as err,
    ):
        patch.setattr(sys, "stdout", out)
        patch.setattr(sys, "stderr", err)
        yield places


def is_judged_anew(*args: str) -> bool:
    """Whether a check is judged, or refused before that; it is not judged here."""

    def judges(*_: object) -> None:
        raise JudgedAnew

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(run, "check", judges)
        try:
            ran = drivelint(*args)
        except JudgedAnew:
            return True
    assert ("nothing has changed" in ran.stderr) is (ran.exit_code != ExitCode.USAGE)
    return ran.exit_code == ExitCode.USAGE


@contextmanager
def _environment_readings() -> Iterator[set[str]]:
    """Yield a set that gets the names of the variables that are looked at inside the block."""
    names: set[str] = set()
    get = os._Environ.__getitem__

    def noted(self: os._Environ[str], name: str) -> str:
        names.add(name)
        return get(self, name)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os._Environ, "__getitem__", noted)
        yield names


@pytest.fixture(scope="module")
def first(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Ran]:
    """Return the first run; its folder is the working folder, whatever it was given is there."""
    home = tmp_path_factory.mktemp("again")
    work = home / "work"
    logs = {path.name: path for path in demo.write(home / "demo")}
    (work / "logs").mkdir(parents=True)
    shutil.copy(logs["near-miss.mcap"], work / "logs")
    shutil.copy(logs["road.xodr"], work)
    (work / "rules" / "mine").mkdir(parents=True)
    shutil.copy(folder("queries") / "assertions" / RULE, work / "rules" / "mine" / "distance.sql")
    (work / "columns.toml").write_text("[columns]\n")
    (work / "waivers.toml").write_text(WAIVER.format("ukhc.*"))
    (work / "drivelint.toml").write_text('fail-on = "never"\n')
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(store, "cache_folder", lambda: home / "cache")
        patch.setenv("DRIVELINT_TEST_STREAMS", str(home))
        patch.chdir(work)
        write(result([verdict("pass")]), Path("before"))
        with _environment_readings() as variables:
            ran = drivelint(*ARGUMENTS)
        (home / "variables.json").write_text(json.dumps(sorted(variables)))
        assert len(list((home / "cache" / "receipts").iterdir())) == 1
        shutil.copytree("out", home / "out")
        yield ran


@pytest.fixture
def receipt(first: Ran) -> Iterator[Path]:
    """Return the file of the receipt, which is afterwards as it was."""
    folder_ = store._receipts_folder()
    assert folder_ is not None
    (file,) = folder_.iterdir()
    whole = file.read_bytes()
    yield file
    file.write_bytes(whole)


def test_the_second_run_writes_and_prints_the_same(first: Ran, tmp_path: Path) -> None:
    expected = files(Path("../out"))
    assert {
        "report.html",
        "margins.parquet",
        "gate.json",
        "files.json",
        "annotated/near-miss-e888ec04.mcap",
    } <= expected.keys()
    for before in (lambda: None, lambda: shutil.rmtree("out"), lambda: Path("out/report.html").write_text("changed")):
        before()
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(run, "check", lambda *_: pytest.fail("is judged"))
            again = drivelint(*ARGUMENTS)
        assert (again.exit_code, again.stdout) == (first.exit_code, first.stdout)
        assert files(Path("out")) == expected
        told = again.stderr.splitlines()
        assert (
            told[-1]
            == "drivelint: nothing has changed since an earlier run: these are its verdicts (--no-cache judges again)"
        )
        assert told[:-1] == first.stderr.splitlines()
    assert drivelint(*ARGUMENTS, "--quiet") == (first.exit_code, first.stdout, "")


def test_a_folder_with_files_of_somebody_else_is_refused_as_ever(first: Ran) -> None:
    Path("out/report.md").write_text("mine")
    try:
        refused = drivelint(*ARGUMENTS)
        assert (refused.exit_code, refused.stdout) == (2, "")
        assert "report.md" in refused.stderr
        assert Path("out/report.md").read_text() == "mine"
    finally:
        Path("out/report.md").unlink()


@contextmanager
def change_file(name: str, change: Callable[[bytes], bytes]) -> Iterator[None]:
    """Change a file, and give it the size and the time that it had where it can have them."""
    path = Path(name)
    before, times = path.read_bytes(), path.stat()
    path.write_bytes(change(before))
    os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))
    try:
        yield
    finally:
        path.write_bytes(before)


@contextmanager
def add_file(name: str, content: str = "") -> Iterator[None]:
    assert not Path(name).exists()
    Path(name).parent.mkdir(exist_ok=True)
    Path(name).write_text(content)
    try:
        yield
    finally:
        Path(name).unlink()


@contextmanager
def move_file_away(name: str) -> Iterator[None]:
    path = Path(name)
    path.rename(path.with_name(f"{path.name}.away"))
    try:
        yield
    finally:
        path.with_name(f"{path.name}.away").rename(path)


@contextmanager
def in_environment(name: str, value: str) -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(name, value)
        yield


@contextmanager
def another_program() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(program, "program_sha256", lambda: "another")
        yield


def flip_last(content: bytes) -> bytes:
    return content[:-1] + bytes([content[-1] ^ 1])


CHANGES: dict[str, Callable[[], AbstractContextManager[None]]] = {
    "a byte of a log": lambda: change_file("logs/near-miss.mcap", flip_last),
    "one more log": lambda: add_file("logs/more.csv", "x"),
    "a log less": lambda: move_file_away("logs/near-miss.mcap"),
    "the map": lambda: change_file("road.xodr", lambda content: content.replace(b"road", b"Road", 1)),
    "the mapping": lambda: change_file("columns.toml", lambda _: b"[COLUMNS]\n"),
    "a rule": lambda: change_file("rules/mine/distance.sql", lambda content: content + b"-- note\n"),
    "one more rule": lambda: add_file("rules/mine/more.sql"),
    "words of a pack": lambda: add_file("rules/mine/pack.toml", 'title = "Mine"\n'),
    "the baseline": lambda: change_file("before/findings.parquet", flip_last),
    "one more file of the baseline": lambda: add_file("before/.drivelint.work.1"),
    "waivers": lambda: change_file("waivers.toml", lambda content: content.replace(b"17", b"18")),
    "settings": lambda: change_file("drivelint.toml", lambda content: content + b"strict = true\n"),
    "waivers in settings": lambda: change_file("drivelint.toml", lambda c: c + WAIVER.format("mine.*").encode()),
    "no settings": lambda: move_file_away("drivelint.toml"),
    "time zone": lambda: in_environment("TZ", "Asia/Tokyo"),
    "width": lambda: in_environment("COLUMNS", "77"),
    "program": another_program,
    "rules that cannot be stopped": lambda: in_environment("DRIVELINT_DEAF_RULES", "{}"),
}


@pytest.mark.parametrize("change", CHANGES)
def test_what_changes_is_judged_anew(first: Ran, change: str) -> None:
    with CHANGES[change]():
        assert is_judged_anew(*ARGUMENTS)
    assert not is_judged_anew(*ARGUMENTS)


@pytest.mark.parametrize(
    "more",
    [
        ("--strict",), ("--rule-timeout", "29"), ("--format", "json"), ("--verbose",), ("--no-annotate",),
        ("--param", "mine.distance.near_margin=3"), ("--env", "weather=wet"), ("--today", "2026-11-30"), ("--ego", "all"),
        ("--no-cache",), ("--keep-db",), ("--evidence", "pack"), ("--out", "other"),
    ],
    ids=" ".join,
)  # fmt: skip
def test_another_question_is_judged(first: Ran, more: tuple[str, ...]) -> None:
    try:
        assert is_judged_anew(*ARGUMENTS, *more)
    finally:
        shutil.rmtree("other", ignore_errors=True)


def test_every_variable_of_the_environment_counts_that_a_run_looks_at(first: Ran) -> None:
    """But those that say where files of the run itself lie, what counts as an option, and those of shells' completion."""
    looked_at = set(json.loads(Path("../variables.json").read_text()))
    assert {"COLUMNS", "TERM"} <= looked_at
    of_folders = {"TMPDIR", "TEMP", "TMP", "HOME", "XDG_CACHE_HOME", "DRIVELINT_CACHE_DIR"}
    answered = {"DRIVELINT_CHECK_CACHE", "DRIVELINT_DEAF_RULES"}
    others = {name for name in looked_at if name.startswith(("DRIVELINT_TEST_", "PYTEST_")) or "_COMPLETE" in name}
    assert looked_at - of_folders - answered - others <= set(program.ENVIRONMENT_VARIABLES)


def test_the_day_counts_only_where_there_are_waivers(first: Ran, receipt: Path) -> None:
    head = json.loads(receipt.read_bytes().partition(b"\n")[0])
    assert head["day"] == "2026-11-29"


def test_a_file_beside_the_inputs_does_not_count(first: Ran) -> None:
    with add_file("notes.txt"), change_file("logs/near-miss.mcap", lambda content: content):
        assert not is_judged_anew(*ARGUMENTS)


def test_a_damaged_receipt_is_judged_anew(first: Ran, receipt: Path) -> None:
    whole = receipt.read_bytes()
    for damaged in (
        b"",
        whole[:-1],
        whole[: len(whole) // 2],
        flip_last(whole),
        whole.replace(b"near-miss", b"near-Miss", 1),
    ):
        receipt.write_bytes(damaged)
        assert is_judged_anew(*ARGUMENTS)
    receipt.write_bytes(whole)
    assert not is_judged_anew(*ARGUMENTS)


RESULTS: dict[str, tuple[Result, bool]] = {
    "whole": (result([verdict("pass")]), True),
    "a drive was not judged": (result([verdict("pass")], drives=[drive(), drive("d2", status="not_judged")]), False),
    "a rule erred": (result([verdict("error")]), False),
    "interrupted": (result([verdict("pass")], interrupted=True), False),
    "only its copies were interrupted": (result([verdict("pass")]), False),
    "a rule took too long for a copy": (result([verdict("pass")]), False),
    "its log is an output": (result([verdict("pass")]), False),
}


@pytest.mark.parametrize("case", RESULTS)
def test_only_a_run_is_kept_that_its_inputs_tell(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, case: str) -> None:
    judged, is_kept = RESULTS[case]
    log = "out/annotated/x.mcap" if case == "its log is an output" else "x.mcap"
    judged = replace(judged, run_options=RunRequest(traces={"d1": log}))

    def judges(_settings: object, _progress: object, interruption: Interruption, *_: object) -> Result:
        if case == "only its copies were interrupted":
            interruption.requested = True
        if case == "a rule took too long for a copy":
            report_not_repeatable("it took too long")
        return judged

    monkeypatch.setattr(run, "check", judges)
    monkeypatch.setattr(os, "_exit", sys.exit)  # an interrupted command waits for nothing
    monkeypatch.setattr(store, "cache_folder", lambda: tmp_path / "cache")
    monkeypatch.setenv("DRIVELINT_TEST_STREAMS", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    drivelint("check", "x.mcap", "--cache", "--out", "out")
    assert (tmp_path / "cache" / "receipts").exists() is is_kept


def test_logs_beside_the_results_are_found(first: Ran, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The folder of results lies among the logs: what `check` writes there is no input, what somebody else does is one."""

    def judges(settings: run.CheckOptions, *_: object) -> Result:
        logs = [log for log in expand_traces(settings.traces) if log.read_bytes()]
        assert settings.out is not None
        (settings.out / "annotated").mkdir()
        (settings.out / "annotated" / "d1.mcap").write_bytes(b"")
        return replace(judged, run_options=RunRequest(traces={"d1": str(logs[0])}))

    judged = result([verdict("pass")])
    monkeypatch.setattr(store, "cache_folder", lambda: tmp_path / "cache")
    monkeypatch.chdir(_copied(tmp_path / "beside"))
    args = ("check", ".", "--no-robustness", "--out", "results", "--cache")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(run, "check", judges)
        assert drivelint(*args).exit_code == 0
    assert not is_judged_anew(*args)
    with add_file("results/log.csv", "x"):
        assert is_judged_anew(*args)
    with add_file("results/annotated/log.csv", "x"):
        assert is_judged_anew(*args)
    assert not is_judged_anew(*args)
    inside = tuple("results/annotated" if each == "." else each for each in args)
    assert is_judged_anew(*inside)


def _copied(to: Path) -> Path:
    to.mkdir()
    shutil.copy("logs/near-miss.mcap", to)
    shutil.copy("road.xodr", to)
    return to


@pytest.mark.ci
def test_the_second_run_imports_nothing_heavy(first: Ran, tmp_path: Path) -> None:
    work = _copied(tmp_path / "work")
    command = (
        *("-m", "drivelint", "check", "near-miss.mcap", "--map", "road.xodr", "--rules", "ukhc.no-collision"),
        *("--no-robustness", "--cache", "--out", "out"),
    )
    env = {**os.environ, "PYTHONPATH": str(ROOT / "src")}
    ran = [
        subprocess.run(
            [sys.executable, *more, *command], cwd=work, env=env, capture_output=True, text=True, check=False
        )
        for more in ((), ("-X", "importtime"))
    ]
    assert "nothing has changed" in ran[1].stderr
    assert (ran[0].returncode, ran[0].stdout) == (ran[1].returncode, ran[1].stdout)
    imported = {line.rpartition("|")[2].strip() for line in ran[1].stderr.splitlines()}
    assert "drivelint.cli" in imported
    assert not imported & {"duckdb", "pyarrow", "polars", "numpy", "rich", "lxml", "jinja2", "scipy", "shapely"}
