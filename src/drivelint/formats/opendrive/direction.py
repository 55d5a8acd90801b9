"""Finds the side of the road that is driven on, and the direction of each lane."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

from drivelint.formats.opendrive.network import DRIVABLE_LANE_TYPES
from drivelint.phrases import plural
from drivelint.road.driving_side import correction_hint, opposite_side

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.formats.opendrive.network import Lane, Network
    from drivelint.road.map_reader import MapOptions
    from drivelint.road.quality import MapQuality

_DECISIVE_SHARE = 2 / 3  # some maps list both ends of every connecting lane, with half of the votes for each side


@dataclass(frozen=True)
class DrivingDirection:
    """The side that is driven on, the direction of the lanes, and the sources of both.

    `forward`: lanes with negative numbers run along the reference line, the standard's rule for right-hand traffic. `travel`: the travel
    directions that lanes state (userData) mostly agree with `forward`.
    """

    handedness: str
    source: str
    forward: bool
    forward_source: str
    travel: bool

    def direction_and_is_two_way(self, lane: Lane) -> tuple[int, bool]:
        """Return 1 or -1 (along or against the reference line) and whether the lane is driven both ways."""
        keep = 1 if self.forward else -1
        if lane.kind == "bidirectional" or lane.direction == "both":
            return keep, True
        if self.travel and lane.travel in {"forward", "backward"} and lane.kind in DRIVABLE_LANE_TYPES:
            return (1 if lane.travel == "forward" else -1), False
        along = keep if lane.number < 0 else -keep
        return (-along if lane.direction == "reversed" else along), False


class DrivingSideStatement(NamedTuple):
    """What one source states about the side that is driven on, or about the lanes' direction.

    `text`: subject and verb of a sentence that ends with the side.
    """

    source: str
    side: str
    text: str
    of_lanes: bool


@dataclass(frozen=True)
class DrivingSideStatements:
    """All statements about the side that is driven on, the most trusted first."""

    statements: tuple[DrivingSideStatement, ...]
    rules: Counter[str]
    travel: str | None

    @classmethod
    def collect(cls, net: Network, request: MapOptions) -> DrivingSideStatements:
        """Collect the statements of the option, the roads' rules, the junctions, the lanes' travel directions and the traces."""
        roads = Counter(road.rule for road in net.roads.values() if road.rule)
        junctions, travel = _driving_side_votes_of_junction_lanes(net), _driving_side_votes_of_travel_directions(net)
        candidates = [
            ("option", request.side, "--handedness says", False),
            ("attribute", _decisive_side(roads), f"the rule attribute of {plural(roads.total(), 'road')} says", False),
            ("junctions", _decisive_side(junctions), f"{junctions.total()} lane links of junctions fit", True),
            (
                "attribute",
                _decisive_side(travel),
                f"the travel direction of {travel.total()} lanes (userData) fits",
                True,
            ),
            ("traces", request.voted_handedness, "the traces fit", True),
        ]
        sides = tuple(
            DrivingSideStatement(source, side, text, of) for source, side, text, of in candidates if side is not None
        )
        return cls(sides, roads, _decisive_side(travel))

    def direction_on_two_way_roads(self) -> DrivingDirection:
        """Return the direction of the lanes on two-way roads, where it follows from the driving side."""
        return self._direction_by_statement("rht", self.statements[0] if self.statements else None)

    def driving_side_and_lane_direction(
        self, side_by_opposing_lanes: str | None, quality: MapQuality
    ) -> DrivingDirection:
        """Return the direction by the most trusted statement, and report the statements that disagree.

        `side_by_opposing_lanes`: `rht` or `lht`, the driving side that follows from adjacent lanes with opposite directions; None: there
        are none.
        It assumes that lanes with negative numbers run along the reference line. It is `lht` if each direction is a road of its own and
        the other direction lies on its right, as in SUMO's left-hand nets.
        """
        if len(self.rules) > 1:
            counts = ", ".join(f"{side} {n}" for side, n in sorted(self.rules.items()))
            message = f"the map has roads with both rules ({counts}): one rule is used for all"
            quality.add("handedness_mixed", "warning", None, message)
        direction = (
            self._direction_without_opposing_lanes(quality)
            if side_by_opposing_lanes is None
            else self._direction_with_opposing_lanes(side_by_opposing_lanes, quality)
        )
        if direction.source == "default":
            message = "the map does not state which side is driven on: right-hand traffic is assumed; set --handedness"
            if side_by_opposing_lanes is None and direction.forward_source != "default":
                message = (
                    f"the direction of the lanes is known from {direction.forward_source}, but no lane has a lane "
                    "of the other direction beside it: right-hand traffic is assumed; set --handedness"
                )
            quality.add("handedness_default", "warning", None, message)
        return direction

    def _direction_with_opposing_lanes(self, side_by_opposing_lanes: str, quality: MapQuality) -> DrivingDirection:
        statements = list(self.statements)
        if side_by_opposing_lanes == "lht" and (
            rule := next((w for w in statements if w.source == "attribute" and not w.of_lanes), None)
        ):
            statements.remove(rule)  # by this rule, the lanes run so that the other side is driven on
            message = (
                f"{rule.text} {rule.side}, but with this rule, the oncoming lanes would be on the other side: it is "
                "ignored; set --handedness if the side is wrong"
            )
            quality.add("handedness_disagrees", "warning", None, message)
        statements = [
            w._replace(side=w.side if side_by_opposing_lanes == "rht" or not w.of_lanes else opposite_side(w.side))
            for w in statements
        ]
        _report_disagreements(statements, quality, "every direction")
        return self._direction_by_statement(side_by_opposing_lanes, statements[0] if statements else None)

    def _direction_without_opposing_lanes(self, quality: MapQuality) -> DrivingDirection:
        side = next((w for w in self.statements if not w.of_lanes), None)
        option = next((w for w in self.statements if w.source == "option"), None)
        rule = next((w for w in self.statements if w.source == "attribute" and not w.of_lanes), None)
        # the rule defines the direction, unless the user says that it is wrong
        ways = [w for w in (rule,) if w and (option is None or option.side == w.side)]
        ways += [w for w in self.statements if w.of_lanes]
        way = ways[0] if ways else side
        if side is None:  # then no option could correct the lanes' direction
            _report_disagreements(
                self.statements, quality, "every direction", "use a map whose roads have the rule attribute"
            )
        else:
            _report_disagreements(
                self.statements, quality, "the side for overtaking" if way and way.of_lanes else "every direction"
            )
        forward = way is None or way.side == "rht"
        return DrivingDirection(
            side.side if side else "rht",
            side.source if side else "default",
            forward,
            "default" if way is None or not ways else way.source,
            self.travel == ("rht" if forward else "lht"),
        )

    def _direction_by_statement(
        self, side_by_opposing_lanes: str, statement: DrivingSideStatement | None
    ) -> DrivingDirection:
        side, source = (statement.side, statement.source) if statement else (side_by_opposing_lanes, "default")
        forward = side == side_by_opposing_lanes
        return DrivingDirection(side, source, forward, source, self.travel == ("rht" if forward else "lht"))


def _report_disagreements(
    statements: Sequence[DrivingSideStatement], quality: MapQuality, what_is_wrong: str, advice: str | None = None
) -> None:
    """Report statements that disagree.

    `what_is_wrong`: what is wrong if the first statement is; `advice`: another remedy than --handedness.
    """
    if len({w.side for w in statements}) > 1:
        first, second = statements[:2]
        # if the second statement agrees with the option, leaving out the option changes nothing
        remedy = advice or correction_hint(first.side, first.source if second.side != first.side else "")
        opinions = ", ".join(f"{w.text} {w.side}" for w in statements)
        message = f"{opinions}: {first.side} is used. If this is not right, {what_is_wrong} is wrong: {remedy}."
        quality.add("handedness_disagrees", "warning", None, message)


def _decisive_side(votes: Counter[str]) -> str | None:
    if not votes:
        return None
    side, n = max(votes.items(), key=lambda item: (item[1], item[0]))
    return side if n >= _DECISIVE_SHARE * votes.total() else None


def _driving_side_votes_of_junction_lanes(net: Network) -> Counter[str]:
    """Return how many lanes in junctions show lht and rht: traffic runs away from the end at which their road is entered."""
    votes: Counter[str] = Counter()
    for connection in net.connections:
        road = net.roads.get(connection.connecting)
        if road is None or road.junction_id is None:
            continue
        kinds = {lane.number: lane.kind for lane_section in road.lane_sections for lane in lane_section.lanes}
        for _, to in connection.lanes:
            if kinds.get(to) in DRIVABLE_LANE_TYPES - {"bidirectional"}:
                votes["rht" if (connection.contact == "start") == (to < 0) else "lht"] += 1
    return votes


def _driving_side_votes_of_travel_directions(net: Network) -> Counter[str]:
    lanes = (lane for road in net.roads.values() for lane_section in road.lane_sections for lane in lane_section.lanes)
    return Counter(
        "rht" if (lane.travel == "forward") == (lane.number < 0) else "lht"
        for lane in lanes
        if lane.kind in DRIVABLE_LANE_TYPES and lane.travel in {"forward", "backward"}
    )


def report_lanes_against_side(net: Network, direction: DrivingDirection, quality: MapQuality) -> None:
    """Report the lanes whose stated direction is not that of their side of the road."""
    plain = replace(direction, travel=False)
    for road in net.roads.values():
        for lane_section in road.lane_sections:
            for lane in lane_section.lanes:
                if lane.invalid is None and direction.direction_and_is_two_way(lane) != plain.direction_and_is_two_way(
                    lane
                ):
                    name = f"{road.road_id}.{lane_section.section}.{lane.number}"
                    message = (
                        f"lane {name} is driven {lane.travel} according to its userData, against the rule of its side"
                    )
                    quality.add("direction_exception", "warning", name, message)
