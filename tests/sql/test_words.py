"""The vocabularies: every column of words has one, every word of ours is in one, and readers' tables are held against them."""

from __future__ import annotations

import ast
import re
from pathlib import Path
from typing import Any

import pyarrow as pa
import pytest

import drivelint
from drivelint.drive import trace
from drivelint.drive.conditions import DRIVE_CONDITION_VALUES
from drivelint.drive.declared_events import EVENTS, ON_OFF_EVENTS
from drivelint.engine.profiles import load_profiles
from drivelint.errors import DriveLintError, InternalError
from drivelint.facts import toml_beside
from drivelint.formats.opendrive import network
from drivelint.formats.osi import map_kinds
from drivelint.reasons.signals import SIGNALS
from drivelint.resources import folder
from drivelint.road import signcodes
from drivelint.sql import declarations, store, words
from drivelint.sql.words import ColumnVocabulary, refuse_wrong_words, vocabularies, word_column

SOURCES = Path(drivelint.__file__).parent
TEXTS = {
    # texts that a log, a map, a rule or a user gave
    *("camera", "file_name", "sha256", "format", "geo_reference", "value", "message", "name", "country", "type", "subtype", "unit"),
    *("map_name", "map_sha256", "status_reason", "rule_version", "pack", "pack_title", "title", "breach", "clause", "hypothesis"),
    "observes",
    # codes with arguments, told in sentences
    *("reason", "unplaced_reason", "ov_reason", "reason_code", "cause_code", "cause_args", "assumes"),
    # of results only: no rule reads them
    *("status", "subtype", "derivation", "legal", "sense", "requires", "profiles", "conditions", "lanelets", "finding_ids"),
    *("occasions", "quality", "not_judged", "recorded", "exposure", "params", "actors", "stretches", "profile"),
}  # fmt: skip
"""Columns of texts, or with texts in them, that hold no words of a vocabulary."""


def columns_of_texts() -> list[tuple[str, str, bool]]:
    """Return table, column and whether it names a vocabulary, of every column that holds texts and is no id."""
    tables = re.findall(r"^CREATE TABLE (\w+) \(\n(.*?)^\);", declared(), re.DOTALL | re.MULTILINE)
    return [
        (table, column, comment.startswith("["))
        for table, body in tables
        for column, kind, comment in re.findall(r"^    (\w+) (.*?),?\s*-- (.+)$", body, re.MULTILINE)
        if "VARCHAR" in kind and not re.search(r"(^|_)id$", column)
    ]


def declared() -> str:
    files = [*sorted(folder("schemas").glob("*.sql")), *sorted((folder("queries") / "library").glob("*/*.sql"))]
    return "\n".join(file.read_text(encoding="utf-8") for file in files)


def test_every_column_of_texts_names_its_vocabulary_or_has_none() -> None:
    columns = columns_of_texts()
    assert len(columns) > 150
    outputs = {table for file in ("verdict", "output", "evidence") for table in declarations.column_comments(file)}
    bare = [(table, column) for table, column, marked in columns if not marked and column not in TEXTS]
    assert bare == []
    # what rules read has words, or texts that nobody lists
    unlisted = {column for table, column, marked in columns if not marked and table not in outputs}
    assert unlisted.isdisjoint({"status", "profile", "legal", "sense"})


def test_every_vocabulary_is_that_of_a_column_or_of_a_condition() -> None:
    used = {column.vocabulary.name for columns in declarations.word_columns().values() for column in columns.values()}
    assert used | {"engaged"} == set(vocabularies())
    assert set(DRIVE_CONDITION_VALUES) <= set(vocabularies())


def test_a_vocabulary_has_not_the_name_of_a_table() -> None:
    """Either is looked up by `drivelint docs dictionary NAME`; the table of verdicts lists the five words itself."""
    assert set(vocabularies()) & set(declarations.column_comments()) == {"verdict"}


@pytest.mark.parametrize("vocabulary", vocabularies().values(), ids=lambda each: each.name)
def test_a_vocabulary_knows_its_words_and_proposes_the_nearest_for_another(vocabulary: ColumnVocabulary) -> None:
    assert len(set(vocabulary.words)) == len(vocabulary.words) > 1
    assert vocabulary.says
    for word in vocabulary.words:
        assert vocabulary.problem(word) is None
        assert vocabulary.known_spelling(word.upper()) == word
        wrong = f"{word}{word[-1]}x" if len(word) < 3 else f"{word[:-1]}{word[-2]}{word[-1]}"
        if wrong not in vocabulary.words and vocabulary.has_all_words:
            assert str(vocabulary.problem(wrong)).startswith(
                f"{wrong!r} is no {vocabulary.name.replace('_', ' ')}; "
            ), wrong


def test_the_nearest_word_is_named() -> None:
    classes, nations, events = (vocabularies()[name] for name in ("actor_class", "nation", "event"))
    assert classes.problem("cyclist") == "'cyclist' is no actor class; did you mean 'bicycle'?"
    assert str(classes.problem("lorry")).startswith("'lorry' is no actor class; known are car, van, truck,")
    assert (nations.problem("fr"), nations.problem("gb-sct")) == (None, None)
    assert str(nations.problem("gb-scot")) == "'gb-scot' is no nation; did you mean 'gb-sct'?"
    assert nations.problem("uk") is not None
    # a log may have events of its own
    assert events.problem("door_opened") is None
    assert events.problem("mirror_chek") == "'mirror_chek' is no event; did you mean 'mirror_check'?"


def test_what_is_said_elsewhere_are_words_of_the_vocabularies() -> None:
    known = {name: set(vocabulary.words) for name, vocabulary in vocabularies().items()}
    assert known["signal"] == SIGNALS
    assert list(words.words_of_vocabulary("event")) == list(EVENTS)
    assert list(words.words_of_vocabulary("mode")) == list(ON_OFF_EVENTS)
    assert known["profile_name"] == set(load_profiles())
    assert set(trace.MOTOR_VEHICLES) < known["actor_class"]
    beside = signcodes.__file__
    assert list(words.words_of_vocabulary("sign_kind")) == list(toml_beside(beside, "signcodes.toml"))
    names = toml_beside(beside, "signnames.toml")
    assert set(names["names"]) <= known["sign_kind"]
    turns = [*names["arrows"].values(), *names["directions"].values(), *map_kinds.TURNS_BY_LIGHT_ICON.values()]
    assert {turn for each in turns for turn in each} == known["turn"]
    assert {*map_kinds.SIGN_KINDS.values(), *map_kinds.LIGHT_KIND_BY_ICON.values()} <= known["sign_kind"]
    assert {*network.DRIVABLE_LANE_TYPES, *map_kinds.DRIVABLE_LANE_KINDS, *map_kinds.LANE_KINDS.values()} <= known[
        "lane_type"
    ]
    assert set(map_kinds.LANE_CHANGE_BY_PASSING_RULE.values()) == known["lanes_changed"]
    assert set(map_kinds._MARKINGS.values()) <= known["marking"]


def check_ids() -> dict[str, set[str]]:
    """Return the check ids that stand in the sources, by the vocabulary that they must be in."""
    found: dict[str, set[str]] = {"log_check": set(), "map_check": set()}
    for file in sorted(SOURCES.rglob("*.py")):
        for call in (
            node for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))) if isinstance(node, ast.Call)
        ):
            name = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
            said = [arg.value if isinstance(arg, ast.Constant) else None for arg in call.args]
            first, second = [*said, None, None][:2]
            if name in {"QualityFinding", "of_actors"} and isinstance(first, str):
                found["log_check"].add(first)
            if name == "findings" and isinstance(second, str):
                found["log_check"].add(second)
            if name in {"add", "_quality_row"} and len(said) >= 4 and isinstance(first, str):
                found["map_check"].add(first)
    return found


def test_every_check_of_the_data_is_a_word_and_every_word_is_a_check() -> None:
    """A check that is no word would make its drive not judged."""
    sources = "\n".join(file.read_text(encoding="utf-8") for file in sorted(SOURCES.rglob("*.py")))
    for name, found in check_ids().items():
        assert len(found) > 30
        assert sorted(found - set(words.words_of_vocabulary(name))) == []
        # those that are put together or passed on stand in the sources too
        composed = {"no_indicator", "no_brake_light"}
        assert [
            word for word in words.words_of_vocabulary(name) if f'"{word}"' not in sources and word not in composed
        ] == []


def test_the_mark_of_a_column_says_its_vocabulary_and_what_it_has_besides() -> None:
    column = word_column("VARCHAR", "[control + none] what governs the ego's way in")
    assert column is not None
    assert column.vocabulary.words == ("traffic_light", "stop", "give_way", "none")
    assert (column.field, column.is_list) == ("", False)
    assert word_column("VARCHAR", "the drive") is None
    lights = declarations.word_columns()["way_mark"]["lights"]
    assert (lights.field, lights.is_list, lights.vocabulary.name) == ("fit", True, "light_fit")
    with pytest.raises(
        DriveLintError, match=r"no vocabulary \[actor_clas\] in words\.toml; did you mean 'actor_class'\?"
    ):
        word_column("VARCHAR", "[actor_clas]")


def test_a_comment_is_shown_with_the_words_in_place_of_the_mark() -> None:
    comments = declarations.column_comments()
    assert comments["actor_state"]["indicator"] == "off, left, right, hazard; NULL: not known"
    assert comments["lanelet"]["lane_type"] == "a word of lane_type"
    assert comments["ego_condition"]["nation"] == "gb, gb-eng, gb-wls, gb-sct, de, ...; NULL: not given"
    assert comments["actor"]["actor_id"] == "the log's own id of the actor, as text"
    assert not [text for columns in comments.values() for text in columns.values() if words.VOCABULARY_MARK.match(text)]


def handed_over(table: str, column: str, value: Any) -> None:
    """Make a table as a reader hands it over, with a value in one column."""
    kind = store.arrow_schemas()[table].field(column).type
    rows = pa.table({column: pa.array([None, value, value], kind)})
    refuse_wrong_words(rows, declarations.word_columns()[table], f"reader some-format: table {table}")


GATED = [
    (table, name, column)
    for file in ("model", "map")
    for table in declarations.column_comments(file)
    for name, column in declarations.word_columns()[table].items()
]


@pytest.mark.parametrize(("table", "name", "column"), GATED, ids=[f"{table}.{name}" for table, name, _ in GATED])
def test_a_reader_that_hands_over_another_word_is_named(table: str, name: str, column: words.WordColumn) -> None:
    good = column.vocabulary.words[-1]
    wrong = f"{good}{good[-1]}"
    handed_over(table, name, [good] if column.is_list else good)
    if column.vocabulary.open:
        handed_over(table, name, wrong)  # it may be the log's own
        return
    message = rf"^reader some-format: table {table}, column {name}: '{wrong}' is no .*; did you mean '{good}'\?: a fault of the reader$"
    with pytest.raises(InternalError, match=message):
        handed_over(table, name, [good, wrong] if column.is_list else wrong)


def test_a_readers_rows_are_held_against_the_vocabularies() -> None:
    row = {
        "actor_id": "a",
        "actor_class": "cyclist",
        "length_m": 1.0,
        "width_m": 1.0,
        "height_m": None,
        "is_ego": False,
    }
    with pytest.raises(
        InternalError, match=r"^reader osi-mcap: table actor, column actor_class: 'cyclist' .*'bicycle'"
    ):
        store.table_with_owner_id("actor", "d", [row], "osi-mcap")
    assert store.table_with_owner_id("actor", "d", [row | {"actor_class": "bicycle"}], "osi-mcap").num_rows == 1
