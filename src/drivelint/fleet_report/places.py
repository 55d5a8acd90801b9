"""Draws the map of findings: their places on the earth, as a plan in metres around their centre, and the places with most findings."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from drivelint.report.html.svg import round_step, svg_number
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    import duckdb

MAX_MARKS_ON_MAP: Final = 3_000
MAX_LISTED_PLACES: Final = 20
_MAP_WIDTH_PX: Final = 900
_MAX_MAP_HEIGHT_PX: Final = 620
_MAP_CELL_PX: Final = 6
_M_PER_DEGREE: Final = 111_320.0
"""Metres per degree of longitude at the equator (WGS 84); also used for latitude."""
_MIN_MAP_EXTENT_DEGREES: Final = 0.002


@dataclass(frozen=True)
class FindingMap:
    """Marks of findings on a grid, and the numbers of findings that are shown or left out.

    `marks`: kind (severity), x, y and radius in pixels, number of findings. `places`: rows of `places.sql`.
    `n_placed`: findings that have a place. `n_left_out`: how many of these are in cells that are not drawn.
    """

    width: int
    height: int
    marks: list[dict[str, Any]]
    bar_px: str
    bar_words: str
    middle: str
    places: list[dict[str, Any]]
    n_placed: int
    n_findings: int
    n_left_out: int


def finding_map(con: duckdb.DuckDBPyConnection) -> FindingMap | None:
    """Return the map of all findings; None: no finding has a place."""
    (about,) = con.execute(statement("fleet_report/extent")).to_arrow_table().to_pylist()
    if not about["placed"]:
        return None
    stretch = math.cos(math.radians((about["south"] + about["north"]) / 2))
    across = max((about["east"] - about["west"]) * stretch, _MIN_MAP_EXTENT_DEGREES)
    down = max(about["north"] - about["south"], _MIN_MAP_EXTENT_DEGREES)
    px = min((_MAP_WIDTH_PX - 2 * _MAP_CELL_PX) / across, (_MAX_MAP_HEIGHT_PX - 2 * _MAP_CELL_PX) / down)  # per degree
    cell = _MAP_CELL_PX / px
    bound = {"west": about["west"], "north": about["north"], "stretch": stretch, "cell": cell, "most": MAX_MARKS_ON_MAP}
    marks = con.execute(statement("fleet_report/marks"), bound).to_arrow_table().to_pylist()
    bar_m = round_step(_M_PER_DEGREE * across / 8)
    return FindingMap(
        width=_MAP_WIDTH_PX,
        height=math.ceil(down * px) + 4 * _MAP_CELL_PX,
        marks=[_map_mark(row) for row in marks],
        bar_px=svg_number(bar_m / _M_PER_DEGREE * px),
        bar_words=f"{bar_m / 1000:g} km" if bar_m >= 1000 else f"{bar_m:g} m",
        middle=f"{(about['south'] + about['north']) / 2:.4f}, {(about['west'] + about['east']) / 2:.4f}",
        places=con.execute(statement("fleet_report/places"), {"most": MAX_LISTED_PLACES}).to_arrow_table().to_pylist(),
        n_placed=about["placed"],
        n_findings=about["findings"],
        n_left_out=about["placed"] - sum(row["n"] for row in marks),
    )


def _map_mark(row: dict[str, Any]) -> dict[str, Any]:
    x, y = ((row[name] + 1.5) * _MAP_CELL_PX for name in ("column_no", "row_no"))
    radius = min(_MAP_CELL_PX * 2.0, 2.2 + 1.3 * math.log10(row["n"]))  # legible for one finding and for ten thousand
    return {
        "kind": ("critical", "major", "minor")[row["rank"] - 1],
        "x": svg_number(x),
        "y": svg_number(y),
        "r": svg_number(radius),
        "n": row["n"],
    }
