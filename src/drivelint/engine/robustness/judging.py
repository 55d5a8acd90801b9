"""Counts for each critical and major finding in how many copies with recording errors it stays a finding.

Only a window of the drive around the finding, with the actors near the ego, is copied, and judged by the rule that failed. The first
window is some seconds around the worst step. Its copy without errors must give the finding with the same margin. Otherwise wider windows
are tried; if none gives that margin, the finding gets no count.

The finding of an invariant is a stretch of steps. It stays in a copy if any of its steps fails there. It is lost if its worst step passes,
because a copy's errors are the same at all steps. If the first window has only a part of the stretch and a copy shows neither, a wider
window is judged, unless so many copies lose the finding that it is only possible.

If an ego breaks a rule several times, copies are judged for the worst finding, and for findings whose margins are as small as the errors.
If the worst finding is only possible, the other findings of this ego and rule follow. On request, copies are judged for all findings.

At most 100 copies are judged. 20 are enough if all of them keep the finding, unless their margins are near 0. Judging ends early if so
many copies lose the finding that it is only possible.
"""

from __future__ import annotations

from contextlib import ExitStack
from itertools import takewhile
from typing import TYPE_CHECKING, Final

import duckdb
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.engine.batch import MAX_BATCH_STATES, have_many_states
from drivelint.engine.derive import derive
from drivelint.engine.robustness.copies import copies
from drivelint.engine.robustness.question import (
    N_COPIES_TO_SETTLE,
    OutcomeInCopies,
    RobustnessQuestion,
    drive_ego_and_rule,
    worst_near_and_other_questions,
)
from drivelint.engine.robustness.window import N_WINDOW_SIZES, Window, set_extents, windows_to_judge
from drivelint.errors import DriveLintError, RuleError
from drivelint.evaluate import evaluate
from drivelint.sql import store
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from drivelint.catalogue import Rule
    from drivelint.engine.batch import Drive
    from drivelint.engine.memory import MemoryLimit
    from drivelint.engine.robustness.copies import MeasurementErrors
    from drivelint.evaluate.limits import RuleLimits

SAME_REFERENCE_POINT_TOLERANCE_NS: Final = 2_000_000_000
"""Reference points of a drive and of its copy are the same if they are at most this far apart."""
MOST_STATES_FOR_ONE_PASS: Final = 10_000
"""If the additional copies have at most this many states, all copies are judged in one pass. They cost a quarter of the fixed cost of a
second pass."""
_TABLES_READ_BY_EVALUATION: Final = ("clock", "step", "ego_state", "pair", "ego_condition")
"""Tables that the evaluation itself reads, except those that only unknown verdicts need."""
_TABLES_COPIED_FROM_DRIVE: Final = frozenset({"capability", "registration"})


class RobustnessJudge:
    """Judges copies in the database of a session.

    `load` fills the database with drives, `forget_excesses` deletes the rows of drives. `of_all`: judge copies for all critical and major
    findings.
    """

    def __init__(
        self,
        con: duckdb.DuckDBPyConnection,
        rules: Sequence[Rule],
        params: Mapping[str, Mapping[str, object]],
        *,
        errors: MeasurementErrors,
        memory: MemoryLimit,
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
        self._limits.memory = memory.most_growth_bytes
        self._is_stopped = is_stopped
        self._of_all = of_all
        self._waiting: dict[str, Drive] = {}
        self._advance: Callable[[int], None] = lambda _: None

    def add(self, drives: Sequence[Drive]) -> None:
        """Keep the drives with findings, and judge their copies once there are enough: few copies cost nearly as much as many."""
        ids = [drive.trace.drive_id for drive in drives]
        findings = self._con.execute(statement("robustness/findings"), {"drives": ids}).to_arrow_table()
        with_findings = set(pc.unique(findings["drive_id"]).to_pylist())
        self._waiting |= {name: drive for name, drive in zip(ids, drives, strict=True) if name in with_findings}
        if sum(drive.n_states for drive in self._waiting.values()) > MAX_BATCH_STATES:
            self.judge()

    @property
    def n_waiting_drives(self) -> int:
        """The number of drives whose copies are not judged yet."""
        return len(self._waiting)

    def n_findings_to_copy_first(self) -> int:
        """Return the number of findings of the waiting drives for which copies are judged first."""
        questions = self._questions(self._waiting)
        gravest, near, _ = worst_near_and_other_questions(questions)
        return len(questions) if self._of_all else len(gravest) + len(near)

    def _questions(self, drives: Iterable[str]) -> list[RobustnessQuestion]:
        findings = self._con.execute(statement("robustness/findings"), {"drives": list(drives)}).to_arrow_table()
        return [
            RobustnessQuestion(row, self._rules[row["rule_id"]], ends_early=not self._of_all)
            for row in findings.to_pylist()
        ]

    def judge(self, advance: Callable[[int], None] | None = None) -> None:
        """Judge copies for the findings of the waiting drives, and write `n_copies` and `n_stays`.

        A finding that is not settled when the run is stopped gets no count. `advance` is called with the number of newly settled findings.
        """
        by_id, self._waiting = self._waiting, {}
        if not by_id:
            return
        self._advance = advance or (lambda _: None)
        questions = self._questions(by_id)
        set_extents(questions)  # of all findings, so that the windows do not depend on which of them are judged
        gravest, near, rest = worst_near_and_other_questions(questions)
        most_states = MAX_BATCH_STATES
        if have_many_states(by_id.values()):
            self._memory.release_unused_memory()
            most_states //= 2
        self._judge_until_settled(by_id, questions if self._of_all else [*gravest, *near], most_states)
        doubtful = {drive_ego_and_rule(question) for question in gravest if not question.is_finding_certain}
        self._judge_until_settled(
            by_id, [question for question in rest if drive_ego_and_rule(question) in doubtful], most_states
        )
        self._write_copy_counts([q for q in questions if q.n_copies and q.is_settled])

    def _judge_until_settled(
        self, drives: Mapping[str, Drive], questions: Sequence[RobustnessQuestion], most_states: int
    ) -> None:
        """Judge copies until all questions are settled, no larger window is left, or the run is stopped."""
        open_: Sequence[RobustnessQuestion] = [question for question in questions if not question.is_settled]
        while open_ and not self._is_stopped():
            chunks = _groups_of_windows(_next_windows(drives, open_), most_states)
            for chunk in takewhile(lambda _chunk: not self._is_stopped(), chunks):
                self._judge_windows(chunk)
            left = [q for q in open_ if q.size < N_WINDOW_SIZES and not q.is_settled]
            self._advance(len(open_) - len(left))
            open_ = left

    def _judge_windows(self, chunk: Sequence[Window]) -> None:
        """Judge windows together; if that fails, judge them one by one, so that only the faulty window gets no result."""
        try:
            with store.uniform_memory_errors():
                outcomes_by_window = self._outcomes_by_window_and_question(chunk)
        except (DriveLintError, duckdb.Error, MemoryError, pa.ArrowException) as error:
            if len(chunk) > 1:
                for window in chunk:
                    self._judge_windows([window])
                return
            if isinstance(error, duckdb.OutOfMemoryException) and self._memory.raise_to_machine_limit():
                self._judge_windows(chunk)
                return
            for question in chunk[0].questions:
                question.restart_with_window_size(N_WINDOW_SIZES)
            return
        for window, outcomes in zip(chunk, outcomes_by_window, strict=True):
            for question in window.questions:
                outcome = outcomes.get(id(question), OutcomeInCopies())
                question.add_results_of_copies(window.numbers, outcome.margins, outcome.passes)

    def _outcomes_by_window_and_question(self, chunk: Sequence[Window]) -> list[dict[int, OutcomeInCopies]]:
        """Judge the copies of the windows, and return for each window: id of the question -> outcome."""
        ids_and_drives = [
            copies(window.part_with_suffix(f"{no:05}"), self._errors, window.numbers) for no, window in enumerate(chunk)
        ]
        questions = [(no, question) for no, window in enumerate(chunk) for question in window.questions]
        rules = {question.rule.id: question.rule for _, question in questions}
        reads = {table for rule in rules.values() for table in rule.reads}
        with store.one_thread(self._con), ExitStack() as undo:
            undo.callback(self._forget, [name for ids, _ in ids_and_drives for name in ids])
            self._load([drives for _, drives in ids_and_drives])
            for name, rows in _copy_and_question_rows(chunk, [ids for ids, _ in ids_and_drives]).items():
                self._con.register(name, pa.Table.from_pylist(rows, schema=_schema_of_columns(rows[0])))
                undo.callback(self._con.unregister, name)
            self._con.execute(statement("robustness/capability"))
            derive(
                self._con,
                reads,
                are_map_tables=False,
                always_needed_tables=_TABLES_READ_BY_EVALUATION,
                filled_tables=_TABLES_COPIED_FROM_DRIVE,
            )
            ordered_rules = [rules[name] for name in sorted(rules)]
            params = {r.id: self._params[r.id] for r in ordered_rules if r.id in self._params}
            evaluate(self._con, ordered_rules, params, may_retry=True, limits=self._limits)
            erred = "SELECT rule_id FROM verdict v SEMI JOIN _copy c ON v.drive_id = c.copy_id WHERE verdict = 'error' LIMIT 1"
            if len(chunk) > 1 and (row := self._con.execute(erred).fetchone()):
                raise RuleError(f"{row[0]} failed on copies of {len(chunk)} windows")
            stays = self._con.execute(
                statement("robustness/stays"), {"same_reference_ns": SAME_REFERENCE_POINT_TOLERANCE_NS}
            ).fetchall()
        outcomes_by_window: list[dict[int, OutcomeInCopies]] = [{} for _ in chunk]
        for finding_no, copy_no, keeps, margin in stays:
            no, question = questions[finding_no]
            outcome = outcomes_by_window[no].setdefault(id(question), OutcomeInCopies())
            if keeps:
                outcome.margins[copy_no] = margin
            else:
                outcome.passes.add(copy_no)
        return outcomes_by_window

    def _write_copy_counts(self, questions: Sequence[RobustnessQuestion]) -> None:
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


def _next_windows(drives: Mapping[str, Drive], questions: Sequence[RobustnessQuestion]) -> list[Window]:
    """Return the windows to judge next, with all copies at once if that costs less than another pass."""
    windows = windows_to_judge(drives, questions, N_COPIES_TO_SETTLE)
    more = sum(
        window.n_states * (N_COPIES_TO_SETTLE[-1] // len(window.numbers))
        for window in windows
        if window.numbers[1] == 1
    )
    if more > MOST_STATES_FOR_ONE_PASS:
        return windows
    for question in questions:
        question.is_hasty = True
    return windows_to_judge(drives, questions, N_COPIES_TO_SETTLE)


def _copy_and_question_rows(
    chunk: Sequence[Window], ids: Sequence[Sequence[str]]
) -> dict[str, list[dict[str, object]]]:
    """Return the rows of the tables `_copy` and `_question`: the copies and the findings to search in them, by window."""
    copies_ = [
        {"window_id": no, "copy_id": name, "copy_no": number, "drive_id": window.drive_id, "ego_id": window.ego_id}
        for no, window in enumerate(chunk)
        for name, number in zip(ids[no], window.numbers, strict=True)
    ]
    numbered_questions = [(no, question) for no, window in enumerate(chunk) for question in window.questions]
    same = ("ego_id", "rule_id", "profile", "object_id", "t_ref_ns")
    findings = [
        {
            "finding_no": finding_no,
            "window_id": no,
            **{key: question.finding[key] for key in same},
            "any_object": question.rule.combine != "each",  # in a copy, another object may decide
            "t_from_ns": question.finding["t_start_ns"],
            "t_to_ns": question.finding["t_end_ns"],
            "t_worst_ns": question.finding["t_worst_ns"],
        }
        for finding_no, (no, question) in enumerate(numbered_questions)
    ]
    return {"_copy": copies_, "_question": findings}


def _groups_of_windows(windows: Sequence[Window], most_states_per_group: int) -> Iterator[list[Window]]:
    """Yield groups of windows whose copies have at most `most_states_per_group` states; larger windows are split into parts with fewer
    copies."""
    chunk: list[Window] = []
    n_states = 0
    for window in (part for whole in windows for part in whole.split_by_copies(most_states_per_group)):
        if chunk and n_states + window.n_states > most_states_per_group:
            yield chunk
            chunk, n_states = [], 0
        chunk.append(window)
        n_states += window.n_states
    if chunk:
        yield chunk


def _schema_of_columns(row: Mapping[str, object]) -> pa.Schema:
    """Return the schema of a table by the names of its columns, because all values of a column may be NULL."""
    texts = {"copy_id", "drive_id", "ego_id", "rule_id", "profile", "object_id"}
    kinds = {"any_object": pa.bool_(), **dict.fromkeys(texts, pa.string())}
    return pa.schema([(name, kinds.get(name, pa.int64())) for name in row])
