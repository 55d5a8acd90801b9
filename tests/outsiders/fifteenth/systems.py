"""What is asked of an automated driver: distances, cut-ins, emergencies, minimal risk manoeuvres and lane changes."""

from tests.outsiders.fifteenth.drives import Drive
from tests.outsiders.fifteenth.motorways import EAST, change, lane
from tests.outsiders.fifteenth.roads import HOME, motorway


def m(name: str, time: float, what: str, side: int = -1) -> Drive:
    """Return a drive on a motorway of three lanes and 70 mph."""
    return Drive(
        name,
        motorway(side, 3, 2600.0, 31.29, EAST if len(name) % 2 else HOME),
        time,
        what,
        nation="de" if side < 0 else "gb",
    )


def drives() -> list[Drive]:
    out = []
    d = m("alks_close", 25, "12 m behind at 13 m/s, engaged").say(0, "engaged", "on")
    d.add("ego", "car", lane(-1, 3), 13.0, 60).add("lead", "car", lane(-1, 3), 13.0, 76.5)
    out.append(d.want("alks-r157.follow-gap", "fail", "12 m of 19 m"))
    d = m("alks_cut_in_hit", 20, "a slower car cuts in with time enough, the ego hits it").say(0, "engaged", "on")
    d.add("ego", "car", lane(-1, 3), 16.0, 28).add("cut", "car", change(-1, 105, 150, 2, 3), 10.0, 110)
    out.append(d.want("alks-r157.cut-in", "fail").want("ukhc.no-collision", "fail"))
    d = m("alks_cut_in_kept_close", 30, "the gap is not made again", side=1).say(0, "engaged", "on")
    d.add("ego", "car", lane(1, 3), 14.0, 60).add(
        "cut", "car", change(1, 60, 110, 2, 3), [(0, 16), (5, 16), (6, 14)], 66
    )
    out.append(d.want("alks-r157.cut-in-gap", "fail", "some 13 m of 21 m for 20 s"))
    hard = [(0.0, 25.0), (8.0, 25.0), (8.4, 23.6), (10.4, 9.6), (10.8, 8.2), (20.0, 8.2)]
    d = m("alks_emergency_untold", 20, "brakes at 7 m/s2").say(0, "engaged", "on").say(0, "emergency_manoeuvre", "off")
    d.add("ego", "car", lane(-1, 3), hard, 60)
    out.append(d.want("alks-r157.emergency", "fail", "7 m/s2"))
    d.want("comfort.decel-iso15622", "fail", "7 m/s2 over two seconds")
    d = m("alks_mrm_hard", 25, "minimal risk manoeuvre at 6 m/s2, hazard lights late", side=1)
    d.say(0, "engaged", "on").say(0, "minimal_risk_manoeuvre", "off").say(6, "minimal_risk_manoeuvre", "on")
    d.add("ego", "car", lane(1, 3), [(0, 24), (7, 24), (11, 0), (25, 0)], 60, lamp=[(0, "off"), (9, "hazard")])
    out.append(d.want("alks-r157.mrm", "fail", "6 m/s2 for 4 s").want("alks-r157.mrm-hazards", "fail", "3 s late"))
    for name, lit, way, rule in (
        ("alks_change_hasty", 7.6, 80.0, "alks-r157.r79.lane-change"),
        ("alks_change_long", 9.0, 420.0, "alks-r157.r79.lane-change-done"),
    ):
        d = m(name, 30, f"lane change over {way:.0f} m, the indicator on at {lit} s").say(0, "engaged", "on")
        lamp = [(0.0, "off"), (lit, "left"), (20.0, "off")]
        d.add("ego", "car", change(-1, 140, 140 + way, 2, 1), 20.0, 90, lamp=lamp)
        out.append(d.want(rule, "fail"))
    return out
