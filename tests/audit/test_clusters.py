"""Audits on Dask and Ray: the tables of one process, also when a worker or the scheduler dies."""

from __future__ import annotations

import importlib.util
import os
import signal
import subprocess
import sys
import threading
import time
from typing import TYPE_CHECKING, Any

import pytest

from drivelint.audit.executors import ClusterError, TaskOutcome
from drivelint.audit.executors.choice import open_executor
from drivelint.errors import ExitCode, UsageError
from tests.audit import fleet
from tests.audit.clusters import dask
from tests.audit.here import run_audit

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from drivelint.audit.executors.dask import DaskCluster
    from tests.audit.clusters import DaskProcesses

pytestmark = pytest.mark.ci

N_DRIVES = 16


def _on(address: str) -> object:
    return open_executor(address, workers=None, memory=None, timeout_s=None)


@pytest.mark.slow
def test_dask_with_a_killed_worker_gives_the_same_tables(
    drives: fleet.Fleet, digest: str | None, tmp_path: Path
) -> None:
    with dask(tmp_path, 2) as cluster:
        victim = threading.Timer(2.0, cluster.workers[0].send_signal, [signal.SIGKILL])
        victim.start()
        counted = run_audit(drives, tmp_path / "out", _on(cluster.address))  # type: ignore[arg-type]
        victim.join()
        assert cluster.workers[0].wait(timeout=10) == -signal.SIGKILL
    assert (counted.n_drives, counted.quarantined, counted.digest) == (N_DRIVES, 0, digest)


@pytest.mark.slow
def test_a_dead_scheduler_is_exit_75_and_the_audit_goes_on_after(
    drives: fleet.Fleet, digest: str | None, tmp_path: Path
) -> None:
    with dask(tmp_path, 1) as cluster:
        command = drives.command(tmp_path / "out", "--cluster", cluster.address, "--memory", "200MB")
        running = subprocess.Popen([sys.executable, "-m", "drivelint", *command], stderr=subprocess.PIPE)
        _until((tmp_path / "out").exists, "the audit has begun")
        cluster.scheduler.send_signal(signal.SIGKILL)
        said = running.communicate(timeout=120)[1].decode()
    assert running.returncode == ExitCode.TEMPFAIL, said
    assert "scheduler" in said
    assert "Traceback" not in said, said
    assert run_audit(drives, tmp_path / "out").digest == digest


@pytest.fixture
def sleepers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[DaskProcesses, DaskCluster]]:
    """Two workers that sleep for as many seconds as a task says, with the executor that hands out such tasks."""
    monkeypatch.setattr("drivelint.audit.executors.dask.run_task", time.sleep)
    monkeypatch.setattr("drivelint.audit.executors.dask.WORKERLESS_S", 1.0)
    monkeypatch.setattr("drivelint.audit.executors.dask._CLUSTER_CHECK_PERIOD_S", 0.5)
    with dask(tmp_path, 2) as cluster:
        executor: Any = _on(cluster.address)
        yield cluster, executor
        executor.close()


def _submitted(executor: Any, seconds: float) -> Any:
    executor.submit(seconds)
    return next(reversed(executor._running))


def _until(is_so: Callable[[], bool], condition: str) -> None:
    for _ in range(600):
        if is_so():
            return
        time.sleep(0.05)
    raise AssertionError(f"for 30 s not so: {condition}")


def _until_status(future: Any, status: str) -> None:
    _until(lambda: future.status == status, f"a task is {status}")


def test_a_result_that_is_lost_with_its_worker_is_made_again(sleepers: tuple[DaskProcesses, Any]) -> None:
    _, executor = sleepers
    long = _submitted(executor, 5.0)
    short = _submitted(executor, 1.0)
    _until_status(short, "finished")
    ((holder,),) = executor._client.who_has([short]).values()
    os.kill(executor._client.run(os.getpid)[holder], signal.SIGKILL)
    _until_status(short, "lost")
    assert executor.wait() == [TaskOutcome(5.0, None)]  # type: ignore[arg-type]
    assert long.status == "finished"
    assert executor.wait() == [TaskOutcome(1.0, None)]  # type: ignore[arg-type]


def test_without_a_worker_the_audit_ends(sleepers: tuple[DaskProcesses, Any]) -> None:
    cluster, executor = sleepers
    executor.submit(60.0)
    # a task that no worker has yet is not lost with them, but waits for others
    _until(lambda: any(executor._client.processing().values()), "a worker has the task")
    for worker in cluster.workers:
        worker.send_signal(signal.SIGKILL)
    (outcome,) = executor.wait()
    assert "the worker died" in outcome.loss_reason
    # a scheduler that has not missed the second one hands it the next task
    _until(lambda: not executor._client.nthreads(), "the scheduler counts no worker")
    executor.submit(60.0)
    with pytest.raises(ClusterError, match="no worker for 1 s: start some and run the same command again"):
        executor.wait()


def test_a_scheduler_that_dies_while_a_result_is_fetched(sleepers: tuple[DaskProcesses, Any]) -> None:
    cluster, executor = sleepers
    _until_status(_submitted(executor, 0.0), "finished")
    cluster.scheduler.send_signal(signal.SIGSTOP)
    death = threading.Timer(1.0, cluster.scheduler.send_signal, [signal.SIGKILL])
    death.start()
    with pytest.raises(ClusterError, match="the scheduler is gone"):
        executor.wait()
    death.join()


def test_workers_with_threads_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("drivelint.audit.executors.dask.ANSWER_S", 2.0)
    with pytest.raises(ClusterError, match="no Dask scheduler answers"):
        _on("tcp://127.0.0.1:9")
    with pytest.raises(UsageError, match="give the address of a Dask scheduler"):
        _on("http://127.0.0.1")


@pytest.mark.skipif(importlib.util.find_spec("ray") is None, reason="Ray is not installed")
def test_ray_with_a_killed_node_gives_the_same_tables(drives: fleet.Fleet, digest: str | None, tmp_path: Path) -> None:
    utils = importlib.import_module("ray.cluster_utils")
    cluster = utils.Cluster(initialize_head=True, head_node_args={"num_cpus": 1})
    node = cluster.add_node(num_cpus=1)
    try:
        executor = _on(cluster.address)
        victim = threading.Timer(3.0, cluster.remove_node, [node], {"allow_graceful": False})
        victim.start()
        counted = run_audit(drives, tmp_path / "out", executor)  # type: ignore[arg-type]
        victim.join()
    finally:
        cluster.shutdown()
    assert (counted.n_drives, counted.quarantined, counted.digest) == (N_DRIVES, 0, digest)
