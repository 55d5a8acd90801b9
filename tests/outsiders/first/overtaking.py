"""Overtaking on a country road."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tests.outsiders.first.chapter import Spec, scene
from tests.outsiders.first.maps import RURAL, rural
from tests.outsiders.first.movement import Actor, against, ahead, car, out_and_back, still
from tests.outsiders.first.road import Map, sign

LAMPS_OUT = [(0.0, "off"), (0.0, "right"), (5.0, "off"), (14.0, "left"), (20.0, "off")]


def overtaking() -> Iterator[Spec]:
    """A lorry at 12 m/s, the ego at 20 m/s: it takes 16 s and 320 m to be past."""

    def ego(m: Map = RURAL, **more: Any) -> Actor:
        return car(out_and_back(m, 200, 230, 310, 520, 600), 20.0, lamps=LAMPS_OUT, **more)

    def lorry(m: Map = RURAL, **more: Any) -> Actor:
        return car(ahead(m, 300), 12.0, "truck", **more)

    safe = "r162.safe-distance-ahead"
    yield scene(
        "overtake_nobody_coming",
        "The ego overtakes a slow lorry on an empty road.",
        f"not fail {safe} overtake-zone r162.not-being-overtaken r162.return-gap r143.direction r129.no-cross-solid "
        "| pass no-collision r163.pull-out-separation",
        RURAL,
        [ego(), lorry()],
        30,
    )
    yield scene(
        "overtake_last_moment",
        "The ego overtakes a lorry and is back half a second before it would meet an oncoming car.",
        f"fail {safe} overtake-zone r126.ds-disjoint rss.opposite | pass no-collision",
        RURAL,
        [ego(), lorry(), car(against(RURAL, 1058), 24.0)],
        28,
    )
    yield scene(
        "overtake_oncoming_brakes",
        "The ego overtakes a lorry so that the oncoming car must stop dead.",
        f"fail {safe}",
        RURAL,
        [ego(), lorry(), car(against(RURAL, 950), [(0, 24), (10, 24), (14.8, 0)])],
        30,
    )
    yield scene(
        "overtake_oncoming_unseen_size",
        "The same as at the last moment, but the log knows no size of the oncoming car.",
        f"not pass {safe} overtake-zone",
        RURAL,
        [ego(), lorry(), car(against(RURAL, 1070), 24.0, no_size=True)],
        28,
    )
    yield scene(
        "overtake_last_moment_2hz",
        "The same at the last moment, logged twice a second with noise.",
        f"fail {safe} rss.opposite",
        RURAL,
        [ego(noise=0.05), lorry(noise=0.05), car(against(RURAL, 1070), 24.0, noise=0.05)],
        28,
        2.0,
    )
    abort = car(
        RURAL.along((200, 1.75), (230, 1.75), (290, -1), (300, -1), (350, 1.75), (2000, 1.75)),
        [(0, 20), (4.5, 20), (8, 10), (12, 12)],
    )
    yield scene(
        "overtake_begun_and_given_up",
        "The ego pulls out with an oncoming car 300 m away, sees it, and falls back behind the lorry.",
        f"fail {safe} | pass no-collision",
        RURAL,
        [abort, lorry(), car(against(RURAL, 654), 24.0)],
        18,
    )
    short = rural(1, length=420)
    cut = car(out_and_back(short, 200, 230, 310, 330, 400), [(0, 20), (7, 20), (12, 12)])
    yield scene(
        "overtake_where_map_ends",
        "The ego pulls out to overtake, beyond its map's end somebody comes; it falls back at once.",
        f"not pass {safe}",
        short,
        [cut, car(ahead(RURAL, 300), 12.0, "truck"), car(np.array([(700, -1.75, 0), (421, -1.75, 0)]), 24.0)],
        11,
    )
    yield scene(
        "overtake_while_overtaken",
        "The ego pulls out in front of a car that is already overtaking both and has to brake hard.",
        "fail r162.not-being-overtaken | pass no-collision",
        RURAL,
        [ego(), lorry(), car(ahead(RURAL, 130, -1.75), [(0, 32), (3, 32), (5, 20)])],
        14,
    )
    train = [lorry(), car(ahead(RURAL, 319), 12.0, "truck"), car(ahead(RURAL, 338), 12.0, "truck")]
    yield scene(
        "overtake_no_gap_to_return",
        "The ego overtakes one of three lorries that drive bumper to bumper and squeezes in between them.",
        "fail r162.return-gap",
        RURAL,
        [car(out_and_back(RURAL, 200, 230, 310, 490, 545), [(0, 20), (11.7, 20), (15.7, 12)]), *train],
        24,
    )
    solid = rural(1, [(0.0, "solid solid")])
    yield scene(
        "solid_past_cyclist",
        "The ego goes over the solid line to pass a cyclist who rides at 9 mph, with room.",
        "not fail r129.no-cross-solid | pass r163.cyclist",
        solid,
        [
            car(out_and_back(solid, 200, 220, 260, 290, 335, out=-0.9), 10.0),
            car(ahead(solid, 250, 2.9), 4.0, "bicycle"),
        ],
        25,
    )
    yield scene(
        "solid_past_quick_cyclist",
        "The ego goes over the solid line to overtake a cyclist who rides at 20 mph.",
        "fail r129.no-cross-solid",
        solid,
        [
            car(out_and_back(solid, 200, 230, 310, 520, 600, out=-1.2), 18.0),
            car(ahead(solid, 270, 2.9), 9.0, "bicycle"),
        ],
        28,
    )
    mine = rural(1, [(0.0, "broken solid")])
    yield scene(
        "double_line_broken_on_my_side",
        "The ego overtakes across a double line that is broken on its own side.",
        "not fail r129.no-cross-solid r143.direction",
        mine,
        [ego(mine), lorry(mine)],
        28,
    )
    theirs = rural(1, [(0.0, "solid broken")])
    yield scene(
        "double_line_solid_on_my_side",
        "The ego overtakes across a double line that is solid on its own side.",
        "fail r129.no-cross-solid",
        theirs,
        [ego(theirs), lorry(theirs)],
        28,
    )
    for name, solid_from, verdict in (("late", 450.0, "fail"), ("in_time", 900.0, "pass")):
        m = rural(1, [(0.0, "broken"), (solid_from, "solid solid")])
        yield scene(
            f"back_before_solid_{name}",
            f"The ego overtakes; the line becomes solid at {solid_from:.0f} m, it is back at 600 m.",
            f"{verdict} r128.back-before-solid r129.no-cross-solid",
            m,
            [ego(m), lorry(m)],
            32,
        )
    for nation, kind in (("GB", "632"), ("DE", "276")):
        m = rural(1, signs=[sign(5, 100.0, 4.5, "+", kind, nation)])
        yield scene(
            f"no_overtaking_sign_{nation}",
            f"The ego overtakes after a no-overtaking sign (map's code {kind} of {nation}).",
            "fail r165.no-overtaking-sign",
            m,
            [car(out_and_back(m, 60, 230, 310, 520, 600), 20.0), car(ahead(m, 216), 12.0, "truck")],
            36,
        )
    m = rural(1, signs=[sign(5, 100.0, 4.5, "+", "276", "DE")])
    yield scene(
        "no_overtaking_sign_parked",
        "After a no-overtaking sign the ego goes round a parked van.",
        "not fail r165.no-overtaking-sign r143.direction",
        m,
        [car(out_and_back(m, 60, 180, 230, 260, 310, out=-0.8), 12.0), still("van", 245, 2.2)],
        25,
    )
    passer = car(out_and_back(RURAL, 120, 160, 260, 680, 780), [(0, 26), (12, 26), (14, 31)])
    yield scene(
        "speeds_up_when_overtaken",
        "The ego speeds up while a car overtakes it.",
        "fail r168.when-overtaken",
        RURAL,
        [car(ahead(RURAL, 200), [(0, 20), (10, 20), (15, 25.5)]), passer],
        28,
    )
    cutter = car(out_and_back(RURAL, 120, 160, 260, 520, 590), [(0, 26), (14.5, 26), (16.6, 20)])
    yield scene(
        "stays_close_after_cut_in",
        "A car overtakes, pulls in 9 m ahead, and the ego stays there for 20 s.",
        "fail r168.drop-back r126.thinking-gap criticality.thw rss.longitudinal",
        RURAL,
        [car(ahead(RURAL, 200), 20.0), cutter],
        40,
    )
    yield scene(
        "drops_back_after_cut_in",
        "A car overtakes and pulls in 9 m ahead; the ego drops back to three seconds.",
        "pass r168.drop-back | not fail r126.thinking-gap",
        RURAL,
        [car(ahead(RURAL, 200), [(0, 20), (16, 20), (20, 14)]), cutter],
        36,
    )
    yield scene(
        "pulls_out_at_bumper",
        "The ego drives 7 m behind a lorry and pulls out from there.",
        "fail r163.pull-out-separation r126.stopping-gap",
        RURAL,
        [
            car(out_and_back(RURAL, 284.5, 420, 500, 800, 880), [(0, 16), (11, 16), (15, 24)]),
            car(ahead(RURAL, 300), 16.0, "truck"),
        ],
        36,
    )
