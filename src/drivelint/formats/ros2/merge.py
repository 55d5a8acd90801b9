"""One actor for the ego, whether a ROS log has it as odometry, among the objects, or as both."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from drivelint.drive.trace import ACTOR_CLASSES, SIZE_COLUMNS, QualityFinding, Recording, States
from drivelint.formats.ros2.recorded_poses import ids_at_ego

if TYPE_CHECKING:
    from collections.abc import Mapping

FORMAT = "ros2-mcap"
DEFAULT_EGO_ID = "ego"
"""What the odometry's vehicle is called where nobody gives it an id."""


@dataclass
class Sources:
    """The states of the objects and of the odometry, each with its topic.

    `infos`: topic of the CARLA bridge's ego info -> the id of the ego; `forward_m` as in `EgoSize`.
    """

    objects: tuple[str, States] | None
    odometry: tuple[str, States] | None
    carla: bool
    infos: Mapping[str, str]
    forward_m: float
    findings: list[QualityFinding] = field(default_factory=list)


def merge_ego(sources: Sources) -> Recording:
    """Merge the objects and the odometry into one recording with one track of the ego."""
    names = _said_egos(sources)
    if sources.carla and sources.objects is not None:
        _carla_origins(*sources.objects, sources.findings)
    if sources.objects is None:
        assert sources.odometry is not None  # noqa: S101 (the reader refuses a log with neither)
        states = sources.odometry[1]
        states.ids = names[:1] or [DEFAULT_EGO_ID]
        _say_odometry(sources, states)
        return Recording(FORMAT, states, ego_ids=list(states.ids), findings=sources.findings)
    if sources.odometry is None:
        return Recording(FORMAT, sources.objects[1], ego_ids=names, findings=sources.findings)
    (topic, others), (_, ego) = sources.objects, sources.odometry
    found = [name for name in names if name in others.ids] or ids_at_ego(ego, others)
    ego.ids = found[:1] or [_free(names[0] if names else DEFAULT_EGO_ID, others.ids)]
    _say_odometry(sources, ego)
    if not found:
        return Recording(FORMAT, concatenate_states(ego, others), ego_ids=list(ego.ids), findings=sources.findings)
    return _once(ego, others, topic, sources.findings)


def _once(ego: States, others: States, topic: str, findings: list[QualityFinding]) -> Recording:
    """Keep of the ego's two tracks the one with more states, in the log's own order, and the size that is known."""
    (name,) = ego.ids
    twin = others.actor == others.ids.index(name)
    n = int(twin.sum())
    both = f"the ego is {name!r} on {topic} too"
    if n >= len(ego):
        findings.append(
            QualityFinding("ego_twice", "info", f"{both}: its {n} states there count, not the odometry's", len(ego))
        )
        return Recording(FORMAT, others, ego_ids=[name], findings=findings)
    for size in SIZE_COLUMNS:
        known = np.sort(others.numbers[size][twin])
        known = known[known > 0.0]
        ego.numbers[size][:] = known[(len(known) - 1) // 2] if len(known) else np.nan
    kinds = others.codes["actor_class"][twin]
    if (kinds >= 0).any():
        ego.codes["actor_class"][:] = kinds[kinds >= 0][0]
    findings.append(
        QualityFinding(
            "ego_twice", "info", f"{both}: its size there counts, its {len(ego)} states are the odometry's", n
        )
    )
    return Recording(FORMAT, concatenate_states(ego, others.take(~twin)), ego_ids=[name], findings=findings)


def concatenate_states(first: States, second: States) -> States:
    """Return the rows of two sets of states; an actor of both is one actor."""
    place = {name: i for i, name in enumerate(first.ids)}
    for name in second.ids:
        place.setdefault(name, len(place))
    moved = np.array([place[name] for name in second.ids], np.int32)
    return States(
        list(place),
        np.concatenate([first.actor, moved[second.actor]]),
        np.concatenate([first.t_ns, second.t_ns]),
        {name: np.concatenate([first.numbers[name], second.numbers[name]]) for name in first.numbers},
        {name: np.concatenate([first.codes[name], second.codes[name]]) for name in first.codes},
        np.concatenate([first.not_finite, second.not_finite]),
    )


def _free(name: str, taken: list[str]) -> str:
    while name in taken:
        name += "_odometry"
    return name


def _said_egos(sources: Sources) -> list[str]:
    """Return the ids that the CARLA bridge gives its egos; of several, that of the odometry's vehicle."""
    found = dict(sources.infos)
    if sources.odometry is not None and len(set(found.values())) > 1:
        beside = sources.odometry[0].rpartition("/")[0]
        found = {topic: name for topic, name in found.items() if topic.rpartition("/")[0] == beside}
    return sorted(set(found.values()))


def _carla_origins(topic: str, states: States, findings: list[QualityFinding]) -> None:
    """Say what CARLA's origins mean, and lift those of vehicles from the ground to the middle of the box."""
    walks = states.codes["actor_class"] == ACTOR_CLASSES.index("pedestrian")
    lift = np.where(walks, 0.0, np.nan_to_num(0.5 * states.numbers["height_m"]))
    states.numbers["z_m"] = states.numbers["z_m"] + lift
    message = (
        f"{topic}: places are the origins of CARLA's actors, taken as the centres of their boxes: by the model of the vehicle "
        "these lie up to a few decimetres ahead or behind; vehicles are lifted by half their height"
    )
    findings.append(QualityFinding("reference_point", "info", message, len(states), int(states.t_ns.min())))


def _say_odometry(sources: Sources, ego: States) -> None:
    if sources.odometry is None or sources.carla or sources.forward_m != 0.0:
        return
    message = (
        f"{sources.odometry[0]}: the ego's place is that of the odometry's child frame, taken as the centre of its box: where "
        "that frame is at the rear axle, say how far ahead of it the centre is: --ego-size LENGTH,WIDTH,AHEAD"
    )
    findings = sources.findings
    findings.append(QualityFinding("reference_point", "warning", message, len(ego), int(ego.t_ns.min()), ego.ids[0]))
