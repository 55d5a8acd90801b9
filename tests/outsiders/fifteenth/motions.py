"""Motions: a path (points), and a speed along it (knots of time and speed)."""

import itertools
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tests.outsiders.fifteenth.roads import ARMS, HALF, W

Floats = NDArray[np.float64]
Knots = Sequence[tuple[float, float]]


def weave(side: int, nodes: Knots, curv: float = 0.0) -> Floats:
    """Return a path through (x, u), u towards the near side of the ego; sideways along a smooth step."""
    xs: list[float] = []
    us: list[float] = []
    for (x0, u0), (x1, u1) in itertools.pairwise(nodes):
        n = max(2, int(abs(x1 - x0) / 0.5))
        f = np.linspace(0.0, 1.0, n, endpoint=False)
        g = f**3 * (10 - 15 * f + 6 * f * f)
        xs += list(x0 + (x1 - x0) * f)
        us += list(u0 + (u1 - u0) * g)
    xs.append(nodes[-1][0])
    us.append(nodes[-1][1])
    x, y = np.array(xs), side * np.array(us)
    if curv:
        s = x + 100.0
        a = s * curv
        x, y = -100.0 + np.sin(a) / curv - np.sin(a) * y, (1 - np.cos(a)) / curv + np.cos(a) * y
    return np.column_stack([x, y])


def across(x: float, y0: float, y1: float) -> Floats:
    """Return a path straight across the road at x."""
    n = max(2, int(abs(y1 - y0) / 0.25))
    return np.column_stack([np.full(n, x), np.linspace(y0, y1, n)])


def turn(
    side: int, frm: str, to: str, *, u: float = W / 2, out: float | None = None, back: float | None = None
) -> Floats:
    """Return the way through a junction, u from the middle of the first arm and out from that of the second."""
    half, reach = HALF, 190.0
    v = u if out is None else out
    a, b = ARMS[frm], ARMS[to]
    h = a + math.pi

    def at(direction: float, r: float, heading: float, off: float) -> tuple[float, float]:
        c, s = math.cos(heading), math.sin(heading)
        return r * math.cos(direction) - side * off * s, r * math.sin(direction) + side * off * c

    p0, p1 = np.array(at(a, half + reach, h, u)), np.array(at(a, half, h, u))
    p2, p3 = np.array(at(b, half, b, v)), np.array(at(b, half + reach, b, v))
    n = int(reach / 0.5)
    first = p0 + (p1 - p0) * np.linspace(0, 1, n)[:, None]
    last = p2 + (p3 - p2) * np.linspace(0, 1, n)[:, None]
    if back is not None:
        g = np.clip(np.linspace(0, 1, n) * reach / 18.0, 0.0, 1.0)[:, None]
        g = g**3 * (10 - 15 * g + 6 * g * g)
        last = last + g * (np.array(at(b, half, b, back)) - p2)
    f = np.linspace(0, 1, 60)[1:-1, None]
    ang = math.remainder(b - h, 2 * math.pi)
    if abs(ang) < 0.1:
        mid = p1 + (p2 - p1) * f
    else:
        k = abs(np.linalg.norm(p2 - p1)) / math.sqrt(2) * 0.5523
        c1 = p1 + k * np.array([math.cos(h), math.sin(h)])
        c2 = p2 - k * np.array([math.cos(b), math.sin(b)])
        mid = (1 - f) ** 3 * p1 + 3 * f * (1 - f) ** 2 * c1 + 3 * f * f * (1 - f) * c2 + f**3 * p2
    return np.vstack([first, mid, last])


def follow(path: Floats, s0: float, speed: Knots, t: Floats) -> tuple[Floats, Floats, Floats, Floats, Floats]:
    """Return x, y, heading, vx and vy at the times t, from s0 along the path."""
    seg = np.hypot(*np.diff(path, axis=0).T)
    arc = np.concatenate([[0.0], np.cumsum(seg)])
    fine = np.unique(np.concatenate([np.arange(0.0, t[-1] + 0.02, 0.01), [k for k, _ in speed], t]))
    v = np.interp(fine, [k for k, _ in speed], [w for _, w in speed])
    s = s0 + np.concatenate([[0.0], np.cumsum((v[1:] + v[:-1]) / 2 * np.diff(fine))])
    st, vt = np.interp(t, fine, s), np.interp(t, fine, v)
    x, y = beyond(st, arc, path[:, 0]), beyond(st, arc, path[:, 1])
    e = 0.2
    hd = np.arctan2(
        beyond(st + e, arc, path[:, 1]) - beyond(st - e, arc, path[:, 1]),
        beyond(st + e, arc, path[:, 0]) - beyond(st - e, arc, path[:, 0]),
    )
    return x, y, hd, vt * np.cos(hd), vt * np.sin(hd)


def beyond(s: Floats, arc: Floats, value: Floats) -> Floats:
    """Return the value at s; before the beginning and after the end straight on."""
    out = np.interp(s, arc, value)
    d0, d1 = (value[1] - value[0]) / (arc[1] - arc[0]), (value[-1] - value[-2]) / (arc[-1] - arc[-2])
    out = np.where(s < 0, value[0] + s * d0, out)
    return np.asarray(np.where(s > arc[-1], value[-1] + (s - arc[-1]) * d1, out))


def stop(v: float, brake: float, way: float, t: float = 0.0) -> list[tuple[float, float]]:
    """Return knots: at v, then braking so as to stand after the way."""
    t1 = (way - v * v / 2 / brake) / v
    return [(t, v), (t + t1, v), (t + t1 + v / brake, 0.0)]


def go(knots: Knots, wait: float, accel: float, v: float) -> list[tuple[float, float]]:
    """Return knots that wait and then speed up to v."""
    t, w = knots[-1]
    return [*knots, (t + wait, w), (t + wait + abs(v - w) / accel, v)]
