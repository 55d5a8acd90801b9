"""Which files and folders of a tree anybody opens, told by the Linux kernel: in whatever language they are read."""

from __future__ import annotations

import ctypes
import os
import struct
from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

_OPEN = 0x20
_EVENT = struct.Struct("iIII")


@contextmanager
def opened_below(root: Path) -> Iterator[set[str]]:
    """Yield a set that has, at the end of the block, the paths that were opened meanwhile in a tree, which may not grow."""
    libc = ctypes.CDLL(None, use_errno=True)
    if not hasattr(libc, "inotify_init1"):
        pytest.skip("the kernel does not tell which files are opened")
    queue = libc.inotify_init1(os.O_NONBLOCK)
    folders = [root, *(path for path in root.rglob("*") if path.is_dir())]
    watched = {libc.inotify_add_watch(queue, os.fsencode(folder), _OPEN): folder for folder in folders}
    paths: set[str] = set()
    try:
        assert min(watched) >= 0
        yield paths
        content = b"".join(iter(lambda: _read(queue), b""))
    finally:
        os.close(queue)
    at = 0
    while at < len(content):
        watch, _, _, length = _EVENT.unpack_from(content, at)
        name = os.fsdecode(content[at + _EVENT.size : at + _EVENT.size + length].rstrip(b"\0"))
        paths.add(str(watched[watch] / name if name else watched[watch]))
        at += _EVENT.size + length


def _read(queue: int) -> bytes:
    try:
        return os.read(queue, 1 << 20)
    except BlockingIOError:
        return b""
