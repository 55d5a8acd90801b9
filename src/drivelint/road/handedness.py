"""Names the opposite driving side, and says how a user corrects a wrong one."""

from __future__ import annotations


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
