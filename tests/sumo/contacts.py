"""Whose boxes touch, by an independent test of two rectangles; and vehicles planted into a log that touch somebody."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from tests.sumo.reading import Log

    Floats = NDArray[np.float64]

MERGE_STEPS = 20  # steps of contact at most 2 s apart are one
RADIUS_M = 12.0  # no box here reaches further from another's middle
GAP_M = 0.1  # a planted vehicle comes so deep into the other's box, or so near to it
LIFE = 30  # steps that a planted vehicle is there, before the closest moment and after it
APART_STEPS, APART_M = 100, 400.0  # two plants are apart in time or in place
CLEAR_M = 60.0  # nobody else comes so near to a planted vehicle
ASIDE_M = 40.0  # two planted vehicles meet so far to the left of the road


class Contact(NamedTuple):
    """A stretch of contact of two vehicles (ids in order), first and last step in tenths of a second."""

    id_a: str
    id_b: str
    first: int
    last: int


class Track(NamedTuple):
    """A planted vehicle: its type's index in the log's sizes; the middle of its box, its heading and speed, step by step."""

    name: str
    like: int
    first: int
    x: Floats
    y: Floats
    heading: Floats
    speed: Floats


class Plant(NamedTuple):
    """A meeting of two vehicles, of which one or both are planted, that touches or only comes near."""

    kind: str
    step: int
    planted_id: str
    other_id: str
    touches: bool
    x_m: float
    y_m: float
    tracks: tuple[Track, ...]


def contacts(log: Log) -> list[Contact]:
    """Return every stretch in which two boxes overlap or touch."""
    cos, sin = np.cos(log.heading), np.sin(log.heading)
    half = log.sizes[log.id_index] / 2
    x, y = log.x - half[:, 0] * cos, log.y - half[:, 0] * sin
    found: dict[tuple[int, int], list[int]] = {}
    for k in range(1, int(np.bincount(log.step).max())):
        i = np.flatnonzero((log.step[k:] == log.step[:-k]) & (np.hypot(x[k:] - x[:-k], y[k:] - y[:-k]) < RADIUS_M))
        j = i + k
        apart = np.full(len(i), -np.inf)
        for ax, ay in ((cos[i], sin[i]), (-sin[i], cos[i]), (cos[j], sin[j]), (-sin[j], cos[j])):
            reach = [
                half[n, 0] * np.abs(cos[n] * ax + sin[n] * ay) + half[n, 1] * np.abs(cos[n] * ay - sin[n] * ax)
                for n in (i, j)
            ]
            apart = np.maximum(apart, np.abs((x[j] - x[i]) * ax + (y[j] - y[i]) * ay) - reach[0] - reach[1])
        for n in np.flatnonzero(apart <= 0):
            pair = sorted((int(log.id_index[i[n]]), int(log.id_index[j[n]])))
            found.setdefault((pair[0], pair[1]), []).append(int(log.step[i[n]]))
    return sorted(c for (a, b), steps in found.items() for c in _stretches(log.ids[a], log.ids[b], sorted(steps)))


def _stretches(a: str, b: str, steps: list[int]) -> list[Contact]:
    one, other = sorted((a, b))
    cut = [n for n in range(1, len(steps)) if steps[n] - steps[n - 1] > MERGE_STEPS]
    parts = zip([0, *cut], [*cut, len(steps)], strict=True)
    return [Contact(one, other, steps[begin], steps[end - 1]) for begin, end in parts]


def plants(log: Log, per_kind: int, seed: int) -> list[Plant]:
    """Choose places for meetings of every kind, `per_kind` that touch and as many that only come near; all drive as cars can."""
    random = np.random.default_rng(seed)
    alone = _alone(log)
    found: list[Plant] = []
    for kind in (*OF_TRAFFIC, *BESIDE_ROAD):
        for n in range(2 * per_kind):
            name = f"{kind.replace(' ', '-')}-{n}"
            for row in random.permutation(alone):
                step, like = int(log.step[row]), int(random.integers(len(log.ids)))
                busy = (
                    abs(p.step - step) < APART_STEPS and np.hypot(p.x_m - log.x[row], p.y_m - log.y[row]) < APART_M
                    for p in found
                )
                if not any(busy):
                    found.append(_plant(log, kind, name, row, like, touches=n < per_kind))
                    break
            else:
                raise LookupError(f"no place for a contact of kind {kind}: drive for longer")
    return found


def _alone(log: Log) -> NDArray[np.intp]:
    """Return the rows around which a vehicle drives straight on for the life of a planted one, fast, and nobody is near."""
    free = np.ones(len(log.step), np.bool_)
    for k in range(1, int(np.bincount(log.step).max())):
        i = np.flatnonzero(
            (log.step[k:] == log.step[:-k]) & (np.hypot(log.x[k:] - log.x[:-k], log.y[k:] - log.y[:-k]) < CLEAR_M)
        )
        free[i] = free[i + k] = False
    free &= log.speed > MOVING_MPS
    found = []
    for who in range(len(log.ids)):
        rows = np.flatnonzero(log.id_index == who)
        for k in range(LIFE, len(rows) - LIFE):
            span = rows[k - LIFE : k + LIFE + 1]
            if free[span].all() and np.ptp(log.heading[span]) < STRAIGHT_RAD:
                found.append(rows[k])
    return np.array(found)


def _plant(log: Log, kind: str, name: str, row: int, like: int, *, touches: bool) -> Plant:
    """Return a meeting with the vehicle of this row, or beside the road where it drives."""
    step, near = int(log.step[row]), int(log.id_index[row])
    span = np.arange(step - LIFE, step + LIFE + 1)
    vehicle = log.of(near).during(span[0], span[-1])
    meeting = _Meeting(
        kind, vehicle, (span - step) / 10, -GAP_M if touches else GAP_M, log.sizes[near], log.sizes[like]
    )
    moves = [_of_traffic(meeting)] if kind in OF_TRAFFIC else _beside_road(meeting)
    tracks = tuple(
        Track(f"{name}-{n}", who, int(span[0]), *move)
        for n, (who, move) in enumerate(zip((near, like)[-len(moves) :], moves, strict=True))
    )
    other = log.ids[near] if kind in OF_TRAFFIC else tracks[0].name
    return Plant(kind, step, tracks[-1].name, other, touches, float(log.x[row]), float(log.y[row]), tracks)


OF_TRAFFIC = ("behind", "beside", "oncoming beside")
BESIDE_ROAD = {"head-on": np.pi, "across": np.pi / 2, "askew": np.radians(12.0)}
MOVING_MPS = 10.0
STRAIGHT_RAD = 0.002
_PASSING_MPS = 6.0
_BRAKE_MPS2 = 3.0
_Move = tuple["Floats", "Floats", "Floats", "Floats"]
"""The middle of a box, its heading and its speed, step by step."""


class _Meeting(NamedTuple):
    """`vehicle`: the one of the log; `t`: seconds from the closest moment; boxes: length and width of the two."""

    kind: str
    vehicle: Log
    t: Floats
    gap: float
    box: Floats
    planted: Floats


def _of_traffic(m: _Meeting) -> _Move:
    """Return the move of a vehicle that comes up to one of the log from behind or from its side, or meets it."""
    length, width = m.box
    beside = (width + m.planted[1]) / 2
    apart = m.gap + 0.4 * m.t**2
    ahead, left = np.zeros(len(m.t)), np.zeros(len(m.t))
    if m.kind == "behind":
        ahead = -(length + m.planted[0]) / 2 - apart
    elif m.kind == "beside":
        left = -(beside + apart)
    else:
        way = np.cumsum(m.vehicle.speed) / 10
        ahead, left = 2.0 * (way[LIFE] - way), np.full(len(m.t), -(beside + m.gap))
    cos, sin = np.cos(m.vehicle.heading), np.sin(m.vehicle.heading)
    x = m.vehicle.x + (ahead - length / 2) * cos - left * sin
    y = m.vehicle.y + (ahead - length / 2) * sin + left * cos
    vx, vy = np.gradient(x, 0.1), np.gradient(y, 0.1)
    return x, y, np.arctan2(vy, vx), np.hypot(vx, vy)


def _beside_road(m: _Meeting) -> list[_Move]:
    """Return the moves of a vehicle that stands beside the road and of one that drives up to it, or past it."""
    turned, nothing = BESIDE_ROAD[m.kind], np.zeros(len(m.t))
    along, speed = _PASSING_MPS * m.t, np.full(len(m.t), _PASSING_MPS)
    # seen from the vehicle that stands: where the middle of the other one is when it is closest
    ahead, left = m.box[0] / 2 + m.gap, 0.0
    if m.kind == "head-on":
        ahead += m.planted[0] / 2
        to_go = np.minimum(m.t, 0.0)
        along, speed = -_BRAKE_MPS2 / 2 * to_go**2, -_BRAKE_MPS2 * to_go
    elif m.kind == "across":
        ahead += m.planted[1] / 2
    else:  # its left side passes the front right corner
        out = m.planted[1] / 2 + m.gap
        ahead, left = m.box[0] / 2 + out * np.sin(turned), -m.box[1] / 2 - out * np.cos(turned)
    angle = m.vehicle.heading[LIFE]
    cos, sin = np.cos(angle), np.sin(angle)
    x, y = m.vehicle.x[LIFE] - ASIDE_M * sin + nothing, m.vehicle.y[LIFE] + ASIDE_M * cos + nothing
    passing_x = x + ahead * cos - left * sin + along * np.cos(angle + turned)
    passing_y = y + ahead * sin + left * cos + along * np.sin(angle + turned)
    return [(x, y, nothing + angle, nothing), (passing_x, passing_y, nothing + angle + turned, speed)]


def write(log: Log, all_plants: list[Plant], source: Path, target: Path) -> None:
    """Copy a log with the planted vehicles in it."""
    lines: dict[int, list[str]] = {}
    for plant in all_plants:
        for track in plant.tracks:
            half = log.sizes[track.like, 0] / 2
            front_x, front_y = track.x + half * np.cos(track.heading), track.y + half * np.sin(track.heading)
            degrees = (90.0 - np.degrees(track.heading)) % 360.0
            for k, (x, y, angle, speed) in enumerate(zip(front_x, front_y, degrees, track.speed, strict=True)):
                lines.setdefault(track.first + k, []).append(
                    f'        <vehicle id="{track.name}" x="{x:.4f}" y="{y:.4f}" angle="{angle:.4f}"'
                    f' type="{log.kinds[track.like]}" speed="{speed:.4f}" pos="0" lane="ab_0"/>\n'
                )
    step = -1
    with source.open(encoding="utf-8") as read, target.open("w", encoding="utf-8") as out:
        for line in read:
            if begun := re.search(r'<timestep time="([^"]+)"', line):
                step = round(float(begun[1]) * 10)
            if "</timestep>" in line:
                out.writelines(lines.get(step, ()))
            out.write(line)


def as_planted(all_plants: list[Plant], read_contacts: list[Contact]) -> list[str]:
    """Return the plants that the reading does not see as they were meant."""
    touched = {(c.id_a, c.id_b): c for c in read_contacts}
    wrong = []
    for plant in all_plants:
        one, other = sorted((plant.planted_id, plant.other_id))
        if ((one, other) in touched) != plant.touches:
            wrong.append(f"{plant.kind} of {one} and {other}: {'' if plant.touches else 'no '}contact was planted")
    return wrong
