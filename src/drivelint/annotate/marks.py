"""What a finding, a near miss or an overtake stands on, drawn at every step at which it is of interest.

Each message is complete: it takes away what was drawn before, so that a viewer that jumps to a time shows what holds there.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from drivelint.annotate import draw, foxglove
from drivelint.annotate.draw import Colour
from drivelint.annotate.events import Message, headline

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from drivelint.annotate.clock import LogClock
    from drivelint.annotate.evidence import Evidence
    from drivelint.annotate.tracks import Places, Tracks

FAIL = Colour(0.90, 0.16, 0.16)
NEAR_MISS = Colour(1.00, 0.62, 0.05)
STEPS: Final = 5_000
"""So many steps of findings are drawn per drive; of longer ones every second, third ... step."""
BEFORE_NS: Final = 1_000_000_000  # a near miss is one moment: a person needs a little more than that to see it
AFTER_NS: Final = 2_000_000_000
_LINES: Final = 5
_UNKNOWN_SIZE: Final = 1.0


class Window(NamedTuple):
    """One finding or near miss, and when it is drawn (ns, the trace's clock)."""

    ego_id: str
    object_id: str | None
    start_ns: int
    end_ns: int
    colour: Colour
    text: str


def windows(evidence: Evidence) -> list[Window]:
    """Return findings over their failing stretch and two seconds more, near misses around their worst step; fails first."""
    fails = [
        Window(row["ego_id"], row["object_id"], row["t_start_ns"], row["t_end_ns"] + AFTER_NS, FAIL, headline(row))
        for row in evidence.findings.to_pylist()
    ]
    near = [
        Window(row["ego_id"], row["object_id"], t - BEFORE_NS, t + AFTER_NS, NEAR_MISS, headline(row))
        for row in evidence.verdicts.filter(evidence.verdicts["near_miss"]).to_pylist()
        if (t := row["t_ref_ns"] if row["t_worst_ns"] is None else row["t_worst_ns"]) is not None
    ]
    return fails + near


def messages(evidence: Evidence, tracks: Tracks, clock: LogClock) -> list[Message]:
    """Return the SceneUpdates of all windows: one for every step in any of them, and an empty one behind each."""
    found = windows(evidence)
    steps = [_steps(tracks, window) for window in found]
    every = max(1, -(-sum(len(s) for s, _ in steps) // STEPS))
    drawn: dict[int, dict[tuple[str, str | None], list[tuple[int, int]]]] = defaultdict(dict)
    for number, (times, behind) in enumerate(steps):
        for k, t in enumerate(times[::every].tolist()):
            pair = (found[number].ego_id, found[number].object_id)
            drawn[t].setdefault(pair, []).append((number, k))
        if behind is not None:
            drawn.setdefault(behind, {})
    where = {(w.ego_id, w.object_id, n): _both(tracks, w, steps[n][0][::every]) for n, w in enumerate(found)}
    out = []
    for t, pairs in sorted(drawn.items()):
        time = clock.at(t)
        entities = [
            draw.entity(_name(pair), time, _pair([found[n] for n, _ in shown], *_at(where[*pair, shown[0][0]], shown[0][1])))
            for pair, shown in sorted(pairs.items(), key=lambda item: _name(item[0]))
        ]
        out.append(Message(time, draw.clear(time) + b"".join(entities)))
    return out


def _name(pair: tuple[str, str | None]) -> str:
    return pair[0] if pair[1] is None else f"{pair[0]} and {pair[1]}"


def _steps(tracks: Tracks, window: Window) -> tuple[NDArray[np.int64], int | None]:
    """Return the ego's steps in a window, and the one behind it."""
    times = tracks.times(window.ego_id)
    first, end = (int(i) for i in np.searchsorted(times, [window.start_ns, window.end_ns + 1]))
    return times[first:end], int(times[end]) if end < len(times) else None


def _both(tracks: Tracks, window: Window, times: NDArray[np.int64]) -> list[Places]:
    names = [window.ego_id, *([window.object_id] if window.object_id is not None else [])]
    return [tracks.places(name, times) for name in names]


def _at(places: list[Places], k: int) -> Iterator[tuple[float, ...] | None]:
    """Yield each box at step k, or None where it is not known."""
    for p in places:
        box = (float(p.x[k]), float(p.y[k]), float(np.nan_to_num(p.z[k])), float(p.yaw[k]), p.length, p.width, p.height)
        yield box if np.isfinite(box[:4]).all() else None


def _pair(shown: list[Window], ego: tuple[float, ...] | None, other: tuple[float, ...] | None = None) -> bytes:
    """Draw outlines of both boxes, the line between them, and what is said of them."""
    colour = shown[0].colour
    boxes = [box for box in (ego, other) if box is not None]
    parts = [draw.line(outline(box), colour, thickness=3.0, kind=foxglove.LINE_LOOP) for box in boxes]
    if len(boxes) == 2:
        ends = np.array([box[:3] for box in boxes])
        parts.append(draw.line(ends, colour, thickness=2.0, kind=foxglove.LINE_STRIP))
    if boxes:
        x, y, z = np.mean([box[:3] for box in boxes], axis=0)
        lines = [w.text for w in shown[:_LINES]] + ([f"and {len(shown) - _LINES} more"] if len(shown) > _LINES else [])
        parts.append(draw.label(float(x), float(y), float(z) + 3.0, "\n".join(lines), colour))
    return b"".join(parts)


def outline(box: tuple[float, ...]) -> NDArray[np.float64]:
    """Return the four corners of a box (x, y, z, yaw, length, width, ...) at its middle height."""
    x, y, z, yaw = box[:4]
    length, width = (v if np.isfinite(v) else _UNKNOWN_SIZE for v in box[4:6])
    along, across = np.array([1, 1, -1, -1]) * length / 2, np.array([1, -1, -1, 1]) * width / 2
    c, s = np.cos(yaw), np.sin(yaw)
    return np.stack([x + c * along - s * across, y + s * along + c * across, np.full(4, z)], axis=1)
