"""`audit --baseline`, `--waivers`, `--min-judged`, and JUnit and SARIF of an audit: the gate of `check`."""

from __future__ import annotations

import json
import shutil
from typing import TYPE_CHECKING

import pytest
from lxml import etree

import drivelint
from drivelint.errors import UsageError
from drivelint.fleet_report import gated
from drivelint.fleet_report.audit_views import open_audits
from tests.fleet_report.command import Ran, ran

if TYPE_CHECKING:
    from pathlib import Path

    from tests.fleet_report.conftest import Audited

pytestmark = pytest.mark.ci

WAIVER = '[[waiver]]\nrule = "ukhc.no-collision"\nreason = "a prop"\nowner = "jo@example.org"\nexpires = {}\n'


def audit(audited: Audited, out: Path, *more: object) -> Ran:
    return ran(*audited.new_fleet.command(out), *more)


@pytest.fixture
def again(audited: Audited, tmp_path: Path) -> Path:
    """Return a copy of the audit of the newer fleet, in which nothing needs to be judged."""
    shutil.copytree(audited.new, tmp_path / "again")
    return tmp_path / "again"


def failures(out: Path) -> tuple[int, int]:
    assert ran("report", out, "--to", "junit").code == 0
    root = etree.parse(out / "junit.xml").getroot()
    return int(root.get("failures", "")), int(root.get("errors", ""))


def test_what_the_baseline_has_does_not_gate(audited: Audited, again: Path) -> None:
    assert audit(audited, again).code == 1
    n_failed, n_errors = failures(again)
    assert (n_failed, n_errors) == (len(audited.new_fleet.planted), 0)
    found = audit(audited, again, "--baseline", audited.new)
    assert found.code == 0, found
    assert f"no new finding; {n_failed} known ({n_failed} critical)" in found.out
    assert failures(again) == (0, 0)
    assert ran("report", again, "--to", "sarif").code == 0
    results = json.loads((again / "report.sarif").read_text(encoding="utf-8"))["runs"][0]["results"]
    assert [(each["baselineState"], each["properties"]["gates"]) for each in results] == [
        ("unchanged", False)
    ] * n_failed
    assert {
        each["locations"][0]["physicalLocation"]["artifactLocation"]["uri"].rpartition("/")[2] for each in results
    } == (audited.new_fleet.planted)


def test_what_the_baseline_has_not_does(audited: Audited, again: Path) -> None:
    found = audit(audited, again, "--baseline", audited.base)
    new = audited.new_fleet.planted - audited.base_fleet.planted
    assert new
    assert found.code == 1
    assert f"{len(new)} new findings at or above severity critical" in found.out


def test_a_waiver_lets_through_until_its_day(audited: Audited, again: Path, tmp_path: Path) -> None:
    (tmp_path / "w.toml").write_text(WAIVER.format("2030-01-01"), encoding="utf-8")
    options = ("--waivers", tmp_path / "w.toml", "--today")
    assert audit(audited, again, *options, "2030-01-01").code == 0
    late = audit(audited, again, *options, "2030-01-02")
    assert late.code == 1
    assert "expired 2030-01-01 (jo@example.org)" in late.out


@pytest.mark.ci
def test_the_next_run_without_a_gate_has_none(audited: Audited, again: Path) -> None:
    audit(audited, again, "--baseline", audited.new)
    assert (again / "gate.json").is_file()
    assert audit(audited, again).code == 1
    assert not (again / "gate.json").exists()


def test_a_changed_gate_is_refused(audited: Audited, again: Path) -> None:
    audit(audited, again, "--baseline", audited.new)
    (again / "gate.json").write_text("{}", encoding="utf-8")
    with (
        pytest.raises(UsageError, match=r"gate\.json: was changed since drivelint audit wrote it"),
        open_audits(str(again)),
    ):
        pass


def test_so_much_must_be_decided(audited: Audited, again: Path) -> None:
    found = audit(audited, again, "--fail-on", "never", "--min-judged", "1")
    assert found.code == 0
    result = gated.audit_result(str(again))
    assert (result.fail_on, result.min_judged) == ("never", 1.0)


@pytest.mark.parametrize(
    ("options", "why"),
    [
        (("--baseline", "{out}"), "is also --out"),
        (("--baseline", "{out}", "--claim"), "need a complete audit"),
        (("--min-judged", "0.5", "--shard", "1/2"), "need a complete audit"),
    ],
)
def test_a_mistake_is_told_before_anything_is_judged(
    options: tuple[str, ...], why: str, audited: Audited, again: Path
) -> None:
    found = audit(audited, again, *(word.format(out=again) for word in options))
    assert found.code == 2
    assert why in found.err


def test_pages_have_options_that_junit_has_not(again: Path) -> None:
    found = ran("report", again, "--to", "junit", "--by", "site")
    assert found.code == 2
    assert "contains only the gate of the last drivelint audit" in found.err


def test_python_has_the_tables_the_gate_and_the_rates_of_an_audit(audited: Audited, again: Path) -> None:
    found = drivelint.AuditResult(again)
    n = len(audited.new_fleet.planted)
    assert (found.exit_code, len(found.findings), len(found.events)) == (1, n, n)
    tags = found.sql("SELECT tags['site'] AS site, count(*) AS n FROM findings JOIN logs USING (drive_id) GROUP BY ALL")
    assert sum(row["n"] for row in tags) == n
    assert {row["site"] for row in tags} <= {"leeds", "york", "hull"}
    rates = {row["tag_value"]: row for row in found.rates("release")}
    assert set(rates) == {"v0", "v1"}
    assert sum(row["findings"] for row in rates.values()) == n
    each = rates["v0"]
    assert each["per_100km"]["low"] < each["per_100km"]["rate"] == pytest.approx(100 * each["findings"] / each["km"])
    assert found.report(to="junit").count("<failure") == n
    with pytest.raises(drivelint.DriveLintError, match="junit, sarif"):
        found.report(to="html")
    with pytest.raises(drivelint.DriveLintError, match="no audit is here"):
        drivelint.AuditResult(again / "tables")
