"""Annotated logs of whole runs, read back as a viewer and as a program would."""

from __future__ import annotations

import json
import math
import shutil
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow.parquet as pq
import pytest
from mcap.reader import SeekingReader
from mcap.writer import Writer
from shapely.geometry import Point, Polygon
from shapely.ops import unary_union

from drivelint import __version__
from drivelint.annotate import actor_boxes, result_messages
from drivelint.annotate.annotator import LAYOUT_FILE
from drivelint.drive.trace import IngestOptions
from drivelint.engine import batch
from drivelint.errors import TraceError
from drivelint.evaluate import evaluate
from drivelint.formats import read_trace
from drivelint.result.geometry import without_geometry
from drivelint.result.publishing import OutputError
from tests.annotate.files import seeking, streaming, verify
from tests.annotate.runs import CASE, ROOT, run, the
from tests.annotate.viewer import SCENES, messages, played, points, visible_entities, yaw

if TYPE_CHECKING:
    from collections.abc import Mapping

SCENE = ROOT / "fixtures" / "scenes"
T0 = 7_700_000_000  # the ego first leaves its lane
EGO, PARKED, ONCOMING = "ego", "parked", "oncoming"
SD = {"a": 0.300, "b": 0.058, "c": -0.011, "d": 0.015}


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("case")
    run(out, *(CASE / f"{name}.csv" for name in ("safe", "near_miss", "collision")))
    return out


@pytest.fixture(scope="module")
def logged(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A log of the scene library whose container has a clock of its own, and its annotated one."""
    home = tmp_path_factory.mktemp("logged")
    path = home / "near-miss.mcap"
    later(SCENE / "near-miss.mcap", path, LATER)
    return path, the(run(home / "out", path, map=SCENE / "overtake-road.xodr", mapping=None), "near-miss")


LATER = 1_700_000_000_123_456_789


def later(source: Path, target: Path, by_ns: int) -> None:
    """Write a log again with all its log times moved."""
    with source.open("rb") as file, target.open("wb") as copy:
        writer = Writer(copy)
        writer.start()
        ids: dict[int, int] = {}
        for schema, channel, message in SeekingReader(file).iter_messages():
            assert schema is not None
            if channel.id not in ids:
                known = writer.register_schema(schema.name, schema.encoding, schema.data)
                ids[channel.id] = writer.register_channel(channel.topic, channel.message_encoding, known)
            time = message.log_time + by_ns
            writer.add_message(ids[channel.id], time, message.data, time, message.sequence)
        writer.finish()  # type: ignore[no-untyped-call]


def rows(out: Path, table: str, drive: str) -> list[dict[str, Any]]:
    found = without_geometry(pq.read_table(out / f"{table}.parquet"))
    return [row for row in found.to_pylist() if row["drive_id"] == drive]


def annotated_values(row: Mapping[str, Any]) -> dict[str, Any]:
    # logs are annotated before copies with recording errors are judged
    return {key: value for key, value in row.items() if value is not None and key not in {"n_copies", "n_stays"}}


@pytest.mark.ci
@pytest.mark.parametrize("name", ["safe", "near_miss", "collision"])
def test_every_verdict_and_finding_is_a_message_at_its_time(out: Path, name: str) -> None:
    path = the(out / "annotated", name)
    verify(path)
    verdicts = rows(out, "verdicts", path.stem)
    said = messages(path, "verdicts")
    assert sorted(map(repr, (json.loads(m.content) for m in said))) == sorted(
        map(repr, map(annotated_values, verdicts))
    )
    for message in said:
        row = json.loads(message.content)
        due = [row[key] for key in ("t_ref_ns", "t_worst_ns", "t_start_ns") if key in row]
        assert message.log_time == (due[0] if due else 0)
    findings = rows(out, "findings", path.stem)
    found = messages(path, "findings")
    assert sorted(map(repr, (json.loads(m.content) for m in found))) == sorted(
        map(repr, map(annotated_values, findings))
    )
    assert all(m.log_time == json.loads(m.content)["t_start_ns"] for m in found)
    assert bool(found) == (len(findings) > 0)


@pytest.mark.ci
def test_every_actor_has_its_box_at_every_step(out: Path) -> None:
    path = the(out / "annotated", "near_miss")
    states = read_trace(CASE / "near_miss.csv", IngestOptions(mapping=str(CASE / "mapping.toml"))).tables["actor_state"]
    expected = {(row["t_ns"], row["actor_id"]): row for row in states.to_pylist()}
    for said in messages(path, "scene"):
        for entity in said.content.entities:
            row = expected.pop((said.log_time, entity.id))
            assert (entity.frame_id, entity.timestamp.ToNanoseconds()) == ("map", said.log_time)
            (cube,) = entity.cubes
            assert (cube.pose.position.x, cube.pose.position.y) == (row["x_m"], row["y_m"])
            assert yaw(cube.pose) == pytest.approx(row["yaw_rad"])
            assert (cube.size.x, cube.size.y) == (4.8, 1.8)
            assert (cube.color.b > 0.9) == (entity.id == EGO), "only the ego is blue"
    assert not expected


@pytest.mark.ci
def test_a_viewer_can_follow_the_ego(out: Path) -> None:
    path = the(out / "annotated", "safe")
    boxes = {said.log_time: {e.id: e for e in said.content.entities} for said in messages(path, "scene")}
    moves = messages(path, "tf")
    assert [said.log_time for said in moves] == sorted(boxes)
    for said in moves:
        move, (cube,) = said.content, boxes[said.log_time][EGO].cubes
        assert (move.parent_frame_id, move.child_frame_id) == ("map", "base_link")
        assert move.timestamp.ToNanoseconds() == said.log_time
        assert (move.translation.x, move.translation.y) == (cube.pose.position.x, cube.pose.position.y)
        assert (move.rotation.z, move.rotation.w) == (cube.pose.orientation.z, cube.pose.orientation.w)


@pytest.mark.ci
def test_lanes_lie_under_everybody_and_are_there_from_the_start(out: Path) -> None:
    path = the(out / "annotated", "safe")
    (said,) = messages(path, "map")
    assert said.log_time == messages(path, "scene")[0].log_time
    lanes = []
    for lane in said.content.entities:
        (surface,) = lane.triangles
        corners = points(surface)[np.array(surface.indices).reshape(-1, 3), :2]
        if {pair.key: pair.value for pair in lane.metadata}["lane type"] == "driving":
            lanes += [Polygon(triangle).buffer(0.01) for triangle in corners]
            assert len(lane.lines) == 2
    road = unary_union(lanes)
    for scene in messages(path, "scene")[::20]:
        for entity in scene.content.entities:
            at = entity.cubes[0].pose.position
            assert road.contains(Point(at.x, at.y))


@pytest.mark.ci
def test_a_finding_shows_the_pair_concerned_and_says_what_is_wrong(out: Path) -> None:
    path = the(out / "annotated", "near_miss")
    entities = visible_entities(path, "markers", T0)
    pair, label = entities["ego and oncoming"], entities["notes on ego"]
    boxes = visible_entities(path, "scene", T0)
    ends = [boxes[name].cubes[0].pose.position for name in (EGO, ONCOMING)]
    assert len(pair.lines) == 3
    assert points(pair.lines[2])[:, :2] == pytest.approx(np.array([[p.x, p.y] for p in ends]))
    for end, outline in zip(ends, pair.lines, strict=False):
        assert Polygon(points(outline)[:, :2]).area == pytest.approx(4.8 * 1.8)
        assert Polygon(points(outline)[:, :2]).centroid.distance(Point(end.x, end.y)) < 1e-6
    (text,) = label.texts
    lines = text.text.splitlines()
    assert "FAIL r162.safe-distance-ahead [nominal], oncoming: 58.33 m, must be > 63.75" in lines
    assert "FAIL r162.safe-distance-ahead [relaxed], oncoming: 58.33 m, must be > 101.39" in lines
    assert not any("aggressive" in line for line in lines)
    assert text.color.r > 0.8 > text.color.g


@pytest.mark.slow
def test_near_misses_are_drawn_too(logged: tuple[Path, Path]) -> None:
    _, path = logged
    near = [row for row in rows(path.parents[1], "verdicts", path.stem) if row["near_miss"]]
    assert "ukhc.no-collision" in {row["rule_id"] for row in near}
    for row in near:
        texts = [t.text for e in visible_entities(path, "markers", row["t_worst_ns"] + LATER).values() for t in e.texts]
        assert any(f"NEAR MISS {row['rule_id'].removeprefix('ukhc.')}" in text for text in texts)


@pytest.mark.ci
@pytest.mark.parametrize("name", ["safe", "near_miss", "collision"])
def test_after_a_jump_a_viewer_shows_what_it_shows_when_it_plays(out: Path, name: str) -> None:
    path = the(out / "annotated", name)
    times = [said.log_time for said in messages(path, "scene")]
    for topic in SCENES:
        assert all(said.content.entities or topic in {"markers", "danger_spaces"} for said in messages(path, topic))
        for t in times[5::17]:
            assert visible_entities(path, topic, t).keys() == played(path, topic, t).keys()


@pytest.mark.ci
def test_nothing_stays_behind_a_finding(out: Path) -> None:
    for path in (out / "annotated").glob("*.mcap"):
        ends = [row["t_end_ns"] for row in rows(out, "findings", path.stem)]
        near = [row["t_worst_ns"] for row in rows(out, "verdicts", path.stem) if row["near_miss"]]
        last = max([*ends, *near]) + 2_100_000_000
        final = messages(path, "scene")[-1].log_time
        if last < final:
            assert not visible_entities(path, "markers", last)
    assert not visible_entities(the(out / "annotated", "safe"), "danger_spaces", final)


@pytest.mark.ci
def test_danger_spaces_are_as_long_as_the_stopping_distance(out: Path) -> None:
    path = the(out / "annotated", "safe")
    drawn = messages(path, "danger_spaces")
    assert drawn[0].log_time == T0
    boxes = visible_entities(path, "scene", T0)
    (entity,) = drawn[0].content.entities
    before = {e.id: e for said in messages(path, "scene", ending_before=T0)[-1:] for e in said.content.entities}
    own, theirs = (points(line)[:, :2] for line in entity.lines)
    for name, around in ((EGO, own), (ONCOMING, theirs)):
        at, then = boxes[name].cubes[0].pose.position, before[name].cubes[0].pose.position
        v = math.hypot(at.x - then.x, at.y - then.y) / 0.1 / 0.44704
        stop = SD["a"] * v + SD["b"] + SD["c"] * v + SD["d"] * v * v
        area = Polygon(around)
        corners = list(area.minimum_rotated_rectangle.boundary.coords)
        sides = sorted(math.dist(a, b) for a, b in pairwise(corners))
        assert sides[-1] == pytest.approx(stop, rel=0.03)
        assert sides[0] == pytest.approx(1.8, abs=0.01), "as wide as the vehicle"
        assert area.distance(Point(at.x, at.y)) == pytest.approx(2.4, abs=0.2), "it begins at the bumper"
        ahead = math.atan2(area.centroid.y - at.y, area.centroid.x - at.x)
        assert math.cos(ahead - yaw(boxes[name].cubes[0].pose)) > 0.95, "in front of the vehicle"
    texts = {t.text for t in entity.texts}
    assert texts == {"ego: pulling out", "VBP", "OV"}


@pytest.mark.ci
def test_the_log_panel_says_what_a_person_should_look_at(out: Path) -> None:
    path = the(out / "annotated", "near_miss")
    lines = messages(path, "log")
    findings = rows(out, "findings", path.stem)
    worth = [r for r in rows(out, "verdicts", path.stem) if r["verdict"] in {"unknown", "error"} or r["near_miss"]]
    assert sorted(line.content.name for line in lines) == sorted(row["rule_id"] for row in (*findings, *worth))
    for row in findings:
        reason = row["reason"][1:]
        said = [m for m in lines if reason in m.content.message and (row["profile"] or "") in m.content.message]
        assert [m.log_time for m in said] == [row["t_start_ns"]], "a finding is said once, where it begins"
    (ours,) = (m for m in lines if "safe-distance-ahead [nominal]" in m.content.message)
    assert (ours.log_time, ours.content.level) == (T0, 4)
    assert ours.content.message.count("58.33") == 1, "a reason that tells the numbers tells them alone"


@pytest.mark.ci
def test_metadata_and_summary_say_what_was_judged_and_by_what(out: Path) -> None:
    path = the(out / "annotated", "collision")
    with path.open("rb") as file:
        reader = SeekingReader(file, validate_crcs=True)
        (said,) = (m.metadata for m in reader.iter_metadata() if m.name == "drivelint")
        (summary,) = (json.loads(a.data) for a in reader.iter_attachments() if a.name == "summary.json")
    drive = rows(out, "drives", path.stem)[0]
    assert said["version"] == __version__
    assert {key: said[key] for key in ("sha256", "map_sha256", "environment_id")} == {
        key: drive[key] for key in ("sha256", "map_sha256", "environment_id")
    }
    rules = {row["rule_id"]: row["rule_version"] for row in pq.read_table(out / "rules.parquet").to_pylist()}
    assert {key.removeprefix("rule "): value for key, value in said.items() if key.startswith("rule ")} == rules
    assert [d["drive_id"] for d in summary["drives"]] == [path.stem]
    verdicts = rows(out, "verdicts", path.stem)
    assert summary["verdicts"]["fail"] == sum(row["verdict"] == "fail" for row in verdicts)


def test_a_recorded_log_keeps_every_message_and_ours_lie_at_its_frames(logged: tuple[Path, Path]) -> None:
    source, path = logged
    assert [m for m in streaming(path) if not m[0].startswith("/drivelint/")] == streaming(source)
    assert [m for m in seeking(path) if not m[0].startswith("/drivelint/")] == seeking(source)
    verify(path)
    frames = {m[3] for m in streaming(source)}
    for topic in (*SCENES, "tf", "verdicts", "findings", "log"):
        assert {said.log_time for said in messages(path, topic)} <= frames
    assert {said.log_time for said in messages(path, "scene")} == frames
    (ours,) = (
        said
        for said in messages(path, "verdicts")
        if (row := json.loads(said.content))["rule_id"].endswith("safe-distance-ahead") and row["profile"] == "nominal"
    )
    assert ours.log_time == json.loads(ours.content)["t_ref_ns"] + LATER
    assert visible_entities(path, "markers", ours.log_time)


@pytest.mark.slow
def test_an_annotated_log_can_be_checked_and_annotated_again(logged: tuple[Path, Path], tmp_path: Path) -> None:
    _, once = logged
    twice = the(run(tmp_path, once, map=SCENE / "overtake-road.xodr", mapping=None), once.stem)
    topics = {m[0] for m in streaming(twice)}
    assert {"/drivelint/verdicts", "/drivelint_2/verdicts"} <= topics
    assert not any(topic.startswith("/drivelint_2/tf") for topic in topics), "the log has its own transforms now"
    assert [m for m in seeking(twice) if not m[0].startswith("/drivelint_2/")] == seeking(once)
    verify(twice)


@pytest.mark.slow
def test_the_same_bytes_alone_or_in_a_crowd_in_any_order(
    out: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(batch, "MAX_BATCH_STATES", 1)
    others = run(tmp_path / "a", *(CASE / f"{name}.csv" for name in ("collision", "safe")))
    alone = run(tmp_path / "b", CASE / "near_miss.csv")
    for path in (*others.glob("*.mcap"), *alone.glob("*.mcap")):
        assert path.read_bytes() == (out / "annotated" / path.name).read_bytes()


@pytest.mark.slow
def test_a_drive_with_too_many_boxes_shows_every_nth_step(
    out: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = messages(the(out / "annotated", "safe"), "scene")
    monkeypatch.setattr(actor_boxes, "MAX_BOXES", 300)
    path = the(run(tmp_path, CASE / "safe.csv"), "safe")
    fewer = messages(path, "scene")
    assert sum(len(said.content.entities) for said in fewer) <= 300
    every = round(len(whole) / len(fewer))
    assert [said.log_time for said in fewer] == [said.log_time for said in whole][::every]
    assert every > 1
    assert visible_entities(path, "scene", fewer[6].log_time - 1).keys() == {EGO, PARKED, ONCOMING}, (
        "boxes live until the next"
    )
    with path.open("rb") as file:
        (said,) = (m.metadata for m in SeekingReader(file).iter_metadata())
    assert said["boxes"].startswith("every ")


@pytest.mark.ci
def test_without_a_map_there_are_boxes_and_verdicts(tmp_path: Path) -> None:
    path = the(run(tmp_path, CASE / "safe.csv", map=None), "safe")
    assert not messages(path, "map")
    assert messages(path, "scene")
    assert messages(path, "verdicts")
    verify(path)


@pytest.mark.ci
def test_the_layout_shows_every_topic_that_is_there(out: Path) -> None:
    layout = json.loads((out / "annotated" / LAYOUT_FILE).read_bytes())
    panels = layout["configById"]
    assert set(panels["3D!drivelint"]["topics"]) == {f"/drivelint/{topic}" for topic in SCENES}
    assert all(topic["visible"] for topic in panels["3D!drivelint"]["topics"].values())
    moves = messages(the(out / "annotated", "safe"), "tf")
    assert panels["3D!drivelint"]["followTf"] == moves[0].content.child_frame_id
    others = {panels["RosOut!drivelint"]["topicToRender"], panels["RawMessages!drivelint"]["topicPath"]}
    assert others == {"/drivelint/log", "/drivelint/findings"}


@pytest.mark.slow
def test_a_trace_that_begins_before_zero_lies_at_zero_and_says_so(tmp_path: Path) -> None:
    lines = (CASE / "safe.csv").read_text(encoding="utf-8").splitlines()
    at = lines[0].split(",").index("time_s")
    earlier = [
        [*cells[:at], f"{float(cells[at]) - 2:.1f}", *cells[at + 1 :]] for cells in (x.split(",") for x in lines[1:])
    ]
    (tmp_path / "early.csv").write_text("\n".join([lines[0], *map(",".join, earlier)]), encoding="utf-8")
    path = the(run(tmp_path / "out", tmp_path / "early.csv"), "early")
    assert messages(path, "scene")[0].log_time == 0
    assert visible_entities(path, "danger_spaces", T0), "two seconds earlier in a log that is shown two seconds later"
    with path.open("rb") as file:
        (said,) = (m.metadata for m in SeekingReader(file).iter_metadata())
    assert said["time"] == "log time = time of the trace + 2000000000 ns"


@pytest.mark.slow
def test_no_annotate_writes_none(tmp_path: Path) -> None:
    assert not run(tmp_path, CASE / "safe.csv", annotate=False).exists()


@pytest.mark.slow
def test_a_log_that_changes_while_it_is_judged_is_not_judged(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "near-miss.mcap"
    shutil.copy(SCENE / "near-miss.mcap", path)
    plain = evaluate

    def meddling(*args: Any, **options: Any) -> None:
        plain(*args, **options)
        path.write_bytes(path.read_bytes() + b"more")

    monkeypatch.setattr("drivelint.engine.session.evaluate", meddling)
    with pytest.raises(TraceError, match="changed while it was judged"):
        run(tmp_path / "out", path, map=SCENE / "overtake-road.xodr", mapping=None)
    assert not list((tmp_path / "out").rglob("*.mcap*"))


@pytest.mark.slow
def test_a_folder_that_cannot_be_written_ends_the_run(tmp_path: Path) -> None:
    (tmp_path / "annotated").write_text("a file where the folder should be", encoding="utf-8")
    with pytest.raises(OutputError, match=r"cannot write the annotated log: .*--no-annotate"):
        run(tmp_path, CASE / "safe.csv", CASE / "collision.csv")


def test_a_headline_without_numbers_leaves_them_out() -> None:
    row = {
        "verdict": "unknown",
        "rule_id": "ukhc.a.b",
        "profile": None,
        "object_id": None,
        "observed": None,
        "required": 1.0,
    }
    assert result_messages.headline(row, {}) == "UNKNOWN a.b"
