"""Finds the successors and neighbours of the lanes of a scenario, as it states them or as their shapes show them."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
import shapely

from drivelint.road.tree_parts import query_in_parts

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from drivelint.formats.scenarionet.centre_lines import CentreLine

_LARGEST_END_GAP_M: Final = 0.3  # the largest gap between the end of a lane and the start of the next
_LEAST_SUCCESSOR_COSINE: Final = float(np.cos(np.radians(45.0)))
_DISTANCE_BEYOND_BOUND_M: Final = 0.4  # how far beyond a bound the lane beside is looked for
_SAMPLED_SHARES_OF_LANE_LENGTH: Final = np.array([0.1, 0.3, 0.5, 0.7, 0.9])
_LEAST_SAMPLES_IN_NEIGHBOUR: Final = 3  # the least number of these places with the same lane beside
_LEAST_NEIGHBOUR_COSINE: Final = float(np.cos(np.radians(25.0)))
_LEAST_LEVEL_DIFFERENCE_M: Final = 3.0


def link_lanes(lanes: Mapping[str, CentreLine]) -> None:
    """Set the predecessors and successors of each lane, in place: as the scenario states them, else by lane ends that meet."""
    successors: dict[str, dict[str, None]] = defaultdict(dict)
    has_links = any(lane.feature.get("exit_lanes") or lane.feature.get("entry_lanes") for lane in lanes.values())
    if has_links:
        for name, lane in lanes.items():
            for linked in _ids_in_list(lane.feature.get("exit_lanes")):
                successors[name][linked] = None
            for linked in _ids_in_list(lane.feature.get("entry_lanes")):
                successors[linked][name] = None
    else:
        _link_ends_that_meet(lanes, successors)
    predecessors: dict[str, dict[str, None]] = defaultdict(dict)
    for name, linked_names in successors.items():
        for linked in linked_names:
            predecessors[linked][name] = None
    for name, lane in lanes.items():
        lane.predecessors, lane.successors = tuple(predecessors[name]), tuple(successors[name])


def _ids_in_list(value: Any) -> Iterable[str]:
    """Return the ids in a list, as texts; none if the value is not a list."""
    value = value.tolist() if isinstance(value, np.ndarray) else value
    return (
        [str(lane_id) for lane_id in value if isinstance(lane_id, (int, str))]
        if isinstance(value, (list, tuple))
        else []
    )


def _link_ends_that_meet(lanes: Mapping[str, CentreLine], successors: dict[str, dict[str, None]]) -> None:
    ordered = list(lanes.values())
    if not ordered:
        return
    tree = shapely.STRtree([shapely.Point(lane.line[0]) for lane in ordered])
    ends = [shapely.Point(lane.line[-1]) for lane in ordered]
    parts = query_in_parts(tree, ends, "dwithin", _LARGEST_END_GAP_M)
    for i, j in (pair for part in parts for pair in zip(*part, strict=True)):
        if i != j and float(ordered[i].tangent[-1] @ ordered[j].tangent[0]) > _LEAST_SUCCESSOR_COSINE:
            successors[ordered[i].lane_id][ordered[j].lane_id] = None


class Neighbours(NamedTuple):
    """The lanes beside a lane, None where there is none, and whether they run the other way."""

    left_id: str | None = None
    left_against: bool | None = None
    right_id: str | None = None
    right_against: bool | None = None


def find_neighbours(lanes: Mapping[str, CentreLine]) -> dict[str, Neighbours]:
    """Return the neighbours of each lane with known bounds: lanes just beyond most of a bound that run along it.

    Lanes that split or merge overlap, and are not neighbours.
    """
    ordered = [lane for lane in lanes.values() if np.isfinite(lane.bound_distances).all()]
    tree = shapely.STRtree(
        [shapely.Polygon(np.vstack([*lane.bounds[:1], lane.bounds[1][::-1]])).buffer(0.0) for lane in ordered]
    )
    neighbours = {
        lane.lane_id: Neighbours(
            *_neighbour_id_and_against(lane, ordered, tree, "left"),
            *_neighbour_id_and_against(lane, ordered, tree, "right"),
        )
        for lane in ordered
    }
    return {name: _mutual_neighbours(name, neighbours) for name in neighbours}


def _neighbour_id_and_against(
    lane: CentreLine, lanes: Sequence[CentreLine], tree: shapely.STRtree, side: str
) -> tuple[str | None, bool | None]:
    """Return the lane that contains most of the places just beyond a bound, and whether it runs the other way."""
    sign, bound = (1.0, lane.bounds[0]) if side == "left" else (-1.0, lane.bounds[1])
    at = _SAMPLED_SHARES_OF_LANE_LENGTH * lane.s[-1]
    x, y, nx, ny, z = (np.interp(at, lane.s, values) for values in (*bound.T, *lane.normal.T, lane.z))
    places = np.column_stack([x, y]) + sign * _DISTANCE_BEYOND_BOUND_M * np.column_stack([nx, ny])
    votes: dict[int, list[int]] = defaultdict(list)
    for k, i in tree.query(shapely.points(places), predicate="within").T:
        neighbour = lanes[i]
        near = int(np.argmin(np.hypot(*(neighbour.line - places[k]).T)))
        along = float(neighbour.normal[near] @ (nx[k], ny[k]))
        if (
            neighbour is not lane
            and abs(along) > _LEAST_NEIGHBOUR_COSINE
            and not abs(neighbour.z[near] - z[k]) >= _LEAST_LEVEL_DIFFERENCE_M
        ):
            votes[int(i)].append(1 if along > 0 else -1)
    for i in sorted(votes, key=lambda i: (-len(votes[i]), i)):
        neighbour = lanes[i]
        are_linked = not {*lane.successors}.isdisjoint(neighbour.successors) or not {*lane.predecessors}.isdisjoint(
            neighbour.predecessors
        )
        if len(votes[i]) >= _LEAST_SAMPLES_IN_NEIGHBOUR and not are_linked:
            return neighbour.lane_id, sum(votes[i]) < 0
    return None, None


def _mutual_neighbours(name: str, neighbours: Mapping[str, Neighbours]) -> Neighbours:
    """Return the neighbours of a lane, except those that have another neighbour on the shared side, as a long lane beside a short one."""
    mutual_neighbours = neighbours[name]
    for side, opposite in (("left", "right"), ("right", "left")):
        counterpart = neighbours.get(getattr(mutual_neighbours, f"{side}_id") or "")
        theirs = side if getattr(mutual_neighbours, f"{side}_against") else opposite
        if counterpart is not None and getattr(counterpart, f"{theirs}_id") not in {None, name}:
            mutual_neighbours = mutual_neighbours._replace(**{f"{side}_id": None, f"{side}_against": None})
    return mutual_neighbours
