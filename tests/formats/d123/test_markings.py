"""Markings of the lanes of 123D maps: from road lines that lie on their bounds."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.formats.d123.files import Object, load, road_line, straight

DASH_SOLID, DASHED, DOUBLE_SOLID, DOUBLE_DASH_YELLOW, SOLID, SOLID_DASH, UNKNOWN = 3, 4, 6, 8, 11, 12, 1
Marks = list[tuple[float, float, str | None]]


def marks(tmp_path: Path, objects: list[Object], **header: Any) -> dict[tuple[str, str], Marks]:
    rows = load(tmp_path, objects, **header).tables["lane_boundary"].to_pylist()
    found: dict[tuple[str, str], Marks] = {}
    for row in rows:
        span = (round(row["s_start_m"], 6), round(row["s_end_m"], 6), row["marking"])
        found.setdefault((row["lanelet_id"], row["side"]), []).append(span)
    return found


def test_a_line_on_a_bound_marks_it(tmp_path: Path) -> None:
    """Whichever way the line was drawn; beside a bound without a line nothing is known."""
    lanes = [straight(1, 0, 40, 0.0), straight(2, 0, 40, 3.5)]
    found = marks(tmp_path, [*lanes, road_line(1, DASHED, [(60, 1.72), (-20, 1.72)])])
    assert found["1", "left"] == found["2", "right"] == [(0.0, 40.0, "broken")]
    assert found["1", "right"] == found["2", "left"] == [(0.0, 40.0, None)]


def test_a_line_on_a_part_of_a_bound(tmp_path: Path) -> None:
    lines = [road_line(1, SOLID, [(0, 1.75), (20, 1.75)]), road_line(2, DASHED, [(20, 1.75), (30, 1.75)])]
    found = marks(tmp_path, [straight(1, 0, 40, 0.0), *lines])
    assert found["1", "left"] == [(0.0, 20.0, "solid"), (20.0, 30.0, "broken"), (30.0, 40.0, None)]


@pytest.mark.parametrize("y", [1.9, 1.6])
def test_a_line_beside_a_bound_is_not_the_bounds(tmp_path: Path, y: float) -> None:
    found = marks(tmp_path, [straight(1, 0, 40, 0.0), road_line(1, SOLID, [(0, y), (40, y)])])
    assert found["1", "left"] == [(0.0, 40.0, None)]


def test_a_line_across_a_bound_does_not_mark_it(tmp_path: Path) -> None:
    found = marks(tmp_path, [straight(1, 0, 40, 0.0), road_line(1, SOLID, [(21, -5), (21, 5)])])
    assert found["1", "left"] == [(0.0, 40.0, None)]


@pytest.mark.parametrize(("second_kind", "word"), [(SOLID, "solid"), (DASHED, None), (UNKNOWN, None)])
def test_lines_that_disagree(tmp_path: Path, second_kind: int, word: str | None) -> None:
    lines = [road_line(k, kind, [(0, 1.75), (40, 1.75)]) for k, kind in enumerate((SOLID, second_kind))]
    assert marks(tmp_path, [straight(1, 0, 40, 0.0), *lines])["1", "left"] == [(0.0, 40.0, word)]


@pytest.mark.parametrize(
    ("kind", "dataset", "word"),
    [
        (DOUBLE_SOLID, "nuplan", "solid_solid"), (DASH_SOLID, "nuplan", None), (SOLID_DASH, "nuplan", None),
        (DOUBLE_DASH_YELLOW, "nuplan", "broken_broken"), (DOUBLE_DASH_YELLOW, "wod-motion", None), (99, "nuplan", None),
    ],
)  # fmt: skip
def test_double_lines(tmp_path: Path, kind: int, dataset: str, word: str | None) -> None:
    """Of a solid line beside a broken one nobody knows which is nearer; Waymo's may be such a one."""
    objects = [straight(1, 0, 40, 0.0), road_line(1, kind, [(0, 1.75), (40, 1.75)])]
    assert marks(tmp_path, objects, dataset=dataset)["1", "left"] == [(0.0, 40.0, word)]


def bound(x0: float, x1: float, y: float) -> list[tuple[float, float, float]]:
    return [(x0, y, 0.0), (x1, y, 0.0)]


def test_lines_that_are_the_lanes_own_bounds(tmp_path: Path) -> None:
    """Argoverse's, in the order of the lanes, left before right; a bound that is not painted has none."""
    lanes = [straight(1, 0, 40, 0.0), straight(2, 0, 40, 3.5), straight(3, 40, 80, 0.0)]
    lines = [
        road_line(0, DASH_SOLID, bound(0, 40, 1.75)), road_line(1, SOLID, bound(0, 40, -1.75)),
        road_line(2, SOLID_DASH, bound(0, 40, 1.75)), road_line(3, UNKNOWN, bound(40, 80, -1.75)),
    ]  # fmt: skip
    found = marks(tmp_path, [*lanes, *lines], dataset="av2-sensor")
    words = {key: spans[0][2] for key, spans in found.items()}
    assert words == {
        ("1", "left"): "broken_solid", ("1", "right"): "solid", ("2", "left"): "none", ("2", "right"): "solid_broken",
        ("3", "left"): "none", ("3", "right"): None,
    }  # fmt: skip


def test_lines_in_another_order_are_read_by_their_place(tmp_path: Path) -> None:
    lines = [road_line(0, DASHED, bound(0, 40, -1.75)), road_line(1, SOLID, bound(0, 40, 1.75))]
    found = marks(tmp_path, [straight(1, 0, 40, 0.0), *lines], dataset="av2-sensor")
    assert found == {("1", "left"): [(0.0, 40.0, "solid")], ("1", "right"): [(0.0, 40.0, "broken")]}


def test_a_map_without_lines_says_nothing(tmp_path: Path) -> None:
    found = marks(tmp_path, [straight(1, 0, 40, 0.0)])
    assert {spans[0][2] for spans in found.values()} == {None}
