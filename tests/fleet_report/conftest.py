"""Audits for the tests: real ones of small generated fleets, and generated tables of a larger one."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import pytest

from tests.audit import fleet
from tests.audit.here import run_audit
from tests.fleet_report import lake

if TYPE_CHECKING:
    from pathlib import Path

N_DRIVES = 24


class Audited(NamedTuple):
    """Two fleets on one road, and their audits."""

    base: Path
    new: Path
    base_fleet: fleet.Fleet
    new_fleet: fleet.Fleet


@pytest.fixture(scope="session")
def audited(tmp_path_factory: pytest.TempPathFactory) -> Audited:
    home = tmp_path_factory.mktemp("audits")
    fleets = [fleet.write(home / f"fleet-{seed}", N_DRIVES, seed) for seed in (0, 1)]
    outs = [home / "base", home / "new"]
    for drives, out in zip(fleets, outs, strict=True):
        run_audit(drives, out)
    return Audited(outs[0], outs[1], fleets[0], fleets[1])


@pytest.fixture(scope="session")
def filled(tmp_path_factory: pytest.TempPathFactory) -> lake.Lake:
    """Return an audit with findings of many rules, unknown verdicts, tags, places, and drives that were not judged."""
    return lake.write(tmp_path_factory.mktemp("lake") / "audit", 1_200)
