"""In town: zebras, parked cars, cyclists."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.first.chapter import Spec, scene
from tests.outsiders.first.maps import urban
from tests.outsiders.first.movement import against, ahead, car, line, out_and_back, still, to_stop
from tests.outsiders.first.road import Lane


def town() -> Iterator[Spec]:
    street, zebra, wide = urban(1), urban(1, crossing="zebra"), urban(1, Lane(2.2, "parking", "none"))
    steps_out = [(0, 0), (1.5, 0), (2, 1.3), (4.1, 1.3), (4.6, 0), (9.5, 0), (10.5, 1.3)]
    walk = line([(200, 6.5), (200, -40)], 0)
    yield scene(
        "zebra_ignored",
        "Somebody has stepped onto the zebra from the near side; the ego drives on before them.",
        "fail r195.zebra-on",
        zebra,
        [car(ahead(zebra, 100), 12.0), car(walk, steps_out, "pedestrian")],
        16,
    )
    yield scene(
        "zebra_ignored_far_side",
        "Somebody walks across the zebra from the far side; the ego drives through before they reach its lane.",
        "fail r195.zebra-on",
        zebra,
        [
            car(ahead(zebra, 100), 12.0),
            car(line([(200, -6.5), (200, 40)], 0), [(0, 0), (4, 0), (5, 1.3)], "pedestrian"),
        ],
        16,
    )
    yield scene(
        "zebra_given_way",
        "The ego stops before the zebra, waits until the walker is across, and goes on.",
        "pass r195.zebra-on no-collision | not fail r191.no-stopping r192.keep-clear h2.turn-pedestrian",
        zebra,
        [
            car(ahead(zebra, 100), to_stop(12, 94.75, 2.5, 5.0, 10)),
            car(walk, [(0, 0), (4.5, 0), (5.5, 1.3)], "pedestrian"),
        ],
        26,
    )
    yield scene(
        "zebra_walker_on_footway",
        "Somebody walks along the footway past the zebra; the ego drives on.",
        "not fail r195.zebra-on criticality.pet",
        zebra,
        [car(ahead(zebra, 100), 12.0), car(line([(192, 4.6), (230, 4.6)], 0), 1.3, "pedestrian")],
        16,
    )
    queue = [(0, 8), (8.9, 8), (12.9, 0), (27, 0), (30, 8)]
    yield scene(
        "zebra_blocked_in_queue",
        "The ego follows a queue onto the zebra and stands there for over ten seconds.",
        "fail r192.keep-clear | not fail r191.no-stopping",
        zebra,
        [car(ahead(zebra, 100), to_stop(8, 100.5, 2.0, 13.5, 8)), car(ahead(zebra, 120.2), queue)],
        38,
    )
    yield scene(
        "zebra_parked",
        "The ego stops on the zebra for twenty seconds, for nobody.",
        "fail r191.no-stopping",
        zebra,
        [car(ahead(zebra, 100), to_stop(8, 100, 2.0, 20.0, 8))],
        44,
    )
    yield scene(
        "zebra_stop_for_walker",
        "The ego stops on the zebra since somebody walks into the road just beyond.",
        "not fail r191.no-stopping r192.keep-clear no-collision",
        zebra,
        [
            car(ahead(zebra, 100), to_stop(8, 100, 4.0, 9.0, 8)),
            car(line([(206, 5), (206, -30)], 0), [(0, 0), (10, 0), (11, 0.9)], "pedestrian"),
        ],
        34,
    )
    yield scene(
        "zebra_overtaking_before",
        "The ego overtakes a moving car ten metres before the zebra.",
        "fail r191.crossing-overtake",
        zebra,
        [car(out_and_back(zebra, 80, 95, 140, 205, 250), 13.0), car(ahead(zebra, 120), 8.0)],
        20,
    )
    yield scene(
        "zebra_past_parked",
        "The ego passes a parked car just before the zebra.",
        "not fail r191.crossing-overtake r163.obstruction-give-way",
        zebra,
        [car(out_and_back(zebra, 100, 140, 175, 195, 230, out=-0.2), 8.0), still("car", 186, 2.6)],
        22,
    )
    yield scene(
        "zebra_past_waiting_car",
        "A car has stopped at the zebra for a walker; the ego passes it and drives across.",
        "fail r191.crossing-overtake r195.zebra-on",
        zebra,
        [
            car(out_and_back(zebra, 46, 110, 150, 205, 240), 10.0),
            car(ahead(zebra, 120), to_stop(8, 74)),
            car(walk, [(0, 0), (9, 0), (9.5, 1.3), (13.2, 1.3), (13.7, 0)], "pedestrian"),
        ],
        22,
    )
    yield scene(
        "footway",
        "The ego drives along the footway for forty metres at 20 mph.",
        "fail r145.off-road",
        street,
        [car(out_and_back(street, 100, 120, 160, 200, 240, out=4.2), 9.0)],
        20,
    )
    yield scene(
        "into_driveway",
        "The ego turns slowly across the footway into a driveway.",
        "not fail r145.off-road r143.direction",
        street,
        [car(line([(110, 1.75), (150, 1.75), (150, 13)], 2.5), [(0, 6), (3, 6), (5.5, 2.2)])],
        14,
    )
    yield scene(
        "hazards_unknown",
        "The ego drives through town; the log does not know its lamps.",
        "not pass r116.hazards",
        street,
        [car(ahead(street, 50), 12.0, lamps=None)],
        15,
    )
    yield scene(
        "horn_standing",
        "The ego, standing with nobody near, sounds its horn.",
        "fail r112.horn",
        street,
        [still("car", 150, 1.75)],
        15,
        events=[(0.0, "horn", "off"), (5.0, "horn", "on"), (7.0, "horn", "off")],
    )
    yield scene(
        "parked_wrong_way_at_night",
        "The ego stands for over a minute at night facing against the traffic.",
        "fail r239.parked-with-traffic r248.parked-at-night",
        street,
        [still("car", 150, -2.5)],
        75,
        2.0,
        light="night",
    )
    yield scene(
        "child_runs_out",
        "A child runs out from behind a parked van; the ego brakes as hard as it can and stops in time.",
        "pass no-collision | not fail contact-signature",
        wide,
        [
            car(ahead(wide, 100), [(0, 11), (3.9, 11), (5.5, 0), (12, 0), (15, 5)]),
            still("van", 152, 4.6),
            car(
                line([(157, 6), (157, -30)], 0),
                [(0, 0), (2.8, 0), (3.3, 2.5), (4.4, 2.5), (4.8, 0), (8, 0), (9, 2)],
                "pedestrian",
                size=(0.3, 0.4, 1.2),
            ),
        ],
        18,
    )
    yield scene(
        "cyclist_close",
        "The ego passes a cyclist at 25 mph, 0.7 m away.",
        "fail r163.cyclist",
        street,
        [car(ahead(street, 100, 1.2), 11.0), car(ahead(street, 140, 3.1), 5.0, "bicycle")],
        18,
    )
    yield scene(
        "cyclist_wide",
        "The ego passes a cyclist at 22 mph with over two metres to spare.",
        "pass r163.cyclist | not fail r143.direction r131.keep-in-lane",
        street,
        [
            car(out_and_back(street, 100, 110, 145, 205, 240, out=-0.4), 10.0),
            car(ahead(street, 140, 3.1), 5.0, "bicycle"),
        ],
        20,
    )
    vans = [still("van", s, 2.4) for s in (195, 202, 209)]
    yield scene(
        "parked_vans_oncoming",
        "The ego goes round three parked vans and makes an oncoming car stop.",
        "fail r163.obstruction-give-way",
        street,
        [
            car(out_and_back(street, 100, 150, 185, 220, 255, out=-0.6), 9.0),
            *vans,
            car(against(street, 340), [(0, 12), (4, 12), (7, 0), (18, 0), (22, 8)]),
        ],
        25,
    )
