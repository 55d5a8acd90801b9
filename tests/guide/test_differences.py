"""Every difference that the guide tells of has a version, or is of ours alone, and a test that names it."""

from __future__ import annotations

import re

import pytest

from drivelint import guide
from tests.shared_data import ROOT

HEADS = ["quantity", "drivelint", "the other tool", "why", "tested by"]
ROWS = [
    [cell.strip() for cell in re.split(r"(?<!\\)\|", line.strip("|"))]
    for line in guide.text("differences").splitlines()
    if line.startswith("|") and not line.startswith("|---")
]
OF_A_TOOL = re.compile(r"^(?P<tool>[\w-]+)(?: (?P<version>\d+(?:\.\d+)+))?")
NO_TOOLS = {"the"}
"""The chord is no other tool's."""


def test_every_row_has_all_columns_and_a_reason() -> None:
    assert ROWS.count(HEADS) == 4
    assert len(ROWS) - 4 >= 26
    assert [row for row in ROWS if len(row) != len(HEADS) or not all(row)] == []


@pytest.mark.parametrize("row", [row for row in ROWS if row != HEADS], ids=lambda row: row[0])
def test_the_test_of_a_row_names_tool_and_version(row: list[str]) -> None:
    found = OF_A_TOOL.match(row[2])
    assert found is not None
    path = ROOT / row[4].strip("`")
    assert path.exists()
    if found["tool"] in NO_TOOLS:
        return
    assert found["version"], "a difference without a version cannot be looked up"
    text = path.read_text(encoding="utf-8").lower()
    names = {found["tool"].lower(), found["tool"].lower().removeprefix("asam-").replace("-", "_")}
    assert any(name in text for name in names)
    assert found["version"] in text
