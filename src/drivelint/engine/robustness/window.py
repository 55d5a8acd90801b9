"""Cuts windows out of drives; copies of these windows show how robust findings are."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final, NamedTuple, Protocol

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.arrays import floats, replace_columns
from drivelint.engine.robustness.copies import crop, with_drive_id

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from drivelint.engine.batch import Drive

N_WINDOW_SIZES: Final = 3
"""The number of window sizes. Size 0 is some seconds around the worst step; sizes 1 and 2 are larger, if that is not enough."""
NEAR_ACTOR_M_BY_WINDOW_SIZE: Final = (10.0, 25.0, 100.0)
"""For each size: actors that are always farther than this from the ego, along x or y, are left out."""
LONGEST_STRETCH_WHOLLY_IN_FIRST_WINDOW_NS: Final = 3_000_000_000
"""The first window contains the whole stretch of a finding that is at most this long."""
MOST_AROUND_WORST_STEP_IN_WINDOW_1_NS: Final = 10_000_000_000
"""A window of size 1 is limited to this time before and after the worst step of a stretch."""


class TimeAround(NamedTuple):
    """The time in nanoseconds by which a window of size 0 extends before the first of its steps and after the last."""

    before_ns: int
    after_ns: int


AROUND_STEP: Final = TimeAround(1_000_000_000, 600_000_000)
"""The window around the worst step of an invariant."""
AROUND_REFERENCE: Final = TimeAround(2_000_000_000, 2_000_000_000)
"""The window around the reference point and the worst step, for rules with reference points."""
AROUND_STEP_OF_OVERTAKE: Final = TimeAround(3_000_000_000, 2_000_000_000)
"""The window around the worst step of an invariant about overtakes, which are detected by the ego's lane before them."""
AROUND_REFERENCE_OF_OVERTAKE: Final = TimeAround(3_000_000_000, 6_000_000_000)
"""The same as `AROUND_REFERENCE`, for rules about overtakes."""


class FindingWithCopies(Protocol):
    """The interface of a finding for which copies are judged."""

    finding: dict[str, Any]
    size: int
    extent: Extent | None
    """The times and actors of its window; None: the window was not cut yet."""

    @property
    def is_about_overtakes(self) -> bool:
        """Whether the finding's rule is about overtakes."""
        ...

    @property
    def next_copy_numbers(self) -> range:
        """The numbers of the copies to judge next."""
        ...


@dataclass
class Extent:
    """Times and actors of a window. They are the same for all copies of a finding."""

    from_ns: int
    to_ns: int
    size: int
    objects: set[str]
    """The objects of the findings in the window."""
    is_near_at_same_time: bool
    """Whether an actor is near only if it is close to the ego at the same time. False: if it is close to any part of the ego's path."""

    def add(self, question: FindingWithCopies) -> None:
        """Include the window of this finding, and set the finding's extent."""
        start, end = window_span_ns(question)
        self.from_ns, self.to_ns = min(self.from_ns, start), max(self.to_ns, end)
        if question.finding["object_id"]:
            self.objects.add(question.finding["object_id"])
        self.is_near_at_same_time &= question.size == 0 and not question.is_about_overtakes
        question.extent = self


@dataclass
class Window:
    """A part of a drive with one ego, the copies of it to judge, and the findings in it."""

    drive: Drive
    ego_id: str
    numbers: Sequence[int]
    """The numbers of the copies to judge; the first is 0, the copy without errors."""
    extent: Extent
    questions: list[Any]

    @property
    def drive_id(self) -> str:
        """The id of the drive."""
        return self.drive.trace.drive_id

    @cached_property
    def _part_of_drive(self) -> Drive:
        part = crop(self.drive, self.extent.from_ns, self.extent.to_ns, self._actors_near_ego())
        is_ego = pc.equal(part.trace.tables["actor"]["actor_id"], self.ego_id)
        actors = replace_columns(part.trace.tables["actor"], {"is_ego": is_ego.combine_chunks()})
        return replace(part, trace=replace(part.trace, tables={**part.trace.tables, "actor": actors}))

    def part_with_suffix(self, id_suffix: str) -> Drive:
        """Return the part as a drive whose id is that of the whole drive with this suffix."""
        return replace(
            self._part_of_drive, trace=with_drive_id(self._part_of_drive.trace, f"{self.drive_id}~{id_suffix}")
        )

    @property
    def n_states(self) -> int:
        """The number of rows of `actor_state` of all copies."""
        return self._part_of_drive.n_states * len(self.numbers)

    def split_by_copies(self, most_states: int) -> Iterator[Window]:
        """Yield the window split into parts with fewer copies, each with at most `most_states` states if that is possible."""
        at_once = max(1, most_states // max(1, self._part_of_drive.n_states) - 1)
        for start in range(1, len(self.numbers), at_once):
            yield replace(self, numbers=(0, *self.numbers[start : start + at_once]))

    def _actors_near_ego(self) -> set[str]:
        """Return the ego, the objects of the findings, and the actors near the ego; an actor at an unknown position counts as near."""
        states, extent = self.drive.trace.tables["actor_state"], self.extent
        t_ns = states["t_ns"].to_numpy()
        rows = np.flatnonzero((t_ns >= extent.from_ns) & (t_ns <= extent.to_ns))
        t_ns, actors = t_ns[rows], states["actor_id"].take(rows)
        is_ego = pc.equal(actors, self.ego_id).to_numpy(zero_copy_only=False)
        near, beyond = np.ones(len(rows), dtype=bool), NEAR_ACTOR_M_BY_WINDOW_SIZE[extent.size]
        for axis in ("x_m", "y_m"):
            place = floats(states[axis])[rows]
            at = np.flatnonzero(is_ego & np.isfinite(place))
            if len(at):
                lowest, highest = place[at].min(), place[at].max()
                if extent.is_near_at_same_time:
                    at = at[np.argsort(t_ns[at], kind="stable")]
                    lowest = highest = np.interp(t_ns, t_ns[at], place[at])
                near &= ~((place < lowest - beyond) | (place > highest + beyond))
        names = set(pc.unique(actors.filter(pa.array(near))).to_pylist())
        return names | extent.objects | {self.ego_id}


def windows_to_judge(
    drives: Mapping[str, Drive], questions: Sequence[FindingWithCopies], goals: Sequence[int]
) -> list[Window]:
    """Return the windows to judge next for these findings, those with the lowest copy numbers first.

    Overlapping windows of one ego are merged. The copy numbers are split after each of the `goals`, so that merged windows have the same
    ones. Each window also has copy 0.
    """
    set_extents([question for question in questions if question.extent is None])
    windows: dict[tuple[Any, ...], Window] = {}
    for question in questions:
        drive_id, ego_id, extent = question.finding["drive_id"], question.finding["ego_id"], question.extent
        if extent is None:
            continue
        for numbers in _ranges_by_goal(question.next_copy_numbers, goals):
            key = (numbers.start, drive_id, ego_id, extent.size, extent.from_ns, extent.to_ns, numbers)
            window = windows.setdefault((*key, id(extent)), Window(drives[drive_id], ego_id, (0, *numbers), extent, []))
            window.questions.append(question)
    return [windows[key] for key in sorted(windows, key=lambda key: key[:-2])]


def set_extents(questions: Sequence[FindingWithCopies]) -> None:
    """Set the extent of each finding; findings of one ego, of the same size and kind, share it if their windows overlap."""
    last: dict[tuple[object, ...], Extent] = {}
    for question in sorted(
        questions,
        key=lambda question: (question.finding["drive_id"], question.finding["ego_id"], window_span_ns(question)),
    ):
        key = (question.finding["drive_id"], question.finding["ego_id"], question.size, question.is_about_overtakes)
        start, end = window_span_ns(question)
        if key not in last or start > last[key].to_ns:
            last[key] = Extent(start, end, question.size, set(), is_near_at_same_time=True)
        last[key].add(question)


def _ranges_by_goal(numbers: range, goals: Sequence[int]) -> list[range]:
    """Return the numbers as several ranges, split after each goal."""
    cuts = [goal + 1 for goal in goals if numbers.start < goal + 1 < numbers.stop]
    return [range(*ends) for ends in pairwise((numbers.start, *cuts, numbers.stop))]


def window_span_ns(question: FindingWithCopies) -> tuple[int, int]:
    """Return the start and end (ns) of a finding's window, by its size, the kind of rule, and the finding's times."""
    finding, ref, worst = question.finding, question.finding["t_ref_ns"], question.finding["t_worst_ns"]
    if question.size == 0:
        steps = (worst,) if ref is None else (ref, worst)
        around = (
            (AROUND_STEP, AROUND_STEP_OF_OVERTAKE) if ref is None else (AROUND_REFERENCE, AROUND_REFERENCE_OF_OVERTAKE)
        )
        before, after = around[question.is_about_overtakes]
        if ref is None and finding["t_end_ns"] - finding["t_start_ns"] <= LONGEST_STRETCH_WHOLLY_IN_FIRST_WINDOW_NS:
            steps = (finding["t_start_ns"], finding["t_end_ns"])
        return min(steps) - before, max(steps) + after
    start, end = (
        max(finding["t_start_ns"], worst - MOST_AROUND_WORST_STEP_IN_WINDOW_1_NS),
        min(finding["t_end_ns"], worst + MOST_AROUND_WORST_STEP_IN_WINDOW_1_NS),
    )
    before, after = 2_000_000_000, 1_000_000_000
    if ref is not None:
        start, end = min(ref, finding["t_start_ns"]), max(ref, finding["t_end_ns"])
        before, after = 6_000_000_000, 6_000_000_000
    if question.size > 1 or finding["profile"] is not None:  # a profile needs the whole manoeuvre
        start, end = min(start, finding["t_start_ns"]), max(end, finding["t_end_ns"])
        before = after = 20_000_000_000
    return start - before, end + after
