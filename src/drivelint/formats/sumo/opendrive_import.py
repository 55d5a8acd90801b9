"""Nets that netconvert made of OpenDRIVE files, and the facts that are lost in the conversion.

Seen with netconvert 1.28.0: of roads with `rule="LHT"` it makes a net without `lefthand`, whose lanes run for right-hand traffic, and it
does not read the limit of a road's type. A lane without a limit of its own has the default speed of its `type`.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final, NamedTuple

from drivelint.formats.safe_xml import number

if TYPE_CHECKING:
    from collections.abc import Mapping

    from lxml import etree

    from drivelint.road.quality import MapQuality

_HEAD_BYTES: Final = 20_000
_SOURCE: Final = re.compile(rb'<opendrive(?:-files)? value="([^"]*)"')


class OpenDriveImport(NamedTuple):
    """The OpenDRIVE file of which a net was made, and the default speed (m/s) of each type of lanes."""

    file: str
    default_mps: Mapping[str, float]

    def is_default(self, lane: etree._Element, edge: etree._Element, limit_mps: float) -> bool:
        """Say whether a lane's limit may be no more than the default of its type."""
        return limit_mps == self.default_mps.get(lane.get("type") or edge.get("type") or "")


def opendrive_import(content: bytes, root: etree._Element, quality: MapQuality) -> OpenDriveImport | None:
    """Return the source of the net, from the configuration in its first comment, with a warning; None: not OpenDRIVE."""
    found = _SOURCE.search(content[:_HEAD_BYTES].partition(b"-->")[0])
    if found is None:
        return None
    file = found[1].decode("utf-8", "replace")
    message = f"netconvert imported this net from the OpenDRIVE file {file}: its side of traffic and limits may be lost: give that file"
    quality.add("imported_net", "warning", None, message)
    speeds = {each.get("id", ""): number(each.get("speed", "")) for each in root.iterfind("type")}
    return OpenDriveImport(file, speeds)
