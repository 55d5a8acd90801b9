"""Where actors of a scene are, worked out by hand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from drivelint.errors import UsageError
from tests.scene.scene_text import column, scene_of, seconds


def test_an_actor_follows_its_lane_round_a_bend(tmp_path: Path) -> None:
    scene = scene_of(tmp_path, "{lane: main 1, from: 290, speed: 10}")
    x, y = column(scene, "x_m"), column(scene, "y_m")
    assert (x[0], y[0]) == pytest.approx((290.0, -1.75))
    # after 1 s it enters the bend, 101.75 m about (300, 100); 9 s later it has turned by 90 m
    turned = 90 / 101.75
    assert (x[-1], y[-1]) == pytest.approx((300 + 101.75 * np.sin(turned), 100 - 101.75 * np.cos(turned)), abs=0.02)
    assert column(scene, "yaw_rad")[-1] == pytest.approx(turned, abs=1e-3)
    assert np.hypot(column(scene, "vx_mps"), column(scene, "vy_mps")) == pytest.approx(10.0, abs=0.02)
    assert column(scene, "z_m") == pytest.approx(2.75)


def test_who_comes_the_other_way_drives_against_the_line(tmp_path: Path) -> None:
    scene = scene_of(tmp_path, "{lane: main -1, from: 654.33, speed: 10}")
    # 300 m, a bend of 154.33 m along this lane, and 200 m of the first straight
    assert (column(scene, "x_m")[0], column(scene, "y_m")[0]) == pytest.approx((100.0, 1.75), abs=0.01)
    assert abs(column(scene, "yaw_rad")[-1]) == pytest.approx(np.pi)


def test_a_mirror_shows_the_left_hand(tmp_path: Path) -> None:
    actor = "{lane: main 1, from: 200, speed: [[0, 10], [5, 0]], offset: [[1, 0], [4, 3.5]], indicator: [[0, left]]}"
    right, left = (scene_of(tmp_path, actor, side=side) for side in ("right", "left"))
    for name, sign in (("x_m", 1), ("y_m", -1), ("yaw_rad", -1), ("vx_mps", 1), ("vy_mps", -1)):
        assert column(left, name) == pytest.approx(sign * column(right, name), abs=1e-9), name
    assert (set(column(right, "indicator")), set(column(left, "indicator"))) == ({"left"}, {"right"})


def test_steps_begin_at_a_second_or_at_a_place_and_a_halt_is_exact(tmp_path: Path) -> None:
    steps = "[{place: 120, lane: -1, over: 2}, {stop: 160, by: 4}]"
    scene = scene_of(tmp_path, f"{{lane: main 1, from: 100, speed: 10, do: {steps}}}")
    y, t = column(scene, "y_m"), seconds(scene)
    assert y[t <= 2.0] == pytest.approx(-1.75)
    assert y[t >= 4.0] == pytest.approx(1.75)
    assert column(scene, "x_m")[-1] + 4.5 / 2 == pytest.approx(160.0, abs=0.1)


def test_a_way_through_a_junction_is_found(tmp_path: Path) -> None:
    for roads, route in (("town", "[west -1, north 1]"), ("ring", "[west -1, ring west 1, south 1]")):
        way = f"{{route: {route}, from: 110, speed: 8}}"
        scene = scene_of(tmp_path, way, roads=roads)
        x, y = column(scene, "x_m"), column(scene, "y_m")
        assert np.hypot(np.diff(x), np.diff(y)) == pytest.approx(0.8, abs=0.05), "no jump"


@pytest.mark.parametrize(
    ("actor", "message"),
    [
        ("{lane: mian 1}", "no road 'mian': did you mean 'main'"),
        ("{lane: main 4}", "road main has no lane 4"),
        ("{lane: main 1, kind: cart}", "kind 'cart': did you mean 'car'"),
        ("{lane: main 1, indicator: lift}", "'lift': did you mean 'left'"),
        ("{lane: main 1, place: [0, 0, 0]}", "here lane and place does"),
        ("{lane: main 1, do: [{speed: 3}]}", "begins at a second"),
        ("{lane: main 1, sped: 3}", "unknown key 'scenes.actors.ego.sped': did you mean 'speed'"),
        ("{lane: main 1, facing: front}", "'front': known are ahead, back"),
        ("ago: {lane: main 1}", "no actor is called ego"),
    ],
)
def test_what_is_not_understood_is_refused_in_a_line(tmp_path: Path, actor: str, message: str) -> None:
    with pytest.raises(UsageError) as refused:
        scene_of(tmp_path, actor).files()
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)
