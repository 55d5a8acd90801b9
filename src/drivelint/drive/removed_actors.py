"""Leaves out actors that a simulator removed from the scene but still writes, all in one place.

CARLA's destroyed actors lie at the origin until the log ends. Two bodies are never in one place, so their tracks end where they jump there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.drive.jumps import IN_STATES, jumps

if TYPE_CHECKING:
    from collections.abc import Collection

    from numpy.typing import NDArray

    from drivelint.drive.order import Steps
    from drivelint.drive.trace import QualityFinding, States

SAME_PLACE_M: Final = 0.01
"""Centres nearer than this are in one place."""


def without_removed_actors(
    states: States, step: Steps, *, whole: Collection[str]
) -> tuple[States, list[QualityFinding]]:
    """Leave out the states of actors that jump to one place and stand there until their tracks end (states in order).

    One that is alone there stays. `whole`: actors that are kept (the egos that are named).
    """
    if len(states) < 3 or not {"x_m", "y_m"} <= states.numbers.keys():
        return states, []
    jump = np.flatnonzero(jumps(states, step))
    place = np.stack([states.numbers["x_m"], states.numbers["y_m"]])
    # an actor's last jump, and where its track ends
    last = {int(states.actor[row]): int(row) + 1 for row in jump if states.ids[states.actor[row]] not in whole}
    parked = []
    for actor, first in last.items():
        end = int(np.searchsorted(states.actor, actor, side="right"))
        spread = np.ptp(place[:, first:end], axis=1).max()
        if spread <= SAME_PLACE_M and end - first > 1:
            parked.append((first, end))
    gone = [a for a in parked if any(b != a and _together(states, place, a, b) for b in parked)]
    if not gone:
        return states, []
    out = np.zeros(len(states), np.bool_)
    for first, end in gone:
        out[first:end] = True
    text = "after a jump they stand in one place: they were taken out of the scene, and their tracks end there"
    return states.take(~out), states.findings(out, "removed", "warning", IN_STATES + text)


def _together(states: States, place: NDArray[np.float64], one: tuple[int, int], other: tuple[int, int]) -> bool:
    """Say whether both rows (first, end) are of one place and share some time."""
    (a, a_end), (b, b_end) = one, other
    apart = np.hypot(*(place[:, a] - place[:, b]))
    return bool(
        apart <= SAME_PLACE_M and states.t_ns[a] <= states.t_ns[b_end - 1] and states.t_ns[b] <= states.t_ns[a_end - 1]
    )
