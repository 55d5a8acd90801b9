"""Germany: towns and country roads."""

from __future__ import annotations

from tests.outsiders.tenth.drive import Drive
from tests.outsiders.tenth.junction import Cross
from tests.outsiders.tenth.road import Lane
from tests.outsiders.tenth.streets import street, town

LIMIT = "stvo.rg3"
BIKE = "stvo.s5-passing"


def german_roads() -> list[Drive]:
    """Towns and country roads."""
    out = []
    s = town(nation="de", length=500, start=(3.0, 3.0, 1.0), pieces=[(150.0, 0.0), (100.0, 1 / 120), (250.0, 0.0)])
    d = Drive("de_town_seventy_l", s.xml, 20)
    d.ego(s.way(1), 40, [(0, 13), (4, 13), (6, 19.0), (20, 19)])
    d.want(LIMIT, "fail", "It does 68 km/h where 50 are allowed.")
    d.want(
        "comfort.accel-iso15622", "fail", "It speeds up at 3 m/s2 from 13 to 19 m/s, where two to three are the limit."
    )
    d.want("comfort.nuplan", "fail", "The same, 2.4 m/s2 are the bound.")
    out.append(d)

    s = town(nation="de", length=500, start=(3.0, 3.0, -1.0))
    d = Drive("de_town_cyclist_at_one_metre_l", s.xml, 26)
    d.ego(s.way(1), 40, 11.0, [(0, 0), (4, 0), (7, 0.7), (12, 0.7), (15, 0)])
    d.add("b", "bicycle", s.way(1), 100, 5.0, -1.2)
    d.want(BIKE, "fail", "It passes a cyclist with 0.7 m.")
    out.append(d)

    road = Lane("driving", 3.5, "solid")
    s = street("de", (road,), (road,), speed=(100, "km/h"), length=900, start=(0.0, 0.0, 0.6))
    d = Drive("de_country_cyclist_too_near_for_there_l", s.xml, 26)
    d.ego(s.way(1), 40, 22.0, [(0, 0), (4, 0), (7, 1.4), (11, 1.4), (14, 0)])
    d.add("b", "bicycle", s.way(1), 190, 6.0, -1.2)
    d.want(BIKE, "fail", "It leaves 1.4 m out of town, where 2 m are asked for.")
    out.append(d)

    d = Drive("de_country_cyclist_wide_l", s.xml, 30)
    d.ego(s.way(1), 40, 20.0, [(0, 0), (5, 0), (8, 3.3), (14, 3.3), (18, 0)])
    d.add("b", "bicycle", s.way(1), 190, 6.0, -1.2)
    d.want(BIKE, "pass", "It leaves more than 3 m.")
    out.append(d)

    c = Cross("de", {"S": -90.0, "E": 0.0, "W": 180.0}, turn=0.2, speed=(50, "km/h"))
    c.stop("S")
    d = Drive("de_stop_sign_only_slows_l", c.xml, 26)
    d.ego(c.way("S", "E"), 92, [(0, 9), (3, 9), (8, 1.5), (9.2, 1.5), (13, 6)], lamps=[(0, "right")])
    d.want("stvo.rin1", "fail", "It passes the stop sign at walking pace.")
    out.append(d)
    return out
