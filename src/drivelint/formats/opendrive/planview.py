"""Evaluates the reference line (line, arc, spiral, poly3 and paramPoly3) and cubic profiles along it, at many stations at once.

Lines, arcs and spirals are treated alike: their curvature is linear in s. Their position is the integral of (cos, sin) of
a quadratic heading. For constant curvature it has a closed form; else Gauss-Legendre quadrature is used, over panels of at
most half a radian (error below 1e-12 of the length). A polynomial is a curve c(p) with a parameter p of its own.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from drivelint.arrays import wrap_angles
from drivelint.formats.opendrive.xml import MalformedError, number_attribute

if TYPE_CHECKING:
    from collections.abc import Iterable

    from lxml import etree

    from drivelint.arrays import Floats


_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
_NODES_AT_A_TIME = 2**20  # nodes at a time: bounds the memory that a long spiral takes
_MAX_TURN_RAD = 200.0  # a loop ramp turns 5 rad; more than 30 turns in one geometry is nonsense


@dataclass(frozen=True, eq=False)
class ReferenceLine:
    """The reference line at some stations: position, unit tangent, curvature, and metres of curve per metre of s."""

    x: Floats
    y: Floats
    cos: Floats
    sin: Floats
    curvature: Floats
    speed: Floats


@dataclass(frozen=True)
class Clothoid:
    """Line, arc or spiral: curvature linear in s."""

    start: float  # 1/m
    rate: float  # 1/m^2

    def evaluate(self, ds: Floats) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
        """Return u, v, cos and sin of the heading, curvature, speed, each (n,), at distances `ds` from the start."""
        heading = (self.start + 0.5 * self.rate * ds) * ds
        u, v = self._points_of_arc(ds) if self.rate == 0.0 else self._points_of_spiral(ds)
        return u, v, np.cos(heading), np.sin(heading), self.start + self.rate * ds, np.ones_like(ds)

    def _points_of_arc(self, ds: Floats) -> tuple[Floats, Floats]:
        # sinc keeps full precision where the curvature is tiny, and is the straight line where it is 0
        half = 0.5 * self.start * ds
        chord = ds * np.sinc(half / np.pi)
        return chord * np.cos(half), chord * np.sin(half)

    def _points_of_spiral(self, ds: Floats) -> tuple[Floats, Floats]:
        turn = np.abs(self.start * ds) + np.abs(0.5 * self.rate * ds * ds)
        panels = max(1, int(np.ceil(2.0 * float(turn.max(initial=0.0)))))
        at = (np.arange(panels)[:, None] + 0.5 * (_NODES + 1.0)).ravel() / panels  # fractions of ds
        weight = np.tile(0.5 * _WEIGHTS, panels) / panels
        u, v = np.empty_like(ds), np.empty_like(ds)
        block = max(1, _NODES_AT_A_TIME // len(at))
        for i in range(0, len(ds), block):
            part = ds[i : i + block]
            q = part[:, None] * at
            phi = (self.start + 0.5 * self.rate * q) * q
            u[i : i + block], v[i : i + block] = part * (np.cos(phi) @ weight), part * (np.sin(phi) @ weight)
        return u, v


@dataclass(frozen=True, eq=False)
class Polynomial:
    """A planar cubic (u(p), v(p)). `table` maps arc length to p; None if p is the arc length itself."""

    u: Floats  # (4,) ascending powers
    v: Floats
    table: tuple[Floats, Floats] | None  # (arc length, p), ascending
    stretch: float = 1.0  # metres of curve per metre of s, where the table is used

    def evaluate(self, ds: Floats) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
        """Return u, v, cos and sin of the heading, curvature, speed, each (n,), at distances `ds` from the start."""
        p = ds if self.table is None else self._parameters_at(ds * self.stretch)
        (u, du, ddu), (v, dv, ddv) = _values_and_derivatives(self.u, p), _values_and_derivatives(self.v, p)
        norm = np.hypot(du, dv)
        if not (norm > 1e-9).all():
            raise MalformedError("a polynomial geometry stands still: its derivative is zero")
        speed = norm if self.table is None else np.full_like(ds, self.stretch)
        return u, v, du / norm, dv / norm, (du * ddv - dv * ddu) / norm**3, speed

    def _parameters_at(self, ds: Floats) -> Floats:
        assert self.table is not None  # noqa: S101 - the caller's branch
        length, p_at = self.table
        k = np.clip(np.searchsorted(length, ds, side="right") - 1, 0, len(length) - 2)
        p = np.interp(ds, length, p_at)
        for _ in range(3):
            p = p - (length[k] + _arc_lengths(self.u, self.v, p_at[k], p) - ds) / _length_per_parameter(
                self.u, self.v, p
            )
        return p


def _values_and_derivatives(coef: Floats, p: Floats) -> tuple[Floats, Floats, Floats]:
    a, b, c, d = coef
    return ((d * p + c) * p + b) * p + a, (3 * d * p + 2 * c) * p + b, 6 * d * p + 2 * c


def _length_per_parameter(u: Floats, v: Floats, p: Floats) -> Floats:
    rate = np.hypot(_values_and_derivatives(u, p)[1], _values_and_derivatives(v, p)[1])
    return np.maximum(rate, 1e-9)


def _arc_lengths(u: Floats, v: Floats, p0: Floats, p1: Floats) -> Floats:
    half = 0.5 * (p1 - p0)
    nodes = p0[:, None] + half[:, None] * (_NODES + 1.0)
    return half * (_length_per_parameter(u, v, nodes) @ _WEIGHTS)


def arc_length_polynomial(u: Floats, v: Floats, p_max: float, length: float | None = None) -> Polynomial:
    """Return the curve as a function of arc length, up to p_max; with `length`, it is stretched so that p_max is reached there."""
    p_at = np.linspace(0.0, p_max, 257)
    along = np.concatenate([[0.0], np.cumsum(_arc_lengths(u, v, p_at[:-1], p_at[1:]))])
    if not along[-1] > 1e-6:
        raise MalformedError("the curve of a polynomial geometry is 0 m long")
    return Polynomial(u, v, (along, p_at), 1.0 if length is None else float(along[-1]) / length)


Shape = Clothoid | Polynomial
"""One geometry in its own frame: starts at the origin along the u axis."""


@dataclass(frozen=True, eq=False)
class PlanView:
    """The geometries of one road, in order of station."""

    s: Floats
    x: Floats
    y: Floats
    heading: Floats
    length: Floats
    shapes: tuple[Shape, ...]

    @property
    def end(self) -> float:
        """Station at which the last geometry ends."""
        return float(self.s[-1] + self.length[-1])

    def evaluate(self, s: Floats, lookup_s: Floats) -> ReferenceLine:
        """Return the line at stations `s` (n,), ascending, by the geometries that apply at stations `lookup_s` (n,)."""
        k = np.clip(np.searchsorted(self.s, lookup_s, side="right") - 1, 0, len(self.s) - 1)
        ds = s - self.s[k]
        inside = np.clip(ds, 0.0, self.length[k])
        local = np.empty((6, len(s)))
        for i in np.unique(k):
            of_shape = k == i
            local[:, of_shape] = self.shapes[i].evaluate(inside[of_shape])
        u, v, cos, sin, curvature, speed = local
        beyond = ds - inside  # a gap in the stations is bridged by a straight line; an offset at its end is reported
        u, v, curvature = u + beyond * cos, v + beyond * sin, np.where(np.abs(beyond) > 1e-3, 0.0, curvature)
        c, n = np.cos(self.heading)[k], np.sin(self.heading)[k]
        return ReferenceLine(
            self.x[k] + c * u - n * v, self.y[k] + n * u + c * v, c * cos - n * sin, n * cos + c * sin, curvature, speed
        )

    def joint_gaps_and_turns(self) -> tuple[Floats, Floats]:
        """Return distance (m) and turn (rad) between each geometry's end and the next one's start, both (n - 1,)."""
        if len(self.s) < 2:
            return np.zeros(0), np.zeros(0)
        end = self.evaluate(self.s[1:], self.s[:-1])
        turn = np.arctan2(end.sin, end.cos) - self.heading[1:]
        return np.hypot(end.x - self.x[1:], end.y - self.y[1:]), np.abs(wrap_angles(turn))


def planview(element: etree._Element | None) -> PlanView:
    """Read `<planView>`; `MalformedError` for a geometry that is missing, unknown or impossible."""
    geometries = [] if element is None else sorted(element.findall("geometry"), key=lambda g: number_attribute(g, "s"))
    geometries = [g for g in geometries if number_attribute(g, "length") > 0.0]
    if not geometries:
        raise MalformedError("the road has no <geometry> with a length")
    s, x, y, heading, length = np.array(
        [[number_attribute(g, a) for a in ("s", "x", "y", "hdg", "length")] for g in geometries]
    ).T
    return PlanView(s, x, y, heading, length, tuple(_shape(g) for g in geometries))


def _shape(geometry: etree._Element) -> Shape:
    length = number_attribute(geometry, "length")
    kind = next(iter(geometry), None)
    if kind is None:
        raise MalformedError(f"<geometry> in line {geometry.sourceline} is empty")
    match kind.tag:
        case "line":
            return Clothoid(0.0, 0.0)
        case "arc":
            return _clothoid(length, number_attribute(kind, "curvature"), number_attribute(kind, "curvature"))
        case "spiral":
            return _clothoid(length, number_attribute(kind, "curvStart"), number_attribute(kind, "curvEnd"))
        case "poly3":
            u, v = np.array([0.0, 1.0, 0.0, 0.0]), np.array([number_attribute(kind, c) for c in "abcd"])
            return arc_length_polynomial(u, v, length)
        case "paramPoly3":
            u, v = (np.array([number_attribute(kind, c + axis) for c in "abcd"]) for axis in "UV")
            if kind.get("pRange") == "arcLength":
                return Polynomial(u, v, None)
            return arc_length_polynomial(u, v, 1.0, length)
        case other:
            raise MalformedError(f"<geometry> in line {geometry.sourceline} is of an unknown kind: {other}")


def _clothoid(length: float, start: float, end: float) -> Clothoid:
    if max(abs(start), abs(end)) * length > _MAX_TURN_RAD:
        raise MalformedError(
            f"a geometry of {length:g} m with curvatures {start:g} and {end:g} 1/m turns beyond {_MAX_TURN_RAD:g} rad"
        )
    return Clothoid(start, (end - start) / length)


@dataclass(frozen=True, eq=False)
class Cubics:
    """Records a + b ds + c ds^2 + d ds^3, ds counted from each record's start; 0 before the first record."""

    start: Floats  # (n,) road station, ascending
    coef: Floats  # (n, 4)

    def evaluate(self, s: Floats, lookup_s: Floats) -> tuple[Floats, Floats]:
        """Return values and first derivatives at stations `s`, by the records that apply at stations `lookup_s`.

        `lookup_s` differs from `s` at the ends of a section, where the record inside the section applies.
        """
        if not len(self.start):
            return np.zeros_like(s), np.zeros_like(s)
        k = np.searchsorted(self.start, lookup_s, side="right") - 1
        before = k < 0
        k = np.maximum(k, 0)
        ds = s - self.start[k]
        a, b, c, d = self.coef[k].T
        value = ((d * ds + c) * ds + b) * ds + a
        slope = (3 * d * ds + 2 * c) * ds + b
        if before.any():
            value, slope = np.where(before, 0.0, value), np.where(before, 0.0, slope)
        return value, slope


def cubics(elements: Iterable[etree._Element], s_attribute: str, origin: float = 0.0) -> Cubics:
    """Read polynomial records. `s_attribute`: the attribute with their start, which counts from `origin`.

    Of records with the same start, the last one applies.
    """
    rows = [
        (origin + number_attribute(e, s_attribute, 0.0), *(number_attribute(e, c, 0.0) for c in "abcd"))
        for e in elements
    ]
    rows.sort(key=lambda row: row[0])
    table = np.array(rows, dtype=np.float64).reshape(-1, 5)
    return Cubics(table[:, 0].copy(), table[:, 1:].copy())
