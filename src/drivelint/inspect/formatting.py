"""Formats amounts, sizes, distances, handedness and gaps as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.phrases import plural

if TYPE_CHECKING:
    from drivelint.inspect.model import Clock

_SOURCES: Final = {
    "option": "as --handedness says",
    "attribute": "as the map says",
    "junctions": "as the map's junctions are linked",
    "lanes": "as its lanes lie beside each other",
    "traces": "as the log's traffic drives",
    "default": "only by the standard's default: say it with --handedness",
}


def part_text(n: int, of: int) -> str:
    """Return `n` of a total as text: none, all, or `n of total`."""
    return "none" if n == 0 else ("all" if n == of else f"{n} of {of}") if of > 1 else "it is"


def size_text(n: int) -> str:
    """Return bytes in kB, MB or GB."""
    for unit, factor in (("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if n >= factor:
            return f"{n / factor:.1f} {unit}"
    return plural(n, "byte")


def distance_text(n: float) -> str:
    """Return a way driven."""
    return f"{n / 1000:.2f} km" if n >= 1000 else f"{n:.0f} m"


def handedness_text(handedness: str, source: str) -> str:
    """Return the side that is driven on, and who says so."""
    return f"{'left' if handedness == 'lht' else 'right'}-hand traffic, {_SOURCES.get(source, source)}"


def holes_text(clock: Clock) -> str:
    """Return the number and length of the gaps between time stamps, as text."""
    if not clock.holes:
        return "no holes"
    return (
        f"{plural(clock.holes, 'hole')}, the longest {clock.longest_hole_s or 0.0:.2f} s, "
        f"the first at {clock.first_hole_at_s or 0.0:.2f} s"
    )
