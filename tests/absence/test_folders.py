"""What a search of a folder cannot look into is named as not judged, exit code 4: by `check`, `audit` and `inspect`."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

import drivelint
from drivelint.audit.model import JudgeSettings
from drivelint.audit.run import AuditRequest, audit
from drivelint.inspect import InspectRequest, exit_code, inspect
from drivelint.report.progress import Silent
from tests.audit.here import InThisProcess
from tests.faults import drives

if TYPE_CHECKING:
    from collections.abc import Callable

RULE = "ukhc.no-collision"


def dead_link(logs: Path, elsewhere: Path) -> str:
    (logs / "gone.mcap").symlink_to(elsewhere / "not-fetched.mcap")
    return "gone.mcap: a dead link to "


def dead_link_to_a_folder(logs: Path, elsewhere: Path) -> str:
    (logs / "recordings").symlink_to(elsewhere / "not-mounted")
    return "recordings: a dead link to "


def linked_folder(logs: Path, elsewhere: Path) -> str:
    (logs / "linked").symlink_to(elsewhere)
    return "linked: a link to the folder "


def pointer(logs: Path, elsewhere: Path) -> str:
    (logs / "gone.mcap.dvc").write_text("outs:\n- path: gone.mcap\n", encoding="utf-8")
    return "gone.mcap.dvc: a pointer of DVC"


ATTACKS: dict[str, Callable[[Path, Path], str]] = {
    "dead link": dead_link,
    "dead link to a folder": dead_link_to_a_folder,
    "linked folder": linked_folder,
    "pointer": pointer,
}


@pytest.fixture
def logs(tmp_path: Path) -> Path:
    """Return a folder with one sound log."""
    folder = tmp_path / "logs"
    folder.mkdir()
    drives.osi_mcap(folder / "sound", drives.drive())
    return folder


@pytest.fixture
def elsewhere(tmp_path: Path) -> Path:
    """Return a folder beside it with a log that nobody judges."""
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    drives.osi_mcap(folder / "other", drives.drive(20))
    return folder


def check_outcome(folder: Path) -> tuple[int, dict[str, Any], str]:
    """Return exit code, status by file name, and the reasons of what was not judged."""
    result = drivelint.check([folder], rules=RULE, annotate=False, robustness=False)
    rows = result.drives.arrow().to_pylist()
    reasons = "\n".join(row["status_reason"] for row in rows if row["status_reason"] is not None)
    return result.exit_code, {row["file_name"]: row["status"] for row in rows}, reasons


@pytest.mark.parametrize("attack", ATTACKS)
def test_a_check_names_it(logs: Path, elsewhere: Path, attack: str) -> None:
    assert check_outcome(logs)[0] == 0
    told = ATTACKS[attack](logs, elsewhere)
    code, status, reasons = check_outcome(logs)
    assert code == 4
    assert status == {"sound.mcap": "judged", told.partition(":")[0]: "not_judged"}
    assert told in reasons


@pytest.mark.parametrize("attack", ATTACKS)
def test_an_audit_names_it(logs: Path, elsewhere: Path, attack: str, tmp_path: Path) -> None:
    told = ATTACKS[attack](logs, elsewhere)
    request = AuditRequest(sources=(str(logs),), out=str(tmp_path / "audit"), settings=JudgeSettings(rules=(RULE,)))
    counted = audit(request, Silent(), InThisProcess())
    assert (counted.n_judged, counted.n_refused, counted.exit_code("critical", strict=False)) == (1, 1, 4)
    assert told in counted.not_judged[0]["reason"]


@pytest.mark.parametrize("attack", ATTACKS)
def test_inspect_names_it(logs: Path, elsewhere: Path, attack: str) -> None:
    told = ATTACKS[attack](logs, elsewhere)
    with pytest.raises(drivelint.DriveLintError, match=r"2 logs \(.*\): inspect looks at one at a time") as error:
        inspect(InspectRequest(str(logs)))
    assert told.partition(":")[0] in str(error.value)
    (logs / "sound.mcap").unlink()
    found = inspect(InspectRequest(str(logs)))
    assert told in (found.problem or "")
    assert exit_code(found) == 4


def test_an_unreadable_folder(logs: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Permissions do not bind root, who may run these tests: the system refuses this folder to everybody."""
    (logs / "sub" / "barred").mkdir(parents=True)
    drives.osi_mcap(logs / "sub" / "barred" / "other", drives.drive(20))
    scandir = os.scandir

    def look(path: Any) -> Any:
        if isinstance(path, Path) and path.name == "barred":
            raise PermissionError(13, "Permission denied", str(path))
        return scandir(path)

    monkeypatch.setattr(os, "scandir", look)
    code, status, reasons = check_outcome(logs)
    assert (code, status) == (4, {"sound.mcap": "judged", "barred": "not_judged"})
    assert "barred: a folder that cannot be searched (Permission denied)" in reasons
    found = inspect(InspectRequest(str(logs / "sub")))
    assert "barred: a folder that cannot be searched (Permission denied)" in (found.problem or "")
    assert exit_code(found) == 4


@pytest.mark.skipif(os.geteuid() == 0, reason="permissions do not bind root")
def test_a_folder_without_permission(logs: Path) -> None:
    barred = logs / "barred"
    barred.mkdir()
    barred.chmod(0)
    try:
        code, status, _ = check_outcome(logs)
    finally:
        barred.chmod(0o700)
    assert (code, status) == (4, {"sound.mcap": "judged", "barred": "not_judged"})


@pytest.mark.ci
def test_links_that_hide_nothing_are_no_matter(logs: Path, tmp_path: Path) -> None:
    """To what is searched anyway, to a log, and to what can hold none."""
    (logs / "sub").mkdir()
    (logs / "latest").symlink_to(logs / "sub")
    (logs / "sub" / "round").symlink_to(logs)
    (logs / "again.mcap").symlink_to(logs / "sound.mcap")
    (logs / "picture.png").symlink_to(tmp_path / "nowhere.png")
    assert check_outcome(logs)[0] == 0
