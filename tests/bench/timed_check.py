"""One check of the `drivelint` that this process imports, timed by stage: `python -P -m tests.bench.timed_check JOB.json`.

It runs on another commit's sources too, so it imports nothing of `drivelint` by name: each stage has the names that its function had,
the newest first. A stage without a function, or whose function was never called, ends the process with the stage's name.
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from functools import reduce
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

from tests.bench.clock import Span, Stages, now

Names = tuple[tuple[str, str], ...]
"""(module, function) candidates, newest first."""

OPTIONS: Names = (("drivelint.run", "CheckOptions"), ("drivelint.run", "Settings"))
CHECK: Names = (("drivelint.run", "check"),)
SILENT: Names = (("drivelint.report.progress", "Silent"),)
WRITE: Names = (("drivelint.report.outputs", "write"),)

# each is the name under which the caller calls the function: replacing the definition would not reach an import by name
WATCHED: tuple[tuple[str, Names], ...] = (
    (
        "ingest",  # waiting for the threads that read
        (
            ("drivelint.engine.batch", "_drive_when_read"),
            ("drivelint.engine.batch", "_wait_for"),
            ("drivelint.engine.batch", "_drive"),
            ("drivelint.batch", "_drive"),
        ),
    ),
    ("map", (("drivelint.engine.map_library", "MapLibrary.find"), ("drivelint.maps.library", "MapLibrary.find"))),
    ("derive", (("drivelint.engine.session", "derive"), ("drivelint.judge", "derive"))),
    ("rules", (("drivelint.engine.session", "evaluate"), ("drivelint.judge", "evaluate"))),
    ("report", (("drivelint.result.evidence", "gather"), ("drivelint.report.evidence", "gather"))),
    ("report", (("drivelint.report.html", "render"),)),
    ("report", (("drivelint.report.junit", "render"),)),
)
REST, WHOLE = "the rest", "to the verdict tables"


class Job(NamedTuple):
    """What one process checks. `source`: the folder that `drivelint` must come from; `answer`: the file to write."""

    source: str
    answer: str
    out: str
    traces: list[str]
    map: str | None
    rules: list[str]
    ego: str | None


class Timed(NamedTuple):
    """Seconds by the clock and of CPU by stage, and how many verdicts there are of each kind."""

    spent: dict[str, Span]
    verdicts: dict[str, int]


class StageError(Exception):
    """A stage that cannot be measured in these sources."""


def owner_of(role: str, names: Names) -> tuple[Any, str]:
    """Return the object that has the first of the names that exists, and the attribute's name. Errors: `StageError`."""
    for module, name in names:
        *path, last = name.split(".")
        try:
            owner = reduce(getattr, path, import_module(module))
        except (AttributeError, ModuleNotFoundError):
            continue
        if callable(getattr(owner, last, None)):
            return owner, last
    raise StageError(f"no function for {role!r}: none of {', '.join(f'{m}.{n}' for m, n in names)} is there")


def timed_check(job: Job, watched: tuple[tuple[str, Names], ...] = WATCHED) -> Timed:
    """Check drives and write the outputs. Errors: `StageError` if a stage has no function or its function was never called."""
    check, write, options, silent = (
        getattr(*owner_of(role, names))
        for role, names in (("check", CHECK), ("write", WRITE), ("options", OPTIONS), ("progress", SILENT))
    )
    found = [(stage, *owner_of(stage, names)) for stage, names in watched]
    keys = [f"{no} {name}" for no, (_, _, name) in enumerate(found)]
    out = Path(job.out)
    asked = options(
        traces=tuple(job.traces),
        map=None if job.map is None else Path(job.map),
        out=out,
        rules=tuple(job.rules),
        ego=job.ego,
        fail_on="never",
        annotate=False,
    )
    stages = Stages()
    begin = now()
    with stages.watch(*((owner, name, key) for (_, owner, name), key in zip(found, keys, strict=True))):
        result = check(asked, silent())
        write(result, out)
    whole = now() - begin
    spent: dict[str, Span] = {}
    for (stage, owner, name), key in zip(found, keys, strict=True):
        if key not in stages.spent:
            raise StageError(f"the function of {stage!r}, {owner.__name__}.{name}, was never called")
        spent[stage] = spent.get(stage, Span()) + stages.spent[key]
    whole -= spent.pop("report", Span())
    spent[REST] = whole - sum(spent.values(), Span())
    spent[WHOLE] = whole
    return Timed(spent, dict(Counter(result.verdicts["verdict"].to_pylist())))


def main(arguments: list[str]) -> None:
    """Run the job of a file, and write what it took into the job's answer."""
    job = Job(**json.loads(Path(arguments[0]).read_text(encoding="utf-8")))
    package = import_module("drivelint").__file__
    if package is None or Path(job.source).resolve() not in Path(package).resolve().parents:
        raise SystemExit(f"drivelint is imported from {package}, not from {job.source}")
    try:
        timed = timed_check(job)
    except StageError as error:
        raise SystemExit(f"{job.source}: {error}") from error
    Path(job.answer).write_text(json.dumps(timed._asdict()), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
