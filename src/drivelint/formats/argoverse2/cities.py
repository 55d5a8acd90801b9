"""The coordinate frames of the six cities of Argoverse 2: UTM, relative to an origin in each city.

Source: av2-api, `geometry/utm.py`, which gives latitude and longitude of the origins and the zones.
"""

from __future__ import annotations

import re
from typing import Final

from drivelint.road.geo_reference import GeoFrame

NATION: Final = "us"
"""The country of all six cities."""
CITY_ORIGINS_IN_UTM: Final = {
    "ATX": (14, 621150.0275, 3349889.9996),  # Austin: 30.27464237939507, -97.7404457407424
    "DTW": (17, 320669.9346, 4685369.9988),  # Detroit: 42.29993066912924, -83.17555750783717
    "MIA": (17, 580560.0088, 2850959.9999),  # Miami: 25.77452579915163, -80.19656914449405
    "PAO": (10, 576480.0006, 4141379.9353),  # Palo Alto: 37.416065, -122.13571963362166
    "PIT": (17, 583710.0070, 4477259.9998),  # Pittsburgh: 40.44177902989321, -80.01294377242584
    "WDC": (18, 323459.9997, 4306469.9870),  # Washington: 38.889377, -77.0355047439081
}
"""City -> the zone of UTM north, and easting and northing of its origin in metres (comments: latitude and longitude as published)."""
_CODE_BY_CITY_NAME: Final = {
    "austin": "ATX", "dearborn": "DTW", "detroit": "DTW", "miami": "MIA", "palo-alto": "PAO", "pittsburgh": "PIT",
    "washington-dc": "WDC",
}  # fmt: skip
"""Cities as the motion forecasting dataset names them -> their codes."""
_CITY_IN_FILE_NAME: Final = re.compile(r"____([A-Z]{3})_city_")


def frame_of_city(name: str) -> GeoFrame | None:
    """Return the coordinate frame of a city, given by its code or name; None if Argoverse does not have the city."""
    word = name.strip()
    origin = CITY_ORIGINS_IN_UTM.get(_CODE_BY_CITY_NAME.get(word.lower().replace("_", "-").replace(" ", "-"), word))
    if origin is None:
        return None
    zone, x_m, y_m = origin
    return GeoFrame(f"+proj=utm +zone={zone} +datum=WGS84 +units=m +no_defs", x_m, y_m)


def frame_by_file_name(name: str) -> GeoFrame | None:
    """Return the coordinate frame of the city in the file name of a sensor log's map; None if the name contains no city."""
    match = _CITY_IN_FILE_NAME.search(name)
    return None if match is None else frame_of_city(match[1])
