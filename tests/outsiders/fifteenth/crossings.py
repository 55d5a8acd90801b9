"""Pedestrian crossings, with and without lights."""

from tests.outsiders.fifteenth.drives import Drive
from tests.outsiders.fifteenth.motions import across, go, stop, weave
from tests.outsiders.fifteenth.roads import HOME, Place, World, crosswalk, sign, stop_line, straight

TURNED = Place(-700.0, 2500.0, 2.1)
AHEAD = weave(1, [(-90, 1.75), (600, 1.75)])


def zebra(side: int = 1, place: Place = HOME, name: str = "zebra", lanes: int = 1, lit: bool = False) -> World:
    """Return a street whose crossing reaches from x = 98.5 to 101.5."""
    w = straight(side, 800, 13.41, "town", lanes=lanes, place=place)
    w.roads[0].objects = [crosswalk(700, 200.0, 3.5 * lanes, name)]
    if lit:
        w.roads[0].objects.append(stop_line(701, 196.0, side))
        w.roads[0].signals = [sign(601, 196.0, side, "1000001", "OpenDRIVE")]
    return w


def zebras() -> list[Drive]:
    out = []
    d = Drive("zebra_on", zebra(), 14, "walker on the ego's half when it goes onto the crossing")
    d.add("ego", "car", AHEAD, 10.0, 90)
    d.add(
        "ped", "pedestrian", across(100, -6, 6), [(0, 1.2), (9.0, 1.2), (9.2, 0), (12, 0), (12.5, 1.2)], 6.4 - 1.2 * 9.1
    )
    out.append(
        d.want("ukhc.r195.zebra-on", "fail", "walker stands at y = 0.4, on the ego's half, as the front comes onto it")
    )
    d = Drive("zebra_yield", zebra(place=TURNED), 30, "waits until the walker is over")
    d.add("ego", "car", AHEAD, go(stop(10, 2, 95.5), 7, 1.5, 9), 90)
    d.add("ped", "pedestrian", across(100, -6, 9), 1.3, -5.0)
    out.append(d.want("ukhc.r195.zebra-on", "pass"))
    d = Drive("zebra_from_near", zebra(), 14, "walker stepped onto the near half 0.7 m before", hz=20)
    d.add("ego", "bus", AHEAD, 9.0, 90)
    d.add("ped", "pedestrian", across(100, 6, -6), 1.2, 0.0)
    d.users[-1].s0 = 6 - 2.6 - 1.2 * (98.5 - 6) / 9
    out.append(d.want("ukhc.r195.zebra-on", "fail", "walker at y = 2.6, on the near half"))
    d = Drive("zebra_late_track", zebra(place=TURNED), 14, "the walker is seen only a moment before")
    d.add("ego", "car", AHEAD, 10.0, 90)
    d.add("ped", "pedestrian", across(100, -6, 6), 1.2, 6 + 1.5 - 1.2 * 9.62, seen=(9.0, 30))
    out.append(d.want("ukhc.r195.zebra-on", "fail", "on the half as the front comes"))
    d = Drive("zebra_stand", zebra(), 30, "stands on the crossing for 8 s for nobody")
    d.add("ego", "car", AHEAD, go(stop(9, 2, 100.0), 8, 1.5, 9), 90)
    out.append(d.want("ukhc.r191.no-stopping", "fail", "8 s"))
    d = Drive("zebra_queue", zebra(), 40, "stands on the crossing behind a queue for 15 s")
    d.add("ego", "car", AHEAD, go(stop(8, 2, 101.0), 15, 1.5, 8), 90)
    d.add("lead", "van", AHEAD, go(stop(8, 2, 108.5 - 22), 15, 1.5, 9), 112)
    out.append(d.want("ukhc.r192.keep-clear", "fail", "15 s, 2.5 m behind"))
    return out


def overtakes() -> list[Drive]:
    out = []
    way = weave(1, [(-90, 1.75), (30, 1.75), (60, -1.75), (120, -1.75), (150, 1.75), (600, 1.75)])
    d = Drive("zigzag_overtake", zebra(), 22, "gets past a moving car 8 m before the crossing")
    d.add("ego", "car", way, 12.0, 60).add("slow", "car", AHEAD, 6.0, 0.0)
    d.users[-1].s0 = 90 + 90 - 6.0 * (90 + 30) / 12
    out.append(d.want("ukhc.r191.crossing-overtake", "fail", "fronts level about x = 90"))
    d = Drive("zigzag_stopped", zebra(), 22, "passes a car that has stopped to give way to a walker")
    d.add("ego", "car", way, 9.0, 60)
    d.add("slow", "car", AHEAD, go(stop(6, 2, 94.5 - 60), 9, 1, 6), 150)
    d.add("ped", "pedestrian", across(100, 8, -8), [(0, 0), (6, 0), (6.5, 1.3)], 3.5)
    out.append(d.want("ukhc.r191.crossing-overtake", "not pass", "it had stopped for the walker"))
    d = Drive("zigzag_parked", zebra(place=TURNED), 22, "passes a parked car before the crossing, nobody there")
    d.add("ego", "car", way, 9.0, 60).add("parked", "car", weave(1, [(-90, 2.4), (600, 2.4)]), 0.0, 178)
    out.append(d.want("ukhc.r191.crossing-overtake", "not fail", "a parked one may be passed"))
    two = weave(1, [(-90, 1.75), (600, 1.75)])
    d = Drive("zigzag_two_lanes", zebra(lanes=2), 22, "in the outer of two lanes past a moving car at the crossing")
    d.add("ego", "car", two, 10.0, 60)
    d.add("slow", "motorcycle", weave(1, [(-90, 5.25), (600, 5.25)]), 5.0, 90 + 93 - 5.0 * 12.0)
    return [*out, d.want("ukhc.r191.crossing-overtake", "fail", "past it within the zig-zags")]


def signalled() -> list[Drive]:
    out = []
    d = Drive("pelican_red", zebra(name="crosswalk", lit=True), 16, "onto the crossing 1.5 s after red")
    d.add("ego", "car", AHEAD, 10.0, 90).light_at("601", (0, "green"), (4.5, "amber"), (7.5, "red"))
    out.append(d.want("ukhc.r196.pelican", "fail", "line at 9.35 s, red from 7.5 s").want("ukhc.r175.red", "fail"))
    d = Drive("pelican_flash", zebra(name="crosswalk", lit=True), 16, "amber flashes and a walker is on its half")
    d.add("ego", "car", AHEAD, 10.0, 90).add("ped", "pedestrian", across(100, -6, 6), 1.2, 6 + 1.4 - 1.2 * 9.62)
    d.light_at("601", (0, "red"), (6, "flashing"))
    out.append(d.want("ukhc.r196.pelican", "fail"))
    d = Drive("pelican_still", zebra(name="crosswalk", lit=True), 30, "green, but somebody is still crossing")
    d.add("ego", "car", AHEAD, go(stop(9, 2, 91.0), 4, 2, 8), 90)
    t = stop(9, 2, 91.0)[-1][0] + 4 + (4.9 * 2 / 2) ** 0.5
    d.add("ped", "pedestrian", across(100, -6, 6), 1.0, 6 + 0.6 - 1.0 * t)
    d.light_at("601", (0, "red"), (t - 3, "green"))
    out.append(d.want("ukhc.r198.still-crossing", "fail", "walker at y = 0.6 on the ego's half"))
    return out


def drives() -> list[Drive]:
    return [*zebras(), *overtakes(), *signalled()]
