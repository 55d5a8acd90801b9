"""Translates the code of a signal (a sign or light) into the values of the `traffic_signal` table.

The codes are in `signcodes.toml`; countries, names and arrows are in `signnames.toml`. If a code is unknown, the signal's name may show
its kind.
"""

from __future__ import annotations

import re
from functools import cache
from typing import Final

from drivelint.facts import toml_beside
from drivelint.road.countries import nation_of

_NAMES_AND_ARROWS: Final = toml_beside(__file__, "signnames.toml")
_KINDS_BY_NAME_PATTERN: Final = [(re.compile(pattern), kind) for kind, pattern in _NAMES_AND_ARROWS["names"].items()]
_ARROW_LIGHT_CODES: Final = frozenset({"1000010", "1000011", "1000012"})
_CODE_WITH_DOTS: Final = re.compile(r"\d\.\d{3}\.\d{3}")


def signal_kind(country: str, code: str, name: str, subtype: str = "") -> str | None:
    """Return the kind of a signal by country (any case), code, subtype and name; None: not recognised."""
    codes = _kind_by_code(_NAMES_AND_ARROWS["countries"].get(country.lower(), ""))
    plain = _code_without_dots(code).upper()
    for candidate in (plain, plain.partition("-")[0] if plain[:1].isdecimal() else plain.replace("-", "")):
        if candidate in codes:
            return codes[candidate]
    if _speeds_without_unit(country, code, subtype):
        return "speed_limit"
    lowered = name.lower().replace(" ", "_").replace("-", "_")
    return next((kind for pattern, kind in _KINDS_BY_NAME_PATTERN if pattern.search(lowered)), None)


def has_codes_of(country: str) -> bool:
    """Return whether the codes of a country (as maps write it, any case) are known."""
    return country.lower() in _NAMES_AND_ARROWS["countries"]


def speed_without_unit_kmh(country: str, code: str, subtype: str, value: float) -> float | None:
    """Return the speed (km/h) on a speed limit sign for which the map states a number but no unit; None: it may have another unit."""
    return _speeds_without_unit(country, code, subtype).get(f"{value:g}")


def _speeds_without_unit(country: str, code: str, subtype: str) -> dict[str, float]:
    """Return number -> speed (km/h) of the speed limit signs of a code; none if it is another code."""
    codes: dict[str, dict[str, float]] = _NAMES_AND_ARROWS["speeds_without_unit"].get(nation_of(country), {})
    plain = _code_without_dots(code).lower().partition("-")[0]
    return codes.get(plain) or codes.get(f"{plain}.{subtype.lower()}") or {}


def signal_codes_by_list(kind: str) -> dict[str, list[str]]:
    """Return name of a list (OpenDRIVE, de, gb, us, es) -> its codes for this kind of signal; lists without such a code are left out."""
    return dict(toml_beside(__file__, "signcodes.toml").get(kind, {}))


@cache
def _kind_by_code(country: str) -> dict[str, str]:
    """Return code -> kind, from the lists of OpenDRIVE and of the country."""
    return {
        code: kind
        for kind, lists in toml_beside(__file__, "signcodes.toml").items()
        for name in ("OpenDRIVE", country)
        for code in lists.get(name, ())
    }


def turns_of_light_code(code: str, subtype: str) -> list[str] | None:
    """Return the turns that an OpenDRIVE traffic light applies to, by its code; None: the code does not show it.

    Source: the signal list of OpenDRIVE as openPASS reads it (1.000.011: arrows 10 left, 20 right, 30 straight, 40 left
    and straight, 50 right and straight) and SUMO writes it.
    """
    plain, finer = _code_without_dots(code), subtype.lower().removesuffix(".0")
    if finer in _NAMES_AND_ARROWS["full_lights"].get(plain, ()):
        return turns_of_light_direction("all")
    return list(_NAMES_AND_ARROWS["arrows"].get(finer, ())) or None if plain in _ARROW_LIGHT_CODES else None


def turns_of_light_direction(word: str) -> list[str] | None:
    """Return the turns that a CommonRoad traffic light applies to, by its `direction`; None: unknown word."""
    return list(_NAMES_AND_ARROWS["directions"].get(word, ())) or None


def _code_without_dots(code: str) -> str:
    """Return a code without dots between thousands (1.000.011), or without a final `.0`."""
    return code.replace(".", "") if _CODE_WITH_DOTS.fullmatch(code) else code.removesuffix(".0")
