"""Junctions: stop signs, lights, turns, and who is in the way."""

import numpy as np

from tests.outsiders.fifteenth.drives import Drive
from tests.outsiders.fifteenth.motions import go, stop, turn
from tests.outsiders.fifteenth.roads import HOME, Place, World, junction, sign, stop_line

FAR = Place(4210.0, -880.0, 0.7)
SLOWER = [(0.0, 9.0), (5.0, 9.0), (7.0, 5.0), (30.0, 5.0)]
LINE = 186.6
"""Where the middle of a car is whose front is at the stop line, along the path."""


def signed(side: int, place: Place = HOME, speed: float = 13.41) -> World:
    extra = {"W": ([stop_line(500, 199.0, side)], [sign(501, 198.0, side, "206")])}
    return junction(side, place=place, extra=extra, speed=speed)


def lit(side: int, place: Place = HOME, speed: float = 13.41) -> World:
    light = sign(601, 199.0, side, "1000001", "OpenDRIVE")
    return junction(side, place=place, extra={"W": ([stop_line(500, 199.0, side)], [light])}, speed=speed)


def stop_signs() -> list[Drive]:
    out = []
    d = Drive("stop_rolled", signed(1), 22, "rolls over the stop line at 2 m/s")
    d.add("ego", "car", turn(1, "W", "N"), [(0, 9), (5, 9), (8, 2), (14, 2), (17, 6)], 120)
    out.append(d.want("ukhc.r171.stop-sign", "fail", "slowest 2 m/s"))
    d = Drive("stop_kept", signed(1, place=FAR), 26, "halts 0.4 m before the line for 3 s")
    d.add("ego", "car", turn(1, "W", "N"), go(stop(9, 2, LINE - 0.4 - 120), 3, 1.5, 6), 120)
    out.append(d.want("ukhc.r171.stop-sign", "pass").want("performance.precise-stop", "pass"))
    d = Drive("stop_far_before", signed(1), 28, "halts 14 m before the line, rolls over it at 4 m/s")
    d.add("ego", "car", turn(1, "W", "N"), go(stop(9, 2, LINE - 14 - 120), 3, 1.5, 4), 120)
    out.append(d.want("ukhc.r171.stop-sign", "fail", "the halt is three cars before the line"))
    d = Drive("stop_over_line", signed(1, place=FAR), 28, "halts with the front 1.2 m over the line")
    d.add("ego", "car", turn(1, "W", "N"), go(stop(9, 2, LINE + 1.2 - 120), 3, 1.5, 6), 120)
    out.append(d.want("ukhc.r171.stop-sign", "fail", "over the line before it stood"))
    d = Drive("stop_creep_slow", signed(1), 30, "creeps over at 0.4 m/s, never at rest", hz=5)
    d.add("ego", "car", turn(1, "W", "N"), [(0, 8), (6, 8), (9.5, 0.4), (14.5, 0.4), (18, 5)], 120)
    out.append(d.want("ukhc.r171.stop-sign", "fail", "slowest 0.4 m/s"))
    d = Drive("de_stop_short", signed(-1, speed=13.89), 26, "stands 0.5 s at the stop line", nation="de")
    d.add("ego", "car", turn(-1, "W", "S"), go(stop(9, 2, LINE - 0.4 - 120), 0.5, 1.5, 6), 120)
    out.append(d.want("stvo.rin1", "fail", "0.5 s of 1 s").want("ukhc.r171.stop-sign", "pass"))
    return out


def lights() -> list[Drive]:
    out = []
    d = Drive("red_front_only", lit(1), 40, "stands on red with the front 0.9 m over the line, the rear far before it")
    d.add("ego", "bus", turn(1, "W", "E"), go(stop(9, 2, 188.85 + 0.9 - 6 - 100), 12, 1, 8), 100)
    d.light_at("601", (0, "red"), (23, "green"))
    out.append(d.want("ukhc.r175.red", "fail").want("performance.precise-stop", "fail", "0.9 m over"))
    d = Drive("red_precise", lit(1), 40, "stands on red 0.3 m before the line")
    d.add("ego", "car", turn(1, "W", "E"), go(stop(9, 2, LINE - 0.3 - 100), 15, 1.2, 8), 100).light_at(
        "601", (0, "red"), (24, "green")
    )
    out.append(d.want("ukhc.r175.red", "pass").want("performance.precise-stop", "pass"))
    d = Drive("red_amber_go", lit(1, FAR), 40, "goes on red and amber, a second before green")
    k = go(stop(9, 2, LINE - 0.4 - 100), 8, 2, 8)
    d.add("ego", "car", turn(1, "W", "N"), [*k[:-1], (k[-1][0], 6.0)], 100)
    d.light_at("601", (0, "red"), (k[2][0] + 7.5, "red_amber"), (k[2][0] + 9.9, "green"))
    out.append(d.want("ukhc.r175.red", "fail", "over the line on red with amber"))
    d = Drive("green_blocked", lit(1), 40, "goes on green behind a queue and stands in the junction")
    d.add("ego", "car", turn(1, "W", "E"), go(stop(9, 2, 194.0 - 110), 16, 1.2, 6), 110)
    d.add("lead", "car", turn(1, "W", "E"), go(stop(9, 2.5, 200.5 - 140), 17, 1.2, 7), 140)
    d.light_at("601", (0, "green"))
    out.append(d.want("ukhc.r176.green-exit-clear", "fail", "some 16 s with half the car in the junction"))
    return out


def turns() -> list[Drive]:
    out = []
    path = turn(1, "W", "S")
    d = Drive("right_turn_close", junction(1), 20, "turns right before an oncoming car")
    d.add("ego", "car", path, SLOWER, 130).add("onc", "car", turn(1, "E", "W"), 12.0, 70.6)
    out.append(d.want("ukhc.r180.right-turn-gap", "fail", "0.8 s"))
    d = Drive(
        "right_turn_made_brake", junction(1), 24, "turns right; the oncoming car brakes at 5 m/s2 to leave it time"
    )
    d.add("ego", "car", path, SLOWER, 130)
    d.add("onc", "car", turn(1, "E", "W"), [(0, 13), (7.2, 13), (9.2, 3), (11, 3), (16, 11)], 80)
    out.append(d.want("ukhc.r180.right-turn-gap", "fail", "it had to brake at 5 m/s2"))
    d = Drive(
        "de_left_turn_close",
        junction(-1, place=FAR, speed=13.89),
        20,
        "left before an oncoming motorcycle",
        nation="de",
    )
    d.add("ego", "van", turn(-1, "W", "N"), SLOWER, 130)
    d.add("onc", "motorcycle", turn(-1, "E", "W"), 12.0, 69.0)
    out.append(d.want("ukhc.r180.right-turn-gap", "fail"))
    d = Drive("corner_cut", junction(1), 20, "cuts the corner by 2 m")
    d.add("ego", "car", turn(1, "W", "S", out=-1.2, back=1.75), SLOWER, 130)
    out.append(d.want("ukhc.r180.corner-cut", "fail", "2.1 m over the middle where it enters"))
    d = Drive("left_wide", junction(1), 14, "swings wide to the left: 2.5 m to the kerb")
    d.add("ego", "car", turn(1, "W", "N", out=0.1, back=0.3), [(0, 9), (5, 9), (7, 4.5), (30, 4.5)], 130)
    out.append(d.want("ukhc.r183.keep-in", "fail", "3.5 - 0.1 - 0.9 = 2.5 m left"))
    return out


def people() -> list[Drive]:
    out = []
    slow = [(0.0, 9.0), (5.0, 9.0), (7.0, 4.5), (30.0, 4.5)]
    d = Drive("left_hook", junction(1), 20, "passes a cyclist and turns left across it")
    d.add("ego", "car", turn(1, "W", "N"), slow, 130)
    d.add("bike", "bicycle", turn(1, "W", "E", u=3.3), 5.0, 142)
    d.want("ukhc.h3.no-cut-across", "fail", "the bicycle comes 0.5 s after")
    out.append(d.want("ukhc.r182.no-pass-before-turn", "fail", "got ahead of it a few seconds before"))
    d = Drive("right_before_bike", junction(1, place=FAR), 20, "turns right before an oncoming cyclist")
    d.add("ego", "car", turn(1, "W", "S"), SLOWER, 130)
    d.add("bike", "bicycle", turn(1, "E", "W", u=2.6), 7.0, 124.0)
    out.append(d.want("ukhc.h3.no-cut-across", "fail"))
    d = Drive("left_walker", junction(1), 20, "turns left right before somebody who crosses the side road")
    d.add("ego", "car", turn(1, "W", "N"), slow, 130)
    d.add("ped", "pedestrian", np.array([[9.0, 15.0], [-9.0, 15.0]]), 1.5, -10.05)
    out.append(d.want("ukhc.h2.turn-pedestrian", "fail", "1 s after"))
    d = Drive("junction_blocked", junction(1), 40, "stands in a junction without lights behind a queue")
    d.add("ego", "car", turn(1, "W", "E"), go(stop(9, 2, 196.0 - 110), 16, 1.2, 6), 110)
    d.add("lead", "car", turn(1, "W", "E"), go(stop(9, 2.5, 203.0 - 140), 17, 1.2, 7), 140)
    out.append(d.want("ukhc.r151.side-roads-clear", "fail", "16 s"))
    d = Drive("pet_crossing", junction(1), 20, "crosses 0.8 s before another car from the side", hz=20)
    d.add("ego", "car", turn(1, "W", "E"), 10.0, 110)
    d.add("side", "car", turn(1, "S", "N"), 10.0, 100.0)
    out.append(d.want("criticality.pet", "fail"))
    return out


def drives() -> list[Drive]:
    return [*stop_signs(), *lights(), *turns(), *people()]
