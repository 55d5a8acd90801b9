"""The command line as a user meets it: its own process, its exit code, one line for a mistake."""

from __future__ import annotations

import dataclasses
import json
import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

import pyarrow.parquet as pq
import pytest
import typer

from drivelint import __version__, cli
from drivelint.catalogue import load_rules
from drivelint.cli.app import _app_with_command
from drivelint.drive.trace import DriveInput
from drivelint.result.request import RunRequest
from tests.evaluate.packs import invariant
from tests.shared_data import ROOT

OVERTAKE = ROOT / "fixtures" / "overtake"
TRACES = [str(OVERTAKE / f"{name}.csv") for name in ("safe", "near_miss", "collision")]
ON_ROAD = ["--map", str(OVERTAKE / "road.xodr"), "--mapping", str(OVERTAKE / "mapping.toml")]
SDA = ["--rules", "ukhc.r162.safe-distance-ahead"]
NO_COPIES = "--no-robustness"  # tests/engine, tests/test_run.py and the guide's commands have them
PROFILES = ["--profile", "relaxed", "--profile", "nominal", "--profile", "aggressive"]


def drivelint(*args: str) -> subprocess.CompletedProcess[str]:
    """Run the command line in a process of its own."""
    source = str(ROOT / "src")
    return subprocess.run(
        [sys.executable, "-m", "drivelint", *args],
        capture_output=True,
        text=True,
        encoding="utf-8",
        timeout=60,
        check=False,
        env={**os.environ, "PYTHONPATH": source, "PYTHONIOENCODING": "utf-8", "COLUMNS": "120"},
    )


Ran = Callable[..., tuple[int, str, str]]
CodeAndError = Callable[..., tuple[int, str]]


@pytest.fixture
def code_and_error(ran: Ran) -> CodeAndError:
    """Return a function that runs a command that must be refused and returns its exit code and one line."""

    def run(*args: str) -> tuple[int, str]:
        code, out, err = ran(*args)
        lines = err.splitlines()
        assert out == ""
        assert [line for line in lines if line.startswith("drivelint: error: ")] == lines[-1:]
        return code, lines[-1]

    return run


@pytest.fixture(scope="module")
def check_run(tmp_path_factory: pytest.TempPathFactory) -> tuple[subprocess.CompletedProcess[str], Path]:
    out = tmp_path_factory.mktemp("overtakes")
    return drivelint("check", *TRACES, *ON_ROAD, *SDA, *PROFILES, NO_COPIES, "--out", str(out)), out


def test_the_last_command_of_the_help_stands_apart_from_what_to_begin_with() -> None:
    lines = drivelint("--help").stdout.splitlines()
    begin = next(n for n, line in enumerate(lines) if line.strip().startswith("To begin:"))
    assert lines[begin - 1] == ""
    assert lines[begin - 2].split()[0] == "rules"


LOADED = """
import sys
from drivelint.cli import main
try: main()
except SystemExit: print('|'.join(sorted(sys.modules)))
"""


@pytest.mark.parametrize(
    ("args", "packages", "heavy"),
    [
        pytest.param(["--help"], set(), "duckdb pyarrow numpy polars lxml mcap shapely yaml msgspec", id="help"),
        pytest.param(["rules", "list"], set(), "numpy pyarrow shapely mcap google lxml", id="rules without what logs need"),
        # DuckDB and pyarrow load pandas wherever it is installed: half a second
        pytest.param(
            ["check", *TRACES, *ON_ROAD, *SDA, NO_COPIES], {"duckdb", "pyarrow"}, "pandas jinja2 yaml matplotlib scipy",
            id="check without pandas and what reports need", marks=pytest.mark.ci,
        ),
    ],
)  # fmt: skip
def test_a_command_loads_nothing_heavy_that_it_does_not_need(
    args: list[str], packages: set[str], heavy: str, tmp_path: Path
) -> None:
    """Which is why the help takes 0.12 s; a timed test would fail on a busy machine."""
    assert find_spec("pandas") is not None
    env = {**os.environ, "PYTHONPATH": str(ROOT / "src")}
    command = [sys.executable, "-c", LOADED, *args]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=tmp_path, env=env)
    loaded = {name.split(".")[0] for name in done.stdout.splitlines()[-1].split("|")}
    assert {"drivelint", *packages} <= loaded
    assert not loaded & set(heavy.split())


def test_version(ran: Ran) -> None:
    assert ran("--version")[1] == f"drivelint {__version__}\n"


def test_no_command_shows_help_on_stderr() -> None:
    done = drivelint()
    assert (done.returncode, done.stdout) == (2, "")
    assert "check" in done.stderr


def test_the_papers_verdicts_on_the_fixture(check_run: tuple[subprocess.CompletedProcess[str], Path]) -> None:
    done, out = check_run
    assert done.returncode == 1, done.stderr
    rows = pq.read_table(out / "verdicts.parquet").to_pylist()
    golden = {
        ("safe", "relaxed"): "fail", ("safe", "nominal"): "pass", ("safe", "aggressive"): "pass",
        ("near_miss", "relaxed"): "fail", ("near_miss", "nominal"): "fail", ("near_miss", "aggressive"): "pass",
        ("collision", "relaxed"): "fail", ("collision", "nominal"): "fail", ("collision", "aggressive"): "fail",
    }  # fmt: skip
    assert {(row["drive_id"].rpartition("-")[0], row["profile"]): row["verdict"] for row in rows} == golden
    ahead = {"safe": 76.43, "near_miss": 58.33, "collision": 35.63}
    required = {"relaxed": 101.39, "nominal": 63.74, "aggressive": 40.01}
    for row in rows:
        assert row["observed"] == pytest.approx(ahead[row["drive_id"].rpartition("-")[0]], abs=0.05)
        assert row["required"] == pytest.approx(required[row["profile"]], abs=0.5)


def test_text_is_for_people_and_goes_to_stdout(check_run: tuple[subprocess.CompletedProcess[str], Path]) -> None:
    done, out = check_run
    assert "3 critical findings in 3 of 3 drives" in done.stdout
    assert "exit 1: 3 findings at or above" in done.stdout
    assert "\x1b" not in done.stdout
    assert "Findings" not in done.stderr
    assert {path.name for path in out.iterdir()} == {
        "verdicts.parquet", "findings.parquet", "drives.parquet", "rules.parquet", "scenes.parquet", "lanes.parquet",
        "courses.parquet", "opportunities.parquet", "overtakes.parquet", "spaces.parquet", "tracks.parquet",
        "report.html", "summary.json", "junit.xml", "run.json", "files.json", "annotated",
    }  # fmt: skip


@pytest.mark.ci
def test_json_is_the_summary_and_nothing_else(
    check_run: tuple[subprocess.CompletedProcess[str], Path], ran: Ran
) -> None:
    _, folder = check_run
    asked = [*reversed(TRACES), *ON_ROAD, *SDA, *PROFILES, NO_COPIES]
    code, out, err = ran("check", *asked, "--format", "json", "--quiet")
    assert out == (folder / "summary.json").read_text(encoding="utf-8")
    assert err == ""
    assert json.loads(out)["exit"]["code"] == code == 1


@pytest.mark.slow
def test_fail_on_never(ran: Ran) -> None:
    assert ran("check", TRACES[2], *ON_ROAD, *SDA, NO_COPIES, "--fail-on", "never")[0] == 0


@pytest.mark.slow
def test_margins_and_database_are_kept_where_asked(tmp_path: Path, ran: Ran) -> None:
    code, _, err = ran("check", TRACES[0], *ON_ROAD, *SDA, "--margins", "--keep-db", "--out", str(tmp_path))
    assert code == 0, err
    assert pq.read_metadata(tmp_path / "margins.parquet").num_rows > 0
    assert (tmp_path / "drivelint.duckdb").stat().st_size > 0
    assert not [path for path in tmp_path.iterdir() if path.name.startswith(".")]


MISTAKES = [
    pytest.param(["check"], 2, "TRACE", id="no trace"),
    pytest.param(["chek"], 2, "chek", id="unknown command"),
    pytest.param(["check", TRACES[0], "--mpa", "x"], 2, "--mpa", id="unknown option"),
    pytest.param(["check", "nowhere.csv", *ON_ROAD], 4, "nowhere.csv", id="unknown file"),
    pytest.param(["check", TRACES[0], *ON_ROAD[2:], "--map", "nowhere.xodr"], 4, "nowhere.xodr", id="missing map"),
    pytest.param(["check", TRACES[0], *ON_ROAD[:2], "--mapping", "nowhere"], 2, "nowhere", id="unknown mapping"),
    pytest.param(["check", TRACES[0], *ON_ROAD[:2]], None, "safe.csv", id="a table without a mapping"),
    pytest.param(["check", TRACES[0], *ON_ROAD, "--ego", "nobody"], 4, "nobody", id="unknown ego"),
    pytest.param(["check", TRACES[0], *ON_ROAD, "--rules", "ukhc.r162"], 2, "ukhc.r162", id="unknown rule"),
    pytest.param(["check", TRACES[0], *ON_ROAD, "--ignore", "ukhc"], 2, "no rule", id="no rule left"),
    pytest.param(["check", TRACES[0], *ON_ROAD, "--profile", "nominl"], 2, "nominal", id="unknown profile"),
    pytest.param(["check", TRACES[0], *ON_ROAD, "--param", "x=1"], 2, "x=1", id="unknown parameter"),
    pytest.param(["check", TRACES[0], *ON_ROAD, "--map-offset", "1;2"], 2, "--map-offset", id="offset is no pair"),
    pytest.param(["check", TRACES[0], *ON_ROAD, "--map-offset", "nan,0"], None, "offset", id="offset is no number"),
    pytest.param(["check", TRACES[0], *ON_ROAD, "--sensor-range", "-1"], 2, "--sensor-range", id="negative range"),
    pytest.param(["check", TRACES[0], *ON_ROAD, "--margins"], 2, "--out", id="margins go nowhere"),
    pytest.param(["check", TRACES[0], *ON_ROAD, "--rules-dir", "nowhere"], 2, "nowhere", id="no rules there"),
    pytest.param(["rules", "show", "ukhc.nothing"], 2, "ukhc.nothing", id="show an unknown rule"),
    pytest.param(["rules", "show"], 2, "drivelint rules show --help", id="which help to read"),
    pytest.param(["convert", "x", "--to", "csv", "--out", "y"], 2, "'--to': 'csv' is not", id="unknown target"),
]


@pytest.mark.parametrize(("args", "code", "names"), MISTAKES)
def test_a_mistake_is_one_line_with_the_right_exit_code(
    args: list[str], code: int | None, names: str, code_and_error: CodeAndError
) -> None:
    got, line = code_and_error(*args)
    assert names in line
    assert got == code or (code is None and got in {2, 4})


@pytest.mark.slow
@pytest.mark.sample(1, ci=2)
@pytest.mark.parametrize(("n", "is_there"), [(1, True), (2, True), (1, False)], ids=["one", "two", "a name of nothing"])
def test_if_no_log_can_be_judged_the_result_says_so_and_no_earlier_one_stays(
    n: int, is_there: bool, tmp_path: Path, ran: Ran
) -> None:
    out = tmp_path / "out"
    asked = [*ON_ROAD, *SDA, "--profile", "aggressive", "--no-annotate", "--out", str(out)]
    assert ran("check", TRACES[0], *asked)[0] == 0
    empty = [str(tmp_path / f"empty{no}.csv") for no in range(n)]
    for log in empty if is_there else ():
        Path(log).touch()
    code, _, err = ran("check", *empty, *([] if is_there else TRACES), *asked)
    assert code == 4
    assert ("the file is empty" if is_there else "no such file or folder") in err
    told = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    assert told["exit"]["code"] == 4
    assert pq.read_table(out / "verdicts.parquet").num_rows == 0
    assert (out / "junit.xml").read_text(encoding="utf-8").count("<error") == n
    assert ran("report", str(out), "--to", "markdown")[0] == 0
    assert "NOT JUDGED" in (out / "report.md").read_text(encoding="utf-8")


def test_an_unreadable_mapping_is_named_with_its_place(tmp_path: Path, code_and_error: CodeAndError) -> None:
    mapping = tmp_path / "broken.toml"
    mapping.write_text('description = "x"\n[time\n', encoding="utf-8")
    code, line = code_and_error("check", TRACES[0], *ON_ROAD[:2], "--mapping", str(mapping))
    assert code == 2
    assert str(mapping) in line


def test_a_log_without_an_ego_says_so(tmp_path: Path, code_and_error: CodeAndError) -> None:
    mapping = tmp_path / "no_ego.toml"
    text = (OVERTAKE / "mapping.toml").read_text(encoding="utf-8")
    mapping.write_text(text.replace('ids = ["ego"]', "ids = []"), encoding="utf-8")
    code, line = code_and_error("check", TRACES[0], *ON_ROAD[:2], "--mapping", str(mapping))
    assert code == 4
    assert "--ego" in line


@pytest.mark.ci
def test_a_drive_that_cannot_be_judged_does_not_harm_the_others(tmp_path: Path, ran: Ran) -> None:
    bad = tmp_path / "bad.csv"
    bad.write_text("time_s,actor\n", encoding="utf-8")
    code, _, err = ran("check", TRACES[0], str(bad), *ON_ROAD, *SDA, "--out", str(tmp_path / "out"))
    assert code == 4, err
    assert "bad.csv" in err
    rows = pq.read_table(tmp_path / "out" / "drives.parquet").to_pylist()
    assert {row["file_name"]: row["status"] for row in rows} == {"bad.csv": "not_judged", "safe.csv": "judged"}


def test_a_map_of_another_place_is_named_not_blamed_on_the_driver(code_and_error: CodeAndError) -> None:
    code, line = code_and_error("check", TRACES[2], *ON_ROAD, "--map-offset", "5000,0")
    assert code == 4
    assert "another place" in line


def test_results_that_cannot_be_written_are_75(tmp_path: Path, code_and_error: CodeAndError) -> None:
    (tmp_path / "taken").write_text("", encoding="utf-8")
    for more in ([], ["--margins"], ["--keep-db"]):
        code, line = code_and_error(
            "check", TRACES[0], *ON_ROAD, *SDA, "--out", str(tmp_path / "taken" / "results"), *more
        )
        assert code == 75
        assert "taken" in line
    code, line = code_and_error("check", TRACES[0], *ON_ROAD, *SDA, "--out", str(tmp_path / "taken"))
    assert (code, "is a file" in line) == (2, True)


def test_a_log_of_which_a_row_could_not_be_read_is_3(tmp_path: Path, ran: Ran) -> None:
    lines = Path(TRACES[0]).read_text(encoding="utf-8").splitlines()
    lines[50] = lines[50].partition(",")[0]
    cut = tmp_path / "cut.csv"
    cut.write_text("\n".join(lines) + "\n", encoding="utf-8")
    code, out, _ = ran("check", str(cut), *ON_ROAD, "--rules", "ukhc.r124.speed-limit")
    assert (code, "(lossy)" in out, "parts of a log were lost" in out) == (3, True, True)
    code, out, _ = ran("check", TRACES[0], *ON_ROAD, "--rules", "ukhc.r124.speed-limit")
    assert (code, "lossy" in out) == (0, False)


def spoilt(tmp_path: Path, name: str) -> tuple[Path, Path]:
    """Return the log of the near miss with one thing wrong with it, and the log as it is."""
    head, *lines = Path(TRACES[1]).read_text(encoding="utf-8").splitlines()
    ghosts = [",".join([cells[0], cells[1], cells[2], "900.0", "90.0", *cells[5:]]) for cells in map(_cells, lines)]
    oncoming = [line for line in ghosts if line.split(",")[1] == "oncoming"]
    again = [
        ",".join([f"{float(cells[0]) + 0.05:.2f}", *cells[1:3], f"{float(cells[3]) + 600:.3f}", *cells[4:]])
        for cells in map(_cells, lines)
        if float(cells[0]) < 17.5
    ]
    text = {"ghost": [*oncoming, *lines], "restart": [*lines, *again], "restart before": [*again, *lines]}[name]
    path = tmp_path / f"{name}.csv"
    path.write_text("\n".join([head, *text]) + "\n", encoding="utf-8")
    return path, Path(TRACES[1])


def _cells(line: str) -> list[str]:
    return line.split(",")


@pytest.mark.ci
@pytest.mark.parametrize(
    "name", ["ghost", *(pytest.param(name, marks=pytest.mark.slow) for name in ("restart", "restart before"))]
)
def test_data_known_to_be_bad_make_no_pass_of_a_fail(name: str, tmp_path: Path, ran: Ran) -> None:
    """A second oncoming car of the same id, far away: 4, as nothing is decided; another drive over the same time: 3. Never 0."""
    bad, good = spoilt(tmp_path, name)
    rules = [*ON_ROAD, "--rules", "ukhc", "--no-annotate", NO_COPIES]
    assert ran("check", str(good), *rules, "--out", str(tmp_path / "good"))[0] == 1
    code, out, _ = ran("check", str(bad), *rules, "--out", str(tmp_path / "bad"))
    assert (code, "(lossy)" in out) == (4 if name == "ghost" else 3, True)
    failed = {
        (row["rule_id"], row["profile"])
        for row in pq.read_table(tmp_path / "good" / "verdicts.parquet").to_pylist()
        if row["verdict"] == "fail"
    }
    rows = pq.read_table(tmp_path / "bad" / "verdicts.parquet").to_pylist()
    assert failed
    assert not [row for row in rows if (row["rule_id"], row["profile"]) in failed and row["verdict"] == "pass"]


def test_headings_in_another_unit_are_4(tmp_path: Path, code_and_error: CodeAndError) -> None:
    lines = Path(TRACES[0]).read_text(encoding="utf-8").splitlines()
    turned = [lines[0], *(",".join([*c[:5], f"{float(c[5]) + 60:.3f}", *c[6:]]) for c in map(_cells, lines[1:]))]
    (tmp_path / "turned.csv").write_text("\n".join(turned) + "\n", encoding="utf-8")
    code, line = code_and_error("check", str(tmp_path / "turned.csv"), *ON_ROAD, *SDA)
    assert (code, "heading is off the direction of motion" in line) == (4, True)


def test_rules_list_is_for_programs_too(ran: Ran) -> None:
    rows = json.loads(ran("rules", "list", "--format", "json")[1])
    assert {"ukhc.r162.safe-distance-ahead", "ukhc.no-collision"} <= {row["id"] for row in rows}
    for row in rows:
        assert row.keys() == {"id", "pack", "kind", "subtype", "severity", "status", "clause", "requires"}
    assert [row["id"] for row in rows] == sorted(row["id"] for row in rows)
    _, listed, _ = ran("rules", "list")
    assert [row["id"] for row in rows if row["id"] not in listed] == []


def test_rules_list_takes_the_selectors_of_check(ran: Ran) -> None:
    def listed(*selectors: str) -> set[str]:
        return {row["id"] for row in json.loads(ran("rules", "list", *selectors, "--format", "json")[1])}

    assert {"ukhc.r162.safe-distance-ahead"} <= listed("ukhc,clause:R162") < listed("ukhc") < listed()
    assert listed("ukhc,kind:invariant", "ukhc,kind:execution") == listed("ukhc,kind:invariant") | listed(
        "ukhc,kind:execution"
    )
    code, _, err = ran("rules", "list", "kind:invarient")
    assert code == 2
    assert "no rule has the kind 'invarient'; did you mean 'invariant'?" in err


@pytest.mark.parametrize("begins", ["r162", "ukhc.r162", "r162.return-gap"])
def test_rules_show_takes_how_an_id_begins(begins: str, ran: Ran) -> None:
    code, out, _ = ran("rules", "show", begins)
    rules = load_rules()
    titles = {f"{rule.id}: {rule.title}" for rule in rules.values()}
    shown = [line for line in out.splitlines() if line in titles]
    assert code == 0
    assert (
        [line.split(":")[0] for line in shown]
        == [
            rule_id for rule_id in rules if begins in (rule_id[: len(begins)], rule_id.partition(".")[2][: len(begins)])
        ]
        != []
    )
    assert ran("rules", "show", "nothing-like-it")[0] == 2


@pytest.mark.sample(6, ci=14)
@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"PK\x03\x04rest", "a zip archive: unpack it"),
        (b"\x1f\x8b\x08rest", "compressed with gzip: unpack it"),
        (b"\x28\xb5\x2f\xfdrest", "compressed with zstd: unpack it"),
        (b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n", "a pointer of Git LFS"),
    ],
)
@pytest.mark.parametrize("name", ["log.csv", "log.mcap", "log.osi", "log.parquet", "map.xodr"])
def test_a_file_that_holds_the_file_is_named_as_such(
    name: str, content: bytes, message: str, tmp_path: Path, ran: Ran
) -> None:
    (tmp_path / name).write_bytes(content)
    inputs = [TRACES[0], "--map", str(tmp_path / name)] if name == "map.xodr" else [str(tmp_path / name)]
    code, _, err = ran("check", *inputs, *(ON_ROAD[2:] if name == "map.xodr" else ()))
    assert code == 4
    assert f"{name}: {message}" in err


def test_rules_show_tells_where_a_rule_is_from(ran: Ran) -> None:
    _, text, _ = ran("rules", "show", "ukhc.r162.safe-distance-ahead")
    for part in ("R162", "@reference", "@condition", "critical"):
        assert part in text
    _, text, _ = ran("rules", "show", "stvo.rg4")
    for part in (r"applies +road_type motorway", r"exempt after +10 s \(settle_s\)", r"merge gap +5 s", r"law +de"):
        assert re.search(rf"^{part}$", text, re.MULTILINE), part


CASES = """
- name: clean
  given: {ego_state: {t_s: 0..1 by 0.1, speed_mps: 1.0}}
  expect: %s
"""
SPEED = "SELECT drive_id, ego_id, t_ns, speed_mps AS observed, 10.0::DOUBLE AS required FROM ego_state"
RULE = invariant(SPEED)


@pytest.mark.sample(1, ci=1)
@pytest.mark.parametrize("expect", ["pass", "fail"])
def test_rules_test_runs_the_cases_of_a_folder(tmp_path: Path, expect: str, ran: Ran) -> None:
    pack = tmp_path / "mine"
    pack.mkdir()
    (pack / "slow.sql").write_text(RULE, encoding="utf-8")
    (pack / "slow.cases.yml").write_text(CASES % expect, encoding="utf-8")
    code, out, _ = ran("rules", "test", str(tmp_path))
    assert code == 1  # one case cannot show every kind
    assert ("case 'clean':" in out) == (expect == "fail")
    assert "mine.slow" in out
    assert "ukhc" not in out


@pytest.mark.skipif(signal.getsignal(signal.SIGINT) is signal.SIG_IGN, reason="Ctrl-C is ignored where these tests run")
def test_ctrl_c_is_answered_while_the_database_computes(tmp_path: Path) -> None:
    pack = tmp_path / "mine"
    pack.mkdir()
    endless = RULE.replace(
        "FROM ego_state", "FROM ego_state WHERE (SELECT count(*) FROM range(100000000000) t(i) WHERE sin(i) > 2) = 0"
    )
    (pack / "slow.sql").write_text(endless, encoding="utf-8")
    args = ["check", TRACES[0], *ON_ROAD, "--rules-dir", str(tmp_path), "--rules", "mine"]
    with subprocess.Popen(
        [sys.executable, "-m", "drivelint", *args],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT / "src")},
    ) as process:
        try:
            with pytest.raises(subprocess.TimeoutExpired):
                process.wait(timeout=2)
            process.send_signal(signal.SIGINT)
            out, err = process.communicate(timeout=10)
        finally:
            process.kill()
    assert (process.returncode, out) == (130, "")
    assert err.splitlines()[-1] == "drivelint: error: interrupted"


def test_every_command_that_reads_a_log_takes_the_same_input() -> None:
    """The options of `DriveInput`, and nothing of it left out."""
    commands = typer.main.get_command(cli.app).commands  # type: ignore[attr-defined]
    fields = {field.name for field in dataclasses.fields(DriveInput)}
    for name in ("check", "inspect", "convert"):
        assert fields <= {param.name for param in commands[name].params}, name
    assert fields <= {field.name for field in dataclasses.fields(RunRequest)}


def test_a_command_is_built_alone() -> None:
    """With the options that it has among the others; who names none has all of them."""
    whole = typer.main.get_command(cli.app).commands  # type: ignore[attr-defined]
    for name, command in whole.items():
        part = typer.main.get_command(_app_with_command(name)).commands  # type: ignore[attr-defined]
        assert list(part) == (list(whole) if name == "docs" else [name])  # which tells of all
        assert [param.name for param in part[name].params] == [param.name for param in command.params]
    assert _app_with_command("nonsense") is _app_with_command("") is cli.app


def test_a_map_beside_logs_that_were_judged_without_one_is_named(tmp_path: Path, ran: Ran) -> None:
    log = str(shutil.copy(OVERTAKE / "safe.csv", tmp_path))
    road, mapping = shutil.copy(OVERTAKE / "road.xodr", tmp_path), ["--mapping", str(OVERTAKE / "mapping.toml")]
    judge = ["check", log, *mapping, "--rules", "ukhc.no-collision", NO_COPIES, "--no-cache"]
    advice = f"drivelint: a map lies beside the logs: judge them on it with --map {road}"
    assert advice in ran(*judge)[2].splitlines()
    assert "a map lies" not in ran(*judge, "--map", str(road))[2] + ran(*judge, "--quiet")[2]
    (tmp_path / "town.net.xml").write_text("<net/>", encoding="utf-8")
    assert f"{advice} (1 other map there)" in ran(*judge)[2].splitlines()
    (tmp_path / "alone").mkdir()
    assert "a map lies" not in ran("check", str(shutil.copy(log, tmp_path / "alone")), *judge[2:])[2]
