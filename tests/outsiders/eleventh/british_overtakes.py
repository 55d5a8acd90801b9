"""Great Britain: overtakes on country roads."""

from __future__ import annotations

from tests.outsiders.eleventh.drive import Drive
from tests.outsiders.eleventh.motion import Actor, actor, ego, late, towed, track
from tests.outsiders.eleventh.places import STRAIGHT, N, near, out
from tests.outsiders.eleventh.road import GB, signal, simple


def british_overtakes() -> list[Drive]:
    plain, way = simple(GB, STRAIGHT, speed=60)
    tractor = track(way, 26, 130, 8, lat=near(GB))
    ban = signal("9", 120, 4.2, "632", "gb")
    three_lanes, by_three = simple(GB, STRAIGHT, speed=60, middle=[(0, "broken")], near=1, far=2)
    solid, by_solid = simple(GB, STRAIGHT, speed=60, middle=[(0, "solid")])
    turns_solid, by_turn = simple(GB, STRAIGHT, speed=60, middle=[(0, "broken"), (260, "solid")])
    solid_far_off, by_far = simple(GB, STRAIGHT, speed=60, middle=[(0, "broken"), (620, "solid")])
    banned, by_ban = simple(GB, STRAIGHT, speed=60, signals=ban)
    end = ban + signal("10", 180, 4.2, "x", "gb", name="overtaking_end")
    ended, by_end = simple(GB, STRAIGHT, speed=60, signals=end)
    return [
        Drive(
            "gb_overtake_oncoming",
            plain,
            [
                ego(track(way, 18, 60, 20, lat=out(3, 9))),
                actor("t", "truck", track(way, 18, 100, 13, lat=near(GB))),
                actor("o", "car", track(way, 18, 512, 22, lat=near(GB, -N), way=-1)),
            ],
            expect=[
                ("ukhc.r162.safe-distance-ahead", "fail", "the oncoming car passes while the ego is still coming back"),
                ("ukhc.overtake-zone", "fail", "less than half a second to spare"),
                ("ukhc.r126.ds-disjoint", "fail", "both could not have stopped"),
                ("ukhc.r163.pull-out-separation", "fail", "pulls out 11 m behind at 20 m/s"),
            ],
        ),
        Drive(
            "gb_overtake_ample",
            plain,
            [
                ego(track(way, 30, 20, 22, lat=out(4, 16.5, takes=3))),
                actor("t", "truck", track(way, 30, 180, 10, lat=near(GB))),
                actor("o", "car", track(way, 30, 1380, 20, lat=near(GB, -N), way=-1)),
            ],
            expect=[
                ("ukhc.r162.safe-distance-ahead", "pass", "hundreds of metres left"),
                ("ukhc.overtake-zone", "pass", "seconds to spare"),
                ("ukhc.r163.pull-out-separation", "pass", "over 100 m behind"),
                ("ukhc.r129.no-cross-solid", "pass", "broken line"),
            ],
        ),
        Drive(
            "gb_overtake_solid",
            solid,
            [
                ego(track(by_solid, 24, 20, 20, lat=out(4, 14))),
                actor("b", "bus", track(by_solid, 24, 110, 11, lat=near(GB))),
            ],
            expect=[("ukhc.r129.no-cross-solid", "fail", "overtakes a bus at 11 m/s over a solid line")],
        ),
        Drive(
            "gb_overtake_late_return",
            turns_solid,
            [
                ego(track(by_turn, 26, 20, 20, lat=out(6, 15))),
                actor("b", "car", track(by_turn, 26, 120, 11, lat=near(GB))),
            ],
            expect=[
                (
                    "ukhc.r128.back-before-solid",
                    "fail",
                    "still out at 260 m, where the line turns solid; back after 350 m",
                ),
                ("ukhc.r129.no-cross-solid", "fail", "straddles the solid line as it comes back"),
            ],
        ),
        Drive(
            "gb_overtake_before_solid",
            solid_far_off,
            [
                ego(track(by_far, 26, 20, 20, lat=out(4, 17))),
                actor("b", "car", track(by_far, 26, 150, 9, lat=near(GB))),
            ],
            expect=[
                ("ukhc.r128.back-before-solid", "pass", "back at about 410 m, solid from 620 m"),
                ("ukhc.r129.no-cross-solid", "pass", "never over the solid part"),
            ],
        ),
        Drive(
            "gb_tractor_trailer",
            plain,
            [
                ego(track(way, 26, 29, 18, [(9, -2.5), (13, 0)], out(5, 12))),
                Actor("tr", "vehicle", (5.0, 2.2, 2.9), tractor),
                Actor("w", "trailer", (7.0, 2.4, 2.8), towed(tractor, 6.6)),
                actor("k", "car", track(way, 26, 145, 8, lat=near(GB))),
                actor("o", "car", track(way, 26, 1300, 18, lat=near(GB, -N), way=-1)),
            ],
            expect=[
                (
                    "ukhc.r162.return-gap",
                    "fail",
                    "10 m between the tractor and the car that it follows: no room for a car with thinking distances",
                ),
                ("ukhc.r162.safe-distance-ahead", "pass", "the road is free for 800 m"),
            ],
        ),
        Drive(
            "gb_no_overtaking",
            banned,
            [
                ego(track(by_ban, 24, 80, 21, lat=out(7, 17.5))),
                actor("b", "van", track(by_ban, 24, 200, 12, lat=near(GB))),
            ],
            expect=[("ukhc.r165.no-overtaking-sign", "fail", "pulls out at 220 m, after the sign at 120 m")],
        ),
        Drive(
            "gb_no_overtaking_end",
            ended,
            [
                ego(track(by_end, 24, 80, 21, lat=out(7, 17.5))),
                actor("b", "van", track(by_end, 24, 200, 12, lat=near(GB))),
            ],
            expect=[("ukhc.r165.no-overtaking-sign", "not fail", "the ban ends at 180 m, it pulls out at 230 m")],
        ),
        Drive(
            "gb_spoils_overtake",
            plain,
            [
                ego(track(way, 24, 100, 17, [(5, 0.9), (9, 0)], near(GB))),
                actor("o", "car", track(way, 24, 50, 22, lat=[(0, N), (2, N), (4.5, -N)])),
            ],
            expect=[("ukhc.r168.when-overtaken", "fail", "speeds up from 17 to 20.6 m/s while a car overtakes it")],
        ),
        Drive(
            "gb_lets_overtake",
            plain,
            [
                ego(track(way, 24, 100, 16, [(6, -0.5), (9, 0)], near(GB))),
                actor("o", "motorcycle", track(way, 24, 40, 24, lat=out(2, 13))),
            ],
            expect=[("ukhc.r168.when-overtaken", "pass", "keeps its course and lets off a little")],
        ),
        Drive(
            "gb_pulls_out_on_overtaker",
            plain,
            [
                ego(track(way, 22, 120, 17, lat=out(5, 14))),
                actor("b", "car", track(way, 22, 175, 10, lat=near(GB))),
                actor("f", "car", track(way, 22, 55, 25, [(6, -3), (9, 0)], lat=[(0, N), (1, N), (3, -N)])),
            ],
            expect=[
                (
                    "ukhc.r162.not-being-overtaken",
                    "fail",
                    "a car in the passing lane comes up at 25 m/s, some 20 m behind",
                )
            ],
        ),
        Drive(
            "gb_overtake_late_oncoming",
            plain,
            [
                ego(track(way, 24, 60, 19, lat=out(3.5, 11))),
                actor("b", "car", track(way, 24, 110, 11, lat=near(GB))),
                actor("o", None, late(track(way, 24, 620, 24, lat=near(GB, -N), way=-1), 6.0)),
            ],
            expect=[
                (
                    "ukhc.r162.safe-distance-ahead",
                    "not pass",
                    "the oncoming one, in the way at the end, is recorded only after the pull-out",
                ),
                ("rss.opposite", "fail", "ego in the opposing lane and the other near, both fast"),
            ],
        ),
        Drive(
            "gb_aborted_overtake",
            plain,
            [
                ego(track(way, 24, 60, 20, [(7, -1.7), (10, 0)], lat=[(0, N), (4, N), (6.5, -N), (7.5, -N), (10, N)])),
                actor("v", "van", track(way, 24, 110, 15, lat=near(GB))),
            ],
            expect=[
                ("ukhc.no-collision", "pass", "looks out behind a van and comes back"),
                ("criticality.thw", "fail", "about 0.3 s behind it"),
            ],
        ),
        Drive(
            "gb_overtake_three_lanes",
            three_lanes,
            [
                ego(track(by_three, 24, 60, 20, lat=out(5, 15))),
                actor("b", "van", track(by_three, 24, 121, 12.5, lat=near(GB))),
            ],
            expect=[
                ("ukhc.no-collision", "pass", "clear"),
                ("ukhc.r162.not-being-overtaken", "not fail", "nobody is behind"),
                ("ukhc.r163.pull-out-separation", "fail", "18 m behind at 20 m/s"),
            ],
        ),
    ]
