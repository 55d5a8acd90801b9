"""Cuts every lane section of an OpenDRIVE map in two: the road stays the same."""

from __future__ import annotations

from copy import deepcopy
from itertools import pairwise

from lxml import etree

LEAST_SECTION_M = 1.0


def with_sections_cut(text: str, share: float = 0.5) -> str:
    """Return the text of the map with each lane section cut at this share of its length; sections of less than a metre stay whole."""
    root = etree.fromstring(text.encode())
    for road in root.iter("road"):
        sections = road.findall("lanes/laneSection")
        starts = [float(section.get("s", "0")) for section in sections] + [float(road.get("length", "0"))]
        for section, (start, end) in zip(sections, pairwise(starts), strict=True):
            if end - start >= LEAST_SECTION_M:
                _cut(section, start, round(start + share * (end - start), 3))
    return etree.tostring(root, encoding="unicode")


def _cut(section: etree._Element, start_m: float, at_m: float) -> None:
    later = deepcopy(section)
    later.set("s", repr(at_m))
    for record in later.iterfind(".//lane/*"):
        if "sOffset" in record.attrib:  # counted from the start of the section
            record.set("sOffset", repr(float(record.get("sOffset", "0")) - (at_m - start_m)))
    for part, end in ((section, "successor"), (later, "predecessor")):
        for lane in part.iter("lane"):
            if lane.get("id") != "0":
                _link(lane, end)
    section.addnext(later)


def _link(lane: etree._Element, end: str) -> None:
    """Link a lane at one end to the lane of its own number."""
    link = lane.find("link")
    if link is None:
        link = etree.Element("link")
        lane.insert(0, link)
    for old in link.findall(end):
        link.remove(old)
    etree.SubElement(link, end).set("id", lane.get("id", ""))
