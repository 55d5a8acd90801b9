"""An audit that did not end: `sql`, `report` and `diff` read what is there, and say how much of it that is."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from drivelint.audit import merge
from drivelint.audit.ask import run_query
from drivelint.audit.compact import create_views, open_database, tables_digest
from drivelint.audit.store import LocalFolder
from drivelint.audit.text import summary_text
from drivelint.audit.unpacked import create_views_of_all_results, n_results
from drivelint.errors import ExitCode
from drivelint.fleet_report import page
from drivelint.fleet_report.audit_views import open_audits, open_two_audits
from drivelint.fleet_report.difference import difference
from drivelint.report.progress import Silent
from tests.audit import fleet
from tests.audit.here import Stopped, run_audit

pytestmark = pytest.mark.ci

N_DRIVES = 20


@pytest.fixture(scope="module")
def interrupted(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, int]:
    """Return the place of an audit that was interrupted, and of how many drives it has results."""
    home = tmp_path_factory.mktemp("interrupted")
    drives = fleet.write(home / "fleet", N_DRIVES)
    with pytest.raises(KeyboardInterrupt):
        run_audit(drives, home / "out", Stopped())
    n = sum(1 for _ in (home / "out").glob("receipts/*/*.json"))
    assert 0 < n < N_DRIVES
    return home / "out", n


def test_sql_answers_and_says_how_much_is_there(interrupted: tuple[Path, int]) -> None:
    out, n = interrupted
    told: list[str] = []
    for table in ("drives", "receipts"):
        (row,) = json.loads(run_query(str(out), f"SELECT count(*) AS n FROM {table}", "json", told.append))
        assert row == {"n": n}
    assert (
        f"the audit has not ended: {n} of {N_DRIVES} drives have a result; {n} judged drives are not packed" in told[0]
    )
    assert n_results(LocalFolder(out), out) == n


def test_report_and_diff_show_what_is_there(interrupted: tuple[Path, int], tmp_path: Path) -> None:
    out, n = interrupted
    name, audit = page.write_fleet_page(str(out), "markdown", (), None)
    text = (out / name).read_text(encoding="utf-8")
    assert f"{n} of {n} drives were judged, of {N_DRIVES} that were asked for" in text
    assert f"{n} of {N_DRIVES} drives have a result" in text
    assert audit.warning
    with open_two_audits(str(out), str(out)) as (con, earlier, later):
        found = difference(con, later, earlier, 5)
    assert found.comparison.drives_both == n
    assert sum(found.verdicts[0].values()) >= n


def test_the_rows_are_those_that_a_merge_packs_and_then_it_says_how_many_are_missing(
    interrupted: tuple[Path, int],
) -> None:
    out, n = interrupted
    with open_database() as con:
        create_views_of_all_results(con, LocalFolder(out), out)
        before = tables_digest(con)
    merged = merge(str(out), Silent())
    assert merged.digest == before
    assert (
        f"INCOMPLETE: these parts have not ended: all: {n} of {N_DRIVES} drives have a result: run the same"
        in summary_text(merged, "out", ExitCode.NOT_JUDGED)
    )
    with open_audits(str(out)) as (_, audit, _):
        assert f"{n} of {N_DRIVES} drives have a result; give the same audit again" in audit.warning
    with open_database() as con:
        create_views(con, LocalFolder(out), out)
        assert tables_digest(con) == before


BLOCKED = """
import multiprocessing
import signal
from drivelint.audit.executors.local import block_ctrl_c

def blocked():
    return signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, [])

def tell():
    print(blocked(), flush=True)

if __name__ == "__main__":
    process = multiprocessing.get_context("spawn").Process(target=tell)
    with block_ctrl_c():
        process.start()
    process.join()
    print(blocked())
"""


def test_ctrl_c_is_heard_by_the_driver_and_by_no_worker_that_begins(tmp_path: Path) -> None:
    """The resource tracker of multiprocessing ends a block of signals when it starts; and the main thread must not stay blocked."""
    script = tmp_path / "blocked.py"
    script.write_text(BLOCKED, encoding="utf-8")
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["True", "False"]
