"""`python -m tests.watch law [NAME ...]`, `... memory LOG MAP`: what a watch says of whole logs, and the memory that it takes.

`law`: every window of 30 s, judged each second with the looks before it, of the scenes and of the reference data's logs (those whose names
contain a NAME), held against `check`. `memory`: a log that is replayed as fast as it can be judged; megabytes now and then.
"""

from __future__ import annotations

import argparse
import resource
import sys
import threading
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from drivelint.engine.interruption import Interruption
from drivelint.errors import DriveLintError
from drivelint.watch.options import WatchOptions
from drivelint.watch.run import Watch
from drivelint.watch.sources.replay import Replay
from drivelint.watch.window import NS_PER_S
from tests.demo.scenes import all_scenes
from tests.false_alarms.count import REAL
from tests.shared_data import DATA, ROOT

from .prefixes import finding_keys, watch

if TYPE_CHECKING:
    from collections.abc import Iterator

SAMPLE_S = 20.0
SCENES = ROOT / "fixtures" / "scenes"


def logs() -> Iterator[tuple[str, WatchOptions, Path]]:
    """Return name, options and folder of every log of the law."""
    for scene in all_scenes():
        yield scene.name, WatchOptions(source=f"{scene.name}.mcap", map=SCENES / f"{scene.map_name}.xodr"), SCENES
    for name, (log, road, words) in REAL.items():
        if (DATA / log).exists():
            more: dict[str, Any] = {
                word.removeprefix("--"): value for word, value in zip(words[::2], words[1::2], strict=True)
            }
            yield name, WatchOptions(source=log, map=DATA / road if road else None, ego="all", **more), DATA


def law(names: list[str]) -> int:
    """Hold every log's windows against `check`; return 1 if one of them breaks the law."""
    sums: dict[str, int] = {}
    for name, options, folder in logs():
        if names and not any(part in name for part in names):
            continue
        begun_s = time.perf_counter()
        try:
            watched = watch(options, folder)
        except DriveLintError as error:
            print(f"{name}: not judged: {error}", flush=True)
            continue
        refused = [str(each) for each in watched.windows if isinstance(each, DriveLintError)]
        counts = {
            "logs": 1,
            "windows": len(watched.windows),
            "refused windows": len(refused),
            "alarms": len(watched.alarms),
            "early": sum(alarm.is_early for alarm in watched.alarms),
            "withdrawn": len(watched.withdrawn),
            "false": len(watched.false),
            "findings": len(watched.findings),
            "missed": len(watched.missed),
            "settled": watched.settled,
            "revised": len(watched.revised),
        }
        sums = {key: sums.get(key, 0) + n for key, n in counts.items()}
        print(f"{name}: {_in_words(counts)}; {time.perf_counter() - begun_s:.0f} s", flush=True)
        for kind, rows in (
            ("refused", sorted(set(refused))),
            ("withdrawn", finding_keys([alarm.row for alarm in watched.withdrawn])),
            ("false", finding_keys([alarm.row for alarm in watched.false])),
            ("missed", finding_keys(watched.missed)),
            ("revised", watched.revised),
        ):
            for row in rows:
                print(f"  {kind}: {row}", flush=True)
    print(f"all: {_in_words(sums)}")
    return int(sums.get("false", 0) + sums.get("missed", 0) + sums.get("revised", 0) > 0)


def _in_words(counts: dict[str, int]) -> str:
    return ", ".join(f"{n} {what}" for what, n in counts.items())


def memory(log: Path, road: Path, window_s: float, every_s: float) -> int:
    """Watch a log without looking at what is said; print the process's memory now and then."""
    options = WatchOptions(source=str(log), map=road, window_s=window_s, every_s=every_s, robustness=False)
    source = Replay(log, options.ingest_options(), speed=0, every_ns=round(every_s * NS_PER_S))
    over = threading.Event()
    with Watch(options, source, lambda _message: None, Interruption()) as watching:

        def sample() -> None:
            while not over.wait(SAMPLE_S):
                now_mb = int(Path("/proc/self/statm").read_text("utf-8").split()[1]) * resource.getpagesize() / 1e6
                print(f"{len(watching.watched.busy_s)} windows: {now_mb:.0f} MB", flush=True)

        sampler = threading.Thread(target=sample)
        sampler.start()
        try:
            watched = watching.watch()
        finally:
            over.set()
            sampler.join()
    print(watched.timing_text())
    return 0


def main() -> int:
    """Hold the law, or measure memory."""
    parser = argparse.ArgumentParser(prog="python -m tests.watch", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    lawful = commands.add_parser("law")
    lawful.add_argument("names", nargs="*")
    measured = commands.add_parser("memory")
    measured.add_argument("log", type=Path)
    measured.add_argument("map", type=Path)
    measured.add_argument("--window", type=float, default=60.0)
    measured.add_argument("--every", type=float, default=55.0)
    asked = parser.parse_args()
    if asked.command == "law":
        return law(asked.names)
    return memory(asked.log, asked.map, asked.window, asked.every)


if __name__ == "__main__":
    sys.exit(main())
