"""Reads who may use a lane from OpenDRIVE's `<access>` and `<rule>`.

Files without the lane types `bus` and `taxi` state such lanes by `<access>`. Until OpenDRIVE 1.7, `<rule>` has a free text; the standard
recommends three.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.formats.opendrive.xml import number_attribute

if TYPE_CHECKING:
    from lxml import etree

_CAR: Final = "passengerCar"
_SOME_CARS: Final = frozenset({_CAR, "autonomousTraffic", "autonomous traffic", "throughTraffic", "simulator"})
"""The words of ASAM OpenDRIVE (e_accessRestrictionType) for a car, and for cars of some kind; `none` restricts nothing."""

_RULES_FOR_EVERYBODY: Final = frozenset({"no stopping at any time", "disabled parking", "none", ""})
"""The texts of `<rule>` that keep nobody out of the lane; what another text says is not known."""


def lane_type_and_unread(lane: etree._Element, lane_type: str) -> tuple[str, bool]:
    """Return the type of a lane by its `<access>` elements, and whether cars are or may be kept out in a way that no lane type shows.

    A driving lane that is for buses all along, also with taxis or cycles, is of type `bus`; one for taxis of type `taxi`. Errors:
    `MalformedError` if a station is no number.
    """
    vehicles: set[str] = set()
    denied: set[str] = set()
    stations = set()
    for access in lane.findall("access"):
        stated = [access.get("restriction"), *(part.get("type") for part in access.findall("restriction"))]
        words = {word for word in stated if word is not None and word != "none"}
        if not words:
            continue
        stations.add(number_attribute(access, "sOffset", 0.0))
        # Before OpenDRIVE 1.5 an access had no rule: its words may be those of either.
        if access.get("rule") != "deny":
            vehicles |= words
        if access.get("rule") != "allow":
            denied |= words
    is_unread = any(rule.get("value", "").strip().lower() not in _RULES_FOR_EVERYBODY for rule in lane.findall("rule"))
    is_unread |= lane.get("roadWorks", lane.get("roadworks")) in {"true", "1"}
    cars_are_allowed = not vehicles or (_CAR in vehicles and len(stations) == 1)
    if cars_are_allowed and not denied & _SOME_CARS:
        return lane_type, is_unread
    if lane_type == "driving" and stations == {0.0} and not denied:
        for word in ("bus", "taxi"):
            if word in vehicles:
                return word, is_unread
    return lane_type, True
