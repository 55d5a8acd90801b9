"""The plan view of the moment: the scene of a finding's worst step, moved to another moment of the drive."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from drivelint.arrays import floats
from drivelint.incident.case import PARTY_LETTERS
from drivelint.incident.parties import other_actor_texts
from drivelint.report.html.plan_view import actor_shapes, plan_view
from drivelint.report.html.road import DrawnMaps
from drivelint.result.text import seconds

if TYPE_CHECKING:
    import pyarrow as pa

    from drivelint.incident.case import Case
    from drivelint.result.text import Row

_DANGER_SPACE_TAG: Final = "danger_space"
_LABEL_HEIGHT_SHARE_OF_PLAN_VIEW: Final = 0.135
"""Size of the plan view's labels as a share of its height; at the least height (`sheet.css`) they are 8 pt or more."""

_LONGEST_TIME_TO_SAMPLE_NS: Final = 500_000_000
"""An actor is drawn only if one of its samples is at most this far away in time."""


def scene_at(scene: Row, actor_states: pa.Table, t_ns: int) -> Row:
    """Return a row of `scene` with its actors at their positions at `t_ns`, without actors that are not recorded around that time.

    `actor_states`: the drive's rows of `actor_state`. Positions between two samples are interpolated linearly.
    """
    if scene["t_ns"] == t_ns:
        return scene
    actor_ids, times = actor_states["actor_id"].to_numpy(zero_copy_only=False), actor_states["t_ns"].to_numpy()
    columns = {name: floats(actor_states[name]) for name in ("x_m", "y_m", "yaw_rad", "vx_mps", "vy_mps")}
    actors: list[dict[str, Any]] = []
    for actor in scene["actors"]:
        samples = np.flatnonzero(
            (actor_ids == actor["actor_id"]) & np.isfinite(columns["x_m"]) & np.isfinite(columns["y_m"])
        )
        samples = samples[np.argsort(times[samples], kind="stable")]
        t = times[samples]
        if not len(t) or not t[0] <= t_ns <= t[-1] or np.abs(t - t_ns).min() > _LONGEST_TIME_TO_SAMPLE_NS:
            continue
        nearest = samples[np.abs(t - t_ns).argmin()]
        yaw, speed = columns["yaw_rad"][nearest], np.hypot(columns["vx_mps"][nearest], columns["vy_mps"][nearest])
        actors.append(
            {
                **actor,
                **{name: float(np.interp(t_ns, t, columns[name][samples])) for name in ("x_m", "y_m")},
                "yaw_rad": float(yaw) if np.isfinite(yaw) else actor["yaw_rad"],
                "speed_mps": float(speed) if np.isfinite(speed) else None,
            }
        )
    return {**scene, "t_ns": t_ns, "actors": actors}


def plan_view_at_moment(case: Case) -> dict[str, Any]:
    """Return the plan view of the moment, with its lanes and shapes; `plan` is None if the result has no scene of the worst step."""
    finding = case.finding
    at = (finding.row["drive_id"], finding.row["ego_id"], finding.row["t_worst_ns"])
    scene, *_ = [*_rows_at_moment(case.result.scenes, at), None]
    drawn_at = seconds(finding.moment_ns, finding.drive_start_ns)
    if scene is None:
        return {"plan": None, "tiles": [], "shapes": [], "drawn": [], "drawn_at": drawn_at}
    drawn_scene = scene_at(scene, case.drive.trace.tables["actor_state"], finding.moment_ns)
    road = DrawnMaps(case.result.lanes)
    spaces = _rows_at_moment(case.result.spaces, at) if _DANGER_SPACE_TAG in finding.rule["tags"] else []
    plan = plan_view(drawn_scene, road, set(finding.parties[1:]), spaces)
    tiles = [tile for tile in road.tiles() if tile["name"] in plan["tiles"]]
    actor_texts = other_actor_texts(plan, drawn_scene)
    letters = dict(zip(finding.parties, PARTY_LETTERS, strict=False))
    plan["texts"] = [{**text, "text": letters.get(text.get("actor"), text["text"])} for text in plan["texts"]]
    plan["font"] = f"{_LABEL_HEIGHT_SHARE_OF_PLAN_VIEW * float(plan['height']):.1f}"
    return {
        "plan": plan,
        "tiles": tiles,
        "shapes": actor_shapes([drawn_scene]),
        "drawn": actor_texts,
        "drawn_at": drawn_at,
    }


def _rows_at_moment(table: pa.Table, drive_ego_and_time: tuple[str, str, int]) -> list[dict[str, Any]]:
    """Return the rows of a table at one moment of an ego; `drive_ego_and_time`: drive, ego and time."""
    return [row for row in table.to_pylist() if (row["drive_id"], row["ego_id"], row["t_ns"]) == drive_ego_and_time]
