"""Merges two recordings of the ego in a ROS log, its odometry and its entry in the list of objects, into one actor."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from drivelint.drive.trace import ACTOR_CLASSES, SIZE_COLUMNS, QualityFinding, Recording, States
from drivelint.formats.ros2.recorded_poses import ids_at_ego

if TYPE_CHECKING:
    from collections.abc import Mapping

FORMAT = "ros2-mcap"
SQLITE_FORMAT = "ros2-sqlite"
DEFAULT_EGO_ID = "ego"
"""The id of the vehicle with the odometry, if no message gives its id."""


def merge_ego(
    objects: tuple[str, States] | None,
    odometry: tuple[str, States] | None,
    ego_ids_by_topic: Mapping[str, str],
    findings: list[QualityFinding],
    *,
    is_carla: bool,
    is_centre: bool,
    ego_id: str = DEFAULT_EGO_ID,
) -> Recording:
    """Merge objects and odometry, each given with its topic, into one recording with one track of the ego.

    `ego_ids_by_topic`: topic of the CARLA bridge's ego info -> the ego's id; `is_carla`: whether the objects come from the CARLA bridge;
    `is_centre`: whether the odometry's positions are known to be box centres; `ego_id`: the ego's id if no message gives it.
    """
    names = _carla_ego_ids(ego_ids_by_topic, odometry)
    if is_carla and objects is not None:
        _correct_carla_origins(*objects, findings)
    if odometry is None:
        assert objects is not None  # noqa: S101 (the reader refuses a log with neither)
        return Recording(FORMAT, objects[1], ego_ids=names, findings=findings)
    ego = odometry[1]
    ids_in_objects: list[str] = []
    if objects is None:
        ego.ids = names[:1] or [ego_id]
    else:
        object_states = objects[1]
        ids_in_objects = [name for name in names if name in object_states.ids] or ids_at_ego(ego, object_states)
        ego.ids = ids_in_objects[:1] or [_unused_actor_id(names[0] if names else ego_id, object_states.ids)]
    if not is_carla and not is_centre:
        message = (
            f"{odometry[0]}: the origin of the ego's frame is used as the centre of the ego's box: if "
            "this frame is at the rear axle, set the distance from it to the centre: --ego-size LENGTH,WIDTH,AHEAD"
        )
        first = int(ego.t_ns.min())
        findings.append(QualityFinding("reference_point", "warning", message, len(ego), first, ego.ids[0]))
    if objects is not None and ids_in_objects:
        return _with_one_ego_track(ego, objects[1], objects[0], findings)
    states = ego if objects is None else concatenate_states(ego, objects[1])
    return Recording(FORMAT, states, ego_ids=list(ego.ids), findings=findings)


def _with_one_ego_track(ego: States, object_states: States, topic: str, findings: list[QualityFinding]) -> Recording:
    """Return a recording with the longer of the ego's two tracks. If it is the odometry's, size and class come from the objects."""
    (name,) = ego.ids
    twin = object_states.actor == object_states.ids.index(name)
    n = int(twin.sum())
    message_start = f"the ego is {name!r} on {topic} too"
    if n >= len(ego):
        message = f"{message_start}: its {n} states on that topic are used instead of the odometry"
        findings.append(QualityFinding("ego_twice", "info", message, len(ego)))
        return Recording(FORMAT, object_states, ego_ids=[name], findings=findings)
    for size in SIZE_COLUMNS:
        sizes = np.sort(object_states.numbers[size][twin])
        sizes = sizes[sizes > 0.0]
        if len(sizes):
            ego.numbers[size][:] = sizes[(len(sizes) - 1) // 2]
    kinds = object_states.codes["actor_class"][twin]
    if (kinds >= 0).any():
        ego.codes["actor_class"][:] = kinds[kinds >= 0][0]
    message = f"{message_start}: its size is taken from that topic, its {len(ego)} states from the odometry"
    findings.append(QualityFinding("ego_twice", "info", message, n))
    return Recording(FORMAT, concatenate_states(ego, object_states.take(~twin)), ego_ids=[name], findings=findings)


def concatenate_states(first: States, second: States) -> States:
    """Return the rows of both sets of states; actors with the same id become one actor."""
    ids = list(dict.fromkeys([*first.ids, *second.ids]))
    place = {name: i for i, name in enumerate(ids)}
    new_index = np.array([place[name] for name in second.ids], np.int32)
    return States.concatenate([replace(first, ids=ids), replace(second, ids=ids, actor=new_index[second.actor])])


def _unused_actor_id(name: str, ids: list[str]) -> str:
    while name in ids:
        name += "_odometry"
    return name


def _carla_ego_ids(ego_ids_by_topic: Mapping[str, str], odometry: tuple[str, States] | None) -> list[str]:
    """Return the ids of the CARLA bridge's egos; of several ids, those from a topic beside the odometry's."""
    if odometry is not None and len(set(ego_ids_by_topic.values())) > 1:
        beside = odometry[0].rpartition("/")[0]
        ego_ids_by_topic = {
            topic: name for topic, name in ego_ids_by_topic.items() if topic.rpartition("/")[0] == beside
        }
    return sorted(set(ego_ids_by_topic.values()))


def _correct_carla_origins(topic: str, states: States, findings: list[QualityFinding]) -> None:
    """Add a finding on CARLA's reference points, and lift vehicles' positions from the ground to the box centre."""
    walks = states.codes["actor_class"] == ACTOR_CLASSES.index("pedestrian")
    lift = np.where(walks, 0.0, np.nan_to_num(0.5 * states.numbers["height_m"]))
    states.numbers["z_m"] = states.numbers["z_m"] + lift
    message = (
        f"{topic}: the origins of CARLA's actors are used as the centres of their boxes: depending on the model, "
        "the true centre is up to a few decimetres ahead or behind; vehicles are raised by half their height"
    )
    findings.append(QualityFinding("reference_point", "info", message, len(states), int(states.t_ns.min())))
