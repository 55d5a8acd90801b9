"""Names that are no text, and texts too long: the log is refused or its rules err, by name, and the others are judged."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet as pq
import pytest

from tests.fleet_report.command import ran
from tests.hostile.drive import OVERTAKE
from tests.hostile.readers import assert_quiet
from tests.hostile.words import TOO_LONG

RULE = ("--map", OVERTAKE / "road.xodr", "--mapping", OVERTAKE / "mapping.toml", "--rules", "ukhc.no-collision")
LOG = (OVERTAKE / "collision.csv").read_bytes()


@pytest.mark.ci
@pytest.mark.skipif(sys.platform != "linux", reason="file names are text here")
def test_a_file_name_that_is_no_text(tmp_path: Path) -> None:
    bad = Path(os.fsdecode(bytes(tmp_path) + b"/bad\xff.csv"))
    bad.write_bytes(LOG)
    (tmp_path / "good.csv").write_bytes(LOG)
    done = ran(
        "check", bad, tmp_path / "good.csv", *RULE, "--no-robustness", "--no-annotate", "--out", tmp_path / "out"
    )
    assert done.code == 1
    assert_quiet(done.out + done.err)
    status = pq.read_table(tmp_path / "out" / "drives.parquet").to_pydict()
    told = dict(zip(status["file_name"], status["status_reason"], strict=True))
    assert told.keys() == {"bad\\udcff.csv", "good.csv"}
    assert str(told["bad\\udcff.csv"]).endswith("its name is not UTF-8, which the result files require: rename it")
    for format_ in ("html", "junit", "sarif", "xqar", "markdown"):
        assert ran("report", tmp_path / "out", "--to", format_).code == 0
    road = Path(os.fsdecode(bytes(tmp_path) + b"/road\xff.xodr"))
    road.write_bytes((OVERTAKE / "road.xodr").read_bytes())
    done = ran("check", tmp_path / "good.csv", "--map", road, *RULE[2:])
    assert (done.code, done.err.endswith("rename it")) == (4, True)
    done = ran(
        "audit", tmp_path / "bad*.csv", "--map", OVERTAKE / "road.xodr", "--out", tmp_path / "audit", "--workers", 1
    )
    assert (done.code, done.err.endswith("rename it")) == (2, True)


def test_a_log_with_an_id_that_is_too_long_is_refused(tmp_path: Path) -> None:
    rows = pyarrow.csv.read_csv(OVERTAKE / "collision.csv").to_pydict()
    rows["actor"] = [TOO_LONG if name == "oncoming" else name for name in rows["actor"]]
    pq.write_table(pa.table(rows), tmp_path / "long.parquet")
    done = ran("check", tmp_path / "long.parquet", *RULE, "--no-robustness", "--no-annotate", "--out", tmp_path / "out")
    assert (done.code, "an actor's id of 100000 characters" in done.err, len(done.err) < 1000) == (4, True, True)
