"""The command `explain` as a user meets it."""

from __future__ import annotations

import json
import sys
from typing import TYPE_CHECKING

import pytest

from drivelint import cli
from tests.explain.overtake_check import check

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("command")
    check(out, rules=("ukhc.no-collision",), params=(), robustness=False)
    return out


def ran(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], *args: str) -> tuple[int, str, str]:
    monkeypatch.setattr(sys, "argv", ["drivelint", "explain", *args])
    monkeypatch.setenv("COLUMNS", "100")
    with pytest.raises(SystemExit) as left:
        cli.main()
    out, err = capfd.readouterr()
    assert isinstance(left.value.code, int)
    return left.value.code, out, err


@pytest.mark.ci
def test_text_is_for_people(folder: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> None:
    code, out, err = ran(
        monkeypatch, capfd, "no-collision@safe", "--in", str(folder), "--samples", "4", "--sigma-map", "0.2"
    )
    assert (code, err) == (0, "")
    assert out.startswith("ukhc.no-collision: ")
    assert "Critical; a 'must' in the words of its clause" in out, "a rule of another pack is none of the Code's"
    assert "Passes in 4 of 4 copies of the drive." in out
    assert "0.2 m in the position of the map" in " ".join(out.split())
    assert "\x1b" not in out
    assert "Traceback" not in err


def test_the_sql_of_a_rule_is_folded_so_that_it_can_be_copied(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    asked = ("no-collision@safe", "--in", str(folder), "--samples", "0")
    _, out, _ = ran(monkeypatch, capfd, *asked)
    _, text, _ = ran(monkeypatch, capfd, *asked, "--format", "json")
    shown = out[out.index("-- @") :].splitlines()
    written = [line for sql in json.loads(text)["sql"].values() for line in sql.splitlines()]
    assert max(map(len, shown)) <= 100 < max(map(len, written))
    one, other = (
        " ".join(word for line in lines if not line.lstrip().startswith("--") for word in line.split())
        for lines in (shown, written)
    )
    assert one == other


@pytest.mark.ci
def test_json_is_for_programs(folder: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> None:
    args = ("no-collision", "--in", str(folder), "--samples", "0", "--format", "json")
    code, out, err = ran(monkeypatch, capfd, *args)
    assert (code, err) == (0, "")
    assert json.loads(out)["verdict"]["verdict"] == "fail"
    assert json.loads(out)["sensitivity"] is None


@pytest.mark.ci
def test_the_title_of_a_fail_is_the_breach(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    _, failed, _ = ran(monkeypatch, capfd, "no-collision@collision", "--in", str(folder), "--samples", "0")
    assert failed.splitlines()[0] == "ukhc.no-collision: Collision"
    assert "\n  No collision.\n" in failed.partition("What the rule requires")[2]
    _, kept, _ = ran(monkeypatch, capfd, "no-collision@safe", "--in", str(folder), "--samples", "0")
    assert kept.splitlines()[0] == "ukhc.no-collision: No collision"


def test_a_mistake_is_one_line(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    code, out, err = ran(monkeypatch, capfd, "abc", "--in", str(folder))
    assert (code, out) == (2, "")
    assert err.startswith("drivelint: error: no finding begins with 'abc'")
    assert err.count("\n") == 1
