"""Lane changes and passing on German motorways."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Actor, Drive
from tests.outsiders.fourteenth.lines import go, side
from tests.outsiders.fourteenth.places import FAST, MID, SLOW, motorway
from tests.outsiders.fourteenth.scenes import alone, on, others_in_right


def german_lanes_a() -> Iterator[Drive]:
    de = motorway("de", at=(0.0, 0.0, 3.0))
    g6 = "stvo.rg6"
    i2 = "stvo.ri2"
    out = side((0.0, SLOW), (5.0, SLOW), (9.0, MID))

    def fast(back: float, v: float) -> list[Actor]:
        return [
            Actor("fast", "car", on(de.course, go(300.0 - back, (0, v), (6.5, v), (9, 25.0 if v > 35 else v)), MID))
        ]

    def passing(v: float) -> Drive:
        return alone(
            f"de-right-{round(v)}",
            f"{v} m/s past one of 28 m/s in the lane to the left",
            de,
            ((0, v),),
            [(i2, "fail", "no queue")],
            others=others_in_right(1, 130, 0, 28.0, MID, de),
        )

    yield alone(
        "de-pull-out",
        "pulls out 30 m ahead of one of 36 m/s",
        de,
        ((0, 25),),
        [(g6, "fail", "about 30 m at 36 behind 25 m/s: 46 asked for")],
        u=out,
        s0=300.0,
        others=fast(110.0, 36.0),
        seconds=12.0,
    )
    yield alone(
        "de-pull-out-room",
        "pulls out 150 m ahead of one of 30 m/s",
        de,
        ((0, 27),),
        [(g6, "pass", "over 120 m")],
        u=out,
        s0=300.0,
        others=fast(170.0, 30.0),
    )
    yield alone(
        "de-pull-out-wake",
        "pulls out 25 m ahead of a lorry that is slower",
        de,
        ((0, 28),),
        [(g6, "pass", "a slower one needs no more than a few metres")],
        u=out,
        s0=300.0,
        others=[Actor("lorry", "truck", on(de.course, go(285.0, (0, 22)), MID))],
    )
    yield passing(33.0)
    yield passing(31.0)


def german_lanes_b() -> Iterator[Drive]:
    de = motorway("de", at=(0.0, 0.0, 3.0))
    i2 = "stvo.ri2"
    yield alone(
        "de-right-queue",
        "18 m/s past a queue of 14 m/s on the left",
        de,
        ((0, 18),),
        [(i2, "pass", "queue, 4 m/s faster")],
        others=others_in_right(5, 130, 25, 14.0, MID, de),
        seconds=30.0,
    )
    yield alone(
        "de-right-queue-fast",
        "24 m/s past a queue of 14 m/s on the left",
        de,
        ((0, 24),),
        [(i2, "fail", "10 m/s faster, 5.55 allowed")],
        others=others_in_right(5, 150, 25, 14.0, MID, de),
    )
    yield alone(
        "de-right-two",
        "18 m/s past two of 14 m/s on the left",
        de,
        ((0, 18),),
        [(i2, "fail", "two are no queue")],
        others=others_in_right(2, 130, 30, 14.0, MID, de),
        seconds=30.0,
    )
    yield alone(
        "de-left-pass",
        "33 m/s past one of 28 m/s on the right",
        de,
        ((0, 33),),
        [(i2, "not fail", "overtakes on the left")],
        u=FAST,
        others=others_in_right(1, 130, 0, 28.0, MID, de),
    )


def german_lanes() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from german_lanes_a()
    yield from german_lanes_b()
