"""What the sections share: how large everything is, and the files that they read, made when first asked for."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from tests.bench import traffic
from tests.bench.traffic import Shape

if TYPE_CHECKING:
    from pathlib import Path


class Sizes(NamedTuple):
    """How much is measured. `slow_runs`: repetitions of what takes long."""

    reference: Shape = traffic.REFERENCE
    short: Shape = traffic.SHORT
    drives: int = 1000
    fleet: int = 300
    unit: Shape = Shape(300.0, 20, 50)
    lengths: tuple[int, ...] = (1, 4, 16)
    hours: float = 8.0
    megabytes: int = 200
    runs: int = 5
    slow_runs: int = 3
    steps: int = 12_000


TINY = Sizes(
    reference=Shape(30.0, 10, 8),
    short=Shape(10.0, 10, 6),
    drives=3,
    fleet=3,
    unit=Shape(5.0, 10, 6),
    lengths=(1, 2),
    hours=10 / 3600,
    megabytes=2,
    runs=1,
    slow_runs=1,
    steps=300,
)


class Place:
    """A temporary folder with the traces and the road of a run. `commit`: what `before`, `demo` and `fleet` compare with."""

    def __init__(self, home: Path, sizes: Sizes, commit: str = "HEAD") -> None:
        self.home = home
        self.sizes = sizes
        self.commit = commit

    @cached_property
    def road(self) -> Path:
        """The ring road as OpenDRIVE."""
        path = self.home / "ring.xodr"
        path.write_text(traffic.ring(), encoding="utf-8")
        return path

    @cached_property
    def reference(self) -> Path:
        """The reference drive as OSI MCAP."""
        return traffic.write_osi(self.home / "reference.mcap", self.sizes.reference)

    def states(self, shape: Shape) -> int:
        """Return the number of actor states of a drive."""
        return round(shape.seconds * shape.hertz) * shape.actors
