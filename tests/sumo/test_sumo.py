"""Some minutes of SUMO's traffic: overtakes and contacts are those of an independent reading. The hour: `python -m tests.sumo`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.sumo import compare, contacts, reading, world
from tests.sumo.comparison import run_comparison

if TYPE_CHECKING:
    from pathlib import Path

    from tests.demo.road import Handedness

needs_sumo = pytest.mark.skipif(
    world.tool("sumo") is None or world.tool("netconvert") is None,
    reason="SUMO is not installed (pip install eclipse-sumo, or set SUMO_HOME)",
)


@needs_sumo
def test_overtakes_and_contacts_are_those_of_an_independent_reading(tmp_path: Path) -> None:
    figures, differ = run_comparison(tmp_path, seconds=300, seed=4, per_kind=1)
    assert not differ
    assert figures["overtakes found"] >= 20
    assert figures["largest difference of DA (m)"] < 0.1
    for name in ("passed", "not passed", "nominal: pass", "nominal: fail", "nominal: unknown"):
        assert figures[name] >= 3, name
    assert figures["contacts found, SUMO's own with them"] >= figures["planted contacts"] == 6


@needs_sumo
@pytest.mark.parametrize("hand", ["left", "right"])
def test_overtakes_on_the_map_that_sumo_writes(tmp_path: Path, hand: Handedness) -> None:
    """It has a road for each direction and no word on the side that is driven on: the traffic tells."""
    files = world.simulate(tmp_path, seconds=80, seed=6, hand=hand)
    net = reading.read_net(files.net)
    log = reading.read_log(files.log, files.routes, net)
    one_way = files._replace(map=tmp_path / world.ONE_WAY_MAP)
    checked = compare.check(one_way, tmp_path / "out", rules=(compare.OVERTAKES,))
    differ, counts = compare.differences(reading.overtakes(log, net), checked, log)
    assert not differ
    assert counts["nominal: pass"] == 2


def test_the_reading_measures_along_a_bend_and_over_the_line() -> None:
    """A quarter of a circle of 100 m, driven at half a lane beside its line."""
    angle = np.linspace(0, np.pi / 2, 500)
    line = reading.Line(100 * angle, 100 * np.sin(angle), 100 - 100 * np.cos(angle))
    s, d = line.place(np.array([98.0 * np.sin(0.7)]), np.array([100 - 98.0 * np.cos(0.7)]), np.array([75.0]))
    assert s == pytest.approx(70.0, abs=0.01)
    assert d == pytest.approx(2.0, abs=0.001)


@pytest.mark.parametrize(("gap", "touches"), [(0.01, False), (-0.01, True)])
def test_contacts_of_boxes(gap: float, touches: bool) -> None:
    """Two boxes of 4 m by 2 m: one behind the other, and one across before the other."""
    nothing = np.zeros(4)
    log = reading.Log(
        ("a", "b"), ("car", "car"), np.array([[4.0, 2.0], [4.0, 2.0]]), np.array([0, 0, 9, 9]), np.array([0, 1, 0, 1]),
        x=np.array([0.0, 4.0 + gap, 0.0, 1.0 + gap]), y=np.array([0.0, 0.0, 0.0, 2.0]),
        heading=np.array([0.0, 0.0, 0.0, np.pi / 2]), against=nothing > 0,
        speed=nothing, along=nothing, met=nothing, offset=nothing,
    )  # fmt: skip
    assert contacts.contacts(log) == ([contacts.Contact("a", "b", 0, 9)] if touches else [])


@pytest.mark.parametrize(
    ("moves", "same"), [({("b", 3)}, True), ({("b", 4)}, False), ({("c", 3)}, False), (set(), False)]
)
def test_a_contact_may_be_shorter_by_the_steps_around_a_jump_alone(moves: set[tuple[str, int]], same: bool) -> None:
    read, found = [contacts.Contact("a", "b", 2, 9)], [("a", "b", 4, 9), ("b", "a", 4, 9)]
    differ, moved = compare.other_contacts(read, found, moves)
    assert (not differ, moved) == (same, 2 * same)
    assert len(compare.other_contacts(read, [("a", "b", 2, 9)], moves)[0]) == 1


@pytest.mark.parametrize(
    ("first", "last", "still", "same"),
    [(2, 7, "ab", True), (2, 7, "a", False), (4, 9, "ab", False), (2, 6, "ab", False)],
)
def test_a_contact_may_end_when_both_stand(first: int, last: int, still: str, same: bool) -> None:
    read, found = [contacts.Contact("a", "b", 2, 9)], [("a", "b", first, last), ("b", "a", first, last)]
    standing = {(who, step) for who in still for step in (2, 3, 8, 9)}
    assert (not compare.other_contacts(read, found, set(), standing)[0]) is same
