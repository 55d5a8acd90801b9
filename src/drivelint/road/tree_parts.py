"""Queries a spatial index in parts, to limit memory: if many shapes overlap, all pairs at once may not fit."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from typing import Literal

    import shapely
    from numpy.typing import NDArray

    from drivelint.arrays import Indices

SHAPES_IN_FIRST_PART: Final = 8
MOST_GROWTH_FACTOR_OF_PART: Final = 8
PAIRS_PER_PART: Final = 1_000_000
"""The aim for the number of pairs in a part; the size of a part follows from the pairs per shape in the part before."""
MOST_SHAPES_AT_ONE_PLACE: Final = 1000
"""The most shapes found per query shape, as the mean of a part. Real maps have at most 12."""


class CrowdedPlaceError(Exception):
    """Raised if more shapes overlap at one position than in any road network."""

    def __init__(self, n: int) -> None:
        super().__init__(f"{n} lanes or lines overlap at one place")


def query_in_parts(
    tree: shapely.STRtree,
    shapes: Sequence[shapely.Geometry] | NDArray[np.object_],
    predicate: Literal["intersects", "within", "dwithin"],
    distance: float | None = None,
) -> Iterator[tuple[Indices, Indices]]:
    """Yield the result of `tree.query` in parts: indices of `shapes`, ascending between parts, and indices of the tree's shapes.

    A time limit of reading takes effect between two parts, but not inside a call of the index. Errors: `CrowdedPlaceError` if a part has
    too many pairs.
    """
    every = np.asarray(shapes, dtype=object)
    begin, n = 0, SHAPES_IN_FIRST_PART
    while begin < len(every):
        shape, places = tree.query(every[begin : begin + n], predicate=predicate, distance=distance)
        if (n_at_one := len(places) // len(every[begin : begin + n])) > MOST_SHAPES_AT_ONE_PLACE:
            raise CrowdedPlaceError(n_at_one)
        yield shape + begin, places
        begin += n
        n = max(1, min(MOST_GROWTH_FACTOR_OF_PART * n, n * PAIRS_PER_PART // max(1, len(places))))


def all_pairs(
    tree: shapely.STRtree,
    shapes: Sequence[shapely.Geometry] | NDArray[np.object_],
    predicate: Literal["intersects", "within", "dwithin"],
    distance: float | None = None,
) -> tuple[Indices, Indices]:
    """Return all parts of `query_in_parts`, concatenated."""
    no_index = np.zeros(0, np.intp)
    parts = [(no_index, no_index), *query_in_parts(tree, shapes, predicate, distance)]
    first, second = (np.concatenate([part[k] for part in parts]) for k in (0, 1))
    return first, second
