"""A small fleet and the digest of its audit on this machine, for modules that audit it elsewhere and say its size as `N_DRIVES`."""

from __future__ import annotations

import pytest

from tests.audit import fleet
from tests.audit.here import run_audit


@pytest.fixture(scope="module")
def drives(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> fleet.Fleet:
    """Return a fleet of `N_DRIVES` drives."""
    return fleet.write(tmp_path_factory.mktemp("fleet"), request.module.N_DRIVES)


@pytest.fixture(scope="module")
def digest(drives: fleet.Fleet, tmp_path_factory: pytest.TempPathFactory) -> str | None:
    """Return the digest of the fleet's audit in one process."""
    return run_audit(drives, tmp_path_factory.mktemp("local") / "out").digest
