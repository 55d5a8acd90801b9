"""An evidence pack of strangers' rules and logs: it stands when others look at it, and runs nothing that was not checked."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING

import duckdb
import pytest

from drivelint.catalogue.load import read_rule
from drivelint.errors import RuleError
from drivelint.pack.finding_sql import is_split_by_shell_as_by_parser, param_literal, text_literal
from drivelint.sql.syntax import with_values
from tests.fleet_report.command import ran
from tests.hostile.drive import OVERTAKE, RULE
from tests.hostile.readers import STEERING, assert_quiet
from tests.hostile.words import EGO, EVIL, FILE

if TYPE_CHECKING:
    from tests.hostile.conftest import Nasty


@pytest.fixture(scope="module")
def pack(nasty: Nasty, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("pack") / "pack"
    done = ran("pack", nasty.result, "--out", out)
    assert done.code == 0, done.err
    assert_quiet(done.out + done.err)
    return out


@pytest.mark.ci
def test_it_stands(nasty: Nasty, pack: Path) -> None:
    done = ran("verify", pack, "--trace", nasty.files.log, "--map", nasty.files.road)
    assert (done.code, done.err) == (
        0,
        "drivelint: rules and profiles in data/rules_dirs/0/rules are not drivelint's: read them\n",
    )
    assert "1 drive judged again: the same bytes" in done.out
    checked = subprocess.run(["sha256sum", "--strict", "--quiet", "-c", "manifest-sha256.txt"], cwd=pack, check=False)
    assert checked.returncode == 0
    (subject,) = json.loads((pack / "statement.json").read_bytes())["subject"]
    assert subject["name"] == f"{FILE}.parquet"


@pytest.mark.slow
def test_inputs_of_such_a_name_are_refused_or_found_again(nasty: Nasty, tmp_path: Path) -> None:
    """A name with a line's end would be a line of the manifest."""
    done = ran("pack", nasty.result, "--out", tmp_path / "pack", "--with-inputs")
    assert done.code == 2
    assert "sha256sum does not find a file of such a name" in done.err
    assert not (tmp_path / "pack").exists()


@pytest.mark.ci
def test_the_sql_of_each_finding_is_ours_and_gives_its_numbers(pack: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    told = json.loads((pack / "data" / "evidence.json").read_bytes())["findings"]
    assert any(each["rule_id"] == "evil.near" for each in told)
    for each in told:
        file = pack / each["sql"]
        text = file.read_text(encoding="utf-8")
        assert {match[0] for match in STEERING.finditer(text)} == set()
        head = text[: text.index("CREATE")].splitlines()
        assert [line for line in head if not line.startswith("-- ")] == []
        assert not [line for line in text.splitlines() if line.startswith(".")]
        monkeypatch.chdir(file.parent)
        with duckdb.connect() as con:
            ((*_, observed, required, margin, holds),) = con.execute(text).fetchall()
        assert (observed, required, margin, holds) == (each["observed"], each["required"], each["margin"], False)


@pytest.mark.sample(0, ci=1)
@pytest.mark.parametrize(
    ("word", "where"),
    [
        ("a\nSELECT 1) SELECT 1; COPY (SELECT 42) TO $$OUT$$; WITH _condition AS ( --", "-- $word\n"),
        (" || (SELECT count(*) FROM read_text($$/etc/passwd$$)) || ", "SELECT '$word' AS x, * FROM ("),
    ],
)
def test_a_value_of_a_parameter_runs_nothing(tmp_path: Path, word: str, where: str) -> None:
    """A value that was written into a comment or a text of the rule ended it, and stood as SQL that nobody had checked."""
    rules = tmp_path / "rules" / "evil"
    rules.mkdir(parents=True)
    value = json.dumps(word.replace("OUT", str(tmp_path / "out.csv")))
    condition = "SELECT drive_id, ego_id, t_ns, object_id, clearance_m AS observed, $near_m AS required FROM pair WHERE $word <> ''"
    whole = f"{where}{condition}" if where.startswith("--") else condition.replace("$word <> ''", "'$word' <> $word")
    head, _, _ = RULE.partition("-- @condition")
    lines = [f"-- default = {value}" if line.startswith('-- default = "') else line for line in head.splitlines()]
    (rules / "near.sql").write_text("\n".join([*lines, "-- @condition", whole, ""]), encoding="utf-8")
    words = ("--map", OVERTAKE / "road.xodr", "--mapping", OVERTAKE / "mapping.toml", "--rules-dir", tmp_path / "rules")
    done = ran(
        "check",
        OVERTAKE / "collision.csv",
        *words,
        "--rules",
        "evil",
        "--no-robustness",
        "--no-annotate",
        "--out",
        tmp_path / "r",
    )
    assert done.code == 1, done.err
    assert ran("pack", tmp_path / "r", "--out", tmp_path / "pack").code == 0
    assert not (tmp_path / "out.csv").exists()
    (sql,) = (tmp_path / "pack" / "data" / "findings").rglob("finding.sql")
    assert (
        len(duckdb.connect().extract_statements(sql.read_text("utf-8").rpartition(";\nWITH ")[2].join(("WITH ", ""))))
        == 1
    )


def test_values_stand_only_where_parameters_do() -> None:
    sql = """SELECT 'é$a', $a, E'\\'$a', $$ $a $$, "$a", a-$n -- ü$a
/* $a */ FROM t"""
    filled = with_values(sql, {"a": text_literal("x\n--"), "n": param_literal(-2)})
    assert filled == sql.replace("', $a, E", "', ('x' || chr(10) || '--'), E").replace("a-$n", "a-(-2)")


@pytest.mark.parametrize("text", [EGO, EVIL, "'", "\0", "\n.shell touch pwned\n", "plain", ""])
def test_a_text_as_sql_is_one_line_and_that_text(text: str) -> None:
    said = text_literal(text)
    assert "\n" not in said
    assert duckdb.connect().execute(f"SELECT {said} = ?, {said}", [text]).fetchone() == (True, text)


@pytest.mark.parametrize(
    ("sql", "alike"),
    [
        ("SELECT 'a;' -- ;\n", True),
        ("SELECT E'\\';\n.shell touch pwned\n'", False),
        ("SELECT e'x'", False),
        ("SELECT $$;$$", False),
        ("SELECT /* /* */ ; \n.shell touch pwned\n */ 1", False),
    ],
)
def test_what_duckdbs_shell_would_read_otherwise_is_known(sql: str, alike: bool) -> None:
    assert is_split_by_shell_as_by_parser(sql) is alike


@pytest.mark.parametrize("char", ["\x1b", "\x00", "\u202e", "\u2066", "\u2028", "\x85", "\x0c"])
def test_a_rule_file_hides_nothing(tmp_path: Path, char: str) -> None:
    (tmp_path / "evil").mkdir()
    file = tmp_path / "evil" / "near.sql"
    file.write_text(RULE.replace("-- @condition", f"-- seen {char} unseen\n-- @condition"), encoding="utf-8")
    with pytest.raises(RuleError, match=rf"near\.sql:\d+: the character U\+{ord(char):04X} hides"):
        read_rule(file)
    shutil.rmtree(tmp_path / "evil")
