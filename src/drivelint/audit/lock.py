"""Locks the place of an audit's results, so that two audits, or an audit and a merge, do not pack it at the same time."""

from __future__ import annotations

import json
import threading
import time
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Final

from drivelint.audit.store import LocalFolder
from drivelint.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from drivelint.audit.store import ResultStore

LOCK_EXPIRY_S: Final = 60.0
"""Seconds without a heartbeat after which the lock of an object store expires. The lock of a folder ends with its process."""
_LOCK_FILE: Final = "lock.json"


@contextmanager
def lock_results(results: ResultStore, *, shared: bool) -> Iterator[None]:
    """Lock a place while the block runs. `shared`: others may hold a shared lock too, such as shards, which do not pack.

    Errors: `UsageError` if another process holds a lock that excludes this one.
    """
    if isinstance(results, LocalFolder):
        with _lock_folder(results, shared=shared):
            yield
    elif shared:
        yield
    else:
        with _lock_store(results):
            yield


@contextmanager
def _lock_folder(results: LocalFolder, *, shared: bool) -> Iterator[None]:
    try:
        import fcntl
    except ImportError:  # Windows
        yield
        return
    results.root.mkdir(parents=True, exist_ok=True)
    with (results.root / ".lock").open("wb") as file:
        try:
            fcntl.flock(file, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
        except OSError:
            raise _in_use_error(str(results.root)) from None
        yield


@contextmanager
def _lock_store(results: ResultStore) -> Iterator[None]:
    def heartbeat_content() -> bytes:
        return f'{{"at": {time.time()}}}\n'.encode()

    if not results.create(_LOCK_FILE, heartbeat_content()):
        last_sign_s = json.loads(results.read(_LOCK_FILE) or b'{"at": 0}')["at"]
        if time.time() - last_sign_s < LOCK_EXPIRY_S:
            raise _in_use_error(f"sign of life {time.time() - last_sign_s:.0f} s ago")
        results.write(_LOCK_FILE, heartbeat_content())
    stop = threading.Event()

    def write_heartbeats() -> None:
        while not stop.wait(LOCK_EXPIRY_S / 6):
            results.write(_LOCK_FILE, heartbeat_content())

    thread = threading.Thread(target=write_heartbeats, daemon=True)
    thread.start()
    try:
        yield
    finally:
        stop.set()
        thread.join()
        with suppress(Exception):  # the lock expires by itself
            results.delete([_LOCK_FILE])


def _in_use_error(where: str) -> UsageError:
    return UsageError(
        f"{where}: another audit is running there: wait until it has ended, or share the drives with --claim"
    )
