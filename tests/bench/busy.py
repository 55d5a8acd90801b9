"""`python -m tests.bench.busy [MINUTES] [OPTION]...`: does a long drive have the same result beside a busy machine as on a quiet one?

The drive has 50 actors at 20 Hz, and 60 minutes where nothing else is said. `drivelint check` judges it with these options, once alone
and once beside two processes that spin. Every file of the two results is compared byte by byte. Exit code 1 where one differs.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple

from tests.bench import traffic

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

MINUTES: Final = 60.0
SPINNING: Final = 2


class CheckRun(NamedTuple):
    """What a check came to: its exit code, what it said on both streams, its files, and what it took."""

    code: int
    output: str
    notes: str
    files: dict[str, bytes]
    wall_s: float
    cpu_s: float
    memory_mib: float


@contextmanager
def spinning(n: int = SPINNING) -> Iterator[None]:
    """Keep so many processes computing inside the block."""
    with ExitStack() as stack:
        for _ in range(n):
            process = subprocess.Popen([sys.executable, "-c", "while True: pass"])
            stack.callback(process.wait)
            stack.callback(process.kill)
        yield


def run_check(words: Sequence[str | Path], out: Path) -> CheckRun:
    """Check a drive in a process of its own, and take its result away from `out`."""
    command = [sys.executable, "-m", "drivelint", "check", *words, "--out", out, "--no-cache", "--quiet"]
    begin = time.monotonic()
    with (
        tempfile.TemporaryFile("w+", encoding="utf-8") as output,
        tempfile.TemporaryFile("w+", encoding="utf-8") as notes,
    ):
        running = subprocess.Popen(command, stdout=output, stderr=notes, cwd=out.parent)
        _, status, used = os.wait4(running.pid, 0)
        running.returncode = os.waitstatus_to_exitcode(status)
        wall_s = time.monotonic() - begin
        output.seek(0)
        notes.seek(0)
        files = {str(file.relative_to(out)): file for file in sorted(out.rglob("*")) if file.is_file()}
        content = {name: file.read_bytes() for name, file in files.items()}
        for file in files.values():
            file.unlink()
        cpu_s, memory_mib = used.ru_utime + used.ru_stime, used.ru_maxrss / 1024
        return CheckRun(running.returncode, output.read(), notes.read(), content, wall_s, cpu_s, memory_mib)


def differing(quiet: CheckRun, busy: CheckRun) -> list[str]:
    """Return what differs: names of files, the exit code, the streams."""
    names = sorted(quiet.files.keys() | busy.files.keys())
    found = [name for name in names if quiet.files.get(name) != busy.files.get(name)]
    return found + [name for name in ("code", "output", "notes") if getattr(quiet, name) != getattr(busy, name)]


def main(arguments: Sequence[str]) -> int:
    """Compare, print what was seen, and return the exit code."""
    minutes, options = MINUTES, list(arguments)
    if options and not options[0].startswith("-"):
        minutes = float(options.pop(0))
    with tempfile.TemporaryDirectory(prefix="drivelint-busy-") as folder:
        home = Path(folder)
        (home / "ring.xodr").write_text(traffic.ring(), encoding="utf-8")
        log = traffic.write_folder(home / "drive", traffic.REFERENCE._replace(seconds=minutes * 60))
        words: list[str | Path] = [log, "--map", home / "ring.xodr", *options]
        runs = {}
        for name, n in (("quiet", 0), ("busy", SPINNING)):
            with spinning(n):
                ran = runs[name] = run_check(words, home / "out")
            took = f"{ran.wall_s:.0f} s, CPU {ran.cpu_s:.0f} s, memory {ran.memory_mib:.0f} MiB"
            print(f"{name}: exit {ran.code}, {len(ran.files)} files, {took}\n{ran.notes}", flush=True)
        wrong = differing(runs["quiet"], runs["busy"])
        print(runs["quiet"].output)
        print(f"{', '.join(runs['quiet'].files)}\n{'all the same' if not wrong else 'differ: ' + ', '.join(wrong)}")
        return int(bool(wrong) or not runs["quiet"].files)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
