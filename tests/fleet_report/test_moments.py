"""The moments of the worst drives of an audit: drawn from their logs as a check draws them, or not at all, with the reason."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest
from lxml import html

import drivelint
from drivelint import demo
from drivelint.audit import AuditRequest, JudgeSettings, audit
from drivelint.fleet_report import moment_pages
from drivelint.report import html as report
from drivelint.report.progress import Silent
from drivelint.result.load import load_result
from tests.audit.here import InThisProcess
from tests.fleet_report.command import ran

pytestmark = pytest.mark.ci

LOGS = ("collision", "near-miss", "safe")


@pytest.fixture(scope="module")
def audited(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with three drives, and their audit in `audit`."""
    home = tmp_path_factory.mktemp("moments")
    demo.write(home / "demo")
    logs = tuple(str(home / "demo" / f"{name}.mcap") for name in LOGS)
    settings = JudgeSettings(memory=400_000_000)
    request = AuditRequest(sources=logs, map=home / "demo" / "road.xodr", out=str(home / "audit"), settings=settings)
    audit(request, Silent(), InThisProcess())
    assert ran("report", home / "audit", "--quiet").code == 0
    return home


@pytest.fixture
def audit_copy(audited: Path, tmp_path: Path) -> Path:
    """Return a copy of the audit that a test may change; its logs lie where they were judged."""
    shutil.copytree(audited / "audit", tmp_path / "audit")
    return tmp_path / "audit"


def page_of(result: Path, log: str) -> Any:
    (page,) = (file for file in drive_pages(result) if f"{log}.mcap" in file.read_text())
    return html.fromstring(page.read_text())


def drive_pages(result: Path) -> list[Path]:
    return [file for file in (result / "drives").glob("*.html") if not file.name.endswith("-moments.html")]


def test_each_finding_leads_to_its_picture(audited: Path) -> None:
    page = page_of(audited / "audit", "collision")
    links = list(page.xpath("//td[@data-label='when']//a/@href"))
    assert links
    name = links[0].partition("#")[0]
    moments = html.fromstring((audited / "audit" / "drives" / name).read_text())
    for link in links:
        assert link.partition("#")[0] == name
        assert moments.xpath("count(//*[@id=$id])", id=link.partition("#")[2]) == 1
    assert moments.xpath(
        "//*[contains(@class, 'plan')]//*[local-name()='svg'] | //*[local-name()='svg'][contains(@class, 'plan')]"
    )
    assert not moments.xpath("//code[contains(., '--in .')]"), "the page does not lie in the folder of a check"


def test_the_page_is_that_of_a_check_without_commands_for_its_folder(audited: Path, tmp_path: Path) -> None:
    log, road = audited / "demo" / "near-miss.mcap", audited / "demo" / "road.xodr"
    drivelint.check(log, map=road, robustness=False, out=tmp_path / "out")
    checked = report.render(load_result(tmp_path / "out"), in_result_folder=False).decode()
    href = page_of(audited / "audit", "near-miss").xpath("//p[@class='gate-line']/a/@href")[0]
    assert (audited / "audit" / "drives" / href).read_text() == checked


def test_the_number_of_drives_is_an_option_and_old_pages_go(audit_copy: Path) -> None:
    assert len(list(audit_copy.glob("drives/*-moments.html"))) == len(LOGS)
    assert ran("report", audit_copy, "--moments", 1).code == 0
    assert len(list(audit_copy.glob("drives/*-moments.html"))) == 1
    listed = json.loads((audit_copy / "drives" / "pages.json").read_text())["written_by_drivelint"]
    assert sorted(listed) == sorted(f"drives/{file.name}" for file in audit_copy.glob("drives/*.html"))
    assert "report --moments N" in page_of(audit_copy, "safe").text_content()
    assert ran("report", audit_copy, "--moments", 0).code == 0
    assert not list(audit_copy.glob("drives/*-moments.html"))


def test_a_changed_log_has_no_moments(audited: Path, tmp_path: Path) -> None:
    home = tmp_path / "moved"
    shutil.copytree(audited / "demo", home / "demo")
    log = home / "demo" / "near-miss.mcap"
    request = AuditRequest(
        sources=(str(log),),
        map=home / "demo" / "road.xodr",
        out=str(home / "audit"),
        settings=JudgeSettings(memory=400_000_000),
    )
    audit(request, Silent(), InThisProcess())
    assert ran("report", home / "audit").code == 0
    assert len(list((home / "audit").glob("drives/*-moments.html"))) == 1
    shutil.copy(home / "demo" / "safe.mcap", log)
    assert ran("report", home / "audit").code == 0
    assert not list((home / "audit").glob("drives/*-moments.html")), "nor those of the former log"
    (page,) = drive_pages(home / "audit")
    assert "could not be drawn: the log has changed since the audit" in " ".join(page.read_text().split())
    log.unlink()
    assert ran("report", home / "audit").code == 0
    assert "could not be drawn: the log is not at" in page.read_text()


def test_other_findings_are_no_moments_of_these(audit_copy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As of another version of the program: positions of one judgement do not illustrate the verdicts of another."""
    judged_again = moment_pages._check_again

    def with_fewer(drive: Any, audit: Any) -> Any:
        from dataclasses import replace

        result = judged_again(drive, audit)
        return replace(result, findings=result.findings.slice(1))

    monkeypatch.setattr(moment_pages, "_check_again", with_fewer)
    assert ran("report", audit_copy).code == 0
    assert not list(audit_copy.glob("drives/*-moments.html"))
    assert "this version of drivelint gives other findings" in page_of(audit_copy, "collision").text_content()


def test_long_drives_are_left_out_unless_they_are_asked_for(audit_copy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(moment_pages, "DEFAULT_MAX_STATES_OF_DRIVE_WITH_MOMENTS", 100)
    assert ran("report", audit_copy).code == 0
    assert not list(audit_copy.glob("drives/*-moments.html"))
    assert ran("report", audit_copy, "--moments", 2).code == 0
    assert len(list(audit_copy.glob("drives/*-moments.html"))) == 2


def test_moments_are_of_pages(audit_copy: Path) -> None:
    assert ran("report", audit_copy, "--to", "markdown", "--moments", 2).code == 2
    assert ran("report", audit_copy, "--to", "junit", "--moments", 2).code == 2
