"""What users wait for at the command line: the demo, one drive, one rule, a fleet. CPU of whole processes, and of another commit beside it.

Every command runs in turn with the others, each in a process of its own, with a cache folder of the bench; the commands of another
commit (`--against`) run between those of the present tree.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from typing import TYPE_CHECKING, NamedTuple

from tests.bench import commit, traffic
from tests.bench.clock import Span, median
from tests.bench.table import Bar, Row

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from tests.bench.commit import Tree
    from tests.bench.place import Place

NOW, BEFORE = "now", "before"
ONE_RULE = "ukhc.r126.thinking-gap"


class ProcessCost(NamedTuple):
    """What one process took. `peak`: the most memory in bytes, of the largest process."""

    span: Span
    peak: float


def demo(place: Place) -> list[Row]:
    """Measure the commands of a first quarter of an hour, on the six drives of the demo."""
    folder = place.home / "demo"
    _run(commit.present(), ["demo", "--out", str(folder)], place.home)
    logs, road = sorted(map(str, folder.glob("*.mcap"))), ["--map", str(folder / "road.xodr")]
    out = ["--out", str(place.home / "out"), "--overwrite"]
    plain = ["--no-robustness", "--no-cache", "--no-annotate"]
    costs = _in_turn(
        place,
        {
            "check": ["check", *logs, *road, *out, "--no-cache"],
            "check, no copies": ["check", *logs, *road, *out, "--no-cache", "--no-robustness"],
            "check again": ["check", *logs, *road, *out],
            "one drive": ["check", logs[0], *road, *plain],
            "one rule, one drive": ["check", logs[0], *road, *plain, "--rules", ONE_RULE],
            "rules list": ["rules", "list"],
            "inspect": ["inspect", logs[0], *road],
        },
        place.sizes.runs,
    )
    cpu = {name: median([each.span for each in each_side[NOW]]).cpu for name, each_side in costs.items()}
    return [
        Row("demo", "check with defaults", cpu["check"], bar=Bar(5.0), note="CPU"),
        Row("demo", "defaults / no copies", cpu["check"] / cpu["check, no copies"], "x", bar=Bar(1.5), note="CPU"),
        Row("demo", "second check / first", cpu["check again"] / cpu["check"], "x", bar=Bar(0.1), note="CPU"),
        *_rows("demo", costs, {"one drive": 0.5, "one rule, one drive": 0.35, "rules list": 0.5, "inspect": 0.5}),
    ]


def fleet(place: Place) -> list[Row]:
    """Measure many short drives: copies, two workers, memory."""
    folder = place.home / "fleet"
    for n in range(place.sizes.fleet):
        traffic.write_folder(folder / f"s{n:04d}", place.sizes.short, n)
    check = ["check", str(folder), "--map", str(place.road), "--rules", "ukhc.*", "--no-cache", "--no-annotate"]
    out = ["--out", str(place.home / "out"), "--overwrite"]
    costs = _in_turn(
        place,
        {
            "check": [*check, *out],
            "check, no copies": [*check, *out, "--no-robustness"],
            "two workers": [*check, *out, "--no-robustness", "-j", "2"],
            "one worker": [*check, *out, "--no-robustness", "-j", "1"],
        },
        max(1, place.sizes.runs // 3),  # each takes half a minute
    )
    span = {name: median([each.span for each in each_side[NOW]]) for name, each_side in costs.items()}
    peak = max(each.peak for each in costs["check"][NOW])
    workers = span["one worker"].wall / span["two workers"].wall
    return [
        Row(
            "fleet",
            "defaults / no copies",
            span["check"].cpu / span["check, no copies"].cpu,
            "x",
            bar=Bar(1.5),
            note="CPU",
        ),
        Row("fleet", "two workers are faster", workers, "x", bar=Bar(1.7, at_least=True), note="wall"),
        Row("fleet", "peak memory", peak / 1e9, "GB", bar=Bar(0.8), note=f"{place.sizes.fleet} drives, defaults"),
        *_rows("fleet", costs, {"check, no copies": 0.5}),
    ]


def _in_turn(
    place: Place, commands: Mapping[str, Sequence[str]], rounds: int
) -> dict[str, dict[str, list[ProcessCost]]]:
    """Return name -> side -> what each round took, after one that does not count; a single one is not warmed up for."""
    trees = {NOW: commit.present()}
    if place.commit != "HEAD":
        trees[BEFORE] = commit.unpacked(place.commit, place.home)
    costs: dict[str, dict[str, list[ProcessCost]]] = {name: {side: [] for side in trees} for name in commands}
    for no in range(rounds + (rounds > 1)):
        for name, arguments in commands.items():
            for side, tree in trees.items():
                if side == BEFORE and "-j" in arguments:
                    continue  # an older `check` has one worker, and no such option
                found = _run(tree, arguments, place.home)
                if no or rounds == 1:
                    costs[name][side].append(found)
    return costs


def _run(tree: Tree, arguments: Sequence[str], home: Path) -> ProcessCost:
    """Run drivelint of a tree. Errors: `RuntimeError` with its message if it ends as no check ends."""
    shutil.rmtree(home / "out", ignore_errors=True)
    known = [word for word in arguments if tree == commit.present() or word != "--no-cache"]
    env = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
    env |= {"PYTHONPATH": str(tree.source), "PYTHONPYCACHEPREFIX": str(home / "bytecode")}
    env |= {"DRIVELINT_CACHE_DIR": str(home / "cache" / tree.name)}
    begin = time.perf_counter()
    with (home / "stderr").open("wb") as errors:
        process = subprocess.Popen(
            [str(tree.python), "-m", "drivelint", *known], cwd=home, env=env, stdout=subprocess.DEVNULL, stderr=errors
        )
        _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode not in {0, 1, 3, 4}:
        told = (home / "stderr").read_text(encoding="utf-8").strip()
        raise RuntimeError(f"{tree.name}: drivelint {' '.join(known[:2])} ended with {process.returncode}: {told}")
    wall = time.perf_counter() - begin
    # the children of the process are in its times, if it waited for them; ru_maxrss is of the largest
    return ProcessCost(Span(wall, used.ru_utime + used.ru_stime), used.ru_maxrss * 1024)


def _rows(section: str, costs: Mapping[str, Mapping[str, list[ProcessCost]]], bars: Mapping[str, float]) -> list[Row]:
    """Return a row per command: the time of now, or, with another commit, the ratio to it."""
    rows = []
    for name, sides in costs.items():
        spans = {side: median([each.span for each in runs]) for side, runs in sides.items() if runs}
        if not sides.get(BEFORE):
            rows.append(Row(section, name, spans[NOW].wall, cpu=spans[NOW].cpu))
            continue
        ratio = spans[NOW].cpu / spans[BEFORE].cpu
        note = f"CPU {spans[BEFORE].cpu:.2f} s before; wall {spans[NOW].wall:.2f} s, before {spans[BEFORE].wall:.2f} s"
        bar = Bar(bars[name]) if name in bars else None
        rows.append(Row(section, name, ratio, "x", cpu=spans[NOW].cpu, bar=bar, note=note))
    return rows


if __name__ == "__main__":
    from tests.bench.__main__ import main

    main(["demo", "fleet", *sys.argv[1:]])
