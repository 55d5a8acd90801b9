"""Whose boxes touch, by an independent test of two rectangles; and contacts planted into a log."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tests.sumo.reading import Log

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

MERGE_STEPS = 20  # steps of contact at most 2 s apart are one
STEPS = 5  # that a planted contact lasts
REST = 200
RADIUS_M = 12.0  # no box here reaches further from another's middle


class Contact(NamedTuple):
    """A stretch of contact of two vehicles (ids in order), first and last step in tenths of a second."""

    one: str
    other: str
    first: int
    last: int


class Plant(NamedTuple):
    """Where one vehicle is put, at the middle of a box, instead of where it was."""

    kind: str
    who: int
    other: int
    step: int
    touches: bool


def contacts(log: Log) -> list[Contact]:
    """Return every stretch in which two boxes overlap or touch."""
    cos, sin = np.cos(log.heading), np.sin(log.heading)
    half = log.sizes[log.who] / 2
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
            pair = sorted((int(log.who[i[n]]), int(log.who[j[n]])))
            found.setdefault((pair[0], pair[1]), []).append(int(log.step[i[n]]))
    return sorted(c for (a, b), steps in found.items() for c in _stretches(log.ids[a], log.ids[b], sorted(steps)))


def _stretches(a: str, b: str, steps: list[int]) -> list[Contact]:
    one, other = sorted((a, b))
    cut = [n for n in range(1, len(steps)) if steps[n] - steps[n - 1] > MERGE_STEPS]
    parts = zip([0, *cut], [*cut, len(steps)], strict=True)
    return [Contact(one, other, steps[begin], steps[end - 1]) for begin, end in parts]


def plants(log: Log, per_kind: int, seed: int) -> list[Plant]:
    """Choose places for contacts of every kind, and for as many that only come near; nobody is taken twice within `REST` steps."""
    random = np.random.default_rng(seed)
    found: list[Plant] = []
    for kind in _KINDS:
        for n in range(2 * per_kind):
            for _ in range(500):
                step = int(random.choice(log.step))
                there = [set(log.at(step + k).who.tolist()) for k in (-STEPS, 2 * STEPS)]
                taken = {who for p in found if abs(p.step - step) < REST for who in (p.who, p.other)}
                if plant := _try(log.at(step), kind, there[0] & there[1] - taken, random, touches=n < per_kind):
                    found.append(plant)
                    break
            else:
                raise LookupError(f"no place for a contact of kind {kind}: drive for longer")
    return found


def expected(log: Log, plant: Plant) -> Contact:
    """Return the contact that was planted."""
    one, other = sorted((log.ids[plant.who], log.ids[plant.other]))
    return Contact(one, other, plant.step, plant.step + STEPS - 1)


_KINDS = {
    # where the middle of the planted box is, seen from the other one's, and how it is turned: longitudinal and lateral side, degrees
    "behind": (-1, 0, 0.0),
    "head-on": (1, 0, 180.0),
    "beside": (0, -1, 0.0),
    "oncoming beside": (0, -1, 180.0),
    "across": (1, 0, 90.0),
    "askew": (0, -1, 12.0),
}


def _try(at: Log, kind: str, free: set[int], random: np.random.Generator, *, touches: bool) -> Plant | None:
    """Return a planted pair at this step, if two that are free drive there in the way that the kind needs, clear of others."""
    opposite = _KINDS[kind][2] == 180.0
    order = random.permutation(len(at.who))
    for i in order:
        for j in order:
            a, b = int(at.who[i]), int(at.who[j])
            if i == j or not {a, b} <= free or (at.against[i] != at.against[j]) != opposite:
                continue
            others = np.hypot(at.x - at.x[j], at.y - at.y[j])
            if np.sort(others)[1] > 4 * RADIUS_M and np.hypot(at.x[i] - at.x[j], at.y[i] - at.y[j]) < 900:
                return Plant(kind, a, b, int(at.step[0]), touches)
    return None


def write(log: Log, chosen: list[Plant], source: Path, target: Path) -> None:
    """Copy a log with the planted vehicles moved for a few steps: 0.1 m into the other's box, or 0.1 m clear of it."""
    moved = {}
    for plant in chosen:
        along, aside, turned = _KINDS[plant.kind]
        for step in range(plant.step, plant.step + STEPS):
            at = log.at(step)
            j = int(np.flatnonzero(at.who == plant.other)[0])
            (length, width), (own_length, own_width) = log.sizes[plant.other], log.sizes[plant.who]
            heading = at.heading[j] + math.radians(turned)
            c, s = abs(math.cos(math.radians(turned))), abs(math.sin(math.radians(turned)))
            gap = -0.1 if plant.touches else 0.1
            ahead = along * (length / 2 + (own_length * c + own_width * s) / 2 + gap)
            if plant.kind == "askew":  # its front corner beside the other's middle, however long the two are
                ahead -= own_length / 2 * c - own_width / 2 * s
            left = aside * (width / 2 + (own_length * s + own_width * c) / 2 + gap)
            hx, hy = math.cos(at.heading[j]), math.sin(at.heading[j])
            # its front bumper's middle, from the other's
            x = at.x[j] + (ahead - length / 2) * hx - left * hy + own_length / 2 * math.cos(heading)
            y = at.y[j] + (ahead - length / 2) * hy + left * hx + own_length / 2 * math.sin(heading)
            moved[step, log.ids[plant.who]] = (x, y, (90.0 - math.degrees(heading)) % 360.0)
    step = -1
    with source.open(encoding="utf-8") as lines, target.open("w", encoding="utf-8") as out:
        for line in lines:
            if begun := re.search(r'<timestep time="([^"]+)"', line):
                step = round(float(begun[1]) * 10)
            vehicle = re.search(r'<vehicle id="([^"]+)"', line)
            if vehicle and (place := moved.get((step, vehicle[1]))):
                for name, value in zip(("x", "y", "angle"), place, strict=True):
                    line = re.sub(rf' {name}="[^"]*"', f' {name}="{value:.4f}"', line)  # noqa: PLW2901
            out.write(line)
