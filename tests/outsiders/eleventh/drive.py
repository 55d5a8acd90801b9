"""A drive, what an examiner says of it, and how it is written."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tests.outsiders import log
from tests.outsiders.eleventh.motion import Actor

Reasons = list[tuple[str, str, str]]  # rule, verdict, why


@dataclass
class Drive:
    """One drive and what is expected of its verdicts; its name begins with the nation."""

    short: str
    road: str
    actors: list[Actor]
    conditions: dict[str, str] = field(default_factory=dict)
    lights: list[tuple[str, float, str]] = field(default_factory=list)
    events: list[tuple[float, str, Any]] = field(default_factory=list)
    expect: Reasons = field(default_factory=list)

    @property
    def scene(self) -> log.Scene:
        """What happens, which is why a verdict is expected, and the verdicts."""
        what = "; ".join(why for _, _, why in self.expect)
        return log.Scene(f"{self.short}_m", what, {rule: verdict for rule, verdict, _ in self.expect})

    def write(self, folder: Path) -> None:
        """Write the drive into a folder of its name."""
        log.write(
            folder / self.scene.name,
            self.road,
            [log.Box(actor.name, actor.kind, actor.size) for actor in self.actors],
            [actor.columns() for actor in self.actors],
            {"nation": self.short[:2], **self.conditions},
            [(name, round(t * 1e9), state) for name, t, state in self.lights],
            self.events,
        )
