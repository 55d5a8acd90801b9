"""The automated driver brakes: emergencies and minimal risk manoeuvres."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Drive, Events
from tests.outsiders.fourteenth.scenes import brakes


def braking_a() -> Iterator[Drive]:
    em = "alks-r157.emergency"
    mrm = "alks-r157.mrm"
    haz = "alks-r157.mrm-hazards"
    said = [
        (0.0, "emergency_manoeuvre", "off"),
        (6.0, "emergency_manoeuvre", "on"),
        (9.5, "emergency_manoeuvre", "off"),
    ]
    late = [
        (0.0, "emergency_manoeuvre", "off"),
        (7.6, "emergency_manoeuvre", "on"),
        (9.5, "emergency_manoeuvre", "off"),
    ]
    never = [(0.0, "emergency_manoeuvre", "off")]

    def risk(a: float, b: float) -> Events:
        return [
            (0.0, "minimal_risk_manoeuvre", "off"),
            (a, "minimal_risk_manoeuvre", "on"),
            (b, "minimal_risk_manoeuvre", "off"),
        ]

    flash = ((0.0, "off"), (5.5, "hazard"))
    yield brakes(
        "alks-brake-7",
        "7 m/s2, nothing declared",
        7.0,
        [(em, "fail", "7 m/s2 for 2.8 s"), ("comfort.decel-iso15622", "fail", "mean of 2 s near 7")],
        events=never,
    )
    yield brakes("alks-brake-7-said", "7 m/s2, declared at once", 7.0, [(em, "pass", "declared")], events=said)
    yield brakes(
        "alks-brake-7-late", "7 m/s2, declared 1.6 s late", 7.0, [(em, "fail", "declared 1.6 s late")], events=late
    )
    yield brakes(
        "alks-brake-45", "4.5 m/s2, nothing declared", 4.5, [(em, "not fail", "4.5 is no emergency")], events=never
    )
    yield brakes(
        "alks-mrm-hard",
        "minimal risk manoeuvre with 5.2 m/s2 for 4 s",
        5.2,
        [(mrm, "fail", "5.2 for 3.8 s"), (haz, "pass", "on from the start")],
        events=risk(5.5, 14.0),
        lamp=flash,
    )
    yield brakes(
        "alks-mrm-dark",
        "minimal risk manoeuvre with 3 m/s2, no hazard lights",
        3.0,
        [(mrm, "pass", "3 m/s2"), (haz, "fail", "never on")],
        events=risk(5.5, 14.0),
    )


def braking_b() -> Iterator[Drive]:
    mrm = "alks-r157.mrm"
    haz = "alks-r157.mrm-hazards"

    def risk(a: float, b: float) -> Events:
        return [
            (0.0, "minimal_risk_manoeuvre", "off"),
            (a, "minimal_risk_manoeuvre", "on"),
            (b, "minimal_risk_manoeuvre", "off"),
        ]

    yield brakes(
        "alks-mrm-late",
        "hazard lights 2.5 s late",
        3.0,
        [(mrm, "pass", "3 m/s2"), (haz, "fail", "2.5 s late")],
        events=risk(5.5, 14.0),
        lamp=((0.0, "off"), (8.0, "hazard")),
    )
    yield brakes(
        "alks-mrm-early-off",
        "hazard lights off 3 s before its end",
        3.0,
        [(haz, "fail", "off for the last 3 s")],
        events=risk(5.5, 15.0),
        lamp=((0.0, "off"), (5.5, "hazard"), (12.0, "off")),
    )


def braking() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from braking_a()
    yield from braking_b()
