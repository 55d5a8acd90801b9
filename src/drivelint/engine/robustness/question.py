"""Findings for which copies are judged: how many copies each needs, and the result of these."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from drivelint.engine.robustness.window import span
from drivelint.sql.derivations import with_sources

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from drivelint.catalogue import Rule
    from drivelint.engine.robustness.window import Extent

N_COPIES: Final = (20, 32, 100)
"""The first 32 copies suffice if all keep the finding. Of a finding that 90 % of all copies would keep, 32 of 32 do in 3.4 % of draws,
and 95 of 100 or more in 2.4 %; of one that 93 % would, in 10 % and in 25 %. 20 are a block of `copies`, which has each error from
the smallest to the largest."""
FAR_SPREADS: Final = 5.0
"""The first 20 suffice if all keep the finding, and the mean of their margins is so many standard deviations from 0."""
LEAST_SHARE: Final = 0.95
"""A finding that fewer of its copies keep is only possible, as `result.certainty` says."""
SMALL_MARGIN: Final = {"m": 0.3, "s": 0.1}
"""Unit -> margin up to which all copies are judged at once, as errors of a decimetre may take it away."""
NOT_FAR: Final = 10.0
"""Below so many small margins, 20 copies will hardly suffice."""


@dataclass
class Question:
    """A finding, and the result of its copies so far."""

    finding: dict[str, Any]
    rule: Rule
    size: int = 0
    """The size of the present window."""
    ends_early: bool = True
    """It ends as soon as it is only possible; whoever gives a confidence of their own needs the share of all copies."""
    n_copies: int = 0
    n_stays: int = 0
    """The number of copies that keep it."""
    margins: list[float | None] = field(default_factory=list)
    """The margins in those that keep it."""
    is_doubtful: bool = False
    """Some copies lost it in the first window, so that all are judged in the next."""
    is_hasty: bool = False
    """All copies are judged at once, which saves a pass. The last ones count only where the first do not suffice."""
    extent: Extent | None = None
    """What its copies of this size are copies of."""

    @cached_property
    def of_overtake(self) -> bool:
        """Whether its rule is about overtakes."""
        return "overtake" in with_sources(self.rule.reads)

    @property
    def is_near(self) -> bool:
        """Whether errors of a decimetre may take it away."""
        return self._is_within(1.0)

    def _is_within(self, share: float) -> bool:
        margin = self.finding["margin"]
        return margin is not None and abs(margin) <= share * SMALL_MARGIN.get(self.rule.unit or "", 0.0)

    @property
    def numbers(self) -> range:
        """The copies to judge next."""
        goal = N_COPIES[-1] if self.is_hasty else next((n for n in N_COPIES if n > self.n_copies), N_COPIES[-1])
        return range(self.n_copies + 1, max(goal, self._n_first) + 1)

    @property
    def _n_first(self) -> int:
        """How many copies are judged together at first: those that will hardly suffice save no time."""
        return N_COPIES[self.finding["margin"] is None or self._is_within(NOT_FAR)]

    @property
    def is_settled(self) -> bool:
        """Whether the copies suffice."""
        few, more, most = N_COPIES
        if self.n_copies >= most or (self.ends_early and self.n_copies - self.n_stays > (1.0 - LEAST_SHARE) * most):
            return True
        if self.n_stays < self.n_copies or self.is_near or self.is_doubtful:
            return False
        return self.n_copies >= (few if self._is_far else more)

    @property
    def _is_far(self) -> bool:
        """Whether the margins of the copies are far from 0."""
        known = [margin for margin in self.margins if margin is not None]
        if len(known) < max(len(self.margins), N_COPIES[0]):
            return False
        return abs(float(np.mean(known))) >= FAR_SPREADS * float(np.std(known))

    @property
    def is_sure(self) -> bool:
        """Whether the copies show that it is more than possible."""
        return self.n_copies > 0 and self.is_settled and self.n_stays >= LEAST_SHARE * self.n_copies

    def take(self, numbers: Sequence[int], margins: Mapping[int, float | None], passes: Collection[int] = ()) -> None:
        """Take the copies of a window in which the finding stays, with their margins; the first copy is the one without errors.

        `passes`: copies in which the rule is kept at the finding's worst step.
        """
        if numbers[1] != self.n_copies + 1 or self.is_settled:
            return  # the window of the copies before these does not do, or these copies suffice
        margin, whole = self.finding["margin"], margins.get(0)
        same = 0 in margins and (margin is None or (whole is not None and abs(whole - margin) < 1e-6))
        if not same:
            self.restart(self.size + 1)
        elif self._is_whole or self._is_decided(numbers, {*margins, *passes}, len(margins) - 1):
            self.n_copies = numbers[-1]
            self.n_stays += len(margins) - 1
            self.margins += [margin for number, margin in margins.items() if number]
        else:
            self.restart(self.size + 1)
            self.is_doubtful = True

    @property
    def _is_whole(self) -> bool:
        """Whether no step outside the window can keep the finding: one of a stretch does, and the first window may not have all."""
        start, end = span(self)
        whole = start <= self.finding["t_start_ns"] and end >= self.finding["t_end_ns"]
        return self.size > 0 or self.finding["t_ref_ns"] is not None or whole

    def _is_decided(self, numbers: Sequence[int], conclusive_copies: Collection[int], n_stays: int) -> bool:
        """Whether undecided copies can be counted as lost: there are none, or the finding is only possible anyway."""
        may_stay = self.n_stays + n_stays + len(set(numbers) - set(conclusive_copies)) + N_COPIES[-1] - numbers[-1]
        return set(conclusive_copies) >= set(numbers) or may_stay < LEAST_SHARE * N_COPIES[-1]

    def restart(self, size: int) -> None:
        """Forget the copies, and try this size of window; none is left: it stays without an answer."""
        self.size, self.n_copies, self.n_stays, self.margins, self.extent = size, 0, 0, [], None


@dataclass(frozen=True)
class Outcome:
    """Of a finding in a window: the copies that keep it with their margins, and those in which its worst step passes."""

    margins: dict[int, float | None] = field(default_factory=dict)
    passes: set[int] = field(default_factory=set)


def breach(question: Question) -> tuple[str, ...]:
    """Return which drive, ego and rule a finding is of."""
    return tuple(question.finding[key] for key in ("drive_id", "ego_id", "rule_id"))


def by_weight(questions: Sequence[Question]) -> tuple[list[Question], list[Question], list[Question]]:
    """Return the gravest finding of each rule that an ego breaks, of the others those near the threshold, and the rest."""
    gravest: dict[tuple[str, ...], Question] = {}
    for question in sorted(questions, key=lambda q: np.nan_to_num(q.finding["margin"] or np.nan, nan=np.inf)):
        gravest.setdefault(breach(question), question)
    others = [question for question in questions if gravest[breach(question)] is not question]
    return list(gravest.values()), [q for q in others if q.is_near], [q for q in others if not q.is_near]
