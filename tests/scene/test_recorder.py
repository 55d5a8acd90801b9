"""What faults of the recorder leave of a drive."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.scene.scene_text import column, scene_of, seconds

MOVING = "lane: main 1, from: 10, speed: 10"


def test_lost_samples_and_ghosts_have_no_rows(tmp_path: Path) -> None:
    scene = scene_of(
        tmp_path, f"{{{MOVING}, faults: {{lost: [[3, 4]]}}}}", "ghost: {lane: main 1, from: 80, there: [2, 2.3]}"
    )
    assert len(seconds(scene)) == 101 - 11
    assert seconds(scene, "ghost") == pytest.approx([2.0, 2.1, 2.2, 2.3])


def test_a_wrong_heading_a_frozen_place_and_a_jump(tmp_path: Path) -> None:
    faults = "{turned: [[1, 2]], frozen: [[4, 5]], shift: [[7, 8, 0, 3]]}"
    scene = scene_of(tmp_path, f"{{{MOVING}, faults: {faults}}}")
    t, x, y = seconds(scene), column(scene, "x_m"), column(scene, "y_m")
    assert set(t[np.cos(column(scene, "yaw_rad")) < 0].round(1)) == {round(1 + n / 10, 1) for n in range(11)}
    assert x[(t >= 4) & (t <= 5)] == pytest.approx(50.0)
    assert y[(t > 6.95) & (t < 8.05)] == pytest.approx(1.25)
    assert column(scene, "vx_mps") == pytest.approx(10.0), "speeds are recorded as driven"


def test_jitter_is_the_same_at_every_time(tmp_path: Path) -> None:
    first, second = (column(scene_of(tmp_path, f"{{{MOVING}, faults: {{jitter: 0.1}}}}"), "y_m") for _ in range(2))
    assert (first == second).all()
    assert 0.05 < np.std(first) < 0.2


def test_sizes_are_swapped_or_unknown(tmp_path: Path) -> None:
    others = [
        "a: {lane: main 1, faults: {swapped: true}}",
        "b: {lane: main 1, faults: {unknown: [width, class, speed]}}",
    ]
    scene = scene_of(tmp_path, "{lane: main 1}", *others)
    actors = {row["actor_id"]: row for row in scene.tables()["actor"].to_pylist()}
    assert (actors["a"]["length_m"], actors["a"]["width_m"]) == (1.8, 4.5)
    assert (actors["b"]["width_m"], actors["b"]["actor_class"]) == (None, None)
    assert set(column(scene, "vx_mps", "b")) == {None}
