"""Pairs of shapes are found in parts, as one call finds them; a place at which far too many lie is no road network's."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import shapely

from drivelint.errors import MapError
from drivelint.formats import load_map
from drivelint.road import tree_parts
from drivelint.road.map_reader import MapSource
from drivelint.road.tree_parts import CrowdedPlaceError, all_pairs, query_in_parts
from tests.hostile import huge

if TYPE_CHECKING:
    from collections.abc import Callable


def boxes(n: int, seed: int = 0) -> Any:
    """Return boxes of 10 m, strewn over a place of 200 m."""
    x, y = np.random.Generator(np.random.PCG64(seed)).uniform(0, 200, (2, n))
    return shapely.box(x, y, x + 10, y + 10)


@pytest.mark.parametrize("pairs_per_part", [1, 50, 1_000_000])
def test_parts_are_what_one_call_returns(pairs_per_part: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tree_parts, "PAIRS_PER_PART", pairs_per_part)
    tree, shapes = shapely.STRtree(boxes(300)), boxes(200, 1)
    for predicate, distance in (("intersects", None), ("dwithin", 3.0)):
        whole = tree.query(shapes, predicate=predicate, distance=distance)
        assert np.array_equal(np.stack(all_pairs(tree, shapes, predicate, distance)), whole)  # type: ignore[arg-type]
    assert [part.tolist() for part in all_pairs(tree, [], "intersects")] == [[], []]


def test_no_call_gives_far_more_pairs_than_a_part_may_have(monkeypatch: pytest.MonkeyPatch) -> None:
    """A limit of reading strikes between two calls alone: so none may take all memory."""
    monkeypatch.setattr(tree_parts, "PAIRS_PER_PART", 2000)
    same = [shapely.box(0, 0, 1, 1)] * 500
    sizes = [len(first) for first, _ in query_in_parts(shapely.STRtree(same), same, "intersects")]
    assert sum(sizes) == 500 * 500
    assert max(sizes) <= tree_parts.SHAPES_IN_FIRST_PART * 500


def test_a_crowded_place_is_told_before_the_work(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tree_parts, "MOST_SHAPES_AT_ONE_PLACE", 99)
    same = [shapely.box(0, 0, 1, 1)] * 100
    with pytest.raises(CrowdedPlaceError, match="100 lanes or lines overlap at one place"):
        next(query_in_parts(shapely.STRtree(same), same, "intersects"))


@pytest.mark.parametrize("make", [huge.opendrive, huge.lanelet2, huge.commonroad], ids=lambda make: make.__name__)
def test_a_map_whose_roads_all_lie_at_one_place_is_refused(
    make: Callable[..., str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """100,000 lanes at one place make 10,000,000,000 pairs."""
    monkeypatch.setattr(tree_parts, "MOST_SHAPES_AT_ONE_PLACE", 15)
    assert load_map(MapSource("apart", make(12, 6).encode())).tables["lanelet"].num_rows == 72
    with pytest.raises(
        MapError, match=r"^map one: \d+ lanes or lines overlap at one place, more than in any road network"
    ):
        load_map(MapSource("one", make(12, 6, apart=False).encode()))
