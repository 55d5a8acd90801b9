"""The table of faults is whole, and every test that it names exists."""

from __future__ import annotations

import ast
from functools import cache
from typing import Any, Final

import pytest
import yaml

from tests.faults.bad_logs import BAD_LOGS
from tests.shared_data import ROOT

FAULTS: Final = yaml.safe_load((ROOT / "tests" / "faults" / "table.yml").read_text(encoding="utf-8"))
HERE: Final = "tests/faults/test_bad_logs.py::test_a_bad_log"


@cache
def functions(file: str) -> set[str]:
    tree = ast.parse((ROOT / file).read_text(encoding="utf-8"))
    return {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}


def test_every_fault_stands_in_it_once() -> None:
    assert [fault["number"] for fault in FAULTS] == list(range(1, 41))


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: str(fault["number"]))
def test_a_test_holds_it(fault: dict[str, Any]) -> None:
    assert fault.keys() == {"number", "what", "formats", "exit_codes", "tells", "shown"}
    assert fault["shown"]
    for place in fault["shown"]:
        file, _, name = place.partition("::")
        assert name.startswith("test_")
        assert name in functions(file), place
    mine = [bad for bad in BAD_LOGS if bad.fault == fault["number"]]
    assert bool(mine) == (HERE in fault["shown"])
    assert {bad.exit_code for bad in mine} <= set(fault["exit_codes"])
