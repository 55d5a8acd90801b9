"""Maps on which several drives go."""

from __future__ import annotations

from tests.outsiders.seventeenth.maps import cross, one_way, roundabout, two_way
from tests.outsiders.seventeenth.road import box, sign

ROAD = two_way()
LONG_ROAD = two_way(length=1200)
LONGER_ROAD = two_way(length=1400)
TOWN = two_way(kind="town", limit=(30, "mph"), walk=2)
M3 = one_way(length=2500)
DE3 = one_way(gb=False, length=2500, limit=(130, "km/h"))
SOLID = two_way(centre=((0, "solid"),))
LIT_CROSS = cross(
    west=(
        [box("sl", "stopLine", "stopline", 148, 1.75, 0.3, 3.4)],
        [sign("tl", "OpenDRIVE", "1000001", 148, 4, 1, dynamic=True)],
    )
)
STOP_CROSS = cross(
    gb=True, west=([box("sl", "stopLine", "stopline", 148, 1.75, 0.3, 3.4)], [sign("s", "DE", "206", 148, 3.8, 1)])
)
WALKED_CROSS = cross(walk=2)
ZEBRA = two_way(kind="town", limit=(30, "mph"), walk=2, objects=[box("z", "crosswalk", "zebra", 200, 0, 3, 7)])
SIGNALLED_CROSSING = two_way(
    kind="town",
    limit=(30, "mph"),
    walk=2,
    objects=[
        box("z", "crosswalk", "signal crossing", 200, 0, 3, 7),
        box("sl", "stopLine", "stopline", 196, 1.75, 0.3, 3.4),
    ],
    signals=[sign("tl", "OpenDRIVE", "1000001", 196, 4, 1, dynamic=True)],
)
ROUNDABOUT = roundabout()
ZEBRA_ONE_WAY = one_way(
    n=2,
    length=500,
    limit=(30, "mph"),
    kind="town",
    shoulder=False,
    objects=[box("z", "crosswalk", "zebra", 200, 3.65, 3, 7.3)],
)
