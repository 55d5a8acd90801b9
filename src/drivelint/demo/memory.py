"""A scene as what ingest makes of its log and its map, without files: for tests and for whoever wants tables at once."""

from __future__ import annotations

from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from drivelint.batch import Drive
from drivelint.demo.osi_log import HOST_ID, mcap
from drivelint.ingest.files import Identity
from drivelint.ingest.finish import finish
from drivelint.ingest.trace import BRAKE_LIGHTS, CLASSES, INDICATORS, IngestOptions, Recording, States
from drivelint.maps import MapSource, load_map

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from drivelint.demo.motion import Track
    from drivelint.demo.scene import Scene


def drive(scene: Scene) -> Drive:
    """Return the scene as a drive: its tables with the names and ids that its MCAP would give, and its map."""
    tracks = scene.tracks
    n = len(tracks[0].t_s)
    content = sha256(mcap(scene)).hexdigest()
    columns = {
        "x_m": [np.round(t.x, 4) for t in tracks],
        "y_m": [np.round(t.y, 4) for t in tracks],
        "z_m": [np.full(n, t.actor.body.height_m / 2) for t in tracks],
        "yaw_rad": [np.round(t.yaw, 6) for t in tracks],
        "vx_mps": [np.round(t.speed * np.cos(t.yaw), 4) for t in tracks],
        "vy_mps": [np.round(t.speed * np.sin(t.yaw), 4) for t in tracks],
        "length_m": [np.full(n, t.actor.body.length_m) for t in tracks],
        "width_m": [np.full(n, t.actor.body.width_m) for t in tracks],
        "height_m": [np.full(n, t.actor.body.height_m) for t in tracks],
    }
    codes = {
        "actor_class": [np.full(n, CLASSES.index(t.actor.body.kind), np.int8) for t in tracks],
        "indicator": [_codes(t, t.light, INDICATORS) for t in tracks],
        "brake_light": [_codes(t, np.where(t.brakes, "on", "off"), BRAKE_LIGHTS) for t in tracks],
    }
    states = States(
        [str(k) for k in range(HOST_ID, HOST_ID + len(tracks))],
        np.repeat(np.arange(len(tracks), dtype=np.int32), n),
        np.tile(np.round(tracks[0].t_s * 1e9).astype(np.int64), len(tracks)),
        {name: np.concatenate(values).astype(np.float64) for name, values in columns.items()},
        {name: np.concatenate(values).astype(np.int8) for name, values in codes.items()},
        np.zeros(n * len(tracks), np.bool_),
    )
    path = Path(f"{scene.name}.mcap")
    trace = finish(
        path,
        Identity(f"{scene.name}-{content[:8]}", path.name, content),
        Recording("osi-mcap", states, ego_ids=[str(HOST_ID)]),
        IngestOptions(),
    )
    return Drive(trace, load_map(MapSource(f"{scene.map_name}.xodr", scene.map_text.encode())))


def _codes(track: Track, said: NDArray[np.str_], words: tuple[str, ...]) -> NDArray[np.int8]:
    """Return the codes of light words; nobody on foot has lights."""
    codes = np.full(said.shape, -1, np.int8)
    if track.actor.body.kind != "pedestrian":
        for code, word in enumerate(words):
            codes[said == word] = code
    return codes
