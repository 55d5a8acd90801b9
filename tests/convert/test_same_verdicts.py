"""A converted log gives the verdicts of its original, needing neither mapping nor map."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import pyarrow.compute as pc
import pytest

from drivelint.convert import ConvertRequest, convert
from drivelint.drive.trace import IngestOptions
from drivelint.formats import read_trace
from drivelint.formats.osi.metadata import ego_independent_quality
from drivelint.report.progress import Silent
from drivelint.run import CheckOptions, check
from tests.shared_data import shared

if TYPE_CHECKING:
    import pyarrow as pa

pytestmark = pytest.mark.ci

Target = Literal["mcap", "parquet"]
TO: tuple[Target, ...] = ("mcap", "parquet")
TABLES = ("actor", "actor_state", "signal_state", "declared_event")


class Log(NamedTuple):
    """A reference log and what it takes to check it."""

    name: str
    road: str | None = None
    mapping: str | None = None
    ego: str | None = None

    def options(self) -> dict[str, Any]:
        road = shared(self.road) if self.road else None
        return {"map": road, "mapping": self.mapping, "ego": self.ego}

    def convert(self, to: Target, out: Path) -> Path:
        return convert(ConvertRequest(str(shared(self.name)), to, out, **self.options())).path


STUDY = [
    Log(f"overtake_case_study/{run}.csv", "overtake_case_study/t_junction.xodr", "carla-testbench")
    for run in ("safe", "near_miss", "collision")
]
SINGLE = [
    Log("esmini/two_plus_one_road.csv", "maps/two_plus_one.xodr", "esmini"),
    Log("esmini/left-hand-traffic_using_road_rule.csv", "maps/e6mini-lht.xodr", "esmini"),
    Log("esmini/pedestrian_collision.csv", "osi/fabriksgatan.xodr", "esmini"),
    Log("esmini/cut-in.csv", "osi/e6mini.xodr", "esmini"),
    Log("esmini/slow-lead-vehicle.csv", "maps/straight_500m_signs.xodr", "esmini"),
    Log("esmini/light_state.csv", "maps/circle_300m.xodr", "esmini"),
    Log("osi/osi_centerline_example.mcap", ego="all"),
]


def verdicts(*paths: Path, **options: Any) -> dict[str, pa.Table]:
    """Return the rows of every rule and profile by the log's stem, without ids, which hold the hash of the log."""
    profiles = ("relaxed", "nominal", "aggressive", "observed")
    asked = CheckOptions(tuple(map(str, paths)), rules=("ukhc",), profiles=profiles, robustness=False, **options)
    rows = check(asked, Silent()).verdicts
    return {
        drive.rpartition("-")[0]: rows.filter(pc.equal(rows["drive_id"], drive)).drop_columns(
            ["drive_id", "finding_ids"]
        )
        for drive in rows["drive_id"].unique().to_pylist()
    }


@pytest.fixture(scope="module")
def expected() -> dict[str, pa.Table]:
    found: dict[str, pa.Table] = {}
    for logs in (STUDY, *([log] for log in SINGLE)):
        found |= verdicts(*(shared(log.name) for log in logs), **logs[0].options())
    return found


@pytest.mark.slow
@pytest.mark.parametrize("to", TO)
def test_verdicts_stay(tmp_path: Path, expected: dict[str, pa.Table], to: Target) -> None:
    for log in (*STUDY, *SINGLE):
        log.convert(to, tmp_path / Path(log.name).stem if to == "parquet" else tmp_path)
    found = verdicts(tmp_path)
    assert found.keys() == expected.keys()
    for stem, rows in expected.items():
        assert rows.num_rows > 0
        assert found[stem] == rows, stem


@pytest.mark.parametrize("to", TO)
@pytest.mark.parametrize("log", [*STUDY, *SINGLE], ids=lambda log: log.name)
def test_rows_stay(tmp_path: Path, to: Target, log: Log) -> None:
    """Every state, actor and finding, doubles to the last bit."""
    original = read_trace(shared(log.name), IngestOptions(mapping=log.mapping, ego=log.ego))
    again = read_trace(log.convert(to, tmp_path / "out"), IngestOptions())
    for name in TABLES:
        assert again.tables[name].drop_columns("drive_id") == original.tables[name].drop_columns("drive_id"), name
    said, had = (
        [
            row
            for row in ego_independent_quality(trace).drop_columns("drive_id").to_pylist()
            if row["check_id"] != "unprotected"
        ]
        for trace in (again, original)
    )  # Parquet has no checksum of all its parts, whatever the log had
    assert said == had
    assert again.map_offset == original.map_offset


def test_there_and_back(tmp_path: Path) -> None:
    """Parquet of the MCAP of the Parquet holds the same rows and the same map."""
    given = ConvertRequest(str(shared("esmini/cut-in.csv")), "parquet", tmp_path / "a", map=shared("osi/e6mini.xodr"))
    first = read_trace(convert(given).path, IngestOptions())
    mcap = convert(ConvertRequest(str(tmp_path / "a"), "mcap", tmp_path / "b"))
    second = read_trace(convert(ConvertRequest(str(mcap.path), "parquet", tmp_path / "c")).path, IngestOptions())
    for name in (*TABLES, "quality"):
        assert first.tables[name].drop_columns("drive_id") == second.tables[name].drop_columns("drive_id"), name
    assert (first.embedded_map, first.map_offset) == (second.embedded_map, second.map_offset)
