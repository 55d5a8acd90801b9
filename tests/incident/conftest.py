"""The overtake fixture, checked once by the Highway Code, and the cases of its findings, each judged once."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import TYPE_CHECKING

import pytest

from drivelint.incident import IncidentRequest, judge_parties_again
from tests.explain.overtake_check import check

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.incident.case import Case

CaseOf = Callable[[str], "Case"]


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("incidents")
    check(out, rules=("ukhc", "ukhc.r112.horn", "ukhc.r113.headlights"), params=())
    return out


@pytest.fixture(scope="session")
def case_of(folder: Path) -> CaseOf:
    return cache(lambda name: judge_parties_again(IncidentRequest(name, folder)))
