"""The catalogue page: current, and honest about what is not covered."""

from __future__ import annotations

import pytest

from drivelint.catalogue import load
from drivelint.errors import RuleError
from drivelint.report.catalogue_page import Clause, by_clause, cited, clauses, page
from drivelint.resources import folder

PACKS = folder("queries") / "assertions"


def test_the_page_in_the_repository_is_the_one_that_the_rules_make() -> None:
    written = (folder("queries") / "README.md").read_text(encoding="utf-8")
    assert written == page(load().values(), PACKS), "write it anew: drivelint rules page --out queries/README.md"


def test_every_rule_stands_on_the_page_and_every_number_with_it() -> None:
    rules = load().values()
    text = page(rules, PACKS)
    for rule in rules:
        assert f"| `{rule.id.removeprefix(rule.pack + '.')}` | {rule.hypothesis} |" in text
        assert all(f"`{name}` " in text for name in rule.params)


def test_every_clause_from_89_to_307_has_one_entry() -> None:
    names = [name for clause in clauses(PACKS / "ukhc") for name in sorted(clause.names)]
    assert sorted(names) == sorted([*(f"R{n}" for n in range(89, 308)), "H1", "H2", "H3"])


def test_a_rule_of_the_highway_code_cites_a_clause() -> None:
    assert [rule.id for rule in load().values() if rule.pack == "ukhc" and not cited(rule)] == []


def test_a_clause_that_nobody_covers_says_why() -> None:
    with pytest.raises(RuleError, match="307: no rule covers it"):
        by_clause([], [Clause("307", "trams")])
    rows = by_clause([], [Clause("307", "trams", "no trams in maps")])
    assert [(row.covered, row.drafted) for row in rows] == [((), ())]


def test_a_rule_that_cites_a_clause_without_entry_is_refused() -> None:
    with pytest.raises(RuleError, match="has no entry"):
        by_clause(load().values(), [Clause("H1", "greatest harm", "a principle")])


def test_what_is_no_clause_is_refused() -> None:
    with pytest.raises(RuleError, match="write H1, 103 or 89-94"):
        Clause("R103", "signals").names  # noqa: B018 - the property refuses
