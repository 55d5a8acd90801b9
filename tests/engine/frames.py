"""The overtaking case in frames of other geo references, moved by pyproj."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pytest

from drivelint.drive.trace import DriveInput, IngestOptions, Trace
from drivelint.engine.batch import drive_with_map
from drivelint.engine.map_library import MapLibrary
from drivelint.formats import read_trace

if TYPE_CHECKING:
    from drivelint.engine.batch import Drive

CASE = Path(__file__).resolve().parents[2] / "fixtures" / "overtake"
LOG, MAPPING = CASE / "near_miss.csv", str(CASE / "mapping.toml")
UTM32, UTM33 = (f"+proj=utm +zone={zone} +datum=WGS84 +units=m +no_defs" for zone in (32, 33))
LOCAL = "+proj=tmerc +lat_0=49 +lon_0=12 +k=1 +datum=WGS84"
BORDER, KARLSRUHE = (12.02, 49.0), (8.4, 49.0)
TURN = 0.3
WHOLE = (0.0, 0.0, 0.0)
FRAMES = [(UTM33, WHOLE), (UTM33, (330_000.0, 5_400_000.0, -2.0)), (LOCAL, WHOLE), (LOCAL, (5.0, -7.0, 0.2))]
NUMBERS = ("x_m", "y_m", "yaw_rad", "vx_mps", "vy_mps", "ax_mps2", "ay_mps2")
pyproj = pytest.importorskip("pyproj")


def origin(place: tuple[float, float]) -> tuple[float, float]:
    x, y = pyproj.Transformer.from_crs("EPSG:4326", UTM32, always_xy=True).transform(*place)
    return x, y


def road(folder: Path, place: tuple[float, float] = BORDER) -> Path:
    """Write the case's road so that its 0,0 is at a longitude and latitude, turned against the projection."""
    x, y = origin(place)
    said = f'<geoReference>{UTM32}</geoReference><offset x="{x!r}" y="{y!r}" hdg="{TURN}"/>'
    text = (CASE / "road.xodr").read_text("utf-8")
    assert 'vendor="drivelint demo"/>' in text
    text = text.replace('vendor="drivelint demo"/>', f'vendor="drivelint demo">{said}</header>')
    (folder / "road.xodr").write_text(text, "utf-8")
    return folder / "road.xodr"


def plain() -> Trace:
    return read_trace(LOG, IngestOptions(mapping=MAPPING))


def numbers(trace: Trace) -> dict[str, Any]:
    return {name: np.array(trace.tables["actor_state"][name].to_numpy(), np.float64) for name in NUMBERS}


def with_numbers(trace: Trace, number: dict[str, Any]) -> Trace:
    states = trace.tables["actor_state"]
    for name, values in number.items():
        at = states.schema.get_field_index(name)
        states = states.set_column(at, states.schema.field(at), pa.array(values, from_pandas=True))
    return replace(trace, tables={**trace.tables, "actor_state": states})


def turned(x: Any, y: Any, angle: Any) -> tuple[Any, Any]:
    return x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)


def in_frame(reference: str, offset: tuple[float, float, float] = WHOLE, place: tuple[float, float] = BORDER) -> Trace:
    """Return the case's drive in another frame, moved by pyproj, turned by PROJ's meridian convergences."""
    number, (x0, y0) = numbers(plain()), origin(place)
    x, y = turned(number["x_m"], number["y_m"], TURN)
    lon, lat = pyproj.Transformer.from_crs(UTM32, "EPSG:4326", always_xy=True).transform(x + x0, y + y0)
    x, y = pyproj.Transformer.from_crs(UTM32, reference, always_xy=True).transform(x + x0, y + y0)
    north, other = (np.radians(pyproj.Proj(r).get_factors(lon, lat).meridian_convergence) for r in (UTM32, reference))
    angle = TURN + other - north - offset[2]
    number["x_m"], number["y_m"] = turned(x - offset[0], y - offset[1], -offset[2])
    number["yaw_rad"] = np.remainder(number["yaw_rad"] + angle + math.pi, math.tau) - math.pi
    for a, b in (("vx_mps", "vy_mps"), ("ax_mps2", "ay_mps2")):
        number[a], number[b] = turned(number[a], number[b], angle)
    return replace(with_numbers(plain(), number), geo_reference=reference, geo_offset=offset)


def drive_on_map(trace: Trace, road: Path, offset: tuple[float, float] | None = None) -> Drive:
    return drive_with_map(trace, MapLibrary(DriveInput(map=road, map_offset=offset)))
