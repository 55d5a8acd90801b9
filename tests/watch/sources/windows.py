"""Drains sources, and compares what is read of a window with what is read of the same span of the whole log."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from drivelint.watch.source import WindowFileSource
from tests.formats.logs import read

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from drivelint.drive.trace import Trace
    from drivelint.watch.source import Frame, Source


def drained(source: Source, most_s: float = 10.0) -> list[Frame]:
    """Return all frames of a source that ends, and close it."""
    found: list[Frame] = []
    until = time.monotonic() + most_s
    while (frames := source.read(0.2)) is not None:
        found += frames
        assert time.monotonic() < until, "the source does not end"
    source.close()
    return found


def times(frames: Sequence[Frame]) -> list[int]:
    """Return the times of frames."""
    return [frame.t_ns for frame in frames]


def rows(trace: Trace, table: str, since_ns: int, until_ns: int) -> list[dict[str, Any]]:
    """Return the rows of a span, without the drive's id."""
    return [
        {name: value for name, value in row.items() if name != "drive_id"}
        for row in trace.tables[table].to_pylist()
        if since_ns <= row["t_ns"] <= until_ns
    ]


def assert_window_is_span(
    source: Source, frames: Sequence[Frame], folder: Path, span: slice, edge_ns: int = 0, **options: Any
) -> Trace:
    """Write the frames of a span as a window, assert that it says what the recording says of that span, and return it.

    The clock of the states must be that of the frames, or begin with them. `edge_ns`: so near to the ends of the window they may
    differ, where velocities are derived from the states on both sides, or poses need the transforms on both sides.
    """
    path = folder / f"window-{span.start}{source.recording.suffix}"
    assert isinstance(source, WindowFileSource)
    source.write_window(frames[span], path)
    window, whole = read(path, **options), read(source.recording, **options)
    begin = min(row["t_ns"] for row in whole.tables["actor_state"].to_pylist())
    chosen = [frame.t_ns + begin - frames[0].t_ns for frame in frames[span]]
    for table in ("actor_state", "signal_state"):
        inside = min(chosen) + edge_ns, max(chosen) - edge_ns
        expected = rows(whole, table, *inside)
        assert rows(window, table, *inside) == expected
        assert expected or table == "signal_state"
    assert window.embedded_map == whole.embedded_map
    assert (window.geo_reference, window.geo_offset, window.map_offset) == (
        whole.geo_reference,
        whole.geo_offset,
        whole.map_offset,
    )
    return window


def assert_windows_are_spans(source: Source, folder: Path, **options: Any) -> None:
    """Assert it of three windows of the drained source, the first one at its beginning."""
    frames = drained(source)
    third = len(frames) // 3
    for start in (0, third, third + third // 2):
        assert_window_is_span(source, frames, folder, slice(start, start + third), **options)
