"""What a converted log says of its states is doubted anew from them, not believed: a stale sentence does not come back."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq
import pytest

from drivelint.convert import ConvertRequest, convert
from tests.drive.tracks import doubts, drive, track
from tests.formats.logs import read

if TYPE_CHECKING:
    from pathlib import Path

    from tests.drive.tracks import Columns

PERSON: dict[str, Any] = {"actor_class": "pedestrian", "length_m": 0.6, "width_m": 0.6}


def with_values(columns: Columns, name: str, rows: slice, values: Any) -> Columns:
    changed = np.array(columns[name])
    changed[rows] = values
    return columns | {name: changed}


def doubtful_tracks() -> dict[str, dict[str, Columns]]:
    """Return, by check, tracks of which it doubts one."""
    car, bike = track(), track(5.0, actor_class="bicycle", length_m=1.8, width_m=0.6)
    ghost = with_values(track(8.0), "x_m", slice(0, 1), -2.5)
    return {
        "class_implausible": {"car": track(20.0, **PERSON)},
        "false_entry": {"car": ghost | {"vx_mps": np.full(100, np.nan), "vy_mps": np.full(100, np.nan)}},
        "heading_spin": {"car": with_values(track(0.0), "yaw_rad", slice(30, 34), [0.3, 0.6, 0.9, 1.2])},
        "position_step": {"car": with_values(bike, "y_m", slice(50, 60), 1.0)},
        "same_body": {"car": car | {"length_m": 12.0, "actor_class": "truck"}, "twin": car | {"length_m": 8.0}},
        "size_implausible": {"car": track(width_m=0.18)},
        "velocity_end_derived": {"car": with_values(car, "vx_mps", slice(0, 1), 0.0)},
        "velocity_jolt": {"car": with_values(car, "vx_mps", slice(40, 41), 16.0)},
    }


@pytest.mark.parametrize("check", doubtful_tracks())
def test_a_doubt_is_read_from_the_states(tmp_path: Path, check: str) -> None:
    original = drive(tmp_path, **doubtful_tracks()[check])
    log = tmp_path / "log.parquet"
    path = convert(ConvertRequest(str(log), "parquet", tmp_path / "out")).path
    table = path / "quality.parquet"
    rows = pq.read_table(table)
    assert check in rows["check_id"].to_pylist()
    stale = pc.if_else(pc.equal(rows["check_id"], check), pa.scalar("stale"), rows["message"])
    pq.write_table(rows.set_column(rows.schema.get_field_index("message"), "message", stale), table)
    converted = read(path)
    assert converted.tables["quality"].drop_columns("drive_id") == original.tables["quality"].drop_columns("drive_id")
    assert doubts(converted) == doubts(original)
