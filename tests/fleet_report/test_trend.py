"""`drivelint trend`: a planted change of a rate is called, logs count once, and what is missing is said."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

from drivelint.audit import AuditRequest, JudgeSettings, audit
from drivelint.report.progress import Silent
from tests.audit import fleet
from tests.audit.here import Stopped
from tests.fleet_report import lake
from tests.fleet_report.command import ran

if TYPE_CHECKING:
    from pathlib import Path


pytestmark = pytest.mark.ci

SIZES = {"may": 120, "june": 60, "july": 30}
PLANTED = "ukhc.contact-signature"
"""The first rule: one drive of each audit has 40 findings of it more than the others, so a smaller audit has a higher rate."""


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    home = tmp_path_factory.mktemp("months")
    for seed, (name, n_drives) in enumerate(SIZES.items()):
        lake.write(home / name, n_drives, seed)
    return home


def test_a_rate_that_rises_is_called(home: Path) -> None:
    months = [home / name for name in SIZES]
    printed = ran("trend", *months)
    assert printed.code == 0
    assert f"{PLANTED} rises by more than chance explains" in printed.out
    falls = ran("trend", *reversed(months))
    assert f"{PLANTED} falls by more than chance explains" in falls.out
    content = json.loads(ran("trend", *months, "--format", "json").out)
    (planted,) = (each for each in content["rules"] if each["rule_id"] == PLANTED)
    assert (planted["called"], planted["direction"]) == (True, "rises")
    assert [rate["per_100km"]["rate"] for rate in planted["rates"]] == sorted(
        rate["per_100km"]["rate"] for rate in planted["rates"]
    )
    assert [each["n_drives"] for each in content["audits"]] == list(SIZES.values())
    others = [each for each in content["rules"] if each["rule_id"] != PLANTED]
    assert others
    assert not any(each["called"] for each in others)


def test_the_rates_are_those_of_each_audit_alone(home: Path) -> None:
    content = json.loads(ran("trend", home / "may", home / "june", "--format", "json").out)
    query = f"SELECT count(*) AS n FROM counted_events WHERE rule_id = '{PLANTED}'"
    for n, name in enumerate(("may", "june")):
        (row,) = json.loads(ran("sql", home / name, query, "--format", "json").out)
        (planted,) = (each for each in content["rules"] if each["rule_id"] == PLANTED)
        assert planted["rates"][n]["findings"] + planted["rates"][n]["findings_of_unknown"] == row["n"]


def test_a_log_that_an_earlier_audit_has_counts_there_only(home: Path) -> None:
    printed = ran("trend", home / "may", home / "may", home / "june", "--format", "json")
    content = json.loads(printed.out)
    assert [each["n_drives"] for each in content["audits"]] == [SIZES["may"], 0, SIZES["june"]]
    assert [each["n_left_out"] for each in content["audits"]] == [0, SIZES["may"], 0]
    twice = ran("trend", home / "may", home / "may")
    assert twice.code == 4
    assert "there is nothing to compare" in twice.out
    assert "120 drives are left out, because an earlier audit has the same logs" in twice.out


def test_markdown_is_a_table_per_kind(home: Path) -> None:
    out = ran("trend", home / "may", home / "june", "--format", "markdown").out
    tables = [block for block in out.split("\n\n") if block.startswith("|")]
    assert [block.splitlines()[0].split(" | ")[0] for block in tables] == ["| audit", "| rule"]
    for block in tables:
        assert len({line.count("|") for line in block.splitlines()}) == 1


def test_an_audit_that_has_not_ended_is_no_trend_yet(home: Path, tmp_path: Path) -> None:
    drives = fleet.write(tmp_path / "fleet", 20)
    settings = JudgeSettings(rules=("ukhc.no-collision",), memory=200_000_000)
    out = tmp_path / "june"
    request = AuditRequest(sources=(str(drives.manifest),), map=drives.road, out=str(out), settings=settings)
    with pytest.raises(KeyboardInterrupt):
        audit(request, Silent(), Stopped())
    printed = ran("trend", home / "may", out)
    assert printed.code == 4
    assert "the audit has not ended" in printed.err


def test_one_audit_is_no_trend(home: Path, tmp_path: Path) -> None:
    assert ran("trend", home / "may").code == 2
    nothing = ran("trend", home / "may", tmp_path)
    assert (nothing.code, "no audit is here" in nothing.err) == (2, True)
