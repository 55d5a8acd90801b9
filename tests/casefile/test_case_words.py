"""Cases with words that no column has are refused: file, case, column and the nearest word are named."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from drivelint.casefile import Case, is_same_value, judge_case, read_cases
from drivelint.casefile.scene import complete_scene, refuse_wrong_word
from drivelint.errors import RuleError
from drivelint.sql import declarations
from tests.casefile.speed_rule import measured_rule, said_of, with_cases
from tests.evaluate.packs import HOLDS, INVARIANT, write

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.sql.words import WordColumn

CASE = "- name: clean\n  given: {{ego_state: {{t_s: 0..1 by 0.1, {}}}}}\n  expect: {}\n"


def test_a_case_is_refused_by_rules_test(tmp_path: Path) -> None:
    with_cases(measured_rule(tmp_path), CASE.format("indicator: hazards", "pass"))
    code, said = said_of(tmp_path)
    assert code == 2
    assert said.endswith(
        "pack/rule.cases.yml:1: case 'clean': given: ego_state.indicator: 'hazards' is no indicator; did you mean 'hazard'?"
    )


@pytest.mark.sample(2, ci=2)
@pytest.mark.parametrize(
    "value", ["hazards", "[off, hazards]", "{else: off, 0.5: hazards}", "{0..0.5: hazards, else: null}"]
)
def test_a_wrong_word_is_found_however_it_is_given(tmp_path: Path, value: str) -> None:
    times = "t_s: [0, 1]" if value.startswith("[") else "t_s: 0..1 by 0.1"
    case = f"- name: clean\n  given: {{ego_state: {{{times}, indicator: {value}}}}}\n  expect: pass\n"
    rule = with_cases(measured_rule(tmp_path), case)
    with pytest.raises(RuleError, match=r"ego_state\.indicator: 'hazards' is no indicator; did you mean 'hazard'\?"):
        judge_case(rule, read_cases(rule)[0])
    good = with_cases(rule, case.replace("hazards", "hazard"))
    assert judge_case(good, read_cases(good)[0]).verdicts


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ("expect: passs", r"expect\.verdict: 'passs' is no verdict; did you mean 'pass'\?"),
        ("expect: [{verdict: fial}]", r"expect\.verdict: 'fial' is no verdict; did you mean 'fail'\?"),
        ("expect: [{severity: mayor}]", r"expect\.severity: 'mayor' is no rule severity; did you mean 'major'\?"),
        ("expect: [{sevrity: major}]", r"expect has no column 'sevrity'; did you mean 'severity'\?"),
        ("expect: pass\n  missing: [indicatr]", r"missing: 'indicatr' is no signal; did you mean 'indicator'\?"),
    ],
)
def test_what_a_case_expects_is_in_words_of_the_verdict(tmp_path: Path, more: str, message: str) -> None:
    rule = with_cases(measured_rule(tmp_path), f"- name: clean\n  given: {{ego_state: {{t_s: 0}}}}\n  {more}\n")
    with pytest.raises(RuleError, match=rf"rule\.cases\.yml:1: case 'clean': {message}"):
        read_cases(rule)


def test_a_parameter_of_a_case_is_a_word_of_the_column_that_it_is_compared_with(tmp_path: Path) -> None:
    sql = "SELECT drive_id, ego_id, t_ns, indicator = $side AS holds FROM ego_state"
    header = INVARIANT | HOLDS | {"reads": '["ego_state"]'}
    rule = write(
        tmp_path, header, {"condition": sql}, tables='[params.side]\ndefault = "left"\nunit = ""\nwhy = "a test"'
    )
    with_cases(rule, "- name: clean\n  given: {ego_state: {t_s: 0}}\n  params: {side: rigth}\n  expect: pass\n")
    with pytest.raises(RuleError, match=r"case 'clean': params\.side: 'rigth' is no indicator; did you mean 'right'\?"):
        read_cases(rule)


def test_tables_and_columns_are_named_with_the_nearest(tmp_path: Path) -> None:
    rule = measured_rule(tmp_path)
    for given, message in (
        ({"ego_stat": {"t_s": 0}}, r"no table 'ego_stat'; did you mean 'ego_state'\?"),
        ({"ego_state": {"t_s": 0, "indicater": "off"}}, r"no column 'indicater'; did you mean 'indicator'\?"),
        ({"ego_state": {"t_s": 0, "zzz": "off"}}, r"no column 'zzz'; it has: drive_id, "),
    ):
        with pytest.raises(RuleError, match=message):
            judge_case(rule, Case(name="scene", given_tables=given, expect="pass"))


COLUMNS = [
    (table, name, column) for table, columns in declarations.word_columns().items() for name, column in columns.items()
]


@pytest.mark.parametrize(("table", "name", "column"), COLUMNS, ids=[f"{table}.{name}" for table, name, _ in COLUMNS])
def test_every_column_of_words_is_held_against_its_vocabulary(table: str, name: str, column: WordColumn) -> None:
    good = column.vocabulary.words[-1]
    wrong = f"{good}{good[-1]}"

    def value_with(word: str) -> str | dict[str, str]:
        return {column.field: word, "signal_id": "any text"} if column.field else word

    known: tuple[Any, ...] = (value_with(good), [None, value_with(good)], {"else": None, "0..1": value_with(good)})
    for value in known:
        refuse_wrong_word(table, name, value, "given")
    for value in (
        value_with(wrong),
        [value_with(good), value_with(wrong)],
        {"else": value_with(good), "0..1": value_with(wrong)},
    ):
        with pytest.raises(RuleError, match=rf"given\.{name}: '{wrong}' is no .*did you mean '{good}'\?"):
            refuse_wrong_word(table, name, value, "given")


def test_ids_and_texts_are_free(tmp_path: Path) -> None:
    given = {
        "pair": {"t_s": 0, "object_id": "cyclist"},
        "declared_event": {"t_s": 0, "event": "door_opened", "value": "rear"},
    }
    scene = complete_scene(measured_rule(tmp_path), given, ())
    assert scene["pair"][0]["object_id"] == "cyclist"


def test_a_value_by_time_may_be_spread_over_its_rows(tmp_path: Path) -> None:
    speeds = {"else": "0..6", "0.2..0.4": "20..30", 0.5: [7]}
    scene = complete_scene(measured_rule(tmp_path), {"ego_state": {"t_s": "0..0.6 by 0.1", "speed_mps": speeds}}, ())
    assert [row["speed_mps"] for row in scene["ego_state"]] == [0, 1, 20, 25, 30, 7, 6]
    with pytest.raises(RuleError, match=r"ego_state\.speed_mps.*: 0\.5: 2 values for 1 rows"):
        complete_scene(measured_rule(tmp_path), {"ego_state": {"t_s": "0..0.6 by 0.1", "speed_mps": {0.5: [7, 8]}}}, ())


def test_an_infinite_value_agrees_only_with_the_same_infinite_value() -> None:
    inf = float("inf")
    assert is_same_value(inf, inf, 1)
    assert not is_same_value(inf, 1e300, 1)
    assert not is_same_value(-inf, inf, 1)
    assert not is_same_value(5, inf, 1)
