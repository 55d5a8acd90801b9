"""The scenes of the second outsider: places (s, u) beside a line of straights and arcs.

`u`: metres from the road's reference line, negative on the side that the ego drives on and positive towards the oncoming
traffic, whichever hand the country drives on.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.outsiders.second.britain import british
from tests.outsiders.second.germany import german

if TYPE_CHECKING:
    from tests.outsiders.second.drive import Drive


def drives() -> list[Drive]:
    """Return every drive."""
    return [*german(), *british()]
