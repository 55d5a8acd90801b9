"""What is told of the progress where stderr is no terminal."""

from __future__ import annotations

import pytest

from drivelint.report.progress import NotePrinter


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
    assert capsys.readouterr().err == "drivelint: auditing: 60 of 5,000\ndrivelint: auditing: 120 of 5,000\n"
