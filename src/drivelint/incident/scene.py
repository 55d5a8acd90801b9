"""Moves the scene of a finding's worst step to another moment of the drive."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from drivelint.arrays import floats

if TYPE_CHECKING:
    import pyarrow as pa

    from drivelint.result.text import Row


_NEAR_NS: Final = 500_000_000
"""An actor is drawn only if one of its samples is at most this far away in time."""


def scene_at(scene: Row, states: pa.Table, t_ns: int) -> Row:
    """Return a row of `scene` with its actors at their positions at `t_ns`, without actors that are not recorded around that time.

    `states`: the drive's rows of `actor_state`. Positions between two samples are interpolated linearly.
    """
    if scene["t_ns"] == t_ns:
        return scene
    who, times = states["actor_id"].to_numpy(zero_copy_only=False), states["t_ns"].to_numpy()
    columns = {name: floats(states[name]) for name in ("x_m", "y_m", "yaw_rad", "vx_mps", "vy_mps")}
    actors: list[dict[str, Any]] = []
    for actor in scene["actors"]:
        mine = np.flatnonzero((who == actor["actor_id"]) & np.isfinite(columns["x_m"]) & np.isfinite(columns["y_m"]))
        mine = mine[np.argsort(times[mine], kind="stable")]
        t = times[mine]
        if not len(t) or not t[0] <= t_ns <= t[-1] or np.abs(t - t_ns).min() > _NEAR_NS:
            continue
        nearest = mine[np.abs(t - t_ns).argmin()]
        yaw, speed = columns["yaw_rad"][nearest], np.hypot(columns["vx_mps"][nearest], columns["vy_mps"][nearest])
        actors.append(
            {
                **actor,
                **{name: float(np.interp(t_ns, t, columns[name][mine])) for name in ("x_m", "y_m")},
                "yaw_rad": float(yaw) if np.isfinite(yaw) else actor["yaw_rad"],
                "speed_mps": float(speed) if np.isfinite(speed) else None,
            }
        )
    return {**scene, "t_ns": t_ns, "actors": actors}
