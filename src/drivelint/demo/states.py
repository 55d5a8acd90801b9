"""A scene's samples as the columns that ingest hands on: what its log says, and what its tables hold."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.drive.trace import ACTOR_CLASSES, BRAKE_LIGHTS, INDICATORS, States

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from drivelint.demo.motion import Track
    from drivelint.demo.scene import Scene

    Floats = NDArray[np.float64]

HOST_ID: Final = 1
"""The ego; the other actors are numbered on from it."""
_DECIMALS: Final = {"yaw_rad": 6}  # of all others four: no machine's last bit shall show in a file
_NUMBERS: Final[dict[str, Callable[[Track], Floats | float]]] = {
    "x_m": lambda track: track.x,
    "y_m": lambda track: track.y,
    "z_m": lambda track: track.actor.body.height_m / 2,
    "yaw_rad": lambda track: track.yaw,
    "vx_mps": lambda track: track.speed * np.cos(track.yaw),
    "vy_mps": lambda track: track.speed * np.sin(track.yaw),
    "length_m": lambda track: track.actor.body.length_m,
    "width_m": lambda track: track.actor.body.width_m,
    "height_m": lambda track: track.actor.body.height_m,
}


def states(scene: Scene) -> States:
    """Return the samples of all actors, actor by actor, each in order of time."""
    tracks = scene.tracks
    n = len(tracks[0].t_s)
    codes = {
        "actor_class": [np.full(n, ACTOR_CLASSES.index(track.actor.body.kind), np.int8) for track in tracks],
        "indicator": [_lights(track, track.light, INDICATORS) for track in tracks],
        "brake_light": [_lights(track, np.where(track.brakes, "on", "off"), BRAKE_LIGHTS) for track in tracks],
    }
    return States(
        [str(number) for number in range(HOST_ID, HOST_ID + len(tracks))],
        np.repeat(np.arange(len(tracks), dtype=np.int32), n),
        np.tile(np.round(tracks[0].t_s * 1e9).astype(np.int64), len(tracks)),
        {name: np.concatenate([_number(name, track) for track in tracks]) for name in _NUMBERS},
        {name: np.concatenate(parts) for name, parts in codes.items()},
        np.zeros(n * len(tracks), np.bool_),
    )


def _number(name: str, track: Track) -> Floats:
    values = np.broadcast_to(np.asarray(_NUMBERS[name](track), np.float64), track.t_s.shape)
    return np.round(values, _DECIMALS.get(name, 4)) + 0.0  # no sign on zero


def _lights(track: Track, said: NDArray[np.str_], words: tuple[str, ...]) -> NDArray[np.int8]:
    """Return the codes of light words; nobody on foot has lights."""
    codes = np.full(said.shape, -1, np.int8)
    if track.actor.body.kind != "pedestrian":
        for code, word in enumerate(words):
            codes[said == word] = code
    return codes
