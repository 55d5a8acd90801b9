"""What the ego declares: speeds, looks and decisions."""

from tests.outsiders.fifteenth.drives import Drive
from tests.outsiders.fifteenth.motions import weave
from tests.outsiders.fifteenth.overtaking import OWN, out_and_back, road
from tests.outsiders.fifteenth.roads import straight


def drives() -> list[Drive]:
    out = []
    d = Drive("speed_said", straight(1, 1600, 26.82), 25, "says 15 m/s and drives 18; the second names no reason")
    d.say(1, "chosen_speed", "15; wet road").say(15, "chosen_speed", "19")
    d.add("ego", "car", OWN, [(0, 14), (7, 14), (9, 18)], 40)
    d.want("declared.r125.chosen-speed-kept", "fail", "18 of 15 m/s at 9 to 15 s")
    out.append(d.want("declared.r152.speed-reason", "fail"))
    d = Drive("overtake_said_no", road(), 20, "decides not to, and then pulls out in doubt")
    d.say(0, "overtake_go").say(1.2, "overtake_no_go").say(1.2, "confidence", "0.6").say(0.2, "mirror_check", "right")
    d.add("ego", "car", out_and_back(40, 324), 22.0, 90, lamp=[(0, "off"), (1.0, "right"), (6, "off")])
    d.add("slow", "car", OWN, 14.0, 150)
    d.want("declared.r162.go-before-overtaking", "fail").want("declared.r166.confidence-at-commit", "fail")
    d.want("declared.r163.checks-before-pull-out", "not pass", "no look over the shoulder")
    out.append(d.want("declared.r161.mirrors-before-signal", "pass"))
    d = Drive("overtake_said_yes", road(), 20, "says and looks all that is asked for")
    d.say(0.4, "mirror_check", "right").say(1.0, "blind_spot_check", "right").say(1.1, "confidence", "0.95").say(
        1.2, "overtake_go"
    )
    d.add("ego", "car", out_and_back(50, 334), 22.0, 90, lamp=[(0, "off"), (1.3, "right"), (6, "off")])
    d.add("slow", "car", OWN, 14.0, 155)
    d.want("declared.r162.go-before-overtaking", "pass").want("declared.r166.confidence-at-commit", "pass")
    out.append(
        d.want("declared.r163.checks-before-pull-out", "pass").want("declared.r161.mirrors-before-signal", "pass")
    )
    d = Drive("reverse_unlooked", straight(1, 800, 13.41), 20, "looks into the mirrors only 8 s before it reverses")
    d.say(0.5, "mirror_check").say(0.6, "blind_spot_check").add(
        "ego", "car", OWN, [(0, 0), (9, 0), (11, -2), (16, -2), (17, 0)], 300
    )
    out.append(d.want("declared.r202.checks-before-reversing", "fail", "8.5 s old"))
    d = Drive("signal_unlooked", straight(1, 1600, 17.88, lanes=2), 25, "looks after it signals, the blind spot never")
    d.say(12.0, "mirror_check", "right").say(0.2, "blind_spot_check", "right")
    d.add(
        "ego",
        "car",
        weave(1, [(-90, 5.25), (110, 5.25), (170, 1.75), (1400, 1.75)]),
        15.0,
        20,
        lamp=[(0, "off"), (10, "right"), (17, "off")],
    )
    d.want("declared.r161.mirrors-before-signal", "fail", "the look comes 2 s after")
    return [*out, d.want("declared.r163.checks-before-pull-out", "fail")]
