"""The plan view of an incident: lanes, boxes, paths, danger spaces and the least distance, as numbers for an SVG.

The ego's direction on the road points to the right. Lanes, boxes, paths and danger spaces have the drawn units of `road` and share
one matrix, so that a script can move them. Names and distances have viewBox units, y down.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import shapely

from drivelint.report.html.road import UNITS_PER_M
from drivelint.report.html.svg import polygon_path, polyline_path, svg_number
from drivelint.result.text import MOST_LABEL_CHARS, brief_id, ego_name

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Sequence

    from drivelint.report.html.road import DrawnLanes, DrawnMaps, Points
    from drivelint.result.text import Row

WIDTH: Final = 600
_VIEW_HEIGHT_RANGE: Final = (190.0, 330.0)
_LEAST_VIEW_M: Final = (44.0, 16.0)  # the view shows at least this much of the road, along and across
_VIEW_PADDING_M: Final = (7.0, 3.5)
_DRAWN_SIZE_IF_UNKNOWN_M: Final = 0.8  # the drawn size of an actor whose size is unknown
_MOST_OTHER_ACTORS_NAMED_IF_IDS_ARE_LONG: Final = 5
_SCALE_BARS_M: Final = (1, 2, 5, 10, 20, 50, 100)
_ACTORS_KEPT_BESIDE_VIEW_SHARE: Final = (
    0.5  # actors up to half a view outside may enter the view when the scene is replayed
)
_TOUCHING_DISTANCE_M: Final = 0.005  # boxes nearer than this touch


@dataclass(frozen=True)
class _View:
    """The transformation from map metres to the view.

    `x`, `y`: the ego's centre; `cos`, `sin`: of the road's heading; `ahead`, `left`: the middle of the view relative to the ego;
    `scale`: viewBox units per metre.
    """

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
        return np.column_stack(self._view_coordinates(*xy.T))

    def _view_coordinates(self, x: Any, y: Any) -> tuple[Any, Any]:
        dx, dy = x - self.x, y - self.y
        u, v = dx * self.cos + dy * self.sin - self.ahead, dy * self.cos - dx * self.sin - self.left
        return WIDTH / 2 + self.scale * u, self.height / 2 - self.scale * v

    def svg_matrix(self, lanes: DrawnLanes) -> str:
        """Return the SVG transformation from the map's drawn units to the view."""
        k = self.scale / UNITS_PER_M
        e, f = self(np.array([lanes.origin]))[0]
        turn = f"{k * self.cos:.5f},{k * self.sin:.5f},{k * self.sin:.5f},{-k * self.cos:.5f}"
        return f"matrix({turn},{svg_number(e)},{svg_number(f)})"

    def has_actor(self, actor: Row, room: float = 0.0) -> bool:
        """Return whether an actor's centre is in the view, or outside it by at most `room` times the view's width."""
        x, y = self._view_coordinates(actor["x_m"], actor["y_m"])
        beside = room * WIDTH
        return bool(-beside < x < WIDTH + beside and -beside < y < self.height + beside)


def plan_view(scene: Row, road: DrawnMaps, object_ids: Collection[str], spaces: Sequence[Row]) -> dict[str, Any]:
    """Return the plan view of a row of the table `scene` for the template: its shapes in drawing order, and a description.

    `object_ids`: the objects that the findings are about; `spaces`: rows of `danger_space` at the moment, to be shown.
    """
    actors: list[dict[str, Any]] = scene["actors"]
    ego, other_actors = actors[0], actors[1:]
    met = [a for a in other_actors if a["actor_id"] in object_ids]
    around = [s for s in spaces if s["actor_id"] in {ego["actor_id"], *object_ids}]
    rings = [(s["actor_id"], np.column_stack([s["x_m"], s["y_m"]])) for s in around]
    lanes = road.lanes_of(scene["environment_id"])
    outlines = [box_corners_m(a) for a in (ego, *met)] + [ring for _, ring in rings]
    heading = lanes.road_heading_rad(ego["x_m"], ego["y_m"], ego["yaw_rad"] or 0.0)
    view = _fitted_view(ego, heading, np.concatenate(outlines))
    texts, gaps, distance_words = _least_distance_labels_and_lines(ego, met, view)
    texts += [
        _name_label(a, ego, met, view) for a in _actors_with_label([a for a in actors if view.has_actor(a)], ego, met)
    ]
    bar_m = next((m for m in _SCALE_BARS_M if m * view.scale >= 55), _SCALE_BARS_M[-1])
    return {
        "height": svg_number(view.height),
        "matrix": view.svg_matrix(lanes),
        "tiles": lanes.tile_names(scene["lanelets"]),
        "spaces": [
            (_role_of_actor(actor_id, ego, object_ids), polygon_path(np.rint(lanes.to_drawn_units(ring))))
            for actor_id, ring in rings
        ],
        "bodies": [
            _actor_drawing(a, _role_of_actor(a["actor_id"], ego, object_ids), lanes, scene["t_ns"])
            for a in sorted(
                (*other_actors, ego), key=_drawn_area_m2, reverse=True
            )  # small actors are drawn over large actors
            if a is ego or a in met or view.has_actor(a, _ACTORS_KEPT_BESIDE_VIEW_SHARE)
        ],
        "gaps": gaps,
        "texts": texts,
        "scale_px": svg_number(bar_m * view.scale),
        "scale_m": bar_m,
        "ego": ego,
        "met": met,
        "told": distance_words,
        "around": around,
    }


def _fitted_view(ego: Row, yaw: float, points: Points) -> _View:
    """Return the view that shows these map points and some road around them, with heading `yaw` pointing to the right."""
    raw = _View(ego["x_m"], ego["y_m"], math.cos(yaw), math.sin(yaw), 0.0, 0.0, 1.0, 0.0)
    flat = raw(points)
    u, v = flat[:, 0] - WIDTH / 2, -flat[:, 1]
    along = max(float(np.ptp(u)) + 2 * _VIEW_PADDING_M[0], _LEAST_VIEW_M[0])
    across = max(float(np.ptp(v)) + 2 * _VIEW_PADDING_M[1], _LEAST_VIEW_M[1])
    scale = min(WIDTH / along, _VIEW_HEIGHT_RANGE[1] / across)
    height = min(max(across * scale, _VIEW_HEIGHT_RANGE[0]), _VIEW_HEIGHT_RANGE[1])
    return replace(
        raw, ahead=float(u.max() + u.min()) / 2, left=float(v.max() + v.min()) / 2, scale=scale, height=round(height, 1)
    )


def _drawn_size_m(actor: Row) -> tuple[float, float]:
    return actor["length_m"] or _DRAWN_SIZE_IF_UNKNOWN_M, actor["width_m"] or _DRAWN_SIZE_IF_UNKNOWN_M


def _drawn_area_m2(actor: Row) -> float:
    return math.prod(_drawn_size_m(actor))


def _box_outline_m(actor: Row) -> Points:
    """Return the corners of a box in its own frame in metres, front left first, counter-clockwise; shape (4, 2)."""
    hl, hw = (side / 2 for side in _drawn_size_m(actor))
    return np.array([(hl, hw), (-hl, hw), (-hl, -hw), (hl, -hw)])


def box_corners_m(actor: Row) -> Points:
    """Return the corners of a box in map metres; shape (4, 2)."""
    yaw = actor["yaw_rad"] or 0.0
    c, s = math.cos(yaw), math.sin(yaw)
    turned: Points = _box_outline_m(actor) @ np.array([[c, s], [-s, c]]) + (actor["x_m"], actor["y_m"])
    return turned


def _role_of_actor(actor_id: str, ego: Row, object_ids: Collection[str]) -> str:
    return "ego" if actor_id == ego["actor_id"] else "met" if actor_id in object_ids else "other"


def actor_shapes(scenes: Iterable[Row]) -> list[dict[str, str]]:
    """Return each different shape of an actor in these scenes once: a box with a chevron, in the box's own frame."""
    actors = {_shape_name(actor): actor for scene in scenes for actor in scene["actors"]}
    return [_actor_shape(name, actor) for name, actor in sorted(actors.items())]


def _has_front(actor: Row) -> bool:
    return actor["yaw_rad"] is not None and actor["length_m"] is not None


def _actor_shape(name: str, actor: Row) -> dict[str, str]:
    hl, hw = (UNITS_PER_M * side / 2 for side in _drawn_size_m(actor))
    front = np.array([(0.5 * hl, 0.8 * hw), (0.82 * hl, 0.0), (0.5 * hl, -0.8 * hw)])
    return {
        "name": name,
        "box": polygon_path(UNITS_PER_M * _box_outline_m(actor)),
        "front": polyline_path(front) if _has_front(actor) else "",
    }


def _shape_name(actor: Row) -> str:
    length, width = _drawn_size_m(actor)
    return f"b{length * 100:.0f}x{width * 100:.0f}{'' if _has_front(actor) else 'n'}"


def _actor_drawing(actor: Row, kind: str, lanes: DrawnLanes, t_ns: int) -> dict[str, str]:
    """Return an actor's position, its path before and after the moment, and its positions at full seconds from the moment."""
    before, after, seconds = _paths_around_moment(actor["path"] or [], lanes, t_ns) if kind != "other" else ("", "", "")
    x, y = ((actor[axis] - zero) * UNITS_PER_M for axis, zero in zip(("x_m", "y_m"), lanes.origin, strict=True))
    return {
        "kind": kind,
        "actor": actor["actor_id"],
        "shape": _shape_name(actor),
        "place": f"translate({svg_number(x)},{svg_number(y)})rotate({math.degrees(actor['yaw_rad'] or 0.0):.1f})",
        "before": before,
        "after": after,
        "seconds": seconds,
    }


def _paths_around_moment(way: Sequence[Row], lanes: DrawnLanes, t_ns: int) -> tuple[str, str, str]:
    """Return the paths before and after a moment, and the points at full seconds from it; empty for a standing actor."""
    xy = lanes.to_drawn_units(np.array([(p["x_m"], p["y_m"]) for p in way])) if way else np.empty((0, 2))
    if not len(xy) or np.ptp(xy, axis=0).sum() < UNITS_PER_M:
        return "", "", ""
    t = np.array([p["t_ns"] for p in way])
    xy = np.rint(xy)
    # at each full second from the moment, take the first point within 0.1 s
    whole = np.round((t - t_ns) / 1e9).astype(int)
    near = (np.abs(t - t_ns - whole * 1_000_000_000) <= 100_000_000) & (whole != 0)
    picked = {int(whole[i]): i for i in np.flatnonzero(near)[::-1]}
    dots = "".join(f"M{svg_number(xy[i, 0])},{svg_number(xy[i, 1])}h0" for _, i in sorted(picked.items()))
    return polyline_path(xy[t <= t_ns]), polyline_path(xy[t >= t_ns]), dots


def _least_distance_labels_and_lines(
    ego: Row, met: Sequence[Row], view: _View
) -> tuple[list[dict[str, str]], list[str], list[str]]:
    """Return labels, lines and words of the least distances from the ego's box to the boxes of `met`."""
    texts, lines, words = [], [], []
    for actor in met:
        a, b = box_corners_m(ego), box_corners_m(actor)
        nearest = shapely.get_coordinates(shapely.shortest_line(shapely.polygons(a), shapely.polygons(b)))
        far = float(np.hypot(*(nearest[1] - nearest[0])))
        if far < _TOUCHING_DISTANCE_M:
            common = float(shapely.area(shapely.intersection(shapely.polygons(a), shapely.polygons(b))))
            words.append("the boxes overlap" if common > _TOUCHING_DISTANCE_M else "the boxes touch")
            continue
        words.append(f"{far:.2f} m from box to box" + (f" with {actor['actor_id']}" if len(met) > 1 else ""))
        p, q = view(nearest)
        middle = (p + q) / 2
        text = f"{far:.1f} m" if far >= 10 else f"{far:.2f} m"
        lines.append(polyline_path(np.array([p, q])))
        if np.hypot(*(q - p)) > 60:
            texts.append({"x": svg_number(middle[0]), "y": svg_number(middle[1] - 6), "text": text, "kind": "gap"})
        else:  # the line is too short for a label: place the label outside the boxes, with a leader line
            top = float(min(view(a)[:, 1].min(), view(b)[:, 1].min()))
            y = top - 26 if top > 44 else float(max(view(a)[:, 1].max(), view(b)[:, 1].max())) + 34
            lines.append(polyline_path(np.array([middle, (middle[0], y + (4 if y < middle[1] else -12))])))
            texts.append({"x": svg_number(middle[0]), "y": svg_number(y), "text": text, "kind": "gap"})
    return texts, lines, words


def _actors_with_label(actors: list[Row], ego: Row, met: Sequence[Row]) -> list[Row]:
    """Return the actors whose names the picture shows: all, or if ids are long, `ego`, `met` and the nearest other actors."""
    if all(len(actor["actor_id"]) <= MOST_LABEL_CHARS for actor in actors):
        return actors
    concerned = [actor for actor in actors if actor is ego or actor in met]
    other_actors = [actor for actor in actors if actor is not ego and actor not in met]
    near = sorted(other_actors, key=lambda a: (math.hypot(a["x_m"] - ego["x_m"], a["y_m"] - ego["y_m"]), a["actor_id"]))
    return [*concerned, *near[:_MOST_OTHER_ACTORS_NAMED_IF_IDS_ARE_LONG]]


def _name_label(actor: Row, ego: Row, met: Sequence[Row], view: _View) -> dict[str, str]:
    """Return an actor's name and its position, on the side of its box that faces away from the other actor."""
    box = view(box_corners_m(actor))
    middle = box.mean(axis=0)
    partner = met[0] if actor is ego and met else ego
    lower = middle[1] - view(box_corners_m(partner)).mean(axis=0)[1]
    below = actor is not partner and (lower > 1 or (abs(lower) <= 1 and actor is not ego))
    y = box[:, 1].max() + 14 if below else box[:, 1].min() - 6
    return {
        "x": svg_number(min(max(float(middle[0]), 22.0), WIDTH - 22.0)),
        "y": svg_number(min(max(float(y), 12.0), view.height - 4.0)),
        "text": ego_name(brief_id(actor["actor_id"])) if actor is ego else brief_id(actor["actor_id"]),
        "kind": "ego" if actor is ego else "met" if actor in met else "other",
        "actor": actor["actor_id"],
    }
