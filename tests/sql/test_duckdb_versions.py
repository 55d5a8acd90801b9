"""DuckDB and its spatial extension are one pinned pair: where the pin stands, and whether there is a newer pair."""

from __future__ import annotations

import subprocess
import sys
import warnings
from importlib.metadata import version

import pytest
from packaging.version import Version

from tests.shared_data import ROOT

PAIR = ("duckdb", "duckdb-extension-spatial")


def released(name: str) -> set[Version]:
    """Return the versions that pip would install here."""
    command = [sys.executable, "-m", "pip", "index", "versions", name, "--disable-pip-version-check"]
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=120)
    told = [line for line in done.stdout.splitlines() if line.startswith("Available versions:")]
    if not told:
        pytest.skip("the package index cannot be reached: whether there is a newer DuckDB is not known")
    return {Version(each) for each in told[0].partition(":")[2].split(",")}


def test_only_the_project_file_names_the_version() -> None:
    pinned = version("duckdb")
    naming = [file for file in (ROOT / "src").rglob("*.py") if pinned in file.read_text(encoding="utf-8")]
    assert naming == []
    assert (ROOT / "pyproject.toml").read_text(encoding="utf-8").count(f"=={pinned}") == len(PAIR)


@pytest.mark.slow
def test_a_newer_pair_is_told() -> None:
    """A release of others is no fault of ours: it is told as a warning."""
    both = set.intersection(*(released(name) for name in PAIR))
    pinned = Version(version("duckdb"))
    assert pinned in both
    if max(both) > pinned:
        warnings.warn(
            f"both wheels of DuckDB {max(both)} are there: raise the pins, see the guide's architecture", stacklevel=1
        )
