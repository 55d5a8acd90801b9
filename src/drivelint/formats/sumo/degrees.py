"""Converts positions in longitude and latitude (`--fcd-output.geo`) back to the metres of the simulated net.

SUMO transforms the positions, but not the angles: they stay relative to the net's grid, not to true north. So the net is needed for both.
Only some XML files state the unit of the positions. The motion of any actor takes precedence over this statement: degrees read as metres
are speeds below 2 mm/s, a hundred-thousandth of the recorded speeds. Source: SUMO's documentation of "Simulation/Output/FCDOutput" and
"Geo-Coordinates".
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.drive.trace import QualityFinding
from drivelint.errors import TraceError
from drivelint.formats.sumo.location import read_location
from drivelint.road.geo_reference import WGS84, transform

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from drivelint.arrays import Floats
    from drivelint.formats.sumo.rows import Rows

_LARGEST_DEGREES: Final = np.array([180.0, 90.0])
_LEAST_DISPLACEMENT: Final = 1e-7
"""A smaller displacement is no motion: as degrees it is a centimetre, as metres a rounding error."""
_LARGEST_DEGREES_PER_S: Final = 0.01
"""No vehicle drives 0.01 degrees in a second; an actor that moves by less than 0.01 metres in a second stands."""
_LEAST_MPS_PER_DEGREE_PER_S: Final = 1000.0
"""A speed in m/s is 38,000 (at 70 degrees of latitude) to 111,000 times the same speed in degrees per second."""
_M_PER_DEGREE: Final = 111_195.0
_LEAST_REPORTED_ERROR_M: Final = 0.005
_TRIED_DECIMAL_COUNTS: Final = range(1, 9)
_DEGREES_MESSAGE: Final = "its positions are longitude and latitude (fcd-output.geo)"
_DEGREES_REMEDY: Final = (
    "give the net that was simulated, with its projection, with --map, or record the log without fcd-output.geo"
)


def positions_in_net_and_findings(
    path: Path, rows: Rows, actor: NDArray[np.int32], net: Path | None
) -> tuple[Floats, list[QualityFinding]]:
    """Return the positions (n, 2) in metres of the net, and a finding on rounded positions.

    `actor` (n,): the actor of each row; `net`: the map that the user gives. Errors: `TraceError` for degrees that cannot be converted.
    """
    xy = np.stack([rows.numbers("x"), rows.numbers("y")], axis=1)
    if not _are_positions_degrees(path, rows, xy, actor, net):
        return xy, []
    if net is None:
        raise TraceError(f"{path}: {_DEGREES_MESSAGE}: {_DEGREES_REMEDY}")
    if (location := read_location(net)) is None:
        raise TraceError(f"{path}: {_DEGREES_MESSAGE}, and {net.name} is no SUMO net: {_DEGREES_REMEDY}")
    frame, trouble = location.geo_frame(), location.why_unconvertible()
    if frame is None or trouble:
        raise TraceError(
            f"{path}: {_DEGREES_MESSAGE}, and the net {net.name} cannot convert them to metres: {trouble}: {_DEGREES_REMEDY}"
        )
    has_place = np.isfinite(xy).all(axis=1)
    positions = np.full_like(xy, np.nan)
    positions[has_place] = frame.unproject(transform(xy[has_place], WGS84, frame.reference))
    positions[~np.isfinite(positions).all(axis=1)] = np.nan
    return positions, _rounding_findings(xy[has_place], net)


def _are_positions_degrees(path: Path, rows: Rows, xy: Floats, actor: NDArray[np.int32], net: Path | None) -> bool:
    points = xy[np.isfinite(xy).all(axis=1)]
    if not len(points):
        return False
    may_be = bool((np.abs(points) <= _LARGEST_DEGREES).all())
    moves = _moves_in_degrees(rows, xy, actor) if may_be else False
    if moves is False and rows.geo_option:
        raise TraceError(
            f"{path}: its configuration says that its positions are longitude and latitude (fcd-output.geo), and they are not: "
            "write the log again"
        )
    if moves is not None or rows.geo_option is not None:
        return bool(rows.geo_option if moves is None else moves)
    # no actor moves, and the unit of the positions is not stated: the net shows the unit
    location = None if net is None else read_location(net)
    frame = None if location is None else location.geo_frame()
    if location is None or frame is None or location.why_unconvertible():
        return False
    return bool(location.is_in_net(frame.unproject(transform(points, WGS84, frame.reference))).all())


def _moves_in_degrees(rows: Rows, xy: Floats, actor: NDArray[np.int32]) -> bool | None:
    """Return whether moving actors move in degrees; None: no actor moves."""
    order = np.argsort(actor, kind="stable")
    same = np.diff(actor[order]) == 0
    dt = np.diff(rows.numbers("time")[order])
    way = np.hypot(*np.diff(xy[order], axis=0).T)
    is_displaced = same & (dt > 0.0) & (way >= _LEAST_DISPLACEMENT)
    if not is_displaced.any():
        return None
    per_s = way[is_displaced] / dt[is_displaced]
    speed = rows.numbers("speed")[order]
    mean = (speed[1:] + speed[:-1])[is_displaced] / 2.0
    if np.isfinite(mean).any():
        return bool(np.nanmedian(mean / per_s) > _LEAST_MPS_PER_DEGREE_PER_S)
    return bool(np.median(per_s) < _LARGEST_DEGREES_PER_S)


def _rounding_findings(degrees: Floats, net: Path) -> list[QualityFinding]:
    """Return a finding on the error of positions that were written with few decimals."""
    digits = next(
        (n for n in _TRIED_DECIMAL_COUNTS if np.abs(degrees * 10.0**n - np.round(degrees * 10.0**n)).max() < 1e-3), None
    )
    along = float(np.cos(np.radians(degrees[:, 1].mean())))  # a degree of longitude, as a share of one of latitude
    error_m = 0.0 if digits is None else _M_PER_DEGREE * 0.5 * 10.0**-digits * float(np.hypot(1.0, along))
    if error_m < _LEAST_REPORTED_ERROR_M:
        return []
    message = (
        f"positions are longitude and latitude with {digits} decimals, converted to the metres of {net.name}: they "
        f"are exact to {error_m:.2g} m; SUMO's option precision.geo gives more decimals"
    )
    return [QualityFinding("rounded_position", "warning", message, len(degrees))]
