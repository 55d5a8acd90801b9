"""The connections of junctions and the cross paths over them, as the file records them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from drivelint.formats.opendrive.xml import MalformedError, integer_attribute, required_attribute

if TYPE_CHECKING:
    from collections.abc import Iterator

    from lxml import etree

    from drivelint.road.quality import MapQuality

START, END = "start", "end"


@dataclass(frozen=True)
class Connection:
    """A connection in a junction: from lanes of the incoming road to lanes of the connecting road."""

    junction_id: str
    incoming: str
    connecting: str
    contact: str  # end of the connecting road that is entered
    lanes: tuple[tuple[int, int], ...]


class CrossPath(NamedTuple):
    """A `<crossPath>` of a junction, as it stands in the file."""

    junction_id: str
    element: etree._Element


def connections(root: etree._Element, quality: MapQuality) -> Iterator[Connection]:
    """Yield the connections of the junctions; those that cannot be read are left out and reported in `quality`."""
    for junction in root.findall("junction"):
        name = junction.get("id", f"in line {junction.sourceline}")
        if junction.get("type") == "virtual":
            if junction.find("connection") is not None:
                message = f"junction {name} is virtual: its links in the middle of roads are left out"
                quality.add("virtual_junction", "warning", name, message)
            continue
        for element in junction.findall("connection"):
            try:
                yield _connection(name, element)
            except MalformedError as error:
                message = f"a connection of junction {name} is left out: {error}"
                quality.add("invalid_connection", "error", name, message)


def _connection(junction_id: str, element: etree._Element) -> Connection:
    contact = required_attribute(element, "contactPoint")
    if contact not in {START, END}:
        raise MalformedError(f"<connection> in line {element.sourceline}: contactPoint={contact!r}")
    return Connection(
        junction_id=junction_id,
        incoming=required_attribute(element, "incomingRoad"),
        connecting=element.get("connectingRoad") or required_attribute(element, "linkedRoad"),
        contact=contact,
        lanes=tuple(
            (integer_attribute(link, "from"), integer_attribute(link, "to")) for link in element.findall("laneLink")
        ),
    )


def cross_paths(root: etree._Element) -> tuple[CrossPath, ...]:
    """Return the cross paths of all junctions."""
    return tuple(
        CrossPath(junction.get("id", ""), element)
        for junction in root.findall("junction")
        for element in junction.findall("crossPath")
    )
