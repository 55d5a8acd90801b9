"""Finds the country of an ISO 3166-1 code in a map or log, and its driving side."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Final

from drivelint.facts import toml_beside

if TYPE_CHECKING:
    from collections.abc import Iterable

_LEFT_DRIVING_NATIONS: Final = frozenset({
    "au", "bd", "cy", "gb", "hk", "id", "ie", "in", "jp", "ke", "lk", "mt", "my", "np", "nz", "pk", "sg", "th", "tz", "ug", "za",
    "zm", "zw",
})  # fmt: skip
"""The larger countries that drive on the left."""


def nation_of(code: str | int | None) -> str | None:
    """Return the two-letter code of a country by its two or three letters, in any case, or its number; None: unknown code."""
    return _nation_by_code().get(code.strip().lower() if isinstance(code, str) else code)


def side_of_nation(nation: str) -> str:
    """Return the driving side (lht, rht) of a country."""
    return "lht" if nation in _LEFT_DRIVING_NATIONS else "rht"


def only_nation(codes: Iterable[str | None]) -> str | None:
    """Return the country that all known codes mean; None: they mean several countries, or no code is known."""
    nations = {nation for code in codes if (nation := nation_of(code))}
    return nations.pop() if len(nations) == 1 else None


@cache
def _nation_by_code() -> dict[str | int | None, str]:
    countries: dict[str, tuple[str, int]] = toml_beside(__file__, "countries.toml")["countries"]
    nations: dict[str | int | None, str] = {"uk": "gb"}
    for letters, (three, number) in countries.items():
        nations |= {letters: letters, three: letters, number: letters}
    return nations
