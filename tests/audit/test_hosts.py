"""Audits on Dask on two hosts: the tables of one process, also when a worker dies, a host is cut off, or the scheduler dies."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import pytest

from drivelint.audit.compact import open_database, tables_digest
from drivelint.audit.store import LocalFolder
from drivelint.audit.unpacked import create_views_of_all_results
from drivelint.errors import ExitCode
from tests.audit import fleet
from tests.audit.clusters import dask
from tests.audit.here import run_audit
from tests.audit.hosts import Hosts, hosts

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

pytestmark = pytest.mark.slow

N_DRIVES = 6
SMALL_TASKS = """
from drivelint.audit import driver
from drivelint.cli import main

driver.SMALL_TASK_MAX_DRIVES = 2
main()
"""
"""The command, with three tasks instead of one for the drives."""


@pytest.fixture
def network() -> Iterator[Hosts]:
    """Host 0 has the scheduler and the driver, hosts 1 and 2 a worker each."""
    with hosts(3) as made:
        yield made


@contextmanager
def _audit(network: Hosts, drives: fleet.Fleet, out: Path, address: str) -> Iterator[subprocess.Popen[str]]:
    """Run an audit on host 0, which ends with the block."""
    command = drives.command(out, "--cluster", address, "--memory", "200MB")
    words = [*network.on(0), sys.executable, "-c", SMALL_TASKS, *command]
    with subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as running:
        try:
            yield running
        finally:
            running.kill()


def _ended(running: subprocess.Popen[str], out: Path) -> dict[str, Any]:
    said = running.communicate(timeout=120)[1]
    assert running.returncode == ExitCode.FAILED, said
    return dict(json.loads((out / "summary.json").read_text(encoding="utf-8")))


def _receipts(out: Path) -> list[Path]:
    """Return the receipts that are not packed."""
    return list(out.glob("receipts/*/*.json"))


def _digest_of_all(out: Path) -> str:
    """Return the digest of all results, also of those that are not packed."""
    with open_database() as con:
        create_views_of_all_results(con, LocalFolder(out), out)
        return tables_digest(con)


def test_a_killed_worker(network: Hosts, drives: fleet.Fleet, digest: str | None, tmp_path: Path) -> None:
    out = tmp_path / "out"
    with dask(tmp_path / "dask", 2, hosts=network) as cluster, _audit(network, drives, out, cluster.address) as running:
        cluster.wait_for_task(0)
        cluster.workers[0].send_signal(signal.SIGKILL)
        counted = _ended(running, out)
    assert (counted["n_drives"], counted["quarantined"], counted["digest"]) == (N_DRIVES, 0, digest)


def test_a_host_that_is_cut_off_and_comes_back(
    network: Hosts, drives: fleet.Fleet, digest: str | None, tmp_path: Path
) -> None:
    """The audit ends without it. Then its worker goes on where it was, and writes what the other one has judged meanwhile."""
    out = tmp_path / "out"
    with dask(tmp_path / "dask", 2, hosts=network) as cluster, _audit(network, drives, out, cluster.address) as running:
        cluster.wait_for_task(0)
        network.cut(1)
        cluster.workers[0].send_signal(signal.SIGSTOP)  # the way to the results is cut, too
        counted = _ended(running, out)
        assert (counted["n_drives"], counted["quarantined"], counted["digest"]) == (N_DRIVES, 0, digest)
        assert not _receipts(out)
        network.join(1)
        cluster.workers[0].send_signal(signal.SIGCONT)
        cluster.workers[0].wait(timeout=60)
    assert _receipts(out)
    assert _digest_of_all(out) == digest
    again = run_audit(drives, out)
    assert (again.n_drives, again.reused, again.digest) == (N_DRIVES, N_DRIVES, digest)


def test_a_killed_scheduler_and_the_audit_given_again(
    network: Hosts, drives: fleet.Fleet, digest: str | None, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    with dask(tmp_path / "dask", 2, hosts=network) as cluster, _audit(network, drives, out, cluster.address) as running:
        cluster.wait_for_task(0)
        cluster.workers[0].send_signal(signal.SIGSTOP)  # something is left for the second time
        while running.poll() is None and not _receipts(out):
            time.sleep(0.1)
        cluster.scheduler.send_signal(signal.SIGKILL)
        said = running.communicate(timeout=120)[1]
    assert running.returncode == ExitCode.TEMPFAIL, said
    assert "the scheduler is gone" in said
    assert "Traceback" not in said, said
    port = int(cluster.address.rpartition(":")[2])
    with (
        dask(tmp_path / "again", 1, port, network) as cluster,
        _audit(network, drives, out, cluster.address) as running,
    ):
        counted = _ended(running, out)
    assert (counted["n_drives"], counted["digest"]) == (N_DRIVES, digest)
    assert 0 < counted["reused"] < N_DRIVES
