"""Another value of a parameter from stored verdicts: equal to a new check, or it says that a new check is needed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import duckdb
import pyarrow.parquet as pq
import pytest

from drivelint import catalogue
from drivelint.errors import UsageError
from drivelint.fleet.what_if import FlipCount, WhatIf, reason_for_new_check, what_if
from tests.evaluate.packs import invariant
from tests.fleet import audits
from tests.fleet.conftest import RunCheck
from tests.report.synthetic import drive, rule, verdict

CATALOGUE = catalogue.load_rules(())
ZONE, CHANGE = "ukhc.overtake-zone", "alks-r157.r79.lane-change-done"
LIMIT = '[params.limit]\ndefault = {}\nunit = "{}"\nwhy = "ours"'
# the second rule is not judged near the overtaken vehicle, so some verdicts are unknown and some that fail are judged in part
OWN_RULES = {
    "slow": invariant(
        "SELECT drive_id, ego_id, t_ns, speed_mps AS observed, $limit AS required FROM ego_state",
        status="stable",
        tables=LIMIT.format(12.0, "m/s"),
    ),
    "apart": invariant(
        """SELECT p.drive_id, p.ego_id, p.t_ns, p.object_id, $limit AS required,
    CASE WHEN p.object_id <> '2' OR abs(p.x_m - e.x_m) > 5 THEN sqrt((p.x_m - e.x_m) ** 2 + (p.y_m - e.y_m) ** 2) END AS observed
FROM pair p JOIN ego_state e USING (drive_id, ego_id, t_ns)""",
        sense=">",
        unit="m",
        reads='"ego_state", "pair"',
        status="stable",
        tables=LIMIT.format(4.0, "m"),
    ),
}


def row_key(row: dict[str, Any]) -> tuple[Any, ...]:
    return tuple(row[name] for name in ("drive_id", "ego_id", "profile", "object_id", "occurrence"))


@pytest.fixture(scope="module")
def own_rules(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("rules")
    (folder / "own").mkdir()
    for name, text in OWN_RULES.items():
        (folder / "own" / f"{name}.sql").write_text(text, encoding="utf-8")
    return folder


@pytest.mark.ci
@pytest.mark.parametrize(
    "values",
    [
        (0.1, 5.0, 2.0),
        *(pytest.param(values, marks=pytest.mark.slow) for values in ((-2.0, 14.0, 9.0), (0.24, 30.0, 60.0))),
    ],
)
def test_it_is_what_a_new_check_says(run_check: RunCheck, own_rules: Path, values: tuple[float, ...]) -> None:
    asked = dict(zip((ZONE, "own.slow", "own.apart"), values, strict=True))
    options = ["--rules-dir", str(own_rules), *(part for name in asked for part in ("--rules", name))]
    param = {name: "margin_s" if name == ZONE else "limit" for name in asked}
    changed = [part for name, value in asked.items() for part in ("--param", f"{name}.{param[name]}={value}")]
    again = pq.read_table(run_check(*options, *changed) / "verdicts.parquet").to_pylist()
    rules = catalogue.load_rules((own_rules,))
    n_flips = 0
    with duckdb.connect() as con:
        audits.add_results(con, run_check(*options), tags=lambda _: {"release": "1"})
        for name, value in asked.items():
            found = what_if(con, rules[name], param[name], value, "release")
            rows = con.execute("SELECT key, ego_id, profile, object_id, occurrence, becomes FROM what_if").fetchall()
            told = {tuple(key): becomes for *key, becomes in rows}
            now = {row_key(row): row["verdict"] for row in again if row["rule_id"] == name}
            assert found.needs_check is None
            assert told == {key: told.get(key) and word for key, word in now.items()}
            assert found.not_known == sum(becomes is None for becomes in told.values())
            assert {each.tag_value for each in found.verdicts} == {"1"}
            n_flips += sum(each.n for each in found.flips)
    assert n_flips


def test_only_a_plain_comparison_needs_no_new_check() -> None:
    able = {
        f"{name}.{param}"
        for name, each in CATALOGUE.items()
        for param in each.params
        if reason_for_new_check(each, param) is None
    }
    assert {f"{ZONE}.margin_s", f"{CHANGE}.most_s", "ukhc.r180.corner-cut.tolerance_m"} <= able
    for name, param in (
        ("criticality.thw", "least_s"),
        ("criticality.pet", "least_s"),
        ("comfort.lateral", "most_mps2"),
    ):
        assert f"{name}.{param}" not in able, "it has a part in what is observed, or in where the rule applies"
    with pytest.raises(UsageError, match="margin_s"):
        reason_for_new_check(CATALOGUE[ZONE], "margin")
    with duckdb.connect() as con:
        assert "when the rule applies" in str(what_if(con, CATALOGUE["criticality.thw"], "least_s", 1.0).needs_check)


def what_if_result(value: float, *words: dict[str, Any], rule_id: str = CHANGE) -> WhatIf:
    """The rule asks for less than 5 s."""
    version = CATALOGUE[rule_id].version
    rows = [{"rule_id": rule_id, "rule_version": version, "profile": None, "drive_id": "d1"} | row for row in words]
    with duckdb.connect() as con:
        way = {"ego_id": "1", "km": 1.0, "hours": 1.0, "engaged_km": 1.0, "engaged_hours": 1.0, "n_steps": 9}
        audits.add_rows(con, [drive(exposure=[way])], [verdict(**row) for row in rows], [], [rule(rule_id)])
        return what_if(con, CATALOGUE[rule_id], "most_s" if rule_id == CHANGE else "margin_s", value)


@pytest.mark.sample(6, ci=6)
@pytest.mark.parametrize(
    ("row", "value", "becomes"),
    [
        ({"word": "fail", "observed": 6.0}, 6.0, "fail"),
        ({"word": "fail", "observed": 6.0}, 6.1, "pass"),
        ({"word": "fail", "observed": 6.0, "n_expected": 9, "n_judged": 8}, 7.0, "unknown"),
        ({"word": "pass", "observed": 4.0}, 4.0, "fail"),
        ({"word": "pass", "observed": 4.0, "n_expected": 9, "n_judged": 9}, 4.1, "pass"),
        ({"word": "pass", "observed": None}, 0.1, "pass"),
        ({"word": "fail", "observed": None}, 99.0, "fail"),
        ({"word": "unknown", "observed": 4.0, "n_expected": 9, "n_judged": 8}, 3.0, "fail"),
        ({"word": "unknown", "observed": 4.0, "n_expected": 9, "n_judged": 8}, 4.5, "unknown"),
        ({"word": "unknown", "observed": 4.0, "n_expected": 9, "n_judged": 0}, 3.0, "unknown"),
        ({"word": "not_applicable", "observed": None}, 3.0, "not_applicable"),
        ({"word": "fail", "observed": 6.0, "rule_version": "older"}, 7.0, None),
    ],
)  # fmt: skip
def test_what_becomes_of_a_verdict(row: dict[str, Any], value: float, becomes: str | None) -> None:
    assert what_if_result(value, row).verdicts == (FlipCount(None, None, row["word"], becomes, 1),)


@pytest.mark.parametrize(
    ("word", "value", "becomes"),
    [("pass", 1.5, "pass"), ("pass", 2.5, None), ("fail", 1.5, "pass"), ("fail", 2.5, "fail"), ("unknown", 1.5, None)],
)
def test_a_lower_bound_proves_one_verdict_only(word: str, value: float, becomes: str | None) -> None:
    """The time that an overtake has to spare may be a lower bound: it is enough for a pass."""
    row = {"word": word, "observed": 2.0, "n_judged": 0 if word == "unknown" else 1}
    assert what_if_result(value, row, rule_id=ZONE).verdicts == (FlipCount(None, None, word, becomes, 1),)
