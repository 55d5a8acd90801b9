"""`drivelint.check`: the options and the bytes of the command line, errors that can be caught, and no exit."""

from __future__ import annotations

import inspect
import json
import os
import re
import signal
import subprocess
import sys
import traceback
from contextlib import suppress
from datetime import date
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import shapely
import typer

import drivelint
from drivelint import cli, demo
from drivelint.pack import VerifyRequest, verify
from drivelint.result.names import TABLE_OF_FILE
from tests.report import synthetic
from tests.shared_data import ROOT

PRINTING = {"format_", "report", "verbose", "quiet", "cache", "jobs", "help"}
"""Options of the command line alone: what it prints and keeps, and by how many processes."""
NAMES = {"map_": "map", "sensor_range_m": "sensor_range"}
"""Parameters of the command line -> keywords, where they differ."""


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("demo")
    demo.write(folder)
    return folder


@pytest.fixture(scope="module")
def check_result(drives: Path) -> drivelint.CheckResult:
    logs = [drives / "near-miss.mcap", drives / "safe.mcap"]
    return drivelint.check(logs, map=drives / "road.xodr", robustness=False)  # the slow tests have copies


def command_line(*args: object, code: int) -> None:
    env = {**os.environ, "PYTHONPATH": str(ROOT / "src")}
    line = [sys.executable, "-m", "drivelint", *map(str, args)]
    done = subprocess.run(line, check=False, capture_output=True, text=True, timeout=120, env=env)
    assert done.returncode == code, done.stderr


def files(folder: Path) -> dict[str, bytes]:
    return {str(f.relative_to(folder)): f.read_bytes() for f in sorted(folder.rglob("*")) if f.is_file()}


def test_the_keywords_are_the_options_with_their_defaults() -> None:
    (command,) = (c for name, c in typer.main.get_command(cli.app).commands.items() if name == "check")  # type: ignore[attr-defined]
    options = {p.opts[0].lstrip("-").replace("-", "_"): p for p in command.params if p.name not in PRINTING}
    keywords = inspect.signature(drivelint.check).parameters
    assert set(keywords) - {"progress"} == {"traces" if name == "TRACE" else name for name in options}
    for name, option in options.items():
        if name != "traces":
            assert (keywords[name].default or None) == (option.default or None), name


@pytest.mark.slow
def test_write_writes_the_bytes_of_the_command_line(
    check_result: drivelint.CheckResult, drives: Path, tmp_path: Path
) -> None:
    said = [drives / "near-miss.mcap", drives / "safe.mcap", "--map", drives / "road.xodr"]
    command_line("check", *said, "--out", tmp_path / "a", "--no-annotate", "--no-robustness", code=1)
    assert check_result.write(tmp_path / "b") == tmp_path / "b"
    theirs, ours = files(tmp_path / "a"), files(tmp_path / "b")
    assert set(theirs) >= {f"{name}.parquet" for name in TABLE_OF_FILE} | {"report.html", "run.json", "summary.json"}
    assert theirs == ours


@pytest.mark.ci
def test_evidence_is_a_pack_of_the_result(drives: Path, tmp_path: Path) -> None:
    asked: dict[str, Any] = {"map": drives / "road.xodr", "rules": "ukhc.no-collision", "robustness": False}
    pack = tmp_path / "pack"
    drivelint.check(drives / "safe.mcap", **asked, out=tmp_path / "out", evidence=pack)
    told = verify(VerifyRequest(pack, traces=(drives / "safe.mcap",), map=drives / "road.xodr"))
    assert told.problems == []
    assert "1 drive judged again" in told.sentence
    with pytest.raises(drivelint.DriveLintError, match="use out=, too"):
        drivelint.check(drives / "safe.mcap", **asked, evidence=tmp_path / "none")


@pytest.mark.slow
def test_out_writes_all_that_the_command_line_writes(drives: Path, tmp_path: Path) -> None:
    """With every kind of option: the logs with their verdicts, each judged step, a baseline, waivers."""
    waivers = tmp_path / "waivers.toml"
    waivers.write_text(
        '[[waiver]]\nrule = "ukhc.r162.*"\nreason = "known"\nowner = "me"\nexpires = 2027-03-31\n', encoding="utf-8"
    )
    log, road, base = drives / "collision.mcap", drives / "road.xodr", tmp_path / "base"
    rules = ["ukhc.r162.*", "ukhc.no-collision", "ukhc.r126.thinking-gap"]
    drivelint.check(drives / "safe.mcap", map=road, rules=rules, out=base)
    said = [part for rule in rules for part in ("--rules", rule)]
    said += ["--profile", "nominal", "--fail-on", "major", "--env", "nation=gb", "--env", "engaged=yes", "--margins"]
    said += ["--map-offset", "0.5,0.25", "--ego-size", "4.5,1.8", "--memory", "1GB", "--today", "2027-01-01"]
    said += ["--param", "ukhc.r126.thinking-gap.settle_s=8"]
    files_of_gate = ["--baseline", base, "--waivers", waivers]
    command_line("check", log, "--map", road, *said, *files_of_gate, "--out", tmp_path / "a", code=1)
    found = drivelint.check(
        str(log),
        map=str(road),
        rules=rules,
        profile="nominal",
        param={"ukhc.r126.thinking-gap.settle_s": 8},
        fail_on="major",
        env={"nation": "gb", "engaged": True},
        map_offset=(0.5, 0.25),
        ego_size=(4.5, 1.8),
        margins=True,
        memory="1GB",
        baseline=str(base),
        waivers=waivers,
        today=date(2027, 1, 1),
        out=tmp_path / "b",
    )
    theirs, ours = files(tmp_path / "a"), files(tmp_path / "b")
    assert {"gate.json", "margins.parquet", "annotated/viewer-layout.json"} <= set(theirs)
    assert theirs == ours
    assert found.exit_code == 1
    assert found.margins is not None
    assert len(found.margins) == found.sql("SELECT count(*) AS n FROM margins").rows()[0]["n"] > 0

    opened = drivelint.open(tmp_path / "b")
    assert (opened.exit_code, opened.why) == (found.exit_code, found.why)
    kept = {name for name in theirs if not name.startswith("annotated")}
    written = files(opened.write(tmp_path / "c"))
    assert written.keys() == kept
    # what says which files are there differs: the logs with their verdicts are not
    assert [name for name in sorted(kept) if written[name] != theirs[name]] == ["files.json", "report.html"]
    links = re.compile(rb'<a href="annotated/[^"]+">[^<]+</a>(<br>)?')
    assert links.sub(b"", theirs["report.html"]) == written["report.html"] != theirs["report.html"]
    assert json.loads(written["files.json"])["written_by_drivelint"] == sorted(kept - {"files.json"})
    assert files(opened.write(tmp_path / "b")) == theirs, "into its own folder"


@pytest.mark.ci
def test_a_margin_says_its_time_its_unit_and_its_finding(drives: Path) -> None:
    log = drives / "collision.mcap"
    rules = ["ukhc.no-collision", "ukhc.r126.*", "ukhc.r103.signal-means-go", "ukhc.r162.safe-distance-ahead"]
    found = drivelint.check(log, map=drives / "road.xodr", rules=rules, margins=True, robustness=False)
    assert found.margins is not None
    steps, findings = found.margins.rows(), {row["finding_id"]: row for row in found.findings}
    (start_ns,) = (row["t_start_ns"] for row in found.drives)
    units = {row["rule_id"]: row["unit"] for row in found.rules}
    same = ("drive_id", "ego_id", "rule_id", "profile", "ref_id")
    for step in steps:
        assert step["t_s"] == pytest.approx((step["t_ns"] - start_ns) / 1e9, abs=1e-9)
        assert step["unit"] == units[step["rule_id"]]
        if step["finding_id"] is not None:
            finding = findings[step["finding_id"]]
            assert step["holds"] is False
            assert [step[key] for key in same] == [finding[key] for key in same]
            assert finding["t_start_s"] <= step["t_s"] <= finding["t_end_s"]
    for finding in findings.values():
        mine = {step["t_ns"]: step for step in steps if step["finding_id"] == finding["finding_id"]}
        assert {min(mine), max(mine)} == {finding["t_start_ns"], finding["t_end_ns"]}
        worst = mine[finding["t_worst_ns"]]
        assert (worst["object_id"], worst["margin"]) == (finding["object_id"], finding["margin"])
    # a window in which one step suffices may have others that fail
    without = {step["rule_id"] for step in steps if step["holds"] is False and step["finding_id"] is None}
    assert without == {"ukhc.r103.signal-means-go"}
    assert found.margins.describe().rows()[-1]["meaning"].startswith("the finding to which this failing step belongs")


def test_the_tables_are_those_of_the_files(check_result: drivelint.CheckResult, tmp_path: Path) -> None:
    folder = check_result.write(tmp_path / "out")
    opened = drivelint.open(str(folder))
    for name in TABLE_OF_FILE:
        ours, theirs = getattr(check_result, name), getattr(opened, name)
        assert ours.arrow().equals(theirs.arrow())
        assert ours is check_result.tables[name]
        assert len(ours) == pq.read_metadata(folder / f"{name}.parquet").num_rows
    assert len(check_result.verdicts)
    assert check_result.exit_code == 1
    assert opened.report() == check_result.report() == (folder / "report.html").read_text("utf-8")


def test_a_table_is_arrow_polars_and_pandas(check_result: drivelint.CheckResult) -> None:
    table = check_result.findings
    arrow = table.arrow()
    assert pa.table(table).equals(arrow)
    assert table.pl().to_arrow().column("finding_id").to_pylist() == arrow["finding_id"].to_pylist()
    pytest.importorskip("pandas")
    assert table.df()["finding_id"].tolist() == [row["finding_id"] for row in table.rows()]
    assert table.columns == tuple(arrow.column_names)
    assert "finding_id" in repr(table)


def test_a_table_gives_columns_and_rows(check_result: drivelint.CheckResult) -> None:
    table = check_result.findings
    assert table["margin"].to_list() == table.arrow()["margin"].to_pylist()
    assert list(table) == table.rows()
    with pytest.raises(KeyError, match="did you mean 'margin'"):
        table["margn"]


def test_geometries_are_those_of_the_files(check_result: drivelint.CheckResult, tmp_path: Path) -> None:
    geopandas = pytest.importorskip("geopandas")
    folder = check_result.write(tmp_path / "out")
    for name in ("findings", "lanes", "tracks"):
        mine, theirs = getattr(check_result, name).geo(), geopandas.read_parquet(folder / f"{name}.parquet")
        assert len(mine) > 0
        assert mine.geometry.name == "geom"
        assert mine.geometry.geom_equals(theirs.geometry).all()
    with pytest.raises(drivelint.DriveLintError, match="has no geometry"):
        check_result.verdicts.geo()


def test_a_timeline_has_what_the_log_and_the_rule_say(check_result: drivelint.CheckResult, tmp_path: Path) -> None:
    (found,) = [
        row
        for row in check_result.findings
        if row["rule_id"].endswith("ds-disjoint") and row["drive_id"].startswith("near")
    ]
    table = check_result.timeline(found["finding_id"])
    rows = {row["t_ns"]: row for row in table}
    assert list(rows) == sorted(rows)
    worst = rows[found["t_worst_ns"]]
    assert [worst[name] for name in ("observed", "required", "margin")] == [
        found[name] for name in ("observed", "required", "margin")
    ]
    assert worst["ego_speed_mps"] == pytest.approx(5.22, abs=0.01)
    # both drive towards each other at the same speed
    told = sorted((row["t_s"], row["gap_m"]) for row in rows.values() if row["gap_m"] is not None and row["t_s"] < 9)
    (t0, gap0), (t1, gap1) = told[0], told[-1]
    assert (gap0 - gap1) / (t1 - t0) == pytest.approx(2 * 5.22, rel=0.05)
    drawn = table.plot()
    assert drawn is not None
    assert "<iframe" in drawn._repr_html_()
    assert "m.strips" not in drawn.save(tmp_path / "t.html").read_text(encoding="utf-8")


@pytest.mark.slow
def test_an_explanation_is_that_of_the_command_line(
    check_result: drivelint.CheckResult, drives: Path, tmp_path: Path
) -> None:
    name = check_result.sql("SELECT finding_id FROM findings WHERE rule_id = 'ukhc.r162.safe-distance-ahead'").rows()[
        0
    ]["finding_id"]
    told = check_result.explain(name)
    folder = check_result.write(tmp_path / "out")
    env = {**os.environ, "PYTHONPATH": str(ROOT / "src")}
    line = [sys.executable, "-m", "drivelint", "explain", name, "--in", str(folder)]
    done = subprocess.run(line, check=True, capture_output=True, text=True, timeout=120, env=env)
    assert told.text.strip() == done.stdout.strip()
    assert told.data()["verdict"]["finding_id"] == name
    assert told._repr_html_().startswith("<pre>")
    assert "font-family: monospace" in told._repr_html_(), "the page of a notebook may have another font for <pre>"
    with pytest.raises(drivelint.DriveLintError, match="nowhere"):
        check_result.explain("nowhere")


@pytest.mark.slow
def test_a_comparison_is_that_of_the_command_line(drives: Path, tmp_path: Path) -> None:
    road = drives / "road.xodr"
    for run, name in (("base", "safe"), ("new", "near-miss")):
        drivelint.check(
            drives / f"{name}.mcap", map=road, rules="ukhc.r162.*", out=tmp_path / run, annotate=False, robustness=False
        )
    env = {**os.environ, "PYTHONPATH": str(ROOT / "src")}
    line = [sys.executable, "-m", "drivelint", "diff", str(tmp_path / "base"), str(tmp_path / "new"), "--format"]
    text, data = (
        subprocess.run([*line, form], check=False, capture_output=True, text=True, timeout=60, env=env)
        for form in ("text", "json")
    )
    new = drivelint.open(tmp_path / "new")
    found = drivelint.diff(tmp_path / "base", new)
    assert (found.text, found.exit_code) == (text.stdout.rstrip("\n"), text.returncode)
    assert found.data() == json.loads(data.stdout)
    assert {row["finding_id"] for row in found.findings() if row["standing"] == "new"} <= set(
        new.findings["finding_id"]
    )


def test_the_demo_is_that_of_the_command_line(tmp_path: Path) -> None:
    paths = drivelint.write_demo(tmp_path / "demo")
    assert {path.name: path.read_bytes() for path in paths} == demo.contents()


def test_sql_reads_the_tables_by_name(check_result: drivelint.CheckResult) -> None:
    query = "SELECT drive_id, count(*) AS n FROM findings JOIN rules USING (rule_id) WHERE severity = $s GROUP BY ALL ORDER BY ALL"
    (row,) = check_result.sql("SELECT count(*) AS n FROM findings WHERE severity = ?", ["critical"]).rows()
    named = check_result.sql(query.replace("severity", "findings.severity"), {"s": "critical"})
    assert sum(each["n"] for each in named.rows()) == row["n"] > 0


def test_columns_of_one_name_are_told_apart(check_result: drivelint.CheckResult) -> None:
    """polars takes no two of one name, and a dictionary has one."""
    joined = check_result.sql(
        "SELECT * FROM findings f JOIN drives d USING (drive_id) JOIN findings g USING (drive_id)"
    )
    names = joined.arrow().column_names
    assert {"t_start_ns", "t_start_ns_1", "t_start_ns_2"} <= set(names)
    assert len(set(names)) == len(names) == joined.pl().width
    same = check_result.sql(
        "SELECT f.t_start_ns, d.t_start_ns, d.lat AS t_start_ns_1 FROM findings f JOIN drives d USING (drive_id)"
    )
    assert same.arrow().column_names == ["t_start_ns", "t_start_ns_2", "t_start_ns_1"]


@pytest.mark.parametrize(
    ("query", "says"),
    [
        ("COPY findings TO '{out}/x.csv'", "disabled"),
        ("ATTACH '{out}/x.duckdb'", "disabled"),
        ("FROM '{out}/log.csv'", "does not exist|disabled"),
        ("FROM read_csv('{out}/log.csv')", "disabled"),
        ("SET enable_external_access = true", "locked"),
        ("INSERT INTO findings FROM findings", "findings"),
        ("FROM nowhere", "nowhere"),
        ("FROM query", "query"),  # a Python variable
        ("SELEC 1", "SELEC"),
    ],
)
def test_sql_touches_nothing_else(check_result: drivelint.CheckResult, query: str, says: str, tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_text("a\n1\n", encoding="utf-8")
    with pytest.raises(drivelint.DriveLintError, match=says):
        check_result.sql(query.format(out=tmp_path))
    assert [f.name for f in tmp_path.iterdir()] == ["log.csv"]


def test_what_a_query_creates_is_gone(check_result: drivelint.CheckResult) -> None:
    check_result.sql("DROP VIEW findings")
    check_result.sql("CREATE TABLE mine AS SELECT 1")
    assert len(check_result.sql("FROM findings")) == len(check_result.findings)
    with pytest.raises(drivelint.DriveLintError, match="mine"):
        check_result.sql("FROM mine")


def test_reports_are_texts_or_files(check_result: drivelint.CheckResult, tmp_path: Path) -> None:
    assert check_result.report(to="junit").startswith("<?xml")
    file = check_result.report(tmp_path / "page.html")
    assert file == tmp_path / "page.html"
    assert file.read_text("utf-8") == check_result.report()
    with pytest.raises(drivelint.DriveLintError, match="'html'"):
        check_result.report(to="htm")  # type: ignore[call-overload]


def test_a_query_that_fails_is_one_error(check_result: drivelint.CheckResult) -> None:
    with pytest.raises(drivelint.DriveLintError, match="the query failed: Parser Error") as raised:
        check_result.sql("selec nonsense")
    shown = "".join(traceback.format_exception(raised.value))
    assert shown.count("Traceback") == 1, shown


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"traces": []}, "no traces"),
        ({"traces": "nowhere.mcap"}, r"nowhere\.mcap: no such file"),
        ({"map": "nowhere.xodr"}, r"nowhere\.xodr does not exist"),
        ({"mpa": "road.xodr"}, r"check\(\) has no argument 'mpa': did you mean 'map'\?"),
        ({"fail_on": "critcal"}, "fail_on='critcal': did you mean 'critical'"),
        ({"handedness": "left"}, "handedness='left'"),
        ({"visibility": "all"}, "visibility='all'"),
        ({"rules": "no-such-rule"}, "no-such-rule"),
        ({"env": {"wether": "dry"}}, "did you mean 'weather'"),
        ({"map_offset": (1.0,)}, "^map_offset='1.0'"),
        ({"map_origin": (91.0, 0.0)}, "^map_origin"),
        ({"ego_size": (0.0, 1.0)}, "^ego_size"),
        ({"memory": "1 byte"}, "memory"),
        ({"today": "tomorrow"}, "today"),
        ({"keep_db": True}, "^keep_db=True writes a file: name its folder with out=DIR"),
        ({"confidence": 0.95, "robustness": False}, "^confidence= needs the copies that robustness=False leaves out"),
        ({"confidence": 95}, "^confidence=95: write a share from 0 to 1"),
        ({"require": "no-such-rule"}, "no-such-rule"),
        ({"rules": []}, "rules names none"),
        ({"rules": 5}, "rules=5: give a text, or several"),
        ({"rules": [["a"]]}, r"\['a'\] is neither a text"),
        ({"traces": 5}, "traces=5: give a path, or several"),
        ({"map": ["a"]}, "map=.*give a path"),
        ({"map_offset": 5}, "map_offset=5: give two numbers"),
        ({"ego": [1, 2]}, r"ego=\[1, 2\]: give a text or a whole number"),
        ({"robustness": "no"}, "robustness='no': give True or False"),
        ({"margins": 1}, "margins=1: give True or False"),
        ({"rule_timeout": "x"}, "rule_timeout='x': give a number"),
        ({"sensor_range": "40"}, "sensor_range='40': give a number"),
        ({"memory": 2000}, "memory=2000: give a text"),
        ({"mapping": "esmin"}, "mapping 'esmin': .* did you mean 'esmini'"),
        ({"sensor_range": -1.0}, "more than 0 m"),
        ({"baseline": "nowhere"}, "nowhere: no result"),
    ],
)
def test_a_mistake_is_an_error_that_can_be_caught(arguments: dict[str, Any], says: str, drives: Path) -> None:
    with pytest.raises(drivelint.DriveLintError, match=says):
        drivelint.check(**{"traces": drives / "safe.mcap", **arguments})


@pytest.mark.slow
def test_the_gate_takes_what_the_command_line_takes(drives: Path, tmp_path: Path) -> None:
    """confidence lets findings through that too few copies keep; require asks for what the log lacks; as on the command line."""
    log, road = drives / "near-miss.mcap", drives / "road.xodr"
    said = ["--map", road, "--confidence", "1", "--require", "ukhc.r115.*", "--no-annotate"]
    command_line("check", log, *said, "--out", tmp_path / "a", code=1)
    found = drivelint.check(log, map=road, confidence=1, require="ukhc.r115.*", annotate=False, out=tmp_path / "b")
    theirs = files(tmp_path / "a")
    assert theirs == files(tmp_path / "b")
    assert (found.exit_code, "only possible" in found.why) == (1, True)
    assert json.loads(theirs["summary.json"])["required"]
    plain = drivelint.check(log, map=road, rules="ukhc.r162.*", robustness=False)
    assert plain.findings["n_copies"].null_count() == len(plain.findings) > 0


@pytest.mark.slow
def test_files_that_are_not_drivelints_stay(drives: Path, tmp_path: Path) -> None:
    asked: dict[str, Any] = {"traces": drives / "safe.mcap", "map": drives / "road.xodr", "rules": "ukhc.no-collision"}
    (tmp_path / "report.html").write_text("mine", encoding="utf-8")
    for write in (
        lambda **more: drivelint.check(**asked, out=tmp_path, **more),
        lambda **more: drivelint.check(**asked).write(tmp_path, **more),
    ):
        (tmp_path / "report.html").write_text("mine", encoding="utf-8")
        (tmp_path / "files.json").unlink(missing_ok=True)
        with pytest.raises(drivelint.DriveLintError, match="overwrite=True"):
            write()
        assert (tmp_path / "report.html").read_text("utf-8") == "mine"
        write(overwrite=True)
        assert (tmp_path / "report.html").read_text("utf-8").startswith("<!doctype html>")


@pytest.mark.slow
def test_margins_need_no_folder(drives: Path, tmp_path: Path) -> None:
    asked: dict[str, Any] = {"traces": drives / "safe.mcap", "map": drives / "road.xodr", "rules": "ukhc.no-collision"}
    found = drivelint.check(**asked, margins=True)
    written = drivelint.check(**asked, margins=True, out=tmp_path / "out")
    assert found.margins is not None
    assert written.margins is not None
    assert len(found.margins) > 0
    assert found.margins.arrow().equals(written.margins.arrow())
    assert (found.write(tmp_path / "b") / "margins.parquet").is_file()
    assert drivelint.check(**asked).margins is None


@pytest.mark.slow
def test_what_could_not_be_judged_is_said(drives: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "bad.mcap").write_bytes(b"\x89MCAP")
    found = drivelint.check(
        [drives / "safe.mcap", tmp_path / "bad.mcap"], map=drives / "road.xodr", fail_on="never", robustness=False
    )
    assert found.exit_code == 4
    assert any("bad.mcap" in note for note in found.notes)
    assert "not judged: 1 drive" in repr(found)
    assert "not judged: bad.mcap: " in found._repr_html_()
    assert drivelint.open(found.write(tmp_path / "out")).notes == found.notes
    assert capfd.readouterr() == ("", ""), "nothing is printed"


def test_a_drive_without_a_map_looks_like_one(drives: Path) -> None:
    found = drivelint.check(drives / "safe.mcap", rules="ukhc.no-collision", robustness=False)
    assert "map: none" in repr(found)
    assert "map: none | log: complete" in found._repr_html_()


INTERRUPTED = """
import os, sys
import drivelint, drivelint.run
from drivelint.sql import store

def long_query(*_, **__):
    with store.temporary_database(None) as con:
        print("computing", flush=True)
        con.execute("SELECT sum(hash(range)) FROM range(1000000000000)")

drivelint.run.check = long_query
try:
    drivelint.check(sys.argv[1])
except KeyboardInterrupt:
    os._exit(42)
"""


@pytest.mark.ci
def test_an_interrupt_is_an_interrupt(drives: Path) -> None:
    """Also while DuckDB computes in the main thread, which raises an error of its own then."""
    env = {**os.environ, "PYTHONPATH": str(ROOT / "src")}
    words = [sys.executable, "-c", INTERRUPTED, str(drives / "safe.mcap")]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=env) as running:
        assert running.stdout
        assert running.stdout.readline() == "computing\n"
        for _ in range(12):  # one that comes before the query, or meets a callback of the garbage collection, is lost
            running.send_signal(signal.SIGINT)
            with suppress(subprocess.TimeoutExpired):
                running.wait(5.0)
                break
        else:
            running.kill()
        assert running.returncode == 42, running.stderr and running.stderr.read()


@pytest.mark.ci
def test_types_of_arrays_and_frames_are_taken(drives: Path) -> None:
    asked: dict[str, Any] = {"rules": "ukhc.no-collision", "map": drives / "road.xodr", "robustness": np.False_}
    found = drivelint.check(
        drives / "safe.mcap", **asked, map_offset=(np.float64(0), np.float64(0)), rule_timeout=np.float64(30)
    )
    assert found.exit_code == 0
    with pytest.raises(drivelint.DriveLintError, match="no actor '17'"):
        drivelint.check(drives / "safe.mcap", **asked, ego=np.int64(17))  # type: ignore[arg-type]


def test_a_folder_and_an_empty_name_are_no_place_for_a_report(
    check_result: drivelint.CheckResult, tmp_path: Path
) -> None:
    with pytest.raises(drivelint.DriveLintError, match="is a folder: name the file"):
        check_result.report(tmp_path)
    with pytest.raises(drivelint.DriveLintError, match="an empty folder name"):
        check_result.write(" ")
    with pytest.raises(drivelint.DriveLintError, match="base=5: give a result, or its folder"):
        drivelint.diff(5, check_result)  # type: ignore[arg-type]


def test_columns_are_described_with_their_units(check_result: drivelint.CheckResult) -> None:
    told = {row["column"]: row for row in check_result.findings.describe()}
    assert tuple(told) == check_result.findings.columns
    assert told["t_worst_s"]["type"] == "double"
    assert all(row["meaning"] for row in told.values())
    assert {row["meaning"] for row in check_result.sql("SELECT 1 AS one").describe()} == {""}


def test_sql_knows_geometry(check_result: drivelint.CheckResult) -> None:
    """Where the findings' rows say that the ego was, and on a lane."""
    (row,) = check_result.sql("""
        SELECT max(abs(ST_X(f.geom) - f.x_m) + abs(ST_Y(f.geom) - f.y_m)) AS off_m, count(*) AS n
        FROM findings f WHERE EXISTS (FROM lanes l WHERE ST_Intersects(l.geom, f.geom))
    """)
    assert row["n"] > 0
    assert row["off_m"] == 0.0
    assert "geom" not in check_result.sql("FROM findings").columns
    for nothing in ("", "-- nothing"):
        with pytest.raises(drivelint.DriveLintError, match="returns nothing"):
            check_result.sql(nothing)


def test_a_folder_without_a_result_is_refused(tmp_path: Path) -> None:
    with pytest.raises(drivelint.DriveLintError, match=r"summary\.json is missing"):
        drivelint.open(tmp_path)


def test_read_trace_has_the_tables_of_a_log(drives: Path) -> None:
    trace = drivelint.read_trace(drives / "near-miss.mcap")
    assert len(trace.lanes) == 0
    assert set(trace.tables) == {name for name in drivelint.TraceTables.__annotations__ if name in trace.tables}
    assert set(trace.tables) == set(drivelint.TraceTables.__annotations__)
    ids = trace.sql("SELECT DISTINCT actor_id FROM actor_state ORDER BY actor_id").rows()
    assert [row["actor_id"] for row in ids] == sorted(trace.actor.pl()["actor_id"].to_list()) == ["1", "2", "3"]
    assert trace.drive_id.startswith("near-miss-")
    with pytest.raises(drivelint.DriveLintError, match="no such file"):
        drivelint.read_trace("nowhere.mcap")
    with pytest.raises(drivelint.DriveLintError, match="mapping"):
        drivelint.read_trace(ROOT / "fixtures" / "overtake" / "safe.csv")
    mapped = drivelint.read_trace(
        ROOT / "fixtures" / "overtake" / "safe.csv", mapping=ROOT / "fixtures" / "overtake" / "mapping.toml"
    )
    assert len(mapped.actor_state)


def test_read_trace_has_the_lanes_of_a_map(drives: Path, check_result: drivelint.CheckResult) -> None:
    """All of the road's lanes, as `check` has those near a finding, and the ego lies on them."""
    trace = drivelint.read_trace(drives / "near-miss.mcap", map=drives / "road.xodr")
    mine = {row["lanelet_id"]: row for row in trace.lanes}
    assert mine.keys() >= set(check_result.lanes["lanelet_id"])
    assert all(mine[row["lanelet_id"]] == row for row in check_result.lanes)
    roads = shapely.union_all([
        shapely.Polygon([
            *zip(row["left_x_m"], row["left_y_m"], strict=True),
            *reversed(list(zip(row["right_x_m"], row["right_y_m"], strict=True))),
        ])
        for row in mine.values()
        if row["drivable"]
    ])  # fmt: skip
    ego = trace.sql("SELECT x_m, y_m FROM actor_state JOIN actor USING (actor_id) WHERE is_ego").rows()
    assert all(roads.distance(shapely.Point(row["x_m"], row["y_m"])) < 0.2 for row in ego)
    assert len(ego) > 100
    with pytest.raises(drivelint.DriveLintError, match="does not exist"):
        drivelint.read_trace(drives / "near-miss.mcap", map="nowhere.xodr")


def test_names_of_a_log_are_escaped_in_a_notebook() -> None:
    bad = "<script>alert(1)</script>"
    drive = synthetic.drive("d1", file_name=bad)
    found = synthetic.result(
        [synthetic.verdict("fail", object_id=bad)],
        [synthetic.finding(object_id=bad, n_copies=100, n_stays=53, closing_mps=3.2)],
        [drive],
        [synthetic.rule(title=bad)],
    )
    shown = drivelint.CheckResult(found)._repr_html_()
    assert "<script" not in shown
    assert "&lt;script&gt;" in shown
    assert "possible" in shown
    assert "3.20\u00a0m/s" in shown
    assert "FAIL 1 critical finding in 1 of 1 drive" in shown
    assert "exit code 1" in shown


def test_a_notebook_shows_the_worst_and_counts_the_rest() -> None:
    rows = [synthetic.finding(occurrence=n, margin=-float(n)) for n in range(13)]
    shown = drivelint.CheckResult(synthetic.result([synthetic.verdict("fail")], rows))._repr_html_()
    assert shown.count("<tr>") == 1 + 10
    assert shown.index("-12.00") < shown.index("-11.00") < shown.index("-3.00")
    assert "and 3 more" in shown
    assert "certainty" not in shown


def test_importing_loads_nothing_heavy() -> None:
    probe = "import sys, drivelint; print(*sorted({name.split('.')[0] for name in sys.modules}))"
    env = {**os.environ, "PYTHONPATH": str(ROOT / "src")}
    done = subprocess.run([sys.executable, "-c", probe], capture_output=True, text=True, check=True, env=env)
    loaded = set(done.stdout.split())
    assert "drivelint" in loaded
    assert not loaded & {"duckdb", "pyarrow", "numpy", "polars", "typer", "jinja2", "rich", "msgspec"}
    assert {"check", "open", "read_trace", "DriveLintError"} <= set(dir(drivelint))
    assert set(dir(drivelint)) == {*drivelint.__all__, "__version__"}, "completion offers nothing else"  # type: ignore[attr-defined]
    with pytest.raises(AttributeError, match="chek"):
        _ = drivelint.chek  # type: ignore[attr-defined]


def test_what_type_checkers_see_is_there() -> None:
    stub = (ROOT / "src" / "drivelint" / "__init__.pyi").read_text("utf-8")
    names = re.findall(r"^from \S+ import (\w+) as \1\b", stub, re.MULTILINE)
    assert set(names) <= set(dir(drivelint))
    assert set(drivelint._API_NAMES) | {"DriveLintError"} == set(names)  # type: ignore[attr-defined]
    assert all(getattr(drivelint, name).__module__.startswith("drivelint.") for name in names)


def test_an_error_in_ipython_is_a_line_and_then_its_traceback() -> None:
    """By the method that IPython calls; `test_notebook.py` has a kernel."""
    with pytest.raises(drivelint.DriveLintError) as raised:
        drivelint.check("now\x1bhere.mcap")
    (line,) = raised.value._render_traceback_()
    assert line == r"TraceError: now\x1bhere.mcap: no such file or folder: check the path (%tb shows the traceback)"
    whole = raised.value._render_traceback_()
    assert whole[0].startswith("Traceback")
    assert any("test_check.py" in each for each in whole)
