"""Others come in ahead: the automated driver, and dropping back."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Drive
from tests.outsiders.fourteenth.scenes import comes_in


def cut_ins_a() -> Iterator[Drive]:
    hit = comes_in(
        "alks-cut-in-hit",
        "cuts in 40 m ahead at 9 m/s less; the ego does nothing",
        ((0, 22),),
        ((0, 13),),
        70.0,
        [
            ("alks-r157.cut-in", "fail", "time to collision over 3 s at the cut-in; struck within 5 s"),
            ("ukhc.no-collision", "fail", "runs into it"),
        ],
        seconds=14.0,
        start=2.0,
    )
    braked = comes_in(
        "alks-cut-in-braked",
        "cuts in at 7 m/s less, the ego brakes",
        ((0, 22), (6, 22), (9, 13)),
        ((0, 15),),
        75.0,
        [("alks-r157.cut-in", "pass", "no contact"), ("ukhc.no-collision", "pass", "apart")],
        start=2.0,
    )
    never = comes_in(
        "alks-cut-in-gap-kept-short",
        "comes in 8 m ahead, the gap stays so",
        ((0, 13.9),),
        ((0, 13.9),),
        8.0,
        [("alks-r157.cut-in-gap", "fail", "8 m for 20 s, table 20.8 m")],
    )
    anew = comes_in(
        "alks-cut-in-gap-anew",
        "comes in 12 m ahead; the ego drops back",
        ((0, 13.9), (6, 13.9), (9, 11.5), (12, 11.5), (15, 13)),
        ((0, 13.9),),
        12.0,
        [("alks-r157.cut-in-gap", "pass", "over 22 m within 8 s")],
    )
    gone = comes_in(
        "alks-cut-in-gone",
        "comes in 9 m ahead and goes on to the next lane at once",
        ((0, 13.9),),
        ((0, 14.2),),
        9.0,
        [("alks-r157.cut-in-gap", "pass", "gone after 4 s")],
        gone=9.5,
    )
    yield hit
    yield braked
    yield never
    yield anew
    yield gone


def cut_ins_b() -> Iterator[Drive]:
    gone_late = comes_in(
        "alks-cut-in-gone-late",
        "comes in 7 m ahead and is gone only after 13 s",
        ((0, 13.9),),
        ((0, 13.9),),
        7.0,
        [("alks-r157.cut-in-gap", "fail", "gap never there again, gone too late")],
        gone=18.5,
        hz=5.0,
    )
    drop = comes_in(
        "drop-back-not",
        "comes in 1 s ahead on a British motorway, the ego stays",
        ((0, 27),),
        ((0, 27),),
        26.0,
        [("ukhc.r168.drop-back", "fail", "1 s for 19 s, two asked for")],
        nation="gb",
        env={},
    )
    back = comes_in(
        "drop-back",
        "comes in 1.1 s ahead, the ego drops back",
        ((0, 27), (6, 27), (8, 22.5), (13, 22.5), (15, 25.5)),
        ((0, 27),),
        29.0,
        [("ukhc.r168.drop-back", "pass", "over 2 s within 9 s")],
        nation="gb",
        env={},
    )
    wet = comes_in(
        "drop-back-wet",
        "comes in 1.2 s ahead in the wet; the ego makes 2.4 s of it: four asked for",
        ((0, 27), (6, 27), (8, 24), (17, 24), (19, 27)),
        ((0, 27),),
        30.0,
        [("ukhc.r168.drop-back", "fail", "under 2.5 s after 10 s, wet asks for 4 s")],
        nation="gb",
        env={"weather": "wet"},
    )
    yield gone_late
    yield drop
    yield back
    yield wet


def cut_ins() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from cut_ins_a()
    yield from cut_ins_b()
