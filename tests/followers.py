"""Who follows whom, and how nearly they collide: worked out from the files alone, with nothing of the product.

Two kinds of source. esmini writes each vehicle's own station and offset along the road beside its position: there the
gap is a difference of stations, and the lane's width is read from the OpenDRIVE file. A CommonRoad scenario has lanelets
as polylines: there shapely projects the corners of the boxes onto the ego's chain of lanelets.
"""

from __future__ import annotations

import csv
import math
import re
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import shapely
from lxml import etree

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

OVER_M = 0.05  # a box this far over a lane's boundary is in the lane
MOST_SHARE = 0.2  # of a closing speed: beyond that a lane's inexact heading decides it
DRIFT_S = 3.0  # so long a present speed across the lane counts
CLOSE_CALL_M = 0.03  # nearer to that than this, two honest computations may differ
NEVER_S = 600.0  # so far off, nobody meets
COMES_MPS = 0.5
FULL_BRAKING_MPS2 = 8.0


class SeenVehicle(NamedTuple):
    """Another vehicle, seen along the ego's lane: rear station less the ego's front, and its extent across."""

    name: str
    gap: float
    ahead: bool
    across: tuple[float, float]
    in_by: float
    centre_in_by: float
    speed: float
    drift: float  # speed across the lane, to the left positive, by its heading
    comes: bool


class Measure(NamedTuple):
    """One step: who leads, and time to collision, headway, braking and time to brake; None: not defined, infinite: never.

    `close_call`: whether somebody is in the lane, or the ego on course, hangs on less than CLOSE_CALL_M, or the closing speed on the
    lane's heading. `share`: so much of the closing speed that heading may change.
    """

    lead: str | None
    ttc: float | None
    thw: float | None
    drac: float | None
    ttb: float | None
    close_call: bool
    share: float


def measure(
    speed: float,
    drift: float,
    across: tuple[float, float],
    other_vehicles: Iterable[SeenVehicle],
    doubt_rad: float = 0.0,
) -> Measure:
    """Return a step's measures by their definitions.

    The lead is the nearest vehicle ahead in the lane (its centre ahead of the ego's, and not alongside: its rear ahead
    of the ego's front, or the two boxes overlapping across the lane) and in the way: its centre in the lane, or the two
    boxes overlapping across it, now or within DRIFT_S at the present speeds across. TTC = gap / closing speed (Hayward
    1972), headway = gap / speed, DRAC = closing speed squared / twice the gap, time to brake = TTC less half the time
    of a full braking from the closing speed. Headway is defined behind a lead that is not alongside and whose box
    overlaps the ego's across the lane (of one that stands: then too), and from 5 m/s on; the others where the two will
    overlap when the ego is there, at the present speeds across, and one of them moves. `doubt_rad`: how exactly the lane's
    heading is known.
    """
    other_vehicles = list(other_vehicles)
    near = [o for o in other_vehicles if o.ahead and o.in_by > OVER_M and not o.comes]
    reaching = [o for o in near if o.gap >= 0 or _overlap(across, o.across) > 0]
    late = {o.name: _comes_in_by(drift, across, o) for o in reaching}
    inside = [o for o in reaching if o.centre_in_by >= 0 or late[o.name] > 0]
    close_call = any(o.ahead and abs(o.in_by - OVER_M) < CLOSE_CALL_M for o in other_vehicles)
    close_call |= any(
        abs(o.gap) < CLOSE_CALL_M or (o.gap < 0 and abs(_overlap(across, o.across)) < CLOSE_CALL_M) for o in near
    )
    # nobody further away than the lead could be it
    least = min((o.gap for o in inside), default=math.inf)
    far = CLOSE_CALL_M + doubt_rad * speed * DRIFT_S
    for o in reaching:
        if o.gap <= least and o.centre_in_by < CLOSE_CALL_M:
            close_call |= o.centre_in_by > -CLOSE_CALL_M or abs(late[o.name]) < far
    if not inside:
        return Measure(None, math.inf, math.inf, 0.0, math.inf, close_call, 0.0)
    lead = min(inside, key=lambda o: o.gap)
    # what it does across the lane takes it no further away; of a lane whose heading is not exact, neither is the share along it
    closing = speed - math.sqrt(max(0.0, lead.speed**2 - lead.drift**2))
    unsure = doubt_rad * abs(lead.drift) + doubt_rad**2 * lead.speed / 2
    share = unsure / abs(closing) if closing else math.inf if unsure else 0.0
    close_call |= share > MOST_SHARE
    ttc = lead.gap / closing if closing > 0 else math.inf
    now = _overlap(across, lead.across)
    shift = (drift - lead.drift) * min(ttc, DRIFT_S) if math.isfinite(ttc) else 0.0
    then = _overlap((across[0] + shift, across[1] + shift), lead.across)
    # the heading of the lane is not exact where the ego is, nor where its lead is
    far = doubt_rad * (speed + lead.speed) * min(ttc, DRIFT_S) if math.isfinite(ttc) else 0.0
    close_call |= min(abs(lead.gap), abs(now), abs(then) - far) < CLOSE_CALL_M or abs(speed - 5.0) < 1e-3
    ttb = drac = thw = None
    on_course = lead.gap >= 0 and then > 0
    timed = on_course and max(speed, lead.speed) > COMES_MPS
    if timed:
        drac = closing**2 / (2 * lead.gap) if closing > 0 else 0.0
        ttb = _or_never(ttc - closing / (2 * FULL_BRAKING_MPS2)) if closing > 0 else math.inf
    if lead.gap >= 0 and now > 0 and speed >= 5.0 and (lead.speed > COMES_MPS or on_course):
        thw = lead.gap / speed
    return Measure(lead.name, _or_never(ttc) if timed else None, thw, drac, ttb, close_call, share)


def _or_never(time: float) -> float:
    return math.inf if time > NEVER_S else time


def _comes_in_by(drift: float, across: tuple[float, float], vehicle: SeenVehicle) -> float:
    """Return by how much the two boxes overlap across the lane, now or in DRIFT_S if they come nearer."""
    side = math.copysign(1.0, sum(vehicle.across) - sum(across))
    return _overlap(across, vehicle.across) + DRIFT_S * max(0.0, side * (drift - vehicle.drift))


def _overlap(a: tuple[float, float], b: tuple[float, float]) -> float:
    return min(a[1], b[1]) - max(a[0], b[0])


# ---- esmini: stations and offsets as logged


class Lane(NamedTuple):
    """The ego's lane on a road: 1 along the reference line, -1 against it; its middle's offset and half its width."""

    sense: float
    centre: float
    half: float


def esmini(log: Path, road: Path, ego: str) -> dict[float, Measure]:
    """Return time in s -> measures of the ego of an esmini log."""
    actors = _esmini_actors(log)
    own = actors.pop(ego)
    vehicles = {name: a for name, a in actors.items() if a["vehicle"]}
    stations = np.concatenate([a["s"] for a in (own, *vehicles.values())])
    order = np.argsort(stations, kind="stable")
    bends = stations[order], np.concatenate([a["k"] for a in (own, *vehicles.values())])[order]
    widths = _lane_widths(road)
    result = {}
    lane = Lane(1.0, 0.0, 0.0)
    for i, t in enumerate(own["t"]):
        sense = math.copysign(1.0, math.cos(own["rel"][i]))
        # in a lane that is driven the other way it overtakes: its own lane is still the one that it left
        if np.sign(own["lane"][i]) * sense == np.sign(own["lane"][0] * math.cos(own["rel"][0])):
            half = widths(own["s"][i], int(own["lane"][i])) / 2 if vehicles else 0.0
            lane = Lane(sense, own["d"][i] - own["off"][i], half)
        seen = [_esmini_seen(name, a, own, i, lane, bends) for name, a in vehicles.items()]
        result[float(t)] = measure(float(own["v"][i]), _drift(own, i, lane), _across(own, i, lane), seen)
    return result


def _esmini_actors(log: Path) -> dict[str, dict[str, Any]]:
    with log.open(newline="") as file:
        rows = [[cell.strip() for cell in row] for row in csv.reader(file)][6:]
    head, body = rows[0], [row for row in rows[1:] if len(row) > 2]
    names = {
        "vx": "Vel_X", "vy": "Vel_Y", "bx": "bb_x", "length": "bb_length", "width": "bb_width",
        "s": "Distance_Travelled_Along_Road_Segment", "d": "Lateral_Distance_Lanem", "lane": "lane_id",
        "off": "lane_offset", "rel": "Relative_Heading_Angle [rad]", "k": "Road_Curvature",
    }  # fmt: skip
    starts = [i for i, h in enumerate(head) if "Entity_Name" in h]
    actors: dict[str, dict[str, Any]] = {}
    for first, last in pairwise([*starts, len(head)]):
        own = {re.sub(r"^#\d+ ", "", h): i for i, h in enumerate(head[first:last], first)}
        place = {key: next(i for h, i in own.items() if h.startswith(name)) for key, name in names.items()}
        values = {key: np.array([float(row[i]) for row in body]) for key, i in place.items()}
        values["t"] = np.array([float(row[1]) for row in body])
        values["v"] = np.hypot(values["vx"], values["vy"])  # Current_Speed has the climb in it: 1e-4 more
        # people and cones are no vehicles
        actors[body[0][first]] = {**values, "vehicle": values["length"][0] > 1.0}
    return actors


def _corners(a: Mapping[str, Any], i: int, lane: Lane) -> tuple[Floats, Floats]:
    """Return how far the corners of a box are ahead and to the left of its reference point, along the lane."""
    turn = a["rel"][i] + (0.0 if lane.sense > 0 else math.pi)
    x = a["bx"][i] + np.array([1, 1, -1, -1]) * a["length"][i] / 2
    y = np.array([1, -1, 1, -1]) * a["width"][i] / 2
    return x * math.cos(turn) - y * math.sin(turn), x * math.sin(turn) + y * math.cos(turn)


def _across(a: Mapping[str, Any], i: int, lane: Lane) -> tuple[float, float]:
    """Return the extent of a box across the lane, left of its middle positive."""
    d = lane.sense * (a["d"][i] - lane.centre) + _corners(a, i, lane)[1]
    return float(d.min()), float(d.max())


def _drift(a: Mapping[str, Any], i: int, lane: Lane) -> float:
    return lane.sense * float(a["v"][i] * math.sin(a["rel"][i]))


def _esmini_seen(  # noqa: PLR0917 - two vehicles, a moment, and the road
    name: str, a: Mapping[str, Any], ego: Mapping[str, Any], i: int, lane: Lane, bends: tuple[Floats, Floats]
) -> SeenVehicle:
    """See a vehicle from the ego: the lane's middle is (1 - curvature x offset) as long as the reference line."""
    way = np.linspace(ego["s"][i], a["s"][i], 200)
    apart = lane.sense * float(np.trapezoid(1 - np.interp(way, *bends) * lane.centre, way))
    low, high = _across(a, i, lane)
    with_lane = lane.sense * math.cos(a["rel"][i])
    return SeenVehicle(
        name,
        apart + float(_corners(a, i, lane)[0].min() - _corners(ego, i, lane)[0].max()),
        bool(apart + float(_corners(a, i, lane)[0].mean() - _corners(ego, i, lane)[0].mean()) > 0),
        (low, high),
        min(lane.half - low, high + lane.half),
        lane.half - abs(low + high) / 2,
        float(a["v"][i]),
        _drift(a, i, lane),
        bool(with_lane < -0.5 and a["v"][i] > COMES_MPS),
    )


def _lane_widths(road: Path) -> Callable[[float, int], float]:
    """Return the function (station, lane id) -> width of the first road's lane there."""
    sections = etree.parse(str(road)).getroot().findall("road")[0].findall("lanes/laneSection")

    def width(s: float, lane: int) -> float:
        section = [x for x in sections if _number(x, "s") <= s][-1]
        of = next(x for x in section.iterfind("*/lane") if int(_number(x, "id")) == lane)
        ds = s - _number(section, "s")
        here = [w for w in of.findall("width") if _number(w, "sOffset") <= ds][-1]
        u = ds - _number(here, "sOffset")
        return float(sum(_number(here, c) * u**n for n, c in enumerate("abcd")))

    return width


def _number(element: etree._Element, attribute: str) -> float:
    return float(element.attrib[attribute])


# ---- CommonRoad: lanelets as polylines


@dataclass(frozen=True)
class Obstacle:
    """One obstacle: kind, size, and state by time step: x, y, heading, speed."""

    kind: str
    length: float
    width: float
    states: dict[int, tuple[float, float, float, float]]

    def corners(self, k: int) -> Floats:
        """Return the corners of its box at a time step, (4, 2)."""
        x, y, yaw, _ = self.states[k]
        along = np.array([1, 1, -1, -1]) * self.length / 2
        left = np.array([1, -1, -1, 1]) * self.width / 2
        c, s = math.cos(yaw), math.sin(yaw)
        return np.column_stack([x + along * c - left * s, y + along * s + left * c])


class Scenario:
    """A CommonRoad file as far as followers need it."""

    def __init__(self, file: Path) -> None:
        root = etree.parse(str(file)).getroot()
        self.step_s = _number(root, "timeStepSize")
        self.bounds: dict[str, tuple[Floats, Floats]] = {}
        self.after: dict[str, list[str]] = {}
        for lanelet in root.findall("lanelet"):
            name = str(lanelet.attrib["id"])
            left, right = (
                np.array(
                    [
                        [float(str(p.findtext("x"))), float(str(p.findtext("y")))]
                        for p in lanelet.findall(f"{side}/point")
                    ]
                )
                for side in ("leftBound", "rightBound")
            )
            self.bounds[name] = left, right
            self.after[name] = [str(x.attrib["ref"]) for x in lanelet.findall("successor")]
        self.before = {name: [b for b, then in self.after.items() if name in then] for name in self.after}
        self.obstacles = {
            str(o.attrib["id"]): _obstacle(o)
            for o in (*root.findall("dynamicObstacle"), *root.findall("obstacle"))
            if o.find("shape/rectangle") is not None
        }
        self.areas = {
            name: shapely.Polygon(np.vstack([left, right[::-1]])) for name, (left, right) in self.bounds.items()
        }

    def measures(self, ego: str, doubt_rad: float = 0.0) -> dict[int, Measure | None]:
        """Return time step -> measures of an ego; None where it is on no lanelet that runs its way."""
        own = self.obstacles[ego]
        lanes = {k: self._lanelet(own.states[k]) for k in sorted(own.states)}
        driven = [name for name in dict.fromkeys(lanes.values()) if name]
        return {
            k: self._at(k, self._chain(lane, driven), ego, doubt_rad) if lane else None for k, lane in lanes.items()
        }

    def _lanelet(self, state: tuple[float, float, float, float]) -> str | None:
        """Return the lanelet under a state that runs most as it heads."""
        x, y, yaw, _ = state
        on = [name for name, area in self.areas.items() if area.covers(shapely.Point(x, y))]
        found = [(abs(_turn(_heading(_centre(*self.bounds[name]), x, y), yaw)), name) for name in on]
        best = min((f for f in found if f[0] < math.pi / 2), default=None)
        return best[1] if best else None

    def _chain(self, lane: str, driven_lanes: list[str]) -> list[str]:
        """Return the lanelets before and after: as driven where known, else straight on."""
        chain = [lane]
        for links, at, put in ((self.after, -1, chain.append), (self.before, 0, lambda n: chain.insert(0, n))):
            while len(chain) < 40:
                choices = [n for n in links[chain[at]] if n not in chain]
                if not choices:
                    break
                put(min(choices, key=lambda n: (n not in driven_lanes, abs(self._bend(n)))))
        return chain

    def _bend(self, name: str) -> float:
        line = _centre(*self.bounds[name])
        first, last = line[1] - line[0], line[-1] - line[-2]
        return _turn(math.atan2(last[1], last[0]), math.atan2(first[1], first[0]))

    def _at(self, k: int, chain: list[str], ego: str, doubt_rad: float) -> Measure:
        own = self.obstacles[ego]
        left, right = (np.vstack([self.bounds[name][side] for name in chain]) for side in (0, 1))
        line, half = _centre(left, right), np.hypot(*(left - right).T) / 2
        keep = np.concatenate([[True], np.hypot(*np.diff(line, axis=0).T) > 1e-6])
        line, half = line[keep], half[keep]
        s, d = _along(line, own.corners(k))
        centre_s = float(_along(line, np.array([own.states[k][:2]]))[0][0])
        stations = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
        seen = []
        for name, other in self.obstacles.items():
            if name == ego or k not in other.states or other.kind == "pedestrian":
                continue
            x, y, yaw, speed = other.states[k]
            (mid,), (mid_d,) = _along(line, np.array([[x, y]]))
            if not 0 < mid < stations[-1] or abs(mid_d) > 15:
                continue
            os, od = _along(line, other.corners(k))
            width = float(np.interp(mid, stations, half))
            turn = _turn(yaw, _heading(line, x, y))
            comes = abs(turn) > 2 * math.pi / 3 and speed > COMES_MPS
            inside = min(width - od.min(), od.max() + width)
            seen.append(
                SeenVehicle(
                    name,
                    float(os.min() - s.max()),
                    mid > centre_s,
                    (od.min(), od.max()),
                    inside,
                    width - abs(mid_d),
                    speed,
                    speed * math.sin(turn),
                    comes,
                )
            )
        x, y, yaw, speed = own.states[k]
        drift = speed * math.sin(_turn(yaw, _heading(line, x, y)))
        return measure(speed, drift, (float(d.min()), float(d.max())), seen, doubt_rad)


def _obstacle(element: Any) -> Obstacle:
    states = {}
    for state in [*element.findall("initialState"), *element.findall("trajectory/state")]:
        value = [
            state.findtext(p) for p in ("position/point/x", "position/point/y", "orientation/exact", "velocity/exact")
        ]
        if all(value):
            x, y, yaw, v = (float(text) for text in value)
            states[int(state.findtext("time/exact"))] = (x, y, yaw, v)
    size = element.find("shape/rectangle")
    return Obstacle(element.findtext("type"), float(size.findtext("length")), float(size.findtext("width")), states)


def _centre(left: Floats, right: Floats) -> Floats:
    middle: Floats = (left + right) / 2
    return middle


def _turn(a: float, b: float) -> float:
    return (a - b + math.pi) % (2 * math.pi) - math.pi


def _heading(line: Floats, x: float, y: float) -> float:
    path = shapely.LineString(line)
    s = path.project(shapely.Point(x, y))
    a, b = path.interpolate(max(s - 0.5, 0)), path.interpolate(min(s + 0.5, path.length))
    return math.atan2(b.y - a.y, b.x - a.x)


def _along(line: Floats, points: Floats) -> tuple[Floats, Floats]:
    """Return stations and offsets (left positive) of points on a polyline."""
    path = shapely.LineString(line)
    s = np.array([path.project(shapely.Point(p)) for p in points])
    foot = np.array([path.interpolate(x).coords[0] for x in s])
    ahead = np.array([path.interpolate(min(x + 0.01, path.length)).coords[0] for x in s])
    behind = np.array([path.interpolate(max(x - 0.01, 0)).coords[0] for x in s])
    along, off = ahead - behind, points - foot
    side = np.sign(along[:, 0] * off[:, 1] - along[:, 1] * off[:, 0])
    return s, side * np.hypot(*off.T)
