"""The processes of SUMO that run."""

from __future__ import annotations

from pathlib import Path


def processes(word: str) -> list[str]:
    """Return the commands that run now and name this file."""
    found = []
    for each in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            command = each.read_bytes().replace(b"\0", b" ").decode(errors="replace")
        except OSError:
            continue
        if word in command and "/sumo " in command:
            found.append(command)
    return found
