"""`drivelint what-if`: equal to another audit with the parameter, or it says that one is needed."""

from __future__ import annotations

import json
import shutil
from collections import Counter
from pathlib import Path

import pytest

from drivelint.audit import AuditRequest, JudgeSettings, audit
from drivelint.audit.ask import run_query
from drivelint.report.progress import Silent
from tests.audit import fleet
from tests.audit.here import InThisProcess
from tests.evaluate.packs import invariant
from tests.fleet_report import lake
from tests.fleet_report.command import ran

pytestmark = pytest.mark.ci

SLOW_RULE = invariant(
    "SELECT drive_id, ego_id, t_ns, $factor * speed_mps AS observed, $limit AS required FROM ego_state",
    status="stable",
    tables="""[params.limit]
default = 30.0
unit = "m/s"
why = "ours"

[params.factor]
default = 1.0
unit = "1"
why = "ours"
""",
)


class OwnRuleFleet:
    """A fleet that is audited by a rule of its own."""

    def __init__(self, home: Path) -> None:
        self.rules = home / "rules"
        (self.rules / "own").mkdir(parents=True)
        (self.rules / "own" / "slow.sql").write_text(SLOW_RULE, encoding="utf-8")
        self.fleet = fleet.write(home / "fleet", 12)

    def audit(self, out: Path, *params: str) -> Path:
        settings = JudgeSettings(rules=("own.slow",), rules_dirs=(self.rules,), params=params, memory=200_000_000)
        request = AuditRequest(
            sources=(str(self.fleet.manifest),), map=self.fleet.road, out=str(out), settings=settings
        )
        audit(request, Silent(), InThisProcess())
        return out


@pytest.fixture(scope="module")
def own_rule_fleet(tmp_path_factory: pytest.TempPathFactory) -> OwnRuleFleet:
    return OwnRuleFleet(tmp_path_factory.mktemp("own"))


@pytest.fixture(scope="module")
def audit_folder(own_rule_fleet: OwnRuleFleet, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return own_rule_fleet.audit(tmp_path_factory.mktemp("judged") / "audit")


def by_release(out: Path) -> Counter[tuple[str, str]]:
    query = "SELECT tags['release'] AS r, verdict, count(*) AS n FROM verdicts JOIN drives USING (key) GROUP BY ALL"
    return Counter({(row["r"], row["verdict"]): row["n"] for row in json.loads(run_query(str(out), query, "json"))})


@pytest.mark.slow
@pytest.mark.parametrize("limit", ["11", "11.99", "12.05", "20"])
def test_it_is_what_another_audit_says(
    own_rule_fleet: OwnRuleFleet, audit_folder: Path, tmp_path: Path, limit: str
) -> None:
    done = ran("what-if", audit_folder, f"own.slow.limit={limit}", "--by", "release", "--format", "json")
    told = json.loads(done.out)
    assert (done.code, told["needs_audit"], told["not_known"], told["was"]) == (0, None, 0, "30.0")
    becomes: Counter[tuple[str, str]] = Counter()
    for each in told["verdicts"]:
        becomes[each["tag_value"], each["becomes"]] += each["n"]
    assert becomes == by_release(own_rule_fleet.audit(tmp_path / "again", f"own.slow.limit={limit}"))
    assert sum(becomes.values()) == 12


@pytest.mark.slow
def test_the_text_counts_flips_by_release(audit_folder: Path) -> None:
    done = ran("what-if", audit_folder, "own.slow.limit=11", "--by", "release")
    assert done.code == 0
    assert "12 of 12 verdicts change: 12 pass -> fail" in done.out
    told, _, which = done.out.partition("verdicts that change:\n")
    assert [line for line in told.splitlines() if line.startswith("  ")] == [
        "  v0  6 pass -> fail",
        "  v1  6 pass -> fail",
    ]
    lines = [line for line in which.splitlines() if line.startswith("  ")]
    assert len(lines) == 12
    assert all(line.endswith(".parquet: ego 0: pass -> fail") for line in lines)
    flipped = json.loads(ran("what-if", audit_folder, "own.slow.limit=11", "--format", "json").out)["flipped"]
    assert [f"  {each['log']}: ego {each['ego_id']}: {each['was']} -> {each['becomes']}" for each in flipped] == lines


@pytest.mark.slow
def test_a_copy_with_another_tag_counts_for_both_values_and_once_in_all(
    own_rule_fleet: OwnRuleFleet, tmp_path: Path
) -> None:
    manifest, logs = own_rule_fleet.fleet.manifest, own_rule_fleet.fleet.manifest.parent / "logs"
    shutil.copy(logs / "drive-00000.parquet", logs / "copy.parquet")
    listed = manifest.read_text(encoding="utf-8")
    try:
        manifest.write_text(f'{listed}"logs/copy.parquet","v1","copied"\n', encoding="utf-8")
        out = own_rule_fleet.audit(tmp_path / "audit")
    finally:
        manifest.write_text(listed, encoding="utf-8")
    done = ran("what-if", out, "own.slow.limit=11", "--by", "release")
    assert "12 of 12 verdicts change: 12 pass -> fail" in done.out
    told, _, which = done.out.partition("verdicts that change:\n")
    lines = [line for line in told.splitlines() if line.startswith("  ")]
    assert lines == ["  v0  6 pass -> fail", "  v1  7 pass -> fail"]
    assert len([line for line in which.splitlines() if line.startswith("  ")]) == 12
    assert ran("what-if", out, "own.slow.limit=11").out.partition("\n")[2].startswith("12 of 12 verdicts")


def test_a_parameter_in_what_is_observed_needs_another_audit(audit_folder: Path) -> None:
    done = ran("what-if", audit_folder, "own.slow.factor=2")
    assert done.code == 4
    assert "needs a new audit: factor is not only the required value" in done.out
    assert "drivelint audit SOURCE --param own.slow.factor=2 --out OTHER" in done.out


def test_a_rule_that_is_not_as_it_was_needs_another_audit(own_rule_fleet: OwnRuleFleet, audit_folder: Path) -> None:
    file = own_rule_fleet.rules / "own" / "slow.sql"
    before = file.read_text(encoding="utf-8")
    assert "$factor * speed_mps" in before
    file.write_text(before.replace("$factor * speed_mps", "2 * $factor * speed_mps"), encoding="utf-8")
    try:
        done = ran("what-if", audit_folder, "own.slow.limit=11")
    finally:
        file.write_text(before, encoding="utf-8")
    assert done.code == 4
    assert "the rule has changed since the audit" in done.out


def test_where_only_a_bound_is_stored_it_says_so(filled: lake.Lake) -> None:
    done = ran("what-if", filled.folder, "ukhc.overtake-zone.margin_s=1.2", "--by", "site")
    assert done.code == 4
    assert "only a bound of the observed value" in done.out
    assert "unknown -> needs a new audit" in done.out


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("own.slow.limit", "write RULE.PARAM=VALUE"),
        ("own.slow.lim=1", "has no parameter"),
        ("ukhc.overtake-zone.margin_s=1", "no verdicts of rule"),
    ],
)
def test_mistakes_are_told(audit_folder: Path, setting: str, message: str) -> None:
    done = ran("what-if", audit_folder, setting)
    assert done.code == 2
    assert message in done.err
