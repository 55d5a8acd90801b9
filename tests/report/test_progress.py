"""What is told of the progress where stderr is no terminal."""

from __future__ import annotations

import time

import pytest
import rich.progress

from drivelint.report.progress import NotePrinter, ProgressBar, note_printer
from drivelint.report.rule_progress import ReportingRuleLimits


def test_it_is_told_once_a_minute_how_far_a_stage_is(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    now_s = 1000.0
    monkeypatch.setattr("drivelint.report.progress.time.monotonic", lambda: now_s)
    listener = NotePrinter()
    listener.stage("auditing", 5000)
    for _ in range(12):
        now_s += 11
        listener.advance(10)
    listener.stage("listing", None)
    now_s += 100
    listener.advance()
    assert capsys.readouterr().err == (
        "drivelint: auditing: 60 of 5,000, about 91 min left\ndrivelint: auditing: 120 of 5,000, about 89 min left\n"
    )


def test_a_step_that_takes_long_is_told_and_what_was_done_before_says_nothing_of_the_rest(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    now_s = 0.0
    monkeypatch.setattr("drivelint.report.progress.time.monotonic", lambda: now_s)
    monkeypatch.setattr("drivelint.report.progress._PRINT_DUE_CHECK_PERIOD_S", 0.001)
    with note_printer() as listener:
        listener.stage("checking", 10)
        listener.advance(8)
        listener.doing("judging 2 drives: rule 26 of 51", 1.0)
        now_s = 61.0
        while not (said := capsys.readouterr().err):
            time.sleep(0.001)
    assert said == "drivelint: checking: 8 of 10 (judging 2 drives: rule 26 of 51), about 1 min left\n"


def test_the_bar_moves_within_a_batch() -> None:
    drawn = rich.progress.Progress(disable=True)
    bar = ProgressBar(drawn)
    limits = ReportingRuleLimits(bar, 3, None)
    bar.stage("checking", 5)
    limits.begin_batch(2)
    moved = []
    for rule_id in ("a", "b", "b", "c"):
        with limits.limit_statements(None, rule_id, alone=True):  # type: ignore[arg-type]
            moved.append(drawn.tasks[0].completed)
    bar.advance(2)
    assert [*moved, drawn.tasks[0].completed] == [0.5, 1.0, 1.0, 1.5, 2]
    assert drawn.tasks[0].description == "judging 2 drives: rule 3 of 3"
