"""Germany: the automated driver, and what it declares."""

from __future__ import annotations

from tests.outsiders.tenth.drive import Drive
from tests.outsiders.tenth.streets import bahn, town


def german_systems() -> list[Drive]:
    return [*alks(), *declared()]


def on(d: Drive) -> Drive:
    """The automated driver drives."""
    return (
        d.says(0.0, "engaged", "on").says(0.0, "minimal_risk_manoeuvre", "off").says(0.0, "emergency_manoeuvre", "off")
    )


def alks() -> list[Drive]:
    """The automated driver."""
    out = []
    s = bahn(3, start=(0.0, 0.0, 0.9), speed=(130, "km/h"))
    d = on(Drive("de_alks_seven_metres_in_slow_traffic_l", s.xml, 30))
    d.ego(s.way(3), 60, 10.0)
    d.add("v", "van", s.way(3), 72, 10.0)
    d.want("alks-r157.follow-gap", "fail", "At 36 km/h the system keeps 7 m; 1.36 s, 13.6 m, are asked for.")
    out.append(d)

    d = on(Drive("de_alks_slow_lane_change_l", s.xml, 34))
    d.ego(s.way(3), 60, 27.0, [(0, 0), (8, 0), (26, 3.75)], lamps=[(0, "off"), (10.2, "left"), (26, "off")])
    d.want("alks-r157.r79.lane-change", "pass", "The signal has been on for 3.7 s when it reaches over the line.")
    d.want("alks-r157.r79.lane-change-done", "fail", "It is astride the line for six seconds.")
    out.append(d)

    d = on(Drive("de_alks_signal_of_one_second_l", s.xml, 30))
    d.ego(s.way(3), 60, 27.0, [(0, 0), (8, 0), (12, 3.75)], lamps=[(0, "off"), (8.0, "left"), (12, "off")])
    d.want(
        "alks-r157.r79.lane-change",
        "fail",
        "The signal has been on for less than two seconds when it reaches over the line.",
    )
    out.append(d)

    d = on(Drive("de_alks_hard_stop_of_the_system_l", s.xml, 34))
    d.says(8.0, "minimal_risk_manoeuvre", "on")
    d.ego(s.way(3), 60, [(0, 26), (8.5, 26), (13.2, 0), (34, 0)], lamps=[(0, "off"), (13.5, "hazard")])
    d.want("alks-r157.mrm", "fail", "The minimal risk manoeuvre brakes at 5.5 m/s2 for nearly five seconds.")
    d.want("alks-r157.mrm-hazards", "fail", "The hazard lights come on when it stands only.")
    d.want("alks-r157.emergency", "fail", "It brakes harder than 5 m/s2 and declares no emergency manoeuvre.")
    d.want("comfort.jerk-iso15622", "fail", "At 26 m/s the braking grows by 5.5 m/s2 within a second.")
    d.want("comfort.decel-iso15622", "fail", "The mean over two seconds is 5.5 m/s2.")
    out.append(d)

    d = on(Drive("de_alks_touches_one_that_cut_in_l", s.xml, 26))
    d.ego(s.way(3), 60, [(0, 22), (9.3, 22), (9.5, 21.6), (9.7, 16), (13, 10)])
    d.add("c", "car", s.way(2), 150, [(0, 13), (9.5, 13), (9.7, 18)], [(0, 0), (4.5, 0), (8.0, -3.75)])
    d.want(
        "alks-r157.cut-in",
        "fail",
        "A car comes in with nearly four seconds left; the system brakes too late and touches it.",
    )
    d.want("ukhc.no-collision", "fail", "The boxes meet.")
    d.want("ukhc.contact-signature", "fail", "It loses 5.6 m/s in 0.2 s at the contact.")
    d.want("criticality.ttc", "fail", "It closes in at 9 m/s until they touch.")
    out.append(d)
    return out


def declared() -> list[Drive]:
    """What is declared."""
    out = []
    s = bahn(start=(0.0, 0.0, 2.9))
    d = Drive("de_declared_no_look_before_lane_change_l", s.xml, 30)
    d.ego(s.way(2), 60, 31.0, [(0, 0), (9, 0), (13, 3.75)], lamps=[(0, "off"), (6, "left"), (13, "off")])
    d.says(1.0, "mirror_check", "right").says(3.0, "chosen_speed", "26.0; roadworks").says(5.5, "mirror_check", "left")
    d.says(15.0, "blind_spot_check", "left").says(20.0, "chosen_speed", "32.0")
    d.want("declared.r163.checks-before-pull-out", "fail", "It looks over its shoulder only after the lane change.")
    d.want("declared.r125.chosen-speed-kept", "fail", "It chooses 26 m/s and does 31 for seventeen seconds.")
    d.want("declared.r152.speed-reason", "fail", "The second choice of speed names no reason.")
    d.want("declared.r161.mirrors-before-signal", "pass", "It looked into the left mirror half a second before.")
    out.append(d)

    s = town(nation="de", length=300, start=(0.0, 0.0, 2.9))
    d = Drive("de_declared_reverses_with_half_a_look_l", s.xml, 24)
    d.ego(s.way(1, wrong=True), 120, [(0, 0), (8, 0), (9.5, 1.5), (15, 1.5), (17, 0)], reverse=True)
    d.says(1.0, "blind_spot_check").says(6.0, "mirror_check")
    d.want(
        "declared.r202.checks-before-reversing",
        "fail",
        "The blind spot check is seven seconds old when it begins to reverse.",
    )
    out.append(d)
    return out
