"""Finds the shapes of a tree that lie at others, some at a time: where all lie at one place, all pairs at once would take all memory."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from typing import Literal

    import shapely
    from numpy.typing import NDArray

    from drivelint.arrays import Indices

FIRST_PART: Final = 8
GROWTH: Final = 8
PAIRS_PER_PART: Final = 1_000_000
"""A part is asked for about so many pairs, by what the part before it gave for each shape."""
MOST_AT_ONE_PLACE: Final = 1000
"""Shapes that lie at another one, as the mean of a part. Real maps have 12 at most."""


class CrowdedPlaceError(Exception):
    """So many shapes lie at one place that this is no road network."""

    def __init__(self, n: int) -> None:
        super().__init__(f"{n} lanes or lines lie at one place")


def query_in_parts(
    tree: shapely.STRtree,
    shapes: Sequence[shapely.Geometry] | NDArray[np.object_],
    predicate: Literal["intersects", "within", "dwithin"],
    distance: float | None = None,
) -> Iterator[tuple[Indices, Indices]]:
    """Yield what `tree.query` returns, in parts: indices of `shapes`, which rise from part to part, and of the tree's shapes at them.

    Between two parts a limit of reading can strike: a single call does not look for it. Errors: `CrowdedPlaceError`, before what would
    take longest.
    """
    every = np.asarray(shapes, dtype=object)
    begin, n = 0, FIRST_PART
    while begin < len(every):
        shape, found = tree.query(every[begin : begin + n], predicate=predicate, distance=distance)
        if (n_at_one := len(found) // len(every[begin : begin + n])) > MOST_AT_ONE_PLACE:
            raise CrowdedPlaceError(n_at_one)
        yield shape + begin, found
        begin += n
        n = max(1, min(GROWTH * n, n * PAIRS_PER_PART // max(1, len(found))))


def all_in_parts(
    tree: shapely.STRtree,
    shapes: Sequence[shapely.Geometry] | NDArray[np.object_],
    predicate: Literal["intersects", "within", "dwithin"],
    distance: float | None = None,
) -> tuple[Indices, Indices]:
    """Return all parts of `query_in_parts` as one."""
    none = np.zeros(0, np.intp)
    parts = [(none, none), *query_in_parts(tree, shapes, predicate, distance)]
    first, second = (np.concatenate([part[k] for part in parts]) for k in (0, 1))
    return first, second
