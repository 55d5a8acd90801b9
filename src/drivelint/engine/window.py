"""Cuts the windows of drives that are copied to see how robust findings are."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any, ClassVar, Final, Protocol

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.arrays import floats, with_columns
from drivelint.engine.copies import crop, renamed

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from drivelint.engine.batch import Drive

NEAR_M: Final = (25.0, 100.0)
"""For each size of window: actors that stay farther away from the rectangle around the ego's way are left out."""

LONG_NS: Final = 10_000_000_000
"""Of a longer stretch, what is farther away from its worst step is left out at first."""


class Asked(Protocol):
    """A finding that copies are judged for."""

    finding: dict[str, Any]
    size: int

    @property
    def numbers(self) -> range:
        """The copies to judge next."""
        ...


@dataclass
class Window:
    """A part of a drive with one ego, the copies of it to judge, and the findings whose times it covers."""

    SIZES: ClassVar[int] = 2

    drive: Drive
    ego_id: str
    numbers: Sequence[int]
    """The copy without errors, and those with errors that are to be judged."""
    from_ns: int
    to_ns: int
    questions: list[Any]

    @property
    def drive_id(self) -> str:
        """The drive."""
        return self.drive.trace.drive_id

    @cached_property
    def _part(self) -> Drive:
        part = crop(self.drive, self.from_ns, self.to_ns, self._near())
        is_ego = pc.equal(part.trace.tables["actor"]["actor_id"], self.ego_id)
        actors = with_columns(part.trace.tables["actor"], {"is_ego": is_ego.combine_chunks()})
        return replace(part, trace=replace(part.trace, tables={**part.trace.tables, "actor": actors}))

    def part(self, name: str) -> Drive:
        """Return what is copied, as a drive with this name behind that of the whole."""
        return replace(self._part, trace=renamed(self._part.trace, f"{self.drive_id}~{name}"))

    @property
    def n_states(self) -> int:
        """Rows of `actor_state` of all copies."""
        return self._part.n_states * len(self.numbers)

    def parts(self, most_states: int) -> Iterator[Window]:
        """Yield the same window with fewer copies each, so that their states are at most so many, if that can be."""
        at_once = max(1, most_states // max(1, self._part.n_states) - 1)
        for start in range(1, len(self.numbers), at_once):
            yield replace(self, numbers=(0, *self.numbers[start : start + at_once]))

    def _near(self) -> set[str]:
        states = self.drive.trace.tables["actor_state"]
        t_ns = states["t_ns"].to_numpy()
        within = (t_ns >= self.from_ns) & (t_ns <= self.to_ns)
        own = pc.equal(states["actor_id"], self.ego_id).to_numpy(zero_copy_only=False) & within
        near, beyond = within.copy(), NEAR_M[self.questions[0].size]
        for axis in ("x_m", "y_m"):
            place = floats(states[axis])
            known = place[own & np.isfinite(place)]
            if len(known):
                # an unknown place may be near
                near &= ~((place < known.min() - beyond) | (place > known.max() + beyond))
        found = set(pc.unique(states["actor_id"].filter(pa.array(near))).to_pylist())
        return found | {self.ego_id, *(q.finding["object_id"] for q in self.questions if q.finding["object_id"])}


def windows(drives: Mapping[str, Drive], asked: Sequence[Asked], goals: Sequence[int]) -> list[Window]:
    """Return the windows in which findings are copied next, those with the first copies first.

    Windows of one ego that overlap are one. They are of the same copies: those up to one of the `goals`, and those from there on,
    each with the copy without errors.
    """
    found: dict[tuple[object, ...], list[Window]] = {}
    for question in sorted(asked, key=lambda each: (each.finding["drive_id"], each.finding["ego_id"], _span(each))):
        drive_id, ego_id = question.finding["drive_id"], question.finding["ego_id"]
        start, end = _span(question)
        for numbers in _parts(question.numbers, goals):
            mine = found.setdefault((drive_id, ego_id, question.size, numbers), [])
            if mine and start <= mine[-1].to_ns:
                mine[-1].to_ns = max(mine[-1].to_ns, end)
                mine[-1].questions.append(question)
            else:
                mine.append(Window(drives[drive_id], ego_id, (0, *numbers), start, end, [question]))
    return sorted((window for each in found.values() for window in each), key=lambda window: window.numbers[1])


def _parts(numbers: range, goals: Sequence[int]) -> list[range]:
    """Return the same numbers, cut behind each goal."""
    cuts = [goal + 1 for goal in goals if numbers.start < goal + 1 < numbers.stop]
    return [range(*ends) for ends in pairwise((numbers.start, *cuts, numbers.stop))]


def _span(question: Asked) -> tuple[int, int]:
    """Return from when to when a finding's window is: a little more than its stretch, or much more."""
    finding, ref = question.finding, question.finding["t_ref_ns"]
    worst = finding["t_worst_ns"]
    start, end = max(finding["t_start_ns"], worst - LONG_NS), min(finding["t_end_ns"], worst + LONG_NS)
    before, after = 2_000_000_000, 1_000_000_000
    if ref is not None:
        start, end = min(ref, finding["t_start_ns"]), max(ref, finding["t_end_ns"])
        before, after = 6_000_000_000, 6_000_000_000
    if question.size or finding["profile"] is not None:  # what a driver did is known when the manoeuvre is over
        start, end = min(start, finding["t_start_ns"]), max(end, finding["t_end_ns"])
        before = after = 20_000_000_000
    return start - before, end + after
