"""What the ends of log and map change.

`python -m tests.map_ends [--seconds 300] [--seed 1] [--egos 60] [--roads rural motorway] [--folder DIR]`
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.false_alarms import worlds
from tests.sumo.world import simulate

from .crop import compared, count_pairs

ROADS = {"rural": (simulate, "lht", (1000.0, 2700.0)), "motorway": (worlds.motorway, "rht", (1500.0, 3900.0))}
"""Who drives, on which side, and from where to where along x the part reaches."""


def main() -> int:
    """Simulate, cut, judge, print by rule; the exit code is 1 where the part contradicts the whole."""
    parser = argparse.ArgumentParser(prog="python -m tests.map_ends", description=__doc__)
    parser.add_argument("--seconds", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--egos", type=int)
    parser.add_argument("--roads", nargs="+", choices=ROADS, default=list(ROADS))
    parser.add_argument("--folder", type=Path, help="keep the files here")
    parser.add_argument("--show", action="store_true", help="print every pair that differs")
    asked = parser.parse_args()
    contradicted = 0
    with TemporaryDirectory() as temporary:
        for road in asked.roads:
            drive, hand, span = ROADS[road]
            folder = (asked.folder or Path(temporary)) / road
            files = drive(folder / "sumo", seconds=asked.seconds, seed=asked.seed)
            pairs = compared(files, folder, span, hand, max_egos=asked.egos)
            print(f"{road:36}{'decided':>9}{'decided on the part':>22}{'contradicted':>15}{'unknown on both':>18}")
            for rule, counts in count_pairs(pairs).items():
                decided = sum(n for (whole, _), n in counts.items() if whole in {"pass", "fail"})
                both = sum(
                    n for (whole, part), n in counts.items() if whole in {"pass", "fail"} and part in {"pass", "fail"}
                )
                wrong = sum(p.contradicts for (_, r, *_), p in pairs.items() if r == rule)
                print(f"{rule:36}{decided:9}{both:22}{wrong:15}{counts['unknown', 'unknown']:18}")
                contradicted += wrong
            for key, pair in pairs.items():
                if pair.contradicts or (asked.show and pair.whole.verdict != pair.part.verdict):
                    print(*key, *pair)
    return int(contradicted > 0)


if __name__ == "__main__":
    sys.exit(main())
