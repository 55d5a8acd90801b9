"""SUMO as a source: what it records is what SUMO alone writes of the same scenario, and nothing of SUMO is left behind."""

from __future__ import annotations

import importlib.util
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from drivelint.drive.trace import IngestOptions
from drivelint.engine.batch import Drive
from drivelint.errors import TraceError, UsageError
from drivelint.formats import load_map, read_trace
from drivelint.road.map_reader import MapSource
from drivelint.watch.sources import sumo, sumo_process
from tests.scenes import verdict_rows
from tests.sumo import crossroads, world
from tests.watch.sumo_processes import processes

if TYPE_CHECKING:
    from drivelint.watch.source import Frame

pytestmark = pytest.mark.skipif(
    world.tool("sumo") is None or world.tool("netconvert") is None or importlib.util.find_spec("traci") is None,
    reason="SUMO or traci is not installed (pip install 'drivelint[sumo]')",
)
SECONDS = 30
RULES = ("ukhc.r175.red",)
_STEP = re.compile(rb'<timestep time="[^"]*"(?:/>|>.*?</timestep>)', re.DOTALL)


def config(
    folder: Path, name: str, routes: str, *, end: int | None = SECONDS, step: float = 0.1, more: str = ""
) -> Path:
    """Write a configuration for the crossroads in this folder."""
    file = folder / name
    until = "" if end is None else f'<end value="{end}"/>'
    file.write_text(
        f'<configuration><net-file value="c.net.xml"/><route-files value="{routes}"/><step-length value="{step}"/>'
        f'<time-to-teleport value="-1"/>{until}{more}</configuration>'
    )
    return file


@pytest.fixture(scope="module")
def scenario(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A crossroads with lights, people who run the red ones, and people who walk."""
    folder = tmp_path_factory.mktemp("crossroads")
    crossroads.simulate(folder, seconds=SECONDS, seed=3)
    people = "".join(
        f'<person id="p{n}" depart="{2 * n}"><walk edges="{arm}in" arrivalPos="-1"/></person>'
        for n, arm in enumerate("wsen")
    )
    (folder / "people.rou.xml").write_text(
        f'<routes><vType id="tall" vClass="pedestrian" length="0.4" width="0.6"/>{people}'
        '<person id="p9" depart="7" type="tall"><walk edges="win"/></person></routes>'
    )
    few = "".join(
        f'<vehicle id="r{n}" type="runner" depart="{n}"><route edges="{a}in {b}out"/></vehicle>'
        for n, (a, b) in enumerate([("w", "e"), ("s", "n"), ("e", "w"), ("n", "s"), ("w", "s"), ("e", "n")])
    )
    runs = 'jmDriveAfterRedTime="1000" jmDriveRedSpeed="8" jmIgnoreFoeProb="1" jmIgnoreFoeSpeed="100"'
    (folder / "few.rou.xml").write_text(f'<routes><vType id="runner" {runs}/>{few}</routes>')
    return folder


def played(source: sumo.SumoSource) -> list[Frame]:
    """Return all frames until it ends."""
    frames: list[Frame] = []
    try:
        while (found := source.read(5.0)) is not None:
            frames += found
    finally:
        source.close()
    return frames


def alone(folder: Path, conf: Path) -> Path:
    """Let SUMO write its floating car data by itself, with all that lies beside it."""
    log = folder / "c.fcd.xml"
    world.run(
        "sumo", "-c", str(conf), "--fcd-output", str(log), "--fcd-output.signals", "--fcd-output.acceleration",
        "--precision", "4", "--no-step-log", cwd=conf.parent,
    )  # fmt: skip
    return log


def steps(log: Path) -> list[bytes]:
    return [re.sub(rb' (?:accelerationLat|vehicle)="[^"]*"', b"", step) for step in _STEP.findall(log.read_bytes())]


def verdicts(logs: list[Path], road: Path) -> list[list[dict[str, Any]]]:
    """Return the verdicts of each log, without what is named after the log."""
    environment = load_map(MapSource(road.name, road.read_bytes()))
    drives = [Drive(read_trace(log, IngestOptions(ego="all")), environment) for log in logs]
    rows = verdict_rows(drives, rules=RULES)
    own = {"drive_id", "finding_ids"}
    return [
        [{k: v for k, v in row.items() if k not in own} for row in rows if row["drive_id"] == drive.trace.drive_id]
        for drive in drives
    ]


def test_the_recording_is_what_sumo_alone_writes(scenario: Path, tmp_path: Path) -> None:
    conf = config(scenario, "run.sumocfg", "few.rou.xml,people.rou.xml", more='<additional-files value="c.add.xml"/>')
    plain = tmp_path / "plain"
    plain.mkdir()
    log = alone(plain, conf).rename(plain / "plain.fcd.xml")
    shutil.move(scenario / "c.tls.xml", plain / "plain.tls.xml")
    for name in ("few.rou.xml", "people.rou.xml"):
        shutil.copy(scenario / name, plain)

    source = sumo.open(str(conf), tmp_path / "out")
    frames = played(source)
    assert len(frames) == SECONDS * 10
    assert [frame.t_ns for frame in frames[:3]] == [0, 100_000_000, 200_000_000]
    assert steps(source.recording) == steps(log)
    assert b"<person " in source.recording.read_bytes()
    mine, plain_ones = verdicts([source.recording, log], scenario / "c.xodr")
    assert mine == plain_ones
    assert {row["verdict"] for row in mine} >= {"pass", "fail"}
    trace = read_trace(source.recording, IngestOptions(ego="all"))
    people = {row["actor_id"]: row for row in trace.tables["actor"].to_pylist() if row["actor_class"] == "pedestrian"}
    assert people["p9"]["length_m"] == pytest.approx(0.4)
    assert people["p0"]["length_m"] == pytest.approx(0.215)


def test_who_rides_is_no_road_user(scenario: Path, tmp_path: Path) -> None:
    """A passenger waits, rides and is no pedestrian in the meantime, in the recording and in a window of it."""
    (scenario / "ride.rou.xml").write_text(
        '<routes><person id="rider" depart="0" departPos="30"><ride from="win" to="eout" lines="cab"/></person>'
        '<vehicle id="cab" depart="0" departPos="5"><route edges="win eout"/>'
        '<stop lane="win_0" startPos="20" endPos="40" triggered="person"/></vehicle></routes>'
    )
    source = sumo.open(str(config(scenario, "ride.sumocfg", "ride.rou.xml")), tmp_path)
    frames = played(source)
    content = source.recording.read_bytes()
    waits, rides = (
        len(re.findall(rb'<person id="rider"[^>]* vehicle="' + who + b'"', content)) for who in (b"", b"cab")
    )
    assert waits > 10
    assert rides > 10
    options = IngestOptions(ego="cab")
    for trace, n in (
        (read_trace(source.recording, options), waits),
        (source.window_reader(frames[-rides:], tmp_path, options)(), 0),
    ):
        ids = trace.tables["actor_state"]["actor_id"].to_pylist()
        assert (ids.count("rider"), set(ids) - {"rider"}) == (n, {"cab"})


def test_a_window_is_the_end_of_the_recording(scenario: Path, tmp_path: Path) -> None:
    source = sumo.open(str(config(scenario, "window.sumocfg", "c.rou.xml", end=15)), tmp_path)
    frames = played(source)
    options = IngestOptions(ego="all")
    window = source.window_reader(frames[-50:], tmp_path, options)().tables
    whole = read_trace(source.recording, options).tables
    for table in ("actor_state", "signal_state"):
        since = [row for row in whole[table].to_pylist() if row["t_ns"] >= frames[-50].t_ns]
        there = window[table].to_pylist()
        assert len(since) == len(there) > 0
        exact = ("t_ns", "actor_id", "x_m", "y_m", "indicator", "signal_id", "state")
        key = [name for name in exact if name in since[0]]
        assert [[row[k] for k in key] for row in there] == [[row[k] for k in key] for row in since]


def test_it_ends_where_nobody_is_left_or_when_it_is_told_to(scenario: Path, tmp_path: Path) -> None:
    conf = config(scenario, "short.sumocfg", "people.rou.xml", end=None, step=1.0)
    assert steps(alone(tmp_path, conf)) == steps(recorded(conf, tmp_path))
    source = sumo.open(str(conf), tmp_path, until_s=20)
    assert source.recording.parent.name == "short-2"  # the other recording stays as it is
    assert [frame.t_ns // 10**9 for frame in played(source)] == list(range(20))


def recorded(conf: Path, folder: Path) -> Path:
    source = sumo.open(str(conf), folder)
    played(source)
    return source.recording


def test_it_waits_until_it_is_asked(scenario: Path, tmp_path: Path) -> None:
    source = sumo.open(str(config(scenario, "asked.sumocfg", "c.rou.xml", step=0.05)), tmp_path, span_s=0.25)
    try:
        assert source.is_advanced_by_reads
        assert [len(source.read(5.0) or ()) for _ in range(3)] == [6, 5, 5]  # each span ends where a window does
        time.sleep(0.1)
        last = source.read(5.0)
        assert last is not None
        assert (last[0].t_ns, last[-1].t_ns) == (800_000_000, 1_000_000_000)
        assert source.recording.read_bytes().count(b"<timestep") == 21  # written through
        assert [len(source.read(0.0) or ()) for _ in range(6)] == [1] * 6  # a span may come in parts
        assert len(source.read(5.0) or ()) == 4
    finally:
        source.close()


def test_halting_ends_sumo_and_the_recording_can_be_read(scenario: Path, tmp_path: Path) -> None:
    conf = config(scenario, "halted.sumocfg", "c.rou.xml")
    source = sumo.open(str(conf), tmp_path)
    for _ in range(20):
        source.read(5.0)
    assert processes(str(conf))
    source.end_sender_if_possible()
    assert not processes(str(conf))
    assert source.read(5.0) is None
    source.close()
    source.close()
    assert read_trace(source.recording, IngestOptions(ego="all")).tables["actor_state"].num_rows > 0


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_nothing_of_sumo_is_left_behind(scenario: Path, tmp_path: Path, number: signal.Signals) -> None:
    conf = config(scenario, f"left-{number}.sumocfg", "c.rou.xml", end=100_000)
    code = (
        "import sys; from pathlib import Path; from drivelint.watch.sources import sumo\n"
        "source = sumo.open(sys.argv[1], Path(sys.argv[2]))\n"
        "while True:\n    source.read(5.0)\n    print(flush=True)\n"
    )
    with subprocess.Popen(
        [sys.executable, "-c", code, conf, tmp_path], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
    ) as child:
        assert child.stdout is not None
        child.stdout.readline()
        assert processes(str(conf))
        child.send_signal(number)
        child.stdout.read()
        child.wait(10)
    until = time.monotonic() + 5
    while processes(str(conf)) and time.monotonic() < until:
        time.sleep(0.05)
    assert not processes(str(conf))


@pytest.fixture
def quick_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sumo_process, "GRACE_BEFORE_KILL_S", 1.0)


@pytest.mark.usefixtures("quick_end")
@pytest.mark.parametrize(
    ("content", "message"),
    [
        ('<configuration><net-file value="none.net.xml"/></configuration>', "none.net.xml' is not accessible"),
        ('<configuration><nothing value="1"/></configuration>', "No option with the name 'nothing' exists"),
        ("<configuration>", "not well-formed"),
    ],
)
def test_what_sumo_says_is_one_line(tmp_path: Path, content: str, message: str) -> None:
    conf = tmp_path / "bad.sumocfg"
    conf.write_text(content)
    with pytest.raises(TraceError) as caught:
        sumo.open(str(conf), tmp_path / "out")
    assert message in str(caught.value)
    assert str(caught.value).startswith(str(conf))
    assert "\n" not in str(caught.value)
    assert not (tmp_path / "out").exists()
    assert not processes(str(conf))


@pytest.mark.usefixtures("quick_end")
def test_an_error_in_the_middle_is_told_and_the_recording_stays(scenario: Path, tmp_path: Path) -> None:
    (scenario / "lost.rou.xml").write_text(
        '<routes><vehicle id="a" depart="0"><route edges="win eout"/></vehicle>'
        '<vehicle id="c" depart="100"><route edges="win eout"/></vehicle>'
        '<vehicle id="b" depart="200"><route edges="win nowhere"/></vehicle></routes>'
    )
    more = '<route-steps value="5"/>'
    source = sumo.open(str(config(scenario, "lost.sumocfg", "lost.rou.xml", end=None, more=more)), tmp_path)
    with pytest.raises(TraceError, match="nowhere"):
        played(source)
    assert read_trace(source.recording, IngestOptions(ego="a")).tables["actor_state"].num_rows > 10


def test_a_recording_that_cannot_be_written_is_one_line(scenario: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("no folder")
    conf = config(scenario, "unwritten.sumocfg", "c.rou.xml")
    source = sumo.open(str(conf), tmp_path / "file")
    with pytest.raises(TraceError, match="the recording cannot be written"):
        played(source)
    assert not processes(str(conf))


def test_what_is_left_out_is_told(scenario: Path, tmp_path: Path) -> None:
    more = '<device.fcd.probability value="0.5"/>'
    source = sumo.open(str(config(scenario, "some.sumocfg", "c.rou.xml", more=more)), tmp_path)
    source.close()
    (note,) = source.notes()
    assert "device.fcd.probability" in note
    assert not source.notes()


def test_without_sumo_the_extra_is_named(scenario: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda *_, **__: None)
    with pytest.raises(UsageError, match=re.escape("drivelint[sumo]")):
        sumo.open(str(config(scenario, "none.sumocfg", "c.rou.xml")), tmp_path)
