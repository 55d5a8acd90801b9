"""Great Britain: zebras."""

from __future__ import annotations

from tests.outsiders.seventh.cast import PERSON, walker
from tests.outsiders.seventh.crossroads import Crossroads
from tests.outsiders.seventh.drive import Drive, draw
from tests.outsiders.seventh.maps import town
from tests.outsiders.seventh.movement import Actor, Pace, ego
from tests.outsiders.seventh.ways import through


def _zebra_on_half() -> Drive:
    m = town(zebra=220)
    return draw(
        "gb_zebra_on_half_i",
        "A walker stands 0.35 m inside the zebra on the ego's half when its front comes onto it. He has "
        "stopped 0.2 m from its side.",
        "fail r195.zebra-on | pass no-collision",
        m,
        [ego(m.way, Pace(10), start=120), walker("p", 220, 5.2, 3.15, wait=5)],
        16,
    )


def _zebra_far_half_walks_on() -> Drive:
    m = town(zebra=240, outline=False)
    return draw(
        "gb_zebra_far_half_walks_on_i",
        "The walker has left the ego's half two seconds before.",
        "pass r195.zebra-on",
        m,
        [
            ego(m.way, Pace(9).slow(88, 3, 2).hold(2).to(9, 1.5).hold(9), start=130),
            walker("p", 240, 5.5, -6, wait=4, speed=1.5),
        ],
        20,
    )


def _zebra_from_far_side() -> Drive:
    m = town(zebra=220)
    return draw(
        "gb_zebra_from_far_side_i",
        "A walker is on the far half of a zebra without island, walking towards the ego's half.",
        "not pass r195.zebra-on",
        m,
        [ego(m.way, Pace(10), start=120), walker("p", 220, -5.2, 5, wait=6.6)],
        18,
    )


def _zebra_island_wait() -> Drive:
    m = town(zebra=260)
    v = Pace(0).hold(1).to(1.4, 2).until(3.9).to(0, 2).hold(8).to(1.4, 2).hold(3).to(0, 2).hold(20)
    return draw(
        "gb_zebra_island_wait_i",
        "The walker waits 8 s in the middle, on an island; the other half is not the ego's.",
        "not fail r195.zebra-on",
        m,
        [ego(m.way, Pace(9), start=180), Actor("p", through((260, -5), (260, 6)), v, kind="pedestrian", size=PERSON)],
        22,
    )


def _zebra_child_vanishes() -> Drive:
    m = town(zebra=220)
    return draw(
        "gb_zebra_child_vanishes_i",
        "A walker steps onto the zebra before the ego and his track ends there half a second before the ego comes.",
        "not pass r195.zebra-on",
        m,
        [ego(m.way, Pace(10), start=120), walker("p", 220, 5.2, -5, wait=7.0, size=(0.4, 0.4, 1.1), end=9.2)],
        16,
    )


def _zebra_wheelchair_null() -> Drive:
    m = town(zebra=220)
    return draw(
        "gb_zebra_wheelchair_null_i",
        "Somebody of unknown class and size is on the ego's half.",
        "not pass r195.zebra-on",
        m,
        [ego(m.way, Pace(10), start=120), walker("p", 220, 5.2, -5, wait=7.6, kind=None, size=None)],
        16,
    )


def _crosswalk_unnamed() -> Drive:
    m = town(zebra=220, name="crossing")
    return draw(
        "gb_crosswalk_unnamed_i",
        "Somebody is on the ego's half of a crossing whose kind is not given.",
        "not pass r195.zebra-on",
        m,
        [ego(m.way, Pace(10), start=120), walker("p", 220, 5.2, -5, wait=7.8)],
        16,
    )


def _zebra_emergency_stop_child() -> Drive:
    m = town(zebra=220)
    return draw(
        "gb_zebra_emergency_stop_child_i",
        "Brakes hard and stands before the zebra. It stops 3 m short. No contact, only braking.",
        "not fail r195.zebra-on contact-signature | pass no-collision",
        m,
        [
            ego(m.way, Pace(12).stop(93, 7).hold(9).to(7, 1.5).hold(9), start=120),
            walker("child", 220, 5, -6, speed=2.2, wait=6, size=(0.3, 0.4, 1.1)),
        ],
        26,
    )


def _zebra_walker_backwards() -> Drive:
    m = town(zebra=250)
    return draw(
        "gb_zebra_walker_backwards_i",
        "A walker whose heading is written wrong by pi is on the ego's half.",
        "fail r195.zebra-on",
        m,
        [ego(m.way, Pace(9), start=150), walker("p", 250, 5.2, 3.1, wait=5, flipped=True)],
        18,
        hertz=5,
    )


def _turn_left_over_zebra() -> Drive:
    m = Crossroads(footway=True)
    m.arms["n"].area("crosswalk", "zebra", 6, 0, 3, 7, outline=True)
    p = m.way("w", "n")
    return draw(
        "gb_turn_left_over_zebra_i",
        "Turns left onto a zebra in the side road's mouth on which a walker stands, on the ego's half. It "
        "just misses him.",
        "fail r195.zebra-on | pass no-collision",
        m,
        [
            ego(p, Pace(8).slow(72, 5, 1.5).hold(30), start=40, lamps=[(4, "left"), (17, "off")]),
            Actor(
                "p",
                through((-6, 17), (8, 17)),
                Pace(0).hold(5).to(1.4, 2).until(2.45).to(0, 2).hold(20),
                kind="pedestrian",
                size=PERSON,
            ),
        ],
        24,
    )


def _school_run_kerb_wait() -> Drive:
    m = town(zebra=230)
    return draw(
        "gb_school_run_kerb_wait_i",
        "It waits behind, not on, the zebra for a class of children. It goes when all are over.",
        "not fail r191.no-stopping | pass r195.zebra-on",
        m,
        [ego(m.way, Pace(9).stop(103, 2).hold(15).to(7, 1.5).hold(30), start=120)]
        + [
            walker(f"k{i}", 229 + 0.5 * i, 5.5, -7, speed=1.2, wait=9 + 1.3 * i, size=(0.4, 0.4, 1.2)) for i in range(5)
        ],
        44,
    )


DRAWN = (
    _zebra_on_half,
    _zebra_far_half_walks_on,
    _zebra_from_far_side,
    _zebra_island_wait,
    _zebra_child_vanishes,
    _zebra_wheelchair_null,
    _crosswalk_unnamed,
    _zebra_emergency_stop_child,
    _zebra_walker_backwards,
    _turn_left_over_zebra,
    _school_run_kerb_wait,
)
