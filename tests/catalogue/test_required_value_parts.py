"""The parts of a requirement, beside the rules that have them: they add up to what the rule requires in each of its cases."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec
import pytest

from drivelint.casefile import read_cases
from drivelint.casefile.scene import case_database, complete_scene, insert_rows
from drivelint.catalogue import load_rules
from drivelint.catalogue.required_value_parts import parts_path, read_parts
from drivelint.errors import RuleError
from drivelint.evaluate import evaluate

if TYPE_CHECKING:
    from drivelint.casefile import Case
    from drivelint.catalogue import Rule

WITH_PARTS = [rule for rule in load_rules().values() if parts_path(rule).is_file()]
OF_A_TABLE = {"ukhc.r162.safe-distance-ahead"}
"""Rules whose requirement and parts are columns of one table, which the cases give: see tests/derive."""


def test_there_are_rules_with_parts() -> None:
    assert {rule.id for rule in WITH_PARTS} > OF_A_TABLE


@pytest.mark.slow
@pytest.mark.parametrize("rule", WITH_PARTS, ids=lambda rule: rule.id)
def test_the_parts_add_up_to_what_is_required(rule: Rule) -> None:
    compared = sum(_compared(rule, case) for case in read_cases(rule))
    assert compared or rule.id in OF_A_TABLE


def _compared(rule: Rule, case: Case) -> int:
    """Return at how many steps of a case the parts were held against the requirement."""
    found = read_parts(rule)
    assert found is not None
    con = case_database()
    scene = complete_scene(rule, case.given_tables, case.missing_signals)
    try:
        for table, rows in scene.items():
            insert_rows(con, table, rows)
        evaluate(con, [rule], {rule.id: case.params}, margins=True)
        params = {name: param.default for name, param in rule.params.items()} | case.params
        bound = {name: params[name] for name in found.parameters}
        steps = con.execute(
            f"FROM margin JOIN ({found.sql}) USING ({', '.join(found.key_columns)}) WHERE required IS NOT NULL", bound
        )
        n = 0
        for row in steps.to_arrow_table().to_pylist():
            parts = [row[name] for name in found.parts if row[name] is not None]
            if parts:
                n += 1
                assert math.isclose(sum(parts), row["required"], rel_tol=1e-9, abs_tol=1e-9), (case.name, row)
        return n
    finally:
        con.execute(";".join(f"DELETE FROM {table}" for table in (*scene, "verdict", "finding", "margin")))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("sql = 3", "write sql and"),
        ('sql = "SELECT drive_id, ego_id, t_ns, 1 AS a_m FROM pair"\n[parts]\na_m = "a"', "reads 'pair'"),
        ('sql = "SELECT drive_id, ego_id, t0_ns AS t_ns, $b AS a_m FROM overtake"\n[parts]\na_m = "a"', "no parameter"),
        ('sql = "SELECT drive_id, ego_id, t0_ns AS t_ns, 1 AS b_m FROM overtake"\n[parts]\na_m = "a"', "must return"),
        ('sql = "SELECT drive_id, ego_id, 1 AS a_m FROM overtake"\n[parts]\na_m = "a"', "must return"),
        ("sql = \"FROM read_text('/etc/passwd')\"\n[parts]\n", "not allowed"),
    ],
)
def test_a_file_that_cannot_be_understood_is_named(text: str, message: str, tmp_path: Path) -> None:
    shipped = next(rule for rule in WITH_PARTS if rule.id == "ukhc.r163.pull-out-separation")
    rule = msgspec.structs.replace(shipped, path=tmp_path / "mine.sql")
    assert read_parts(rule) is None
    parts_path(rule).write_text(text, encoding="utf-8")
    with pytest.raises(RuleError, match=message) as error:
        read_parts(rule)
    assert str(parts_path(rule)) in str(error.value)
