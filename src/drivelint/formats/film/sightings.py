"""What was detected in the frames of a film."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True)
class Sightings:
    """Frames that exist (numbers, rising), and per actor its distance ahead in each, NaN where it was not detected."""

    frames: NDArray[np.int64]
    ahead_m: list[NDArray[np.float64]]
