"""Markers of findings and near misses: the boxes of ego and object and a label, at every step near the event.

Each message is complete: it removes earlier drawings, so that a viewer that jumps to a time shows the right state.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from drivelint.annotate import draw
from drivelint.annotate.draw import Colour
from drivelint.annotate.result_messages import Message, headline
from drivelint.formats.foxglove import messages as foxglove
from drivelint.result.counts import SEVERITIES

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    import pyarrow as pa

    from drivelint.annotate.clock import LogClock
    from drivelint.annotate.tracks import Tracks
    from drivelint.arrays import Floats, Times

FAIL_COLOUR = Colour(0.90, 0.16, 0.16)
NEAR_MISS_COLOUR = Colour(1.00, 0.62, 0.05)
MAX_MARKER_STEPS_PER_DRIVE: Final = 5_000
"""The most steps of findings that are drawn per drive; if there are more, only every second, third ... step."""
DRAW_BEFORE_NEAR_MISS_NS: Final = 1_000_000_000  # a short event is drawn longer, so that a person sees it
LEAST_DRAW_AFTER_EVENT_NS: Final = 2_000_000_000
LABEL_OFFSET_FROM_EGO_M: Final = (
    9.0  # beside the ego: the role label is above it, and viewers that follow the ego show both
)
MAX_LABEL_LINES: Final = 5
_LENGTH_OR_WIDTH_IF_UNKNOWN_M: Final = 1.0


class Box(NamedTuple):
    """A box at one time; length and width may be NaN."""

    x: float
    y: float
    z: float
    yaw: float
    length: float
    width: float


class Marker(NamedTuple):
    """One finding or near miss, and when it is drawn (ns, the trace's clock)."""

    ego_id: str
    object_id: str | None
    start_ns: int
    end_ns: int
    colour: Colour
    text: str


class MarkerAtStep(NamedTuple):
    """A marker (`marker`) at one step, with the boxes of ego and object; None: the box is unknown, or there is no object."""

    marker: Marker
    ego: Box | None
    object: Box | None


def markers(verdicts: pa.Table, findings: pa.Table, sense_by_rule: Mapping[str, str]) -> list[Marker]:
    """Return markers: first of findings by severity, during their failing steps; then of near misses, around their worst step."""
    spans = [
        (row, FAIL_COLOUR, row["t_start_ns"], max(row["t_end_ns"], row["t_start_ns"] + LEAST_DRAW_AFTER_EVENT_NS))
        for row in sorted(findings.to_pylist(), key=lambda row: SEVERITIES.index(row["severity"]))
    ]
    spans += [
        (row, NEAR_MISS_COLOUR, t - DRAW_BEFORE_NEAR_MISS_NS, t + LEAST_DRAW_AFTER_EVENT_NS)
        for row in verdicts.filter(verdicts["near_miss"]).to_pylist()
        if (t := row["t_ref_ns"] if row["t_worst_ns"] is None else row["t_worst_ns"]) is not None
    ]
    return [
        Marker(row["ego_id"], row["object_id"], start, end, colour, headline(row, sense_by_rule))
        for row, colour, start, end in spans
    ]


def messages(drawn_markers: Sequence[Marker], tracks: Tracks, clock: LogClock) -> list[Message]:
    """Return the SceneUpdates of all markers (`drawn_markers`): one for every step of a marker, and an empty one after each marker."""
    steps = [_marker_steps_and_next_step(tracks, window) for window in drawn_markers]
    every = max(1, -(-sum(len(times) for times, _ in steps) // MAX_MARKER_STEPS_PER_DRIVE))
    frames_at: dict[int, list[MarkerAtStep]] = {}
    for window, (times, behind) in zip(drawn_markers, steps, strict=True):
        thinned = times[::every]
        ego_boxes = _boxes_of_actor(tracks, window.ego_id, thinned)
        object_boxes = _boxes_of_actor(tracks, window.object_id, thinned)
        for k, t in enumerate(thinned.tolist()):
            frames_at.setdefault(t, []).append(MarkerAtStep(window, ego_boxes[k], object_boxes[k]))
        if behind is not None:
            frames_at.setdefault(behind, [])
    out = []
    for t, frames in sorted(frames_at.items()):
        time = clock.log_time_at(t)
        out.append(Message(time, draw.deletion_of_all(time) + b"".join(_entities_at_step(frames, time))))
    return out


def _marker_steps_and_next_step(tracks: Tracks, marker: Marker) -> tuple[Times, int | None]:
    """Return the ego's steps in the time range of a marker, and the next step after it."""
    times = tracks.times(marker.ego_id)
    first, end = (int(i) for i in np.searchsorted(times, [marker.start_ns, marker.end_ns + 1]))
    return times[first:end], int(times[end]) if end < len(times) else None


def _boxes_of_actor(tracks: Tracks, name: str | None, times: Times) -> list[Box | None]:
    """Return an actor's box at each time; None if its position or heading is unknown."""
    if name is None:
        return [None] * len(times)
    p = tracks.poses_at(name, times)
    z = np.nan_to_num(p.z)
    is_known = np.isfinite(p.x) & np.isfinite(p.y) & np.isfinite(p.yaw)
    columns = (p.x.tolist(), p.y.tolist(), z.tolist(), p.yaw.tolist(), is_known.tolist())
    return [Box(*row[:4], p.length, p.width) if row[4] else None for row in zip(*columns, strict=True)]


def _entities_at_step(step_markers: list[MarkerAtStep], time: int) -> Iterator[bytes]:
    """Yield the entities at one step: each pair of ego and object once, in the colour of its worst marker, and a label per ego."""
    pairs: dict[tuple[str, str | None], MarkerAtStep] = {}
    egos: dict[str, list[MarkerAtStep]] = {}
    for frame in step_markers:
        pairs.setdefault((frame.marker.ego_id, frame.marker.object_id), frame)
        egos.setdefault(frame.marker.ego_id, []).append(frame)
    for (ego, object_id), frame in sorted(pairs.items(), key=lambda item: (item[0][0], item[0][1] or "")):
        yield draw.entity(ego if object_id is None else f"{ego} and {object_id}", time, _pair_outlines(frame))
    for ego, ego_frames in sorted(egos.items()):
        if (box := ego_frames[0].ego) is not None:
            more = [f"and {len(ego_frames) - MAX_LABEL_LINES} more"] if len(ego_frames) > MAX_LABEL_LINES else []
            text = "\n".join([*(step_marker.marker.text for step_marker in ego_frames[:MAX_LABEL_LINES]), *more])
            label = draw.label(box.x, box.y + LABEL_OFFSET_FROM_EGO_M, box.z + 2.0, text, ego_frames[0].marker.colour)
            yield draw.entity(f"notes on {ego}", time, label)


def _pair_outlines(step_marker: MarkerAtStep) -> bytes:
    """Return the outlines of both boxes and the line between them."""
    boxes = [box for box in (step_marker.ego, step_marker.object) if box is not None]
    parts = [
        draw.line(box_corners(box), step_marker.marker.colour, thickness=3.0, line_type=foxglove.LINE_LOOP)
        for box in boxes
    ]
    if len(boxes) == 2:
        ends = np.array([box[:3] for box in boxes])
        parts.append(draw.line(ends, step_marker.marker.colour, thickness=2.0, line_type=foxglove.LINE_STRIP))
    return b"".join(parts)


def box_corners(box: Box) -> Floats:
    """Return the four corners of a box at its middle height."""
    length, width = (v if np.isfinite(v) else _LENGTH_OR_WIDTH_IF_UNKNOWN_M for v in (box.length, box.width))
    along, across = np.array([1, 1, -1, -1]) * length / 2, np.array([1, -1, -1, 1]) * width / 2
    c, s = np.cos(box.yaw), np.sin(box.yaw)
    return np.stack([box.x + c * along - s * across, box.y + s * along + c * across, np.full(4, box.z)], axis=1)
