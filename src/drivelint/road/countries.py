"""Finds the country that a code of ISO 3166-1 means, as maps and logs write it."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Final

from drivelint.facts import toml_beside

if TYPE_CHECKING:
    from collections.abc import Iterable

_LEFT_DRIVEN: Final = frozenset({
    "au", "bd", "cy", "gb", "hk", "id", "ie", "in", "jp", "ke", "lk", "mt", "my", "np", "nz", "pk", "sg", "th", "tz", "ug", "za",
    "zm", "zw",
})  # fmt: skip
"""The larger countries that drive on the left."""


def nation_of(code: str | int | None) -> str | None:
    """Return the two letters of a country by its two or three letters, in any case, or its number; None: no country's."""
    return _nations().get(code.strip().lower() if isinstance(code, str) else code)


def side_of_nation(nation: str) -> str:
    """Return lht or rht: the side of the road that is driven on in a country."""
    return "lht" if nation in _LEFT_DRIVEN else "rht"


def only_nation(codes: Iterable[str | None]) -> str | None:
    """Return the country if all codes of countries are of one; None: they are of several, or there is none."""
    nations = {nation for code in codes if (nation := nation_of(code))}
    return nations.pop() if len(nations) == 1 else None


@cache
def _nations() -> dict[str | int | None, str]:
    countries: dict[str, tuple[str, int]] = toml_beside(__file__, "countries.toml")["countries"]
    found: dict[str | int | None, str] = {"uk": "gb"}
    for letters, (three, number) in countries.items():
        found |= {letters: letters, three: letters, number: letters}
    return found
