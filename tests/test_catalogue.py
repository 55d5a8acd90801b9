"""The shipped catalogue: every rule's header, SQL and plan, its cases, and whether the cases would notice a wrong
rule.

Here the cases of some rules are judged by all of these as drives of one database, and of the rest there is a sample. `.ci/full` also
runs `drivelint rules test` (each case alone, and all as egos of one drive) and `drivelint rules test --mutate` (every mutant of every
rule).
"""

from __future__ import annotations

from functools import cache
from hashlib import sha256
from typing import TYPE_CHECKING

import pytest

from drivelint.casefile import coverage_problem, read_cases, run_cases, unused_reasons_message
from drivelint.casefile.mutation import judge_mutants, unknown_rule_messages
from drivelint.catalogue import load_rules
from drivelint.sql import store
from tests.catalogue.judged_together import CasesTogether, judged_together

if TYPE_CHECKING:
    import duckdb

RULES = load_rules()
IDS = sorted(RULES, key=lambda i: RULES[i].status != "stable")
"""Those of stable rules first: the others are judged apart from them, and later."""
SAMPLE = sorted(
    (rule.id for rule in RULES.values() if rule.status == "stable"), key=lambda i: sha256(i.encode()).digest()
)[:1]
RULES_AT_ONCE = 8
"""So many rules are judged on the cases of all of them: of more, the cases of the others take longer than an evaluation."""


@pytest.fixture(scope="module")
def con() -> duckdb.DuckDBPyConnection:
    return store.connect(threads=1)


def test_there_are_rules() -> None:
    assert RULES
    assert any(rule.status == "stable" for rule in RULES.values())


@pytest.mark.parametrize("rule_id", IDS)
def test_header(rule_id: str) -> None:
    rule = RULES[rule_id]
    assert rule.hypothesis.endswith("?"), "the hypothesis is a question"
    assert rule.title
    assert rule.clause
    assert all(param.why and param.unit is not None for param in rule.params.values())


@cache
def judged_in_part(part: int) -> dict[str, CasesTogether]:
    return judged_together([RULES[rule_id] for rule_id in IDS[part * RULES_AT_ONCE : (part + 1) * RULES_AT_ONCE]])


def in_quick_part(rule_id: str) -> bool:
    """Whether a rule's cases are judged in the quick suite: those of every other part of the stable rules are."""
    return RULES[rule_id].status == "stable" and IDS.index(rule_id) // RULES_AT_ONCE % 2 == 0


@pytest.mark.parametrize("rule_id", [pytest.param(i, marks=[] if in_quick_part(i) else pytest.mark.ci) for i in IDS])
def test_cases(rule_id: str) -> None:
    rule = RULES[rule_id]
    problem, codes = judged_in_part(IDS.index(rule_id) // RULES_AT_ONCE)[rule_id]
    assert problem == ""
    assert unused_reasons_message(rule, codes) == ""
    assert coverage_problem(read_cases(rule)) == ""


@pytest.mark.ci
@pytest.mark.parametrize("rule_id", SAMPLE)
def test_each_case_alone_and_as_egos(rule_id: str) -> None:
    assert [message for _, ok, message in run_cases(RULES[rule_id]) if not ok] == []


@pytest.mark.parametrize("rule_id", SAMPLE)
def test_the_cases_would_notice_a_wrong_rule(rule_id: str) -> None:
    proof = judge_mutants(RULES[rule_id])
    assert proof.n > 0
    assert (proof.problem, proof.unlisted_survivors, proof.stale_listed_faults) == ("", (), ())


def test_a_survivor_is_listed_of_rules_that_there_are() -> None:
    assert unknown_rule_messages(list(RULES.values())) == []
