"""Hosts on this machine: network namespaces with an address each on one switch, whose cables a test can pull."""

from __future__ import annotations

import os
import shutil
import subprocess
import uuid
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING, NamedTuple

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterator

_IP = shutil.which("ip", path=f"{os.environ.get('PATH', '')}:/usr/sbin:/sbin") or "ip"


class Hosts(NamedTuple):
    """Hosts by number. Nothing of them is in the namespace of the test, so that no address can clash with another network's."""

    switch: str
    names: list[str]

    @staticmethod
    def address(host: int) -> str:
        """Return the address of a host, which only the other hosts reach."""
        return f"10.0.0.{host + 1}"

    def on(self, host: int) -> list[str]:
        """Return what a command begins with to run on a host. The process is that of the command."""
        return [_IP, "netns", "exec", self.names[host]]

    def cut(self, host: int) -> None:
        """Pull the cable of a host at the switch: packets vanish, and neither side is told."""
        _ip("-n", self.switch, "link", "set", f"port{host}", "down")

    def join(self, host: int) -> None:
        """Plug the cable of a host in again."""
        _ip("-n", self.switch, "link", "set", f"port{host}", "up")


@contextmanager
def hosts(n_hosts: int) -> Iterator[Hosts]:
    """Make hosts, which are gone after the block. The test is skipped where nobody may make namespaces."""
    mark = f"drivelint-{uuid.uuid4().hex[:12]}"
    made = Hosts(f"{mark}-switch", [f"{mark}-{host}" for host in range(n_hosts)])
    with ExitStack() as undo:
        for name in (made.switch, *made.names):
            try:
                _ip("netns", "add", name)
            except (OSError, subprocess.CalledProcessError) as error:
                why = getattr(error, "stderr", None) or error
                pytest.skip(f"no right to make network namespaces: {why}")
            undo.callback(_ip, "netns", "delete", name)  # its interfaces go with it
        _ip("-n", made.switch, "link", "add", "bridge", "type", "bridge")
        _ip("-n", made.switch, "link", "set", "bridge", "up")
        for host, name in enumerate(made.names):
            ends = ["add", f"port{host}", "type", "veth", "peer", "name", "cable", "netns", name]
            _ip("-n", made.switch, "link", *ends)
            _ip("-n", made.switch, "link", "set", f"port{host}", "master", "bridge", "up")
            _ip("-n", name, "address", "add", f"{made.address(host)}/24", "dev", "cable")
            for device in ("lo", "cable"):
                _ip("-n", name, "link", "set", device, "up")
        yield made


def _ip(*words: str) -> None:
    subprocess.run([_IP, *words], check=True, capture_output=True, text=True, timeout=30)
