"""What the pages say of numbers and orders is so."""

from __future__ import annotations

import random
import re

import yaml

import drivelint
from drivelint.guide import FOLDER
from drivelint.report.worst_first import worst_first
from tests.guide.blocks import blocks
from tests.report.synthetic import drive, finding, result, rule, verdict


def test_the_checks_of_the_rule_are_counted_right() -> None:
    page = (FOLDER / "writing-a-rule.md").read_text(encoding="utf-8")
    (cases,) = (yaml.safe_load(b.body) for b in blocks(FOLDER / "writing-a-rule.md") if b.argument.endswith(".yml"))
    (shown,) = re.findall(r"slow-near-people: (\d+) of \d+ checks", page)
    assert re.findall(r"has (\d+) cases and (\d+) checks", page) == [(str(len(cases)), shown)]
    others = page.partition(" checks. The three others are ")[2].partition(".")[0]
    assert re.findall(r"\*([a-z\s]+)\*", others) == ["all cases together", "reasons", "kinds of\ncase"]
    assert int(shown) - len(cases) == 3


def test_the_query_for_the_worst_first_is_the_order_of_the_reports() -> None:
    (query,) = (block.body for block in blocks(FOLDER / "columns.md") if block.argument == "worst.sql")
    rules = [rule(), rule("ukhc.no-collision", tags=["contact"]), rule("ukhc.spare")]
    drawn = random.Random(5)  # noqa: S311
    found = [
        finding(
            finding_id=f"f{n:03}",
            drive_id=drawn.choice(["d1", "d2"]),
            rule_id=drawn.choice(rules)["rule_id"],
            severity=drawn.choice(["critical", "major", "minor"]),
            profile=drawn.choice([None, "nominal", "relaxed"]),
            object_id=drawn.choice([None, "3"]),
            margin=drawn.choice([None, -1.0, -2.5]),
            occurrence=n,
        )
        | drawn.choice([{"n_copies": None, "n_stays": None}, *({"n_copies": 100, "n_stays": k} for k in (94, 95, 100))])
        for n in range(200)
    ]
    of = result([verdict("fail")], found, drives=[drive(), drive("d2")], rules=rules)
    expected = worst_first(of.findings, {each["rule_id"]: each for each in rules})["finding_id"].to_pylist()
    assert [row["finding_id"] for row in drivelint.CheckResult(of).sql(query)] == expected
