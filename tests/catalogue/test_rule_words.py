"""A rule with a word that no column has is refused where it is read: such a rule would never apply, and pass everything."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import pytest

from drivelint import cli
from drivelint.catalogue import load_rule, load_rules, parse_params, read_rule
from drivelint.catalogue.rule_words import refuse_wrong_words
from drivelint.errors import RuleError, UsageError
from tests.evaluate.packs import EXECUTION, HEADER, HOLDS, INVARIANT, text, write

if TYPE_CHECKING:
    from pathlib import Path

CYCLIST = """SELECT drive_id, ego_id, t_ns, object_id,
    clearance_m > 1.5 AS holds,
    is_class(actor_class, 'cyclist') AS applies
FROM pair"""
KIND = '[params.kind]\ndefault = "{}"\nunit = ""\nwhy = "a test"'
BY_KIND = (
    "SELECT drive_id, ego_id, t_ns, object_id, clearance_m > 1.5 AS holds, actor_class = $kind AS applies FROM pair"
)
OF_PAIR = INVARIANT | HOLDS | {"reads": '["pair"]'}
SHIPPED = load_rules()


def packed(folder: Path, sql: str = CYCLIST, tables: str = "") -> Path:
    """Write the issue's rule as a user does, and return its pack's folder."""
    file = folder / "rules" / "mine" / "cyclists.sql"
    file.parent.mkdir(parents=True)
    file.write_text(text(HEADER | OF_PAIR, {"condition": sql}, tables), encoding="utf-8")
    return file.parent.parent


def test_a_class_that_does_not_exist_is_refused_where_it_stands(tmp_path: Path) -> None:
    rules = packed(tmp_path)
    message = r"mine/cyclists\.sql:15: 'cyclist' is no actor class; did you mean 'bicycle'\?$"
    for read in (
        lambda: read_rule(rules / "mine" / "cyclists.sql"),
        lambda: load_rules([rules]),
        lambda: load_rule("mine.cyclists", [rules]),
    ):
        with pytest.raises(RuleError, match=message):
            read()
    line = (rules / "mine" / "cyclists.sql").read_text(encoding="utf-8").splitlines()[15 - 1]
    assert "'cyclist'" in line


@pytest.mark.parametrize("command", ["test", "check", "list"])
def test_the_commands_refuse_it(
    tmp_path: Path, command: str, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    rules = str(packed(tmp_path))
    asked = {
        "test": ["rules", "test", rules],
        "list": ["rules", "list", "--rules-dir", rules],
        "check": ["check", "none.mcap", "--rules-dir", rules, "--out", str(tmp_path / "out")],
    }[command]
    monkeypatch.setattr(sys, "argv", ["drivelint", *asked])
    with pytest.raises(SystemExit) as left:
        cli.main()
    said = "".join(capfd.readouterr())
    assert left.value.code == 2
    assert "mine/cyclists.sql:15: 'cyclist' is no actor class; did you mean 'bicycle'?" in said


@pytest.mark.parametrize("rule", SHIPPED.values(), ids=SHIPPED)
def test_every_shipped_rule_has_only_words_that_its_tables_have(rule: object) -> None:
    """They are not looked at again when they are read: that takes a third of the time."""
    assert hasattr(rule, "sections")
    assert hasattr(rule, "params")
    refuse_wrong_words(rule.sections, rule.params, lambda part, offset: f"{part}, byte {offset}")


def test_the_words_of_a_rules_reference_points_are_known_in_its_condition(tmp_path: Path) -> None:
    sections = {
        "reference": "SELECT drive_id, ego_id, t_start_ns AS t_ns, side AS to_side FROM lane_change",
        "condition": "SELECT drive_id, ego_id, t_ns, ref_id, to_side = '{}' AS holds FROM reference",
    }
    header = EXECUTION | HOLDS | {"reads": '["lane_change"]'}
    good = {**sections, "condition": sections["condition"].format("left")}
    assert write(tmp_path, header, good).reads == ("lane_change",)
    with pytest.raises(RuleError, match=r"rule\.sql:\d+: 'lefft' is no side; did you mean 'left'\?"):
        write(tmp_path, header, {**sections, "condition": sections["condition"].format("lefft")})


def test_a_section_that_is_too_deep_for_the_check_of_words_is_named() -> None:
    sections = {
        "condition": "SELECT drive_id, ego_id, t_ns, speed_mps > 1 AS holds FROM ego_state",
        "applies": "SELECT e.drive_id, e.ego_id, e.t_ns, true AS applies FROM ego_state e" + " CROSS JOIN step" * 900,
    }
    with pytest.raises(RuleError, match=r"^applies, byte 0: too deeply nested"):
        refuse_wrong_words(sections, {}, lambda part, offset: f"{part}, byte {offset}")


def test_the_default_of_a_parameter_and_its_value_are_words_too(tmp_path: Path) -> None:
    with pytest.raises(
        RuleError, match=r"rule\.sql:\d+: parameter 'kind': 'cyclist' is no actor class; did you mean 'bicycle'\?"
    ):
        write(tmp_path, OF_PAIR, {"condition": BY_KIND}, tables=KIND.format("cyclist"))
    rule = write(tmp_path, OF_PAIR, {"condition": BY_KIND}, tables=KIND.format("bicycle"))
    assert parse_params([rule], ["pack.rule.kind=pedestrian"]) == {"pack.rule": {"kind": "pedestrian"}}
    message = r"--param 'pack\.rule\.kind=pedestrain': 'pedestrain' is no actor class; did you mean 'pedestrian'\?"
    with pytest.raises(UsageError, match=message):
        parse_params([rule], ["pack.rule.kind=pedestrain"])


def test_a_parameter_that_no_column_of_words_is_compared_with_may_be_any_text(tmp_path: Path) -> None:
    rule = write(
        tmp_path,
        OF_PAIR,
        {"condition": BY_KIND.replace("actor_class = $kind", "object_id = $kind")},
        tables=KIND.format("truck-7"),
    )
    assert parse_params([rule], ["pack.rule.kind=anybody"]) == {"pack.rule": {"kind": "anybody"}}
