"""Reading rule files: what is refused, and how it is said."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from drivelint.catalogue import json_schema, load_rules, read_rule
from drivelint.catalogue.header import line_of_key
from drivelint.drive import conditions
from drivelint.errors import RuleError
from drivelint.resources import folder
from tests.evaluate.packs import BEFORE, EXECUTION, HEADER, HOLDS, INVARIANT, MEASURE, PLACE_BEFORE, text, write

SPEED = "SELECT drive_id, ego_id, t_ns, speed_mps AS observed, 1 AS required FROM ego_state"
GOOD = INVARIANT | MEASURE | {"reads": '["ego_state"]'}
REFERENCE = "SELECT drive_id, ego_id, t_ns FROM exit_taken"
READS_BOTH = {"reads": '["ego_state", "exit_taken"]'}
PARAM = '[params.limit]\ndefault = 13\nunit = "m/s"\nwhy = "a test"'


def test_a_rule_is_its_file(tmp_path: Path) -> None:
    rule = write(tmp_path, GOOD, {"condition": SPEED.replace("1 AS", "$limit AS")}, name="r1.slow-down", tables=PARAM)
    assert (rule.id, rule.pack, rule.kind, rule.severity) == ("pack.r1.slow-down", "pack", "invariant", "major")
    assert rule.params["limit"].default == 13.0
    assert isinstance(rule.params["limit"].default, float)
    assert len(rule.version) == 16
    assert (rule.reads, rule.per_object, rule.per_profile) == (("ego_state",), False, False)
    again = write(tmp_path, GOOD | {"title": '"Another"'}, {"condition": SPEED}, name="r1.slow-down")
    assert again.version != rule.version


@pytest.mark.parametrize(
    ("header", "sections", "tables", "message"),
    [
        ({"senze": '">"'}, {}, "", r":12: unknown key 'senze' in the header; did you mean 'sense'\?"),
        ({"kind": '"invarient"'}, {}, "", r"kind = 'invarient': did you mean 'invariant'"),
        ({"title": None}, {}, "", "missing required field `title`"),
        ({"clause": "7"}, {}, "", r":2: header: Expected `str`, got `int`"),
        ({"clause": "broken"}, {}, "", r":2: the header is not TOML"),
        ({}, {}, "[params.limit]\ndefualt = 1\n", r"unknown key 'defualt' in the header; did you mean 'default'"),
        (
            {},
            {},
            "[applies]\nroad_typs = ['town']\n",
            r"unknown key 'road_typs' in the header; did you mean 'road_type'",
        ),
        ({}, {}, "[applies]\nweather = ['wett']", r":\d+: \[applies\] 'wett' is no weather; did you mean 'wet'"),
        ({}, {}, "[applies]\ncarriageway = ['duel', 'single']", "'duel' is no carriageway; did you mean 'dual'"),
        ({}, {}, "[applies]\narea = ['urban']", "'urban' is no area; known are built_up, open"),
        ({}, {}, "[applies]\nlight = ['dusk']", "'dusk' is no light; known are day, night"),
        ({}, {}, "[applies]\nvehicle_class = ['truck']", "'truck' is no vehicle class"),
        ({}, {}, "[applies]\nroad_type = ['moterway']", "'moterway' is no road type; did you mean 'motorway'"),
        ({}, {}, "[applies]\nroad_type = ['TownLocal']", "did you mean 'townLocal'"),
        ({}, {}, "[applies]\nnation = ['uk']", "'uk' is no country code: use 'gb'"),
        ({}, {}, "[applies]\nnation = ['gb-eng', 'gb-nir']", "'gb-nir' is no nation"),
        ({"tags": '["contcat"]'}, {}, "", r":\d+: tags: 'contcat' is no rule tag; did you mean 'contact'\?"),
        ({"law": '["uk"]'}, {}, "", "law: 'uk' is no country code: use 'gb'"),
        ({"requires": '["map", "indikator"]'}, {}, "", "requires: 'indikator' is no signal; did you mean 'indicator'"),
        (
            {"pass_requires": '["weather"]'},
            {},
            "",
            "pass_requires: 'weather' is no signal; known are actor_classes, .*",
        ),
        ({}, {}, "[applies]\nlimit_min_mps = -1", "limit_min_mps must be a speed in m/s, not -1"),
        ({}, {}, "[applies]\nlimit_max_mps = inf", "limit_max_mps must be a speed in m/s, not inf"),
        (
            {},
            {},
            "[applies]\nlimit_min_mps = 3\nlimit_max_mps = 2",
            "above limit_max_mps: the rule would apply nowhere",
        ),
        ({"observes": '" "'}, {}, "", "observes names what a measured condition observes"),
        ({}, {}, PARAM, "parameter 'limit' is never used"),
        ({}, {}, PARAM.replace("limit", "Limit"), "parameter 'Limit': use lower-case"),
        ({"quantifier": '"eventually"'}, {}, "", "'eventually' makes no sense for an invariant"),
        (
            {"quantifier": '"eventually"'} | EXECUTION,
            {"reference": REFERENCE},
            "",
            "'eventually' makes no sense for an execution",
        ),
        ({"subtype": '"temporal"'}, {}, "", "subtype .* belongs to pre- and postconditions"),
        ({"window_s": "3"}, {}, "", "window_s belongs to temporal conditions"),
        ({"combine": '"all"'}, {}, "", "combine is for conditions at a reference point"),
        ({"unit": None}, {}, "", "unit is missing"),
        ({"near_margin": "1.0", "sense": '"holds"'}, {}, "", "near_margin needs a measured condition"),
        (
            {"merge_gap_s": '"nothing"'},
            {},
            "",
            "merge_gap_s = 'nothing' must be a number or the name of a numeric parameter",
        ),
        ({"without_time": '"no sign"'}, {}, "", "an invariant has no reference point"),
        ({"without_anchor": '"no sign"'}, {}, "", "without_anchor is for physical conditions"),
        ({"merge_gap_s": "-1"}, {}, "", "merge_gap_s must be a number of seconds"),
        ({"reads": "[]"}, {}, "", "reads must name the tables"),
        ({"reads": '["ego_state", "pair"]'}, {}, "", ":11: reads does not match the SQL: remove pair"),
        ({"reads": '["pair"]'}, {}, "", ":14: reads does not match the SQL: add ego_state to reads"),
        (EXECUTION, {}, "", "execution: needs a section @reference"),
        ({}, {"reference": REFERENCE}, "", "invariant: has no section @reference"),
        ({}, {"anchor": REFERENCE}, "", "invariant: has no section @anchor"),
        ({}, {"conditoin": SPEED}, "", r"unknown section @conditoin; did you mean @condition\?"),
        ({}, {"condition": "SELECT 1 AS a; SELECT 2 AS b"}, "", "exactly one SELECT, found 2"),
        ({}, {"condition": "DROP TABLE step"}, "", "exactly one SELECT"),
        ({}, {"condition": "SELEC drive_id"}, "", "Parser Error|syntax error"),
        ({}, {"condition": "SELECT * FROM ego_state"}, "", "must name every column"),
        ({}, {"condition": SPEED.replace("speed_mps AS observed, ", "")}, "", "observed missing"),
        (
            {},
            {"condition": SPEED.replace(" FROM", ", 1 AS aplies FROM")},
            "",
            "unknown column 'aplies'; did you mean 'applies'",
        ),
        (
            {},
            {"condition": SPEED.replace(" FROM", ", true AS holds FROM")},
            "",
            "column 'holds' does not go with sense = '>'",
        ),
        (
            {},
            {"condition": SPEED.replace(" FROM", ", 1 AS ref_id FROM")},
            "",
            "reads reference or reference_step returns ref_id",
        ),
        (
            {},
            {"condition": SPEED.replace("ego_state", "'/etc/passwd'")},
            "",
            "there is no table '/etc/passwd' for rules; ",
        ),
        (
            {},
            {"condition": SPEED.replace("ego_state", "read_csv('x.csv')")},
            "",
            r"table function read_csv\(\) is not allowed",
        ),
        (
            {},
            {"condition": SPEED.replace("ego_state", "query('SELECT 1')")},
            "",
            r"table function query\(\) is not allowed",
        ),
        (
            {},
            {"condition": SPEED.replace("ego_state", "ego_stat")},
            "",
            r"there is no table 'ego_stat' for rules; did you mean 'ego_state'\?",
        ),
        ({}, {"condition": SPEED.replace("1 AS", "random() AS")}, "", r"function random\(\) is not allowed in a rule"),
        ({}, {"condition": f"WITH pair AS (SELECT 1) {SPEED}"}, "", "rename the CTE 'pair'"),
        ({}, {"condition": f"WITH _grid AS (SELECT 1) {SPEED}"}, "", "rename the CTE '_grid'"),
        ({}, {"condition": SPEED.replace("1 AS", "$limit AS")}, "", r"\$limit is not a parameter of this rule"),
        ({}, {"condition": SPEED.replace("1 AS", "? AS")}, "", "is not a parameter of this rule"),
        ({}, {"condition": SPEED, "applies": "SELECT drive_id, ego_id FROM ego_state"}, "", "t_ns missing"),
        ({"reference": '"exit_taken"'}, {}, "", "an invariant has no reference point"),
    ],
)
def test_what_is_refused(
    tmp_path: Path, header: dict[str, Any], sections: dict[str, str], tables: str, message: str
) -> None:
    fields = {key: value for key, value in (GOOD | header).items() if value is not None}
    if "title" in header:
        fields = {**fields, "title": ""}
    body = {**({"condition": SPEED} if "conditoin" not in sections else {}), **sections}
    pack = tmp_path / "pack"
    pack.mkdir()
    file = pack / "bad.sql"
    whole = {key: value for key, value in (HEADER | fields).items() if value}
    file.write_text(text(whole, body, tables), encoding="utf-8")
    with pytest.raises(RuleError, match=message) as caught:
        read_rule(file)
    assert all(line.startswith(f"{file}:") for line in str(caught.value).split("\n"))


def test_all_that_is_wrong_in_a_file_is_told_at_once(tmp_path: Path) -> None:
    sql = "SELECT drive_id, ego_id, t_ns,\n  random() AS observed,\n  now() AS required FROM ego_stat"
    with pytest.raises(RuleError) as caught:
        write(tmp_path, GOOD | {"law": '["uk"]', "tags": '["contcat"]'}, {"condition": sql})
    said = [line.partition("rule.sql:")[2] for line in str(caught.value).split("\n")]
    first = len(HEADER | GOOD) + 5
    assert [int(line.partition(":")[0]) for line in said[2:]] == [first + 1, first + 2, first + 2], said
    numbers = [int(line.partition(":")[0]) for line in said]
    assert numbers == sorted(numbers), "in the order of the lines"
    assert ["use 'gb'" in said[0], "'contcat' is no rule tag" in said[1], "did you mean 'ego_state'" in said[4]] == [
        True
    ] * 3
    with pytest.raises(RuleError) as caught:
        write(
            tmp_path,
            GOOD,
            {"condition": f"{SPEED} WHERE speed_mps > $low"},
            tables=PARAM.replace("limit", "most"),
            name="b",
        )
    assert [word in str(caught.value) for word in ("$low is not a parameter", "'most' is never used")] == [True] * 2


@pytest.mark.parametrize(
    ("tables", "line"),
    [
        ("[applies]\nroad_type = ['foo']", 2),
        ("[applies]\nroad_type = [\n    'foo',\n]", 2),
        ("[applies]\nroad_type = [3]", 2),
        ("[applies]\n'road_type' = ['foo']", 2),
        ("[applies]\nlimit_min_mps = -1", 2),
        ("[applies]\nroad_typ = ['town']", 2),
        ("applies.road_type = ['foo']", 1),
        ("applies = {road_type = ['foo']}", 1),
        ("applies = {road_typ = ['foo']}", 1),
        (PARAM.replace("limit", "road_type") + "\n[applies]\nroad_type = ['foo']", 6),
        (PARAM + "\nunits = 'm'", 5),
    ],
)
def test_an_error_in_a_table_of_the_header_names_the_line_of_the_key(tmp_path: Path, tables: str, line: int) -> None:
    with pytest.raises(RuleError, match=rf"rule\.sql:{len(HEADER | GOOD) + line}: "):
        write(tmp_path, GOOD, {"condition": SPEED}, tables=tables)


def test_the_line_of_a_key() -> None:
    header = "title = 'reads = 1'\nreads = [\n    'pair',\n]\n[params.reads]  # a number\ndefault = 1\n[applies]\n"
    keys = {
        "reads": 2,
        "params.reads": 5,
        "params.reads.default": 6,
        "params.*.default": 6,
        "applies.light": 7,
        "law": 1,
    }
    assert {key: line_of_key(header, key) for key in keys} == keys


@pytest.mark.parametrize(
    ("header", "sections", "message"),
    [
        (BEFORE | {"window_s": '"ahead"'}, {"reference": REFERENCE}, "window_s = 'ahead' must be a number or the name"),
        (PLACE_BEFORE, {"reference": REFERENCE}, "physical precondition: needs a section @anchor"),
        (EXECUTION, {"reference": "SELECT drive_id, ego_id FROM exit_taken"}, "must return drive_id, ego_id, t_ns"),
        (EXECUTION, {"reference": REFERENCE, "applies": SPEED}, "@applies is for invariants"),
        (EXECUTION | {"reference": '"_exit_lane"'}, {}, "reference = '_exit_lane' is no event table"),
        (EXECUTION | {"reference": '"exit_taken"'}, {"reference": REFERENCE}, "names an event table already"),
        (EXECUTION | {"combine": '"any"'}, {"reference": REFERENCE}, "combine = 'any' needs the column object_id"),
        (
            EXECUTION,
            {
                "reference": REFERENCE,
                "condition": SPEED.replace("ego_state", "ego_state JOIN reference r USING (drive_id)"),
            },
            "returns ref_id",
        ),
        (
            PLACE_BEFORE,
            {"reference": REFERENCE, "anchor": "SELECT ref_id, t_ns FROM reference_step"},
            "@anchor has no table 'reference_step' in a rule of kind precondition",
        ),
    ],
)
def test_what_is_refused_at_reference_points(
    tmp_path: Path, header: dict[str, str], sections: dict[str, str], message: str
) -> None:
    with pytest.raises(RuleError, match=message):
        write(tmp_path, MEASURE | READS_BOTH | header, {"condition": SPEED} | sections)


def test_sql_before_the_first_section_and_a_missing_condition(tmp_path: Path) -> None:
    (tmp_path / "pack").mkdir()
    file = tmp_path / "pack" / "rule.sql"
    file.write_text(text(HEADER | GOOD, {}) + "\nSELECT 1\n-- @condition\nSELECT 1", encoding="utf-8")
    with pytest.raises(RuleError, match=r":13: only '-- ' comment lines"):
        read_rule(file)
    file.write_text(text(HEADER | GOOD, {}), encoding="utf-8")
    with pytest.raises(RuleError, match="section '-- @condition' is missing"):
        read_rule(file)


def test_packs_of_users_stand_beside_the_shipped_ones(tmp_path: Path) -> None:
    write(tmp_path, GOOD, {"condition": SPEED}, name="one")
    assert "pack.one" in load_rules([tmp_path])
    assert "pack.one" in load_rules([tmp_path / "pack"])
    with pytest.raises(RuleError, match="exists already in"):
        load_rules([tmp_path, tmp_path / "pack"])
    with pytest.raises(RuleError, match="no rules here"):
        load_rules([tmp_path / "nothing"])


def test_a_rule_may_use_ctes_unions_macros_of_ours_and_unnest(tmp_path: Path) -> None:
    ctes = "WITH fast AS (SELECT * FROM ego_state), n AS (SELECT unnest([1, 2]) AS i)"
    sql = f"{ctes} {SPEED.replace('ego_state', 'fast')} UNION ALL {SPEED}"
    rule = write(tmp_path, HOLDS | GOOD | MEASURE, {"condition": sql})
    assert rule.columns["condition"] == ("drive_id", "ego_id", "t_ns", "observed", "required")


def test_conditions_are_read_and_what_they_include_is_known(tmp_path: Path) -> None:
    tables = '[applies]\nnation = ["gb"]\nroad_type = ["town", "rural"]\nlimit_min_mps = 13\n'
    rule = write(tmp_path, GOOD | {"observes": '"speed"'}, {"condition": SPEED}, tables=tables)
    assert rule.applies.restricted_conditions == {"road_type": ("town", "rural"), "nation": ("gb",)}
    assert (rule.applies.limit_min_mps, rule.applies.has_speed_limit_condition, rule.observes) == (13.0, True, "speed")
    assert conditions.with_narrower_values(("gb",)) == ["gb", "gb-eng", "gb-sct", "gb-wls"]
    assert {"town", "townLocal", "rural"} < set(conditions.with_narrower_values(("rural", "town")))
    assert (conditions.broader_values(("gb-sct", "de")), conditions.broader_values(("gb",))) == (["gb"], [])
    assert conditions.value_problem("nation", "fr") is None


def test_the_published_schema_of_the_header_is_current() -> None:
    written = json.loads((folder("schemas") / "assertion-header.schema.json").read_text(encoding="utf-8"))
    assert written == json.loads(json.dumps(json_schema()))
    assert written["$defs"]["Header"]["additionalProperties"] is False


def test_a_pack_says_what_it_is_about(tmp_path: Path) -> None:
    assert all(rule.pack_title for rule in load_rules().values())
    pack = tmp_path / "mine"
    pack.mkdir()
    file = pack / "speed.sql"
    file.write_text(text(HEADER | GOOD, {"condition": SPEED}), encoding="utf-8")
    assert read_rule(file).pack_title == ""
    other = tmp_path / "broken"
    other.mkdir()
    (other / "pack.toml").write_text("titel = 'x'\n", encoding="utf-8")
    (other / "speed.sql").write_text(file.read_text(encoding="utf-8"), encoding="utf-8")
    with pytest.raises(RuleError, match=r"pack\.toml: .*`titel`.*: write title = "):
        read_rule(other / "speed.sql")


def test_the_columns_of_a_union_by_name_are_not_those_of_its_first_branch(tmp_path: Path) -> None:
    """The engine numbers reference points in the order of all their columns: it asks the database for them."""
    of = "SELECT drive_id, ego_id, t_ns FROM ego_state"
    condition = {"condition": "SELECT drive_id, ego_id, t_ns, true AS holds FROM ego_state"}
    header = HEADER | EXECUTION | HOLDS | {"reads": '["ego_state"]'}
    for other, known in ((f"UNION ALL BY NAME {of}", False), (f"UNION ALL {of}", True)):
        rule = write(tmp_path, header, {"reference": f"{of} {other}"} | condition)
        assert ("reference" in rule.columns) == known
