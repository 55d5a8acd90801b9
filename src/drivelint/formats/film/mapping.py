"""Mappings of filmed drives: which values of a frame are distances ahead, and the assumptions about all other values.

A film contains no positions. The drive is placed on a straight road with one lane each way: the ego moves along it at its
assumed speed, and a detected actor is placed at its measured distance ahead, in the middle of its lane.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated, Any, Final, Literal

import msgspec

from drivelint.errors import UsageError
from drivelint.formats.tables.mapping import UNITS, read_toml
from drivelint.phrases import hint
from drivelint.toml_text import parse_toml

MAPPINGS_FOLDER: Final = Path(__file__).parent / "mappings"
Metres = Annotated[float, msgspec.Meta(gt=0.0, lt=1000.0)]


class Speed(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A speed, in any unit of the mappings for tables."""

    value: Annotated[float, msgspec.Meta(ge=0.0)]
    unit: str = "m/s"

    @property
    def mps(self) -> float:
        """The speed in m/s."""
        return self.value * UNITS["speed"][self.unit]


class FrameTiming(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """How frames are counted: the column with their number (in a table), their rate, and the time of frame 0.

    `every` n: only frames 0, n, 2n, ... are judged. `not_detected`: the words for an actor that is not detected.
    """

    rate_hz: Annotated[float, msgspec.Meta(gt=0.0)]
    column: str = "frame"
    start_s: float = 0.0
    every: Annotated[int, msgspec.Meta(ge=1)] = 1
    not_detected: list[str] = []


class RoadShape(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """The assumed road."""

    driven_on: Literal["left", "right"]
    lane_width: Metres = 3.5


class EgoCar(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """The vehicle with the camera. The camera is assumed to be at the front end."""

    speed: Speed
    id: str = "ego"
    length: Metres = 4.5
    width: Metres = 1.8


class OvertakeStages(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """The first frames of the stages of an aborted overtake, and how far beyond the centre line the ego's middle gets (metres)."""

    pulling_out: int
    passing: int
    abort: int
    back: int
    offset: float = 0.0


class DetectedActor(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A detected actor: the column with its distance ahead (in a table), or the id of its box (in an MCAP); and its assumed size."""

    id: str
    lane: Literal["own", "opposing"]
    speed: Speed
    ahead: str | None = None
    box: str | None = None
    length: Metres = 4.5
    width: Metres = 1.8
    kind: Literal["car", "van", "truck", "bus", "motorcycle", "vehicle"] = "car"


class Camera(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A monocular camera: distance ahead = focal_px * real width / width in the picture (pixels)."""

    focal_px: Annotated[float, msgspec.Meta(gt=0.0)]


class VideoMapping(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A mapping of a filmed drive; without `stages` the ego stays in the middle of its lane."""

    description: str
    frames: FrameTiming
    road: RoadShape
    ego: EgoCar
    actor: list[DetectedActor]
    stages: OvertakeStages | None = None
    camera: Camera | None = None
    sensor_range_m: Metres | None = None


# made at import, because logs are read in several threads: see drivelint.formats.tables.mapping
DECODER = msgspec.json.Decoder(VideoMapping)


def shipped_mappings() -> list[str]:
    """Return the names of the video mappings that come with drivelint."""
    return sorted(file.stem for file in MAPPINGS_FOLDER.glob("*.toml"))


def is_video_mapping(name: str) -> bool:
    """Return whether a mapping, given as a file or as a shipped name, is for filmed drives."""
    if name in shipped_mappings():
        return True
    if not os.path.isfile(name):  # noqa: PTH113 - no error for a name that is too long
        return False
    try:
        raw = parse_toml(Path(name).read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return False  # reading it as another mapping reports the problem
    return "frames" in raw or raw.get("extends") in shipped_mappings()


def load(name: str) -> tuple[str, VideoMapping]:
    """Return the name of a mapping and the mapping. `name`: the path of a TOML file, or the name of a shipped mapping.

    Errors: `UsageError`, which names the file and the invalid key.
    """
    path = Path(name) if os.path.isfile(name) else MAPPINGS_FOLDER / f"{name}.toml"  # noqa: PTH113 - as above
    raw = read_toml(path)
    if "extends" in raw:
        base = raw.pop("extends")
        if base not in shipped_mappings():
            raise UsageError(f"mapping {path}: extends {base!r}: {hint(str(base), shipped_mappings())}")
        raw = _merge_tables(read_toml(MAPPINGS_FOLDER / f"{base}.toml"), raw)
    try:
        film = msgspec.convert(raw, VideoMapping)
    except msgspec.ValidationError as error:
        raise UsageError(f"mapping {path}: {error}") from error
    _validate(path, film)
    return path.stem, film


def _merge_tables(base: dict[str, Any], override: dict[str, Any]) -> dict[str, Any]:
    """Return `base` with the changes of `override`; tables are merged, lists replaced."""
    common = {
        key: _merge_tables(base[key], value) if isinstance(value, dict) and isinstance(base.get(key), dict) else value
        for key, value in override.items()
    }
    return {**base, **common}


def _validate(path: Path, film: VideoMapping) -> None:
    for speed in (film.ego.speed, *(actor.speed for actor in film.actor)):
        if speed.unit not in UNITS["speed"]:
            raise UsageError(f"mapping {path}: unknown unit {speed.unit!r}: use {', '.join(UNITS['speed'])}")
    ids = [film.ego.id, *(actor.id for actor in film.actor)]
    if len(set(ids)) < len(ids):
        raise UsageError(f"mapping {path}: two actors have one id: {', '.join(ids)}")
    stages = film.stages
    if stages is not None and not stages.pulling_out < stages.passing < stages.abort < stages.back:
        raise UsageError(f"mapping {path}: stages: pulling_out, passing, abort and back must come in this order")
