"""The sheets of the trial: an examiner sees where a heading contradicts the motion of a track."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from .recording import Track
from .sheet import EGO, WARNING, _box, heading_warning

if TYPE_CHECKING:
    from numpy.typing import NDArray

T = np.arange(0.0, 5.05, 0.1)


def track(
    speed: float = 8.0, turned: float = 0.0, *, travel: float = 0.0, doubted: bool = False, north: bool = False
) -> Track:
    """Return a car that drives straight on, its box `turned` against the motion, its travel against the box by so much (radians)."""
    way = np.pi / 2 if north else 0.0
    x, y = 10 + speed * T * np.cos(way), 20 + speed * T * np.sin(way)
    yaw = np.full(len(T), way + turned)
    return Track("car", 4.8, 1.8, True, T, x, y, yaw, np.full(len(T), speed), yaw + travel, np.full(len(T), doubted))


@pytest.mark.parametrize("north", [False, True])
@pytest.mark.parametrize(
    ("turned", "travel", "off"),
    [
        (0.0, 0.0, False),
        (np.deg2rad(10), 0.0, False),
        (np.deg2rad(30), 0.0, True),
        (np.pi / 2, 0.0, True),
        (-np.pi / 2, 0.0, True),
        (np.pi, 0.0, True),
        (np.pi, np.pi, False),  # it reverses, and drivelint has it travel backwards
        (0.0, np.pi, True),
    ],
)
def test_a_box_across_its_motion_is_told(turned: float, travel: float, off: bool, north: bool) -> None:
    car = track(turned=turned, travel=travel, north=north)
    assert set(car.is_off_motion()) == {off}
    assert bool(heading_warning(car, [1.0, 2.0, 2.0])) == off
    if off:
        assert f"{np.degrees(abs(turned)):.0f} deg off its motion at 2.0 s" in heading_warning(car, [2.0])


def test_the_motion_is_that_of_the_positions() -> None:
    assert track(north=True).motion() == pytest.approx(np.full(len(T), np.pi / 2))
    assert np.isnan(track(speed=0.5).motion()).all()  # half a metre in a second may be noise
    assert not track(speed=0.5, turned=1.0).is_off_motion().any()


@pytest.mark.parametrize("north", [False, True])
def test_a_heading_in_doubt_and_none_at_all_are_told(north: bool) -> None:
    assert "in doubt" in heading_warning(track(doubted=True, north=north), [2.0])
    nothing = track(north=north)._replace(yaw=np.full(len(T), np.nan))
    assert "no heading at 2.0 s" in heading_warning(nothing, [2.0])
    assert heading_warning(nothing, [60.0]) == ""


class _Axis:
    """Notes what is drawn."""

    def __init__(self) -> None:
        self.filled: list[NDArray[np.float64]] = []
        self.lines: list[tuple[NDArray[np.float64], str]] = []
        self.arrows: list[tuple[NDArray[np.float64], str]] = []

    def fill(self, x: Any, y: Any, **_: Any) -> None:
        self.filled.append(np.array([x, y]))

    def plot(self, x: Any, y: Any, **how: Any) -> None:
        self.lines.append((np.array([x, y]), how["color"]))

    def annotate(self, _: str, tip: Any, start: Any, **how: Any) -> None:
        self.arrows.append((np.asarray(tip) - np.asarray(start), how["arrowprops"]["color"]))


def _axis_with_box(car: Track) -> _Axis:
    axis = _Axis()
    _box(axis, car, 20, lambda x, y: np.array([np.asarray(x), np.asarray(y)]), EGO)
    return axis


def test_a_box_along_its_motion_has_no_arrow_and_its_nose_ahead() -> None:
    axis = _axis_with_box(track())
    assert not axis.arrows
    ((nose, _),) = axis.lines
    assert nose[0] - (10 + 8 * 2.0) == pytest.approx([1.2, 2.4])


def test_a_box_that_travels_backwards_has_its_nose_at_its_rear() -> None:
    axis = _axis_with_box(track(turned=np.pi, travel=np.pi))
    assert not axis.arrows
    ((nose, _),) = axis.lines
    assert nose[0] - (10 + 8 * 2.0) == pytest.approx([1.2, 2.4])


@pytest.mark.parametrize("car", [track(turned=np.pi / 2), track(turned=np.pi), track(doubted=True)])
def test_a_box_that_contradicts_its_motion_has_an_arrow_along_it(car: Track) -> None:
    axis = _axis_with_box(car)
    ((arrow, colour),) = axis.arrows
    assert colour == WARNING
    assert arrow == pytest.approx([4.8, 0.0])
    assert len(axis.filled) == 1


def test_without_a_heading_there_is_a_circle_and_the_motion() -> None:
    axis = _axis_with_box(track()._replace(yaw=np.full(len(T), np.nan), travel=np.full(len(T), np.nan)))
    assert not axis.filled
    ((circle, _),) = axis.lines
    assert np.hypot(*(circle - [[26.0], [20.0]])) == pytest.approx(np.full(40, np.hypot(4.8, 1.8) / 2))
    assert len(axis.arrows) == 1
