"""The sources of another commit in a temporary folder, and a Python that has what they depend on."""

from __future__ import annotations

import io
import os
import subprocess
import sys
import tarfile
import tomllib
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from packaging.requirements import Requirement

from tests.bench.table import Skipped
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from collections.abc import Sequence


class UnknownCommitError(Exception):
    """The history has no such commit."""


class Tree(NamedTuple):
    """Sources and the Python that runs them. `differs`: dependencies that the present environment does not have as asked."""

    name: str
    source: Path
    python: Path
    differs: tuple[str, ...] = ()


def present() -> Tree:
    """Return the tree that this module belongs to. Errors: `Skipped` if there is no git history."""
    return Tree(_git("describe", "--always", "--dirty", "--exclude=*").decode().strip(), ROOT / "src", _python())


def unpacked(commit: str, home: Path) -> Tree:
    """Return the tree of a commit, unpacked under `home`, with an environment of its own if its dependencies differ.

    Errors: `Skipped` if there is no git history; `UnknownCommitError`.
    """
    _history()
    try:
        name = _git("rev-parse", "--short", "--verify", f"{commit}^{{commit}}").decode().strip()
    except subprocess.CalledProcessError as error:
        raise UnknownCommitError(f"no commit {commit!r} in {ROOT}") from error
    folder = home / "tree"
    with tarfile.open(fileobj=io.BytesIO(_git("archive", "--format=tar", name))) as archive:
        archive.extractall(folder, filter="data")
    requirements = dependencies(folder / "pyproject.toml")
    differs = unmet(requirements)
    python = _environment(home / "venv", requirements, differs) if differs else _python()
    return Tree(name, folder / "src", python, tuple(differs))


def dependencies(pyproject: Path) -> list[str]:
    """Return what a project depends on, without its extras."""
    found: list[str] = tomllib.loads(pyproject.read_text(encoding="utf-8"))["project"]["dependencies"]
    return found


def unmet(requirements: Sequence[str]) -> list[str]:
    """Return the requirements that the present environment does not meet."""
    return [each for each in requirements if not _met(Requirement(each))]


def _met(requirement: Requirement) -> bool:
    if requirement.marker and not requirement.marker.evaluate():
        return True
    try:
        return requirement.specifier.contains(version(requirement.name), prereleases=True)
    except PackageNotFoundError:
        return False


def _environment(folder: Path, requirements: Sequence[str], differs: Sequence[str]) -> Path:
    """Install what a commit depends on; all that does not differ has the version of the present environment."""
    same = [Requirement(each) for each in requirements if each not in differs]
    # a newer pyarrow beside an older duckdb would be measured as a change of ours
    pins = [f"{each.name}=={version(each.name)}" for each in same if not each.marker or each.marker.evaluate()]
    subprocess.run([sys.executable, "-m", "venv", folder], check=True)
    python = folder / "bin" / "python"
    subprocess.run([python, "-m", "pip", "install", "-q", *differs, *pins], check=True)
    return python


def _python() -> Path:
    return Path(sys.executable)


def _history() -> None:
    try:
        top = _git("rev-parse", "--show-toplevel").decode().strip()
    except FileNotFoundError as error:
        raise Skipped("no git") from error
    except subprocess.CalledProcessError as error:
        raise Skipped(f"no git history at {ROOT}: {error.stderr.decode().strip()}") from error
    if Path(top).resolve() != ROOT:  # unpacked inside another repository
        raise Skipped(f"no git history at {ROOT}: it lies in the repository {top}")


def _git(*arguments: str) -> bytes:
    # in a hook, git's own variables name the repository that is committed to
    env = {key: value for key, value in os.environ.items() if key not in {"GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE"}}
    return subprocess.run(["git", "-C", ROOT, *arguments], check=True, capture_output=True, env=env).stdout
