"""The nasty drive, checked and audited once, with every command's words kept."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import pytest

from drivelint.audit import AuditRequest, JudgeSettings, audit
from drivelint.report.progress import Silent
from tests.audit.here import InThisProcess
from tests.fleet_report.command import Ran, ran
from tests.hostile import drive
from tests.hostile.words import EVIL

if TYPE_CHECKING:
    from pathlib import Path

RULES = ("evil", "ukhc.no-collision", "ukhc.r162.safe-distance-ahead")


class Nasty(NamedTuple):
    """Where everything is, and what `check` said."""

    files: drive.Files
    result: Path
    audit: Path
    check_run: Ran


@pytest.fixture(scope="session")
def nasty(tmp_path_factory: pytest.TempPathFactory) -> Nasty:
    home = tmp_path_factory.mktemp("nasty")
    files = drive.write(home)
    chosen = [word for rule in RULES for word in ("--rules", rule)]
    said = ran("check", files.log, *files.options, *chosen, "--no-robustness", "--out", home / "result")
    assert said.code == 1, said.err
    settings = JudgeSettings(rules=RULES, rules_dirs=(files.rules,), memory=200_000_000)
    manifest = home / "fleet.csv"
    tag = EVIL.replace("\0", "").replace('"', '""')
    manifest.write_bytes(f'log,"{tag}"\n"{files.log.name.replace(chr(34), chr(34) * 2)}","={tag}"\n'.encode())
    request = AuditRequest(
        sources=(str(manifest),), map=files.road, mapping=str(files.mapping), out=str(home / "audit"), settings=settings
    )
    audit(request, Silent(), InThisProcess())
    return Nasty(files, home / "result", home / "audit", said)
