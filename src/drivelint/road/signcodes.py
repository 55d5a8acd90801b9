"""Translates a signal's code into the values of the `traffic_signal` table.

OpenDRIVE's own list (numbers from 1000001), the German catalogue (StVO sign numbers, which RoadRunner and CARLA also
use under the country OpenDRIVE), the British one (TSRGD diagram numbers), the American one (MUTCD) and the Spanish one
(Reglamento General de Circulacion), as far as rules ask for them. Where the code is not known, the signal's name may say it.
"""

from __future__ import annotations

import re

_LIGHTS = {
    "1000001": "traffic_light", "1000002": "pedestrian_light", "1000007": "pedestrian_light",
    "1000009": "traffic_light", "1000010": "traffic_light", "1000011": "traffic_light", "1000012": "traffic_light",
    "1000013": "bicycle_light",
}  # fmt: skip
_ALL_TURNS = ("left", "straight", "right", "u_turn")
_FULL_LIGHTS = {"1000001": {"", "-1", "0", "none"}, "1000009": {"", "-1", "10", "20", "30"}}  # and their subtypes
_ARROW_LIGHTS = {"1000010", "1000011", "1000012"}
_ARROWS = {
    "10": ("left",),
    "20": ("right",),
    "30": ("straight",),
    "40": ("left", "straight"),
    "50": ("straight", "right"),
}
# CommonRoad's words
_DIRECTIONS = {
    "all": _ALL_TURNS, "left": ("left",), "straight": ("straight",), "right": ("right",),
    "leftStraight": ("left", "straight"), "straightRight": ("straight", "right"), "leftRight": ("left", "right"),
}  # fmt: skip
_STVO = {
    "205": "give_way", "206": "stop", "208": "give_way_to_oncoming", "215": "roundabout", "220": "one_way",
    "250": "no_vehicles", "267": "no_entry", "274": "speed_limit", "274.1": "speed_zone", "274.2": "speed_zone_end",
    "275": "minimum_speed", "276": "no_overtaking", "277": "no_overtaking_trucks", "278": "speed_limit_end",
    "280": "no_overtaking_end", "281": "no_overtaking_trucks_end", "282": "restrictions_end", "283": "no_stopping",
    "286": "no_parking", "293": "crossing", "294": "stop_line", "301": "priority_here", "306": "priority_road",
    "307": "priority_road_end", "308": "priority_over_oncoming", "310": "town_entrance", "311": "town_exit",
    "330.1": "motorway", "330.2": "motorway_end", "331.1": "expressway", "331.2": "expressway_end", "332": "exit",
    "333": "exit", "350": "crossing", "448": "exit", "449": "exit", "450": "exit",
}  # fmt: skip
_TSRGD = {
    "601.1": "stop", "602": "give_way", "606": "one_way", "611": "roundabout", "615": "give_way_to_oncoming",
    "616": "no_entry", "632": "no_overtaking", "670": "speed_limit", "671": "restrictions_end",
    "672": "minimum_speed",
}  # fmt: skip
_MUTCD = {
    "R1-1": "stop", "R1-2": "give_way", "R2-1": "speed_limit", "R2-4": "minimum_speed", "R2-4P": "minimum_speed",
    "R4-1": "no_overtaking", "R4-2": "no_overtaking_end", "R5-1": "no_entry", "R5-1A": "no_entry", "R6-1": "one_way",
    "R6-1L": "one_way", "R6-1R": "one_way", "R6-2": "one_way", "R6-2L": "one_way", "R6-2R": "one_way",
    "R7-1": "no_parking", "R7-107": "no_parking", "R8-3": "no_parking",
}  # fmt: skip
_SPAIN = {
    "R1": "give_way", "R2": "stop", "R3": "priority_road", "R4": "priority_road_end", "R5": "give_way_to_oncoming",
    "R6": "priority_over_oncoming", "R100": "no_vehicles", "R101": "no_entry", "R301": "speed_limit",
    "R305": "no_overtaking", "R306": "no_overtaking_trucks", "R307": "no_stopping", "R308": "no_parking",
    "R411": "minimum_speed", "R500": "restrictions_end", "R501": "speed_limit_end", "R502": "no_overtaking_end",
    "R503": "no_overtaking_trucks_end", "S13": "crossing",
}  # fmt: skip
_DOTTED = re.compile(r"\d\.\d{3}\.\d{3}")
_COUNTRIES = {
    **dict.fromkeys(("", "opendrive", "de", "deu", "germany"), _LIGHTS | _STVO),
    **dict.fromkeys(("gb", "gbr", "uk", "united kingdom"), _LIGHTS | _TSRGD),
    **dict.fromkeys(("us", "usa"), _LIGHTS | _MUTCD),
    **dict.fromkeys(("es", "esp", "spain"), _LIGHTS | _SPAIN),
}
_NAMES = [
    (re.compile(pattern), kind)
    for pattern, kind in (
        (r"stop_?line", "stop_line"),
        (r"overtaking.*end", "no_overtaking_end"),
        (r"no_?overtaking|overtaking_?ban", "no_overtaking"),
        (r"speed_?lowest|min(imum)?_?speed", "minimum_speed"),
        (r"speed_?limit|speed_?highest|max(imum)?_?speed|^speed_\d", "speed_limit"),
        (r"give_?way|yield", "give_way"),
        (r"no_?entry", "no_entry"),
        (r"(^|[_ ])exit($|[_ \d])", "exit"),
        (r"(^|[_ ])stop($|[_ \d])", "stop"),
        (r"traffic_?light|signal_\dlight", "traffic_light"),
        (r"pedestrian_?crossing|crosswalk|zebra", "crossing"),
    )
]


def kind_of(country: str, code: str, name: str) -> str | None:
    """Return the kind of a signal by country (any case), code and name; None: not recognised."""
    codes = _COUNTRIES.get(country.lower(), _LIGHTS)
    plain = _plain(code).upper()
    for candidate in (plain, plain.partition("-")[0] if plain[:1].isdecimal() else plain.replace("-", "")):
        if candidate in codes:
            return codes[candidate]
    lowered = name.lower().replace(" ", "_").replace("-", "_")
    return next((kind for pattern, kind in _NAMES if pattern.search(lowered)), None)


def codes_of(kind: str) -> dict[str, list[str]]:
    """Return the codes of a kind of signal by whose list they are: OpenDRIVE's, de, gb, us, es; lists without one are left out."""
    lists = {"OpenDRIVE": _LIGHTS, "de": _STVO, "gb": _TSRGD, "us": _MUTCD, "es": _SPAIN}
    found = {name: [code for code, meant in codes.items() if meant == kind] for name, codes in lists.items()}
    return {name: codes for name, codes in found.items() if codes}


def turns_of(code: str, subtype: str) -> list[str] | None:
    """Return the turns that an OpenDRIVE traffic light holds for by its code; None: it does not say.

    Source: the signal list of OpenDRIVE as openPASS reads it (1.000.011: arrows 10 left, 20 right, 30 straight, 40 left
    and straight, 50 right and straight) and SUMO writes it.
    """
    plain, finer = _plain(code), subtype.lower().removesuffix(".0")
    if finer in _FULL_LIGHTS.get(plain, ()):
        return list(_ALL_TURNS)
    found = _ARROWS.get(finer) if plain in _ARROW_LIGHTS else None
    return list(found) if found else None


def turns_of_direction(word: str) -> list[str] | None:
    """Return the turns that a CommonRoad traffic light holds for by its `direction`; None: it does not say."""
    found = _DIRECTIONS.get(word)
    return list(found) if found else None


def _plain(code: str) -> str:
    """Return a code without the dots between thousands and without a decimal."""
    return code.replace(".", "") if _DOTTED.fullmatch(code) else code.removesuffix(".0")
