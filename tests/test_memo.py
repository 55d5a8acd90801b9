"""Facts that are kept are those that are found, of the same code only; damage, and a folder that cannot be written, cost time alone."""

from __future__ import annotations

from pathlib import Path

import pytest

from drivelint import memo
from drivelint.catalogue import load, load_rules, rule_file
from drivelint.catalogue.check import SelectParts, check_query
from drivelint.catalogue.rule import Rule
from drivelint.errors import RuleError
from drivelint.memo import Memo

SQL = "SELECT t_ns, speed_mps > $limit AS condition FROM ego_state"


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "cache"
    monkeypatch.setattr(memo, "cache_folder", lambda: folder)
    return folder


def never() -> SelectParts:
    raise AssertionError("it is kept")


def test_a_fact_is_found_once(home: Path) -> None:
    query = check_query(SQL, "a.sql", 1)
    first = Memo[SelectParts]("queries", SelectParts)
    assert first.find_or_compute(SQL, lambda: query) == query
    first.save()
    assert [file.name for file in home.iterdir()] == [
        f"queries-{memo.code_and_version_hash(memo.SQL_CODE_GLOBS)[:16]}.msgpack"
    ]
    assert Memo[SelectParts]("queries", SelectParts).find_or_compute(SQL, never) == query
    with pytest.raises(AssertionError):
        Memo[SelectParts]("queries", SelectParts).find_or_compute(f"{SQL} ", never)


def test_rules_are_read_and_checked_once(monkeypatch: pytest.MonkeyPatch) -> None:
    def fresh() -> None:
        load._cached_rule.cache_clear()
        monkeypatch.setattr(load, "_RULE_MEMO", Memo[Rule]("rules", Rule))

    fresh()
    rules = load_rules()
    load._RULE_MEMO.save()
    fresh()
    monkeypatch.setattr(rule_file, "checked_rule", never)
    assert load_rules() == rules
    load._cached_rule.cache_clear()


def test_other_code_finds_its_own(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    kept = Memo[int]("numbers", int)
    kept.put("a", 1)
    kept.save()
    monkeypatch.setattr(memo, "code_and_version_hash", lambda _: "f" * 64)
    assert Memo[int]("numbers", int).find_or_compute("a", lambda: 2) == 2


def test_the_code_and_the_declarations_count() -> None:
    whole = memo.code_and_version_hash(memo.SQL_CODE_GLOBS)
    assert whole != memo.code_and_version_hash(memo.SQL_CODE_GLOBS[1:])
    files = {file.name for pattern in memo.SQL_CODE_GLOBS for file in Path(memo.__file__).parent.glob(pattern)}
    assert {"syntax.py", "check.py", "allowed_sql.py", "derivations.py", "memo.py"} <= files


@pytest.mark.parametrize("content", [b"", b"\xff\xff", b"\x81\xa1a\xa1b"])
def test_a_damaged_file_is_none(home: Path, content: bytes) -> None:
    kept = Memo[int]("numbers", int)
    kept.put("a", 1)
    kept.save()
    (file,) = home.iterdir()
    file.write_bytes(content)
    assert Memo[int]("numbers", int).find_or_compute("a", lambda: 1) == 1


def test_errors_are_not_kept() -> None:
    for _ in range(2):
        with pytest.raises(RuleError, match=r"a\.sql:3"):
            check_query("SELECT 1 FROM nowhere", "a.sql", 3)


def test_a_folder_that_cannot_be_written(home: Path) -> None:
    home.write_bytes(b"a file stands there")
    kept = Memo[int]("numbers", int)
    assert kept.find_or_compute("a", lambda: 1) == 1
    kept.save()


def test_no_more_facts_than_are_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memo, "MOST_FACTS_IN_FILE", 2)
    old = Memo[int]("numbers", int)
    for name in "ab":
        old.put(name, 0)
    old.save()
    new = Memo[int]("numbers", int)
    new.put("c", 1)
    new.find_or_compute("b", lambda: 5)
    new.save()
    last = Memo[int]("numbers", int)
    assert [last.get(name) for name in "abc"] == [None, 0, 1]
