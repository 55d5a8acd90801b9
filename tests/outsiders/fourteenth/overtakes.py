"""Overtaking on two-lane roads."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Actor, Drive
from tests.outsiders.fourteenth.lines import go, side
from tests.outsiders.fourteenth.places import OPP, OWN, street
from tests.outsiders.fourteenth.scenes import on, pass_by


def overtakes_a() -> Iterator[Drive]:
    gb = street("gb", length=1600.0, at=(300.0, 100.0, 0.5))
    de = street("de", length=1600.0, at=(-300.0, 100.0, -2.2))
    far = "ukhc.r162.safe-distance-ahead"
    opp = "rss.opposite"
    a = "ukhc.r126.ds-av-out-of-ov"
    d = "ukhc.r126.ds-disjoint"
    b = "ukhc.r126.ds-ov-out-of-av"
    ban = street("gb", length=1600.0, at=(300.0, 100.0, 0.5))
    ban.road.sign("no1", 60.0, "632", country="GB", name="no_overtaking")
    forced = Actor(
        "oncoming",
        "car",
        on(gb.course, go(660.0, (0, 22), (7.5, 22), (11, 2), (16, 2), (20, 12), back=True), OPP, back=True),
    )
    sign = "ukhc.r165.no-overtaking-sign"
    yield pass_by(
        "pass-near-miss",
        gb,
        "oncoming meets the ego a second after it is back",
        [
            (opp, "fail", "in one lane at 65 m, 44 m/s towards each other"),
            (d, "fail", "under 90 m, both need about 100 m"),
        ],
        oncoming=812.0,
    )
    yield pass_by(
        "pass-forces",
        gb,
        "the oncoming one has to brake hard for the overtaking ego",
        [
            (far, "fail", "without its braking they meet 3 s before the ego is back"),
            ("ukhc.overtake-zone", "fail", "nothing to spare"),
            (opp, "fail", "close, in one lane"),
        ],
        more=[forced],
    )
    yield pass_by(
        "pass-far",
        gb,
        "nobody comes for 1.4 km",
        [(far, "not fail", "far enough"), (opp, "not fail", "1 km away"), ("ukhc.no-collision", "pass", "apart")],
        oncoming=1500.0,
        v_on=14.0,
    )
    yield pass_by(
        "pass-de-near-miss",
        de,
        "the same in Germany",
        [
            (opp, "fail", "both in one lane, close"),
            (b, "fail", "the oncoming one within the stopping distance"),
            (a, "fail", "the ego within the other's stopping distance"),
        ],
        oncoming=765.0,
    )
    yield pass_by("pass-banned", ban, "after a no-overtaking sign", [(sign, "fail", "sign 60 m before its start")])


def overtakes_b() -> Iterator[Drive]:
    gb = street("gb", length=1600.0, at=(300.0, 100.0, 0.5))
    lifted = street("gb", length=1600.0, at=(300.0, 100.0, 0.5))
    lifted.road.sign("no1", 20.0, "632", country="GB", name="no_overtaking")
    lifted.road.sign("no2", 130.0, "280", name="overtaking_end")
    behind_one = Actor(
        "behind",
        "motorcycle",
        on(gb.course, go(38.0, (0, 31), (4.8, 31), (6.8, 20)), side((0.0, OWN), (1.0, OWN), (3.0, OPP), (16.0, OPP))),
    )
    sign = "ukhc.r165.no-overtaking-sign"
    go_ok = [
        (0.5, "overtake_no_go", None),
        (3.0, "overtake_go", None),
        (3.0, "confidence", "0.97"),
        (2.5, "mirror_check", None),
        (3.5, "blind_spot_check", None),
    ]
    g = "declared.r162.go-before-overtaking"
    c = "declared.r166.confidence-at-commit"
    m = "declared.r163.checks-before-pull-out"
    yield pass_by(
        "pass-ban-lifted", lifted, "after the sign that ends it", [(sign, "not fail", "ban lifted before it pulls out")]
    )
    yield pass_by(
        "pass-while-passed",
        gb,
        "a motorcycle is already out to overtake the ego",
        [("ukhc.r162.not-being-overtaken", "fail", "9 m/s faster, under 25 m behind")],
        more=[behind_one],
    )
    yield pass_by(
        "pass-late-out",
        gb,
        "pulls out 5 m behind the slow one",
        [("ukhc.r163.pull-out-separation", "fail", "5 m at 22 m/s")],
        gap=5.0,
    )
    yield pass_by(
        "pass-declared",
        gb,
        "go, sure, mirrors, blind spot",
        [(g, "pass", "go 1 s before"), (c, "pass", "0.97"), (m, "pass", "both, in order")],
        events=go_ok,
    )


def overtakes_c() -> Iterator[Drive]:
    gb = street("gb", length=1600.0, at=(300.0, 100.0, 0.5))
    no_go = [
        (3.0, "overtake_go", None),
        (5.6, "overtake_no_go", None),
        (5.0, "confidence", "0.6"),
        (5.2, "mirror_check", None),
        (2.4, "blind_spot_check", None),
    ]
    g = "declared.r162.go-before-overtaking"
    c = "declared.r166.confidence-at-commit"
    m = "declared.r163.checks-before-pull-out"
    yield pass_by(
        "pass-declared-not",
        gb,
        "no-go just before, unsure, blind spot before the mirrors and old",
        [
            (g, "fail", "the last one was no-go"),
            (c, "fail", "0.6"),
            (m, "fail", "no blind spot check after the mirrors"),
        ],
        events=sorted(no_go),
        out_t=6.0,
        back_t=15.0,
        seconds=22.0,
    )


def overtakes() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from overtakes_a()
    yield from overtakes_b()
    yield from overtakes_c()
