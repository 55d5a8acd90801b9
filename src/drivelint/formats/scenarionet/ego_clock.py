"""Corrects the times of the ego's positions, in a data set that counts the messages of a stream instead of timing them.

The messages have a fixed period, and every n-th message is a step. If a message was lost, its step takes longer than stated, and the ego
seems to jump: if every fifth message of 50 Hz is a step, a lost message makes the step 0.12 s long instead of 0.1 s, and the speed over it
seems a fifth too high. Such steps get their true duration. At the end of the drive, where messages run short, the ego's last places are
those of the annotated frames, as for all other actors: they show the difference between the clocks of the stream and of the frames.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from drivelint.arrays import Floats, Mask

_LEAST_MOVING_SPEED_MPS: Final = 2.0
"""Below this speed, the ego moves by less than 4 cm per message, so that noise of 2 cm hides a lost message."""
_MEDIAN_STEPS_PER_SIDE: Final = 4
"""A step is compared with this number of steps on each side."""
_LOST_MESSAGE_COUNT_TOLERANCE: Final = 0.4
"""A step over lost messages is longer by a whole number of messages, give or take this share of a message."""
_MOST_LOST_MESSAGES_PER_STEP: Final = 10
"""A step that would span more lost messages is not taken for one."""
_SHORT_STEP_SHARE: Final = 0.8
"""A step that advances by less than this share of the usual step is the seam between the stream and the frames."""
_EXAMINED_LAST_STEPS: Final = 20
"""The seam lies within this number of steps from the end: the stream lacks no more steps than messages were lost."""
_MOST_CLOCK_SHIFT_S: Final = 0.5


class EgoTrack(NamedTuple):
    """The ego's places (T, 2) and headings (T,) at the steps, NaN where the stream has none.

    `lost_messages`: the number of missing messages. `shift_s`: how long after the frames the stream begins; NaN: not known.
    """

    place: Floats
    heading: Floats
    lost_messages: int
    shift_s: float


def track_at_steps(place: Floats, heading: Floats, t_s: Floats, message_period_s: float) -> EgoTrack:
    """Return the ego's track at the steps `t_s` (T,), from places (T, 2) and headings (T,) that are counted messages.

    Between two messages, 0.1 s apart, the track is interpolated linearly: at 5 m/s2, the error is 6 mm.
    """
    n, period = len(t_s), np.diff(t_s)
    way = np.hypot(*np.diff(place, axis=0).T)
    if n < 2 * _MEDIAN_STEPS_PER_SIDE + 2 or not np.isfinite(way).all() or not (period > 0.0).all():
        return EgoTrack(place, heading, 0, np.nan)
    usual = _usual_speed(way / period)
    moving = usual > _LEAST_MOVING_SPEED_MPS
    longer = np.where(moving, way / np.maximum(usual * period, 1e-9) - 1.0, 0.0) * period / message_period_s
    whole = np.round(longer)
    n_lost = np.where(
        (whole >= 1)
        & (whole <= _MOST_LOST_MESSAGES_PER_STEP)
        & (np.abs(longer - whole) < _LOST_MESSAGE_COUNT_TOLERANCE),
        whole,
        0.0,
    )
    seam = _first_step_after_message_stream(place, usual * period, moving)
    n_lost[seam - 1 :] = 0.0
    stream = t_s[0] + np.r_[0.0, np.cumsum(period + message_period_s * n_lost)][:seam]
    shift = t_s[seam] - _time_nearest_to_point(place[seam], place[:seam], stream) if seam < n else np.nan
    shift = shift if abs(shift) <= _MOST_CLOCK_SHIFT_S else np.nan
    if not n_lost.any() and np.isnan(shift):
        return EgoTrack(place, heading, 0, np.nan)
    stream += np.nan_to_num(shift)
    inside = (t_s >= stream[0] - 1e-9) & (t_s <= stream[-1] + 1e-9)
    columns = [*place[:seam].T, np.unwrap(heading[:seam])]
    timed = np.column_stack([np.where(inside, np.interp(t_s, stream, column), np.nan) for column in columns])
    later = (t_s > stream[-1]) & (np.arange(n) >= seam)  # the stream has ended, the frames go on
    timed[later] = np.column_stack([place, heading])[later]
    return EgoTrack(timed[:, :2], timed[:, 2], int(n_lost.sum()), float(shift))


def _usual_speed(speed: Floats) -> Floats:
    """Return for each speed the median of this speed and its neighbours."""
    padded = np.pad(speed, _MEDIAN_STEPS_PER_SIDE, mode="reflect")
    return np.asarray(
        np.median(np.lib.stride_tricks.sliding_window_view(padded, 2 * _MEDIAN_STEPS_PER_SIDE + 1), axis=1),
        np.float64,
    )


def _first_step_after_message_stream(place: Floats, usual_step_m: Floats, moving: Mask) -> int:
    """Return the first step (1 ... T - 1) that is not from the stream; T if all are from it."""
    n = len(place)
    step = np.diff(place, axis=0)
    ahead = step[:-1] / np.maximum(np.hypot(*step[:-1].T), 1e-9)[:, None]
    short = (step[1:] * ahead).sum(axis=1) < _SHORT_STEP_SHARE * usual_step_m[1:]
    starts = np.flatnonzero(short & moving[1:]) + 2
    starts = starts[starts > n - 1 - _EXAMINED_LAST_STEPS]
    return int(starts[0]) if len(starts) else n


def _time_nearest_to_point(point: Floats, place: Floats, t_s: Floats) -> float:
    """Return when a track, in its last steps, is nearest to a point; beyond its end, the track is extended by a straight line."""
    first = max(0, len(place) - _EXAMINED_LAST_STEPS)
    a, b = place[first:-1], place[first + 1 :]
    way = b - a
    share = ((point - a) * way).sum(axis=1) / np.maximum((way * way).sum(axis=1), 1e-12)
    share = np.r_[np.clip(share[:-1], 0.0, 1.0), np.maximum(share[-1:], 0.0)]
    near = int(np.argmin(np.hypot(*(a + share[:, None] * way - point).T)))
    t0, t1 = t_s[first + near], t_s[first + near + 1]
    return float(t0 + share[near] * (t1 - t0))
