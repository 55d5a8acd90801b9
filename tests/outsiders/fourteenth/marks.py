"""Middle lines."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Actor, Drive
from tests.outsiders.fourteenth.lines import go, side
from tests.outsiders.fourteenth.maps import Lane
from tests.outsiders.fourteenth.places import OWN, street
from tests.outsiders.fourteenth.scenes import alone, on, pass_by


def marks_a() -> Iterator[Drive]:
    own = (Lane(mark="solid"),)
    r129 = "ukhc.r129.no-cross-solid"
    r128 = "ukhc.r128.back-before-solid"
    solid = street("gb", length=1600.0, centre=((0.0, "solid solid"),), at=(9.0, 9.0, 1.0))
    mine = street("gb", length=1600.0, centre=((0.0, "broken solid"),), at=(9.0, 9.0, 1.0))
    theirs = street("gb", length=1600.0, centre=((0.0, "solid broken"),), at=(9.0, 9.0, 1.0))
    soon = street("gb", length=1600.0, centre=((0.0, "broken"), (250.0, "solid solid")), own=own, at=(9.0, 9.0, 1.0))
    cyc = Actor("cyc", "bicycle", on(solid.course, go(190.0, (0, 3.5)), 2.9))
    fast = Actor("cyc", "bicycle", on(solid.course, go(190.0, (0, 8.0)), 2.9))
    yield pass_by("line-solid", solid, "overtakes over a double solid line", [(r129, "fail", "solid for both")])
    yield pass_by(
        "line-mine-broken", mine, "the line nearer to the ego is broken", [(r129, "not fail", "broken on its side")]
    )
    yield pass_by(
        "line-mine-solid", theirs, "the line nearer to the ego is solid", [(r129, "fail", "solid on its side")]
    )
    yield pass_by(
        "line-turns-solid",
        soon,
        "back 3 s after the line turned solid",
        [(r128, "fail", "back at about 430 m, solid from 250 m")],
    )
    yield alone(
        "line-straddle",
        "half a metre over a solid line for 2 s",
        solid,
        ((0, 18),),
        [(r129, "fail", "0.5 m over")],
        u=side((0.0, OWN), (5.0, OWN), (7.0, 0.4), (9.0, 0.4), (11.0, OWN)),
    )
    yield alone(
        "line-cyclist",
        "over the solid line round a cyclist of 8 mph",
        solid,
        ((0, 12),),
        [(r129, "not fail", "a cyclist at 10 mph or less"), ("ukhc.r163.cyclist", "pass", "over 2 m")],
        u=side((0.0, OWN), (6.0, OWN), (9.0, -0.6), (14.0, -0.6), (17.0, OWN)),
        others=[cyc],
    )
    yield alone(
        "line-cyclist-fast",
        "over the solid line round a cyclist of 18 mph",
        solid,
        ((0, 17),),
        [(r129, "fail", "18 mph, ten allowed")],
        u=side((0.0, OWN), (5.0, OWN), (8.0, -0.6), (14.0, -0.6), (17.0, OWN)),
        others=[fast],
    )


def marks() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from marks_a()
