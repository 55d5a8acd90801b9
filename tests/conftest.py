"""What holds for every test."""

from __future__ import annotations

import gc
import os
import re
import sys
import zlib
from collections import defaultdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import pytest
from hypothesis import HealthCheck, settings
from xdist.scheduler import LoadFileScheduling  # type: ignore[import-untyped]

from tests.shared_data import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Sequence

    from drivelint.result.model import Result

# how long an example takes says how busy the machine is, and nothing of the law; .ci/full asks for `thorough`
for profile, n in (("quick", 40), ("thorough", 200)):
    settings.register_profile(profile, max_examples=n, deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("quick")

# pytest-xdist sets the width of its terminal, which would be that of every command that a test runs
os.environ.pop("COLUMNS", None)
# hundreds of tests start a process: each would compile the package anew
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
# nor does a test read what other versions kept for the user
os.environ["DRIVELINT_CACHE_DIR"] = str(ROOT / ".pytest_cache" / "drivelint")
# nor is it answered by what an earlier version of the code came to
os.environ["DRIVELINT_CHECK_CACHE"] = "no"

SIDES: Final = {"lht": 0, "left": 0, "rht": 1, "right": 1}


TOGETHER: Final = {
    "tests/fleet_report": "fleet_report",
    "tests/hostile": "hostile",
    "tests/incident": "incident",
    "tests/pack": "pack",
    "tests/report": "report",
    "tests/result": "report",
}
"""Folder -> name of the files that share what takes long to make: one process runs them all."""
SAMPLE_SIZES: Final = {"tests/absence": (0, 1), "tests/derive": (0, 1), "tests/evaluate": (1, 1)}
"""Folder -> so many cases of each of its tests are quick, and so many more `ci`; others are slow, unless the test is marked `sample`."""
LATER: Final = ROOT / "tests" / "derive"
"""The folder of which no test is quick: the statements of each scene are planned anew, which takes seconds."""
QUICK: Final = "not ci and not slow"
WHOLLY_LATER: Final = re.compile(r"^pytestmark = \[?pytest\.mark\.(ci|slow)\b", re.MULTILINE)


@pytest.fixture(scope="session")
def overtakes(tmp_path_factory: pytest.TempPathFactory) -> Result:
    """Return the result of the fixture's overtakes, with copies and with evidence; nobody may alter it."""
    from tests.result import fixture_result

    return fixture_result.run(tmp_path_factory.mktemp("overtakes"))


@pytest.fixture
def ran(capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Callable[..., tuple[int, str, str]]:
    """Return a function that runs a command in this process (quicker) and returns exit code, stdout and stderr."""
    from drivelint import cli

    def run(*args: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["drivelint", *args])
        monkeypatch.setenv("COLUMNS", "120")
        with pytest.raises(SystemExit) as left:
            cli.main()
        out, err = capfd.readouterr()
        assert isinstance(left.value.code, int)
        assert "Traceback" not in err
        return left.value.code, out, err

    return run


class BySharing(LoadFileScheduling):  # type: ignore[misc]
    """Gives a worker whole files, and all that share fixtures."""

    def _split_scope(self, nodeid: str) -> str:
        path = nodeid.partition("::")[0]
        return TOGETHER.get(path.rpartition("/")[0], path)


@pytest.hookimpl(optionalhook=True)  # without pytest-xdist there is none
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> BySharing | None:
    """See `BySharing`."""
    return BySharing(config, log) if config.getvalue("dist") == "loadfile" else None


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Collect without looking for garbage: what is collected stays to the end, and to look through it takes a third of the time."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Leave files without a quick test out of the quick suite: each worker would compile and import them, only to run nothing of them."""
    if config.option.markexpr != QUICK or {*map(Path, config.args)} - {Path("tests"), ROOT, ROOT / "tests"}:
        return None
    if collection_path == LATER:
        return True
    is_test = collection_path.name.startswith("test_") and collection_path.suffix == ".py"
    return True if is_test and WHOLLY_LATER.search(collection_path.read_text(encoding="utf-8")) else None


@pytest.hookimpl(tryfirst=True)  # before those that are marked slow are left out
def pytest_collection_modifyitems(items: Sequence[pytest.Item]) -> None:
    """Mark what a quick run leaves out of tests with many cases.

    Of a test of both sides of the road one side is slow: every run has half of the tests on the left, half on the right. Of a test marked
    `sample(n, ci=m)` n cases are quick, m more are marked `ci`, and the others are slow.
    """
    by_test: dict[tuple[str, str], list[pytest.Function]] = defaultdict(list)
    for item in items:
        if item.path.is_relative_to(LATER):
            item.add_marker(pytest.mark.ci)
        if isinstance(item, pytest.Function) and hasattr(item, "callspec"):
            by_test[str(item.path), item.originalname].append(item)
    for (path, name), cases in by_test.items():
        sides = {id(case): SIDES.get(str(case.callspec.params.get("hand"))) for case in cases}
        quick, later = cases, list[pytest.Function]()
        if {0, 1} <= set(sides.values()):
            quick = [case for case in cases if sides[id(case)] in {None, zlib.crc32(name.encode()) % 2}]
        if sample := cases[0].get_closest_marker("sample"):
            quick, later = _parted(quick, sample.args[0], sample.kwargs.get("ci", 0))
        elif few := SAMPLE_SIZES.get(Path(path).parent.relative_to(ROOT).as_posix()):
            quick, later = _parted(quick, *few)
        for case in cases:
            if case not in quick:
                case.add_marker(pytest.mark.ci if case in later else pytest.mark.slow)


def _parted(cases: list[pytest.Function], n: int, more: int) -> tuple[list[pytest.Function], list[pytest.Function]]:
    """Return n of the cases, and others up to `more`: always the same ones, whatever their order."""
    ordered = sorted(cases, key=lambda case: zlib.crc32(case.name.encode()))
    return ordered[:n], ordered[n : n + more]
