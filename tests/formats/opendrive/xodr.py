"""Small OpenDRIVE files, written by hand."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests.formats.maps import checks, lanelets, points, rows

if TYPE_CHECKING:
    from drivelint.road.map_reader import MapTables

__all__ = ["LINE", "checks", "geometry", "lane", "lanelets", "load", "points", "road", "rows", "section", "xodr"]

LINE = '<geometry s="0" x="0" y="0" hdg="0" length="100"><line/></geometry>'


def lane(number: int, inside: str = '<width sOffset="0" a="3.5"/>', kind: str = "driving", attributes: str = "") -> str:
    return f'<lane id="{number}" type="{kind}" {attributes}>{inside}</lane>'


def section(s: float, *lanes: str, centre: str = "", attributes: str = "") -> str:
    def side(sign: str) -> str:
        return "".join(x for x in lanes if x.startswith('<lane id="-') == (sign == "-"))

    left = f"<left>{side('+')}</left>" if side("+") else ""
    right = f"<right>{side('-')}</right>" if side("-") else ""
    middle = f'<center><lane id="0" type="none">{centre}</lane></center>'
    return f'<laneSection s="{s}" {attributes}>{left}{middle}{right}</laneSection>'


def geometry(shape: str, s: float = 0, at: tuple[float, float, float] = (0, 0, 0), length: float = 100) -> str:
    x, y, heading = at
    return f'<geometry s="{s}" x="{x}" y="{y}" hdg="{heading}" length="{length}">{shape}</geometry>'


def road(  # noqa: PLR0917 - one parameter per part of the element
    road_id: str = "1",
    geometry: str = LINE,
    lanes: str = "",
    length: float = 100.0,
    link: str = "",
    attributes: str = "",
    more: str = "",
    junction: str = "-1",
) -> str:
    lanes = lanes or section(0, lane(1), lane(-1))
    return (
        f'<road id="{road_id}" length="{length}" junction="{junction}" {attributes}><link>{link}</link>'
        f"<planView>{geometry}</planView>{more}<lanes>{lanes}</lanes></road>"
    )


def xodr(*parts: str) -> str:
    return f'<OpenDRIVE><header revMajor="1" revMinor="6"/>{"".join(parts) or road()}</OpenDRIVE>'


def load(*parts: str, **options: Any) -> MapTables:
    return load_map(MapSource("small.xodr", xodr(*parts).encode()), **options)
