"""Who judges again judges as the run did: a rule that it named by its id is unknown without its signal, any other does not apply."""

from __future__ import annotations

from io import StringIO
from typing import TYPE_CHECKING

import pytest
from rich.console import Console

from drivelint.explain import ExplainRequest, Explanation, MeasurementErrors, explain
from drivelint.explain.text import render
from drivelint.pack import VerifyRequest, verify
from tests.explain.overtake_check import OVERTAKE, check
from tests.pack.packed import make_pack

if TYPE_CHECKING:
    from pathlib import Path

HORN = "ukhc.r112.horn"


@pytest.mark.parametrize(
    ("selector", "verdict"),
    [pytest.param("ukhc.r112*", "not_applicable"), pytest.param(HORN, "unknown", marks=pytest.mark.ci)],
)
def test_a_signal_that_the_log_has_not(selector: str, verdict: str, tmp_path: Path) -> None:
    result = check(
        tmp_path / "result",
        traces=(str(OVERTAKE / "near_miss.csv"),),
        rules=("ukhc.no-collision", selector),
        params=(),
        robustness=False,
    )
    assert {row["verdict"] for row in result.verdicts.to_pylist() if row["rule_id"] == HORN} == {verdict}

    pack = make_pack(tmp_path / "result", tmp_path / "pack", with_inputs=True)
    verified = verify(VerifyRequest(pack))
    assert verified.problems == []
    assert "judged again: the same bytes" in verified.sentence

    explanation = explain(ExplainRequest(HORN, tmp_path / "result", errors=MeasurementErrors(samples=0)))
    assert explanation.verdict["judged_anew"] == verdict
    assert not [note for note in explanation.notes if "Judged again" in note]
    screen = screen_text(explanation)
    assert ("NOT APPLICABLE: the log does not contain a signal that the rule needs" in screen) == (verdict != "unknown")
    assert "did not happen" not in screen


def screen_text(explanation: Explanation) -> str:
    console = Console(width=120, file=StringIO())
    console.print(render(explanation, 120))
    assert isinstance(console.file, StringIO)
    return console.file.getvalue()
