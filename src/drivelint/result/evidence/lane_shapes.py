"""Gathers the simplified shapes of lanes near scenes into `lane_shape`, each lane once."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow as pa
import shapely

from drivelint.sql import store
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    import duckdb
    from numpy.typing import NDArray

SIMPLIFY_TOLERANCE_M: Final = 0.1


def gather(con: duckdb.DuckDBPyConnection) -> None:
    """Add the shapes of lanes near scenes that are not in `lane_shape` yet."""
    con.execute(statement("evidence/near_lane"))
    lanes = con.execute(statement("evidence/lane")).to_arrow_table()
    if lanes.num_rows:
        points = con.execute(statement("evidence/lane_point")).fetchnumpy()
        for side in ("left", "right"):
            for axis, values in zip("xy", _simplified(points, side, lanes.num_rows), strict=True):
                lanes = lanes.append_column(f"{side}_{axis}_m", values)
        store.insert(con, "lane_shape", lanes)


def _simplified(points: dict[str, NDArray[np.float64]], side: str, n: int) -> tuple[pa.ListArray, pa.ListArray]:
    """Return the x and y of `n` bounds as lists in centimetres, with only the points that keep them true."""
    xy = np.column_stack([points[f"{side}_x_m"], points[f"{side}_y_m"]])
    lines = shapely.linestrings(xy, indices=points["lane"].astype(np.intp))
    kept, index = shapely.get_coordinates(shapely.simplify(lines, SIMPLIFY_TOLERANCE_M), return_index=True)
    offsets = pa.array(np.searchsorted(index, np.arange(n + 1)), pa.int32())
    x, y = np.round(kept, 2).T
    return pa.ListArray.from_arrays(offsets, pa.array(x)), pa.ListArray.from_arrays(offsets, pa.array(y))
