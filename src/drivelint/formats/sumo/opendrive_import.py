"""Nets that netconvert made from OpenDRIVE files, and the facts that are lost in the conversion.

Observed with netconvert 1.28.0: roads with `rule="LHT"` become a net without `lefthand`, whose lanes run for right-hand traffic. The limit
of a road's type is not read: a lane without a limit of its own gets the default speed of its `type`.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final, NamedTuple

from drivelint.formats.safe_xml import number_or_nan

if TYPE_CHECKING:
    from collections.abc import Mapping

    from lxml import etree

    from drivelint.road.quality import MapQuality

_HEAD_BYTES: Final = 20_000
_SOURCE_OPTION: Final = re.compile(rb'<opendrive(?:-files)? value="([^"]*)"')


class OpenDriveImport(NamedTuple):
    """The OpenDRIVE file from which a net was made, and the default speed (m/s) of each type of lanes."""

    file: str
    default_mps: Mapping[str, float]

    def has_default_limit(self, lane: etree._Element, edge: etree._Element, limit_mps: float) -> bool:
        """Return whether a lane's limit equals the default of its type, and so may not be the road's limit."""
        return limit_mps == self.default_mps.get(lane.get("type") or edge.get("type") or "")


def opendrive_import(content: bytes, root: etree._Element, quality: MapQuality) -> OpenDriveImport | None:
    """Return the OpenDRIVE source of a net, from the configuration in its first comment, and warn in `quality`; None without one."""
    match = _SOURCE_OPTION.search(content[:_HEAD_BYTES].partition(b"-->")[0])
    if match is None:
        return None
    file = match[1].decode("utf-8", "replace")
    message = f"netconvert imported this net from the OpenDRIVE file {file}: its side of traffic and limits may be lost: give that file"
    quality.add("imported_net", "warning", None, message)
    speeds = {element.get("id", ""): number_or_nan(element.get("speed", "")) for element in root.iterfind("type")}
    return OpenDriveImport(file, speeds)
