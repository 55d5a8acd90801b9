"""Converts times of a drive to times of its log, and finds the frame that is nearest in time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.pictures.frames import FrameError

if TYPE_CHECKING:
    from drivelint.drive.trace import FrameTimes
    from drivelint.pictures.frames import FramePlace, FrameSource

FRAME_SEARCH_RADIUS_NS: Final = 2_000_000_000
"""Frames are searched up to this far from a time in the log: a frame may be recorded up to a second after it was taken."""
LONGEST_TIME_TO_FRAME_NS: Final = 500_000_000
"""The greatest difference between the requested time and the time of a frame."""
_SAME_CLOCK_TOLERANCE_NS: Final = 1_000_000_000
"""A camera's stamp counts as a time of the drive's clock if it differs from the converted log time by at most this."""


class DriveClock:
    """Converts times of a drive to log times. `times`: the times of the drive's frames on both clocks; None: the clocks are the same.

    `is_log_clock`: the times of the drive are log times. Times of the drive's own messages that equal their log times are not: a camera's
    frame may still be logged later than it was taken.
    """

    def __init__(self, times: FrameTimes | None, *, uses_log_times: bool = False) -> None:
        self.is_log_clock = times is None or uses_log_times
        self._t_ns, ahead = np.zeros(1, np.int64), np.zeros(1, np.int64)
        if times is not None and len(times.t_ns):
            self._t_ns, first = np.unique(times.t_ns, return_index=True)
            ahead = self._t_ns - times.log_ns[first].astype(np.int64)
        self._ahead_ns = ahead

    def ahead_of_log_ns(self, t_ns: int) -> int:
        """Return by how much the drive's clock is ahead of the log's clock, at the frame nearest to a time of the drive."""
        at = int(np.clip(np.searchsorted(self._t_ns, t_ns), 1, max(len(self._t_ns) - 1, 1)))
        before, after = (min(i, len(self._t_ns) - 1) for i in (at - 1, at))
        is_after = abs(int(self._t_ns[after]) - t_ns) < abs(int(self._t_ns[before]) - t_ns)
        return int(self._ahead_ns[after if is_after else before])


def nearest_frame(log: FrameSource, topic: str, clock: DriveClock, t_ns: int) -> tuple[FramePlace, int] | None:
    """Return the frame of a camera nearest to a time of the drive, and the frame's time; None: no frame is near.

    The time of a frame is its message's stamp, if that is on the drive's clock, else its log time. Errors: `FrameError`.
    """
    ahead_ns = clock.ahead_of_log_ns(t_ns)
    wanted_ns = t_ns - ahead_ns
    places = log.frame_places(topic, wanted_ns - FRAME_SEARCH_RADIUS_NS, wanted_ns + FRAME_SEARCH_RADIUS_NS)
    if not places:
        return None
    times_by_index: dict[int, int] = {}

    def time_difference_ns(i: int) -> int:
        """Return the difference between the time of a frame and the requested time."""
        if i not in times_by_index:
            times_by_index[i] = _frame_time_ns(log, places[i], clock, ahead_ns)
        return abs(times_by_index[i] - t_ns)

    best = min(range(len(places)), key=lambda i: abs(places[i].log_ns - wanted_ns))
    # messages are logged in the order in which frames are taken: only one direction leads to nearer frames
    for way in (-1, 1):
        while 0 <= best + way < len(places) and time_difference_ns(best + way) < time_difference_ns(best):
            best += way
    return (places[best], times_by_index[best]) if time_difference_ns(best) <= LONGEST_TIME_TO_FRAME_NS else None


def _frame_time_ns(log: FrameSource, place: FramePlace, clock: DriveClock, ahead_of_log_ns: int) -> int:
    logged_ns = place.log_ns + ahead_of_log_ns
    if clock.is_log_clock:
        return logged_ns
    try:
        stamp_ns = log.stamp_ns(place)
    except FrameError:
        return logged_ns  # decoding the frame reports the problem
    return logged_ns if stamp_ns is None or abs(stamp_ns - logged_ns) > _SAME_CLOCK_TOLERANCE_NS else stamp_ns
