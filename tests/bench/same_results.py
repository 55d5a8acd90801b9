"""`python -m tests.bench.same_results COMMIT [JOB]...`: are the results those of another commit, byte by byte?

Each job is a `check` without copies, in both trees, of logs of the reference data or of the project: its tables, report and JUnit file are
compared. Exit code 1 if one differs. A commit that judges otherwise on purpose shows where it does.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Final

from tests.bench import commit, traffic
from tests.shared_data import DATA, ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.bench.commit import Tree

COMPARED: Final = ("*.parquet", "junit.xml", "report.html")
_CHECK: Final = ("--no-robustness", "--no-cache", "--fail-on", "never", "--no-annotate", "--quiet")
_OSI, _CASE, _SCENES, _ROAD = (
    DATA / "osi",
    DATA / "overtake_case_study",
    ROOT / "fixtures/scenes",
    ROOT / "fixtures/overtake",
)
JOBS: Final[dict[str, tuple[str | Path, ...]]] = {
    "case study": (
        _CASE,
        "--map",
        _CASE / "t_junction.xodr",
        "--margins",
        "--profile",
        "relaxed",
        "--profile",
        "observed",
    ),
    "overtakes": (_ROAD, "--map", _ROAD / "road.xodr", "--mapping", _ROAD / "mapping.toml", "--margins"),
    "acc": (_OSI / "acc-test.osi", "--map", _OSI / "straight_500m.xodr", "--ego", "all", "--margins"),
    "pedestrian": (_OSI / "pedestrian.osi", "--map", _OSI / "fabriksgatan.xodr", "--ego", "all", "--margins"),
    "cut-in": (_OSI / "alks_cut-in.osi", "--ego", "all"),
    "merge": (_OSI / "highway_merge.osi", "--map", _OSI / "soderleden.xodr", "--handedness", "rht", "--ego", "all"),
    "light": (DATA / "esmini/light_state.csv", "--map", DATA / "maps/circle_300m.xodr", "--margins"),
    "film": (DATA / "video_case_study/detections.csv", "--mapping", "video-detections"),
    "Garching": (DATA / "commonroad/DEU_Gar-1_1_T-1.xml", "--ego", "all"),
    "Overtake": (DATA / "commonroad/OSC_Overtake-1_1_T-1.xml", "--ego", "all"),
    "Lanker": (DATA / "commonroad/USA_Lanker-1_1_T-1.xml", "--ego", "all"),
    "scenes": (_SCENES, "--map", _SCENES / "overtake-road.xodr"),
}
"""Name -> the arguments of `check`, which has all rules besides."""


def main(arguments: list[str]) -> int:
    """Compare, print a line per job, and return the exit code."""
    if not arguments or (unknown := set(arguments[1:]) - {*JOBS, "short", "one rule"}):
        raise SystemExit(
            f"{__doc__}\nJobs: {', '.join([*JOBS, 'short', 'one rule'])}" + (f"; not {unknown}" if arguments else "")
        )
    with tempfile.TemporaryDirectory(prefix="drivelint-same-") as home:
        trees = (commit.unpacked(arguments[0], Path(home)), commit.present())
        differing = 0
        for name, words in _jobs(Path(home)):
            if arguments[1:] and name not in arguments[1:]:
                continue
            if not Path(words[0]).exists():
                print(f"{name}: skipped, {words[0]} is not there")
                continue
            codes, results = zip(
                *(_check_result(tree, words, Path(home) / f"out{n}") for n, tree in enumerate(trees)), strict=True
            )
            wrong = sorted(
                file for file in results[0].keys() | results[1].keys() if results[0].get(file) != results[1].get(file)
            )
            if codes[0] != codes[1]:
                wrong.append(f"exit code {codes[0]}, {codes[1]}")
            print(
                f"{name}: {len(results[1])} files, {'same' if not wrong else 'differ: ' + ', '.join(wrong)}", flush=True
            )
            differing += bool(wrong) or not results[1]
    return int(differing > 0)


def _jobs(home: Path) -> Iterator[tuple[str, tuple[str | Path, ...]]]:
    for name, words in JOBS.items():
        yield name, (*words, "--rules", "all")
    road = home / "ring.xodr"
    road.write_text(traffic.ring(), encoding="utf-8")
    traffic.write_folder(home / "short" / "s0000", traffic.SHORT, 0)
    yield "short", (home / "short", "--map", road, "--rules", "ukhc", "--margins")
    yield "one rule", (home / "short", "--map", road, "--rules", "ukhc.no-collision")


def _check_result(tree: Tree, words: tuple[str | Path, ...], out: Path) -> tuple[int, dict[str, bytes]]:
    """Return the exit code of one check, and its files that are compared."""
    command = [tree.python, "-m", "drivelint", "check", *words, *_CHECK, "--out", out, "--overwrite"]
    done = subprocess.run(
        command,
        check=False,
        env={"PYTHONPATH": str(tree.source), "PATH": "/usr/bin:/bin"},
        cwd=out.parent,
        capture_output=True,
    )
    files = [file for pattern in COMPARED for file in out.glob(pattern)]
    found = {file.name: file.read_bytes() for file in files}
    for file in files:
        file.unlink()
    return done.returncode, found


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
