"""`python -m tests.peers stvo [SCENARIO ...]`: the German rules against commonroad-stl-monitor, every vehicle of each scenario as ego.

The peer's environment is made in the folder, with the network, or is the one of `--peer-python`. What both sides wrote stays in the
folder, and is not made again. The exit code is 1 where a bar is missed.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from .environment import peer_python
from .stvo import compare


def main() -> int:
    """Make the environment, compare, print."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.peers", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("peer", choices=["stvo"])
    parser.add_argument("scenarios", nargs="*", type=Path)
    parser.add_argument("--folder", type=Path, required=True, help="for the environment and what both sides write")
    parser.add_argument("--peer-python", type=Path, help="a Python that has the peer")
    asked = parser.parse_args()
    python = asked.peer_python or peer_python(asked.folder / "environment")
    text, is_met = compare(python, asked.folder, asked.scenarios)
    print(text)
    return 0 if is_met else 1


if __name__ == "__main__":
    sys.exit(main())
