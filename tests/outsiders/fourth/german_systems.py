"""Germany: a system that drives by itself on a motorway."""

from __future__ import annotations

from tests.outsiders.fourth.drive import Drive
from tests.outsiders.fourth.faults import lost
from tests.outsiders.fourth.movement import east, ego, way
from tests.outsiders.fourth.places import ALWAYS_UNKNOWN, ON, V50, V130, F, M
from tests.outsiders.fourth.worlds import motorway


def german_systems() -> list[Drive]:
    auto = motorway(V130)
    v = V50
    mrm = ((0.0, "engaged", "on"), (0.0, "minimal_risk_manoeuvre", "off"), (3.0, "minimal_risk_manoeuvre", "on"))
    shift = ((137.5, 225.0, 3.75),)
    return [
        Drive(
            "de_alks_tailgates_4",
            "The system follows a car at 50 km/h with 9 m between them.",
            "fail alks-r157.follow-gap criticality.thw | pass stvo.rg1 | not fail stvo.rg4",
            auto,
            [ego(way(100, M), v), east("lead", "car", 113.5, M, v)],
            events=ON,
        ),
        Drive(
            "de_alks_keeps_gap",
            "The system follows a car at 50 km/h with 30 m between them.",
            "pass alks-r157.follow-gap criticality.thw criticality.ttc",
            auto,
            [ego(way(100, M), v), east("lead", "car", 134.5, M, v)],
            events=ON,
        ),
        Drive(
            "de_alks_cut_in_avoided",
            "A slower car cuts in 24 m ahead and the system brakes and keeps clear.",
            "pass alks-r157.cut-in no-collision | not fail stvo.rg2",
            auto,
            [ego(way(100, M), 22.0, 4.2, (14.0, 3.5)), east("cutter", "car", 160, F, 15.0, shifts=((45, 90, -3.75),))],
            events=ON,
        ),
        Drive(
            "de_alks_cut_in_hit",
            "A slower car cuts in 17 m ahead and the system drives into it unbraked.",
            "fail alks-r157.cut-in no-collision criticality.ttc criticality.ttb",
            auto,
            [ego(way(100, M), 22.0), east("cutter", "car", 155, F, 14.0, shifts=((42, 91, -3.75),))],
            7.5,
            events=ON,
        ),
        Drive(
            "de_alks_gap_never_restored",
            "A car cuts in 8 m ahead at 50 km/h and the system stays that close for long.",
            "fail alks-r157.cut-in-gap alks-r157.follow-gap criticality.thw",
            auto,
            [ego(way(100, M), v), east("cutter", "car", 112, F, v, shifts=((42, 83, -3.75),))],
            30.0,
            events=ON,
        ),
        Drive(
            "de_alks_emergency_undeclared_4",
            "The system brakes with 7 m/s2 for a thing on its lane and declares nothing.",
            "fail alks-r157.emergency comfort.decel-iso15622 comfort.nuplan | not fail stvo.rg2 stvo.ri1",
            auto,
            [ego(way(100, M), 25.0, 3.0, (0.0, 7.0)), east("crate", "object", 237, M, 0.0)],
            15.0,
            events=((0.0, "engaged", "on"), (0.0, "emergency_manoeuvre", "off")),
        ),
        Drive(
            "de_mrm_brakes_hard",
            "In a minimal risk manoeuvre the system brakes with 6.5 m/s2 to a halt, hazards on.",
            "fail alks-r157.mrm | pass alks-r157.mrm-hazards | not fail stvo.ri1",
            auto,
            [ego(way(100, M), 25.0, 3.0, (0.0, 6.5), lamp=((3.0, 99.0, "hazard"),))],
            events=mrm,
        ),
        Drive(
            "de_mrm_without_hazards",
            "A minimal risk manoeuvre brakes gently but its hazard lights stay off.",
            "pass alks-r157.mrm | fail alks-r157.mrm-hazards",
            auto,
            [ego(way(100, M), 20.0, 3.0, (0.0, 2.0))],
            events=mrm,
        ),
        Drive(
            "de_mrm_lamps_unlogged",
            "A minimal risk manoeuvre, and the log does not know the lamps.",
            "not pass alks-r157.mrm-hazards | pass alks-r157.mrm",
            auto,
            [ego(way(100, M), 20.0, 3.0, (0.0, 2.0), lamp=ALWAYS_UNKNOWN)],
            events=mrm,
        ),
        Drive(
            "de_r79_signals_late",
            "The system changes lane two seconds after its indicator came on.",
            "fail alks-r157.r79.lane-change | pass alks-r157.r79.lane-change-done",
            auto,
            [ego(way(100, M, shifts=shift), 25.0, lamp=((5.0, 12.0, "far"),))],
            18.0,
            events=ON,
        ),
        Drive(
            "de_r79_lingers_on_line",
            "The system takes 24 s to drift into the next lane.",
            "pass alks-r157.r79.lane-change | fail alks-r157.r79.lane-change-done",
            auto,
            [ego(way(100, M, shifts=((100, 700, 3.75),)), 25.0, lamp=((9.0, 30.0, "far"),))],
            35.0,
            events=ON,
        ),
        Drive(
            "de_r79_lamps_unlogged",
            "The system changes lane, and the log does not know the lamps.",
            "not pass alks-r157.r79.lane-change | pass alks-r157.r79.lane-change-done",
            auto,
            [ego(way(100, M, shifts=shift), 25.0, lamp=ALWAYS_UNKNOWN)],
            18.0,
            events=ON,
        ),
        Drive(
            "de_alks_lead_lost",
            "The system tailgates at 7 m; after 14 s the log loses the car ahead.",
            "fail alks-r157.follow-gap criticality.thw",
            auto,
            [ego(way(100, M), v), east("lead", "car", 111.5, M, v)],
            faults=[lost("lead", 14.0, 99.0)],
            events=ON,
        ),
        Drive(
            "de_alks_lead_without_size",
            "The system tailgates a vehicle whose size the log does not know.",
            "not pass alks-r157.follow-gap criticality.thw",
            auto,
            [ego(way(100, M), v), east("lead", "car", 110, M, v, size=(None, None, None))],
            events=ON,
        ),
    ]
