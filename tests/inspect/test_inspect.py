"""What inspect finds out: held against the data's own description, and against what check then judges."""

from __future__ import annotations

import io
import json
import re
import tomllib
from typing import TYPE_CHECKING, Any

import msgspec
import pytest
from rich.console import Console

from drivelint.drive.conditions import RULE_CONDITION_VALUES
from drivelint.drive.trace import IngestOptions
from drivelint.errors import ExitCode, TraceError, UsageError
from drivelint.formats import read_trace
from drivelint.formats.registry import FIRST_BYTES_BY_SUFFIX
from drivelint.inspect import InspectRequest, exit_code, inspect, to_json
from drivelint.inspect.model import Content, Inspection, json_schema
from drivelint.inspect.text import render
from drivelint.reasons.signals import ADVICE, how_to_provide
from drivelint.report.progress import Silent
from drivelint.resources import folder
from drivelint.run import CheckOptions, check
from tests.formats.osi import osi_log
from tests.scenes import derived, road, rows, standing, times
from tests.scenes import drive as scene
from tests.shared_data import ROOT, shared

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.inspect.model import Drive

FIXTURE = ROOT / "fixtures" / "overtake"
ROAD = FIXTURE / "road.xodr"
MAPPING = str(FIXTURE / "mapping.toml")
SAID_BY_THE_LOG = {"indicator", "brake_light", "ego_size", "actor_classes", "signals", "declared_events", "modes"}
SAID_BY_THE_LOG |= {signal for signal in ADVICE if signal.startswith("mode_")}
LIGHTS = {"ukhc.r103.signal-before", "ukhc.r103.signal-means-go", "ukhc.signal-then-leaves"}


def looked(trace: Path | str, **options: Any) -> Drive:
    """Return what is known of a log that is a drive."""
    found = inspect(InspectRequest(str(trace), **options))
    assert found.problem is None
    assert found.drive is not None
    return found.drive


@pytest.fixture(scope="module")
def study() -> Inspection:
    road = shared("overtake_case_study/t_junction.xodr")
    return inspect(InspectRequest(str(shared("overtake_case_study/safe.csv")), map=road, mapping="carla-testbench"))


def test_the_case_study(study: Inspection) -> None:
    drive = study.drive
    assert drive is not None
    (ego,) = drive.egos
    assert (ego.actor.actor_id, ego.actor.length_m, ego.actor.width_m) == ("1", 4.8, 1.8)
    assert (drive.clock.period_s, drive.clock.holes, drive.states) == (0.1, 0, 1005)
    assert [(c.actor_class, c.n, c.sized, c.moving) for c in drive.classes] == [("car", 3, 3, 2)]
    assert drive.road is not None
    assert (drive.road.handedness, drive.road.handedness_source, drive.road.offset_m) == (
        "lht",
        "junctions",
        (2.618, 3.113),
    )
    assert ego.registration is not None
    assert ego.registration.ok
    assert ego.registration.on_lane == ego.registration.steps == ego.steps == drive.clock.steps


def test_which_rules_can_be_decided_and_why_not_the_others() -> None:
    """The logs have no indicators: the four rules about signalling wait for them."""
    road = shared("overtake_case_study/t_junction.xodr")
    chosen = (*LIGHTS, "ukhc.exit-sign-signal", "ukhc.r162.*", "ukhc.r163.cut-in", "ukhc.overtake-*")
    trace = shared("overtake_case_study/safe.csv")
    drive = looked(trace, map=road, mapping="carla-testbench", rules=chosen)
    (ego,) = drive.egos
    assert {rule.split(".")[1] for rule in ego.can} >= {"r162", "r163", "overtake-zone"}
    assert len(ego.can) + 4 == len(drive.rules)
    assert {rule.rule_id for rule in ego.cannot} == {*LIGHTS, "ukhc.exit-sign-signal"}
    assert all("indicator" in rule.missing_signals for rule in ego.cannot)
    indicator = ego.missing_signals[0]
    assert (indicator.signal, len(indicator.rules)) == ("indicator", 4)
    assert (
        set(indicator.alone) == {rule.rule_id for rule in ego.cannot if rule.missing_signals == ["indicator"]} >= LIGHTS
    )


@pytest.mark.slow
@pytest.mark.parametrize("road", [ROAD, None], ids=["map", "no map"])
def test_what_cannot_be_decided_is_what_check_calls_missing(road: Path | None) -> None:
    """inspect and check must not tell different stories.

    The rules whose verdict is `missing_...` are named here; of the others that are, none is kept, and one is broken only
    where it was said that it can be.
    """
    (ego,) = looked(FIXTURE / "safe.csv", map=road, mapping=MAPPING).egos
    rows = check(
        CheckOptions((str(FIXTURE / "safe.csv"),), map=road, mapping=MAPPING, rules=("ukhc",), robustness=False),
        Silent(),
    ).verdicts
    lacking = {row["rule_id"] for row in rows.to_pylist() if row["reason_code"].startswith("missing_")}
    named = {rule.rule_id: rule for rule in ego.cannot}
    assert lacking or road
    assert lacking <= named.keys()
    decided = {(row["rule_id"], row["verdict"]) for row in rows.to_pylist()}
    assert not [rule for rule, verdict in decided if verdict == "pass" and rule in named]
    assert not [
        rule for rule, verdict in decided if verdict == "fail" and rule in named and not named[rule].breach_only
    ]


@pytest.mark.ci
def test_a_map_without_limits_and_road_types_promises_no_rule_about_them(tmp_path: Path) -> None:
    bare = re.sub(r"<type .*?</type>|<speed [^>]*>", "", ROAD.read_text("utf-8"), flags=re.DOTALL)
    (tmp_path / "bare.xodr").write_text(bare, "utf-8")
    chosen = ("ukhc.r124.*", "ukhc.r265.*", "ukhc.r162.safe-distance-ahead")
    for env, missing in (((), {"r124", "r265"}), (("road_type=rural",), {"r124"})):
        drive = looked(FIXTURE / "safe.csv", map=tmp_path / "bare.xodr", mapping=MAPPING, rules=chosen, env=env)
        (ego,) = drive.egos
        named = {rule.rule_id.split(".")[1]: rule for rule in ego.cannot}
        assert named.keys() == missing
        assert (named["r124"].missing_signals, named["r124"].breach_only) == (["speed_limits"], True)
        assert (
            next(item for item in ego.missing_signals if item.signal == "speed_limits").reason
            == "the map has no speed limits"
        )
        assert "r265" not in named or (named["r265"].missing_signals, named["r265"].breach_only) == (
            ["road_types"],
            False,
        )


def test_without_a_map_it_is_the_map_that_is_missing() -> None:
    drive = looked(FIXTURE / "safe.csv", mapping=MAPPING)
    (ego,) = drive.egos
    assert (drive.road, ego.registration) == (None, None)
    # rules that follow the ego's own way need no map but for its speed limits
    known = {"map", "speed_limits", *SAID_BY_THE_LOG, *RULE_CONDITION_VALUES}
    assert {signal for rule in ego.cannot for signal in rule.missing_signals} <= known
    assert next(item for item in ego.missing_signals if item.signal == "map").provide.endswith("--map FILE")


@pytest.mark.ci
def test_an_ego_that_is_no_vehicle_is_advised_to_choose_another(tmp_path: Path) -> None:
    """Somebody on foot crosses the road: no other map makes them drive on it."""
    frames = []
    for i in range(40):
        truth = osi_log.frame(i * 100_000_000, host=7)
        osi_log.moving(truth, 7, 20.0, -20.0 + i, v=(0.0, 10.0), kind=3, vehicle=0)
        frames.append(truth)
    drive = looked(osi_log.write(tmp_path / "log.mcap", osi_log.truths(frames)), map=ROAD)
    (ego,) = drive.egos
    registration = next(item for item in ego.missing_signals if item.signal == "registration")
    assert registration.provide == "choose the ego with --ego ID (drivelint inspect LOG --ego all lists the ids)"
    assert registration.reason.endswith(f"so it may not be the vehicle under test: {registration.provide}")


def test_a_map_of_another_place_is_told_and_not_used() -> None:
    found = inspect(InspectRequest(str(FIXTURE / "safe.csv"), map=ROAD, mapping=MAPPING, map_offset=(9000.0, 0.0)))
    assert found.drive is not None
    assert "of another place" in (found.drive.road_problem or "")
    assert found.drive.road is None
    assert found.drive.egos[0].missing_signals[0].reason.startswith("the map is not used")
    assert exit_code(found) is ExitCode.NOT_JUDGED


@pytest.mark.ci
def test_no_ego_is_no_error_but_a_choice(tmp_path: Path) -> None:
    frames = []
    for i in range(20):
        truth = osi_log.frame(i * 100_000_000, host=None)
        osi_log.moving(truth, 7, 1.0 * i)
        osi_log.moving(truth, 8, 2.0 * i, 4.0, v=(20.0, 0.0))
        osi_log.moving(truth, 9, 5.0 * i, 8.0, v=(50.0, 0.0), kind=3, vehicle=0)
        frames.append(truth)
    drive = looked(osi_log.write(tmp_path / "log.mcap", osi_log.truths(frames)))
    assert drive.egos == []
    assert [(a.actor_id, round(a.way_m)) for a in drive.candidates] == [("8", 38), ("7", 19)]
    assert drive.supposed is not None
    assert drive.supposed.actor.actor_id == "8"
    assert "ukhc.no-collision" in drive.supposed.can
    chosen = looked(tmp_path / "log.mcap", ego="7")
    assert [ego.actor.actor_id for ego in chosen.egos] == ["7"]
    assert (chosen.supposed, chosen.candidates) == (None, [])


def test_an_ego_without_states_is_told_as_check_tells_it(tmp_path: Path) -> None:
    frames = []
    for i in range(20):
        truth = osi_log.frame(i * 100_000_000, host=3)
        osi_log.moving(truth, 7, 1.0 * i)
        frames.append(truth)
    path = osi_log.write(tmp_path / "log.mcap", osi_log.truths(frames))
    with pytest.raises(TraceError) as refused:
        read_trace(path, IngestOptions())
    found = inspect(InspectRequest(str(path)))
    assert found.drive is not None
    assert str(refused.value) == f"{path}: {found.drive.ego_source}"
    console = Console(file=io.StringIO(), width=200)
    console.print(render(found, "log.mcap"))
    assert isinstance(console.file, io.StringIO)
    assert (
        "none: the log's ego '3' has no states: use --ego ID or --ego all (ids: 7). The longest"
        in console.file.getvalue()
    )


@pytest.mark.ci
def test_every_vehicle_in_turn_and_who_lacks_what(tmp_path: Path) -> None:
    frames = osi_log.drive(20)
    for truth in frames:
        truth.moving_object[1].base.ClearField("dimension")
        truth.moving_object[0].vehicle_classification.light_state.indicator_state = 2
    drive = looked(osi_log.write(tmp_path / "log.mcap", osi_log.truths(frames)), ego="all")
    assert [ego.actor.actor_id for ego in drive.egos] == ["0", "1", "2"]
    lacking = {ego.actor.actor_id: {item.signal for item in ego.missing_signals} for ego in drive.egos}
    assert lacking["1"] >= {"map", "ego_size"}
    assert "ego_size" not in lacking["0"]


def test_channels_are_counted_and_said_what_they_are_for(tmp_path: Path) -> None:
    more = [osi_log.Out("osi3.SensorView", "view", 500_000_000, b"")]
    path = osi_log.write(tmp_path / "log.mcap", [*osi_log.truths(osi_log.drive(11)), *more])
    found = inspect(InspectRequest(str(path)))
    assert "2 topics" in (found.problem or "")
    channels = {c.topic: c for c in found.content.channels}
    truth = channels["ground_truth"]
    assert (truth.messages, truth.schema, truth.encoding, truth.read_as) == (
        11,
        "osi3.GroundTruth",
        "protobuf",
        "ground truth",
    )
    assert truth.rate_hz == pytest.approx(10.0)
    assert (channels["view"].messages, channels["view"].rate_hz) == (1, None)
    assert exit_code(found) is ExitCode.NOT_JUDGED
    assert exit_code(inspect(InspectRequest(str(path), topic="ground_truth"))) is ExitCode.OK


def test_holes(tmp_path: Path) -> None:
    frames = [frame for i, frame in enumerate(osi_log.drive(40)) if i not in range(10, 15)]
    clock = looked(osi_log.write(tmp_path / "log.mcap", osi_log.truths(frames))).clock
    assert (clock.steps, clock.holes) == (35, 1)
    assert clock.longest_hole_s == pytest.approx(0.6)
    assert clock.first_hole_at_s == pytest.approx(0.9)


def test_a_table_that_no_mapping_fits_gets_one_to_start_from(tmp_path: Path) -> None:
    found = inspect(InspectRequest(str(FIXTURE / "safe.csv")))
    assert "no shipped mapping fits" in (found.problem or "")
    draft = found.content.draft_mapping or ""
    (tmp_path / "draft.toml").write_text(draft.replace("ids = []", 'ids = ["ego"]'), encoding="utf-8")
    mine, good = (looked(FIXTURE / "safe.csv", mapping=name) for name in (str(tmp_path / "draft.toml"), MAPPING))
    assert mine.clock == good.clock
    assert mine.egos[0].actor.way_m == good.egos[0].actor.way_m
    assert not [q for q in mine.quality if q.severity == "error"]
    lacking = {item.signal for item in mine.egos[0].missing_signals}
    # which the table does not have
    assert {"map", "ego_size"} <= lacking <= {"map", "speed_limits", *SAID_BY_THE_LOG, *RULE_CONDITION_VALUES}


def test_a_file_that_does_not_begin_as_its_suffix_says_is_no_table(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A byte order mark before the fixed beginning is no fault."""
    monkeypatch.setitem(FIRST_BYTES_BY_SUFFIX, ".trk", b"#TRK")
    found = {}
    for name, text in (("bare", "a,b\n1,2\n"), ("marked", "\ufeff#TRK,b\n1,2\n")):
        (tmp_path / f"{name}.trk").write_text(text, encoding="utf-8")
        found[name] = inspect(InspectRequest(str(tmp_path / f"{name}.trk")))
    assert "not trk: it should begin b'#TRK'" in (found["bare"].problem or "")
    assert found["bare"].content == Content()
    assert "no shipped mapping fits" in (found["marked"].problem or "")
    assert found["marked"].content.sheets


@pytest.mark.parametrize(
    ("columns", "lines"),
    [
        ("timestamp_ms,Track ID,Position X [m],Position Y [m],Speed [km/h],Heading (deg)",
         ['column = "timestamp_ms"', 'unit = "ms"', 'actor_id = "Track ID"', 'x = "Position X [m]"',
          'speed = { column = "Speed [km/h]", unit = "km/h" }', 'yaw = { column = "Heading (deg)", unit = "deg" }']),
        ("t,object_id,xCenter,yCenter,xVelocity,yVelocity", ['x = "xCenter"', 'vx = "xVelocity"', 'vy = "yVelocity"', "# yaw"]),
        ('t,id,x,y,vx,"say ""hi""\\n"', ['x = "x"']),
        ("trackId,frame,xCenter,yCenter,heading", ['column = "frame"\nunit = "frames"\n# rate_hz = 25', 'actor_id = "trackId"']),
        ("Vehicle_ID,Frame_ID,Global_Time,Local_X,Local_Y,Global_X", ['column = "Global_Time"', 'x = "Local_X"']),
    ],
)  # fmt: skip
def test_drafts(tmp_path: Path, columns: str, lines: list[str]) -> None:
    (tmp_path / "log.csv").write_text(columns + "\n", encoding="utf-8")
    draft = inspect(InspectRequest(str(tmp_path / "log.csv"))).content.draft_mapping or ""
    for line in lines:
        assert line in draft
    assert ("\nvx = " in draft) == ("\nvy = " in draft)


def _table(tmp_path: Path, *classes: str) -> Path:
    """Write a table of an ego, a car, that drives behind actors whose class is called so."""
    rows = [
        f"{t / 10:.1f},{actor},{100 * actor + t},0,0,10,4.5,1.8,{kind}"
        for t in range(50)
        for actor, kind in enumerate(("car", *classes))
    ]
    (tmp_path / "log.csv").write_text("\n".join(["t,id,x,y,heading,speed,length,width,type", *rows]), encoding="utf-8")
    return tmp_path / "log.csv"


def test_a_draft_has_the_classes_that_the_table_names(tmp_path: Path) -> None:
    draft = inspect(InspectRequest(str(_table(tmp_path, "Van", "foo", 'b"r')))).content.draft_mapping or ""
    assert tomllib.loads(draft)["class"] == {
        "column": "type", "values": {"Van": "van", "car": "car"}, "default": "vehicle"
    }  # fmt: skip
    assert '# in values, too: "foo" = "car"  # which class?\n' in draft
    assert '# in values, too: "b\\"r" = "car"  # which class?\n' in draft
    assert "text in the column" not in draft


def test_texts_that_a_mapping_makes_no_class_of_are_named(tmp_path: Path) -> None:
    log = _table(tmp_path, "foo", "bar")
    draft = inspect(InspectRequest(str(log))).content.draft_mapping or ""
    mapping = tmp_path / "draft.toml"
    unfilled = draft.replace('"car" = "car"', "").replace("ids = []", 'ids = ["0"]')
    mapping.write_text(unfilled, encoding="utf-8")
    found = looked(log, mapping=str(mapping))
    said = "column type: 'bar', 'car', 'foo' are not in [class] values of the mapping"
    (classes,) = [item for item in found.egos[0].missing_signals if item.signal == "actor_classes"]
    assert classes.reason == said
    assert "in values a class for each of its texts" in classes.provide
    assert said in [item.message for item in found.quality]
    mapping.write_text(unfilled.replace("values = {", 'values = { "foo" = "van"'), encoding="utf-8")
    assert "unmapped_class" not in [item.check_id for item in looked(log, mapping=str(mapping)).quality]


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        (b"", "the file is empty"),
        (b"<html>404</html>", "no reader for this file"),
        (b"\x89MCAP0\r\n\x01", "ends without a footer"),
        (b"PAR1 not really", "not readable as Parquet"),
        (b"a,b\n1,2\n", "no shipped mapping fits"),
        (b"\xff\xfe,b\n1,2\n", "no shipped mapping fits"),
        (b'<?xml version="1.0"?><OpenDRIVE>', "this is a map, not a log"),
    ],
)
def test_files_that_are_no_drives(tmp_path: Path, content: bytes, problem: str) -> None:
    (tmp_path / "log").write_bytes(content)
    found = inspect(InspectRequest(str(tmp_path / "log")))
    assert problem in (found.problem or "")
    assert (found.drive, exit_code(found)) == (None, ExitCode.NOT_JUDGED)


def test_several_logs_are_refused(tmp_path: Path) -> None:
    for name in ("a.csv", "b.csv"):
        (tmp_path / name).write_text("x\n", encoding="utf-8")
    with pytest.raises(UsageError, match=r"2 logs \(a\.csv, b\.csv\)"):
        inspect(InspectRequest(str(tmp_path)))


def test_every_signal_that_the_library_tells_has_advice() -> None:
    told = rows(
        derived(scene([standing("ego", road(), times(1.0), 5.0, 0.0)], None), tables=["capability"]), "FROM capability"
    )
    signals = {row["signal"] for row in told}
    assert "registration" in signals
    assert signals | RULE_CONDITION_VALUES.keys() == set(ADVICE)
    for signal in signals:
        for log_format in ("osi-mcap", "osi-file", "canonical-parquet", "esmini"):
            assert "{" not in how_to_provide(signal, log_format)


def test_an_osi_file_has_no_place_for_declared_events() -> None:
    table = "use drivelint convert --to parquet, and add declared_event.parquet (columns drive_id, actor_id, t_ns, event, value)"
    assert how_to_provide("declared_events", "osi-file").endswith(f": a .osi file cannot contain them: {table}")
    assert how_to_provide("declared_events", "osi-mcap").endswith(
        "drivelint.DeclaredEvent (keys t_ns, actor_id, event, value)"
    )
    for log_format, how in (("osi-file", table), ("osi-mcap", "a channel of JSON messages")):
        told = how_to_provide("mode_headlights", log_format)
        assert "either the signal vehicle_classification.light_state.head_light" in told
        assert "or, with the values on and off, the declared event headlights" in told
        assert how in told


def test_the_json_is_as_its_schema_says(study: Inspection) -> None:
    """The schema in the repository is made from the code; a key that goes must be seen in a diff of it."""
    assert (folder("schemas") / "inspect.schema.json").read_bytes() == json_schema(), "write it anew with json_schema()"
    text = to_json(study)
    assert msgspec.json.decode(text, type=Inspection) == study
    assert list(json.loads(text)) == ["inspect_schema", "file", "content", "problem", "drive"]


@pytest.mark.ci
def test_the_same_every_time(study: Inspection) -> None:
    road = shared("overtake_case_study/t_junction.xodr")
    again = inspect(InspectRequest(str(shared("overtake_case_study/safe.csv")), map=road, mapping="carla-testbench"))
    assert to_json(again) == to_json(study)
