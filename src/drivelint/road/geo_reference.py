"""Reads the geo reference of a map, compares it with that of a log, and checks whether it gives positions on the earth."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Final, NamedTuple

import duckdb
import numpy as np
import pyarrow as pa

from drivelint.sql import store

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from drivelint.road.map_reader import MapSource

WGS84: Final = "EPSG:4326"

_GEO_REFERENCE_ELEMENT: Final = re.compile(rb"<geoReference[^>]*>(.*?)</geoReference>", re.DOTALL)
_CDATA: Final = re.compile(r"<!\[CDATA\[(.*?)\]\]>", re.DOTALL)
_SEARCHED_BYTES: Final = 65536
_PARAMETERS_WITHOUT_EFFECT: Final = frozenset({"no_defs", "wktext", "type", "units", "vunits", "geoidgrids"})
"""PROJ parameters that do not change positions in the plane (lengths are in metres in all supported formats)."""
_DEFAULT_PARAMETERS: Final = {("x_0", "0.0"), ("y_0", "0.0"), ("k", "1.0"), ("k_0", "1.0")}
"""PROJ parameters with their default values."""
_COMPARED_DECIMALS: Final = 9
"""The number of decimals that are compared, because writers round the last ones: 0.1 mm on the ground, even for degrees."""
_TANGENT_PLANE_PROJECTION: Final = "ortho"
_LARGEST_LOCAL_COORDINATE_M: Final = 100_000.0
_NEAR_EQUATOR_DEG: Final = 1.0
_NEAR_POLE_DEG: Final = 5.0  # 0,0 of the southern zones of UTM is 4.5 degrees from the pole
_METRES_PER_DEGREE: Final = 111_195.0  # of a great circle, on the sphere of the earth's mean radius
_GROUND_LENGTH_PER_METRE_RANGE: Final = (0.4, 1.6)
"""The range of the length on the ground (m) of one metre of a projection: Mercator's is 0.4 m at 66 degrees of latitude."""


class GeoFrame(NamedTuple):
    """A projection, and the transformation into it: coordinates are turned by `yaw_rad`, then shifted by x, y and z (metres).

    `<offset>` of ASAM OpenDRIVE 1.7 and later (8.5, georeferencing), and `proj_frame_offset` of ASAM OSI, are defined like this.
    """

    reference: str
    x_m: float = 0.0
    y_m: float = 0.0
    z_m: float = 0.0
    yaw_rad: float = 0.0

    def project(self, xy: NDArray[np.float64]) -> NDArray[np.float64]:
        """Convert coordinates (n, 2) in this frame to projected coordinates."""
        return xy @ self._rotation_matrix().T + (self.x_m, self.y_m)

    def unproject(self, xy: NDArray[np.float64]) -> NDArray[np.float64]:
        """Convert projected coordinates (n, 2) to coordinates in this frame."""
        return (xy - (self.x_m, self.y_m)) @ self._rotation_matrix()

    def after_shift(self, x_m: float, y_m: float) -> GeoFrame:
        """Return the frame that is valid after x and y (metres) were added to all coordinates."""
        ((x, y),) = self.project(-np.array([[x_m, y_m]])).tolist()
        return self._replace(x_m=x, y_m=y)

    def longitude_latitude(self, xy: NDArray[np.float64]) -> NDArray[np.float64]:
        """Convert coordinates (n, 2) in this frame to longitude and latitude. Errors: as `transform`."""
        return transform(self.project(xy), self.reference, WGS84)

    def _rotation_matrix(self) -> NDArray[np.float64]:
        cos, sin = math.cos(self.yaw_rad), math.sin(self.yaw_rad)
        return np.array([[cos, -sin], [sin, cos]])


def tangent_plane_frame(latitude: float, longitude: float) -> GeoFrame:
    """Return the frame whose coordinates are metres to the east and north of a point (degrees, WGS 84)."""
    return GeoFrame(
        f"+proj={_TANGENT_PLANE_PROJECTION} +lat_0={latitude!r} +lon_0={longitude!r} +datum=WGS84 +units=m +no_defs"
    )


def why_unusable(frame: GeoFrame, x_m: float, y_m: float) -> str | None:
    """Return why the frame gives no positions on the earth, tested at one position of the map or log; None: it is usable.

    A placeholder cannot be recognised by its text. But with it, local coordinates near 0,0 would be near the projection's origin on the
    equator or at a pole: in the Gulf of Guinea or on the ice.
    """
    ((x, y),) = frame.project(np.array([[x_m, y_m]])).tolist()
    try:
        places = transform(np.array([[x, y], [x + 1.0, y]]), frame.reference, WGS84)
    except duckdb.Error:
        return "PROJ cannot read it"
    if not np.isfinite(places).all():
        return "it gives no latitude and longitude for the coordinates"
    (longitude, latitude), (beside, above) = places.tolist()
    turned = math.remainder(beside - longitude, 360.0) * math.cos(math.radians(latitude))
    if (
        not _GROUND_LENGTH_PER_METRE_RANGE[0]
        < math.hypot(turned, above - latitude) * _METRES_PER_DEGREE
        < _GROUND_LENGTH_PER_METRE_RANGE[1]
    ):
        return "its unit is not the metre, or the coordinates are far outside its area"
    local = max(abs(x), abs(y)) < _LARGEST_LOCAL_COORDINATE_M and not _has_local_origin(frame.reference)
    if local and (abs(latitude) < _NEAR_EQUATOR_DEG or abs(latitude) > 90.0 - _NEAR_POLE_DEG):
        return (
            f"it is a placeholder: the coordinates are local, and it would place them at latitude {latitude:.3f}, "
            f"longitude {longitude:.3f}"
        )
    return None


def transform(xy: NDArray[np.float64], source: str, target: str) -> NDArray[np.float64]:
    """Convert coordinates (n, 2) from the reference `source` to the reference `target`; not finite if they do not exist there.

    Errors: `duckdb.Error` if PROJ does not understand a reference.
    """
    sql = (
        "SELECT ST_X(p) AS x, ST_Y(p) AS y "
        "FROM (SELECT ST_Transform(ST_Point(x, y), $source, $target, always_xy := true) AS p FROM places)"
    )
    with store.open_without_creating_tables() as con:
        store.lock_down(con)  # a reference may contain the names of grid files
        con.register("places", pa.table({"x": xy[:, 0], "y": xy[:, 1]}))
        columns = con.execute(sql, {"source": source, "target": target}).fetchnumpy()
    return np.stack([np.ma.filled(columns[axis], np.nan) for axis in ("x", "y")], axis=1)


def _has_local_origin(reference: str) -> bool:
    """Return whether a PROJ string has its own latitude of origin; UTM ignores this parameter."""
    parameters = dict(_reference_parameters(reference))
    return parameters.get("proj") != "utm" and parameters.get("lat_0", "0.0") != "0.0"


def opendrive_geo_reference(source: MapSource) -> str | None:
    """Return the geo reference in an OpenDRIVE header; None: it is absent or empty."""
    match = _GEO_REFERENCE_ELEMENT.search(source.content[:_SEARCHED_BYTES])
    if match is None:
        return None
    text = match[1].decode("utf-8", "replace")
    inner = _CDATA.search(text)
    return (inner[1] if inner else text).strip() or None


def is_same_reference(first: str, second: str) -> bool:
    """Return whether two references are equal: PROJ strings by their parameters, other texts by their words."""
    return _reference_parameters(first) == _reference_parameters(second)


def is_conflicting_reference(first: str, second: str) -> bool:
    """Return whether two references contradict each other: unequal PROJ strings with projections other than `tangent_plane_frame`."""
    return not is_same_reference(first, second) and all(
        "proj" in dict(_reference_parameters(text)) and not is_from_map_origin(text) for text in (first, second)
    )


def is_from_map_origin(reference: str) -> bool:
    """Return whether a reference was made by `tangent_plane_frame`, from the user's `--map-origin`."""
    return dict(_reference_parameters(reference)).get("proj") == _TANGENT_PLANE_PROJECTION


def _reference_parameters(text: str) -> frozenset[tuple[str, str]]:
    words = text.split()
    if not any(word.startswith("+") for word in words):
        return frozenset({("", " ".join(words))})
    pairs = (word.removeprefix("+").partition("=")[::2] for word in words)
    parameters = {(key, _rounded_if_number(value)) for key, value in pairs if key not in _PARAMETERS_WITHOUT_EFFECT}
    return frozenset(parameters - _DEFAULT_PARAMETERS)


def _rounded_if_number(value: str) -> str:
    try:
        return repr(round(float(value), _COMPARED_DECIMALS) + 0.0)
    except ValueError:
        return value
