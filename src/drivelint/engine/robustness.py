"""Counts for each critical and major finding in how many copies with the errors of a recording it is a finding too.

Only a window of the drive around a finding is copied, with the actors near the ego, and judged by the rules that failed.
The window's copy without errors must give the finding with the same margin: where it does not, a wider window is tried, and
then none. Few copies come first; more follow only where these do not tell whether 95 % of all would keep the finding.
What one pass judges, it judges at once: the time of a pass hardly depends on its rows while they are few.
"""

from __future__ import annotations

import math
from contextlib import ExitStack
from dataclasses import dataclass, field
from statistics import fmean, stdev
from typing import TYPE_CHECKING, Any, Final

import duckdb
import pyarrow as pa

from drivelint.engine import batch
from drivelint.engine.copies import copies
from drivelint.engine.derive import derive
from drivelint.engine.window import Window, windows
from drivelint.errors import DriveLintError, RuleError
from drivelint.evaluate import evaluate
from drivelint.sql import store
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from drivelint.catalogue import Rule
    from drivelint.engine.batch import Drive
    from drivelint.engine.copies import MeasurementErrors
    from drivelint.engine.memory import Memory
    from drivelint.evaluate.limits import RuleLimits

SAME_REFERENCE_NS: Final = 2_000_000_000
"""A reference point that moved by no more is the same one."""
N_COPIES: Final = (5, 12, 40, 100)
"""Copies after which it is asked whether they suffice."""
SURE_SPREADS: Final = {5: 3.400, 12: 2.448, 40: 2.010}
"""Copies -> by how many standard deviations the mean of their margins must be below 0, so that 95 % of all are, with 90 % confidence:
one-sided tolerance factors of a normal distribution."""
MOST_OF_LOST: Final = {12: 10, 40: 36}
"""Copies -> how many at most keep a finding that clearly does not stay in 95 %: one that does has so few in 1 of 7 draws."""
SMALL_MARGIN: Final = {"m": 1.0, "s": 0.2}
"""Unit -> margin up to which the first copies would not suffice, as errors of a decimetre may take it away."""
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
    known_whole: bool = False
    """The window's copy without errors gave the finding."""
    n_copies: int = 0
    margins: list[float | None] = field(default_factory=list)
    """Those of the copies that keep it."""

    @property
    def numbers(self) -> range:
        """The copies to judge next; the copy without errors comes first."""
        margin = self.finding["margin"]
        few = margin is not None and abs(margin) > SMALL_MARGIN.get(self.rule.unit or "", 0.0)
        goal = next(n for n in N_COPIES if n > self.n_copies and (few or n > N_COPIES[0]))
        return range(self.n_copies + 1 if self.known_whole else 0, goal + 1)

    @property
    def is_settled(self) -> bool:
        """Whether the copies suffice."""
        n_stays = len(self.margins)
        if self.n_copies >= N_COPIES[-1]:
            return True
        if n_stays < self.n_copies:
            return n_stays <= MOST_OF_LOST.get(self.n_copies, 0)
        numbers = [margin for margin in self.margins if margin is not None and math.isfinite(margin)]
        if len(numbers) < n_stays or n_stays < 2:
            return self.n_copies >= N_COPIES[1]
        return fmean(numbers) + SURE_SPREADS[self.n_copies] * stdev(numbers) <= 0.0


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

    def judge(self, drives: Sequence[Drive]) -> None:
        """Write `n_copies` and `n_stays` of the findings of these drives, whose own tables are not needed any more."""
        ids = [drive.trace.drive_id for drive in drives]
        rows = self._con.execute(statement("robustness/findings"), {"drives": ids}).to_arrow_table().to_pylist()
        questions = [Question(row, self._rules[row["rule_id"]]) for row in rows]
        by_id = {drive.trace.drive_id: drive for drive in drives}
        open_ = questions
        while open_:
            for chunk in _chunks(windows(by_id, open_, N_COPIES)):
                self._try(chunk)
            open_ = [q for q in open_ if q.size < Window.SIZES and not (q.known_whole and q.is_settled)]
        self._answer([q for q in questions if q.known_whole])

    def _try(self, chunk: Sequence[Window]) -> None:
        """Judge windows together; if that errs, one by one, so that one rule's fault is not the others'."""
        try:
            found = self._stays(chunk)
        except (DriveLintError, duckdb.Error) as error:
            if len(chunk) > 1:
                for window in chunk:
                    self._try([window])
                return
            if isinstance(error, duckdb.OutOfMemoryException) and self._memory.lift_limit():
                self._try(chunk)
                return
            for question in chunk[0].questions:
                question.known_whole, question.size = False, Window.SIZES  # it stays without an answer
            return
        for window in chunk:
            for question in window.questions:
                kept = found.get(id(question), {})  # of both windows, where it is asked in two
                _take(question, window.numbers, {number: kept[number] for number in window.numbers if number in kept})

    def _stays(self, chunk: Sequence[Window]) -> dict[int, dict[int, float | None]]:
        """Return question -> copy that keeps it -> its margin there."""
        made = [copies(window.part(f"{no:05}"), self._errors, window.numbers) for no, window in enumerate(chunk)]
        questions = [question for window in chunk for question in window.questions]
        rules = {question.rule.id: question.rule for question in questions}
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
        found: dict[int, dict[int, float | None]] = {}
        for finding_no, copy_no, margin in stays:
            found.setdefault(id(questions[finding_no]), {})[copy_no] = margin
        return found

    def _answer(self, questions: Sequence[Question]) -> None:
        if not questions:
            return
        rows = [
            {
                **{key: q.finding[key] for key in ("drive_id", "finding_id")},
                "n_copies": q.n_copies,
                "n_stays": len(q.margins),
            }
            for q in questions
        ]
        self._con.register("_answer", pa.Table.from_pylist(rows))
        self._con.execute(statement("robustness/answer"))
        self._con.unregister("_answer")


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
        }
        for finding_no, (no, question) in enumerate(asked)
    ]
    return {"_copy": copies_, "_question": findings}


def _take(question: Question, numbers: range, stays: Mapping[int, float | None]) -> None:
    """Let a question know which of these copies keep its finding."""
    if not question.known_whole:
        if numbers.start:
            return  # the copy without errors has told that its window does not do
        margin, whole = question.finding["margin"], stays.get(0)
        same = 0 in stays and (margin is None or (whole is not None and abs(whole - margin) < 1e-6))
        if not same:
            question.size += 1
            return
        question.known_whole = True
    question.n_copies = numbers[-1]
    question.margins += [margin for number, margin in sorted(stays.items()) if number]


def _chunks(all_: Sequence[Window]) -> Iterator[list[Window]]:
    """Cut windows into those whose copies fit into one pass, a larger one being a pass of its own."""
    chunk: list[Window] = []
    n_states = 0
    for window in all_:
        if chunk and n_states + window.n_states > batch.BATCH_STATES:
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
