"""An independent reading of SUMO's log: its overtakes, their distance ahead and the safe distance ahead.

Numpy over the columns of the FCD and the lane shapes of the net, after the definitions of the paper; nothing of the product's
readers, maps, tables or macros is used. Distances are along the middle of the overtaking vehicle's own lane.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

OVER_M = 0.05  # a corner further over the line than that has left the lane
LOOK_M = 1000.0  # with nobody coming, how far the road counts as looked at
NEAR_M = 100.0  # who is pulled out behind, though not passed in the end
WELL_OVER_M = 0.5
STILL_MPS = 0.5  # slower than this counts as standing, see `standing_mps`
JUMP_M = 1.0
STANDING_MPS = 0.5
PROFILES = {"relaxed": (10.0, 9.10), "nominal": (20.0, 4.65), "aggressive": (40.0, 1.11)}
"""Angle of pulling out and cutting in (degrees), headroom and clearance (m)."""
VERDICTS = ("fail", "unknown", "pass")


@dataclass(frozen=True)
class Line:
    """The middle of a lane, in its direction: stations and points."""

    s: Floats
    x: Floats
    y: Floats

    def place(self, x: Floats, y: Floats, guess: Floats) -> tuple[Floats, Floats]:
        """Return station and offset (left positive) of points whose station is roughly known."""
        along = guess
        for _ in range(6):
            k = np.clip(np.searchsorted(self.s, along, side="right") - 1, 0, len(self.s) - 2)
            step = self.s[k + 1] - self.s[k]
            tx, ty = (self.x[k + 1] - self.x[k]) / step, (self.y[k + 1] - self.y[k]) / step
            dx, dy = x - self.x[k], y - self.y[k]
            along = self.s[k] + dx * tx + dy * ty
        return along, dy * tx - dx * ty


@dataclass(frozen=True)
class Net:
    """The road's two lanes and what the definitions need of them."""

    lines: dict[str, Line]
    lane_m: float
    limit_mps: float
    side: int  # 1: the left is driven on, -1: the right


@dataclass(frozen=True)
class Log:
    """Rows by step: `step` counts tenths of a second; `id_index` indexes `ids`; corners (row, 4).

    `kinds`, `sizes`: type, length and width by vehicle. `x`, `y`: the middle of the front bumper; `heading` counter-clockwise from east.
    `against`: it drives the way of `ba`. `along`: on the middle of its own lane; `offset` from the centre line, positive on
    its own side; `met`: where those who come towards it have it, on the middle of theirs.
    """

    ids: tuple[str, ...]
    kinds: tuple[str, ...]
    sizes: Floats
    step: NDArray[np.int64]
    id_index: NDArray[np.int64]
    x: Floats
    y: Floats
    heading: Floats
    against: NDArray[np.bool_]
    speed: Floats
    along: Floats
    met: Floats
    offset: Floats

    def of(self, id_index: int) -> Log:
        return self._take(self.id_index == id_index)

    def at(self, step: int) -> Log:
        return self.during(step, step)

    def during(self, first: int, last: int) -> Log:
        return self._take(slice(*np.searchsorted(self.step, (first, last + 1))))

    def seen_by(self, against: bool) -> Log:
        """Return it with `along` and `offset` as those have them who drive the one way or the other."""
        other = (self.against != against)[:, None]
        return replace(
            self, along=np.where(other, self.met, self.along), offset=np.where(other, -self.offset, self.offset)
        )

    def _take(self, rows: NDArray[np.bool_] | slice) -> Log:
        names = ("step", "id_index", "x", "y", "heading", "against", "speed", "along", "met", "offset")
        return replace(self, **{name: getattr(self, name)[rows] for name in names})


class Overtake(NamedTuple):
    """One vehicle that was passed or pulled out behind; metres, m/s, seconds; verdicts by profile."""

    ego: str
    t0: float
    t3: float | None
    vbp: str
    passed: bool
    ov: str | None
    da_m: float
    end_m: float  # how far the road goes on
    verdicts: dict[str, str]


def read_net(path: Path) -> Net:
    """Read the net: its two lanes."""
    root = ET.parse(path).getroot()  # noqa: S314
    lanes = [lane.attrib for lane in root.iter("lane")]
    side = 1 if root.get("lefthand") == "true" else -1
    shapes = {lane["id"]: _line(lane["shape"]) for lane in lanes}
    return Net(shapes, float(lanes[0]["width"]), float(lanes[0]["speed"]), side)


def _line(shape: str) -> Line:
    points = np.array([[float(v) for v in point.split(",")[:2]] for point in shape.split()])
    s = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    return Line(s, points[:, 0], points[:, 1])


def read_log(log: Path, routes: Path, net: Net) -> Log:
    """Read the log, and the sizes of its vehicles from the route file."""
    sizes = {
        e.attrib["id"]: (float(e.attrib["length"]), float(e.attrib["width"]))
        for e in ET.parse(routes).getroot().iter("vType")  # noqa: S314
    }
    numbers: dict[str, int] = {}
    kinds: list[str] = []
    rows = []
    for step, vehicle in _vehicles(log):
        name = vehicle["id"]
        if name not in numbers:
            numbers[name] = len(numbers)
            kinds.append(vehicle["type"])
        at = (float(vehicle[key]) for key in ("x", "y", "angle", "speed", "pos"))
        rows.append((step, numbers[name], vehicle["lane"] == "ba_0", *at))
    step, id_index, on_ba, x, y, angle, speed, pos = np.array(rows, np.float64).T
    id_index = id_index.astype(np.int64)
    length, width = (np.array([sizes[kind][k] for kind in kinds]) for k in (0, 1))
    heading = np.radians(90.0 - angle)
    forward, side = np.array([np.cos(heading), np.sin(heading)]), np.array([-np.sin(heading), np.cos(heading)])
    own = {name: np.where((on_ba > 0) == (name == "ba_0"), pos, line.s[-1] - pos) for name, line in net.lines.items()}
    k = np.clip(np.searchsorted(net.lines["ab_0"].s, own["ab_0"]) - 1, 0, len(net.lines["ab_0"].s) - 2)
    ab = net.lines["ab_0"]
    against = forward[0] * (ab.x[k + 1] - ab.x[k]) + forward[1] * (ab.y[k + 1] - ab.y[k]) < 0
    found = {name: np.empty((2, len(x), 4)) for name in net.lines}
    for n, (back, beside) in enumerate(((0.0, 0.5), (0.0, -0.5), (1.0, 0.5), (1.0, -0.5))):
        cx, cy = np.array([x, y]) - back * length[id_index] * forward + beside * width[id_index] * side
        for name, line in net.lines.items():
            found[name][0, :, n], found[name][1, :, n] = line.place(cx, cy, own[name])
    (along, offset), (met, _) = (
        np.where(against[:, None], found[one], found[other]) for one, other in (("ba_0", "ab_0"), ("ab_0", "ba_0"))
    )
    offset = net.side * offset + net.lane_m / 2  # each lane lies to that side of the centre line in its direction
    steps = step.astype(np.int64)
    return Log(
        tuple(numbers),
        tuple(kinds),
        np.array([length, width]).T,
        steps,
        id_index,
        x,
        y,
        heading,
        against,
        speed,
        along,
        met,
        offset,
    )


def _vehicles(log: Path) -> Iterator[tuple[int, dict[str, str]]]:
    step = -1
    for event, element in ET.iterparse(log, events=("start", "end")):  # noqa: S314
        if element.tag == "timestep":
            if event == "start":
                step = round(float(element.attrib["time"]) * 10)
            else:
                element.clear()
        elif element.tag == "vehicle" and event == "start":
            yield step, dict(element.attrib)


def jumps(log: Log) -> set[tuple[str, int]]:
    """Return who is elsewhere at a step than its speed led by more than a metre: SUMO does that where a change of lanes is given up."""
    found = set()
    for who, name in enumerate(log.ids):
        own = log.of(who)
        way = np.hypot(np.diff(own.x), np.diff(own.y))
        behind = np.cos(own.heading[1:]) * np.diff(own.x) + np.sin(own.heading[1:]) * np.diff(own.y) < 0
        off = np.abs(np.where(behind, -way, way) - 0.1 * own.speed[1:]) > JUMP_M
        found |= {(name, int(step)) for step in own.step[1:][off & (np.diff(own.step) == 1)]}
    return found


def still(log: Log) -> set[tuple[str, int]]:
    """Return who stands at a step."""
    rows = np.flatnonzero(log.speed < STILL_MPS)
    return {(log.ids[who], int(step)) for who, step in zip(log.id_index[rows], log.step[rows], strict=True)}


def edges(log: Log) -> dict[str, tuple[int, int]]:
    """Return the first step of every vehicle and its last."""
    return {name: (int(own.step[0]), int(own.step[-1])) for who, name in enumerate(log.ids) for own in [log.of(who)]}


def overtakes(log: Log, net: Net) -> list[Overtake]:
    """Return every overtake of every vehicle."""
    found = []
    for who in range(len(log.ids)):
        own = log.of(who)
        over = own.offset.min(axis=1) < -OVER_M
        edges = np.flatnonzero(np.diff(np.concatenate([[False], over, [False]]).astype(np.int8)))
        for first, end in edges.reshape(-1, 2):
            found += _excursion(log, net, own, int(first), int(end))
    return sorted(found, key=lambda o: (o.t0, o.ego, o.vbp))


def _excursion(log: Log, net: Net, ego: Log, first: int, end: int) -> list[Overtake]:
    """Return whom the vehicle overtakes in its rows from `first` until before `end`."""
    step = int(ego.step[first])
    there = log.at(step)
    me = ego.id_index[first]
    front, centre = ego.along[first].max(), ego.along[first].mean()
    same = there.against == ego.against[first]
    # who stands in the lane is passed, whichever way it faces
    there = there.seen_by(bool(ego.against[first]))
    ahead = (there.along.mean(axis=1) > centre) & (there.offset.max(axis=1) > OVER_M) & (there.id_index != me)
    ahead &= same | (there.speed <= STANDING_MPS)
    order = np.flatnonzero(ahead)[np.argsort(there.along[ahead].min(axis=1))]
    back = end < len(ego.step)
    well = -ego.offset[first:end].min() >= WELL_OVER_M or not back
    gaps = there.along[order].min(axis=1) - front
    row_begin = float(there.along[order].min()) if len(order) else math.nan  # rear of the nearest one
    found = []
    for rank, at in enumerate(order):
        vbp = int(there.id_index[at])
        passed = _passed(ego, log.of(vbp).seen_by(bool(ego.against[first])), first, min(end + 1, len(ego.step)))
        if not passed and not (rank == 0 and gaps[0] <= NEAR_M and well):
            continue
        line = net.lines["ba_0" if ego.against[first] else "ab_0"]
        others = _oncoming(there, line, bool(ego.against[first]), float(front), float(centre))
        da, _, ov = others[0]
        # the row of vehicles from the nearest one's rear to this one's front; one that is alone has its own length
        row_m = float(there.along[at].max() - row_begin)
        # one that sped up to overtake: whether it planned with the speed that it had or with the one that it got to is not known
        later = math.nan
        if not back:
            later = float(ego.speed[first:].max())
        elif passed:
            later = _mean_speed(ego, first, end)
        speeds = float(ego.speed[first]), max(float(ego.speed[first]), later)
        verdicts: dict[str, str] = {}
        for name, (angle, gap) in PROFILES.items():
            way_m = 2 * gap + row_m + log.sizes[me, 0]
            said = set()
            for other_da, speed, who in others:
                v_ov = net.limit_mps if who is None else speed
                needed, least = (
                    _safe_distance(net.lane_m, math.radians(angle), way_m, (v, float(there.speed[at]), v_ov))
                    for v in speeds
                )
                if (needed or 0) >= other_da > (least or math.inf):
                    said.add("unknown")
                else:
                    said.add(_verdict(other_da, needed, is_seen=who is not None, begin=first > 0))
            # everybody who comes counts, not the nearest alone
            verdicts[name] = next(verdict for verdict in ("fail", "unknown", "pass") if verdict in said)
        found.append(
            Overtake(
                log.ids[me], step / 10, int(ego.step[end]) / 10 if back else None, log.ids[vbp], passed,
                None if ov is None else log.ids[ov], da, float(line.s[-1] - front), verdicts,
            )
        )  # fmt: skip
    return found


def _mean_speed(ego: Log, first: int, end: int) -> float:
    """Return the speed at which the vehicle covers the way of its rows from `first` to `end`."""
    way = np.hypot(np.diff(ego.x[first : end + 1]), np.diff(ego.y[first : end + 1])).sum()
    return float(way / (0.1 * (ego.step[end] - ego.step[first])))


def _passed(ego: Log, vehicle: Log, first: int, end: int) -> bool:
    """Say whether the vehicle's front gets past the other's in its rows from `first` until before `end`."""
    _, mine, theirs = np.intersect1d(ego.step[first:end], vehicle.step, return_indices=True)
    return bool((ego.along[first:end].max(axis=1)[mine] > vehicle.along.max(axis=1)[theirs]).any())


def _oncoming(
    there: Log, line: Line, against: bool, front: float, centre: float
) -> list[tuple[float, float, int | None]]:
    """Return DA, the speed to reckon with, and who it is, of everybody who comes, the nearest first.

    Nobody: the road's end (or as far as is looked) and no speed.
    """
    coming = (there.against != against) & (there.along.mean(axis=1) > centre)
    coming &= (there.speed > STANDING_MPS) | (there.offset.min(axis=1) < -OVER_M)  # or it is parked in the own lane
    if not coming.any():
        return [(min(float(line.s[-1]) - front, LOOK_M), math.nan, None)]
    das = there.along.min(axis=1) - front
    found = np.flatnonzero(coming)
    return [(float(das[k]), float(there.speed[k]), int(there.id_index[k])) for k in found[np.argsort(das[found])]]


def _safe_distance(lane_m: float, angle: float, way_m: float, speeds: tuple[float, float, float]) -> float | None:
    """Return what the whole manoeuvre needs, angle of pulling out and cutting in alike; None: undefined.

    `way_m`: headroom, vehicles passed, clearance and the own length; `speeds`: the own, the VBP's and the OV's.
    """
    v, v_vbp, v_ov = speeds
    if v <= v_vbp:
        return None
    aside = lane_m / (v * math.sin(angle))  # time in which the lane is left, and got back into
    beside = (way_m - (v * math.cos(angle) - v_vbp) * aside) / (v - v_vbp)
    own_way = 2 * lane_m / math.tan(angle) + v * beside
    mph = v_ov / 0.44704
    return own_way + v_ov * (2 * aside + beside) + 0.3 * mph + (0.058 - 0.011 * mph + 0.015 * mph * mph)


def _verdict(da: float, sda: float | None, *, is_seen: bool, begin: bool) -> str:
    if sda is None or not begin:
        return "unknown"
    if da > sda:
        return "pass"
    return "fail" if is_seen else "unknown"  # what comes from beyond the road's end is not told
