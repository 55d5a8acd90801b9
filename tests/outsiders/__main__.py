"""Print where product and outsiders differ, and write `fails.txt` anew: `python -m tests.outsiders`."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from tests.outsiders.judging import FAILS, judge

with TemporaryDirectory() as folder:
    judged = judge(Path(folder))
for (scene, rule), what in judged.differing().items():
    print(f"{scene} {rule}: expected {what}")
FAILS.write_text("".join(f"{line}\n" for line in judged.fails()), encoding="utf-8")
