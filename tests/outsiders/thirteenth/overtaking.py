"""Overtaking on roads of two lanes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from tests.outsiders.log import Size
from tests.outsiders.thirteenth.drive import DE, FAR, TURNED, Drive, Wanted, draw
from tests.outsiders.thirteenth.motion import SIZES, Across, Speeds
from tests.outsiders.thirteenth.street import AWAY, N, two_way

LORRY: Size = (16.0, 2.5, 3.8)


def overtake(
    name: str,
    wanted: Wanted,
    *,
    gap: float = 35,
    v: float | Speeds = 14,
    vm: float = 21,
    t_out: float = 4,
    t_back: float = 14,
    out: float = AWAY,
    lead: float = 13,
    lead_cls: str = "car",
    cls: str = "car",
    oncoming: tuple[float, float] | None = None,
    behind: tuple[float, float, float] | None = None,
    second: tuple[float, float] | None = None,
    signs: Sequence[tuple[float, str]] = (),
    seconds: float = 26,
    noise: float = 0,
    **more: Any,
) -> Drive:
    """The ego pulls out at t_out and is back three seconds after t_back; oncoming, behind, second: where, how fast (and u)."""
    lht = more.pop("lht", True)
    road = {key: more.pop(key) for key in ("frame", "curve", "middle") if key in more}
    street = two_way(lht, length=1800, **road)
    for s, number in signs:
        street.road.add_sign(s, 4.5, number)
    size, led = SIZES[cls], LORRY if lead_cls == "truck" else SIZES[lead_cls]
    speeds = [(0, v), (t_out - 1, v), (t_out + 4, vm), (seconds, vm)] if isinstance(v, int | float) else v
    across: Across = [(0, N), (t_out, N), (t_out + 3, out), (t_back, out), (t_back + 3, N)]
    first, last = ("right", "left") if lht else ("left", "right")
    lamps = [(0, "off"), (t_out - 3, first), (t_out + 2, "off"), (t_back - 2, last), (t_back + 3, "off")]
    actors = [
        street.go("ego", cls, 200, speeds, across, indicator=lamps, noise=noise),
        street.go("lead", lead_cls, 200 + gap + (size[0] or 0) / 2 + (led[0] or 0) / 2, lead, N, size=led),
    ]
    if oncoming:
        actors.append(street.come("onc", "car", *oncoming, N))
    if behind:
        actors.append(street.go("beh", "car", 200 + behind[0], *behind[1:]))
    if second:
        actors.append(street.go("ahead2", "car", 200 + second[0], second[1], N))
    return draw(name, street.map, actors, seconds, wanted, **more)


def with_oncoming() -> Iterator[Drive]:
    """Somebody comes, or nobody."""
    yield overtake(
        "ot_clear",
        [
            ("ukhc.r143.direction", "pass", "own lane but for the overtake"),
            ("ukhc.no-collision", "pass", "3.5 m apart"),
            ("ukhc.r162.safe-distance-ahead", "not fail", "nobody oncoming"),
            ("ukhc.r126.thinking-gap", "pass", "35 m at 14 m/s"),
        ],
    )
    yield overtake(
        "ot_clear_turned",
        [
            ("ukhc.r143.direction", "not fail", "overtake"),
            ("ukhc.no-collision", "pass", "apart"),
            ("ukhc.overtake-zone", "not fail", "empty road"),
        ],
        frame=TURNED,
        curve=1 / 900,
    )
    yield overtake(
        "ot_head_on",
        [
            ("ukhc.no-collision", "fail", "meets it head on"),
            ("ukhc.r162.safe-distance-ahead", "fail", "they meet before the ego is back"),
            ("ukhc.r126.ds-disjoint", "fail", "closing with 42 m/s in one lane"),
            ("rss.opposite", "fail", "same"),
            ("ukhc.overtake-zone", "fail", "no spare"),
        ],
        oncoming=(780, 21),
    )
    yield overtake(
        "ot_near_head_on",
        [
            ("ukhc.r126.ds-disjoint", "fail", "20 m apart at 42 m/s closing as the ego gets back"),
            ("rss.opposite", "fail", "same"),
            ("ukhc.overtake-zone", "fail", "back with under 0.5 s to go"),
            ("ukhc.no-collision", "pass", "just back"),
        ],
        oncoming=(848, 21),
    )
    yield overtake(
        "ot_far_oncoming",
        [
            ("ukhc.r162.safe-distance-ahead", "not fail", "1500 m"),
            ("rss.opposite", "not fail", "far"),
            ("ukhc.overtake-zone", "not fail", "far"),
        ],
        oncoming=(1750, 20),
        seconds=24,
    )


def seen_late() -> Iterator[Drive]:
    """Somebody comes: low rates, noise, two overtaken."""
    yield overtake(
        "ot_head_on_late_seen",
        [("ukhc.r126.ds-disjoint", "fail", "very close oncoming"), ("rss.opposite", "fail", "same")],
        oncoming=(800, 22),
        frame=FAR,
        hz=5,
        noise=0.02,
    )
    yield overtake(
        "x_late_oncoming",
        [
            ("ukhc.r126.ds-disjoint", "fail", "very close oncoming"),
            ("rss.opposite", "fail", "same"),
            ("ukhc.no-collision", "fail", "head on"),
        ],
        oncoming=(800, 22),
        curve=1 / 700,
        lht=False,
        conditions=DE,
        noise=0.02,
    )
    yield overtake(
        "x_overtake_two",
        [("ukhc.r126.ds-disjoint", "fail", "both passed, oncoming then 31 m off"), ("rss.opposite", "fail", "same")],
        second=(62, 13),
        t_back=18,
        seconds=28,
        oncoming=(1010, 20),
    )


def room() -> Iterator[Drive]:
    """The room before, behind and between."""
    yield overtake(
        "ot_tailgate",
        [
            ("ukhc.r163.pull-out-separation", "fail", "5 m at 18 m/s"),
            ("ukhc.r126.thinking-gap", "fail", "5 m < 12 m"),
            ("criticality.thw", "fail", "0.28 s"),
        ],
        gap=5,
        v=18,
        lead=18,
        vm=25,
        t_out=5,
        t_back=14,
    )
    yield overtake(
        "ot_was_overtaken",
        [
            ("ukhc.no-collision", "fail", "run into from behind or beside"),
            (
                "ukhc.r162.not-being-overtaken",
                "fail",
                "28 m/s, about 40 m behind in the passing lane when the ego moves out: 3 s",
            ),
        ],
        behind=(-70, 28, AWAY),
        v=14,
        t_out=2,
        vm=18,
        seconds=24,
    )
    yield overtake(
        "ot_behind_far",
        [("ukhc.r162.not-being-overtaken", "not fail", "190 m behind at the same speed")],
        behind=(-190, 15, AWAY),
        v=14,
        t_out=3,
    )
    yield overtake(
        "ot_squeeze",
        [("ukhc.r162.return-gap", "fail", "9.5 m between the two slow cars, an ego of 4.5 m")],
        second=(35 + 4.5 + 14, 13),
        v=[(0, 14), (3, 14), (6, 20), (9.25, 20), (11.75, 13), (26, 13)],
        t_back=11.5,
        seconds=24,
    )


def lines() -> Iterator[Drive]:
    """The line in the middle."""
    yield overtake(
        "ot_solid",
        [("ukhc.r129.no-cross-solid", "fail", "moving car at 13 m/s overtaken over a solid line")],
        middle="solid",
    )
    yield overtake(
        "ot_solid_de",
        [("ukhc.r129.no-cross-solid", "fail", "moving car overtaken over a solid line (no law asked of the rule)")],
        middle="solid",
        lht=False,
        conditions=DE,
    )
    yield overtake(
        "ot_solid_slow_bike_11mph",
        [("ukhc.r129.no-cross-solid", "fail", "cyclist at 5.2 m/s = 11.6 mph, over 10 mph")],
        middle="solid",
        lead_cls="bicycle",
        lead=5.2,
        gap=60,
        v=12,
        vm=12,
        t_out=4,
        t_back=13,
    )
    yield overtake(
        "ot_solid_bike_9mph",
        [
            ("ukhc.r129.no-cross-solid", "not fail", "cyclist at 8.5 mph may be passed"),
            ("ukhc.r163.cyclist", "pass", "2.3 m clear"),
        ],
        middle="solid",
        lead_cls="bicycle",
        lead=3.8,
        gap=60,
        v=11,
        vm=11,
        t_out=3,
        t_back=13,
    )
    yield overtake(
        "ot_solid_begins",
        [
            (
                "ukhc.r128.back-before-solid",
                "fail",
                "crossed on the broken line at about 270, solid from 330, back past 440",
            )
        ],
        middle=[(0.0, "broken"), (330.0, "solid")],
    )
    yield overtake(
        "ot_back_before_solid",
        [
            ("ukhc.r128.back-before-solid", "not fail", "back at about 530, solid from 620"),
            ("ukhc.r129.no-cross-solid", "not fail", "never over the solid"),
        ],
        middle=[(0.0, "broken"), (620.0, "solid")],
    )
    yield overtake(
        "ot_motorcycle",
        [("ukhc.r129.no-cross-solid", "fail", "motorcycle wholly over the line")],
        cls="motorcycle",
        out=-0.9,
        middle="solid",
    )


def signs() -> Iterator[Drive]:
    """No-overtaking signs."""
    yield overtake(
        "ot_sign", [("ukhc.r165.no-overtaking-sign", "fail", "sign at 150, pulled out after 250")], signs=[(150, "276")]
    )
    yield overtake(
        "ot_sign_truck",
        [("ukhc.r165.no-overtaking-sign", "fail", "sign before")],
        signs=[(150, "276")],
        lead_cls="truck",
        lead=12,
        gap=45,
        frame=TURNED,
    )
    yield overtake(
        "ot_sign_between",
        [("ukhc.r165.no-overtaking-sign", "fail", "out before the sign, drew level after it")],
        signs=[(290, "276")],
        lead=13,
    )
    yield overtake(
        "ot_sign_ended",
        [("ukhc.r165.no-overtaking-sign", "not fail", "sign lifted at 180 before the start")],
        signs=[(120, "276"), (180, "280")],
    )
    yield overtake(
        "ot_sign_parked",
        [("ukhc.r165.no-overtaking-sign", "not fail", "a standing car")],
        signs=[(150, "276")],
        lead=0.0,
        gap=90,
        v=12,
        vm=12,
        t_out=4,
        t_back=12,
        seconds=20,
    )
    yield overtake(
        "ot_reckless",
        [
            ("ukhc.r129.no-cross-solid", "fail", "solid"),
            ("ukhc.r165.no-overtaking-sign", "fail", "sign"),
            ("ukhc.r163.pull-out-separation", "fail", "6 m"),
        ],
        gap=6,
        v=17,
        lead=17,
        oncoming=(720, 20),
        middle="solid",
        signs=[(150, "276")],
        t_out=3,
        vm=25,
        t_back=12,
        hz=20,
    )
