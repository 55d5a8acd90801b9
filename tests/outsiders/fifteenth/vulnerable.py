"""Cyclists, horses and a dog, passed with and without room."""

from tests.outsiders.fifteenth.drives import Drive
from tests.outsiders.fifteenth.motions import weave
from tests.outsiders.fifteenth.roads import HOME, Place, straight

VALE = Place(900.0, 15000.0, 3.0)


def passing(
    name: str, u: float, v: float, kind: str | None, w: float, *, out: float = 120.0, back: float = 205.0
) -> Drive:
    """Return a drive past somebody at u = 3, going w."""
    d = Drive(name, straight(1, 1600, 17.88, place=VALE if len(name) % 2 else HOME), 22, f"passes at u = {u}, {v} m/s")
    way = weave(1, [(-90, 1.75), (out, 1.75), (out + 40, u), (back, u), (back + 40, 1.75), (1400, 1.75)])
    d.add("ego", "car", way, v, 70)
    size = "animal" if kind == "animal" else "bicycle"
    return d.add("other", kind, weave(1, [(-90, 3.0), (1400, 3.0)]), w, 190, size=size)


def drives() -> list[Drive]:
    c, h, s = "ukhc.r163.cyclist", "ukhc.r215.horse", "stvo.s5-passing"
    out = []
    out.append(passing("cyclist_room", 0.15, 12.0, "bicycle", 5.0).want(c, "pass", "1.65 m at 27 mph"))
    out.append(
        passing("cyclist_room_fast", 0.1, 15.5, "bicycle", 5.0, out=90.0, back=190.0).want(
            c, "fail", "1.7 m at 35 mph: more is asked"
        )
    )
    out.append(passing("cyclist_unclassed", 0.6, 12.0, None, 5.0).want(c, "not pass", "may be a cyclist, 1.2 m"))
    d = passing("cyclist_lost", 0.7, 12.0, "bicycle", 5.0)
    d.users[1].lost = (16.6, 17.0)
    out.append(d.want(c, "fail", "1.1 m, but for a gap of 0.4 s in its track"))
    out.append(passing("horse_fast", -0.4, 8.0, "animal", 1.6, out=65.0, back=150.0).want(h, "fail", "8 m/s"))
    out.append(
        passing("horse_kept", -0.5, 4.2, "animal", 1.2, out=60.0, back=140.0).want(h, "not fail", "2.2 m at 4.2 m/s")
    )
    out[-1].users[0].s0, out[-1].time = 140.0, 35.0
    d = passing("dog_passed", 0.9, 9.0, "animal", 1.6, out=65.0, back=150.0)
    d.users[1].size = (0.8, 0.35, 0.6)
    out.append(d.want(h, "not fail", "a dog is no horse"))
    for name, u, verdict in (("de_cyclist_open", 0.0, "fail"), ("de_cyclist_open_kept", -0.5, "pass")):
        w = straight(-1, 1600, 27.78)
        d = Drive(name, w, 22, f"passes a cyclist at u = {u}", nation="de", more={"area": "open"}, hz=20)
        d.add(
            "ego", "car", weave(-1, [(-90, 1.75), (120, 1.75), (160, u), (205, u), (245, 1.75), (1400, 1.75)]), 12.0, 70
        )
        d.add("other", "bicycle", weave(-1, [(-90, 3.0), (1400, 3.0)]), 5.0, 190)
        out.append(d.want(s, verdict, f"{3.0 - 0.3 - 0.9 - u:.2f} m"))
    return out
