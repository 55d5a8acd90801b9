"""Names the opposite driving side, and says how a user corrects a wrong one."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from drivelint.road.quality import MapQuality


def opposite_side(side: str) -> str:
    """Return rht for lht, and lht for rht."""
    return "lht" if side == "rht" else "rht"


def correction_hint(side: str, source: str) -> str:
    """Return what the user must do for the opposite side; `source`: what chose `side`, such as option, attribute or lanes."""
    return (
        f"leave the option out, or give {opposite_side(side)}"
        if source == "option"
        else f"give --handedness {opposite_side(side)}"
    )


def choose_side(
    statements: Iterable[tuple[str, str | None]], quality: MapQuality, where: str = "the map"
) -> tuple[str, str]:
    """Return the side driven on and what says so: the first of (source, side) that has a side; report that others disagree."""
    said = [(source, side) for source, side in statements if side is not None]
    if not said:
        message = f"nothing in {where} says which side is driven on: right-hand traffic is a guess; give --handedness"
        quality.add("handedness_default", "warning", None, message)
        return "rht", "default"
    source, side = said[0]
    if len({side for _, side in said}) > 1:
        opinions = ", ".join(f"{source}: {side}" for source, side in said)
        message = f"{opinions}; the first is taken: if it is wrong, {correction_hint(side, source)}"
        quality.add("handedness_disagrees", "warning", None, message)
    return side, source
