"""`summary.json` and the counts in it."""

from __future__ import annotations

import json
import math

from drivelint.report import summary
from tests.report.synthetic import drive, finding, result, rule, verdict

RUN = result(
    [
        verdict("pass", near_miss=True),
        verdict("fail", profile="relaxed"),
        verdict("unknown", profile="observed"),
        verdict("not_applicable", drive_id="d2"),
        verdict("error", drive_id="d2", rule_id="ukhc.other", severity="minor"),
    ],
    [finding(), finding(rule_id="ukhc.other", severity="minor")],
    drives=[drive(), drive("d2", km=math.inf), drive("d3", status="not_judged", status_reason="no ego")],
    rules=[rule(), rule("ukhc.other", severity="minor"), rule("ukhc.silent")],
)


def test_all_counts_stand_beside_each_other() -> None:
    told = json.loads(summary.render(RUN))
    assert told["verdicts"] == {"pass": 1, "fail": 1, "unknown": 1, "not_applicable": 1, "error": 1}
    assert told["findings"] == {"critical": 1, "major": 0, "minor": 1}
    assert told["near_misses"] == 1
    for part in ("rules", "drives"):
        for verdict_name, n in told["verdicts"].items():
            assert sum(row["verdicts"][verdict_name] for row in told[part]) == n
        assert sum(row["findings"] for row in told[part]) == 2
    assert [row["rule_id"] for row in told["rules"]] == ["ukhc.r162.safe-distance-ahead", "ukhc.other", "ukhc.silent"]
    assert told["rules"][2]["verdicts"] == dict.fromkeys(told["verdicts"], 0)


def test_packs_are_counted_apart() -> None:
    rules = [rule(), rule("rss.along", pack="rss"), rule("rss.silent", pack="rss")]
    run = result([verdict("fail"), verdict("pass", rule_id="rss.along")], [finding()], rules=rules)
    none = dict.fromkeys(("pass", "fail", "unknown", "not_applicable", "error"), 0)
    assert json.loads(summary.render(run))["packs"] == [
        {"pack": "ukhc", "verdicts": none | {"fail": 1}}, {"pack": "rss", "verdicts": none | {"pass": 1}},
    ]  # fmt: skip


def test_it_names_inputs_versions_and_the_exit() -> None:
    told = json.loads(summary.render(RUN))
    assert told["output_schema"] >= 1
    assert told["tool"].keys() == {"name", "version", "duckdb"}
    assert told["exit"] == {"code": 2, "name": "usage", "why": "1 verdict in error: could not be run: ukhc.other"}
    assert [row["file_name"] for row in told["drives"]] == ["d1.csv", "d2.csv", "d3.csv"]
    assert told["drives"][0]["sha256"] == "ab" * 32
    assert told["drives"][2]["status_reason"] == "no ego"


def test_infinity_is_not_json() -> None:
    assert json.loads(summary.render(RUN))["drives"][1]["km"] is None


def test_the_same_run_gives_the_same_bytes() -> None:
    assert summary.render(RUN) == summary.render(RUN)
