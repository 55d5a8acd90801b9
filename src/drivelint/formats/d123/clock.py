"""The clock of a 123D log: microseconds, which are UTC only if the data set is documented to use UTC."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from drivelint.drive.trace import EARLIEST_UTC_NS
from drivelint.errors import TraceError
from drivelint.formats.d123.arrow_files import integers

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    import pyarrow as pa

    from drivelint.arrays import Times

_LATEST_CREDIBLE_TIME_US: Final = 1 << 52  # the year 2112: a clock beyond it is broken


class LogTimeConverter(NamedTuple):
    """Converts a log's microseconds to nanoseconds of the drive, which count from `zero_us`."""

    zero_us: int = 0

    def nanoseconds(self, stamps_us: Times) -> Times:
        """Return times of the log in nanoseconds of the drive."""
        return (stamps_us - self.zero_us) * 1000

    @property
    def notes(self) -> list[str]:
        """The note for the user that times count from `zero_us`; none if that is 0."""
        if not self.zero_us:
            return []
        return [f"times count from {self.zero_us} us of the log: the data set does not document whether this is UTC"]


def converter_from_times(folder: Path, time_columns: Iterable[pa.Array], *, utc: bool) -> LogTimeConverter:
    """Return the clock of a log with these columns of times. Errors: `TraceError` for impossible times.

    drivelint treats times as large as those of UTC as UTC. Large times of another clock therefore count from the first time of the log.
    """
    every = np.concatenate([integers(stamps) for stamps in time_columns])
    low, high = int(every.min()), int(every.max())
    if max(-low, high) > _LATEST_CREDIBLE_TIME_US:
        raise TraceError(
            f"{folder}: times from {low} to {high} us: the clock or its unit is wrong: convert the log again"
        )
    return LogTimeConverter(0 if utc or high * 1000 < EARLIEST_UTC_NS else low)
