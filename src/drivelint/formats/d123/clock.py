"""The clock of a 123D log: microseconds, of UTC only where the data set is documented to count in it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from drivelint.drive.trace import LEAST_UTC_NS
from drivelint.errors import TraceError
from drivelint.formats.d123.arrow_files import integers

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    import pyarrow as pa

    from drivelint.arrays import Times

_LATEST_US: Final = 1 << 52  # the year 2112: a clock beyond it is broken


class Clock(NamedTuple):
    """How a log's microseconds become nanoseconds: they count from `zero_us`."""

    zero_us: int = 0

    def nanoseconds(self, stamps_us: Times) -> Times:
        """Return times of the log in nanoseconds of the drive."""
        return (stamps_us - self.zero_us) * 1000

    @property
    def notes(self) -> list[str]:
        """Notes for the user."""
        if not self.zero_us:
            return []
        return [
            f"times count from {self.zero_us} us of the log: whether that is UTC is not documented for this data set"
        ]


def clock(folder: Path, columns: Iterable[pa.Array], *, utc: bool) -> Clock:
    """Return the clock of a log with these columns of times. Errors: `TraceError` for times that cannot be.

    Times as large as those of UTC are taken for UTC everywhere, so that others have to count from the log's first.
    """
    every = np.concatenate([integers(stamps) for stamps in columns])
    low, high = int(every.min()), int(every.max())
    if max(-low, high) > _LATEST_US:
        raise TraceError(
            f"{folder}: times from {low} to {high} us: the clock or its unit is wrong: convert the log again"
        )
    return Clock(0 if utc or high * 1000 < LEAST_UTC_NS else low)
