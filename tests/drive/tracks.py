"""Straight tracks of single actors as one log, and what is doubted of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import polars as pl

from tests.formats.logs import read

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.drive.trace import Trace

Columns = dict[str, Any]
CAR: Columns = {"actor_class": "car", "length_m": 4.5, "width_m": 1.8}


def track(speed: float = 13.0, *, n: int = 100, hz: float = 10.0, heading: float = 0.0, **more: Any) -> Columns:
    """Return the columns of a straight track, with its velocity."""
    t_s = np.arange(n) / hz
    return {
        "t_ns": np.round(t_s * 1e9).astype(np.int64), "x_m": speed * t_s * np.cos(heading), "y_m": speed * t_s * np.sin(heading),
        "yaw_rad": np.full(n, heading), "vx_mps": np.full(n, speed * np.cos(heading)), "vy_mps": np.full(n, speed * np.sin(heading)),
        **CAR, **more,
    }  # fmt: skip


def drive(folder: Path, **tracks: Columns) -> Trace:
    """Read tracks, by id, as one log; the ego is `ego`, 50 m aside."""
    ego = track(5.0)
    ego["y_m"] = ego["y_m"] + 50.0
    rows = pl.concat([pl.DataFrame(columns | {"actor_id": name}) for name, columns in {"ego": ego, **tracks}.items()])
    path = folder / "log.parquet"
    rows.with_columns(is_ego=pl.col("actor_id") == "ego").write_parquet(path)
    return read(path)


def doubts(trace: Trace) -> set[tuple[str, str, str]]:
    return {(row["actor_id"], row["quantity"], row["code"]) for row in trace.tables["doubt"].to_pylist()}
