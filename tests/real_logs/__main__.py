"""`python -m tests.real_logs judge DIR [NAME ...]` and `... compare OLD NEW`: what a change does to verdicts on real logs.

`judge` checks every log of the reference data (or those whose names contain a NAME) with every vehicle as ego, all rules and profiles,
each into a folder of DIR. To compare two versions, run it in a checkout of each.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from tests.false_alarms.count import REAL
from tests.shared_data import DATA

from .verdicts import changes, judge


def main() -> int:
    """Judge, or compare; the exit code of `compare` is 1 where a verdict went from unknown to pass."""
    parser = argparse.ArgumentParser(prog="python -m tests.real_logs", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    judging = commands.add_parser("judge")
    judging.add_argument("folder", type=Path)
    judging.add_argument("names", nargs="*")
    comparing = commands.add_parser("compare")
    comparing.add_argument("old", type=Path)
    comparing.add_argument("new", type=Path)
    asked = parser.parse_args()
    if asked.command == "judge":
        for name in REAL:
            if not asked.names or any(part in name for part in asked.names):
                print(
                    f"{name}: {judge(name, asked.folder) if (DATA / REAL[name][0]).exists() else 'not there'}",
                    flush=True,
                )
        return 0
    found = changes(asked.old, asked.new)
    for change in found:
        print(f"{change.log}: {change.rule} {change.before} -> {change.after}, {change.n}; {change.example}")
    return int(any((change.before, change.after) == ("unknown", "pass") for change in found))


if __name__ == "__main__":
    sys.exit(main())
