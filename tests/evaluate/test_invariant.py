"""Invariants: truth tables with tiny scenes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import pytest

from tests.evaluate.packs import HOLDS, INVARIANT, MEASURE, brief, verdicts, write

if TYPE_CHECKING:
    from pathlib import Path

SPEED = {"reads": '["ego_state"]'}
SPEED_SQL = "SELECT drive_id, ego_id, t_ns, speed_mps AS observed, 10 AS required FROM ego_state"


def speeds(values: list[Any], **more: Any) -> dict[str, Any]:
    return {
        "ego_state": {
            "t_s": [i / 10 for i in range(len(values))],
            "speed_mps": values,
            "x_m": list(range(len(values))),
            **more,
        }
    }


@pytest.mark.parametrize(
    ("sense", "value", "verdict"),
    [
        *((">", 10.0, "fail"), (">=", 10.0, "pass"), ("<", 10.0, "fail"), ("<=", 10.0, "pass")),
        *((">", 10.001, "pass"), ("<", 9.999, "pass")),
        *((">", 9.0, "fail"), (">=", 9.0, "fail"), ("<", 11.0, "fail"), ("<=", 11.0, "fail")),
    ],
)
def test_the_operator_decides_and_equality_fails_a_strict_one(
    tmp_path: Path, sense: str, value: float, verdict: str
) -> None:
    rule = write(tmp_path, INVARIANT | {"sense": f'"{sense}"', "unit": '"m/s"'} | SPEED, {"condition": SPEED_SQL})
    (row,) = verdicts(rule, speeds([value] * 3))
    assert row["verdict"] == verdict
    assert row["margin"] == pytest.approx((value - 10) if sense[0] == ">" else (10 - value))
    assert (row["n_expected"], row["n_judged"]) == (3, 3)


@pytest.mark.parametrize(
    ("values", "expected", "worst_s", "n_judged"),
    [
        ([12, 11, 13], ("pass", "kept"), 0.1, 3),
        ([12, 9, 8, 8], ("fail", "violated"), 0.2, 4),
        ([12, None, 13], ("unknown", "null_value"), 0.0, 2),
        ([12, None, 9], ("fail", "violated"), 0.2, 2),
        ([None, None], ("unknown", "null_value"), 0.0, 0),
        ([12, math.nan, 12], ("unknown", "null_value"), 0.0, 2),
        ([math.inf, 12], ("pass", "kept"), 0.1, 2),
        ([math.inf, math.inf], ("pass", "kept"), 0.0, 2),
        ([12, -math.inf], ("fail", "violated"), 0.1, 2),
    ],
)
def test_always(tmp_path: Path, values: list[Any], expected: tuple[str, str], worst_s: float, n_judged: int) -> None:
    rule = write(tmp_path, INVARIANT | MEASURE | SPEED, {"condition": SPEED_SQL})
    (row,) = verdicts(rule, speeds(values))
    assert brief([row]) == [expected]
    assert (row["t_worst_ns"], row["n_expected"], row["n_judged"]) == (round(worst_s * 1e9), len(values), n_judged)
    assert row["x_m"] == round(worst_s * 10)
    for column in ("observed", "required", "margin"):
        assert row[column] is None or math.isfinite(row[column])


@pytest.mark.parametrize(
    ("sense", "column", "verdict"),
    [
        ("<=", "observed", "unknown"),
        (">=", "required", "unknown"),
        (">=", "observed", "fail"),
        ("<=", "required", "fail"),
    ],
)
def test_negative_infinity_keeps_nothing(tmp_path: Path, sense: str, column: str, verdict: str) -> None:
    """It is no measure: where nothing was measured, a rule of an upper limit would pass."""
    values = {"observed": "1.0", "required": "1.0", column: "'-inf'::DOUBLE + 0 * speed_mps"}
    sql = f"SELECT drive_id, ego_id, t_ns, {values['observed']} AS observed, {values['required']} AS required FROM ego_state"
    rule = write(tmp_path, INVARIANT | {"sense": f'"{sense}"', "unit": '"m/s"'} | SPEED, {"condition": sql})
    (row,) = verdicts(rule, speeds([1.0, 1.0]))
    assert row["verdict"] == verdict


@pytest.mark.parametrize(
    ("values", "expected", "worst_s"),
    [
        (["left", "left"], ("pass", "kept"), 0.0),
        (["left", "off", "off"], ("fail", "violated"), 0.1),
        (["left", None, "off"], ("fail", "violated"), 0.2),
        (["left", None, "left", None], ("unknown", "null_value"), 0.1),
    ],
)
def test_holds_takes_the_earliest_deciding_step(
    tmp_path: Path, values: list[Any], expected: tuple[str, str], worst_s: float
) -> None:
    sql = "SELECT drive_id, ego_id, t_ns, indicator = 'left' AS holds FROM ego_state"
    rule = write(tmp_path, INVARIANT | HOLDS | SPEED, {"condition": sql})
    (row,) = verdicts(rule, {"ego_state": {"t_s": [i / 10 for i in range(len(values))], "indicator": values}})
    assert brief([row]) == [expected]
    assert (row["t_worst_ns"], row["margin"]) == (round(worst_s * 1e9), None)


@pytest.mark.parametrize(
    ("sense", "value", "bound", "expected"),
    [
        (">", 12, True, ("pass", "kept")),
        (">", 9, True, ("unknown", "only_a_bound")),
        (">", 9, False, ("fail", "violated")),
        (">", 9, None, ("unknown", "only_a_bound")),
        (">=", 10, True, ("pass", "kept")),
        ("<", 12, True, ("fail", "violated")),
        ("<", 9, True, ("unknown", "only_a_bound")),
        ("<", 9, False, ("pass", "kept")),
        ("<=", 10, True, ("unknown", "only_a_bound")),
        (">", None, True, ("unknown", "null_value")),
    ],
)
def test_a_lower_bound_proves_what_it_can(
    tmp_path: Path, sense: str, value: Any, bound: Any, expected: tuple[str, str]
) -> None:
    sql = SPEED_SQL.replace(" FROM", ", with_direction AS at_least FROM")
    rule = write(tmp_path, INVARIANT | {"sense": f'"{sense}"', "unit": '"m/s"'} | SPEED, {"condition": sql})
    (row,) = verdicts(rule, speeds([value], with_direction=bound))
    assert brief([row]) == [expected]
    assert (row["margin"] is None) == (row["verdict"] == "unknown")


@pytest.mark.parametrize(
    ("applies", "expected"),
    [
        ([True, True, True], [("pass", "kept", 3)]),
        ([False, False, False], [("not_applicable", "not_triggered", 0)]),
        ([True, None, True], [("unknown", "applies_unknown", 3)]),
        ([False, True, True], [("fail", "violated", 2)]),
    ],
)
@pytest.mark.parametrize("own_grid", [False, True])
def test_applies_is_three_valued(
    tmp_path: Path, applies: list[Any], expected: list[tuple[str, str, int]], own_grid: bool
) -> None:
    values = [5, 12, 5] if expected[0][0] == "fail" else [12 if a is not False else 5 for a in applies]
    if own_grid:
        sections = {
            "applies": "SELECT drive_id, ego_id, t_ns, in_junction AS applies FROM ego_state",
            "condition": SPEED_SQL,
        }
    else:
        sections = {"condition": SPEED_SQL.replace(" FROM", ", in_junction AS applies FROM")}
    rule = write(tmp_path, INVARIANT | MEASURE | SPEED, sections)
    rows = verdicts(rule, speeds(values, in_junction=applies))
    assert [(r["verdict"], r["reason_code"], r["n_expected"]) for r in rows] == expected
