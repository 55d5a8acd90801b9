"""Draws small Lanelet2 maps."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource

if TYPE_CHECKING:
    from drivelint.road.map_reader import MapTables

ORIGIN = (49.0, 8.4)


class Drawing:
    """Collects nodes, ways and relations of an OSM file; coordinates in metres from the origin."""

    def __init__(self, *, local: bool = False, globe: bool = True) -> None:
        self.globe = globe  # whether latitude and longitude are there
        self.local, self.parts, self.nodes = local, [], {}  # type: ignore[var-annotated]
        self.count = 0

    def node(self, x: float, y: float) -> int:
        if (x, y) in self.nodes:
            return int(self.nodes[x, y])
        self.count += 1
        lat = ORIGIN[0] + math.degrees(y / 6_366_000)
        lon = ORIGIN[1] + math.degrees(x / (6_388_000 * math.cos(math.radians(ORIGIN[0]))))
        tags = f'<tag k="local_x" v="{x}"/><tag k="local_y" v="{y}"/>' if self.local else ""
        place = f'lat="{lat:.11f}" lon="{lon:.11f}"' if self.globe else 'lat="" lon=""'
        self.parts.append(f'<node id="{self.count}" {place}>{tags}</node>')
        self.nodes[x, y] = self.count
        return self.count

    def way(self, points: list[tuple[float, float]], kind: str = "line_thin", style: str = "dashed") -> int:
        refs = "".join(f'<nd ref="{self.node(*p)}"/>' for p in points)
        self.count += 1
        self.parts.append(
            f'<way id="{self.count}">{refs}<tag k="type" v="{kind}"/><tag k="subtype" v="{style}"/></way>'
        )
        return self.count

    def lanelet(self, left: int, right: int, more: str = "", **tags: str) -> int:
        said = {"type": "lanelet", "subtype": "road", "location": "urban", "one_way": "yes", "region": "de"} | tags
        text = "".join(f'<tag k="{k}" v="{v}"/>' for k, v in said.items())
        self.count += 1
        self.parts.append(
            f'<relation id="{self.count}"><member type="way" ref="{left}" role="left"/>'
            f'<member type="way" ref="{right}" role="right"/>{more}{text}</relation>'
        )
        return self.count

    def element(self, subtype: str = "traffic_sign", /, yields: tuple[int, ...] = (), **members: list[int]) -> str:
        """Add a regulatory element, `count` is then its id; return it as a member of a lanelet. `yields`: lanelets with the role yield."""
        self.count += 1
        inside = "".join(f'<member type="relation" ref="{i}" role="yield"/>' for i in yields)
        inside += "".join(f'<member type="way" ref="{i}" role="{role}"/>' for role, ids in members.items() for i in ids)
        said = f'<tag k="type" v="regulatory_element"/><tag k="subtype" v="{subtype}"/>'
        self.parts.append(f'<relation id="{self.count}">{inside}{said}</relation>')
        return f'<member type="relation" ref="{self.count}" role="regulatory_element"/>'

    def tag_last(self, **tags: str) -> None:
        """Add tags to the last way, lanelet or regulatory element."""
        said = "".join(f'<tag k="{k}" v="{v}"/>' for k, v in tags.items())
        start, end = self.parts[-1].rsplit("</", 1)
        self.parts[-1] = f"{start}{said}</{end}"

    def text(self) -> str:
        """Return the file."""
        order = sorted(self.parts, key=lambda part: ["<n", "<w", "<r"].index(part[:2]))
        return f"<?xml version='1.0'?><osm version='0.6'>{''.join(order)}</osm>"

    def load(self, **options: object) -> MapTables:
        return load_map(MapSource("a.osm", self.text().encode()), **({"origin": ORIGIN} | options))  # type: ignore[arg-type]
