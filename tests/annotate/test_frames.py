"""A viewer can place the drawings in the frames of a bag: whatever its fixed frame is called, and with static transforms only."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.annotate.runs import run, the
from tests.annotate.viewer import messages
from tests.formats.ros2 import ros_log as ros
from tests.formats.ros2.ros_drive import T0, TURN, along, ego, road_users, ticks

if TYPE_CHECKING:
    from pathlib import Path

CAMERA = ros.transform(T0, "base_link", "camera", 1.0, topic="/tf_static")


def moving(parent: str) -> list[ros.Message]:
    return [ros.transform(t_s, parent, "base_link", *along(t_s), yaw=TURN) for t_s in ticks()]


@pytest.mark.sample(1, ci=2)
@pytest.mark.parametrize(
    ("bag", "parents", "follows"),
    [
        ([*moving("odom"), *road_users(frame="odom")], ["odom"], False),
        ([*moving("map"), *road_users()], [], False),
        ([CAMERA, *ego(), *road_users()], [], True),
    ],
)  # fmt: skip
def test_the_frame_of_the_drawings_is_connected(
    tmp_path: Path, bag: list[ros.Message], parents: list[str], follows: bool
) -> None:
    log = ros.write(tmp_path / "log.mcap", bag)
    out = run(tmp_path / "out", log, map=None, mapping=None, rules=("ukhc.no-collision",), profiles=())
    links = [each.content for each in messages(the(out, "log"), "tf_map")]
    assert [each.parent_frame_id for each in links] == parents
    assert all((each.child_frame_id, each.rotation.w) == ("map", 1.0) for each in links)
    poses = [each.content for each in messages(the(out, "log"), "tf")]
    assert bool(poses) == follows
    assert {(each.parent_frame_id, each.child_frame_id) for each in poses} <= {("map", "base_link")}
