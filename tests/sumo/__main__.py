"""`python -m tests.sumo [--seconds 3600] [--seed 1] [--folder DIR]`: SUMO's traffic, read twice, and contacts planted in it."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.sumo.comparison import run_comparison


def main() -> int:
    """Simulate, read, check, compare; print the figures. Return 1 where the two readings differ."""
    parser = argparse.ArgumentParser(prog="python -m tests.sumo", description=__doc__)
    parser.add_argument("--seconds", type=int, default=3600)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--plants", type=int, default=5, help="contacts of each kind")
    parser.add_argument("--folder", type=Path, help="keep the files here")
    asked = parser.parse_args()
    with TemporaryDirectory() as temporary:
        figures, differ = run_comparison(asked.folder or Path(temporary), asked.seconds, asked.seed, asked.plants)
    for name, value in figures.items():
        print(f"{name:44} {value:g}")
    print("\n".join(["differences:", *differ]) if differ else "no differences")
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
