"""Reads filmed drives: the detections in each frame, placed on the straight road that the mapping assumes.

Distances ahead are from bumper to bumper along the road. An actor that is not detected in a frame is present without a place, if it was
detected before and is detected later. Otherwise it is absent: only the range of the detector is known.

Places are box centres: half a length behind the front bumper.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.drive.trace import (
    ACTOR_CLASSES,
    ASSUMED_MOTION_CHECK,
    ASSUMED_SIZE_CHECK,
    QualityFinding,
    Recording,
    States,
)
from drivelint.errors import TraceError, UsageError
from drivelint.formats.film import boxes
from drivelint.formats.film import mapping as video_mapping
from drivelint.formats.film.boxes import DistancesAhead
from drivelint.formats.tables.mapping import TextLayout
from drivelint.formats.tables.sheets import CsvSheet, ParquetSheet, describe_places

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from drivelint.arrays import Floats, Times
    from drivelint.formats.film.mapping import DetectedActor, EgoCar, OvertakeStages, VideoMapping
    from drivelint.formats.probe import Probe

formats: Final[dict[str, tuple[str, str]]] = {}
takes_mapping: Final = True
PULL_OUT_START_OVER_LINE_M: Final = 0.06
"""How far a corner of the ego is over the centre line in the first frame of pulling out: just over 0.05 m, which counts as over it."""
LAST_PULL_OUT_FRAME_DISTANCE_TO_OFFSET_M: Final = 0.11
"""How far the ego is from its offset of passing in the last frame of pulling out: just over 0.1 m, which does not count as settled."""
FRAME_NUMBER_LIMIT: Final = 10_000_000
"""46 hours at 60 frames a second: this or a larger number is not a frame number."""
ROAD_EXTENSION_M: Final = 400.0
"""How far the road extends beyond the ego's path, at each end."""


def _matching_mapping(path: Path) -> str | None:
    """Return the shipped mapping that judges every frame and whose columns the table has; None if no mapping fits."""
    try:
        names = CsvSheet(path, TextLayout()).names
    except TraceError:
        return None
    for name in video_mapping.shipped_mappings():
        _, film = video_mapping.load(name)
        if film.frames.every == 1 and set(_needed_columns(film)) <= set(names):
            return name
    return None


def accepts(probe: Probe) -> bool:
    """Return whether the given mapping is for films or, without a mapping, whether a table has the columns of a shipped one."""
    if probe.path.is_dir():
        return False
    if probe.options.mapping is not None:
        return video_mapping.is_video_mapping(probe.options.mapping)
    begins = probe.head[:16].lstrip(b"\xef\xbb\xbf").startswith(b"frame")
    return begins and _matching_mapping(probe.path) is not None


def read(probe: Probe) -> Recording:
    """Read detections (a table, or boxes in MCAP) through a mapping. Errors: `TraceError`, `UsageError`."""
    path = probe.path
    stem, film = video_mapping.load(probe.options.mapping or _matching_mapping(path) or "")
    findings: list[QualityFinding] = []
    if probe.head.startswith(b"\x89MCAP"):
        detections = boxes.read(path, film)
    else:
        detections = _distances_in_table(path, stem, film, findings, is_parquet=probe.head.startswith(b"PAR1"))
    is_used = detections.frames % film.frames.every == 0
    frames = detections.frames[is_used]
    if not len(frames):
        raise TraceError(f"{path}: no frame is in the range of the mapping {stem!r}: see its [frames]")
    t_ns = np.rint((film.frames.start_s + frames / film.frames.rate_hz) * 1e9).astype(np.int64)
    states, egos_x = _states_and_ego_x_range(film, frames, t_ns, [ahead[is_used] for ahead in detections.ahead_m])
    assumed = "speeds, lanes and the ego's path across them"
    message = (
        f"mapping {stem!r} assumes {assumed}; only distances ahead are measured: all other rules judge assumed values"
    )
    findings.append(QualityFinding(ASSUMED_MOTION_CHECK, "warning", message))
    findings.append(QualityFinding(ASSUMED_SIZE_CHECK, "info", f"size from the mapping {stem!r}, not recorded"))
    recording = Recording(stem, states, ego_ids=[film.ego.id], findings=findings)
    recording.embedded_map = _assumed_road_xml(film, egos_x)
    recording.sensor_range_m = film.sensor_range_m
    recording.notes = [f"read through the mapping {stem!r}: {assumed} are assumed"]
    return recording


def _needed_columns(film: VideoMapping) -> list[str]:
    return [film.frames.column, *(actor.ahead for actor in film.actor if actor.ahead is not None)]


def _distances_in_table(
    path: Path, name: str, film: VideoMapping, findings: list[QualityFinding], *, is_parquet: bool
) -> DistancesAhead:
    sheet = ParquetSheet(path) if is_parquet else CsvSheet(path, TextLayout(null_values=film.frames.not_detected))
    columns = _needed_columns(film)
    if lacking := [column for column in columns if column not in sheet.names]:
        raise TraceError(
            f"{path}: no column {lacking[0]!r}, which mapping {name!r} needs: it has {', '.join(sheet.names)}"
        )
    if unsaid := [actor.id for actor in film.actor if actor.ahead is None]:
        raise UsageError(f"mapping {name!r}: actor {unsaid[0]} has no 'ahead', the column with its distance")
    sheet.load(columns)
    number, bad = sheet.numbers_and_bad(film.frames.column)
    bad |= ~(np.abs(number) < FRAME_NUMBER_LIMIT) | (number != np.floor(number))
    rows = np.flatnonzero(~bad)
    frames, first = np.unique(number[rows].astype(np.int64), return_index=True)
    if not len(frames):
        raise TraceError(f"{path}: column {film.frames.column!r} has no frame numbers")
    whole = np.arange(frames[0], frames[-1] + 1)
    at = np.searchsorted(whole, frames)
    ahead = []
    for actor in film.actor:
        values, odd = sheet.numbers_and_bad(str(actor.ahead))
        odd &= ~bad
        if odd.any():
            where = sheet.describe_rows(np.flatnonzero(odd))
            message = f"{path.name}, {where}: column {actor.ahead!r} is not a number: the actor is present, but its position is not known"
            findings.append(QualityFinding("malformed_cell", "warning", message, int(odd.sum())))
        distance = np.full(len(whole), np.nan)
        distance[at] = np.where(odd, np.inf, values)[rows[first]]
        ahead.append(distance)
    bad_lines = sheet.bad_lines
    if bad_lines or bad.any():
        n = len(bad_lines) + int(bad.sum())
        where = (
            describe_places("line", bad_lines, len(bad_lines))
            if bad_lines
            else sheet.describe_rows(np.flatnonzero(bad))
        )
        message = (
            f"{path.name}, {where}: the number of cells differs from the {len(sheet.names)} cells of the header: "
            "no actor has a position in these frames"
        )
        findings.append(QualityFinding("malformed_row", "warning", message, n))
    return DistancesAhead(whole, ahead)


def _states_and_ego_x_range(
    film: VideoMapping, frames: NDArray[np.int64], t_ns: Times, ahead: list[Floats]
) -> tuple[States, tuple[float, float]]:
    """Return the states of all actors, and where the ego's path begins and ends along the road (x)."""
    side_sign = 1.0 if film.road.driven_on == "left" else -1.0  # 1: the ego's lane is left of the centre line
    middle = side_sign * film.road.lane_width / 2
    ego_x = film.ego.speed.mps * (t_ns - t_ns[0]) / 1e9
    ego_y = np.full(len(frames), middle)
    if film.stages is not None:
        ego_y = -side_sign * _ego_beyond_centre_line_m(film, film.stages, frames)
    front = ego_x + film.ego.length / 2
    tracks = [(t_ns, ego_x, ego_y, 0.0, film.ego.speed.mps)]
    for actor, distance in zip(film.actor, ahead, strict=True):
        with_distance = np.flatnonzero(~np.isnan(distance))  # infinite: an actor is there, but its place is not known
        there = slice(with_distance[0], with_distance[-1] + 1) if len(with_distance) else slice(0, 0)
        along = actor.lane == "own"
        x = (front + np.where(np.isfinite(distance), distance, np.nan) + actor.length / 2)[there]
        y = np.where(np.isfinite(x), middle if along else -middle, np.nan)
        yaw, mps = (0.0, actor.speed.mps) if along else (np.pi, -actor.speed.mps)
        tracks.append((t_ns[there], x, y, yaw, mps))
    actor_index = np.repeat(np.arange(len(tracks), dtype=np.int32), [len(track[0]) for track in tracks])
    times, x, y = (np.concatenate([track[k] for track in tracks]) for k in range(3))
    actors: list[EgoCar | DetectedActor] = [film.ego, *film.actor]
    # if an actor has no place, nothing else is known
    motions = {
        "yaw_rad": [track[3] for track in tracks],
        "vx_mps": [track[4] for track in tracks],
        "vy_mps": [0.0] * len(tracks),
    }
    numbers = {"x_m": x, "y_m": y}
    numbers |= {
        name: np.where(np.isfinite(x), np.array(values)[actor_index], np.nan) for name, values in motions.items()
    }
    numbers["length_m"] = np.array([actor.length for actor in actors])[actor_index]
    numbers["width_m"] = np.array([actor.width for actor in actors])[actor_index]
    kinds = ["car", *(actor.kind for actor in film.actor)]
    codes = {"actor_class": np.array([ACTOR_CLASSES.index(kind) for kind in kinds], np.int8)[actor_index]}
    states = States(
        [actor.id for actor in actors], actor_index, times, numbers, codes, np.zeros(len(actor_index), np.bool_)
    )
    return states, (float(ego_x[0]), float(ego_x[-1]))


def _ego_beyond_centre_line_m(film: VideoMapping, stages: OvertakeStages, frames: NDArray[np.int64]) -> Floats:
    """Return how far beyond the centre line the ego's middle is in each frame, so that the stages begin in the frames of the mapping.

    The path is linear from touching the line to just before the offset of passing, then constant, then linear from the first frame of the
    abort to the middle of the lane.
    """
    home = -film.road.lane_width / 2
    touching = PULL_OUT_START_OVER_LINE_M - film.ego.width / 2
    pulling = frames[(frames >= stages.pulling_out) & (frames < stages.passing)]
    leaving = frames[frames >= stages.abort]
    points: list[tuple[float, float]] = []
    if len(pulling):
        if pulling[0] > frames[0]:
            points.append((float(pulling[0] - 1), min(home, touching - 2 * PULL_OUT_START_OVER_LINE_M)))
        points += [
            (float(pulling[0]), touching),
            (float(pulling[-1]), max(touching, stages.offset - LAST_PULL_OUT_FRAME_DISTANCE_TO_OFFSET_M)),
        ]
    points.append((float(stages.passing), stages.offset))
    if len(leaving):
        points += [(float(leaving[0]), stages.offset), (float(max(stages.back, leaving[0] + 1)), home)]
    at = np.array([point[0] for point in points])
    values = np.array([point[1] for point in points])
    return np.asarray(np.interp(frames.astype(np.float64), at, values), np.float64)


def _assumed_road_xml(film: VideoMapping, ego_x_range: tuple[float, float]) -> bytes:
    """Return the assumed road as OpenDRIVE: straight, with one lane each way; the ego drives along the reference line."""
    start, length = ego_x_range[0] - ROAD_EXTENSION_M, ego_x_range[1] - ego_x_range[0] + 2 * ROAD_EXTENSION_M
    lane = (
        '<lane id="{}" type="driving" level="false"><link/><width sOffset="0" a="{}" b="0" c="0" d="0"/>'
        '<roadMark sOffset="0" type="solid" weight="standard" color="white" width="0.12" laneChange="none"/></lane>'
    )
    left, right = (lane.format(number, repr(film.road.lane_width)) for number in (1, -1))
    rule = "LHT" if film.road.driven_on == "left" else "RHT"
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n<OpenDRIVE>'
        '<header revMajor="1" revMinor="7" name="assumed straight road" version="1.00"/>'
        f'<road name="assumed" length="{length!r}" id="1" junction="-1" rule="{rule}">'
        f'<planView><geometry s="0" x="{start!r}" y="0" hdg="0" length="{length!r}"><line/></geometry></planView>'
        f'<lanes><laneSection s="0"><left>{left}</left>'
        '<center><lane id="0" type="none" level="false">'
        '<roadMark sOffset="0" type="broken" weight="standard" color="white" width="0.12" laneChange="both"/></lane></center>'
        f"<right>{right}</right></laneSection></lanes></road></OpenDRIVE>\n"
    ).encode()
