"""`python -m tests.trial draw DIR --seed N --count 100`, `... score DIR` and `... misses DIR`: are findings on real logs true?

`draw` judges the perception logs of the reference data, every vehicle as ego (each log once: results stay in DIR/results), draws
findings of stable rules by lot and writes a sheet for each into DIR/sheets; DIR/key.json says which sheet is which finding.
An examiner answers from the sheets alone in DIR/answers.csv: `number,answer,fault,remark`, where answer is T, F or ?.
`score` prints how many were true. `misses` lists contacts and near contacts that no stable rule fails.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from . import lots, misses, score


def main() -> int:
    """Draw, score or look for misses; the exit code of `misses` is 1 where one is there."""
    parser = argparse.ArgumentParser(prog="python -m tests.trial", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    drawing = commands.add_parser("draw")
    drawing.add_argument("--seed", type=int, default=1)
    drawing.add_argument("--count", type=int, default=100)
    drawing.add_argument(
        "--no-copies", action="store_true", help="in a third of the time: sure and possible are not told apart"
    )
    drawing.add_argument("--without", nargs="*", default=[], metavar="RULE", help="rules that are left out")
    for command in (drawing, commands.add_parser("score"), commands.add_parser("misses")):
        command.add_argument("folder", type=Path)
    asked = parser.parse_args()
    if asked.command == "draw":
        drawn = lots.draw(asked.folder, asked.seed, asked.count, copies=not asked.no_copies, without=asked.without)
        print(f"{drawn} sheets in {asked.folder / 'sheets'}")
        return 0
    if asked.command == "score":
        print("\n".join(score.table(asked.folder)))
        return 0
    lines = [line for result in lots.results(asked.folder) for line in misses.unnoticed(result)]
    print("\n".join(lines) or "no contact and no near contact without a finding")
    return int(not all(line.startswith("unknown") for line in lines))


if __name__ == "__main__":
    sys.exit(main())
