"""Print where product and outsiders differ, and write `fails.txt` anew: `python -m tests.outsiders`."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from tests.outsiders.judging import FAILS, PERSONS, judge

fails = []
for person in PERSONS:
    with TemporaryDirectory() as folder:
        judged = judge(person, Path(folder))
    for (scene, rule), what in judged.differing().items():
        print(f"{scene} {rule}: expected {what}", flush=True)
    fails += judged.fails()
FAILS.write_text("".join(f"{line}\n" for line in sorted(fails)), encoding="utf-8")
