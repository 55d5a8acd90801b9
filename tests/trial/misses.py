"""Looks for contacts and near contacts of moving egos by itself: which of them does no stable rule fail?"""

from __future__ import annotations

import numpy as np

from .lots import MOVED_M, Result
from .recording import Track, apart, recording

NEAR_M = 0.3
JUDGES = ("ukhc.no-collision", "criticality.near-contact")
RELATIVE_MPS = 2.0
STEP_MPS = 3.0
"""Speeds that the positions give and that the recording gives differ by less, and the length of a sound track is longer."""
SOUND_S = 1.0


def unnoticed(result: Result) -> list[str]:
    """Return a line for each near contact at speed, between two sound tracks, of which nothing is said within a second.

    The line says whether a rule of `JUDGES` is unknown, or passes as a near miss, or says nothing: MISSED.
    """
    tracks = recording(result.folder).tracks
    egos = [row["ego_id"] for row in result.rows("SELECT DISTINCT ego_id FROM {verdicts} ORDER BY 1")]
    found = result.rows("SELECT ego_id, object_id, rule_id, t_start_s - 1 AS t0, t_end_s + 1 AS t1 FROM {findings}")
    statements = {"unknown": "verdict = 'unknown'", "near miss": "near_miss"}
    pairs = {
        statement: {
            (row["ego_id"], row["object_id"])
            for row in result.rows(
                f"SELECT DISTINCT ego_id, object_id FROM {{verdicts}} WHERE rule_id IN {JUDGES} AND {condition}"
            )
        }
        for statement, condition in statements.items()
    }
    lines = []
    for ego_id in egos:
        ego = tracks.get(ego_id)
        if ego is None or ego.extent_m() < MOVED_M or not ego.sized:
            continue
        for name, other in tracks.items():
            near = None if other is ego or not other.sized else _near(ego, other)
            if near is None:
                continue
            t, distance, relative = near
            rules = sorted(
                {
                    row["rule_id"]
                    for row in found
                    if row["ego_id"] == ego_id and row["object_id"] == name and row["t0"] <= t <= row["t1"]
                }
            )
            if not rules:
                pair = {(ego_id, name), (ego_id, None)}
                says = next((statement for statement, known in pairs.items() if pair & known), "MISSED")
                lines.append(
                    f"{says}: {result.log}: {t:.1f} s, ego {ego_id} and {other.actor_class} {name}: {distance:.2f} m, {relative:.1f} m/s"
                )
    return lines


def _near(ego: Track, other_track: Track) -> tuple[float, float, float] | None:
    """Return time, distance and relative speed of the nearest sound moment of a near contact; None: there is none."""
    reach = (ego.length + other_track.length) / 2 + NEAR_M
    if min(len(ego.t), len(other_track.t)) < 3 or min(np.ptp(ego.t), np.ptp(other_track.t)) < SOUND_S:
        return None
    if (ego.x.min() > other_track.x.max() + reach) or (other_track.x.min() > ego.x.max() + reach):
        return None
    t, distance, _, _ = apart(ego, other_track)
    i, j = (np.clip(np.searchsorted(track.t, t - 0.06), 0, len(track.t) - 1) for track in (ego, other_track))
    velocity = [
        np.stack([np.gradient(track.x, track.t), np.gradient(track.y, track.t)], axis=1)[k]
        for track, k in ((ego, i), (other_track, j))
    ]
    relative = np.hypot(*(velocity[0] - velocity[1]).T)
    sound = np.ones(len(t), dtype=bool)
    for track, k in ((ego, i), (other_track, j)):
        sound &= ~(np.abs(track.derived_speed()[k] - track.speed[k]) > STEP_MPS)
    moments = np.flatnonzero(sound & (distance < NEAR_M) & (relative > RELATIVE_MPS))
    if not len(moments):
        return None
    best = moments[np.argmin(distance[moments])]
    return float(t[best]), float(distance[best]), float(relative[best])
