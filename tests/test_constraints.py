"""Image, action and tests install the versions of `.ci/constraints.txt`, which has all that drivelint needs on every supported Python."""

from __future__ import annotations

import re
import shutil
import subprocess
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from tests.installed import installed
from tests.shared_data import ROOT

FILE = ".ci/constraints.txt"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
PYTHONS = sorted(each.rpartition(" ")[2] for each in PROJECT["classifiers"] if re.search(r"Python :: 3\.\d+$", each))


def constraints(python: str) -> dict[str, str]:
    """Return name -> version for a Python on Linux."""
    lines = (ROOT / FILE).read_text(encoding="utf-8").splitlines()
    wanted = [Requirement(line) for line in lines if not line.startswith("#")]
    here = {"python_version": python, "python_full_version": f"{python}.0"}
    of_it = [each for each in wanted if each.marker is None or each.marker.evaluate(here)]
    assert all(re.fullmatch(r"==[^,*]+", str(each.specifier)) for each in of_it)
    found = {str(canonicalize_name(each.name)): str(each.specifier)[2:] for each in of_it}
    assert len(found) == len(of_it), "a name stands there twice"
    return found


@pytest.mark.parametrize("python", PYTHONS)
def test_the_versions_are_those_that_pyproject_allows(python: str) -> None:
    versions = constraints(python)
    wanted = [Requirement(each) for each in PROJECT["dependencies"]]
    assert [str(each) for each in wanted if not each.specifier.contains(versions[canonicalize_name(each.name)])] == []


def test_all_that_is_installed_for_users_has_a_version() -> None:
    versions = constraints(PYTHONS[0]) | constraints(PYTHONS[-1])
    extras = ("dask", "delta", "lanelet2", "live", "timestamp")
    assert sorted(installed(extras).keys() - versions.keys()) == []


@pytest.mark.parametrize("file", ["README.md", "CONTRIBUTING.md", ".ci/Dockerfile", ".github/action/action.yml"])
def test_who_installs_drivelint_takes_them(file: str) -> None:
    text = (ROOT / file).read_text(encoding="utf-8")
    assert re.search(r"pip [^\n]*install [^\n]*-c [^\n]*\.ci/constraints\.txt", text)


@pytest.mark.slow
@pytest.mark.timeout(1200)
@pytest.mark.parametrize("python", PYTHONS)
def test_they_install_together_and_drivelint_runs_with_them(python: str, tmp_path: Path) -> None:
    program = shutil.which(f"python{python}")
    if program is None or subprocess.run([program, "--version"], check=False, capture_output=True).returncode:
        pytest.skip(f"python{python} is not installed")
    subprocess.run([program, "-m", "venv", tmp_path / "venv"], check=True)
    pip = [str(tmp_path / "venv" / "bin" / "python"), "-m", "pip", "-q", "--disable-pip-version-check"]
    done = subprocess.run([*pip, "install", "-c", FILE, "."], cwd=ROOT, check=False, capture_output=True, text=True)
    if "No matching distribution" in done.stderr or "ConnectionError" in done.stderr:
        pytest.skip("the package index cannot be reached")
    assert done.returncode == 0, done.stderr
    tool = tmp_path / "venv" / "bin" / "drivelint"
    subprocess.run([tool, "demo", "--out", tmp_path / "demo"], check=True)
    road = ("--map", tmp_path / "demo" / "road.xodr")
    assert subprocess.run([tool, "check", tmp_path / "demo" / "safe.mcap", *road], check=False).returncode == 0
