"""Drains sources, and compares what is read of a window with what is read of the same span of the whole log."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from tests.formats.logs import read, states

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from drivelint.watch.source import Frame, Source


def drained(source: Source, most_s: float = 10.0) -> list[Frame]:
    """Return all frames of a source that ends."""
    found: list[Frame] = []
    until = time.monotonic() + most_s
    while (frames := source.read(0.2)) is not None:
        found += frames
        assert time.monotonic() < until, "the source does not end"
    return found


def times(frames: Sequence[Frame]) -> list[int]:
    return [frame.t_ns for frame in frames]


def rows_of(path: Path, since_ns: int, until_ns: int, **options: Any) -> list[dict[str, Any]]:
    """Return the actor states of a span, without the drive's id."""
    rows = states(read(path, **options))
    return [
        {name: value for name, value in row.items() if name != "drive_id"}
        for row in rows
        if since_ns <= row["t_ns"] <= until_ns
    ]


def assert_window_is_span(source: Source, frames: Sequence[Frame], path: Path, span: slice, **options: Any) -> None:
    """Write the frames of a span as a window, and assert that it has the states of that span of the recording."""
    window = path / f"window-{span.start}{source.recording.suffix}"
    source.write_window(frames[span], window)
    own = [row["t_ns"] for row in states(read(window, **options)) if row["t_ns"] >= 0]
    step = [row["t_ns"] for row in states(read(source.recording, **options))]
    chosen = times(frames[span])
    shift = min(step) - min(frame.t_ns for frame in frames)  # the states' clock may not be the frames'
    since, until = min(chosen) + shift, max(chosen) + shift
    whole = rows_of(source.recording, since, until, **options)
    assert own
    assert whole
    assert rows_of(window, since, until, **options) == whole
