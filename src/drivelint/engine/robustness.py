"""Counts for each critical and major finding in how many copies with the errors of a recording it is a finding too.

Only a window of the drive around a finding is copied, with the actors near the ego, and judged by the rules that failed. The first
window has some seconds around the worst step. Its copy without errors must give the finding with the same margin: where it does not,
a wider window is tried, and then none.

A stretch stays in a copy where any step of it fails. The errors of a copy are the same at all steps, so a copy in which the worst step
passes loses the stretch. Where the first window has only a part of the stretch and a copy tells neither, the wider one is judged,
unless so few copies keep the finding that it is only possible anyway.

Of a rule that an ego breaks several times, the gravest finding is judged, and those that are as near to the threshold as the errors are
large. Where one of these is only possible, the others are judged too. Whoever asks for them gets the copies of all findings.

100 copies are judged, 32 where all of these keep the finding, or 20 where their margins are far from 0, too. Fewer are enough where so
many of them lose it that it is only possible, whatever the others would tell.
"""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass, field
from functools import cached_property
from itertools import takewhile
from typing import TYPE_CHECKING, Any, Final

import duckdb
import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.engine.batch import BATCH_STATES, are_large
from drivelint.engine.copies import copies
from drivelint.engine.derive import derive
from drivelint.engine.window import SIZES, Window, cut, span, windows
from drivelint.errors import DriveLintError, RuleError
from drivelint.evaluate import evaluate
from drivelint.sql import store
from drivelint.sql.derivations import with_sources
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterator, Mapping, Sequence

    from drivelint.catalogue import Rule
    from drivelint.engine.batch import Drive
    from drivelint.engine.copies import MeasurementErrors
    from drivelint.engine.memory import Memory
    from drivelint.engine.window import Extent
    from drivelint.evaluate.limits import RuleLimits

SAME_REFERENCE_NS: Final = 2_000_000_000
"""A reference point that moved by no more is the same one."""
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
HASTY_STATES: Final = 10_000
"""So many copied states cost a quarter of what a pass over none costs, which most runs do not need."""
_DERIVED: Final = ("clock", "step", "ego_state", "pair", "ego_condition")
"""What the evaluation reads itself, without what it reads for verdicts that are unknown."""
_HANDED_OVER: Final = frozenset({"capability", "registration"})


@dataclass
class Question:
    """A finding, and what its copies have told so far."""

    finding: dict[str, Any]
    rule: Rule
    size: int = 0
    """Which size of window is tried."""
    n_copies: int = 0
    n_stays: int = 0
    """How many of them keep it."""
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
        if self.n_copies >= most or self.n_copies - self.n_stays > (1.0 - LEAST_SHARE) * most:
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
        """Learn which of these copies of a window keep the finding, with what margins; the first is the one without errors.

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

    def _is_decided(self, numbers: Sequence[int], told: Collection[int], n_stays: int) -> bool:
        """Whether copies that do not tell can be counted as lost: there are none, or the finding is only possible anyway."""
        may_stay = self.n_stays + n_stays + len(set(numbers) - set(told)) + N_COPIES[-1] - numbers[-1]
        return set(told) >= set(numbers) or may_stay < LEAST_SHARE * N_COPIES[-1]

    def restart(self, size: int) -> None:
        """Forget the copies, and try this size of window; none is left: it stays without an answer."""
        self.size, self.n_copies, self.n_stays, self.margins, self.extent = size, 0, 0, [], None


@dataclass(frozen=True)
class Outcome:
    """Of a finding in a window: the copies that keep it with their margins, and those in which its worst step passes."""

    margins: dict[int, float | None] = field(default_factory=dict)
    passes: set[int] = field(default_factory=set)


class Robustness:
    """Judges copies in the database of a session, which `load`s drives into it and `forget`s all that is there of them."""

    def __init__(
        self,
        con: duckdb.DuckDBPyConnection,
        rules: Sequence[Rule],
        params: Mapping[str, Mapping[str, object]],
        *,
        errors: MeasurementErrors,
        memory: Memory,
        load: Callable[[Sequence[Drive]], None],
        forget: Callable[[Sequence[str]], None],
        limits: RuleLimits,
        is_stopped: Callable[[], bool],
        of_all: bool = False,
    ) -> None:
        self._con = con
        self._rules = {rule.id: rule for rule in rules}
        self._params = params
        self._errors = errors
        self._memory = memory
        self._load = load
        self._forget = forget
        self._limits = limits
        self._limits.memory = memory.most_growth
        self._is_stopped = is_stopped
        self._of_all = of_all
        self._waiting: dict[str, Drive] = {}

    def add(self, drives: Sequence[Drive]) -> None:
        """Keep the drives with findings until there are enough of them: a pass over few copies costs nearly what one over many does."""
        ids = [drive.trace.drive_id for drive in drives]
        found = self._con.execute(statement("robustness/findings"), {"drives": ids}).to_arrow_table()
        with_findings = set(pc.unique(found["drive_id"]).to_pylist())
        self._waiting |= {name: drive for name, drive in zip(ids, drives, strict=True) if name in with_findings}
        if sum(drive.n_states for drive in self._waiting.values()) > BATCH_STATES:
            self.judge()

    @property
    def n_waiting(self) -> int:
        """How many drives wait."""
        return len(self._waiting)

    def judge(self) -> None:
        """Write `n_copies` and `n_stays` of the findings of the drives that wait, whose own tables are not needed any more.

        A finding that is not settled when the run is stopped stays without an answer.
        """
        by_id, self._waiting = self._waiting, {}
        if not by_id:
            return
        rows = self._con.execute(statement("robustness/findings"), {"drives": list(by_id)}).to_arrow_table().to_pylist()
        questions = [Question(row, self._rules[row["rule_id"]]) for row in rows]
        cut(questions)  # findings of one overtake share a window, whichever of them are judged
        gravest, near, others = _by_weight(questions)
        most_states = BATCH_STATES
        if are_large(by_id.values()):
            self._memory.release()
            most_states //= 2
        self._settle(by_id, questions if self._of_all else [*gravest, *near], most_states)
        doubtful = {_breach(question) for question in gravest if not question.is_sure}
        self._settle(by_id, [question for question in others if _breach(question) in doubtful], most_states)
        self._answer([q for q in questions if q.n_copies and q.is_settled])

    def _settle(self, drives: Mapping[str, Drive], questions: Sequence[Question], most_states: int) -> None:
        """Judge copies until they suffice."""
        open_ = questions
        while open_ and not self._is_stopped():
            chunks = _chunks(_windows(drives, open_), most_states)
            for chunk in takewhile(lambda _chunk: not self._is_stopped(), chunks):
                self._try(chunk)
            open_ = [q for q in open_ if q.size < SIZES and not q.is_settled]

    def _try(self, chunk: Sequence[Window]) -> None:
        """Judge windows together; if that errs, one by one, so that one rule's fault is not the others'."""
        try:
            with store.telling_short_memory():
                found = self._stays(chunk)
        except (DriveLintError, duckdb.Error, MemoryError, pa.ArrowException) as error:
            if len(chunk) > 1:
                for window in chunk:
                    self._try([window])
                return
            if isinstance(error, duckdb.OutOfMemoryException) and self._memory.lift_limit():
                self._try(chunk)
                return
            for question in chunk[0].questions:
                question.restart(SIZES)
            return
        for window, outcomes in zip(chunk, found, strict=True):
            for question in window.questions:
                outcome = outcomes.get(id(question), Outcome())
                question.take(window.numbers, outcome.margins, outcome.passes)

    def _stays(self, chunk: Sequence[Window]) -> list[dict[int, Outcome]]:
        """Return for each window: question -> what its copies tell."""
        made = [copies(window.part(f"{no:05}"), self._errors, window.numbers) for no, window in enumerate(chunk)]
        asked = [(no, question) for no, window in enumerate(chunk) for question in window.questions]
        rules = {question.rule.id: question.rule for _, question in asked}
        reads = {table for rule in rules.values() for table in rule.reads}
        with store.one_thread(self._con), ExitStack() as undo:
            undo.callback(self._forget, [name for ids, _ in made for name in ids])
            self._load([many for _, many in made])
            for name, rows in _asked(chunk, [ids for ids, _ in made]).items():
                self._con.register(name, pa.Table.from_pylist(rows, schema=_schema(rows[0])))
                undo.callback(self._con.unregister, name)
            self._con.execute(statement("robustness/capability"))
            derive(self._con, reads, of_the_map=False, also=_DERIVED, given=_HANDED_OVER)
            judged = [rules[name] for name in sorted(rules)]
            params = {r.id: self._params[r.id] for r in judged if r.id in self._params}
            evaluate(self._con, judged, params, may_retry=True, limits=self._limits)
            erred = "SELECT rule_id FROM verdict v SEMI JOIN _copy c ON v.drive_id = c.copy_id WHERE verdict = 'error' LIMIT 1"
            if len(chunk) > 1 and (row := self._con.execute(erred).fetchone()):
                raise RuleError(f"{row[0]} erred on copies of {len(chunk)} windows")
            stays = self._con.execute(
                statement("robustness/stays"), {"same_reference_ns": SAME_REFERENCE_NS}
            ).fetchall()
        found: list[dict[int, Outcome]] = [{} for _ in chunk]
        for finding_no, copy_no, keeps, margin in stays:
            no, question = asked[finding_no]
            outcome = found[no].setdefault(id(question), Outcome())
            if keeps:
                outcome.margins[copy_no] = margin
            else:
                outcome.passes.add(copy_no)
        return found

    def _answer(self, questions: Sequence[Question]) -> None:
        if not questions:
            return
        rows = [
            {
                **{key: q.finding[key] for key in ("drive_id", "finding_id")},
                "n_copies": q.n_copies,
                "n_stays": q.n_stays,
            }
            for q in questions
        ]
        self._con.register("_answer", pa.Table.from_pylist(rows))
        self._con.execute(statement("robustness/answer"))
        self._con.unregister("_answer")


def _breach(question: Question) -> tuple[str, ...]:
    """Return which drive, ego and rule a finding is of."""
    return tuple(question.finding[key] for key in ("drive_id", "ego_id", "rule_id"))


def _by_weight(questions: Sequence[Question]) -> tuple[list[Question], list[Question], list[Question]]:
    """Return the gravest finding of each rule that an ego breaks, of the others those near the threshold, and the rest."""
    gravest: dict[tuple[str, ...], Question] = {}
    for question in sorted(questions, key=lambda q: np.nan_to_num(q.finding["margin"] or np.nan, nan=np.inf)):
        gravest.setdefault(_breach(question), question)
    others = [question for question in questions if gravest[_breach(question)] is not question]
    return list(gravest.values()), [q for q in others if q.is_near], [q for q in others if not q.is_near]


def _windows(drives: Mapping[str, Drive], questions: Sequence[Question]) -> list[Window]:
    """Return the windows to judge next, with all copies at once where that costs less than another pass."""
    found = windows(drives, questions, N_COPIES)
    more = sum(
        window.n_states * (N_COPIES[-1] // len(window.numbers)) for window in found if window.numbers[1] == 1
    )
    if more > HASTY_STATES:
        return found
    for question in questions:
        question.is_hasty = True
    return windows(drives, questions, N_COPIES)


def _asked(chunk: Sequence[Window], ids: Sequence[Sequence[str]]) -> dict[str, list[dict[str, object]]]:
    """Return the rows of the copies, and of the findings that are looked for in them, in the order of the windows."""
    copies_ = [
        {"window_id": no, "copy_id": name, "copy_no": number, "drive_id": window.drive_id, "ego_id": window.ego_id}
        for no, window in enumerate(chunk)
        for name, number in zip(ids[no], window.numbers, strict=True)
    ]
    asked = [(no, question) for no, window in enumerate(chunk) for question in window.questions]
    same = ("ego_id", "rule_id", "profile", "object_id", "t_ref_ns")
    findings = [
        {
            "finding_no": finding_no,
            "window_id": no,
            **{key: question.finding[key] for key in same},
            "any_object": question.rule.combine != "each",  # else the object is only the one that decided
            "t_from_ns": question.finding["t_start_ns"],
            "t_to_ns": question.finding["t_end_ns"],
            "t_worst_ns": question.finding["t_worst_ns"],
        }
        for finding_no, (no, question) in enumerate(asked)
    ]
    return {"_copy": copies_, "_question": findings}


def _chunks(all_: Sequence[Window], most_states: int) -> Iterator[list[Window]]:
    """Cut windows into those whose copies have at most so many states, a larger one being parts of fewer copies."""
    chunk: list[Window] = []
    n_states = 0
    for window in (part for whole in all_ for part in whole.parts(most_states)):
        if chunk and n_states + window.n_states > most_states:
            yield chunk
            chunk, n_states = [], 0
        chunk.append(window)
        n_states += window.n_states
    if chunk:
        yield chunk


def _schema(row: Mapping[str, object]) -> pa.Schema:
    """Return the schema of the rows of a table; a column may be NULL in all of them."""
    texts = {"copy_id", "drive_id", "ego_id", "rule_id", "profile", "object_id"}
    kinds = {"any_object": pa.bool_(), **dict.fromkeys(texts, pa.string())}
    return pa.schema([(name, kinds.get(name, pa.int64())) for name in row])
