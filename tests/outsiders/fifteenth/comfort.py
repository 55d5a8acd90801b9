"""Comfort and criticality: how hard it brakes, how near it comes."""

from tests.outsiders.fifteenth.drives import Drive
from tests.outsiders.fifteenth.motions import weave
from tests.outsiders.fifteenth.overtaking import OWN
from tests.outsiders.fifteenth.roads import straight


def comfort() -> list[Drive]:
    out = []
    d = Drive("comfort_launch", straight(1, 1600, 31.29), 22, "speeds up at 3.5 m/s2 up to 27 m/s")
    d.add("ego", "motorcycle", OWN, [(0, 6), (5, 6), (11, 27), (22, 27)], 40)
    out.append(d.want("comfort.accel-iso15622", "fail", "3.5 m/s2 of 2 m/s2 at 20 m/s").want("comfort.nuplan", "fail"))
    d = Drive("comfort_stamp", straight(1, 1600, 26.82), 20, "stamps on the brake: 6 m/s2 within half a second", hz=20)
    d.add("ego", "car", OWN, [(0, 25), (8, 25), (8.5, 23.5), (10.5, 11.5), (11, 10), (20, 10)], 40)
    d.want("comfort.jerk-iso15622", "fail", "6 m/s3").want("comfort.decel-iso15622", "fail", "6 of about 4 m/s2")
    out.append(d.want("comfort.nuplan", "fail"))
    d = Drive("comfort_bend", straight(1, 620, 26.82, curv=1 / 110), 14, "a bus at 18 m/s in a bend of 108 m")
    d.add("ego", "bus", weave(1, [(-90, 1.75), (450, 1.75)], 1 / 110), 18.0, 30)
    out.append(d.want("comfort.lateral", "fail", f"{324 / 108.25:.2f} of 2.5 m/s2"))
    return out


def criticality() -> list[Drive]:
    out = []
    d = Drive("closing_late", straight(1, 1600, 26.82), 22, "closes in at 12 m/s and brakes at the last moment")
    d.add("ego", "car", OWN, [(0, 22), (7, 22), (8.7, 10), (22, 10)], 60).add(
        "lead", "truck", OWN, 10.0, 60 + 8.25 + 12 * 7 + 12
    )
    d.want("criticality.ttc", "fail", "12 m at 12 m/s: 1 s").want("criticality.drac", "fail", "6 m/s2")
    out.append(d.want("criticality.ttb", "fail"))
    d = Drive("lead_brakes", straight(1, 1600, 26.82), 22, "the one ahead brakes at 6 m/s2, the ego late")
    d.add("ego", "car", OWN, [(0, 20), (8.5, 20), (10.75, 2), (22, 2)], 60)
    d.add("lead", "car", OWN, [(0, 20), (6.5, 20), (9.5, 2), (22, 2)], 60 + 4.5 + 33)
    out.append(d.want("criticality.mttc", "fail"))
    d = Drive("following_calm", straight(-1, 1600, 27.78), 22, "50 m behind", nation="de")
    way = weave(-1, [(-90, 1.75), (1400, 1.75)])
    d.add("ego", "car", way, 20.0, 20).add("lead", "truck", way, 20.0, 20 + 8.25 + 50)
    d.want("criticality.ttc", "pass").want("criticality.thw", "pass").want("criticality.drac", "pass")
    return [*out, d.want("criticality.mttc", "pass").want("ukhc.r126.thinking-gap", "pass")]


def drives() -> list[Drive]:
    return [*comfort(), *criticality()]
