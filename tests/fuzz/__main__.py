"""`python -m tests.fuzz N [--seed S] [--only KIND]`, from the repository's root: N damaged files, and what became of them.

The numbers are shared out among the kinds. `--log FILE` writes every outcome there, and a second run with it goes on where the first
ended: so 100,000 files are tried, beside other work. `--only KIND --at NUMBER --save FOLDER` repeats one case and keeps its files. The exit
code is 1 where a case shows a bug.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

from tests.fuzz.driver import TIME_LIMIT_S, Driver
from tests.fuzz.outcome import BAD, GOOD, Outcome
from tests.fuzz.worker import KINDS, Job

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

PER_JOB = 100
JOBS_PER_ROUND = 10
"""So many jobs of one kind follow each other: a run that is ended early has tried all kinds."""


def jobs(n: int, kinds: Sequence[str], seed: int, *, is_judged: bool = True, first: int = 0) -> Iterator[Job]:
    """Share `n` cases out among the kinds, in jobs whose readable files are judged together."""
    of_kind = []
    for i, kind in enumerate(kinds):
        last = first + (n * (i + 1)) // len(kinds) - (n * i) // len(kinds)
        of_kind.append([Job(kind, seed, at, min(PER_JOB, last - at), is_judged) for at in range(first, last, PER_JOB)])
    for start in range(0, max(map(len, of_kind)), JOBS_PER_ROUND):
        for some in of_kind:
            yield from some[start : start + JOBS_PER_ROUND]


def logged(log: Path) -> tuple[list[Outcome], set[Job]]:
    """Return the outcomes of a log and the jobs that have ended in it."""
    outcomes: list[Outcome] = []
    ended: set[Job] = set()
    for line in filter(None, log.read_text(encoding="utf-8").splitlines() if log.exists() else ()):
        try:
            told = json.loads(line)
        except ValueError:
            continue  # its run was killed while it wrote
        ended.add(Job(*told["job"]))
        outcomes += [Outcome(*each) for each in told["outcomes"]]
    return outcomes, ended


def table(outcomes: Sequence[Outcome]) -> str:
    """Return how many cases of each kind came to which end."""
    counts = Counter((each.kind, each.outcome) for each in outcomes)
    shown = [name for name in (*GOOD, *BAD) if any(outcome == name for _, outcome in counts)]
    kinds = [kind for kind in KINDS if any(kind == each for each, _ in counts)]
    rows = [["kind", "cases", *shown]]
    rows += [
        [
            kind,
            str(len({each.number for each in outcomes if each.kind == kind})),
            *(str(counts[kind, name]) for name in shown),
        ]
        for kind in kinds
    ]
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return "\n".join("  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True)) for row in rows)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the cases and print the table and the bugs."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.fuzz", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("n", nargs="?", type=int, default=1000, help="how many files")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument(
        "--only", action="append", choices=KINDS, metavar="KIND", help=f"of {', '.join(KINDS)}; repeatable"
    )
    parser.add_argument("--first", type=int, default=0, help="the first number of each kind")
    parser.add_argument("--at", type=int, help="only this number of the one kind")
    parser.add_argument("--save", metavar="FOLDER", help="with --at: where its files are written")
    parser.add_argument(
        "--log", metavar="FILE", type=Path, help="where outcomes are written; a run goes on after those of it"
    )
    parser.add_argument("--read-only", action="store_true", help="read, and judge nothing")
    parser.add_argument("--time-limit", type=float, default=TIME_LIMIT_S, metavar="S", help="for each file")
    options = parser.parse_args(arguments)
    kinds = options.only or KINDS
    if options.at is None:
        work = list(jobs(options.n, kinds, options.seed, is_judged=not options.read_only, first=options.first))
    elif len(kinds) == 1:
        work = [Job(kinds[0], options.seed, options.at, 1, not options.read_only, options.save)]
    else:
        parser.error("--at needs one --only")
    outcomes, ended = logged(options.log) if options.log else ([], set())
    began = time.monotonic()
    with Driver(options.time_limit) as driver:
        for i, job in enumerate(work, 1):
            if job in ended:
                continue
            of_job = list(_print_outcomes(driver.run(job), print_all=options.at is not None))
            outcomes += of_job
            if options.log:
                with options.log.open("a", encoding="utf-8") as file:
                    file.write("\n" + json.dumps({"job": job, "outcomes": of_job}) + "\n")
            print(f"{i}/{len(work)} jobs, {time.monotonic() - began:.0f} s", end="\r", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    print(table(outcomes))
    return int(any(each.outcome in BAD for each in outcomes))


def _print_outcomes(outcomes: Iterator[Outcome], *, print_all: bool) -> Iterator[Outcome]:
    """Print outcomes that show a bug, or all, as they come."""
    for each in outcomes:
        if print_all or each.outcome in BAD:
            print(*each, sep=" | ", flush=True)
        yield each


if __name__ == "__main__":
    sys.exit(main())
