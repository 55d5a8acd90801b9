"""Plain-English explanations of the technical words that occur on the first page."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterable


_WORDS: Final = (
    ("danger space", "Danger space", "the room in front of a vehicle that it needs to stop, as wide as the vehicle"),
    (
        "rss",
        "RSS",
        "Responsibility-Sensitive Safety: published formulas for the distances that a careful driver keeps; not a law",
    ),
    ("iso 15622", "ISO 15622", "a standard that says how hard a cruise control may accelerate and brake"),
    ("nuplan", "nuPlan's bounds", "limits of acceleration and jerk beyond which a ride counts as uncomfortable"),
    ("jerk", "Jerk", "how suddenly acceleration or braking changes"),
    (
        "m/s2",
        "m/s2",
        "metres per second, each second: how quickly a speed changes; full braking on a dry road is about 8",
    ),
    ("m/s3", "m/s3", "how quickly that changes, each second"),
    ("post-encroachment", "Post-encroachment time", "the time between one leaving a place and the other coming there"),
    ("time headway", "Time headway", "the time until the ego is where the vehicle ahead is now"),
    ("time to collision", "Time to collision", "the time until the two would meet if both went on as they did"),
    ("time left to brake", "Time left to brake", "how long the ego could still have waited before braking fully"),
    ("lateral", "Lateral", "to the side"),
    ("zone", "Zones", "how much time an overtake had to spare: A none, B under half a second, C enough, D a lot"),
    (
        "relaxed",
        "Relaxed, nominal, aggressive",
        "how gently an overtake is driven: the more gently, the more road it takes",
    ),
    ("thinking distance", "Thinking distance", "how far a vehicle goes before its driver begins to brake"),
)
"""What is looked for (in lower case), how it is written, what it means; in the order shown."""


def glossary_entries(texts: Iterable[str]) -> list[tuple[str, str]]:
    """Return the words that occur in any of the texts, each with what it means."""
    said = " ".join(texts).lower()
    return [(word, means) for sign, word, means in _WORDS if sign in said]
