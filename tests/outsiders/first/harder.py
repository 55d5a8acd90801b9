"""Scenes drawn after the first run, where the product had been close to wrong or had not been asked."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.first.chapter import Spec, scene
from tests.outsiders.first.maps import RURAL, crossroads, motorway, urban
from tests.outsiders.first.movement import against, ahead, car, line, out_and_back, route, still
from tests.outsiders.first.road import Lane


def harder() -> Iterator[Spec]:
    """Drawn after the first run: where it had been close to wrong, or had not been asked."""
    street, zebra, plain = urban(1), urban(1, crossing="zebra"), crossroads(1, "give way")
    free, m = motorway(-1, None), motorway(1, (70.0, "mph"))
    tail = "r126.thinking-gap"
    yield scene(
        "astride_centre_briefly",
        "On a long drive the ego drives 10 s astride the middle line, more on the other side, with nothing to pass.",
        "fail r131.keep-in-lane",
        RURAL,
        [car(out_and_back(RURAL, 200, 400, 470, 680, 750, out=-0.3), 20.0)],
        50,
    )
    yield scene(
        "reversing_only",
        "In the whole log the ego does nothing but reverse at 18 mph.",
        "not pass r143.direction",
        RURAL,
        [car(ahead(RURAL, 200), [(0, 0), (2, 0), (6, -8), (15, -8), (19, 0)], start=200)],
        22,
    )
    yield scene(
        "ghost_driver",
        "The ego drives against the traffic on the motorway, from the first to the last step.",
        "fail r143.direction",
        m,
        [car(against(m, 2000, 1.8), 30.0), car(ahead(m, 300, 9.1), 28.0), car(ahead(m, 700, 5.5), 31.0)],
        20,
        road_type="motorway",
    )
    yield scene(
        "de_ghost_driver",
        "The ego drives against the traffic on the Autobahn, nobody else is there.",
        "fail stvo.ri3",
        free,
        [car(against(free, 2000, 1.8), 30.0)],
        20,
        road_type="motorway",
    )
    broad = urban(1)
    broad.roads["main"].own[0] = broad.roads["main"].other[0] = Lane(5.0)
    yield scene(
        "wide_lane_cyclist",
        "In a lane of five metres the ego passes a cyclist with 1.6 m to spare, without leaving the lane.",
        f"pass r163.cyclist | not fail {tail} r126.stopping-gap rss.longitudinal criticality.ttc r163.obstruction-give-way",
        broad,
        [car(ahead(broad, 100, 1.6), 10.0), car(ahead(broad, 140, 4.4), 5.0, "bicycle")],
        18,
    )
    yield scene(
        "crossed_between_steps",
        "At 2 Hz, a motorcycle goes through the ego at a right angle between two steps.",
        "fail no-collision",
        plain,
        [car(route(plain, "W WE E", 100, 200), 10.0), car(route(plain, "S SN N", 203, 200), 20.0, "motorcycle")],
        16,
        2.0,
    )
    rig = [
        car(ahead(RURAL, 210), 20.0, "truck", size=(6.0, 2.5, 3.8)),
        car(ahead(RURAL, 202.5), 20.0, "trailer", size=(13.6, 2.5, 4.0)),
    ]
    yield scene(
        "semi_trailer",
        "The ego pulls a semi-trailer, whose front hangs over its own rear.",
        "not fail no-collision contact-signature criticality.mttc rss.longitudinal",
        RURAL,
        rig,
        15,
        vehicle_class="goods_over_7t5",
    )
    yield scene(
        "zebra_walker_lost",
        "Somebody is on the zebra before the ego; the log loses them a second before it drives across.",
        "not pass r195.zebra-on",
        zebra,
        [
            car(ahead(zebra, 100), 12.0),
            car(line([(200, 6.5), (200, -9)], 0), [(0, 0), (3.5, 0), (4, 1.0)], "pedestrian", until=7.1),
        ],
        16,
    )
    yield scene(
        "parked_vans_nose_to_nose",
        "The ego goes round three parked vans; an oncoming car brakes hard and waits nose to nose.",
        "fail r163.obstruction-give-way | pass no-collision",
        street,
        [
            car(out_and_back(street, 100, 150, 185, 220, 255, out=-0.6), 9.0),
            *(still("van", s, 2.4) for s in (195, 202, 209)),
            car(against(street, 366), [(0, 12), (8, 12), (10.4, 0), (19, 0), (22, 8)]),
        ],
        25,
    )
    short = line(
        [(-60, 1.75), (-14, 1.75), (-6, 2.6), (-0.7, 8), (-0.3, 14), (-0.3, 35), (-1.75, 55), (-1.75, 140)], 3.0
    )
    yield scene(
        "left_turn_wide_a_little",
        "The ego turns left and runs on astride the middle of the side road.",
        "fail r183.keep-in",
        plain,
        [car(short, [(0, 8), (4, 8), (6, 4)])],
        26,
    )
    yield scene(
        "footway_briefly",
        "On a long drive the ego takes to the footway for three seconds to get past a queue.",
        "fail r145.off-road",
        street,
        [
            car(out_and_back(street, 20, 190, 215, 245, 270, out=4.2), 9.0),
            still("car", 250, 1.5),
            still("car", 243, 1.5),
        ],
        35,
    )
    for name, n in (("", 7.3), ("_own_half", 7.8), ("_other_half", 6.8)):
        yield scene(
            f"motorway_astride_briefly{name}",
            "On a long drive the ego drives astride two lanes for ten seconds and more.",
            "fail r131.keep-in-lane",
            m,
            [car(out_and_back(m, 100, 400, 480, 760, 840, 9.1, n), 28.0)],
            50,
            road_type="motorway",
        )
    bare = urban(1)
    bare.roads["main"].limit = None
    yield scene(
        "fifty_in_town_without_limit",
        "The ego drives at 56 mph through a town for which the map has no limit.",
        "not pass r124.speed-limit",
        bare,
        [car(ahead(bare, 20), 25.0)],
        14,
    )
    for name, a, b, verdict in (("", 335, 425, "fail"), ("_early", 300, 360, "not pass")):
        yield scene(
            f"drifts_when_overtaken{name}",
            "While a car overtakes it in the opposing lane the ego drifts over a metre towards it.",
            f"{verdict} r168.when-overtaken",
            RURAL,
            [
                car(RURAL.along((200, 2.3), (a, 2.3), (b, 1.0), (2000, 1.0)), 18.0),
                car(out_and_back(RURAL, 120, 160, 260, 536, 640, out=-2.0), 26.0),
            ],
            26,
        )
    town = urban(-1)
    yield scene(
        "de_cyclist_on_inside",
        "In a German town the ego squeezes past a cyclist on the wrong side, the right, 0.5 m away.",
        "fail stvo.s5-passing",
        town,
        [car(ahead(town, 100, 2.5), 9.0), car(ahead(town, 130, 0.8), 4.5, "bicycle")],
        16,
    )
    rig = [car(ahead(RURAL, 200), 22.0), car(ahead(RURAL, 210.7), 22.0, "trailer"), car(ahead(RURAL, 216.8), 22.0)]
    engaged = [(0.0, "engaged", "on")]
    yield scene(
        "alks_too_close",
        "In automatic mode the ego follows 4 m behind a car at 25 mph on the motorway.",
        "fail alks-r157.follow-gap",
        m,
        [car(ahead(m, 100, 9.1), 11.0), car(ahead(m, 108.5, 9.1), 11.0)],
        20,
        events=engaged,
        road_type="motorway",
    )
    yield scene(
        "lorry_unknown_class_right_lane",
        "A lorry drives in the right-hand lane; nobody told what class it is of.",
        "not pass r265.right-lane-ban",
        m,
        [car(ahead(m, 100, 1.8), 25.0, "truck", no_class=True)],
        15,
        road_type="motorway",
        vehicle_class="",
    )
