"""The same check many times under several limits of memory: every run must give the same bytes, words and exit code.

    python -m tests.repeated --runs 10 --memory 512MB --memory 1200MB --memory none -- \\
        ../shared/data/cav_loop/TEST003.csv --mapping ../shared/data/cav_loop/mapping.toml \\
        --map ../shared/data/cav_loop/loop_geo_RHD.xodr --handedness lht --rules all --ego all --margins

One line per run on stdout, with its seconds and the most memory of the process; exit code 1 where a run differs from the first.
"""

from __future__ import annotations

import argparse
import hashlib
import shutil
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple


class Outcome(NamedTuple):
    """What one run left: digests by file, of stdout too, its exit code, and what it said of memory."""

    digests: dict[str, str]
    code: int
    memory: str


def run(asked: list[str], memory: str, out: Path) -> Outcome:
    """Check in a process of its own, with results in the folder `out`."""
    command = [sys.executable, "-m", "drivelint", "check", *asked, "--out", str(out), "--memory", memory]
    done = subprocess.run(command, capture_output=True, check=False)
    found = {str(f.relative_to(out)): _digest(f.read_bytes()) for f in sorted(out.rglob("*")) if f.is_file()}
    found.pop("drivelint.duckdb", None)  # a database's file may differ where its rows do not
    said = "; ".join(line for line in done.stderr.decode().splitlines() if "memory" in line)
    return Outcome({**found, "stdout": _digest(done.stdout)}, done.returncode, said)


def main() -> int:
    """Run as the command line says. Return 1 where a run differs from the first."""
    parser = argparse.ArgumentParser(prog="python -m tests.repeated", description=__doc__)
    parser.add_argument("--runs", type=int, default=10, help="for each limit")
    parser.add_argument("--memory", action="append", help="as of drivelint check, repeatable")
    parser.add_argument("asked", nargs="+", help="what drivelint check is asked, after --")
    given = parser.parse_args()
    first: Outcome | None = None
    differing = 0
    with TemporaryDirectory(prefix="repeated-") as folder:
        out = Path(folder) / "out"  # the same each time: it stands in what is printed
        for memory in given.memory or ["512MB", "1200MB", "none"]:
            for no in range(1, given.runs + 1):
                start = time.monotonic()
                found = run(given.asked, memory, out)
                shutil.rmtree(out, ignore_errors=True)
                first = first or found
                other = sorted(n for n in first.digests | found.digests if first.digests.get(n) != found.digests.get(n))
                differing += bool(other) or found.code != first.code
                told = f"{', '.join(other)} differ" if other else f"the same {len(found.digests) - 1} files"
                took = f"{time.monotonic() - start:.0f} s"
                print(f"{memory} {no}: exit {found.code}, {told}, {took}. {found.memory}", flush=True)
    print(f"{differing} of the runs differ from the first")
    return int(differing > 0)


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


if __name__ == "__main__":
    sys.exit(main())
