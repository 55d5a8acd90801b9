"""Angles are wrapped in one place: `wrap_rad` in SQL (half turns: `box_turn_rad`), `arrays.wrap_angles` in Python.

In DuckDB 1.5.5 `fmod` has the sign of the divisor and `%` that of the dividend. In Python, numpy and C it is the other way round.
"""

from __future__ import annotations

import math
import re
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from drivelint.arrays import wrap_angles
from drivelint.resources import folder
from drivelint.sql import store
from tests.shared_data import ROOT

if TYPE_CHECKING:
    import duckdb

COMMENT = re.compile(r"--.*")
REMAINDER = re.compile(r"\b(?:f?mod|remainder)\s*\(", re.IGNORECASE)
PERCENT = re.compile(r"[\w)]\s*%(?!\s*(?:12|72)\b)")
"""Twelfths of a half turn and steps of 5 degrees are whole numbers, to which a turn is added first."""
FLOOR_OF_TURNS = re.compile(
    r"\b(?:floor|round|trunc|rint)\([^;\n]*?/ \(?(?:2(?:\.0)? \* )?(?:pi\(\)|np\.pi|math\.pi|math\.tau|tau)\)"
)
BY_SINE = re.compile(r"atan2?2?\(\s*(?:np\.|math\.)?sin\([^,]*\), (?:np\.|math\.)?cos\(")
PYTHON = re.compile(r"\b(?:np|math)\.(?:f?mod|remainder)\(|% \(?(?:2(?:\.0)? \* )?(?:np|math)\.(?:pi|tau)|% 360")
DEGREES = "road/geo_reference.py"
"""Two longitudes, in degrees, are compared."""


@cache
def database() -> duckdb.DuckDBPyConnection:
    return store.connect(threads=1)


angles = st.lists(st.floats(-1e4, 1e4), min_size=1, max_size=50)


def test_the_signs_of_remainders_in_this_duckdb() -> None:
    with store.open_without_creating_tables() as con:
        found = con.execute("SELECT fmod(-1.0, 3.0), -1.0 % 3.0, fmod(1.0, -3.0), 1.0 % -3.0, -1 % 3").fetchall()
    assert [tuple(map(float, row)) for row in found] == [(2.0, -1.0, -2.0, 1.0, -1.0)]
    assert (math.fmod(-1.0, 3.0), float(np.mod(-1.0, 3.0))) == (-1.0, 2.0)


@given(angles)
def test_a_wrapped_angle_is_the_same_direction(values: list[float]) -> None:
    rows = database().execute(
        "SELECT a, wrap_rad(a), box_turn_rad(a) FROM (SELECT unnest($a::DOUBLE[]) AS a)", {"a": values}
    )
    for angle, turn, half in rows.fetchall():
        assert -math.pi <= turn <= math.pi
        assert math.isclose(math.cos(turn - angle), 1.0, abs_tol=1e-9)
        assert -math.pi / 2 <= half <= math.pi / 2
        assert math.isclose(abs(math.cos(half - angle)), 1.0, abs_tol=1e-9)
    ours = wrap_angles(np.array(values))
    assert (np.abs(ours) <= np.pi).all()
    assert np.allclose(np.cos(ours - values), 1.0, atol=1e-9)


def test_no_statement_wraps_angles_itself() -> None:
    found = {}
    for path in folder("queries").rglob("*.sql"):
        lines = [COMMENT.sub("", line) for line in path.read_text(encoding="utf-8").splitlines()]
        found[path.stem] = [
            line for line in lines if any(p.search(line) for p in (REMAINDER, PERCENT, FLOOR_OF_TURNS, BY_SINE))
        ]
    assert len(found) > 100
    macros = [line.split("MACRO ")[1].split("(")[0] for line in found.pop("geometry")]
    assert sorted(macros) == ["box_turn_rad", "wrap_rad"]
    assert {name: lines for name, lines in found.items() if lines} == {}


def test_no_python_wraps_angles_itself() -> None:
    src = ROOT / "src" / "drivelint"
    patterns = (PYTHON, BY_SINE, re.compile(r"np\.round\(.*np\.pi"))
    found = {
        str(path.relative_to(src))
        for path in src.rglob("*.py")
        if any(pattern.search(path.read_text(encoding="utf-8")) for pattern in patterns)
    }
    assert found == {"arrays.py", DEGREES}
