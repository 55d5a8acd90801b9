"""Cuts the windows of drives that are copied to see how robust findings are."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final, NamedTuple, Protocol

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.arrays import floats, with_columns
from drivelint.engine.robustness.copies import crop, renamed

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from drivelint.engine.batch import Drive

SIZES: Final = 3
"""The sizes of a window: 0, the seconds around the worst step, and two larger ones if these seconds are not enough."""
NEAR_M: Final = (10.0, 25.0, 100.0)
"""For each size: actors that stay farther away from the ego, along x or y, are left out."""
SHORT_NS: Final = 3_000_000_000
"""A stretch that is no longer is in its first window as a whole."""
LONG_NS: Final = 10_000_000_000
"""Of a longer stretch, what is farther away from its worst step is left out at first."""


class Around(NamedTuple):
    """How long before and after its step a window of size 0 is, in nanoseconds."""

    before_ns: int
    after_ns: int


AT_STEP: Final = Around(1_000_000_000, 600_000_000)
"""For an invariant."""
AT_REFERENCE: Final = Around(2_000_000_000, 2_000_000_000)
"""For a rule with reference points: around these and the worst step."""
IN_OVERTAKE: Final = Around(3_000_000_000, 2_000_000_000)
"""For an invariant about overtakes, which are known only with the lane before."""
AT_OVERTAKE: Final = Around(3_000_000_000, 6_000_000_000)
"""For a rule with reference points in overtakes."""


class FindingWithCopies(Protocol):
    """A finding that copies are judged for."""

    finding: dict[str, Any]
    size: int
    extent: Extent | None
    """What its copies of this size are copies of; None: no window of this size was cut yet."""

    @property
    def of_overtake(self) -> bool:
        """Whether its rule is about overtakes."""
        ...

    @property
    def numbers(self) -> range:
        """The copies to judge next."""
        ...


@dataclass
class Extent:
    """Times and actors of a window. All copies for a finding have the same."""

    from_ns: int
    to_ns: int
    size: int
    objects: set[str]
    """The objects of the findings in it."""
    at_once: bool
    """Actors are near only if they are so at the same time: else wherever the ego is in the window."""

    def add(self, question: FindingWithCopies) -> None:
        """Let a finding's window be in it, too."""
        start, end = span(question)
        self.from_ns, self.to_ns = min(self.from_ns, start), max(self.to_ns, end)
        if question.finding["object_id"]:
            self.objects.add(question.finding["object_id"])
        self.at_once &= question.size == 0 and not question.of_overtake
        question.extent = self


@dataclass
class Window:
    """A part of a drive with one ego, the copies of it to judge, and the findings whose times it covers."""

    drive: Drive
    ego_id: str
    numbers: Sequence[int]
    """The copy without errors, and those with errors that are to be judged."""
    extent: Extent
    questions: list[Any]

    @property
    def drive_id(self) -> str:
        """The drive."""
        return self.drive.trace.drive_id

    @cached_property
    def _part(self) -> Drive:
        part = crop(self.drive, self.extent.from_ns, self.extent.to_ns, self._near())
        is_ego = pc.equal(part.trace.tables["actor"]["actor_id"], self.ego_id)
        actors = with_columns(part.trace.tables["actor"], {"is_ego": is_ego.combine_chunks()})
        return replace(part, trace=replace(part.trace, tables={**part.trace.tables, "actor": actors}))

    def part(self, name: str) -> Drive:
        """Return the copied part as a drive, with this suffix after the name of the whole."""
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
        """Return the ego, the findings' objects and the actors near the ego; an actor whose place is not known may be near."""
        states, extent = self.drive.trace.tables["actor_state"], self.extent
        t_ns = states["t_ns"].to_numpy()
        rows = np.flatnonzero((t_ns >= extent.from_ns) & (t_ns <= extent.to_ns))
        t_ns, actors = t_ns[rows], states["actor_id"].take(rows)
        own = pc.equal(actors, self.ego_id).to_numpy(zero_copy_only=False)
        near, beyond = np.ones(len(rows), dtype=bool), NEAR_M[extent.size]
        for axis in ("x_m", "y_m"):
            place = floats(states[axis])[rows]
            known = np.flatnonzero(own & np.isfinite(place))
            if len(known):
                lowest, highest = place[known].min(), place[known].max()
                if extent.at_once:
                    known = known[np.argsort(t_ns[known], kind="stable")]
                    lowest = highest = np.interp(t_ns, t_ns[known], place[known])
                near &= ~((place < lowest - beyond) | (place > highest + beyond))
        found = set(pc.unique(actors.filter(pa.array(near))).to_pylist())
        return found | extent.objects | {self.ego_id}


def windows(drives: Mapping[str, Drive], questions: Sequence[FindingWithCopies], goals: Sequence[int]) -> list[Window]:
    """Return the windows in which findings are copied next, those with the first copies first.

    Windows of one ego that overlap are one. They are of the same copies: those up to one of the `goals`, and those from there on,
    each with the copy without errors.
    """
    cut([question for question in questions if question.extent is None])
    found: dict[tuple[Any, ...], Window] = {}
    for question in questions:
        drive_id, ego_id, extent = question.finding["drive_id"], question.finding["ego_id"], question.extent
        if extent is None:
            continue
        for numbers in _parts(question.numbers, goals):
            key = (numbers.start, drive_id, ego_id, extent.size, extent.from_ns, extent.to_ns, numbers)
            window = found.setdefault((*key, id(extent)), Window(drives[drive_id], ego_id, (0, *numbers), extent, []))
            window.questions.append(question)
    return [found[key] for key in sorted(found, key=lambda key: key[:-2])]


def cut(questions: Sequence[FindingWithCopies]) -> None:
    """Give each finding the extent of its window, which it shares with those of the same ego that it overlaps."""
    last: dict[tuple[object, ...], Extent] = {}
    for question in sorted(questions, key=lambda each: (each.finding["drive_id"], each.finding["ego_id"], span(each))):
        key = (question.finding["drive_id"], question.finding["ego_id"], question.size, question.of_overtake)
        start, end = span(question)
        if key not in last or start > last[key].to_ns:
            last[key] = Extent(start, end, question.size, set(), at_once=True)
        last[key].add(question)


def _parts(numbers: range, goals: Sequence[int]) -> list[range]:
    """Return the same numbers, cut behind each goal."""
    cuts = [goal + 1 for goal in goals if numbers.start < goal + 1 < numbers.stop]
    return [range(*ends) for ends in pairwise((numbers.start, *cuts, numbers.stop))]


def span(question: FindingWithCopies) -> tuple[int, int]:
    """Return from when to when a finding's window is: its worst step with what is around it, its stretch, or much more."""
    finding, ref, worst = question.finding, question.finding["t_ref_ns"], question.finding["t_worst_ns"]
    if question.size == 0:
        steps = (worst,) if ref is None else (ref, worst)
        around = (AT_STEP, IN_OVERTAKE) if ref is None else (AT_REFERENCE, AT_OVERTAKE)
        before, after = around[question.of_overtake]
        if ref is None and finding["t_end_ns"] - finding["t_start_ns"] <= SHORT_NS:
            steps = (finding["t_start_ns"], finding["t_end_ns"])
        return min(steps) - before, max(steps) + after
    start, end = max(finding["t_start_ns"], worst - LONG_NS), min(finding["t_end_ns"], worst + LONG_NS)
    before, after = 2_000_000_000, 1_000_000_000
    if ref is not None:
        start, end = min(ref, finding["t_start_ns"]), max(ref, finding["t_end_ns"])
        before, after = 6_000_000_000, 6_000_000_000
    if question.size > 1 or finding["profile"] is not None:  # what a driver did is known when the manoeuvre is over
        start, end = min(start, finding["t_start_ns"]), max(end, finding["t_end_ns"])
        before = after = 20_000_000_000
    return start - before, end + after
