"""The plan view of a moment: lanes, boxes, ways, danger spaces and the least distance, as numbers for an SVG.

The road runs to the right as the ego drives it. Lengths are viewBox units, y down; everything is clipped to the view.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
import shapely

from drivelint.report.html.svg import closed, num, polyline

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from drivelint.report.html.road import Points, Road

WIDTH: Final = 600
_HEIGHT: Final = (190.0, 330.0)
_LEAST_M: Final = (44.0, 16.0)  # the view shows at least this much of the road, along and across
_PAD_M: Final = (7.0, 3.5)
_DOT_M: Final = 0.8  # drawn size of an actor whose size is not known
_BARS_M: Final = (1, 2, 5, 10, 20, 50, 100)
_TOUCH_M: Final = 0.005  # boxes nearer than this are not apart


class Text(NamedTuple):
    """A label at a point."""

    x: str
    y: str
    text: str
    kind: str


class Body(NamedTuple):
    """An actor's box with the line of its front window, and its way before and after the moment."""

    kind: str
    box: str
    front: str
    before: str
    after: str
    seconds: list[tuple[str, str]]


class Line(NamedTuple):
    """A straight line."""

    x1: str
    y1: str
    x2: str
    y2: str


@dataclass(frozen=True)
class Plan:
    """Everything that the template draws, in drawing order, and the same in words."""

    height: str
    road: str
    beside: str
    markings: list[tuple[str, str]]
    arrows: list[str]
    spaces: list[tuple[str, str]]
    bodies: list[Body]
    gaps: list[Line]
    texts: list[Text]
    scale_px: str
    scale_m: int
    words: str


@dataclass(frozen=True)
class _View:
    """From map metres to the view: centre of the ego and heading of the road, middle of the view (ahead, left) and units per metre."""

    x: float
    y: float
    cos: float
    sin: float
    ahead: float
    left: float
    scale: float
    height: float

    def __call__(self, xy: Points, /) -> Points:
        """Return viewBox coordinates, shape (n, 2), of map points of the same shape."""
        dx, dy = xy[:, 0] - self.x, xy[:, 1] - self.y
        u, v = dx * self.cos + dy * self.sin - self.ahead, dy * self.cos - dx * self.sin - self.left
        return np.column_stack([WIDTH / 2 + self.scale * u, self.height / 2 - self.scale * v])


def plan(scene: Mapping[str, Any], road: Road, concerned: Collection[str], spaces: Sequence[Mapping[str, Any]]) -> Plan:
    """Return the plan view of a row of the table `scene`.

    `concerned`: the objects that the findings are about; `spaces`: rows of `danger_space` at the moment, to be shown.
    """
    actors: list[dict[str, Any]] = scene["actors"]
    ego, others = actors[0], actors[1:]
    met = [a for a in others if a["actor_id"] in concerned]
    around = [s for s in spaces if s["actor_id"] in {ego["actor_id"], *concerned}]
    rings = [(s["actor_id"], _ring(s)) for s in around]
    lanes = road.near(scene["environment_id"], scene["lanelets"])
    shown = [_corners(a) for a in (ego, *met)] + [ring for _, ring in rings]
    heading = lanes.direction(ego["x_m"], ego["y_m"], ego["yaw_rad"] or 0.0)
    view = _fit(ego, heading, np.concatenate(shown))
    inside = _Clip(view)
    texts, gaps, told = _distances(ego, met, view)
    texts += [_label(a, ego, met, view) for a in actors if inside.has(a)]
    length_px, length_m = _bar(view.scale)
    return Plan(
        height=num(view.height),
        road=inside.areas(lanes.drivable(view)),
        beside=inside.areas(lanes.beside(view)),
        markings=[(kind, d) for kind, line in lanes.markings(view) if (d := inside.line(line))],
        arrows=[inside.arrow(p, q) for p, q in lanes.arrows(view) if inside.point(p)],
        spaces=[(_kind(who, ego, concerned), closed(view(ring))) for who, ring in rings],
        bodies=[
            _body(a, _kind(a["actor_id"], ego, concerned), view, inside, scene["t_ns"])
            for a in sorted((*others, ego), key=_area, reverse=True)  # whoever is under a larger one is still seen
            if inside.has(a)
        ],
        gaps=gaps,
        texts=texts,
        scale_px=num(length_px),
        scale_m=length_m,
        words=_words(ego, met, told, around),
    )


def _fit(ego: Mapping[str, Any], yaw: float, shown: Points) -> _View:
    """Return the view, this heading to the right, that shows these map points with some road around them."""
    raw = _View(ego["x_m"], ego["y_m"], math.cos(yaw), math.sin(yaw), 0.0, 0.0, 1.0, 0.0)
    flat = raw(shown)
    u, v = flat[:, 0] - WIDTH / 2, -flat[:, 1]
    along = max(float(np.ptp(u)) + 2 * _PAD_M[0], _LEAST_M[0])
    across = max(float(np.ptp(v)) + 2 * _PAD_M[1], _LEAST_M[1])
    scale = min(WIDTH / along, _HEIGHT[1] / across)
    height = min(max(across * scale, _HEIGHT[0]), _HEIGHT[1])
    return replace(
        raw, ahead=float(u.max() + u.min()) / 2, left=float(v.max() + v.min()) / 2, scale=scale, height=round(height, 1)
    )


class _Clip:
    """What of a drawing lies inside the view."""

    def __init__(self, view: _View) -> None:
        self._view = view
        self._rect = (-3.0, -3.0, WIDTH + 3.0, view.height + 3.0)

    def point(self, p: Points) -> bool:
        x0, y0, x1, y1 = self._rect
        return bool(x0 + 9 < p[0] < x1 - 9 and y0 + 9 < p[1] < y1 - 9)

    def has(self, actor: Mapping[str, Any]) -> bool:
        return bool(shapely.intersects(shapely.polygons(self._view(_corners(actor))), shapely.box(*self._rect)))

    def areas(self, polygons: Sequence[shapely.Geometry]) -> str:
        """Return the union of polygons as a path."""
        view = shapely.box(*self._rect)
        seen = [polygon for polygon in polygons if shapely.intersects(polygon, view)]
        if not seen:
            return ""
        cut = shapely.intersection(shapely.union_all(seen, grid_size=0.05), view)
        parts = [p for p in shapely.get_parts(shapely.simplify(cut, 0.2)) if p.geom_type == "Polygon"]
        rings = [ring for p in parts for ring in (p.exterior, *p.interiors)]
        return "".join(closed(shapely.get_coordinates(ring)[:-1]) for ring in rings)

    def line(self, points: Points) -> str:
        """Return a line as a path, in several pieces if it leaves the view."""
        if len(points) < 2:
            return ""
        cut = shapely.clip_by_rect(shapely.linestrings(points), *self._rect)
        parts = [p for p in shapely.get_parts(shapely.simplify(cut, 0.1)) if p.geom_type == "LineString"]
        return "".join(polyline(shapely.get_coordinates(part)) for part in parts)

    def arrow(self, at: Points, towards: Points) -> str:
        """Return a small chevron at a point."""
        u = (towards - at) / max(float(np.hypot(*(towards - at))), 1e-9)
        n = np.array([-u[1], u[0]])
        return polyline(np.array([at - 4 * u + 3 * n, at, at - 4 * u - 3 * n]))


def _corners(actor: Mapping[str, Any]) -> Points:
    """Return the corners of a box in map metres, front left first, counter-clockwise; shape (4, 2)."""
    hl, hw = (actor["length_m"] or _DOT_M) / 2, (actor["width_m"] or _DOT_M) / 2
    return _of_body(actor, [(hl, hw), (-hl, hw), (-hl, -hw), (hl, -hw)])


def _area(actor: Mapping[str, Any]) -> float:
    return (actor["length_m"] or _DOT_M) * (actor["width_m"] or _DOT_M)


def _of_body(actor: Mapping[str, Any], points: Sequence[tuple[float, float]]) -> Points:
    yaw = actor["yaw_rad"] or 0.0
    c, s = math.cos(yaw), math.sin(yaw)
    return np.array([(actor["x_m"] + c * u - s * v, actor["y_m"] + s * u + c * v) for u, v in points])


def _ring(space: Mapping[str, Any]) -> Points:
    return np.column_stack([space["x_m"], space["y_m"]])


def _kind(actor_id: str, ego: Mapping[str, Any], concerned: Collection[str]) -> str:
    return "ego" if actor_id == ego["actor_id"] else "met" if actor_id in concerned else "other"


def _body(actor: Mapping[str, Any], kind: str, view: _View, inside: _Clip, t_ns: int) -> Body:
    hl, hw = (actor["length_m"] or 0.0) / 2, (actor["width_m"] or 0.0) / 2
    heading = (
        [(0.5 * hl, 0.8 * hw), (0.82 * hl, 0.0), (0.5 * hl, -0.8 * hw)] if actor["yaw_rad"] is not None and hl else []
    )
    before, after, seconds = "", "", []
    way: list[dict[str, Any]] = actor["path"] or []
    if kind != "other" and way and np.ptp([p["x_m"] for p in way]) + np.ptp([p["y_m"] for p in way]) > 1:
        t = np.array([p["t_ns"] for p in way])
        xy = view(np.array([(p["x_m"], p["y_m"]) for p in way]))
        before, after = inside.line(xy[t <= t_ns]), inside.line(xy[t >= t_ns])
        near = np.abs((t - t_ns) - 1e9 * np.round((t - t_ns) / 1e9)) < 5e7
        seconds = [(num(p[0]), num(p[1])) for p in xy[near & (t != t_ns)] if inside.point(p)]
    front = polyline(view(_of_body(actor, heading))) if heading else ""
    return Body(kind, closed(view(_corners(actor))), front, before, after, seconds)


def _distances(
    ego: Mapping[str, Any], met: Sequence[Mapping[str, Any]], view: _View
) -> tuple[list[Text], list[Line], list[str]]:
    """Return labels, lines and words of the least distances from the ego's box to those concerned."""
    texts, lines, told = [], [], []
    for actor in met:
        a, b = _corners(ego), _corners(actor)
        nearest = shapely.get_coordinates(shapely.shortest_line(shapely.polygons(a), shapely.polygons(b)))
        far = float(np.hypot(*(nearest[1] - nearest[0])))
        if far < _TOUCH_M:
            common = float(shapely.area(shapely.intersection(shapely.polygons(a), shapely.polygons(b))))
            told.append("the boxes overlap" if common > _TOUCH_M else "the boxes touch")
            continue
        told.append(f"{far:.2f} m from box to box")
        p, q = view(nearest)
        middle = (p + q) / 2
        text = f"{far:.1f} m" if far >= 10 else f"{far:.2f} m"
        if np.hypot(*(q - p)) > 60:
            lines.append(Line(num(p[0]), num(p[1]), num(q[0]), num(q[1])))
            texts.append(Text(num(middle[0]), num(middle[1] - 6), text, "gap"))
        else:  # too short for a label on it: lead it out to the free side
            top = float(min(view(a)[:, 1].min(), view(b)[:, 1].min()))
            y = top - 26 if top > 44 else float(max(view(a)[:, 1].max(), view(b)[:, 1].max())) + 34
            lines.append(Line(num(p[0]), num(p[1]), num(q[0]), num(q[1])))
            lines.append(Line(num(middle[0]), num(middle[1]), num(middle[0]), num(y + (4 if y < middle[1] else -12))))
            texts.append(Text(num(middle[0]), num(y), text, "gap"))
    return texts, lines, told


def _label(actor: Mapping[str, Any], ego: Mapping[str, Any], met: Sequence[Mapping[str, Any]], view: _View) -> Text:
    """Return an actor's name, on the side of its box that faces away from whom it met."""
    box = view(_corners(actor))
    middle = box.mean(axis=0)
    partner = met[0] if actor is ego and met else ego
    lower = middle[1] - view(_corners(partner)).mean(axis=0)[1]
    below = actor is not partner and (lower > 1 or (abs(lower) <= 1 and actor is not ego))
    y = box[:, 1].max() + 14 if below else box[:, 1].min() - 6
    name, kind = (
        (f"ego {actor['actor_id']}", "ego") if actor is ego else (actor["actor_id"], "met" if actor in met else "other")
    )
    x = min(max(float(middle[0]), 22.0), WIDTH - 22.0)
    return Text(num(x), num(min(max(float(y), 12.0), view.height - 4.0)), name, kind)


def _bar(scale: float) -> tuple[float, int]:
    """Return length in units and in metres of the scale bar."""
    metres = next((m for m in _BARS_M if m * scale >= 55), _BARS_M[-1])
    return metres * scale, metres


def _words(
    ego: Mapping[str, Any],
    met: Sequence[Mapping[str, Any]],
    told: Sequence[str],
    spaces: Sequence[Mapping[str, Any]],
) -> str:
    """Return the picture in words."""
    speeds = [f"ego {ego['actor_id']} at {_speed(ego)}"] + [f"{a['actor_id']} at {_speed(a)}" for a in met]
    parts = [", ".join(speeds)]
    parts += told
    if spaces:
        lengths = ", ".join(
            f"{'ego' if s['actor_id'] == ego['actor_id'] else s['actor_id']} {s['length_m']:.1f} m" for s in spaces
        )
        parts.append(f"danger spaces: {lengths}")
    return "; ".join(parts)


def _speed(actor: Mapping[str, Any]) -> str:
    v = actor["speed_mps"]
    return "unknown speed" if v is None else f"{v:.1f} m/s"
