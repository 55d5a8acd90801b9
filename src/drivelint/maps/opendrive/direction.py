"""Which side of the road is driven on, and which way each lane goes."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

from drivelint.maps.opendrive.network import DRIVABLE

if TYPE_CHECKING:
    from drivelint.maps.contract import Request
    from drivelint.maps.opendrive.network import Lane, Network
    from drivelint.maps.quality import Quality

_DECISIVE = 2 / 3  # some maps list both ends of every connecting lane: half the votes each way say nothing


@dataclass(frozen=True)
class Direction:
    """The side that is driven on, and how it was found; `travel`: the lanes' own travel directions mostly agree."""

    handedness: str
    source: str
    travel: bool

    def of(self, lane: Lane) -> tuple[int, bool]:
        """Return 1 or -1 (along or against the reference line) and whether the lane is driven both ways."""
        keep = 1 if self.handedness == "rht" else -1
        if lane.kind == "bidirectional" or lane.direction == "both":
            return keep, True
        if self.travel and lane.travel in {"forward", "backward"} and lane.kind in DRIVABLE:
            return (1 if lane.travel == "forward" else -1), False
        along = keep if lane.number < 0 else -keep
        return (-along if lane.direction == "reversed" else along), False


def decide(net: Network, request: Request, quality: Quality) -> Direction:
    """Return the handedness: the first that option, roads, junctions, lanes, traces say, else the standard's default.

    The roads' rule attribute and the lanes' travel direction (RoadRunner's userData) both count as attributes. Any two
    that disagree are a warning, and so is the default.
    """
    roads = Counter(road.rule for road in net.roads.values() if road.rule)
    junctions, travel = _junction_votes(net), _travel_votes(net)
    found = [
        ("option", None if request.handedness == "auto" else request.handedness, "the option --handedness"),
        ("attribute", _winner(roads), f"the rule attribute of {roads.total()} roads"),
        ("junctions", _winner(junctions), f"{junctions.total()} lane links of junctions"),
        ("attribute", _winner(travel), f"the travel direction of {travel.total()} lanes (userData)"),
        ("traces", request.sensed, "the headings of the traces"),
    ]
    said = [(source, side, text) for source, side, text in found if side is not None]
    if len({side for _, side, _ in said}) > 1:
        opinions = "; ".join(f"{text}: {side}" for _, side, text in said)
        quality.add(
            "handedness_disagrees",
            "warning",
            None,
            f"{opinions}. {said[0][1]} is taken: if that is wrong, every direction is; give --handedness",
        )
    if len(roads) > 1:
        counts = ", ".join(f"{side} {n}" for side, n in sorted(roads.items()))
        quality.add(
            "handedness_mixed", "warning", None, f"roads of both rules in one map ({counts}): one is taken for all"
        )
    if not said:
        message = "nothing in the map says which side is driven on: right-hand traffic is a guess; give --handedness"
        quality.add("handedness_default", "warning", None, message)
    source, handedness, _ = said[0] if said else ("default", "rht", "")
    direction = Direction(handedness, source, _winner(travel) == handedness)
    _report_exceptions(net, direction, quality)
    return direction


def _winner(votes: Counter[str]) -> str | None:
    if not votes:
        return None
    side, n = max(votes.items(), key=lambda item: (item[1], item[0]))
    return side if n >= _DECISIVE * votes.total() else None


def _junction_votes(net: Network) -> Counter[str]:
    """Return the votes of the lanes by which junctions are entered: traffic runs away from the end that is entered."""
    votes: Counter[str] = Counter()
    for connection in net.connections:
        road = net.roads.get(connection.connecting)
        if road is None or road.junction_id is None:
            continue
        kinds = {lane.number: lane.kind for strip in road.strips for lane in strip.lanes}
        for _, to in connection.lanes:
            if kinds.get(to) in DRIVABLE - {"bidirectional"}:
                votes["rht" if (connection.contact == "start") == (to < 0) else "lht"] += 1
    return votes


def _travel_votes(net: Network) -> Counter[str]:
    lanes = (lane for road in net.roads.values() for strip in road.strips for lane in strip.lanes)
    return Counter(
        "rht" if (lane.travel == "forward") == (lane.number < 0) else "lht"
        for lane in lanes
        if lane.kind in DRIVABLE and lane.travel in {"forward", "backward"}
    )


def _report_exceptions(net: Network, direction: Direction, quality: Quality) -> None:
    """Name the lanes whose own direction is not that of their side."""
    plain = Direction(direction.handedness, direction.source, travel=False)
    for road in net.roads.values():
        for strip in road.strips:
            for lane in strip.lanes:
                if lane.invalid is None and direction.of(lane) != plain.of(lane):
                    name = f"{road.road_id}.{strip.section}.{lane.number}"
                    message = f"lane {name} is driven {lane.travel}, as its userData says, against the rule of its side"
                    quality.add("direction_exception", "warning", name, message)
