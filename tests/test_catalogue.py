"""The shipped catalogue: every rule's header, SQL and plan, its cases, and whether the cases would notice a wrong
rule."""

from __future__ import annotations

from typing import TYPE_CHECKING

import msgspec
import pytest

from drivelint import store
from drivelint.casefile import read_cases, run_case, run_cases
from drivelint.catalogue import Rule, load
from drivelint.evaluate import explain

if TYPE_CHECKING:
    import duckdb

RULES = load()
IDS = list(RULES)
OPPOSITE = {">": "<=", ">=": "<", "<": ">=", "<=": ">"}
EDGE = {">": ">=", ">=": ">", "<": "<=", "<=": "<"}


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


@pytest.mark.parametrize("rule_id", IDS)
def test_cases(rule_id: str) -> None:
    wrong = [f"{name}: {message}" for name, ok, message in run_cases(RULES[rule_id]) if not ok]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("rule_id", IDS)
def test_the_plans_join_on_keys(con: duckdb.DuckDBPyConnection, rule_id: str) -> None:
    plans = explain(con, RULES[rule_id])
    assert plans
    for plan in plans:
        assert "BLOCKWISE_NL" not in plan, plan


def _noticed(rule: Rule) -> bool:
    return any(not run_case(rule, case).ok for case in read_cases(rule))


@pytest.mark.parametrize("rule_id", IDS)
def test_cases_notice_a_wrong_sense(rule_id: str) -> None:
    rule = RULES[rule_id]
    if rule.sense == "holds":
        sql = rule.sections["condition"]
        negated = f"SELECT * REPLACE (NOT holds AS holds) FROM (\n{sql}\n)"
        mutants = [msgspec.structs.replace(rule, sections={**rule.sections, "condition": negated})]
    else:
        mutants = [msgspec.structs.replace(rule, sense=sense) for sense in (OPPOSITE[rule.sense], EDGE[rule.sense])]
    for mutant in mutants:
        assert _noticed(mutant), f"no case of {rule_id} notices sense = {mutant.sense}"


NUMERIC = [
    (rule.id, name)
    for rule in RULES.values()
    for name, param in rule.params.items()
    if isinstance(param.default, float)
]


@pytest.mark.parametrize(("rule_id", "name"), NUMERIC)
def test_cases_notice_a_wrong_threshold(rule_id: str, name: str) -> None:
    rule = RULES[rule_id]
    param = rule.params[name]
    assert isinstance(param.default, float)
    for wrong in (param.default * 0.5 - 0.1, param.default * 2 + 0.1):
        value = max(wrong, 0.0) if name in {rule.window_s, rule.merge_gap_s, rule.exempt_after_s} else wrong
        params = {**rule.params, name: msgspec.structs.replace(param, default=value)}
        if _noticed(msgspec.structs.replace(rule, params=params)):
            return
    pytest.fail(f"no case of {rule_id} notices a wrong {name}")
