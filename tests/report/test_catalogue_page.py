"""The catalogue page: current, and honest about what is not covered."""

from __future__ import annotations

import re

import pytest

from drivelint.catalogue import load_rules
from drivelint.drive.conditions import CONDITION_TEXTS, DRIVE_CONDITION_VALUES
from drivelint.drive.declared_events import EVENTS, ON_OFF_EVENTS
from drivelint.errors import RuleError
from drivelint.report.catalogue_page import (
    Clause,
    cited_clauses,
    clause_coverage,
    map_features,
    read_clauses,
    render_markdown,
)
from drivelint.resources import folder
from drivelint.road.signcodes import signal_kind

PACKS = folder("queries") / "assertions"


def test_the_page_in_the_repository_is_the_one_that_the_rules_make() -> None:
    written = (folder("queries") / "README.md").read_text(encoding="utf-8")
    assert written == render_markdown(load_rules().values(), PACKS), (
        "write it anew: drivelint rules page --out queries/README.md"
    )


def test_every_rule_stands_on_the_page_and_every_number_with_it() -> None:
    rules = load_rules().values()
    text = render_markdown(rules, PACKS)
    for rule in rules:
        assert f"| `{rule.id.removeprefix(rule.pack + '.')}` | {rule.hypothesis} |" in text
        assert all(f"`{name}` " in text for name in rule.params)


def test_the_nation_of_a_law_stands_beside_the_conditions() -> None:
    rows = {
        line.split("`")[1]: line
        for line in render_markdown(load_rules().values(), PACKS).splitlines()
        if line.startswith("| `")
    }
    assert "[law de, road_type motorway]" in rows["rg1"]
    assert "[law gb]" in rows["r124.speed-limit"]
    assert "law" not in rows["no-collision"].split("|")[3]


def test_every_clause_from_89_to_307_has_one_entry() -> None:
    names = [name for clause in read_clauses(PACKS / "ukhc") for name in sorted(clause.cited_names)]
    assert sorted(names) == sorted([*(f"R{n}" for n in range(89, 308)), "H1", "H2", "H3"])


def test_a_rule_of_the_highway_code_cites_a_clause() -> None:
    assert [rule.id for rule in load_rules().values() if rule.pack == "ukhc" and not cited_clauses(rule)] == []


def test_a_clause_that_nobody_covers_says_why() -> None:
    with pytest.raises(RuleError, match="307: no rule covers it"):
        clause_coverage([], [Clause("307", "trams")])
    rows = clause_coverage([], [Clause("307", "trams", "no trams in maps")])
    assert [(row.covered, row.drafted) for row in rows] == [((), ())]


def test_a_rule_that_cites_a_clause_without_entry_is_refused() -> None:
    with pytest.raises(RuleError, match="has no entry"):
        clause_coverage(load_rules().values(), [Clause("H1", "greatest harm", "a principle")])


def test_what_is_no_clause_is_refused() -> None:
    with pytest.raises(RuleError, match="write H1, 103 or 89-94"):
        Clause("R103", "signals").cited_names  # noqa: B018 - the property refuses


def compared(sql: str, column: str) -> set[str]:
    """Return the words that SQL holds a column against."""
    lists = re.findall(rf"\b{column} (?:=|IN) (\[[^\]]*\]|\([^)]*\)|'[a-z_]+')", sql)
    return {word for one in lists for word in re.findall(r"'([a-z_]+)'", one)}


def test_every_event_that_a_rule_or_a_derivation_asks_for_is_on_the_page() -> None:
    asked: set[str] = set()
    for file in sorted(folder("queries").glob("**/*.sql")):
        sql = file.read_text(encoding="utf-8")
        asked |= compared(sql, "event") if "declared_event" in sql else set()
        asked |= compared(sql, "mode") if "ego_mode" in sql else set()
    assert asked == EVENTS.keys()


def test_the_modes_that_the_log_is_looked_through_for_are_those_of_the_vocabulary() -> None:
    sql = (folder("queries") / "library" / "log" / "capability.sql").read_text(encoding="utf-8")
    assert compared(sql, "mode") == ON_OFF_EVENTS.keys()
    required = {signal for rule in load_rules().values() for signal in rule.requires if signal.startswith("mode_")}
    assert required <= {f"mode_{mode}" for mode in ON_OFF_EVENTS}


def test_every_condition_is_explained() -> None:
    assert CONDITION_TEXTS.keys() == DRIVE_CONDITION_VALUES.keys()


def test_a_signal_is_recognised_by_the_name_that_the_page_gives() -> None:
    parts = map_features()["name_parts"]
    assert {kind: signal_kind("", "", name) for kind, name in parts.items()} == {kind: kind for kind in parts}


def map_feature_rows() -> list[list[str]]:
    _, _, text = render_markdown(load_rules().values(), PACKS).partition("## What a map must have")
    return [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| ")]


def test_what_a_map_must_have_is_asked_for_by_some_rule() -> None:
    assert [name for name, _, asking in map_feature_rows() if asking == "no rule"] == []


def test_a_zebra_is_one_by_name() -> None:
    (zebra,) = (row for row in map_feature_rows() if row[0] == "zebra")
    assert "zebra in its `name` or `subtype`" in zebra[1]
    assert "`ukhc.r195.zebra-on`" in zebra[2]
