"""Finds the persons and containers of floating car data that ride in a vehicle: SUMO writes them at the place of their vehicle.

The attribute `vehicle` names the vehicle. In a log without that attribute, the place shows it: a person with exactly the place, the angle
and the speed of a vehicle is in it, because two bodies are never in one place.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyarrow.compute as pc

from drivelint.formats.sumo.rows import CONTAINER, PERSON, PERSON_OR_CONTAINER, UNKNOWN_KIND, VEHICLE

if TYPE_CHECKING:
    from drivelint.arrays import Mask
    from drivelint.formats.sumo.rows import Rows


def is_riding(rows: Rows) -> Mask:
    """Return for each row (n) whether its person or container rides in a vehicle.

    Of several rows of unknown kind in one place, all but the first ride: SUMO writes a vehicle before its passengers.
    """
    vehicle_ids = rows.table["vehicle"]
    is_rider: Mask = pc.fill_null(pc.not_equal(vehicle_ids, ""), fill_value=False).to_numpy()
    carried = np.isin(rows.kind, (PERSON, CONTAINER, PERSON_OR_CONTAINER)) & pc.is_null(vehicle_ids).to_numpy()
    may_ride = carried | (rows.kind == UNKNOWN_KIND)
    if not may_ride.any():
        return is_rider
    time, x, y = (rows.numbers(name) for name in ("time", "x", "y"))
    near = np.flatnonzero(np.isin(time, np.unique(time[may_ride])) & np.isfinite(x) & np.isfinite(y))
    there = np.stack([time, x, y, rows.numbers("angle"), rows.numbers("speed")], axis=1)[near] + 0.0
    _, place = np.unique(there.view(np.int64), axis=0, return_inverse=True)
    place = place.reshape(-1)
    kind = rows.kind[near]
    first_vehicle, first_unknown = (
        _first_row_by_place(place, kind == VEHICLE),
        _first_row_by_place(place, kind == UNKNOWN_KIND),
    )
    # a vehicle is written before its passengers, and a row of unknown kind may be a vehicle
    beside = (first_vehicle[place] < len(near)) | (first_unknown[place] < np.arange(len(near)))
    riders = is_rider.copy()
    riders[near] |= may_ride[near] & beside
    return riders


def _first_row_by_place(place: np.ndarray, candidates: Mask) -> np.ndarray:
    """Return for each place its first candidate row; the number of rows if it has none."""
    first_rows = np.full(int(place.max(initial=-1)) + 1, len(place))
    rows = np.flatnonzero(candidates)[::-1]
    first_rows[place[rows]] = rows
    return first_rows
