"""From a folder to verdicts in one command: the map is found, what is not recorded is unknown, and nothing is a pass by not looking."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from drivelint.convert import ConvertRequest, convert
from drivelint.inspect import InspectRequest, inspect
from drivelint.report.progress import Silent
from drivelint.run import CheckOptions, check
from tests.formats.argoverse2.argoverse_log import box, drive, road, scenario, sensor_log, stamp, straight, track
from tests.formats.logs import read
from tests.shared_data import shared

if TYPE_CHECKING:
    from pathlib import Path

N = 60
COLLISION = "ukhc.no-collision"
STREET = road(
    straight(1, begin=-60.0, end=300.0, left_neighbor_id=2, left_lane_mark_type="DOUBLE_SOLID_YELLOW"),
    straight(2, 4.0, 300.0, -60.0, left_neighbor_id=1, left_lane_mark_type="DOUBLE_SOLID_YELLOW"),
)


def parked(x: float, **more: Any) -> list[dict[str, Any]]:
    """Return the boxes of a car that stands at x in the city, seen from a vehicle that passes by at 5 m/s."""
    return [box(k, "parked", x - 0.5 * k, **more) for k in range(N)]


def verdicts(path: Path, rule: str = COLLISION) -> set[tuple[str, str]]:
    """Return (verdict, reason code) of the rule."""
    result = check(CheckOptions((str(path),), rules=(rule,), robustness=False), Silent())
    return {(row["verdict"], row["reason_code"]) for row in result.verdicts.to_pylist()}


def test_a_collision_is_found(tmp_path: Path) -> None:
    """The vehicle drives from x = 0 to 29.5 along its lane into a car that stands there."""
    log = sensor_log(tmp_path / "log", parked(20.0), drive(N), STREET)
    assert "fail" in {verdict for verdict, _ in verdicts(log)}


@pytest.mark.ci
def test_a_car_that_is_not_placed_where_the_vehicle_hits_it_is_no_pass(tmp_path: Path) -> None:
    """The boxes touch from step 20 to 38: while the poses are missing nobody knows where the two are."""
    hit = {stamp(k) for k in range(17, 43)}
    poses = [row for row in drive(N) if row["timestamp_ns"] not in hit]
    log = sensor_log(tmp_path / "log", parked(16.0), poses, STREET)
    found = verdicts(log)
    assert "pass" not in {verdict for verdict, _ in found}, found
    assert "unknown" in {verdict for verdict, _ in found}
    result = check(CheckOptions((str(log),), rules=(COLLISION,), robustness=False), Silent())
    assert result.drives["lossy"].to_pylist() == [True]


@pytest.mark.ci
def test_sizes_that_a_scenario_does_not_have_leave_gaps_unknown(tmp_path: Path) -> None:
    rows = [*track("AV", range(110)), *track("7", range(110), speed=0.0, y=0.0, position_x=60.0)]
    (tmp_path / "s").mkdir()
    scenario(tmp_path / "s", rows)
    found = verdicts(tmp_path / "s")
    assert {verdict for verdict, _ in found} == {"unknown"}


def test_inspect_says_what_is_there_and_what_is_not(tmp_path: Path) -> None:
    log = sensor_log(tmp_path / "log", parked(40.0, y=-3.0), drive(N), STREET)
    found = inspect(InspectRequest(trace=str(log)))
    assert found.problem is None
    assert found.drive is not None
    assert found.drive.road is not None
    (ego,) = found.drive.egos
    assert "ukhc.no-collision" in ego.can
    missing = {item.signal: item.reason for item in ego.missing_signals}
    assert {"indicator", "speed_limits", "road_types"} <= missing.keys()


@pytest.mark.ci
def test_a_converted_log_has_the_same_verdicts(tmp_path: Path) -> None:
    log = sensor_log(tmp_path / "log", parked(20.0), drive(N), STREET)
    convert(ConvertRequest(trace=str(log), to="parquet", out=tmp_path / "twin"))
    assert verdicts(tmp_path / "twin") == verdicts(log)
    for name in ("actor_state", "actor"):
        first, second = (read(path).tables[name].drop_columns(["drive_id"]) for path in (log, tmp_path / "twin"))
        assert first.equals(second)


@pytest.mark.ci
@pytest.mark.parametrize("name", ["av2/adcf7d18", "av2/3b3570b4", "av2_forecasting"])
def test_published_logs_are_judged_on_their_maps(name: str) -> None:
    result = check(CheckOptions((str(shared(f"perception/{name}")),), robustness=False), Silent())
    (drive_row,) = result.drives.to_pylist()
    assert (drive_row["status"], drive_row["lossy"]) == ("judged", False)
    assert drive_row["map_name"] == "embedded"
    assert drive_row["lat"] is not None
    assert {row["verdict"] for row in result.verdicts.to_pylist()} <= {"pass", "fail", "unknown", "not_applicable"}


@pytest.mark.ci
def test_a_log_has_the_same_verdicts_as_its_twin_in_123d() -> None:
    twins = ("av2/adcf7d18", "d123/av2-sensor_val/adcf7d18-0510-35b0-a2fa-b4cea13a6d76")
    rows = []
    for name in twins:
        path = str(shared(f"perception/{name}"))
        result = check(CheckOptions((path,), rules=("*",), robustness=False), Silent())
        rows.append(
            {
                (row["rule_id"], row["profile"]): (row["verdict"], row["reason_code"], row["n_judged"])
                for row in result.verdicts.to_pylist()
            }
        )
    published, through_123d = rows
    assert len(published) > 100
    assert published == through_123d
