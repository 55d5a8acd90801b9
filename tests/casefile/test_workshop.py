"""The author's commands: a rule to start from, and what is said of rules and cases that are wrong."""

from __future__ import annotations

from pathlib import Path
from threading import Event

import pytest

from drivelint.casefile import commands as workshop
from drivelint.casefile import mutation
from drivelint.catalogue import Rule, read_rule
from drivelint.errors import ExitCode, RuleError, UsageError
from tests.casefile.speed_rule import CASES, SPEED, Lines, measured_rule, said_of, with_cases
from tests.evaluate.packs import INVARIANT, MEASURE, text

KINDS = ("invariant", "execution", "precondition", "postcondition")


@pytest.mark.sample(0, ci=1)
@pytest.mark.parametrize("kind", KINDS)
def test_a_new_rule_runs_as_it_is_and_its_cases_notice_every_mutant(tmp_path: Path, kind: str) -> None:
    sql, cases = workshop.write_new_rule(f"mine.r1.{kind}", tmp_path, kind)
    assert (sql.name, cases.name) == (f"r1.{kind}.sql", f"r1.{kind}.cases.yml")
    rule = read_rule(sql)
    assert (rule.id, rule.kind, rule.status) == (f"mine.r1.{kind}", kind, "draft")
    assert said_of(tmp_path)[0] is ExitCode.OK
    said = Lines()
    assert workshop.mutation_test(tmp_path, (), said) is ExitCode.OK
    assert "no case notices" not in "\n".join(said)


@pytest.mark.slow
def test_one_rule_is_tested_by_its_file_or_that_of_its_cases(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sql, cases = workshop.write_new_rule("mine.one", tmp_path, "invariant")
    workshop.write_new_rule("mine.two", tmp_path, "invariant")
    monkeypatch.setattr(mutation, "judge_all_mutants", lambda *_: iter(()))
    for file in (sql, cases):
        assert said_of(file) == (ExitCode.OK, "ok   mine.one: 10 of 10 checks")
    said = Lines()
    (sql.parent / "survivors.toml").write_text('[[survivor]]\nrule = "mine.two"\nmutant = "x"\nreason = "y"\n', "utf-8")
    assert workshop.mutation_test(sql, (), said) is ExitCode.OK, "an entry of another rule is none of its business"
    other = tmp_path / "mine" / "notes.txt"
    other.write_text("no rule", encoding="utf-8")
    with pytest.raises(UsageError, match=r"notes\.txt: neither a rule nor the cases of a rule"):
        said_of(other)


def test_nothing_is_overwritten(tmp_path: Path) -> None:
    sql, cases = workshop.write_new_rule("mine.one", tmp_path, "invariant")
    sql.write_text("mine", encoding="utf-8")
    with pytest.raises(UsageError, match=r"one\.sql is there already: nothing was written"):
        workshop.write_new_rule("mine.one", tmp_path, "invariant")
    sql.unlink()
    cases.write_text("mine", encoding="utf-8")
    with pytest.raises(UsageError, match=r"one\.cases\.yml is there already: nothing was written"):
        workshop.write_new_rule("mine.one", tmp_path, "invariant")
    assert not sql.exists()
    assert cases.read_text(encoding="utf-8") == "mine"


@pytest.mark.parametrize(
    "rule_id", ["one", "mine.", ".one", "Mine.one", "mine/../../x.one", "mine.a/b", "mine.one two"]
)
def test_what_is_no_rule_id(tmp_path: Path, rule_id: str) -> None:
    with pytest.raises(UsageError, match="is no rule id: write PACK"):
        workshop.write_new_rule(rule_id, tmp_path, "invariant")
    assert list(tmp_path.iterdir()) == []


def test_a_new_rule_does_not_take_the_name_of_a_shipped_one(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="is shipped already"):
        workshop.write_new_rule("ukhc.r124.speed-limit", tmp_path, "invariant")


def test_a_folder_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "mine").write_text("a file", encoding="utf-8")
    with pytest.raises(UsageError, match="cannot write there"):
        workshop.write_new_rule("mine.one", tmp_path, "invariant")


@pytest.mark.slow
def test_a_copy_of_the_shipped_rules_can_be_worked_on(tmp_path: Path) -> None:
    from drivelint.resources import folder

    pack = tmp_path / "ukhc"
    pack.mkdir()
    for file in (folder("queries") / "assertions" / "ukhc").glob("r145.off-road.*"):
        (pack / file.name).write_text(file.read_text(encoding="utf-8"), encoding="utf-8")
    code, said = said_of(tmp_path)
    assert (code, said.split(":")[0]) == (ExitCode.OK, "ok   ukhc.r145.off-road")


@pytest.mark.slow
def test_one_rule_is_refused_and_the_others_go_on(tmp_path: Path) -> None:
    with_cases(measured_rule(tmp_path), CASES)
    broken = tmp_path / "pack" / "broken.sql"
    broken.write_text(text(INVARIANT | MEASURE | {"senze": "1"}, {"condition": SPEED}), encoding="utf-8")
    code, said = said_of(tmp_path)
    assert code is ExitCode.USAGE
    assert f"REFUSED {broken}:" in said
    assert f"\n{broken}:4: unknown key 'senze'" in said
    assert "pack.rule: 6 of 7 checks" in said, "no case is not applicable"
    assert workshop.mutation_test(tmp_path, (), Lines()) is ExitCode.USAGE
    assert said_of(tmp_path, "pack.rule")[0] is ExitCode.FAILED
    with pytest.raises(UsageError, match="none of the 2 rules here"):
        said_of(tmp_path, "nobody.*")


@pytest.mark.parametrize(
    ("source", "message"),
    [
        (
            "ego_state e LEFT JOIN pair p ON p.drive_id = e.drive_id AND (p.t_ns = e.t_ns OR p.object_id = 'a')",
            "a join of ego_state and pair compares every row with every other (BLOCKWISE_NL_JOIN)",
        ),
        ("ego_state e JOIN pair p USING (drive_id)", "Ambiguous reference"),
    ],
)
def test_a_plan_or_sql_that_does_not_fit_is_refused(tmp_path: Path, source: str, message: str) -> None:
    reads = '["ego_state", "pair"]' if "pair" in source else '["ego_state"]'
    sql = f"SELECT e.drive_id, e.ego_id, {'t_ns' if message[0] == 'A' else 'e.t_ns'}, 1 AS observed, 2 AS required\nFROM {source}"
    rule = with_cases(measured_rule(tmp_path, sql, {"reads": reads}, tables=""), CASES)
    code, said = said_of(tmp_path)
    assert code is ExitCode.USAGE
    assert said.startswith(f"REFUSED {rule.path}:")
    assert message in said


def test_an_unknown_column_is_told_with_its_line_and_the_names_that_are_near(tmp_path: Path) -> None:
    sql = "SELECT drive_id, ego_id, t_ns,\n  spead_mps AS observed,\n  $limit AS required\nFROM ego_state"
    rule = with_cases(measured_rule(tmp_path, sql), CASES)
    line = rule.path.read_text(encoding="utf-8").split("\n").index("  spead_mps AS observed,") + 1
    code, said = said_of(tmp_path)
    assert code is ExitCode.USAGE
    assert said.startswith(f"REFUSED {rule.path}:{line}: ")
    assert "speed_mps" in said


@pytest.mark.slow
def test_a_rule_is_tested_again_when_it_is_saved(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workshop, "_CHANGED_FILES_CHECK_PERIOD_S", 0.01)
    rule = with_cases(measured_rule(tmp_path), CASES)
    workshop.write_new_rule("mine.other", tmp_path, "invariant")
    over = Event()
    edits = iter(
        [
            lambda: with_cases(rule, CASES.replace("margin: 0", "margin: 1")),
            lambda: rule.path.write_text("no rule", encoding="utf-8"),
            over.set,
        ]
    )
    said = Lines()

    def say(line: str) -> None:
        said(line)
        if len(said) > 2:  # both rules, and that it waits
            next(edits)()

    assert workshop.repeat_tests_on_changes(workshop.case_test, tmp_path, (), say, over) is ExitCode.USAGE
    assert [line.split(":")[0] for line in said[2:4]] == ["waiting for changes; press Ctrl-C to end", "FAIL pack.rule"]
    assert [line.split(" ")[0] for line in said[4:]] == ["REFUSED"]


@pytest.mark.slow
@pytest.mark.sample(3, ci=3)
@pytest.mark.parametrize(
    ("cases", "line", "message"),
    [
        (None, 1, "has no cases"),
        ("- name: [", 1, "not YAML"),
        ("a: 1", 1, "cases are a list"),
        ("\n- name: clean\n  given: {}\n  expect: pass\n- 7", 5, "a case consists of 'key: value' pairs"),
        ("\n\n- name: clean\n  given: {}\n  expct: pass", 3, "unknown field `expct`; did you mean 'expect'?"),
        ("- name: clean\n  given: {}\n  finding: []\n  expect: pass", 1, "`finding`; did you mean 'findings'?"),
        ("- name: clean\n  given: {}\n  zzz: []\n  expect: pass", 1, "unknown field `zzz`"),
        (CASES + "\n- name: clean\n  given: {}\n  expect: pass", 15, "has the name of the case in line 2"),
        (CASES.replace("name: boundary", "name: boundary\n  params: {limitt: 1}"), 5, "has no parameter 'limitt'"),
        (CASES.replace("name: boundary", "name: boundary\n  missing: [indicator]"), 5, "does not require 'indicator'"),
        (
            CASES.replace("speed_mps: 13", "spead_mps: 13"),
            5,
            "case 'boundary': given: ego_state has no column 'spead_mps'",
        ),
        (CASES.replace("{ego_state: {t_s: 0..1 by 0.1, speed_mps: 13}}", "{ego: {}}"), 5, "there is no table 'ego'"),
        (CASES.replace("speed_mps: 13", "speed_mps: fast"), 5, "case 'boundary': given: ego_state:"),
        (CASES.replace("margin: 0", "margn: 0"), 5, "case 'boundary': expect has no column 'margn'"),
    ],
)
def test_what_is_wrong_in_cases_is_said_with_its_line(
    tmp_path: Path, cases: str | None, line: int, message: str
) -> None:
    rule = measured_rule(tmp_path)
    if cases is not None:
        with_cases(rule, cases)
    code, said = said_of(tmp_path)
    assert code is ExitCode.USAGE
    assert said.startswith(f"REFUSED {rule.path.with_suffix('.cases.yml')}:{line}: ")
    assert message in said
    assert "\n" not in said


@pytest.mark.sample(1, ci=1)
@pytest.mark.parametrize(
    ("cases", "line", "message"),
    [
        (CASES, 1, "no case shows: not_applicable"),
        (CASES.replace("margin: 0", "margin: 0.5"), 5, "case 'boundary': row 0: expected margin = 0.5, got 0.0"),
        (CASES.replace("expect: unknown", "expect: pass"), 11, "case 'unknown': expected pass, got unknown"),
        (CASES.replace("name: boundary", "name: edge\n  shows: brink"), 5, "shows: 'brink' is not one of clean"),
    ],
)
def test_a_case_that_fails_is_said_with_its_line(tmp_path: Path, cases: str, line: int, message: str) -> None:
    rule = with_cases(measured_rule(tmp_path), cases)
    code, said = said_of(tmp_path)
    assert code is ExitCode.FAILED
    assert f"{rule.path.with_suffix('.cases.yml')}:{line}: {message}" in said


@pytest.mark.ci
def test_a_condition_about_objects_that_are_not_in_pair_is_told_why_it_never_applies(tmp_path: Path) -> None:
    sql = "SELECT drive_id, ego_id, t_ns, object_id, speed_mps AS observed, $limit AS required FROM lead"
    case = "\n- name: clean\n  given: {lead: {t_s: 0..1 by 0.1, object_id: f, speed_mps: 14}}\n  expect: pass\n"
    with_cases(measured_rule(tmp_path, sql, {"reads": '["lead"]'}), case)
    hint = "without @applies, an invariant about objects is judged for the actors of pair, and this case has none"
    assert hint in said_of(tmp_path)[1]
    with_cases(measured_rule(tmp_path), CASES.replace("expect: unknown", "expect: pass"))
    assert "actors of pair" not in said_of(tmp_path)[1]


@pytest.mark.parametrize(
    ("change", "line", "message"),
    [
        (("$limit", "$limit + $more"), 18, "$more is not a parameter of this rule; add [params.more] to the header"),
        (
            ("$limit", "$limitt"),
            18,
            "$limitt is not a parameter of this rule; did you mean $limit? If not, add [params.limitt]",
        ),
        (("$limit", "is_clas('car', 'car')"), 18, "is_clas() is not allowed in a rule; did you mean is_class()?: only"),
        (("$limit", "13"), 12, "parameter 'limit' is never used"),
        (("FROM ego_state", "FROM ego_state\nJOIN pair USING (drive_id)"), 19, "add pair to reads"),
        (('reads = ["ego_state"]', 'reads = ["ego_state", "pair"]'), 11, "remove pair"),
        (("FROM ego_state", "FROM\nego_states"), 19, "there is no table 'ego_states'"),
        (("$limit", "now()"), 18, "function now() is not allowed"),
        (('"invariant"', '"invarient"'), 8, "kind = 'invarient': did you mean 'invariant'"),
        (("FROM ego_state", "FROM ego_state;\nSELECT 1"), 19, "exactly one SELECT, found 2"),
        (("SELECT drive_id", "DROP TABLE step; SELECT drive_id"), 18, "exactly one SELECT, found 2"),
        (("speed_mps AS observed", "speed_mps"), 17, "observed missing"),
        (("-- @condition", "-- @conditoin"), 17, "did you mean @condition?"),
    ],
)
def test_what_is_wrong_in_a_rule_is_said_with_its_line(
    tmp_path: Path, change: tuple[str, str], line: int, message: str
) -> None:
    rule: Rule = measured_rule(tmp_path)
    good = rule.path.read_text(encoding="utf-8")
    assert change[0] in good
    rule.path.write_text(good.replace(*change), encoding="utf-8")
    with pytest.raises(RuleError) as caught:
        read_rule(rule.path)
    said = [each for each in str(caught.value).split("\n") if message in each]
    assert [each.startswith(f"{rule.path}:{line}: ") for each in said] == [True], caught.value
