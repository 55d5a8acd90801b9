"""Another commit of this repository against the present tree, on the same inputs and in one run.

The present tree generates the inputs. Both trees check them in turn, each time in a process of its own, without annotated logs. A row
is a stage: the CPU seconds of now over those of before; below 1, the present tree is faster. `ingest` is the wait for the threads
that read, with the CPU of all threads meanwhile. Both trees run all the rules that they have, so a new rule costs what it costs.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from tests.bench import commit, timed_check, traffic
from tests.bench.clock import Span, median
from tests.bench.table import Row
from tests.bench.timed_check import Job, Timed
from tests.shared_data import DATA, ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.bench.commit import Tree
    from tests.bench.place import Place

DENSE = "USA_US101-*_T-1.xml"


class Input(NamedTuple):
    """What both trees check. `rules`: empty for all."""

    name: str
    traces: Path
    road: Path | None
    rules: tuple[str, ...] = ("ukhc",)
    ego: str | None = None


def before(place: Place) -> list[Row]:
    """Measure every input in both trees. Errors: those of `commit.unpacked`; `RuntimeError` if a tree's process fails."""
    then = commit.unpacked(place.commit, place.home)
    trees = {"now": commit.present(), "before": then}
    runs = place.sizes.runs
    rows = [_about(trees["now"], then, runs)]
    for no, each in enumerate(_inputs(place)):
        print(f"before: {each.name} (load {os.getloadavg()[0]:.1f}) ...", file=sys.stderr, flush=True)
        if no == 0 and runs > 1:  # so that no tree is compiled while its time counts
            for tree in trees.values():
                _timed(tree, each, place.home)
        timings: dict[str, list[Timed]] = {side: [] for side in trees}
        for _ in range(runs):
            for side, tree in trees.items():
                timings[side].append(_timed(tree, each, place.home))
        rows += _compared(f"{then.name}, {each.name}", timings)
    return rows


def _inputs(place: Place) -> Iterator[Input]:
    yield Input("reference drive", place.reference, place.road)
    folder = place.home / "many"
    for n in range(place.sizes.drives):
        traffic.write_folder(folder / f"s{n:04d}", place.sizes.short, n)
    yield Input(f"{place.sizes.drives} short drives", folder, place.road)
    dense = densest(DATA / "commonroad")
    if dense:
        yield Input(f"{dense.stem}, every ego", dense, None, rules=(), ego="all")
    else:
        print(f"skipped: before: no {DENSE} in {DATA / 'commonroad'}", file=sys.stderr, flush=True)


def densest(folder: Path) -> Path | None:
    """Return the US101 scenario of the most states; of several, the first by name. None: there is none."""
    found = sorted(folder.glob(DENSE))
    return max(found, key=lambda path: path.read_bytes().count(b"<state>"), default=None)


def _timed(tree: Tree, drive_input: Input, home: Path) -> Timed:
    """Check in a process of its own that imports `drivelint` from the tree, and this bench from the present one."""
    asked, answer = home / "job.json", home / "answer.json"
    job = Job(
        source=str(tree.source),
        answer=str(answer),
        out=str(home / "out"),
        traces=[str(drive_input.traces)],
        map=None if drive_input.road is None else str(drive_input.road),
        rules=list(drive_input.rules),
        ego=drive_input.ego,
    )
    asked.write_text(json.dumps(job._asdict()), encoding="utf-8")
    answer.unlink(missing_ok=True)
    # both trees keep their bytecode in the same place, whether or not they lie where it may be written
    env = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
    env |= {"PYTHONPATH": os.pathsep.join((str(tree.source), str(ROOT))), "PYTHONPYCACHEPREFIX": str(home / "bytecode")}
    command = [str(tree.python), "-P", "-m", timed_check.__name__, str(asked)]
    done = subprocess.run(command, cwd=home, env=env, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{tree.name}, {drive_input.name}: {done.stderr.strip()}")
    told = json.loads(answer.read_text(encoding="utf-8"))
    return Timed({stage: Span(*seconds) for stage, seconds in told["spent"].items()}, told["verdicts"])


def _about(now: Tree, then: Tree, runs: int) -> Row:
    environment = (
        f"an environment of its own, for {', '.join(then.differs)}" if then.differs else "the present environment"
    )
    note = (
        f"{then.name} in {environment}; below: CPU seconds of {now.name} / of {then.name}, in turn, medians of {runs}"
    )
    return Row(f"before {then.name}", "dependencies that differ", len(then.differs), "", note=note)


def _compared(section: str, timings: dict[str, list[Timed]]) -> list[Row]:
    now, then = (
        {stage: median([timed.spent[stage] for timed in timings[side]]) for stage in timings[side][0].spent}
        for side in ("now", "before")
    )
    rows = [
        Row(
            section,
            stage,
            _ratio(spent.cpu, then[stage].cpu),
            "x",
            cpu=spent.cpu,
            note=f"CPU {then[stage].cpu:.2f} s before; wall {spent.wall:.2f} s, before {then[stage].wall:.2f} s:"
            f" {_ratio(spent.wall, then[stage].wall):.2f} x",
        )
        for stage, spent in now.items()
    ]
    counts, old = timings["now"][0].verdicts, timings["before"][0].verdicts
    note = f"now {_counts_text(counts)}; before {_counts_text(old)}"
    return [*rows, Row(section, "verdicts", _ratio(sum(counts.values()), sum(old.values())), "x", note=note)]


def _counts_text(verdicts: dict[str, int]) -> str:
    return ", ".join(f"{n} {verdict}" for verdict, n in sorted(verdicts.items())) or "none"


def _ratio(now: float, then: float) -> float:
    return now / then if then else float("nan")
