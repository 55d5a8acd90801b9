"""What holds for every test."""

from __future__ import annotations

import os
import zlib
from collections import defaultdict
from typing import TYPE_CHECKING, Final

import pytest
from hypothesis import HealthCheck, settings

if TYPE_CHECKING:
    from collections.abc import Sequence

# how long an example takes says how busy the machine is, and nothing of the law
settings.register_profile("drivelint", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("drivelint")

# pytest-xdist sets the width of its terminal, which would be that of every command that a test runs
os.environ.pop("COLUMNS", None)
# hundreds of tests start a process: each would compile the package anew
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

SIDES: Final = {"lht": 0, "left": 0, "rht": 1, "right": 1}


@pytest.hookimpl(tryfirst=True)  # before those that are marked slow are left out
def pytest_collection_modifyitems(items: Sequence[pytest.Item]) -> None:
    """Mark one side of the road slow for each test of both: every run has half of them on the left, half on the right."""
    by_test: dict[tuple[str, str], list[tuple[pytest.Item, int]]] = defaultdict(list)
    for item in items:
        if isinstance(item, pytest.Function) and hasattr(item, "callspec"):
            side = SIDES.get(str(item.callspec.params.get("hand")))
            if side is not None:
                by_test[str(item.path), item.originalname].append((item, side))
    for (_, name), mine in by_test.items():
        if len({side for _, side in mine}) == 2:
            quick = zlib.crc32(name.encode()) % 2
            for item, side in mine:
                if side != quick:
                    item.add_marker(pytest.mark.slow)
