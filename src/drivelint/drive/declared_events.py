"""Lists the events that an ego may declare, with their values and meanings."""

from __future__ import annotations

from typing import Final, NamedTuple


class DeclaredEvent(NamedTuple):
    """What the value of an event is, and what the event says."""

    value: str
    says: str


MODES: Final = {
    "engaged": "the automated driver drives",
    "emergency_manoeuvre": "an emergency manoeuvre of the automated driver is under way",
    "minimal_risk_manoeuvre": "a minimal risk manoeuvre of the automated driver is under way",
    "lane_change_procedure": "the automated driver is changing lane, from its decision to its end",
    "headlights": "the headlights are on, dipped or main beam",
    "horn": "the horn sounds",
}
"""Events that are on until they are declared off."""
EVENTS: Final = {
    **{mode: DeclaredEvent("on, off", says) for mode, says in MODES.items()},
    "mirror_check": DeclaredEvent("left, right; none: both sides", "a look into the mirrors"),
    "blind_spot_check": DeclaredEvent("left, right; none: both sides", "a look over the shoulder"),
    "overtake_go": DeclaredEvent("none", "the decision to overtake"),
    "overtake_no_go": DeclaredEvent("none", "the decision not to overtake"),
    "confidence": DeclaredEvent("a number, 0 to 1", "how sure it is that the overtake is safe"),
    "chosen_speed": DeclaredEvent(
        "m/s; reason, such as `12.5; wet road`", "the speed that it means not to exceed, from now on"
    ),
    "hazard": DeclaredEvent("an actor_id", "somebody who may become a danger"),
}
"""Event -> what it says. Other events are kept and read by no rule."""
