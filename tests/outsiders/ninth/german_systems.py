"""Germany: automated driving systems, and what they declare."""

from __future__ import annotations

from tests.outsiders.ninth.cast import SCHNELLER, out_and_back
from tests.outsiders.ninth.drive import Drive, draw
from tests.outsiders.ninth.maps import AUTOBAHN_M, autobahn, landstrasse, lane, own
from tests.outsiders.ninth.movement import ego, who


def german_systems() -> list[Drive]:
    """Return its drives."""
    return [
        draw(
            "de_alks_zu_dicht_k",
            "The system follows a car at 47 km/h, 6.5 m behind it.",
            "fail alks-r157.follow-gap",
            autobahn(60),
            [ego(lane(0), 60, 13), who("vor", "car", lane(0), 71, 13)],
            26,
            engaged="yes",
        ),
        draw(
            "de_alks_mrm_ohne_warnblinker_k",
            "The system brakes with 6.6 m/s2 to a halt, without hazard lights.",
            "fail alks-r157.mrm alks-r157.mrm-hazards alks-r157.emergency",
            autobahn(130),
            [ego(lane(0), 60, [(6, 29), (10.4, 0)])],
            26,
            events=[
                (0, "minimal_risk_manoeuvre", "off"),
                (5.5, "minimal_risk_manoeuvre", "on"),
                (0, "emergency_manoeuvre", "off"),
            ],
            engaged="yes",
        ),
        draw(
            "de_r79_kriechender_wechsel_k",
            "The system changes lane for six seconds, soon after the indicator came on.",
            "fail alks-r157.r79.lane-change alks-r157.r79.lane-change-done",
            autobahn(130),
            [ego(lane(0), 60, 28, [(4, 0), (26, AUTOBAHN_M)], indicator=[(0, "off"), (10.8, "offside"), (28, "off")])],
            34,
            engaged="yes",
        ),
        draw(
            "de_ueberholt_ohne_ueberzeugung_k",
            "The ego overtakes after it decided not to, in doubt, and with its looks in the wrong order.",
            "fail declared.r162.go-before-overtaking declared.r166.confidence-at-commit "
            "declared.r163.checks-before-pull-out declared.r161.mirrors-before-signal declared.r125.chosen-speed-kept",
            landstrasse(1400),
            [
                ego(
                    own, 45, SCHNELLER, out_and_back(3.5, back=15), indicator=[(0, "off"), (5.5, "offside"), (9, "off")]
                ),
                who("lkw", "truck", own, 100, 19),
            ],
            24,
            events=[
                (0.5, "chosen_speed", "22; Kurve"),
                (1, "chosen_speed", "22"),
                (3.0, "overtake_go", None),
                (3.6, "overtake_no_go", None),
                (3.6, "confidence", "0.4"),
                (5.2, "blind_spot_check", "offside"),
                (5.8, "mirror_check", "offside"),
            ],
        ),
    ]
