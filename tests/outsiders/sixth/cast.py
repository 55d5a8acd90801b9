"""Movements and crossings that are in many scenes."""

from __future__ import annotations

from tests.outsiders.sixth.drive import Drive
from tests.outsiders.sixth.maps import OPP, OWN, street
from tests.outsiders.sixth.road import Map


def overtaker(d: Drive, s: float, v: float, out: float, back: float) -> None:
    """The ego pulls out at one time and moves back at another, with signals."""
    lamps = [(out - 2, "right"), (out + 3, "off"), (back - 1, "left"), (back + 3, "off")]
    d.add("ego", s=s, v=v, u=[(out, OWN), (out + 3, OPP), (back, OPP), (back + 3, OWN)], ind=lamps)


def zebra(own: int = 1, name: str = "zebra") -> Map:
    """A street with a crossing at 200 m."""
    drawn = street("gb", 400, "town", 30, own=own, walk=True)
    drawn["1"].crossing("z1", 200, name, 7.0 * own)
    return drawn


def pelican(name: str) -> Map:
    """A street with a signalled crossing at 200 m."""
    drawn = zebra(name=name)
    drawn["1"].stopline("sl", 196, 1).signal("tp", 196, 1, "1000001")
    return drawn
