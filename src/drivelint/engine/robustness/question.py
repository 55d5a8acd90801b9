"""Findings for which copies are judged: how many copies each needs, and what the copies show."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from drivelint.engine.robustness.window import window_span_ns
from drivelint.sql.derivations import tables_with_sources

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from drivelint.catalogue import Rule
    from drivelint.engine.robustness.window import Extent

N_COPIES_TO_SETTLE: Final = (20, 100)
"""The numbers of judged copies after which a question may be settled.

20 is the block size of `copies`: a block has errors from the smallest to the largest. They suffice if all keep the finding. If the true
share of copies that keep it is 90 %, all of 20 keep it with a probability of 5 to 7 %, and at least 95 of 100 with 2 %; if it is 93 %, with
15 to 19 %, and 25 % (simulated for margins that depend on 2 to 8 errors alike)."""
N_LOST_OF_FEW_COPIES_FOR_POSSIBLE_FINDING: Final = 3
"""A finding that so many of the first 20 copies lose is only possible. If 96 % of copies keep it, 2 % of blocks lose so many; in 100
copies, less than 95 then keep it with a probability of 21 %."""
FAR_FROM_ZERO_STANDARD_DEVIATIONS: Final = 2.5
"""If the mean of known margins is nearer to 0, 20 copies that keep the finding do not suffice: of normally distributed margins, 5 % lie
beyond 1.6 standard deviations, and 20 margins give this ratio to a third."""
LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING: Final = 0.95
"""A finding is only possible if less than this share of its copies keep it (see `result.certainty`)."""
SMALL_MARGIN_BY_UNIT: Final = {"m": 0.3, "s": 0.1}
"""Unit -> margin up to which a finding is near the threshold: errors of a decimetre may remove it, so all copies are judged."""


@dataclass
class RobustnessQuestion:
    """A finding, and what its copies have shown so far."""

    finding: dict[str, Any]
    rule: Rule
    size: int = 0
    """The judged window: 0, some seconds around the worst step; 1 and 2, larger ones; `N_WINDOW_SIZES`: none is left, so there is no
    count."""
    ends_early: bool = True
    """Stop judging copies as soon as the finding is only possible. False: the user gave a confidence, which needs all copies."""
    n_copies: int = 0
    n_stays: int = 0
    """The number of copies that keep the finding."""
    margins: list[float | None] = field(default_factory=list)
    """The margins in the copies that keep the finding."""
    is_doubtful: bool = False
    """The first window left some copies undecided, so all copies are judged in the next window."""
    is_hasty: bool = False
    """Judge all copies at once, which saves a pass. The later copies count only if the earlier ones do not suffice."""
    extent: Extent | None = None
    """The times and actors of the current window; None: it was not cut yet."""

    @cached_property
    def is_about_overtakes(self) -> bool:
        """Whether the finding's rule is about overtakes."""
        return "overtake" in tables_with_sources(self.rule.reads)

    @property
    def is_near_threshold(self) -> bool:
        """Whether the margin is so small that errors of a decimetre may remove the finding."""
        margin = self.finding["margin"]
        return margin is not None and abs(margin) <= SMALL_MARGIN_BY_UNIT.get(self.rule.unit or "", 0.0)

    @property
    def next_copy_numbers(self) -> range:
        """The numbers of the copies to judge next."""
        least, largest = N_COPIES_TO_SETTLE
        return range(self.n_copies + 1, (largest if self.is_hasty or self.n_copies >= least else least) + 1)

    @property
    def is_settled(self) -> bool:
        """Whether enough copies were judged."""
        least, largest = N_COPIES_TO_SETTLE
        n_lost = self.n_copies - self.n_stays
        if self.n_copies >= largest or (self.ends_early and self._suffice_lost_copies(n_lost)):
            return True
        if n_lost or self.is_near_threshold or self.is_doubtful:
            return False
        return self.n_copies >= least and self._are_margins_far_from_zero_or_unknown

    def _suffice_lost_copies(self, n_lost: int) -> bool:
        """Return whether so many copies lose the finding that it is only possible."""
        least, largest = N_COPIES_TO_SETTLE
        if self.n_copies <= least and n_lost >= N_LOST_OF_FEW_COPIES_FOR_POSSIBLE_FINDING:
            return True
        return n_lost > (1.0 - LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING) * largest

    @property
    def _are_margins_far_from_zero_or_unknown(self) -> bool:
        """Whether the margins of the copies are far from 0; True if some are not known."""
        numbers = [margin for margin in self.margins if margin is not None]
        if len(numbers) < len(self.margins):
            return True
        return abs(float(np.mean(numbers))) >= FAR_FROM_ZERO_STANDARD_DEVIATIONS * float(np.std(numbers))

    @property
    def is_finding_certain(self) -> bool:
        """Whether the copies show that the finding is certain, not only possible."""
        return (
            self.n_copies > 0
            and self.is_settled
            and self.n_stays >= LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING * self.n_copies
        )

    def add_results_of_copies(
        self, numbers: Sequence[int], margins: Mapping[int, float | None], passes: Collection[int] = ()
    ) -> None:
        """Add the results of a window of the drive that was judged in several copies.

        `next_copy_numbers`: the numbers of the copies; the first is 0, the copy without measuring errors. `margins`: number -> margin, for
        copies that keep the finding. `passes`: numbers of the copies in which the worst step passes.
        """
        if numbers[1] != self.n_copies + 1 or self.is_settled:
            return  # the window of the copies before these failed, or the question is settled
        margin, whole = self.finding["margin"], margins.get(0)
        same = 0 in margins and (margin is None or (whole is not None and abs(whole - margin) < 1e-6))
        if not same:
            self.restart_with_window_size(self.size + 1)
        elif self._has_window_all_steps_of_finding or self._may_undecided_copies_count_as_lost(
            numbers, {*margins, *passes}, len(margins) - 1
        ):
            self.n_copies = numbers[-1]
            self.n_stays += len(margins) - 1
            self.margins += [margin for number, margin in margins.items() if number]
        else:
            self.restart_with_window_size(self.size + 1)
            self.is_doubtful = True

    @property
    def _has_window_all_steps_of_finding(self) -> bool:
        """Whether the window contains every step that can keep the finding; the first window may have only a part of a stretch."""
        start, end = window_span_ns(self)
        whole = start <= self.finding["t_start_ns"] and end >= self.finding["t_end_ns"]
        return self.size > 0 or self.finding["t_ref_ns"] is not None or whole

    def _may_undecided_copies_count_as_lost(
        self, numbers: Sequence[int], conclusive_copies: Collection[int], n_stays: int
    ) -> bool:
        """Return whether undecided copies may count as lost: there are none, or the finding is only possible even if they keep it."""
        may_stay = (
            self.n_stays + n_stays + len(set(numbers) - set(conclusive_copies)) + N_COPIES_TO_SETTLE[-1] - numbers[-1]
        )
        return (
            set(conclusive_copies) >= set(numbers)
            or may_stay < LEAST_SHARE_OF_COPIES_FOR_CERTAIN_FINDING * N_COPIES_TO_SETTLE[-1]
        )

    def restart_with_window_size(self, size: int) -> None:
        """Discard the results, and continue with this size of window; with the size `N_WINDOW_SIZES`, the finding gets no count."""
        self.size, self.n_copies, self.n_stays, self.margins, self.extent = size, 0, 0, [], None


@dataclass(frozen=True)
class OutcomeInCopies:
    """The result of a finding in a window: copies that keep it, with their margins, and copies in which the worst step passes."""

    margins: dict[int, float | None] = field(default_factory=dict)
    passes: set[int] = field(default_factory=set)


def drive_ego_and_rule(question: RobustnessQuestion) -> tuple[str, ...]:
    """Return the drive, ego and rule of a finding."""
    return tuple(question.finding[key] for key in ("drive_id", "ego_id", "rule_id"))


def worst_near_and_other_questions(
    questions: Sequence[RobustnessQuestion],
) -> tuple[list[RobustnessQuestion], list[RobustnessQuestion], list[RobustnessQuestion]]:
    """Return the questions in three lists: the worst finding (by margin) of each drive, ego and rule; others near the threshold; all
    remaining ones."""
    gravest: dict[tuple[str, ...], RobustnessQuestion] = {}
    for question in sorted(questions, key=lambda q: np.nan_to_num(q.finding["margin"] or np.nan, nan=np.inf)):
        gravest.setdefault(drive_ego_and_rule(question), question)
    rest = [question for question in questions if gravest[drive_ego_and_rule(question)] is not question]
    return (
        list(gravest.values()),
        [q for q in rest if q.is_near_threshold],
        [q for q in rest if not q.is_near_threshold],
    )
