"""`python -m tests.bench [SECTION]...`, from the repository's root: what the product takes, beside its bars.

`before COMMIT` compares the present tree with another commit of this repository, stage by stage; `demo fleet --against COMMIT` does so
command by command.

Everything is generated, in a temporary folder. Shared machines are noisy: compare lines of one run, not numbers of two, and look
at CPU seconds beside the clock's. Nothing here asserts a time; comparisons assert that both sides gave the same answer.
"""

from __future__ import annotations

import argparse
import os
import platform
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import duckdb

from tests.bench import before, commands, copying, formats, growth, perception, pictures, profiling, stages
from tests.bench.commit import UnknownCommitError
from tests.bench.place import TINY, Place, Sizes
from tests.bench.rivals import boxes, postgis, reading, temporal
from tests.bench.table import Row, Skipped, markdown

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

SECTIONS: dict[str, Callable[[Place], list[Row]]] = {
    "reference": stages.reference,
    "short": stages.short,
    "demo": commands.demo,
    "fleet": commands.fleet,
    "formats": formats.formats,
    "perception": perception.perception,
    "growth": growth.growth,
    "copy": copying.copying,
    "pictures": pictures.pictures,
    "shapely": boxes.compare,
    "rtamt": temporal.compare,
    "omega": reading.compare,
    "postgis": postgis.compare,
    "long": growth.long,
    "profile": profiling.profile,
    "before": before.before,
}
ASKED_ONLY = ("long", "profile", "before")  # minutes and gigabytes; a table of its own; needs a commit


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table."""
    options = _options(arguments)
    sizes = TINY if options.tiny else Sizes()
    if not options.tiny:
        sizes = sizes._replace(
            runs=options.runs,
            slow_runs=max(1, options.runs * 3 // 5),
            drives=options.short,
            fleet=options.fleet,
            megabytes=options.megabytes,
            hours=options.hours,
            steps=options.steps,
            unit=sizes.unit._replace(seconds=options.unit),
        )
    rows: list[Row] = []
    with tempfile.TemporaryDirectory(prefix="drivelint-bench-") as home:
        place = Place(Path(home), sizes, options.commit)
        for name in options.sections or [s for s in SECTIONS if s not in ASKED_ONLY]:
            print(f"{name} (load {os.getloadavg()[0]:.1f}) ...", file=sys.stderr, flush=True)
            try:
                rows += SECTIONS[name](place)
            except Skipped as why:
                print(f"skipped: {name}: {why}", file=sys.stderr, flush=True)
            except UnknownCommitError as error:
                raise SystemExit(f"{name}: {error}") from error
    print(
        f"{os.cpu_count()} cores, Python {platform.python_version()}, DuckDB {duckdb.__version__}; "
        f"load at the end {os.getloadavg()[0]:.1f}\n"
    )
    print(markdown(rows))


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m tests.bench", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    whole = Sizes()
    parser.add_argument("sections", nargs="*", metavar="SECTION", help=f"of {', '.join(SECTIONS)} COMMIT")
    parser.add_argument("--runs", type=int, default=whole.runs, help="repetitions (default 5; slow sections: 3)")
    parser.add_argument("--short", type=int, default=whole.drives, help="how many short drives")
    parser.add_argument("--unit", type=float, default=whole.unit.seconds, help="seconds of the 1x drive of `growth`")
    parser.add_argument("--megabytes", type=int, default=whole.megabytes, help="size of the log of `copy`")
    parser.add_argument("--hours", type=float, default=whole.hours, help="length of the drive of `long`")
    parser.add_argument("--steps", type=int, default=whole.steps, help="steps of the PostGIS loop over time steps")
    parser.add_argument("--fleet", type=int, default=whole.fleet, help="how many drives of `fleet`")
    parser.add_argument(
        "--against", metavar="COMMIT", default="HEAD", help="run the commands of `demo` and `fleet` at this commit, too"
    )
    parser.add_argument("--tiny", action="store_true", help="everything as small as can be: only to see that it runs")
    options = parser.parse_args(arguments)
    options.commit = options.against
    if "before" in options.sections:
        at = options.sections.index("before") + 1
        if at == len(options.sections):
            parser.error("before: name the commit to compare with, as in `before HEAD~1`")
        options.commit = options.sections.pop(at)
    if unknown := [s for s in options.sections if s not in SECTIONS]:
        parser.error(f"no section {unknown[0]!r}: choose of {', '.join(SECTIONS)}")
    return options


if __name__ == "__main__":
    main()
