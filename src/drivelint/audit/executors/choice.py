"""Chooses the executor named on the command line."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from drivelint.errors import UsageError

if TYPE_CHECKING:
    from drivelint.audit.executors import Executor

_HOST_AND_PORT: Final = re.compile(r"[\w.-]+:\d+")
"""An address of a Ray cluster in the form `host:port`, for a process on one of its nodes."""


def open_executor(cluster: str | None, *, workers: int | None, memory: int | None, timeout_s: float | None) -> Executor:
    """Return the executor for `--cluster`, or the local one, to which the other arguments apply.

    Errors: `UsageError` for an unknown kind of address, or an engine that is not installed; `ClusterError`.
    """
    if cluster is None:
        from drivelint.audit.executors.local import LocalPool

        return LocalPool(workers, memory, timeout_s)
    try:
        if cluster.startswith(("tcp://", "tls://")):
            from drivelint.audit.executors.dask import DaskCluster

            return DaskCluster(cluster)
        if cluster == "auto" or cluster.startswith("ray://") or _HOST_AND_PORT.fullmatch(cluster):
            from drivelint.audit.executors.ray import RayCluster

            return RayCluster(cluster)
    except ModuleNotFoundError as error:
        extra = "ray" if error.name == "ray" else "dask"
        raise UsageError(
            f"--cluster {cluster}: {error.name} is not installed: pip install 'drivelint[{extra}]'"
        ) from error
    raise UsageError(
        f"--cluster {cluster}: give the address of a Dask scheduler (tcp://..., tls://...) or of Ray (ray://..., HOST:PORT, auto)"
    )
