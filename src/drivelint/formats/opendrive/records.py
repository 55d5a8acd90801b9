"""Records along a road: each applies from its station to that of the next."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable


def record_spans(starts: Iterable[float], start: float, end: float) -> list[tuple[int, float, float]]:
    """Return (record index, from, to) of the records that apply between two stations; index -1: before the first record."""
    edges = [float("-inf"), *starts, float("inf")]
    spans = [(i - 1, max(a, start), min(b, end)) for i, (a, b) in enumerate(pairwise(edges))]
    return [(i, a, b) for i, a, b in spans if b - a > 1e-6]
