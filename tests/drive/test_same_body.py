"""One body in two tracks is one, two bodies that collide are two; a track that begins elsewhere is not believed there."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from drivelint.drive.actors import Actors
from drivelint.drive.implausible import bodies
from drivelint.drive.implausible.bodies import repeated_end_position_findings, same_body_findings
from drivelint.drive.trace import States
from tests.drive.tracks import doubts, drive, track

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

TRUCK: dict[str, Any] = {"actor_class": "truck", "length_m": 12.0, "width_m": 2.5}


def shift(columns: dict[str, Any], x: float = 0.0, y: float = 0.0, rows: slice = slice(None)) -> dict[str, Any]:
    """Return the rows of a track, moved by some metres."""
    cut = {name: values[rows] if isinstance(values, np.ndarray) else values for name, values in columns.items()}
    return cut | {"x_m": cut["x_m"] + x, "y_m": cut["y_m"] + y}


@pytest.mark.parametrize("rows", [slice(None), slice(0, 60), slice(40, None)])
def test_a_truck_that_is_tracked_twice(tmp_path: Path, rows: slice) -> None:
    second = shift(track(**TRUCK), 1.5, 0.3, rows) | {"length_m": 8.0}
    trace = drive(tmp_path, a=track(**TRUCK), b=second)
    # of two tracks of one length, the first id counts
    assert doubts(trace) == {("b", "identity", "same_body")}
    (said,) = (row["message"] for row in trace.tables["quality"].to_pylist() if row["check_id"] == "same_body")
    assert "b is the same body as a" in said


def test_a_rider_on_a_bicycle(tmp_path: Path) -> None:
    bicycle = track(5.0, actor_class="bicycle", length_m=1.8, width_m=0.6)
    rider = shift(track(5.0, actor_class="bicycle", length_m=0.9, width_m=0.6), 0.1)
    assert doubts(drive(tmp_path, rider=rider, wheels=bicycle)) == {("wheels", "identity", "same_body")}


def test_the_ego_is_believed(tmp_path: Path) -> None:
    twin = track(5.0, n=200)
    twin["y_m"] = twin["y_m"] + 50.2
    assert doubts(drive(tmp_path, twin=twin)) == {("twin", "identity", "same_body")}


def test_vehicles_side_by_side_or_in_a_queue_are_two(tmp_path: Path) -> None:
    cars = {"a": track(), "b": shift(track(), y=1.9), "c": shift(track(), x=4.4)}
    assert not doubts(drive(tmp_path, **cars))


def test_who_collides_and_is_pushed_along_is_another(tmp_path: Path) -> None:
    front = track(5.0)
    front["x_m"] = front["x_m"] + 20.0
    rear = track(10.0)
    # from 4.0 s on the rear car lies 2.5 m deep in the front one, both at 7 m/s
    for car, offset in ((front, 0.0), (rear, -2.0)):
        car["vx_mps"][40:] = 7.0
        car["x_m"][40:] = front["x_m"][40] + 7.0 * (np.arange(60) / 10.0) + offset
    assert not {row for row in doubts(drive(tmp_path, front=front, rear=rear)) if row[2] == "same_body"}


def in_line(gap: float, closing: float, speed: float = 8.0) -> dict[str, dict[str, Any]]:
    """Return a lorry's cab and its trailer, behind it by `gap` at first, 3 s long."""
    front, rear = track(speed, n=30, length_m=8.0, width_m=3.0), track(speed, n=30, length_m=4.0, width_m=3.0)
    front["x_m"] = front["x_m"] + 6.0 + gap
    rear["x_m"] = rear["x_m"] + closing * np.arange(30) / 10.0
    rear["vx_mps"] = rear["vx_mps"] + closing
    return {"front": front, "rear": rear}


@pytest.mark.parametrize(
    ("gap", "closing", "speed", "is_one_body"),
    [(1.5, 0.8, 8.0, True), (1.5, 0.3, 8.0, False), (3.0, 1.4, 8.0, False), (1.5, 0.8, 3.0, False)],
)
def test_who_is_nearer_than_anybody_follows_and_sinks_in_is_one_body(
    tmp_path: Path, *, gap: float, closing: float, speed: float, is_one_body: bool
) -> None:
    found = doubts(drive(tmp_path, **in_line(gap, closing, speed)))
    assert (("rear", "identity", "same_body") in found) is is_one_body


def begun(depth: float, *, closing: float = -1.5, hit: float = 0.0, speed: float = 8.0) -> dict[str, dict[str, Any]]:
    """Return two cars of which the rear one lies `depth` in the front one at first; `hit`: it loses so much speed after 0.3 s."""
    front, rear = track(speed), track(speed + closing)
    front["x_m"] = front["x_m"] + 4.5 - depth
    rear["vx_mps"][4:] -= hit
    rear["x_m"] = np.r_[0.0, np.cumsum((rear["vx_mps"][1:] + rear["vx_mps"][:-1]) / 20.0)]
    rear["y_m"] = rear["y_m"] + 0.4
    return {"front": front, "rear": rear}


@pytest.mark.parametrize(
    ("depth", "more", "doubted"),
    [
        (0.7, {}, {"front", "rear"}),
        (0.2, {}, set()),
        (0.7, {"hit": 4.0}, set()),
        (0.7, {"closing": 0.0}, set()),
        (0.7, {"speed": 3.0}, set()),
    ],
)
def test_boxes_that_begin_in_each_other_are_not_exact(
    tmp_path: Path, *, depth: float, more: dict[str, float], doubted: set[str]
) -> None:
    trace = drive(tmp_path, **begun(depth, **more))
    rows = [row for row in trace.tables["doubt"].to_pylist() if row["code"] == "begin_overlap"]
    assert {row["actor_id"] for row in rows} == doubted
    # 0.7 m at 1.5 m/s: until they are 0.7 m apart, at 0.9 s
    assert {(row["quantity"], row["t_from_ns"], row["t_to_ns"]) for row in rows} <= {("position", 0, 999_999_999)}


@pytest.mark.parametrize(("aside_m", "until_ns"), [(1.2, 2_499_999_999), (0.4, 1_099_999_999)])
def test_who_may_drive_beside_the_other_is_doubted_as_long_as_it_stays_there(
    tmp_path: Path, aside_m: float, until_ns: int
) -> None:
    """Cars 1.8 m wide, 0.8 m in each other along: after 1.1 s they are as far apart. Who is 1.2 m aside draws away to 2.5 m."""
    cars = begun(0.8)
    cars["rear"]["y_m"] = np.where(np.arange(len(cars["rear"]["y_m"])) < 25, aside_m, aside_m + 2.0)
    trace = drive(tmp_path, **cars)
    rows = [row for row in trace.tables["doubt"].to_pylist() if row["code"] == "begin_overlap"]
    assert {(row["quantity"], row["t_from_ns"], row["t_to_ns"]) for row in rows} == {("position", 0, until_ns)}


@pytest.mark.parametrize(
    ("apart", "longest_m", "doubted"),
    [
        ((0.3, 0.1), 0.5, {"a", "b"}),
        # side by side, their boxes in each other by 0.1 m
        ((0.1, 0.4), 0.5, set()),
        # one of them goes on
        ((0.3, 0.1, 1.5), 0.5, set()),
        # a person at a car's door
        ((1.5, 0.7), 4.5, set()),
    ],
)
def test_two_persons_in_one_place_are_not_exact(
    tmp_path: Path, apart: tuple[float, ...], longest_m: float, doubted: set[str]
) -> None:
    first = track(0.8, actor_class="pedestrian", length_m=longest_m, width_m=0.5)
    second = shift(track(0.8, actor_class="pedestrian", length_m=0.5, width_m=0.5), apart[0], apart[1])
    for speed in apart[2:]:
        second["x_m"] = second["x_m"] + speed * np.arange(len(second["x_m"])) / 10.0
    trace = drive(tmp_path, a=first, b=second)
    rows = [row for row in trace.tables["doubt"].to_pylist() if row["code"] == "begin_overlap"]
    assert {row["actor_id"] for row in rows} == doubted
    assert {row["quantity"] for row in rows} <= {"position"}


def test_who_collides_after_the_begin_is_not_doubted(tmp_path: Path) -> None:
    cars = begun(-1.0, closing=2.0)
    assert not {row for row in doubts(drive(tmp_path, **cars)) if row[2] == "begin_overlap"}


@pytest.mark.parametrize(
    ("until", "arrives", "brakes", "is_held"),
    [
        (50, 51, False, True),
        (50, 66, False, False),
        (100, 51, False, False),
        (50, 48, False, False),
        (50, 51, True, False),
    ],
)
def test_who_stands_at_its_end_where_another_one_is_at_once_was_gone(
    tmp_path: Path, *, until: int, arrives: int, brakes: bool, is_held: bool
) -> None:
    stands = track(0.0) | {"x_m": np.full(100, 60.0)}
    goes = track(6.0)
    goes["x_m"] = goes["x_m"] + 60.0 - 4.5 - 0.6 * (arrives - 1)
    goes["vx_mps"][51:] = 3.0 if brakes else 6.0
    goes["x_m"][51:] = goes["x_m"][50] + np.arange(1, 50) * goes["vx_mps"][-1] / 10.0
    trace = drive(tmp_path, stands=shift(stands, rows=slice(0, until)), goes=goes)
    found = {row for row in doubts(trace) if row[2] == "held_track"}
    assert found == ({("stands", "existence", "held_track")} if is_held else set())


def test_a_track_that_begins_elsewhere(tmp_path: Path) -> None:
    ghost = track(8.0)
    ghost["x_m"][0] -= 2.5
    ghost |= {"vx_mps": np.full(100, np.nan), "vy_mps": np.full(100, np.nan)}
    trace = drive(tmp_path, ghost=ghost)
    assert ("ghost", "existence", "false_entry") in doubts(trace)
    (row,) = (row for row in trace.tables["doubt"].to_pylist() if row["code"] == "false_entry")
    assert (row["t_from_ns"], row["t_to_ns"]) == (0, 99_999_999)


def test_who_brakes_hard_as_it_comes_in_is_there(tmp_path: Path) -> None:
    car = track(8.0)
    car["vx_mps"] = np.maximum(0.0, 15.0 - np.arange(100))
    car["x_m"] = np.cumsum(np.r_[0.0, (car["vx_mps"][1:] + car["vx_mps"][:-1]) / 20.0])
    assert not doubts(drive(tmp_path, car=car))


class Walked(list[str]):
    """Ids that count how often somebody goes over all of them."""

    n_walks = 0

    def __iter__(self) -> Iterator[str]:
        self.n_walks += 1
        return super().__iter__()


def queue(ids: list[str], apart_m: float) -> tuple[States, Actors]:
    """Return cars of 4.5 m that stand behind each other at two moments."""
    n = len(ids)
    x, zero = np.repeat(apart_m * np.arange(n), 2), np.zeros(2 * n)
    numbers = {"x_m": x, "y_m": zero, "yaw_rad": zero, "vx_mps": zero, "vy_mps": zero}
    t_ns = np.tile(np.array([0, 100_000_000]), n)
    t_ns[1] = 200_000_000  # the first one is there longest: all the others' tracks end before the log does
    states = States(ids, np.repeat(np.arange(n, dtype=np.int32), 2), t_ns, numbers, {}, np.zeros(2 * n, np.bool_))
    return states, Actors(ids, ["car"] * n, {"length_m": np.full(n, 4.5), "width_m": np.full(n, 1.8)})


def test_a_pair_of_tracks_takes_no_walk_over_all_actors() -> None:
    """As it did: a log of 100,000 actors in two frames did not end."""
    ids = Walked(f"{i:03}" for i in range(300))
    states, actors = queue(ids, 4.0)
    assert same_body_findings(states, actors, {"000"}) == []
    assert repeated_end_position_findings(states, actors) == []
    assert ids.n_walks < 20


def test_of_tracks_too_short_to_be_coupled_no_pair_is_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    pairs: list[object] = []
    monkeypatch.setattr(bodies, "_rows_at_common_times", lambda *told: pairs.append(told))
    assert same_body_findings(*queue([f"{i:03}" for i in range(300)], 6.0), {"000"}) == []
    assert pairs == []
