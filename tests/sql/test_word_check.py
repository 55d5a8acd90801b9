"""Words in SQL that a column never has: found in every form in which a rule may compare, and nothing else is taken for one."""

from __future__ import annotations

import re

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from drivelint.resources import folder
from drivelint.sql import declarations, macro_trees, store, syntax, word_check
from drivelint.sql.derivations import derivations
from drivelint.sql.library import library_tables
from drivelint.sql.word_check import CheckedQuery, check_query
from drivelint.sql.word_scope import Relation
from drivelint.sql.words import ColumnVocabulary, WordColumn
from tests.sql.lines import lines


def check_sql(sql: str, tables: dict[str, Relation] | None = None) -> CheckedQuery:
    return check_query(syntax.parse_select(sql, "a test"), tables)


def wrong(sql: str) -> list[str]:
    """Return what is wrong in a SELECT, in order of place."""
    return [each.message for each in sorted(check_sql(sql).wrong, key=lambda each: each.offset or 0)]


@pytest.mark.parametrize("sql", lines("wrong_words"))
def test_a_class_that_does_not_exist_is_found(sql: str) -> None:
    found = check_sql(sql).wrong
    assert [each.word.rstrip("%") for each in found] == ["cyclist"], sql
    assert "did you mean 'bicycle'?" in found[0].message
    place = found[0].offset
    assert place is not None
    assert place <= sql.encode().find(b"'cyclist")  # there, or where the macro is called


@pytest.mark.parametrize("sql", lines("wrong_words"))
def test_a_class_that_exists_is_none(sql: str) -> None:
    assert wrong(re.sub(r"'cyclist(%?)'", r"'bicycle\1'", sql)) == []


@pytest.mark.parametrize("sql", lines("right_words"))
def test_what_may_be_so_is_not_refused(sql: str) -> None:
    assert wrong(sql) == []


def test_a_union_of_many_parts_and_a_long_condition_can_be_looked_at() -> None:
    parts = " UNION ALL ".join(["SELECT actor_class AS k FROM pair"] * 60)
    assert wrong(f"SELECT k = 'cyclist' FROM ({parts})") == wrong("SELECT actor_class = 'cyclist' FROM pair")
    many = " OR ".join(["actor_class = 'car'"] * 900)
    assert wrong(f"SELECT 1 FROM pair WHERE {many} OR actor_class = 'cyclist'") == wrong(
        "SELECT actor_class = 'cyclist' FROM pair"
    )


@pytest.mark.parametrize(
    ("sql", "message"),
    [
        ("SELECT part = 'befor' FROM (SELECT CASE WHEN k = 0 THEN 'before' ELSE 'after' END AS part FROM step)",
         "'befor' is never what it is compared with; did you mean 'before'?"),
        ("SELECT relation_of(1.0) = 'oncomming'", "'oncomming' is never what it is compared with; did you mean 'oncoming'?"),
        ("SELECT is_class(n.lane_type, 'car') FROM lanelet n", "'vehicle' is no lane type; "),
        ("SELECT lights[1].fit = 'mine' FROM way_mark", "'mine' is no light fit; "),
        ("SELECT list_contains(turns, 'lefft') FROM traffic_signal", "'lefft' is no turn; did you mean 'left'?"),
        ("SELECT beyond = 'oposing' FROM line_step", "'oposing' is no lane type; did you mean 'opposing'?"),
        ("SELECT event = 'mirror_chek' FROM declared_event", "'mirror_chek' is no event; did you mean 'mirror_check'?"),
        ("SELECT mode = 'horns' FROM ego_mode", "'horns' is no mode; did you mean 'horn'?"),
        ("SELECT profile = 'agressive' FROM overtake_sda", "'agressive' is no profile name; did you mean 'aggressive'?"),
        ("SELECT check_id = 'lost_tim' FROM quality", "'lost_tim' is no log check; did you mean 'lost_time'?"),
        ("SELECT signal = 'indicators' FROM capability", "'indicators' is no signal; did you mean 'indicator'?"),
        ("SELECT nation = 'gb-scot' FROM ego_condition", "'gb-scot' is no nation; did you mean 'gb-sct'?"),
        ("SELECT lane_type LIKE 'Driv%' FROM lanelet", "'Driv%' is no lane type; did you mean 'driving'?"),
    ],
)  # fmt: skip
def test_other_words_are_found_with_the_nearest(sql: str, message: str) -> None:
    (found,) = {each for each in wrong(sql) if each.startswith(message[:8])}
    assert found.startswith(message)


COLUMNS = [
    (table, name, column)
    for table in (*declarations.column_comments("model"), *declarations.column_comments("map"), *library_tables())
    for name, column in declarations.word_columns()[table].items()
    if not column.field and not column.is_list
]
FORMS = (
    "SELECT {c} = {w} FROM {t}",
    "SELECT {w} IS DISTINCT FROM x.{c} FROM {t} x",
    "SELECT {c} IN ({w}) FROM {t}",
    "WITH a AS (SELECT {c} AS renamed FROM {t}) SELECT CASE renamed WHEN {w} THEN 1 END FROM a",
    "SELECT count(*) FILTER (last_value({c}) OVER () = {w}) FROM {t}",
    "SELECT list_contains(list({c}), {w}) FROM {t}",
    "SELECT any_value({{'k': {c}}}).k = {w} FROM {t} GROUP BY ALL",
)


@pytest.mark.parametrize(("table", "name", "column"), COLUMNS, ids=[f"{table}.{name}" for table, name, _ in COLUMNS])
def test_every_column_of_words_is_known_in_sql(table: str, name: str, column: WordColumn) -> None:
    good = column.vocabulary.words[-1]
    for form in FORMS:
        assert wrong(form.format(t=table, c=name, w=f"'{good}'")) == [], form
        (found,) = wrong(form.format(t=table, c=name, w=f"'{good}{good[-1]}'"))
        assert found.endswith(f"did you mean {good!r}?"), form


TEXTS = st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0"), max_size=12)


@given(st.sampled_from(COLUMNS), st.sampled_from(FORMS), TEXTS)
@example(COLUMNS[0], FORMS[0], "it's")
@example(COLUMNS[0], FORMS[3], "")
def test_a_text_is_refused_exactly_if_it_is_no_word(place: tuple[str, str, WordColumn], form: str, text: str) -> None:
    """A law: what a SELECT may compare with a column is what its vocabulary has."""
    table, name, column = place
    found = wrong(form.format(t=table, c=name, w=store.quoted(text)))
    assert bool(found) == (text not in column.vocabulary)
    assert all(each.startswith(f"{text!r} is no ") for each in found)


def test_what_a_parameter_is_compared_with_is_known() -> None:
    found = check_sql(
        "SELECT actor_class = $kind, speed_mps > $most_mps, is_class(actor_class, $word) FROM pair"
    ).parameters
    assert {name: [kind.possible_words[0] for kind in kinds] for name, kinds in found.items()} == {
        "kind": ["car"],
        "word": ["car"],
    }


def test_tables_beside_those_of_the_schemas_are_known() -> None:
    reference = check_sql("SELECT drive_id, ego_id, t_ns, side AS to_side FROM lane_change").relation._replace(
        complete=False
    )
    found = check_sql("SELECT r.to_side = 'lefft', r.ref_id = 'x' FROM reference r", {"reference": reference}).wrong
    assert [each.message for each in found] == ["'lefft' is no side; did you mean 'left'?"]


@pytest.mark.parametrize("name", sorted(derivations()))
def test_a_derivation_has_only_words_that_its_tables_have_and_fills_every_column(name: str) -> None:
    """Both what it compares and what it gives; a column that nothing fills would be NULL for ever."""
    found = check_sql(derivations()[name].sql)
    assert [each.message for each in (*found.wrong, *word_check.wrong_words_in_columns(name, found.relation))] == []
    assert found.relation.complete
    filled = dict(found.relation.columns)
    assert list(declarations.column_comments()[name].keys() - filled.keys() - {"geom"}) == []
    # what it is made of is known, but for the conditions of a drive, whose words are in one column
    unknown = [column for column in declarations.word_columns()[name] if filled[column] is None]
    assert unknown == (list(declarations.word_columns()[name]) if name == "ego_condition" else [])


def test_a_derivation_that_gives_another_word_is_found() -> None:
    found = check_sql("SELECT CASE WHEN k = 0 THEN 'left' ELSE 'rigth' END AS side FROM step")
    (only,) = word_check.wrong_words_in_columns("lane_change", found.relation)
    assert (only.message, only.offset) == ("'rigth' is no side; did you mean 'right'?", 40)


def test_a_macro_has_only_words_of_the_columns_that_its_parameters_are_named_after() -> None:
    found = {name: [each.message for each in word_check.check_macro(name)] for name in macro_trees.macro_texts()}
    assert {name: messages for name, messages in found.items() if messages} == {}
    assert len(found) > 200


def test_every_macro_is_read_but_that_of_two_signatures() -> None:
    defined = {name.lower() for name in re.findall(r"\bMACRO (\w+)\(", store.macro_definitions())}
    assert defined == macro_trees.macro_texts().keys()
    assert [name for name in macro_trees.macro_texts() if macro_trees.macro(name) is None] == ["why"]


@pytest.mark.parametrize("part", ["evidence", "inspect", "incident", "judging", "robustness", "watch"])
def test_what_reads_the_tables_beside_the_rules_has_only_words_that_they_have(part: str) -> None:
    read = 0
    for file in sorted((folder("queries") / part).glob("*.sql")):
        tree = syntax.syntax_tree(
            re.sub(r"^(CREATE|INSERT)\b.*?\bAS\b", "", file.read_text(encoding="utf-8"), flags=re.DOTALL)
        )
        if tree["error"]:
            continue  # with fragments, or no SELECT
        read += 1
        assert [each.message for each in check_query(tree["statements"][0]["node"]).wrong] == [], file.name
    assert read


def test_the_nearest_word_of_a_column_with_words_besides_is_one_of_both() -> None:
    beyond: ColumnVocabulary = declarations.word_columns()["line_step"]["beyond"].vocabulary
    assert {"opposing", "same", "shoulder"} < set(beyond.words)
