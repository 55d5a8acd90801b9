"""Describes the place of the finding: its position and coordinates, and the source of the side of the road that is driven on."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from drivelint.convert import CLIP_CHECK_ID
from drivelint.drive.trace import TURNED_FRAME_CHECK
from drivelint.engine.earth import frame_of_map
from drivelint.incident.land import is_far_at_sea
from drivelint.incident.words import text_with_minus_signs

if TYPE_CHECKING:
    from collections.abc import Mapping

    from drivelint.incident.case import Case
    from drivelint.result.text import Row

_SIMULATOR_BY_FORMAT: Final = {"carla-testbench": "CARLA", "esmini": "esmini", "sumo-fcd": "SUMO"}
"""The simulators whose own formats are read."""
_SURROUNDING_CONDITIONS: Final = ("weather", "light")
_INFERRED_SIDE_TEXTS: Final = {
    "junctions": "inferred from the links in the map's junctions",
    "lanes": "inferred from the positions of the map's lanes",
    "traces": "inferred from the traffic in the log",
    "default": "assumed: neither map nor user states it",
}
"""The source of the side of the road that is driven on, in words, if neither map nor user states that side."""


class Place(NamedTuple):
    """The centre of A's box at a time: degrees (WGS 84), the drive's coordinates, and the lanelet. None: not known, or no lanelet."""

    t_ns: int
    lat: float | None
    lon: float | None
    x_m: float | None
    y_m: float | None
    lanelet_id: str | None


def place_at_moment(case: Case) -> Place:
    """Return A's place at the moment of the finding; if that is not known, its place at the worst step."""
    row, moment_ns = case.finding.row, case.finding.moment_ns
    steps = case.ego_rows.steps.select(["t_ns", "x_m", "y_m", "lanelet_id"]).to_pylist()
    at = next((step for step in steps if step["t_ns"] == moment_ns), None)
    is_in_row = row["t_worst_ns"] == moment_ns and not case.finding.is_near_miss  # a verdict has no degrees
    if is_in_row or at is None or at["x_m"] is None or at["y_m"] is None:
        return Place(row["t_worst_ns"], *(row[name] for name in Place._fields[1:]))
    lat = lon = None
    if case.drive.geo is not None:
        ((lon, lat),) = case.drive.geo.longitude_latitude(np.array([[at["x_m"], at["y_m"]]])).tolist()
    is_known = lat is not None and np.isfinite([lat, lon]).all()
    return Place(
        moment_ns, lat if is_known else None, lon if is_known else None, at["x_m"], at["y_m"], at["lanelet_id"]
    )


def doubtful_at_sea_text(where: Place, source: str) -> str:
    """Return in words why the coordinates are doubted, if they are far out at sea; else ''. `source`: that of `geo_source`."""
    if where.lat is None or where.lon is None or not is_far_at_sea(where.lat, where.lon):
        return ""
    return f"by the {source}'s geo reference, doubtful: in the sea"


def geo_source(case: Case) -> str:
    """Return the source of the geographic reference: `map` or `log`."""
    environment = case.drive.environment
    return "map" if environment is not None and frame_of_map(environment) is not None else "log"


def weather_and_light_text(drive: Row) -> str:
    """Return weather and light in words, also which of them is not known."""
    values = {condition["condition"]: condition["value"] for condition in drive["conditions"]}
    known_texts = [f"{name} {values[name]}" for name in _SURROUNDING_CONDITIONS if name in values]
    missing_names = [name for name in _SURROUNDING_CONDITIONS if name not in values]
    parts = [", ".join(known_texts)] if known_texts else []
    return "; ".join([*parts, f"{' and '.join(missing_names)} not known"] if missing_names else parts).capitalize()


def simulator_text(drive: Row) -> str:
    """Return in words that the log has the format of a simulator, so that the drive may never have been driven; '' for other formats."""
    name = _SIMULATOR_BY_FORMAT.get(drive["format"])
    return f"The log has the format of the simulator {name}: probably a simulated drive" if name else ""


def coordinates_source_text(case: Case) -> str:
    """Return in words whether x and y are coordinates of the log or of a clip, and any change of y's sign or offset of the map."""
    checks = {check["check_id"] for check in case.finding.drive["quality"]}
    text = "the recording's coordinates"
    if CLIP_CHECK_ID in checks:
        text = "the clip's coordinates"  # a clip contains the coordinates that were judged
    elif TURNED_FRAME_CHECK in checks:
        text += " with the sign of y changed, as its frame is left-handed"
    dx, dy = _map_offset_m(case)
    return f"{text}{text_with_minus_signs(f' (the map was moved by {dx:+g} m, {dy:+g} m)')}" if dx or dy else text


def driving_side_text(drive: Row) -> str:
    """Return in words the side of the road that is driven on, and how it was inferred, if it was; '' if it is not known."""
    side = {"lht": "Left", "rht": "Right"}.get(drive["handedness"])
    how = _INFERRED_SIDE_TEXTS.get(drive["handedness_source"])
    return f"{side}-hand traffic: {how}." if side and how else f"{side}-hand traffic." if side else ""


def road_id_of_lanelet(case: Case, lanelet_id: str | None) -> str | None:
    """Return the id of the road of a lanelet; None if the lanelet, its road or the map is not known."""
    environment = case.drive.environment
    if lanelet_id is None or environment is None:
        return None
    rows: Mapping[str, Any] = environment.tables["lanelet"].select(["lanelet_id", "road_id"]).to_pydict()
    roads = dict(zip(rows["lanelet_id"], rows["road_id"], strict=True))
    return roads.get(lanelet_id)


def _map_offset_m(case: Case) -> tuple[float, float]:
    """Return the offset in metres along x and y by which the map was moved to fit the log."""
    if case.drive.environment is None:
        return 0.0, 0.0
    (row,) = case.drive.environment.tables["environment"].select(["offset_x_m", "offset_y_m"]).to_pylist()
    return row["offset_x_m"] or 0.0, row["offset_y_m"] or 0.0
