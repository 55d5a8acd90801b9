"""A road as a mirror shows it: OpenDRIVE with left and right exchanged."""

from __future__ import annotations

from lxml import etree

_SIGNED = {  # element: attributes that change their sign with the side
    "geometry": ("y", "hdg"), "arc": ("curvature",), "laneOffset": ("a", "b", "c", "d"), "lane": ("id",),
    "signal": ("t", "hOffset"), "object": ("t", "hdg"), "cornerRoad": ("t",), "cornerLocal": ("v",),
    "laneLink": ("from", "to"), "validity": ("fromLane", "toLane"),
}  # fmt: skip
_SWAPPED = {"left": "right", "right": "left"}
_KEPT = {
    "OpenDRIVE", "header", "road", "link", "type", "speed", "planView", "line", "lanes", "laneSection", "center", "width", "roadMark",
    "predecessor", "successor", "signals", "objects", "outline", "outlines", "junction", "connection", "access", "userData", "priority",
    "controller", "control", "elevationProfile", "elevation", "lateralProfile", "geoReference", "markings", "marking",
} | _SIGNED.keys() | _SWAPPED.keys()  # fmt: skip


def mirrored_map(text: str) -> str:
    """Return the text of the mirrored map. Errors: `LookupError` for an element of which nobody has thought yet."""
    root = etree.fromstring(text.encode())
    for element in root.iter(etree.Element):
        name = str(element.tag)
        if name not in _KEPT:
            raise LookupError(f"<{name}>: say in _SIGNED or _KEPT how a mirror shows it")
        for attribute in _SIGNED.get(name, ()):
            if attribute in element.attrib:
                element.attrib[attribute] = _negated(str(element.attrib[attribute]))
        if name in {"predecessor", "successor"} and "id" in element.attrib:  # of a lane: roads have an elementId
            element.attrib["id"] = _negated(str(element.attrib["id"]))
        if name == "road" and "rule" in element.attrib:
            element.attrib["rule"] = {"LHT": "RHT", "RHT": "LHT"}[str(element.attrib["rule"])]
    for section in root.iter("laneSection"):
        sides = {str(side.tag): side for side in section if side.tag in _SWAPPED}
        for name, side in sides.items():
            side.tag = _SWAPPED[name]
            side[:] = reversed(side)
        section[:] = sorted(section, key=lambda side: ("left", "center", "right").index(str(side.tag)))
    return etree.tostring(root, encoding="unicode")


def _negated(number: str) -> str:
    if not float(number):
        return number
    return number[1:] if number.startswith("-") else f"-{number}"
