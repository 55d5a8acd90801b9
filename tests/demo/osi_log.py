"""Writes a scene as ASAM OSI ground truth in MCAP, as a simulator would: chunked, compressed, with checksums, no clock."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Final

import numpy as np
from mcap.writer import CompressionType, Writer

from drivelint.drive.trace import ACTOR_CLASSES, BRAKE_LIGHTS, INDICATORS, SIZE_COLUMNS, STATE_COLUMNS, States
from drivelint.formats.osi.encode import encode_ground_truths, moving_objects
from drivelint.formats.osi.schema import GROUND_TRUTH, WRITTEN_OSI_VERSION, descriptor_set
from tests.demo.opendrive import GENERATOR

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from tests.demo.motion import Track
    from tests.demo.scene import Scene

    Floats = NDArray[np.float64]

TOPIC: Final = "ground_truth"
HOST_ID: Final = 1
"""The ego; the other actors are numbered on from it."""
_DECIMALS: Final = {"yaw_rad": 6}  # of all others four: no machine's last bit shall show in a file
_NUMBERS: Final[dict[str, Callable[[Track], Floats | float]]] = {
    "x_m": lambda track: track.x,
    "y_m": lambda track: track.y,
    "z_m": lambda track: track.ground + track.actor.body.height_m / 2,
    "yaw_rad": lambda track: track.yaw,
    "vx_mps": lambda track: track.speed * np.cos(track.yaw),
    "vy_mps": lambda track: track.speed * np.sin(track.yaw),
    "length_m": lambda track: track.actor.body.length_m,
    "width_m": lambda track: track.actor.body.width_m,
    "height_m": lambda track: track.actor.body.height_m,
}


def osi_mcap(scene: Scene) -> bytes:
    """Return the scene's log: one `osi3.GroundTruth` per sample, log time = sample time, the same bytes every time."""
    sink = io.BytesIO()
    writer = Writer(sink, compression=CompressionType.ZSTD, enable_crcs=True, enable_data_crcs=True)
    writer.start(library=GENERATOR)
    version = ".".join(map(str, WRITTEN_OSI_VERSION))
    schema = writer.register_schema(GROUND_TRUTH, "protobuf", descriptor_set())
    channel = writer.register_channel(TOPIC, "protobuf", schema, {"net.asam.osi.trace.channel.osi_version": version})
    bounds = dict.fromkeys(("version", "min_osi_version", "max_osi_version"), version)
    writer.add_metadata("net.asam.osi.trace", {**bounds, "description": scene.shows})
    for t_ns, message in _frames(scene):
        writer.add_message(channel, t_ns, message, t_ns)
    writer.finish()  # type: ignore[no-untyped-call]
    return sink.getvalue()


def _frames(scene: Scene) -> Iterator[tuple[int, bytes]]:
    """Yield time and message of every sample."""
    said = states(scene)
    actors, n = len(said.ids), len(said) // len(said.ids)
    by_frame = (np.arange(n)[:, None] + n * np.arange(actors)).ravel()
    unknown = np.full(len(said), np.nan)
    objects = moving_objects(
        said.actor[by_frame].astype(np.uint64) + np.uint64(HOST_ID),
        {name: said.numbers.get(name, unknown)[by_frame] for name in (*STATE_COLUMNS, *SIZE_COLUMNS)},
        {name: codes[by_frame] for name, codes in said.codes.items()},
        log_has_heights=True,
    )
    messages = encode_ground_truths(said.t_ns[:n], HOST_ID, objects, np.arange(n + 1) * actors)
    yield from zip(said.t_ns[:n].tolist(), messages.to_pylist(), strict=True)


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


def _lights(track: Track, light_words: NDArray[np.str_], words: tuple[str, ...]) -> NDArray[np.int8]:
    """Return the codes of light words; nobody on foot has lights."""
    codes = np.full(light_words.shape, -1, np.int8)
    if track.actor.body.kind != "pedestrian":
        for code, word in enumerate(words):
            codes[light_words == word] = code
    return codes
