"""A map is refused for whose ground the database would take more memory than reading a file of its size may."""

from __future__ import annotations

import pyarrow as pa
import pytest

from drivelint.errors import MapError
from drivelint.formats import load_map, map_registry
from drivelint.road.ground import approximate_square_count
from drivelint.road.map_reader import MapSource
from tests.hostile import huge


def points(*rows: tuple[str, float, float, float]) -> pa.Table:
    lane, x, y, half = zip(*rows, strict=True)
    return pa.table({"lanelet_id": list(lane), "x_m": list(x), "y_m": list(y), "half_width_m": list(half)})


def test_squares_are_those_of_boxes_round_segments() -> None:
    straight = (("a", 0.0, 0.0, 1.5), ("a", 10.0, 0.0, 1.0))
    assert approximate_square_count(points(*straight)) == 7.5 * 2.5
    aslant = (("b", 50.0, 0.0, 2.0), ("b", 56.0, 8.0, 2.0), ("b", 62.0, 16.0, 2.0))
    assert approximate_square_count(points(*straight, *aslant)) == 7.5 * 2.5 + 2 * 6.0 * 7.0
    assert approximate_square_count(points(("a", 0.0, 0.0, 1.5))) == 0.0


def test_a_road_network_for_a_small_file_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of 100,000 lanes in 12 MB: the database took over 8 GB, and did not end."""
    road = MapSource("huge", huge.opendrive(12, 6).encode())
    assert load_map(road).tables["lanelet"].num_rows == 72
    monkeypatch.setattr(map_registry, "BYTES_PER_SQUARE", 1_000_000)
    told = (
        r"^map huge: its 72 lanes cover 18\d\d\d squares of 2 m, .* more than the limit of 2048 MiB for "
        r"a map of \d+ bytes: give a smaller part"
    )
    with pytest.raises(MapError, match=told):
        load_map(road)
