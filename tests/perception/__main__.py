"""`python -m tests.perception [--levels mild faulty] [--seconds 600] [--pieces 1] [--egos 60] [--roads town main]`: what perception does.

Traffic of SUMO is the truth; a model of a recorder writes what each ego would have seen of it; both are judged. Prints, by rule,
how many verdicts of the truth are decided on the recording, and how many are contradicted.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory

from drivelint import catalogue

from .compare import Tally, compared
from .recorder import LEVELS
from .roads import ROADS
from .traffic import tracks


def main() -> int:
    """Simulate, record, judge, print; the exit code is 1 where a critical or major rule's breach became a pass, or was not seen."""
    parser = argparse.ArgumentParser(prog="python -m tests.perception", description=__doc__)
    parser.add_argument("--levels", nargs="+", choices=LEVELS, default=["mild"], help="of how badly the recorder sees")
    parser.add_argument("--roads", nargs="+", choices=ROADS, default=list(ROADS))
    parser.add_argument("--seconds", type=int, default=600, help="of traffic on each road, each time")
    parser.add_argument("--pieces", type=int, default=1, help="how many times, with another seed each")
    parser.add_argument("--egos", type=int, help="at the most, on each road, each time")
    parser.add_argument("--folder", type=Path, help="keep the files here")
    asked = parser.parse_args()
    sums: dict[str, dict[str, Counter[tuple[str, str]]]] = {level: {} for level in asked.levels}
    hours = 0.0
    with TemporaryDirectory() as temporary:
        for road in asked.roads:
            drive, hand = ROADS[road]
            for seed in range(1, asked.pieces + 1):
                folder = (asked.folder or Path(temporary)) / f"{road}{seed}"
                files = drive(folder / "sumo", seconds=asked.seconds, seed=seed)
                found, driven = compared(
                    tracks(files.log, files.routes), files.map, folder, {level: LEVELS[level] for level in asked.levels},
                    asked.egos, ("--handedness", hand),
                )  # fmt: skip
                hours += driven
                for level, tallies in found.items():
                    for rule, tally in tallies.items():
                        sums[level].setdefault(rule, Counter()).update(tally.pairs)
                print(f"{road} {seed}: {driven:.2f} h", file=sys.stderr, flush=True)
    grave = [_print_level(level, hours, sums[level]) for level in asked.levels]
    return int(sum(grave) > 0)


def _print_level(level: str, hours: float, sums: dict[str, Counter[tuple[str, str]]]) -> int:
    """Print a level's table; return how many breaches of critical and major rules became a pass, or were not seen."""
    rules = {rule.id: rule for rule in catalogue.load_rules().values() if rule.status == "stable"}
    print(f"{level}: {hours:.2f} h of egos\n")
    heads = ("truth", "fails", "decided", "share", "false pass", "false n/a", "false fail")
    print(f"{'rule':34}{'severity':>9}" + "".join(f"{head:>11}" for head in heads))
    grave = 0
    for rule, pairs in sorted(sums.items()):
        tally = Tally(pairs)
        if rule in rules and tally.decided + tally.false_fails:
            print(_line(rule, rules[rule].severity, tally))
            grave += tally.false_passes + tally.missed if rules[rule].severity in {"critical", "major"} else 0
    print(_line("all", "", Tally(sum((pairs for rule, pairs in sums.items() if rule in rules), Counter()))), flush=True)
    return grave


def _line(rule: str, severity: str, tally: Tally) -> str:
    share = f"{tally.decided_by_both / tally.decided:.2f}" if tally.decided else "-"
    values = (
        tally.decided,
        tally.fails,
        tally.decided_by_both,
        share,
        tally.false_passes,
        tally.missed,
        tally.false_fails,
    )
    return f"{rule:34}{severity:>9}" + "".join(f"{value:>11}" for value in values)


if __name__ == "__main__":
    sys.exit(main())
