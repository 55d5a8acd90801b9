"""Reasons are codes with arguments; their words are made in one place."""

from __future__ import annotations

import re

import duckdb
import msgspec
import pytest

from drivelint import catalogue
from drivelint.reasons import reason_text
from drivelint.reasons.reason_text import ReasonText
from drivelint.resources import folder

OWN_TEXTS = {
    "came_by": ReasonText(
        "{object_id} came by with {room_m:.2f} m between[, behind {behind_id}]", "record it until {t_ns}"
    ),
    "stood": ReasonText("{braked}, and it stood until then"),
}


def why(con: duckdb.DuckDBPyConnection, arguments: str) -> str:
    (found,) = con.execute(f"SELECT why({arguments})").fetchone() or ()
    return str(found)


@pytest.fixture(scope="module")
def con() -> duckdb.DuckDBPyConnection:
    con = duckdb.connect()
    con.execute((folder("queries") / "macros" / "causes.sql").read_text(encoding="utf-8"))
    return con


def test_arguments_are_filled_in_and_times_are_told_from_the_start(con: duckdb.DuckDBPyConnection) -> None:
    reason = why(con, "'came_by', {'object_id': 'o{1}', 'room_m': 1.256, 'behind_id': NULL, 't_ns': 7_500_000_000}")
    assert (
        reason_text.sentence(reason, 2_000_000_000, OWN_TEXTS)
        == "o{1} came by with 1.26 m between: record it until 5.500 s"
    )
    reason = why(con, "'came_by', {'object_id': 'o', 'room_m': 1, 'behind_id': 'p', 't_ns': 0}")
    assert (
        reason_text.sentence(reason, 0, OWN_TEXTS) == "o came by with 1.00 m between, behind p: record it until 0.000 s"
    )


def test_what_is_null_is_a_question_mark(con: duckdb.DuckDBPyConnection) -> None:
    reason = why(con, "'came_by', {'object_id': NULL, 'room_m': NULL::DOUBLE}")
    assert reason_text.sentence(reason, 0, OWN_TEXTS) == "? came by with ? m between: record it until ?"


def test_a_reason_may_be_an_argument(con: duckdb.DuckDBPyConnection) -> None:
    reason = why(con, "'stood', {'braked': why('came_by', {'object_id': 'o', 'room_m': 1, 't_ns': 0})}")
    assert (
        reason_text.sentence(reason, 0, OWN_TEXTS)
        == "o came by with 1.00 m between: record it until 0.000 s, and it stood until then"
    )
    code, arguments = reason_text.parse_reason(reason)
    assert reason_text.sentence_if_it_has_advice(code, arguments, 0, OWN_TEXTS) == reason_text.sentence(
        reason, 0, OWN_TEXTS
    )
    assert reason_text.sentence_if_it_has_advice("stood", {"braked": "it"}, 0, OWN_TEXTS) is None
    assert reason_text.code_and_nested_codes(code, arguments) == {"stood", "came_by"}


@pytest.mark.parametrize("text", ["plain words", '{"code":', '{"code":1, "args": 2}', "{}", ""])
def test_plain_text_is_its_own_words(text: str) -> None:
    assert reason_text.parse_reason(text).code == reason_text.PLAIN_TEXT_CODE
    assert reason_text.sentence(text) == text


def test_a_code_without_words_is_told_as_it_is() -> None:
    assert reason_text.sentence('{"code":"too_late"}') == "too late"


@pytest.mark.parametrize("says", ["{x.__class__}", "{x!r}", "{x:>99999999}", "{", "}", "{x[0]}", "{x:d}"])
def test_only_arguments_stand_in_braces(says: str) -> None:
    with pytest.raises(msgspec.ValidationError, match="write an argument as"):
        msgspec.convert({"says": says}, ReasonText)


def test_every_shared_code_is_given_somewhere() -> None:
    given = {code for rule in catalogue.load_rules().values() for code in rule.reason_codes}
    texts = [
        file.read_text(encoding="utf-8")
        for part in ("macros", "statement_macros", "library", "judging")
        for file in (folder("queries") / part).rglob("*.sql")
    ]
    named = set(re.findall(r"'(\w+)'", "\n".join(texts))) | {reason_text.PLAIN_TEXT_CODE}
    assert sorted(reason_text.texts_of_shared_codes().keys() - given - named) == []


def test_no_code_of_a_rule_hides_a_shared_one() -> None:
    assert [
        f"{rule.id}: {code}"
        for rule in catalogue.load_rules().values()
        for code in rule.reasons
        if code in reason_text.texts_of_shared_codes()
    ] == []


def test_who_lacks_only_the_way_out_of_a_junction_is_not_asked_for_the_side() -> None:
    def sentence_of(code: str) -> str:
        return reason_text.sentence(f'{{"code":"{code}"}}')

    assert sentence_of("turn_across_unknown").endswith("across the road: record it until it has left the junction")
    assert sentence_of("turn_side_unknown").endswith("is not known: set it with --handedness")
