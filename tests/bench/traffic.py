"""Traffic for the benchmarks: a two-way ring road driven on the left, cars both ways, and an ego that overtakes parked cars.

Shapes follow the reference drive: 10 min, 20 Hz, 50 actors (12,000 frames, 600,000 states); a short drive is 20 s, 10 Hz, 20 actors.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from tests.formats.osi import osi_log

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

STRAIGHT, RADIUS, LANE = 600.0, 150.0, 3.5
LAP = 2 * STRAIGHT + 2 * math.pi * RADIUS
PARKED = (150.0, 450.0, STRAIGHT + math.pi * RADIUS + 300.0)  # stations of the cars parked in the ego's lane


class Shape(NamedTuple):
    """Seconds, samples a second and actors of a drive."""

    seconds: float
    hertz: int
    actors: int


REFERENCE = Shape(600.0, 20, 50)
SHORT = Shape(20.0, 10, 20)


def ring() -> str:
    """Return the road as OpenDRIVE: two straights, two bends, one lane each way."""
    bend = math.pi * RADIUS
    pieces = [
        (0.0, 0.0, 0.0, 0.0, STRAIGHT, 0.0),
        (STRAIGHT, STRAIGHT, 0.0, 0.0, bend, 1 / RADIUS),
        (STRAIGHT + bend, STRAIGHT, 2 * RADIUS, math.pi, STRAIGHT, 0.0),
        (2 * STRAIGHT + bend, 0.0, 2 * RADIUS, math.pi, bend, 1 / RADIUS),
    ]
    plan = ""
    for s, x, y, heading, length, curvature in pieces:
        shape = f'<arc curvature="{curvature}"/>' if curvature else "<line/>"
        plan += f'<geometry s="{s}" x="{x}" y="{y}" hdg="{heading}" length="{length}">{shape}</geometry>'
    ends = 'elementType="road" elementId="1" contactPoint='
    link = f'<link><predecessor {ends}"end"/><successor {ends}"start"/></link>'
    lane = (
        '<lane id="{0}" type="{1}" level="false"><link><predecessor id="{0}"/><successor id="{0}"/></link>'
        '<width sOffset="0" a="{2}" b="0" c="0" d="0"/></lane>'
    )
    mark = '<roadMark sOffset="0" type="broken" weight="standard" color="white" width="0.12" laneChange="both"/>'
    return (
        '<?xml version="1.0"?><OpenDRIVE><header revMajor="1" revMinor="6" name="ring"/>'
        f'<road name="ring" length="{LAP}" id="1" junction="-1" rule="LHT">{link}'
        f'<type s="0" type="rural"><speed max="60" unit="mph"/></type><planView>{plan}</planView><lanes><laneSection s="0">'
        f"<left>{lane.format(2, 'sidewalk', 2.0)}{lane.format(1, 'driving', LANE)}</left>"
        f'<center><lane id="0" type="none" level="false">{mark}</lane></center>'
        f"<right>{lane.format(-1, 'driving', LANE)}{lane.format(-2, 'sidewalk', 2.0)}</right>"
        "</laneSection></lanes></road></OpenDRIVE>"
    )


def place(s: Floats, d: Floats) -> tuple[Floats, Floats, Floats]:
    """Return x, y and heading of the reference line at station s, moved d to the left."""
    s = np.mod(s, LAP)
    bend = math.pi * RADIUS
    first, second, third = s < STRAIGHT, s < STRAIGHT + bend, s < 2 * STRAIGHT + bend
    u1, u3 = (s - STRAIGHT) / RADIUS, (s - 2 * STRAIGHT - bend) / RADIUS
    x = np.select(
        [first, second, third], [s, STRAIGHT + RADIUS * np.sin(u1), 2 * STRAIGHT + bend - s], -RADIUS * np.sin(u3)
    )
    y = np.select(
        [first, second, third], [0 * s, RADIUS * (1 - np.cos(u1)), 2 * RADIUS + 0 * s], RADIUS * (1 + np.cos(u3))
    )
    heading = np.select([first, second, third], [0 * s, u1, math.pi + 0 * s], math.pi + u3)
    return x - d * np.sin(heading), y + d * np.cos(heading), heading


def _step(u: Floats) -> Floats:
    u = np.clip(u, 0.0, 1.0)
    return u * u * (3 - 2 * u)


def drive(shape: Shape, seed: int = 0) -> tuple[pa.Table, pa.Table]:
    """Return `actor_state` and `actor` of a drive: actor 0 is the ego; the seed moves everybody along the road."""
    t = np.arange(round(shape.seconds * shape.hertz)) / shape.hertz
    start = (seed * 97.0) % LAP
    states: list[dict[str, Floats]] = []
    for n in range(shape.actors):
        if n == 0:
            s = start + 60.0 + 12.0 * t
            away = np.abs(np.mod(s[:, None] - np.array(PARKED)[None, :] + LAP / 2, LAP) - LAP / 2)
            d = LANE / 2 - LANE * np.max(_step((55.0 - away) / 30.0), axis=1)
            sign = 1.0
        elif n <= len(PARKED):
            s, d, sign = PARKED[n - 1] + 0 * t, LANE / 2 + 0.3 + 0 * t, 1.0
        elif n % 2:
            s, d, sign = start + LAP * n / shape.actors - 11.0 * t, -LANE / 2 + 0 * t, -1.0
        else:
            s, d, sign = start + 90.0 + LAP * n / (shape.actors + 2) + 12.0 * t, LANE / 2 + 0 * t, 1.0
        x, y, heading = place(s, d)
        vx, vy = np.gradient(x, t), np.gradient(y, t)
        yaw = np.where(np.hypot(vx, vy) > 0.1, np.arctan2(vy, vx), heading if sign > 0 else heading + math.pi)
        states.append({"x_m": x, "y_m": y, "z_m": 0.75 + 0 * t, "yaw_rad": yaw, "vx_mps": vx, "vy_mps": vy})
    ids = [str(n) for n in range(shape.actors)]
    rows = pa.table(
        {
            "actor_id": pa.array(np.repeat(ids, len(t))),
            "t_ns": pa.array(np.tile(np.round(t * 1e9).astype(np.int64), shape.actors)),
            **{key: np.concatenate([state[key] for state in states]) for key in states[0]},
            "indicator": pa.array(["off"] * (len(t) * shape.actors)),
        }
    )
    size = {"length_m": 4.8, "width_m": 1.8, "height_m": 1.5}
    actors = pa.table(
        {
            "actor_id": ids,
            "actor_class": ["car"] * shape.actors,
            **{key: [value] * shape.actors for key, value in size.items()},
            "is_ego": [n == 0 for n in range(shape.actors)],
        }
    )
    return rows, actors


def write_folder(folder: Path, shape: Shape, seed: int = 0) -> Path:
    """Write a drive as a canonical Parquet folder."""
    folder.mkdir(parents=True, exist_ok=True)
    rows, actors = drive(shape, seed)
    pq.write_table(rows, folder / "actor_state.parquet")
    pq.write_table(actors, folder / "actor.parquet")
    return folder


def write_osi(path: Path, shape: Shape, seed: int = 0) -> Path:
    """Write a drive as ASAM OSI GroundTruth in MCAP."""
    rows, _ = drive(shape, seed)
    frames = rows.num_rows // shape.actors
    column = {
        key: rows[key].to_numpy().reshape(shape.actors, frames)
        for key in ("x_m", "y_m", "yaw_rad", "vx_mps", "vy_mps", "t_ns")
    }
    # not every reader can do without accelerations
    ax, ay = (np.gradient(column[key], axis=1) * shape.hertz for key in ("vx_mps", "vy_mps"))
    messages = []
    for i in range(frames):
        truth = osi_log.frame(int(column["t_ns"][0, i]))
        for n in range(shape.actors):
            velocity = (float(column["vx_mps"][n, i]), float(column["vy_mps"][n, i]))
            osi_log.moving(
                truth,
                n,
                float(column["x_m"][n, i]),
                float(column["y_m"][n, i]),
                yaw=float(column["yaw_rad"][n, i]),
                v=velocity,
                a=(float(ax[n, i]), float(ay[n, i])),
                indicator=2,
                brake=2,
            )
        messages.append(
            osi_log.Out("osi3.GroundTruth", "ground_truth", int(column["t_ns"][0, i]), truth.SerializeToString())
        )
    return osi_log.write(path, messages)
