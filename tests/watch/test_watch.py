"""`drivelint watch` from end to end: what it prints, what it writes, where it halts."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

from drivelint import run
from drivelint.engine.interruption import Interruption
from drivelint.errors import ExitCode, TraceError, UsageError
from drivelint.report.outputs import write
from drivelint.report.progress import Silent
from drivelint.result.files import parquet_bytes
from drivelint.result.load import load_result
from drivelint.result.model import exit_status
from drivelint.watch.ending import check_recording
from drivelint.watch.options import WatchOptions
from drivelint.watch.run import Watch
from drivelint.watch.source import Frame
from drivelint.watch.sources.choice import source_of_watch
from drivelint.watch.window import NS_PER_S
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from pathlib import Path

SCENES = ROOT / "fixtures" / "scenes"
LOG, ROAD = SCENES / "collision-25mph.mcap", SCENES / "overtake-road.xodr"
RULES = ("ukhc.no-collision", "ukhc.r162.safe-distance-ahead")


def drivelint(*words: str | Path) -> tuple[int, str, str]:
    done = subprocess.run(
        [sys.executable, "-m", "drivelint", *map(str, words)], capture_output=True, check=False, text=True
    )
    return done.returncode, done.stdout, done.stderr


def options(*rules: str) -> list[str | Path]:
    return ["--map", ROAD, "--no-robustness", *(word for rule in rules for word in ("--rules", rule))]


def watched(*words: str | Path, log: Path = LOG, code: int = 1, every: float = 1.0) -> list[dict[str, Any]]:
    status, out, err = drivelint("watch", log, "--replay", "0", "--every", str(every), *words)
    assert status == code, err
    return [json.loads(line) for line in out.splitlines()]


def of_type(messages: list[dict[str, Any]], kind: str) -> list[dict[str, Any]]:
    return [each for each in messages if each["type"] == kind]


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> tuple[list[dict[str, Any]], Path]:
    """Return what is said, and the folder of a watch whose contact starts a command that writes what it is told."""
    out = tmp_path_factory.mktemp("watched")
    script = out.with_name("told.py")
    script.write_text("import sys; open(sys.argv[1], 'w').write(sys.stdin.read())", encoding="utf-8")
    on = f"ukhc.no-collision={sys.executable} {script} {out.with_name('told.json')}"
    return watched(*options(*RULES), "--warn", "--advise", "--on", on, "--out", out, every=2.0), out


@pytest.mark.ci
def test_the_result_is_that_of_check(result: tuple[list[dict[str, Any]], Path]) -> None:
    _, out = result
    asked = run.CheckOptions((str(LOG),), map=ROAD, rules=RULES, robustness=False)
    checked = run.check(asked, Silent())
    for name, table in (("verdicts", "verdict"), ("findings", "finding"), ("drives", "drive"), ("rules", "rule")):
        assert (out / f"{name}.parquet").read_bytes() == parquet_bytes(getattr(checked, name), table)


@pytest.mark.ci
def test_a_command_gets_the_alarm(result: tuple[list[dict[str, Any]], Path]) -> None:
    told = json.loads(result[1].with_name("told.json").read_text(encoding="utf-8"))
    assert told == next(each for each in of_type(result[0], "alarm") if each["rule_id"] == "ukhc.no-collision")


@pytest.mark.ci
def test_every_alarm_is_a_finding_and_every_finding_has_one(result: tuple[list[dict[str, Any]], Path]) -> None:
    messages, _ = result
    alarms, end = of_type(messages, "alarm"), messages[-1]
    assert {each["rule_id"] for each in alarms} == set(RULES)
    assert [each["alarm"] for each in of_type(messages, "checked")] == [each["alarm"] for each in alarms]
    assert all(each["is_finding"] and each["finding_ids"] for each in of_type(messages, "checked"))
    assert end["type"] == "end"
    assert (end["n_alarms"], end["n_alarms_that_are_findings"], end["n_findings_without_alarm"]) == (3, 3, 0)
    assert end["exit_code"] == 1


@pytest.mark.ci
def test_the_alarm_of_the_contact_is_said_with_the_next_window(result: tuple[list[dict[str, Any]], Path]) -> None:
    (alarm,) = (each for each in of_type(result[0], "alarm") if each["rule_id"] == "ukhc.no-collision")
    assert (alarm["t_s"], alarm["severity"], alarm["object_id"]) == (9.7, "critical", "3")
    assert (alarm["title"], alarm["breach"]) == ("No collision", "Collision")
    assert 0 <= alarm["latency_s"] <= 2.0
    assert alarm["said_s"] == pytest.approx(alarm["t_s"] + alarm["latency_s"])


@pytest.mark.ci
def test_the_overtake_is_alarmed_before_the_contact(result: tuple[list[dict[str, Any]], Path]) -> None:
    said = {(each["rule_id"], each["profile"]): each["said_s"] for each in of_type(result[0], "alarm")}
    assert said["ukhc.r162.safe-distance-ahead", "nominal"] < 9.7 <= said["ukhc.no-collision", None]


@pytest.mark.ci
def test_the_verdicts_are_those_of_the_table(result: tuple[list[dict[str, Any]], Path]) -> None:
    import pyarrow.parquet as pq

    messages, out = result
    rows = pq.read_table(out / "verdicts.parquet").to_pylist()
    assert [{**each, "type": None} for each in of_type(messages, "verdict")] == [
        {"type": None, **row} for row in rows if row["verdict"] != "not_applicable"
    ]


@pytest.mark.ci
def test_advice_names_the_most_relaxed_profile_that_is_kept(result: tuple[list[dict[str, Any]], Path]) -> None:
    (mode,) = of_type(result[0], "mode")
    assert mode["mode"] is None  # no way of overtaking has so much room
    assert mode["verdicts"] == {"relaxed": "fail", "nominal": "fail", "aggressive": "fail"}


@pytest.mark.slow
def test_advice_names_a_profile_that_has_room() -> None:
    near = watched(*options("ukhc.r162.safe-distance-ahead"), "--advise", log=SCENES / "near-miss.mcap", every=5)
    assert [each["mode"] for each in of_type(near, "mode")] == ["aggressive"]


@pytest.mark.slow
def test_it_halts_within_a_step_and_says_so(tmp_path: Path) -> None:
    out = tmp_path / "out"
    messages = watched(*options("ukhc.no-collision"), "--halt-on", "critical", "--out", out, every=2.5)
    (halt,) = of_type(messages, "halt")
    assert 0 <= halt["after_s"] <= 2.5
    assert halt["t_s"] == pytest.approx(9.7 + halt["after_s"])
    assert len(of_type(messages, "alarm")) == 1
    told = f"halted at {halt['t_s']:.2f} s by an alarm of ukhc.no-collision at 9.70 s"
    assert (messages[-1]["exit_code"], messages[-1]["why"]) == (1, told)
    assert exit_status(load_result(out)) == (ExitCode.FAILED, told)


@pytest.mark.slow
def test_nothing_halts_below_the_severity() -> None:
    messages = watched(*options("ukhc.r126.ds-disjoint"), "--halt-on", "critical", code=0, every=5)
    assert of_type(messages, "alarm")
    assert not of_type(messages, "halt")


WRITER = """
import pathlib, sys, time
source, target, pause_s = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), float(sys.argv[3])
content = source.read_bytes()
with target.open("wb") as file:
    for at in range(0, len(content) - 2000, 2000):
        file.write(content[at : at + 2000])
        file.flush()
    time.sleep(pause_s)
    file.write(content[at + 2000 :])
"""


@pytest.mark.slow
def test_a_program_that_writes_a_log_is_watched_and_halted(tmp_path: Path) -> None:
    """The program stops for long before the end of the log, so that only the halt can end it in time."""
    script, log = tmp_path / "writer.py", tmp_path / "growing.mcap"
    script.write_text(WRITER, encoding="utf-8")
    begun_s = time.monotonic()
    status, out, err = drivelint(
        "watch",
        log,
        *options("ukhc.no-collision"),
        "--halt-on",
        "critical",
        "--",
        sys.executable,
        script,
        LOG,
        log,
        "300",
    )
    assert time.monotonic() - begun_s < 120
    messages = [json.loads(line) for line in out.splitlines()]
    assert status == 1, err
    assert [each["t_s"] for each in of_type(messages, "alarm")] == [9.7]
    assert of_type(messages, "halt")
    assert len(log.read_bytes()) < len(LOG.read_bytes())
    assert messages[-1]["n_alarms_that_are_findings"] == 1


@pytest.mark.slow
def test_a_program_that_ends_by_itself_is_waited_for(tmp_path: Path) -> None:
    script, log, out = tmp_path / "writer.py", tmp_path / "growing.mcap", tmp_path / "out"
    script.write_text(WRITER + "sys.exit(7)", encoding="utf-8")
    status, said, err = drivelint(
        "watch", log, *options("ukhc.no-collision"), "--out", out, "--", sys.executable, script, LOG, log, "1"
    )
    messages = [json.loads(line) for line in said.splitlines()]
    assert status == 1, err
    assert [each["t_s"] for each in of_type(messages, "alarm")] == [9.7]
    assert any("ended with exit code 7" in each["text"] for each in of_type(messages, "note"))
    assert log.read_bytes() == LOG.read_bytes()


@pytest.mark.parametrize(
    ("watch_options", "message"),
    [
        ({"window_s": 12.0, "every_s": 8.0}, "--every 8: use at most 7 s, or a longer --window"),
        ({"window_s": 9.0}, "--window 9: use more than 10 s"),
        ({"on": ("ukhc.no-collision",)}, "write SEL=COMMAND"),
        ({"on": ("stvo.rg1=true",)}, "none of the selected rules is meant"),
        ({"command": ("true",)}, "there is no program to start"),
        ({"command": ("true",), "replay": None}, "exists already: the program after -- must write a new file"),
        ({"command": ("true",), "replay": None, "source": "-"}, "stdin exists before the program after -- is started"),
    ],
)
def test_mistakes(watch_options: dict[str, Any], message: str) -> None:
    watch_options = {"source": str(LOG), "map": ROAD, "rules": RULES, "replay": 0.0, **watch_options}
    wanted = WatchOptions(**watch_options)
    with pytest.raises(UsageError, match=message), source_of_watch(wanted, Silent()) as source:
        Watch(wanted, source, print, Interruption())


@pytest.mark.parametrize("name", ["ws://127.0.0.1:1", "{}/ws-new.mcap"])
def test_a_program_may_bring_the_source_into_being(name: str, tmp_path: Path) -> None:
    wanted = WatchOptions(source=name.format(tmp_path), command=("true",))
    with source_of_watch(wanted, Silent()) as source:
        assert source.read(0.0) == []


def test_a_mistake_is_one_line() -> None:
    status, out, err = drivelint("watch", LOG, "--replay", "0", *options("no-such-rule"))
    assert (status, len(err.splitlines())) == (2, 1)
    (end,) = (json.loads(line) for line in out.splitlines())
    assert (end["type"], end["exit_code"]) == ("end", 2)
    assert end["why"] in err


def test_a_map_that_cannot_be_read_is_known_before_anything_is_started(tmp_path: Path) -> None:
    road, marker = tmp_path / "road.xodr", tmp_path / "marker"
    road.write_text("<OpenDRIVE><road", encoding="utf-8")
    script = f"open({str(marker)!r}, 'w')"
    words = ("--rules", "ukhc.no-collision", "--map", road, "--idle", "0.1", "--", sys.executable, "-c", script)
    status, out, err = drivelint("watch", tmp_path / "new.mcap", *words)
    (end,) = (json.loads(line) for line in out.splitlines())
    assert (status, end["type"], end["exit_code"]) == (4, "end", 4), err
    assert "is not well-formed XML" in end["why"]
    assert not marker.exists()


class Broken:
    """A source that has a recording, gives windows that no reader can read, and then breaks."""

    is_advanced_by_reads = is_window_due = True
    recording = LOG

    def __init__(self) -> None:
        self.left = 3

    def read(self, timeout_s: float) -> list[Frame]:  # noqa: ARG002 - of all sources
        self.left -= 1
        if self.left < 0:
            raise TraceError("the other side is gone")
        return [Frame(self.left * NS_PER_S, None, 0)]

    def notes(self) -> list[str]:
        return []

    def window_reader(self, frames: Any, folder: Path, options: Any) -> Any:  # noqa: ARG002 - of all sources
        raise ValueError("what a reader never expected")

    latest_trace = window_reader

    def end_sender_if_possible(self) -> None: ...

    def close(self) -> None: ...


@pytest.mark.ci
def test_neither_a_window_that_cannot_be_read_nor_a_source_that_breaks_costs_the_check(tmp_path: Path) -> None:
    told: list[dict[str, Any]] = []
    on = ("ukhc.no-collision=true",)
    asked = WatchOptions(source="x.mcap", map=ROAD, rules=("ukhc.no-collision",), robustness=False, on=on)
    with Watch(asked, Broken(), told.append, Interruption()) as watch:
        for _ in range(2):
            watch._triggers[0].run_for_alarms_and_return_note([{"rule_id": "ukhc.no-collision"}])
        watched = watch.watch()
        checked: dict[str, Any] = {"folder": tmp_path, "progress": Silent(), "interruption": Interruption()}
        result = check_recording(asked, LOG, None, watch, **checked)
    assert (watched.n_unjudged, watched.broken) == (3, "the other side is gone")
    texts = [each["text"] for each in told]
    assert any("what a reader never expected" in text for text in texts)
    assert "the other side is gone" in texts
    assert any(text.startswith("--on: true was not started for 1 alarm") for text in texts)
    assert len(texts) == 3
    assert result.findings.num_rows == 1
    why = "the recording ended early: the other side is gone"
    assert why in result.notes
    assert exit_status(result).code == ExitCode.FAILED
    result = replace(result, fail_on="never")
    assert exit_status(result) == (ExitCode.NOT_JUDGED, why)
    write(result, tmp_path / "out")
    assert exit_status(load_result(tmp_path / "out")) == (ExitCode.NOT_JUDGED, why)
