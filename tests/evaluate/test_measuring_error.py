"""What is missed by less than the error of a value, or than a recorder's sensors can tell, is unknown."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from tests.evaluate.packs import INVARIANT, MEASURE, brief, verdicts, write

if TYPE_CHECKING:
    from pathlib import Path

SQL = "SELECT drive_id, ego_id, t_ns, speed_mps AS observed, 10 AS required{more} FROM ego_state"
READS = {"reads": '["ego_state"]'}
PASS, FAIL, UNKNOWN = ("pass", "kept"), ("fail", "violated"), ("unknown", "within_error")


def scene(values: list[Any], sensors: float | None = None, **more: Any) -> dict[str, Any]:
    times = [i / 10 for i in range(len(values))]
    log = {"data_log": {"sensor_range_m": sensors, "sha256": "log"}} if sensors else {}
    return {"ego_state": {"t_s": times, "speed_mps": values, **more}} | log


@pytest.mark.parametrize(
    ("sense", "value", "error", "expected"),
    [
        (">=", 9.0, 1.5, UNKNOWN),
        (">=", 9.0, 1.0, UNKNOWN),
        (">=", 9.0, 0.9, FAIL),
        (">=", 9.0, None, FAIL),
        (">=", 10.0, 5.0, PASS),
        (">", 10.0, 0.0, FAIL),
        ("<=", 11.0, 1.5, UNKNOWN),
        ("<=", 11.0, 0.9, FAIL),
        ("<=", 9.0, 5.0, PASS),
    ],
)
def test_an_error_takes_back_a_miss_and_no_pass(
    tmp_path: Path, sense: str, value: float, error: float | None, expected: tuple[str, str]
) -> None:
    sql = SQL.format(more=", limit_mps AS error")
    rule = write(tmp_path, INVARIANT | {"sense": f'"{sense}"', "unit": '"m/s"'} | READS, {"condition": sql})
    (row,) = verdicts(rule, scene([value] * 3, limit_mps=error))
    assert brief([row]) == [expected]


@pytest.mark.parametrize(
    ("value", "sensor_outcome", "exact_outcome"), [(9.6, UNKNOWN, FAIL), (9.5, UNKNOWN, FAIL), (9.4, FAIL, FAIL)]
)
def test_what_sensors_saw_is_known_to_five_per_cent(
    tmp_path: Path, value: float, sensor_outcome: tuple[str, str], exact_outcome: tuple[str, str]
) -> None:
    """Ground truth is exact; a recorder that sees 50 m has measured."""
    rule = write(tmp_path, INVARIANT | MEASURE | READS, {"condition": SQL.format(more="")})
    assert brief(verdicts(rule, scene([value] * 3, sensors=50.0))) == [sensor_outcome]
    assert brief(verdicts(rule, scene([value] * 3))) == [exact_outcome]
    assert brief(verdicts(rule, scene([10.4] * 3, sensors=50.0))) == [PASS]


@pytest.mark.ci
@pytest.mark.parametrize(("unit", "value", "expected"), [("m", 0.95, UNKNOWN), ("m", 0.89, FAIL), ("s", 0.94, FAIL)])
def test_no_distance_is_known_better_than_to_a_decimetre(
    tmp_path: Path, unit: str, value: float, expected: tuple[str, str]
) -> None:
    sql = SQL.format(more="").replace("10 AS required", "1 AS required")
    rule = write(tmp_path, INVARIANT | {"sense": '">"', "unit": f'"{unit}"'} | READS, {"condition": sql})
    assert brief(verdicts(rule, scene([value], sensors=50.0))) == [expected]
    assert brief(verdicts(rule, scene([value]))) == [FAIL]
