"""Germany: motorways."""

from __future__ import annotations

from tests.outsiders.ninth.drive import Drive, draw
from tests.outsiders.ninth.maps import AUTOBAHN_M, autobahn, lane
from tests.outsiders.ninth.movement import ego, who


def german_motorways() -> list[Drive]:
    """Return its drives."""
    return [
        draw(
            "de_autobahn_draengler_k",
            "The ego follows a car at 133 km/h, 6.5 m behind it.",
            "fail stvo.rg1 r126.thinking-gap",
            autobahn(),
            [ego(lane(1), 60, 37), who("vor", "car", lane(1), 71, 37)],
            24,
        ),
        draw(
            "de_autobahn_bremst_grundlos_k",
            "The ego brakes with 4 m/s2 on an empty motorway.",
            "fail stvo.rg2",
            autobahn(120),
            [ego(lane(0), 60, [(8, 32), (12, 15), (20, 25)]), who("weit", "car", lane(1), 700, 32)],
            24,
        ),
        draw(
            "de_autobahn_troedelt_k",
            "The ego drives at 50 km/h on an empty motorway of 130 km/h.",
            "fail stvo.rg4",
            autobahn(130),
            [ego(lane(0), 60, 14)],
            40,
            rate=5,
        ),
        draw(
            "de_autobahn_schert_aus_k",
            "The ego changes lane before a car that is 15 m/s faster.",
            "fail stvo.rg6",
            autobahn(),
            [
                ego(
                    lane(0), 100, 25, [(5.2, 0), (8.2, AUTOBAHN_M)], indicator=[(0, "off"), (5, "offside"), (9, "off")]
                ),
                who("schnell", "car", lane(1), 220 - 240, [(6.3, 40), (8.2, 24.6)]),
                who("lkw", "truck", lane(0), 200, 22),
            ],
            22,
        ),
        draw(
            "de_autobahn_haelt_an_k",
            "The ego stops in its lane on an empty motorway.",
            "fail stvo.ri1 r240.no-stopping",
            autobahn(130),
            [ego(lane(0), 60, [(6, 26), (17, 0)])],
            36,
        ),
        draw(
            "de_autobahn_rechts_vorbei_k",
            "The ego passes a van on its right at 133 km/h.",
            "fail stvo.ri2",
            autobahn(),
            [ego(lane(0), 60, 37), who("links", "van", lane(1), 150, 29)],
            24,
        ),
        draw(
            "de_autobahn_setzt_zurueck_k",
            "The ego stops on a motorway and reverses.",
            "fail stvo.ri3 r263.no-reverse",
            autobahn(100),
            [ego(lane(0), 260, [(4, 20), (12, 0), (15, 0), (17, -3), (25, -3), (27, 0), (30, 0)])],
            34,
        ),
        draw(
            "de_geisterfahrer_zwei_hertz_k",
            "The ego drives against the traffic of a motorway; the log has two steps a second.",
            "fail stvo.ri3 r143.direction",
            autobahn(),
            [ego(lane(1, against=True), 100, 26), who("a", "car", lane(1), 500, 30, [(15, 0), (18, -AUTOBAHN_M)])],
            26,
            rate=2,
        ),
        draw(
            "de_lkw_abstand_22_m_k",
            "A lorry follows another at 79 km/h, 22 m behind it.",
            "fail stvo.s4-truck | pass stvo.rg1",
            autobahn(),
            [ego(lane(0), 60, 22, kind="truck"), who("vor", "truck", lane(0), 93, 22)],
            24,
            vehicle_class="goods_over_7t5",
        ),
        draw(
            "de_autobahn_kolonne_rechts_k",
            "The ego passes two slow queues on the right with little more speed.",
            "pass stvo.ri2 | not fail stvo.rg4",
            autobahn(120, lanes=3),
            [
                ego(lane(0, 3), 60, 13),
                *(
                    each
                    for i in range(6)
                    for each in (
                        who(f"l{i}", "car", lane(1, 3), 90 + 13 * i, 10),
                        who(f"m{i}", "car" if i % 2 else "van", lane(2, 3), 86 + 14 * i, 10.4),
                    )
                ),
            ],
            34,
        ),
        draw(
            "de_standstreifen_am_stau_vorbei_k",
            "The ego drives along the hard shoulder past a jam.",
            "fail r269.hard-shoulder",
            autobahn(100),
            [
                ego(lane(0, beside=-3.3), 60, 10),
                *(
                    each
                    for i in range(7)
                    for each in (
                        who(f"r{i}", "truck" if i % 3 == 0 else "car", lane(0), 120 + 16 * i, 0.5 if i % 2 else 0.4),
                        who(f"k{i}", "car", lane(1), 115 + 12 * i, 0.5),
                    )
                ),
            ],
            34,
            rate=5,
        ),
    ]
