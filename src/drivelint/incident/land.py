"""Tells whether a place on the earth is far out at sea, by a coarse map of land: then a geo reference is probably wrong.

`land.txt` has one bit per cell of half a degree, from the north-west corner, row by row, compressed and in base64. A bit is set if the cell
or one of its neighbours has land in NOAA's GLOBE elevations (1 km, public domain). So a place that is called sea is 30 km or more
from the coast up to 57 degrees of latitude.
"""

from __future__ import annotations

import base64
import zlib
from functools import cache
from pathlib import Path
from typing import Final

_CELLS_PER_DEGREE: Final = 2
_ROWS, _COLUMNS = 180 * _CELLS_PER_DEGREE, 360 * _CELLS_PER_DEGREE


def is_far_at_sea(latitude: float, longitude: float) -> bool:
    """Return whether neither the place (degrees) nor any cell beside it has land."""
    row = min(max(int((90.0 - latitude) * _CELLS_PER_DEGREE), 0), _ROWS - 1)
    column = int((longitude + 180.0) * _CELLS_PER_DEGREE) % _COLUMNS
    byte, bit = divmod(row * _COLUMNS + column, 8)
    return not _land_bits()[byte] >> (7 - bit) & 1


@cache
def _land_bits() -> bytes:
    return zlib.decompress(base64.b64decode(Path(__file__).with_name("land.txt").read_bytes()))
