"""How the lanes of a scenario follow one another and lie side by side, as it says or as their shapes tell."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import shapely

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from drivelint.formats.scenarionet.centre_lines import CentreLine
    from drivelint.road.boundary_lanes import BoundedLane

_JOINED_M: Final = 0.3  # the end of a lane and the begin of the next are one point
_ONWARDS: Final = float(np.cos(np.radians(45.0)))
_OUTSIDE_M: Final = 0.4  # so far beyond a bound one looks for the lane beside
_SHARES: Final = np.array([0.1, 0.3, 0.5, 0.7, 0.9])
_MOST: Final = 3  # of these places, where the same lane lies beside
_ALONG: Final = float(np.cos(np.radians(25.0)))
_LEVEL_M: Final = 3.0


def link(lanes: Mapping[str, CentreLine]) -> None:
    """Give each lane what comes before and after it, in place: what the scenario says, else the lanes whose ends meet its own."""
    after: dict[str, dict[str, None]] = defaultdict(dict)
    said = any(lane.feature.get("exit_lanes") or lane.feature.get("entry_lanes") for lane in lanes.values())
    if said:
        for name, lane in lanes.items():
            for other in _ids(lane.feature.get("exit_lanes")):
                after[name][other] = None
            for other in _ids(lane.feature.get("entry_lanes")):
                after[other][name] = None
    else:
        _by_shape(lanes, after)
    before: dict[str, dict[str, None]] = defaultdict(dict)
    for name, others in after.items():
        for other in others:
            before[other][name] = None
    for name, lane in lanes.items():
        lane.before, lane.after = tuple(before[name]), tuple(after[name])


def _ids(value: Any) -> Iterable[str]:
    """Return the ids that a list holds, as texts."""
    value = value.tolist() if isinstance(value, np.ndarray) else value
    return [str(each) for each in value if isinstance(each, (int, str))] if isinstance(value, (list, tuple)) else []


def _by_shape(lanes: Mapping[str, CentreLine], after: dict[str, dict[str, None]]) -> None:
    ordered = list(lanes.values())
    if not ordered:
        return
    tree = shapely.STRtree([shapely.Point(lane.line[0]) for lane in ordered])
    ends = [shapely.Point(lane.line[-1]) for lane in ordered]
    for i, j in tree.query(ends, predicate="dwithin", distance=_JOINED_M).T:
        if i != j and float(ordered[i].ends[1] @ ordered[j].ends[0]) > _ONWARDS:
            after[ordered[i].lane_id][ordered[j].lane_id] = None


def find_neighbours(lanes: Sequence[BoundedLane]) -> None:
    """Give each lane the one that lies beside it, in place: it has ground just beyond most of the bound, and runs along it.

    Lanes that fork or join share ground, and are none.
    """
    before: dict[str, set[str]] = defaultdict(set)
    for lane in lanes:
        for other in lane.successors:
            before[other].add(lane.lanelet_id)
    tree = shapely.STRtree([lane.line.polygon for lane in lanes])
    for lane in lanes:
        for side in ("left", "right"):
            votes = _beside(lane, lanes, tree, side)
            for i in sorted(votes, key=lambda i: (-len(votes[i]), i)):
                other = lanes[i]
                share = (
                    set(lane.successors) & set(other.successors) or before[lane.lanelet_id] & before[other.lanelet_id]
                )
                if len(votes[i]) >= _MOST and not share:
                    setattr(lane, f"{side}_id", other.lanelet_id)
                    setattr(lane, f"{side}_against", sum(votes[i]) < 0)
                    break
    _drop_one_sided({lane.lanelet_id: lane for lane in lanes})


def _beside(lane: BoundedLane, lanes: Sequence[BoundedLane], tree: shapely.STRtree, side: str) -> dict[int, list[int]]:
    """Return lane -> for each place beside a bound on which it lies, 1 if it runs the same way there, -1 if the other way."""
    line = lane.line
    at = _SHARES * line.length
    sign = 1.0 if side == "left" else -1.0
    bound = line.left if side == "left" else line.right
    x, y, tx, ty, z = (np.interp(at, line.s, values) for values in (*bound.T, *line.tangent.T, lane.z))
    places = np.column_stack([x - sign * _OUTSIDE_M * ty, y + sign * _OUTSIDE_M * tx])
    votes: dict[int, list[int]] = defaultdict(list)
    for k, i in tree.query(shapely.points(places), predicate="within").T:
        other = lanes[i]
        s = other.line.station(places[k])
        along = float(np.interp(s, other.line.s, other.line.tangent @ np.array([tx[k], ty[k]])))
        level = abs(float(np.interp(s, other.line.s, other.z)) - z[k])
        if other is not lane and abs(along) > _ALONG and not level >= _LEVEL_M:
            votes[int(i)].append(1 if along > 0 else -1)
    return votes


def _drop_one_sided(lanes: Mapping[str, BoundedLane]) -> None:
    """Keep those that name each other, in place: a short lane beside a long one has it as a neighbour, and is none of its own."""
    for lane in lanes.values():
        for side, opposite in (("left", "right"), ("right", "left")):
            other = lanes.get(getattr(lane, f"{side}_id") or "")
            if other is None:
                continue
            theirs = side if getattr(lane, f"{side}_against") else opposite
            if getattr(other, f"{theirs}_id") not in {None, lane.lanelet_id}:
                setattr(lane, f"{side}_id", None)
                setattr(lane, f"{side}_against", None)
