"""`python -m tests.audit kills DRIVES KILLS`: a large fleet, audited with kills and beside a drive that always exhausts its worker, and
without; both must give the same tables.

`python -m tests.audit plan DRIVES`: what ten million drives would take beside their judging. `memory DRIVES`: how the memory of the
driver and of one worker grows with the drives, its mean and the most since the line before. `workers DRIVES`: what a second worker brings.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pyarrow.parquet as pq

from tests.audit import fleet
from tests.audit.kills import audit_with_kills, children
from tests.audit.plan import plan


def kills(n_drives: int, n_kills: int) -> None:
    """Print what was seen; exit 1 where a kill is missing, the tables differ, or the findings are not those planted."""
    with TemporaryDirectory(prefix="drivelint-audit-") as home:
        drives = fleet.write(Path(home) / "fleet", n_drives)
        greedy = Path(home) / "fleet" / "logs" / "greedy.parquet"
        fleet.write_exhausting(greedy, greedy.with_name("drive-00000.parquet"))
        killed_out, whole_out = (str(Path(home) / name) for name in ("killed", "whole"))
        limit = ("--worker-memory", f"{fleet.LITTLE_BYTES // 10**6}MB")
        begin = time.monotonic()
        command = drives.command(Path(killed_out), *limit)
        code, killed = audit_with_kills([*command[:2], str(greedy), *command[2:]], n_kills, 4.0)
        print(f"with {killed} kills: exit {code}, {time.monotonic() - begin:.0f} s", flush=True)
        told = [_summary(killed_out)]
        _run(drives.command(Path(killed_out), "--prune"))  # without the greedy drive, which no table may show any more
        begin = time.monotonic()
        done = _run(drives.command(Path(whole_out)))
        print(f"undisturbed: exit {done.returncode}, {time.monotonic() - begin:.0f} s")
        told += [_summary(out) for out in (killed_out, whole_out)]
        for each in told:
            print(json.dumps(each, sort_keys=True))
        broken = f"SELECT DISTINCT file_name FROM findings JOIN drives USING (key) WHERE rule_id = '{fleet.RULE}'"
        found = _run(["sql", killed_out, broken, "--format", "csv"])
        names = set(found.stdout.decode().split()[1:])
        print(f"planted contacts: {len(drives.planted)}; found: {len(names)}; the same: {names == drives.planted}")
        as_due = (killed, told[0]["judged"], told[0]["quarantined"]) == (n_kills, n_drives, 1)
        sys.exit(int(not as_due or told[1]["digest"] != told[2]["digest"] or names != drives.planted))


def _summary(out: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((Path(out) / "summary.json").read_text("utf-8"))
    return found


def memory(n_drives: int) -> None:
    """Print the mean and the most memory of the driver and its one worker, again and again as the audit goes on."""
    with TemporaryDirectory(prefix="drivelint-audit-") as home:
        drives = fleet.write(Path(home) / "fleet", n_drives)
        out = Path(home) / "out"
        words = drives.command(out, "--workers", "1")
        running = subprocess.Popen([sys.executable, "-m", "drivelint", *words], stdout=subprocess.DEVNULL)
        told, sizes = 0, dict[int, list[float]]()
        while running.poll() is None:
            for _ in range(10):
                time.sleep(0.1)
                for pid in (running.pid, *children(running.pid)):
                    sizes.setdefault(pid, []).append(_rss(pid))
            loose = sum(1 for _ in out.glob("receipts/*/*.json"))
            packed = sum(pq.read_metadata(file).num_rows for file in out.glob("tables/receipts/*.parquet"))
            n = max(loose, packed) if loose + packed > n_drives else loose + packed  # while it packs, both have some
            if n >= told + n_drives // 20:
                told = n
                # beside the worker, a process that packs, and one of Python's own
                seen = [sizes[pid] for pid in (running.pid, *children(running.pid)) if pid in sizes]
                driver, *others = (f"{sum(each) / len(each):.0f} (most {max(each):.0f})" for each in seen)
                print(f"{n:>7} drives: driver {driver} MB, its processes {', '.join(others)} MB", flush=True)
                sizes.clear()


def workers(n_drives: int) -> None:
    """Print the seconds that one and two workers take."""
    with TemporaryDirectory(prefix="drivelint-audit-") as home:
        drives = fleet.write(Path(home) / "fleet", n_drives)
        taken = []
        for n in (1, 2):
            begin = time.monotonic()
            _run(drives.command(Path(home) / f"out{n}", "--workers", str(n)))
            taken.append(time.monotonic() - begin)
            print(f"{n} workers: {taken[-1]:.1f} s", flush=True)
        print(f"two are {taken[0] / taken[1]:.2f} times as fast as one")


def _run(words: list[str]) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run([sys.executable, "-m", "drivelint", *words], check=False, capture_output=True)


def _rss(pid: int) -> float:
    """Return the resident memory of a process in MB (Linux); 0 if it has ended."""
    try:
        told = Path(f"/proc/{pid}/status").read_text(encoding="ascii")
    except OSError:
        return 0.0
    found = re.search(r"VmRSS:\s+(\d+) kB", told)
    return int(found[1]) / 1e3 if found else 0.0


if __name__ == "__main__":
    command, *numbers = sys.argv[1:]
    first, *rest = map(int, numbers)
    if command == "kills":
        kills(first, *rest)
    elif command == "plan":
        print("\n".join(plan(first)))
    else:
        {"memory": memory, "workers": workers}[command](first)
