"""Who may use a lane: OpenDRIVE's `<access>`, which older files have instead of the lane types `bus` and `taxi`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.formats.opendrive.xml import number_attribute

if TYPE_CHECKING:
    from lxml import etree

_CARS: Final = frozenset({"passengerCar", "autonomousTraffic", "autonomous traffic", "throughTraffic", "simulator"})
"""The words of ASAM OpenDRIVE (e_accessRestrictionType) for a car; `none` restricts nothing."""


def lane_type_and_unread(lane: etree._Element, lane_type: str) -> tuple[str, bool]:
    """Return the type of a lane by its `<access>` elements, and whether these keep cars out in a way that no lane type shows.

    A driving lane that is for buses all along, also with taxis or cycles, is of type `bus`; one for taxis of type `taxi`. Errors:
    `MalformedError` if a station is no number.
    """
    allowed: set[str] = set()
    denied: set[str] = set()
    stations = set()
    for access in lane.findall("access"):
        stated = [access.get("restriction"), *(part.get("type") for part in access.findall("restriction"))]
        words = {word for word in stated if word is not None and word != "none"}
        if not words:
            continue
        stations.add(number_attribute(access, "sOffset", 0.0))
        # before OpenDRIVE 1.5 an access had no rule: it is not stated whether the word is for who may, or for who may not
        for rule, of_rule in (("allow", allowed), ("deny", denied)):
            if access.get("rule", rule) == rule:
                of_rule.update(words)
    keeps_cars_out = bool(allowed) and (not allowed & _CARS or bool(denied & _CARS) or len(stations) > 1)
    if not keeps_cars_out and not denied & _CARS:
        return lane_type, False
    if lane_type == "driving" and stations == {0.0} and not denied:
        for word in ("bus", "taxi"):
            if word in allowed:
                return word, False
    return lane_type, True
