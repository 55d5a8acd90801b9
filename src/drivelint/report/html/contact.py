"""The speeds of two road users just before they touched; the speeds at the contact may already be lower because of it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from drivelint.result.text import closing_speed_words, seconds

if TYPE_CHECKING:
    from drivelint.result.text import Row

LONGEST_TIME_BEFORE_CONTACT_NS: Final = 1_000_000_000
"""Speeds measured earlier than this before the contact are not used."""


def speeds_before_contact(scene: Row, contact: Row, start_ns: int) -> dict[str, Any] | None:
    """Return the speeds at the last time before a contact at which `scene` has both actors; None if it has no such time.

    `contact`: the finding; the closing speed is taken from it.
    """
    ways = {actor["actor_id"]: actor["path"] or [] for actor in scene["actors"]}
    if contact["object_id"] not in ways:
        return None
    ego, met = (
        {point["t_ns"]: point for point in ways.get(actor_id, [])}
        for actor_id in (contact["ego_id"], contact["object_id"])
    )
    times = sorted(t for t in ego.keys() & met.keys() if t < contact["t_start_ns"])
    if not times or contact["t_start_ns"] - times[-1] > LONGEST_TIME_BEFORE_CONTACT_NS:
        return None
    last = times[-1]
    speeds = [
        (actor_id, way[last]["speed_mps"]) for actor_id, way in ((contact["ego_id"], ego), (contact["object_id"], met))
    ]
    speeds_text = ", ".join(f"{actor_id} at {v:.1f} m/s" for actor_id, v in speeds if v is not None)
    # a scene does not contain every step: the closing speed may be from a later step than `last`
    nearing = (
        ""
        if contact["closing_mps"] is None
        else f"{closing_speed_words(contact['closing_mps'])} just before the contact"
    )
    parts = [nearing, f"at {seconds(last, start_ns)}: {speeds_text}" if speeds_text else ""]
    return {
        "time": seconds(last, start_ns),
        "speeds": speeds,
        "words": "; ".join(part for part in parts if part),
    }
