"""A gate that counts sure findings only, and the word that reports have for the others."""

from __future__ import annotations

import json
from dataclasses import replace
from datetime import date
from pathlib import Path
from typing import TYPE_CHECKING

import pyarrow as pa
import pytest
from rich.console import Console

from drivelint import demo, run
from drivelint.arrays import replace_columns
from drivelint.gate import GateInputs
from drivelint.report import junit, markdown, sarif, terminal
from drivelint.report.progress import Silent
from drivelint.result import gate as gates
from drivelint.result.certainty import certainty
from drivelint.result.model import exit_status
from drivelint.result.names import GATE_FILE

if TYPE_CHECKING:
    from drivelint.result.model import Result

TODAY = date(2026, 11, 26)


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Result:
    """Return the contact of the demo's collision, which is 0.02 m deep: some copies keep it, others do not."""
    folder = tmp_path_factory.mktemp("demo")
    demo.write(folder)
    log = str(folder / "collision.mcap")
    found = run.check(run.CheckOptions((log,), map=folder / "road.xodr", rules=("ukhc.no-collision",)), Silent())
    assert found.findings.num_rows == 1
    return found


def copied(result: Result, n_copies: int | None, n_stays: int | None) -> Result:
    """Return a result whose finding has these copies."""
    return replace(result, findings=replace_columns(result.findings, {"n_copies": [n_copies], "n_stays": [n_stays]}))


def gated(result: Result, confidence: float | None) -> tuple[int, str]:
    status = exit_status(GateInputs(TODAY, confidence=confidence).apply_to(result))
    return int(status.code), status.why


@pytest.mark.parametrize(
    ("n_copies", "n_stays", "confidence", "code"),
    [
        (100, 94, 0.95, 0),
        (100, 95, 0.95, 1),
        (100, 94, 0.9, 1),
        (100, 0, None, 1),
        (None, None, 0.95, 1),  # nobody looked
    ],
)
def test_only_sure_findings_gate(
    result: Result, n_copies: int | None, n_stays: int | None, confidence: float | None, code: int
) -> None:
    got, why = gated(copied(result, n_copies, n_stays), confidence)
    assert got == code
    assert (f"(of that severity {1 - code} only possible)" in why) is (confidence is not None)


def test_without_a_gate_a_possible_finding_fails_the_run(result: Result) -> None:
    assert certainty(result.findings.to_pylist()[0]) == "possible"
    assert int(exit_status(result).code) == 1


def test_reports_call_it_possible(result: Result) -> None:
    doubtful, sure = copied(result, 100, 53), copied(result, 100, 100)
    words = "possible, in 53 of 100 copies with recording errors"
    for render in (junit.render, sarif.render, markdown.render):
        assert words in render(doubtful).decode()
        assert "possible" not in render(sure).decode().replace('"possible_findings"', "")
    properties = json.loads(sarif.render(doubtful))["runs"][0]["results"][0]["properties"]
    assert (properties["n_stays"], properties["n_copies"], properties["certainty"]) == (53, 100, "possible")
    for verbose in (False, True):
        console = Console(width=140)
        with console.capture() as shown:
            console.print(terminal.render(doubtful, None, 140, verbose=verbose))
        assert "possible contact in 1" in shown.get()
        assert "CONTACT" not in shown.get()


def test_the_gate_is_read_back_as_it_was_written(result: Result, tmp_path: Path) -> None:
    gate = GateInputs(TODAY, confidence=0.95).apply_to(copied(result, 100, 53)).gate
    assert gate is not None
    assert len(gate.possible) == 1
    (tmp_path / GATE_FILE).write_bytes(gates.render(gate))
    assert gates.load(tmp_path) == gate


def test_a_known_finding_is_counted_as_known(result: Result) -> None:
    doubtful = copied(result, 100, 53)
    again = GateInputs(TODAY, baseline=doubtful, confidence=0.95).apply_to(doubtful)
    assert exit_status(again).why.endswith("(of that severity 1 known, 0 only possible)")
    assert isinstance(again.findings, pa.Table)
