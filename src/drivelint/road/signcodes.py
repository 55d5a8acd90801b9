"""Translates a signal's code into the values of the `traffic_signal` table.

The codes stand in `signcodes.toml`. Where a code is not known, the signal's name may say its kind.
"""

from __future__ import annotations

import re
from functools import cache

from drivelint.resources import facts

_ALL_TURNS = ("left", "straight", "right", "u_turn")
_FULL_LIGHTS = {"1000001": {"", "-1", "0", "none"}, "1000009": {"", "-1", "10", "20", "30"}}  # and their subtypes
_ARROW_LIGHTS = {"1000010", "1000011", "1000012"}
_ARROWS = {
    "10": ("left",), "20": ("right",), "30": ("straight",), "40": ("left", "straight"), "50": ("straight", "right"),
}  # fmt: skip
# CommonRoad's words
_DIRECTIONS = {
    "all": _ALL_TURNS, "left": ("left",), "straight": ("straight",), "right": ("right",),
    "leftStraight": ("left", "straight"), "straightRight": ("straight", "right"), "leftRight": ("left", "right"),
}  # fmt: skip
_DOTTED = re.compile(r"\d\.\d{3}\.\d{3}")
_COUNTRIES = {
    **dict.fromkeys(
        ("", "opendrive", "de", "deu", "germany"), "de"
    ),  # RoadRunner and CARLA write StVO numbers without a country
    **dict.fromkeys(("gb", "gbr", "uk", "united kingdom"), "gb"),
    **dict.fromkeys(("us", "usa"), "us"),
    **dict.fromkeys(("es", "esp", "spain"), "es"),
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
    codes = _kinds(_COUNTRIES.get(country.lower(), ""))
    plain = _plain(code).upper()
    for candidate in (plain, plain.partition("-")[0] if plain[:1].isdecimal() else plain.replace("-", "")):
        if candidate in codes:
            return codes[candidate]
    lowered = name.lower().replace(" ", "_").replace("-", "_")
    return next((kind for pattern, kind in _NAMES if pattern.search(lowered)), None)


def codes_of(kind: str) -> dict[str, list[str]]:
    """Return the codes of a kind of signal by whose list they are: OpenDRIVE's, de, gb, us, es; lists without one are left out."""
    found: dict[str, list[str]] = facts(__file__, "signcodes.toml").get(kind, {})
    return found


@cache
def _kinds(country: str) -> dict[str, str]:
    """Return code -> kind, of OpenDRIVE's list and of a country's."""
    return {
        code: kind
        for kind, lists in facts(__file__, "signcodes.toml").items()
        for name in ("OpenDRIVE", country)
        for code in lists.get(name, ())
    }


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
