"""The other side of the road, and what to do where the one that is taken is wrong."""

from __future__ import annotations


def other(side: str) -> str:
    """Return rht for lht, and lht for rht."""
    return "lht" if side == "rht" else "rht"


def correction(side: str, source: str) -> str:
    """Say how to have the other side; `source`: who says that it is `side`, such as option, attribute or lanes."""
    return f"leave the option out, or give {other(side)}" if source == "option" else f"give --handedness {other(side)}"
