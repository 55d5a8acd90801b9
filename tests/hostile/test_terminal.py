"""What the commands print: no word of a log, a map or a rule steers the terminal, or is a line or a command of its own."""

from __future__ import annotations

import csv
import io
import json
import os
import pty
import re
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from tests.fleet_report.command import Ran, ran
from tests.hostile.drive import write_mcap
from tests.hostile.readers import assert_quiet
from tests.hostile.words import EGO, FILE, MARK, ONCOMING
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from tests.hostile.conftest import Nasty

QUERY = "SELECT drive_id, ego_id, object_id, reason, margin FROM findings ORDER BY ALL"


def assert_said(run: Ran, *codes: int) -> str:
    assert run.code in codes, run.err
    assert_quiet(run.err)
    assert MARK in run.out
    return run.out


def test_check(nasty: Nasty) -> None:
    said = assert_said(nasty.check_run, 1)
    assert_quiet(said)
    (hint,) = re.findall(r"^explain  drivelint explain (\S+) --in ", said, re.MULTILINE)
    assert re.fullmatch("[0-9a-f]{16}", hint)
    done = ran("check", nasty.files.log, *nasty.files.options, "--rules", "evil", "--no-robustness", "--verbose")
    assert_quiet(assert_said(done, 1))


def test_a_terminal_gets_no_sequences_but_our_colours(nasty: Nasty) -> None:
    command = [sys.executable, "-m", "drivelint", "rules", "show", "--rules-dir", str(nasty.files.rules), "evil.near"]
    ours, theirs = pty.openpty()
    env = {**os.environ, "PYTHONPATH": str(ROOT / "src"), "TERM": "xterm-256color", "COLUMNS": "120"}
    with subprocess.Popen(command, stdout=theirs, stderr=subprocess.PIPE, env=env) as run:
        os.close(theirs)
        said = b""
        while block := _read(ours):
            said += block
        assert run.stderr
        assert run.stderr.read() == b""
    os.close(ours)
    text = said.decode().replace("\r\n", "\n")
    assert "\x1b[1m" in text
    assert MARK in text
    assert_quiet(text, styled=True)


def _read(terminal: int) -> bytes:
    try:
        return os.read(terminal, 1 << 16)
    except OSError:  # nobody writes to it any more
        return b""


@pytest.mark.parametrize(
    "words", [("rules", "list", "evil"), ("rules", "show", "evil.near"), ("rules", "list", "evil", "--format", "json")]
)
def test_rules(nasty: Nasty, words: tuple[str, ...]) -> None:
    assert_quiet(assert_said(ran(*words, "--rules-dir", nasty.files.rules), 0))


@pytest.mark.slow
def test_explain_and_inspect(nasty: Nasty) -> None:
    assert_quiet(assert_said(ran("explain", "evil.near", "--in", nasty.result, "--samples", 0), 0))
    told = ran("explain", "evil.near", "--in", nasty.result, "--samples", 0, "--format", "json")
    assert_quiet(assert_said(told, 0))
    assert json.loads(told.out)["verdict"]["object_id"] == ONCOMING
    assert_quiet(assert_said(ran("inspect", nasty.files.log, *nasty.files.options), 0))
    told = ran("inspect", nasty.files.log, *nasty.files.options, "--format", "json")
    assert_quiet(assert_said(told, 0))
    assert json.loads(told.out)["file"]["name"] == nasty.files.log.name


def test_inspect_a_log_with_foreign_topics(tmp_path: Path) -> None:
    write_mcap(tmp_path / "topics.mcap")
    for format_ in ("text", "json"):
        assert_quiet(assert_said(ran("inspect", tmp_path / "topics.mcap", "--format", format_), 0))


@pytest.mark.slow
def test_diff(nasty: Nasty) -> None:
    less = nasty.result.with_name("less")
    done = ran(
        "check", nasty.files.log, *nasty.files.options, "--rules", "evil.unknown", "--no-robustness", "--out", less
    )
    assert done.code == 4, done.err  # nothing can be decided
    for base, new in ((nasty.result, less), (less, nasty.result), (nasty.audit, nasty.audit)):
        for format_ in ("text", "json", "markdown"):
            done = ran("diff", base, new, "--format", format_)
            assert_quiet(done.out.replace("\u2060", ""))
            assert_quiet(done.err)
            assert MARK in done.out or base == new


def test_what_if_and_the_fleets_summary(nasty: Nasty) -> None:
    for format_ in ("text", "json"):
        done = ran("what-if", nasty.audit, "evil.near.near_m=2", "--format", format_)
        assert done.out, done.err
        assert_quiet(done.out + done.err)


def test_sql(nasty: Nasty) -> None:
    for folder in (nasty.result, nasty.audit):
        assert_quiet(assert_said(ran("sql", folder, QUERY), 0))
        told = assert_said(ran("sql", folder, QUERY, "--format", "json"), 0)
        assert_quiet(told)
        assert {row["ego_id"] for row in json.loads(told)} == {EGO}


def test_csv_is_text_to_a_spreadsheet_and_numbers_stay_numbers(nasty: Nasty) -> None:
    told = assert_said(ran("sql", nasty.result, QUERY, "--format", "csv"), 0)
    assert_quiet(told, lines_are_ours=False)
    head, *rows = csv.reader(io.StringIO(told))
    assert head == ["drive_id", "ego_id", "object_id", "reason", "margin"]
    assert len(rows) > 1
    for row in rows:
        assert len(row) == len(head)
        assert row[1].startswith("'=1+1")
        assert not [cell for cell in row[:-1] if cell[:1] in set("=+-@\t\r\n")]
        assert float(row[-1]) < 0
    done = ran(
        "sql",
        nasty.result,
        "SELECT '-1e5' AS a, '-x' AS b, '=1' AS c, '' AS d, NULL AS e, '-,' AS f",
        "--format",
        "csv",
    )
    assert done.out == 'a,b,c,d,e,f\n-1e5,\'-x,\'=1,"",,"\'-,"\n'


def test_convert_and_its_clip(nasty: Nasty, tmp_path: Path) -> None:
    words = (
        "convert",
        nasty.files.log,
        "--to",
        "mcap",
        "--out",
        tmp_path,
        "--in",
        nasty.result,
        "--clip",
        "ukhc.no-collision",
    )
    said = assert_said(ran(*words), 0)
    assert_quiet(said)
    assert len(said.strip().split("\n")) == 2
    (clip,) = tmp_path.iterdir()
    assert clip.name.startswith(f"{FILE}-clip-")
