"""The danger spaces in an overtake, as they were judged: along the lanes, as wide as the vehicle, as long as its safe distance."""

from __future__ import annotations

import math
from functools import cache, partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import pyarrow.compute as pc

from drivelint.annotate import draw
from drivelint.annotate.draw import Colour
from drivelint.annotate.result_messages import Message
from drivelint.arrays import floats
from drivelint.formats.foxglove import messages as foxglove
from drivelint.result.counts import group_rows

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import pyarrow as pa

    from drivelint.annotate.clock import LogClock
    from drivelint.annotate.tracks import ActorPoses, Tracks
    from drivelint.arrays import Floats, Times

FREE_COLOUR = Colour(0.20, 0.70, 0.35)
ENTERED_COLOUR = Colour(0.90, 0.16, 0.16)
OVERLAP_COLOUR = Colour(1.00, 0.62, 0.05)
ROLE_COLOUR = Colour(0.95, 0.95, 0.95)
MAX_DRAWN_STEPS: Final = 5_000
_POINTS_PER_EDGE: Final = 24
_HEIGHT_ABOVE_LANE_M: Final = 0.1  # above the lanes
_LABEL_HEIGHT_M: Final = 1.5
_LEAST_DRAWN_SPACE_LENGTH_M: Final = 0.1
"""Shorter spaces are not drawn."""


def messages(spaces: pa.Table, chains: pa.Table, tracks: Tracks, clock: LogClock) -> list[Message]:
    """Return a SceneUpdate for every step of an overtake, and an empty one after its last step.

    `spaces`: the danger spaces. `chains`: the centre lines of the lane chains along which they lie, by station.
    """
    rows = spaces.to_pylist()
    every = max(1, -(-len(rows) // MAX_DRAWN_STEPS))
    by_time = group_rows(rows[::every], lambda row: int(row["t_ns"]))
    for ego in sorted({row["ego_id"] for row in rows}):
        for t in _steps_after_drawn_steps(
            tracks.times(ego), np.array([r["t_ns"] for r in rows if r["ego_id"] == ego], np.int64)
        ):
            by_time.setdefault(t, [])
    line_of = cache(partial(_centre_line, chains))
    times = np.unique(np.array([row["t_ns"] for row in rows], np.int64))
    step = {t: k for k, t in enumerate(times.tolist())}
    names = {name for row in rows for name in (row["ego_id"], row["ov_id"], *row["vbp_ids"]) if name is not None}
    poses = {name: tracks.poses_at(name, times) for name in names}
    out = []
    for t, space_rows in sorted(by_time.items()):
        time = clock.log_time_at(t)
        entities = [
            draw.entity(
                f"overtake of {row['ego_id']}",
                time,
                _danger_space_shapes(row, line_of) + _role_labels(row, poses, step[t]),
            )
            for row in space_rows
        ]
        out.append(Message(time, draw.deletion_of_all(time) + b"".join(entities)))
    return out


def _steps_after_drawn_steps(times: Times, drawn_times: Times) -> list[int]:
    """Return the ego's steps that follow a drawn step and are not drawn."""
    after = np.searchsorted(times, drawn_times, side="right")
    return [int(t) for t in np.setdiff1d(times[after[after < len(times)]], drawn_times)]


def _centre_line(chains: pa.Table, ego: str, chain: int) -> Floats:
    """Return a chain's centre line by station: station, x, y, z, and its direction as x and y."""
    rows = chains.filter(pc.and_(pc.equal(chains["ego_id"], ego), pc.equal(chains["chain_id"], chain)))
    columns = [floats(rows[name]) for name in ("s_m", "x_m", "y_m", "z_m", "tx", "ty")]
    return np.nan_to_num(np.stack(columns)[:, np.argsort(columns[0], kind="stable")])


def _left_and_right_edges_of_strip(
    line: Floats, start_m: float, end_m: float, offset_m: float, half_width_m: float
) -> tuple[Floats, Floats] | None:
    """Return the left and right edge of a strip around the lateral offset `offset_m`; None if the chain has no such stations."""
    if not line.shape[1]:
        return None
    start_m, end_m = max(start_m, line[0, 0]), min(end_m, line[0, -1])
    if end_m - start_m < _LEAST_DRAWN_SPACE_LENGTH_M:
        return None
    s = np.linspace(start_m, end_m, _POINTS_PER_EDGE)
    x, y, z, tx, ty = (np.interp(s, line[0], column) for column in line[1:])
    left, right = (
        np.stack([x - ty * off, y + tx * off, z + _HEIGHT_ABOVE_LANE_M], axis=1)
        for off in (offset_m + half_width_m, offset_m - half_width_m)
    )
    return left, right


def _role_labels(row: dict[str, Any], poses: Mapping[str, ActorPoses], step: int) -> bytes:
    """Return the roles of the actors at one step, the k-th of `poses`, as texts above the boxes with known positions."""
    roles = [(row["ego_id"], "ego: " + row["stage"].replace("_", " ")), *((name, "VBP") for name in row["vbp_ids"])]
    if row["ov_id"] is not None:
        roles.append((row["ov_id"], "OV"))
    parts = []
    for name, role in roles:
        x, y, z = (float(column[step]) for column in poses[name][:3])
        if math.isfinite(x) and math.isfinite(y):
            parts.append(draw.label(x, y, (z if math.isfinite(z) else 0.0) + _LABEL_HEIGHT_M, role, ROLE_COLOUR))
    return b"".join(parts)


def _danger_space_shapes(row: dict[str, Any], line_of: Callable[[str, int], Floats]) -> bytes:
    """Return the danger spaces of the ego and the oncoming vehicle (OV) at one step."""
    ego_space = row["s_m"], row["d_m"], row["half_m"], row["sd_av_m"]
    oncoming_space = row["ov_s_m"], row["ov_d_m"], row["ov_half_m"], row["sd_ov_m"]
    parts = []
    for (s, d, half, sd), direction, met in ((ego_space, 1, row["av_met"]), (oncoming_space, -1, row["ov_met"])):
        if None not in (row["chain_id"], s, d, half, sd):
            start, end = sorted((s, s + direction * sd))
            if strip := _left_and_right_edges_of_strip(line_of(row["ego_id"], row["chain_id"]), start, end, d, half):
                left, right = strip
                colour = ENTERED_COLOUR if met else OVERLAP_COLOUR if row["overlap"] else FREE_COLOUR
                around = np.concatenate([left, right[::-1]])
                parts.append(draw.ribbon(left, right, colour.with_opacity(0.3)))
                parts.append(draw.line(around, colour, thickness=2.0, line_type=foxglove.LINE_LOOP))
    return b"".join(parts)
