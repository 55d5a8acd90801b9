"""The numbers of an annotated log against the tables of the run, and against computations that share nothing with it."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow.parquet as pq
import pytest
from mcap.reader import SeekingReader
from shapely import affinity
from shapely.geometry import Polygon, box

from drivelint.annotate import measures
from drivelint.annotate.annotator import LAYOUT_FILE
from drivelint.annotate.layout import MAX_SERIES, layout_json
from drivelint.annotate.measures import MarginSeries
from drivelint.resources import folder
from drivelint.result.geometry import without_geometry
from drivelint.sql.declarations import column_comments
from tests.annotate.runs import CASE, run, the
from tests.annotate.viewer import messages, yaw

if TYPE_CHECKING:
    from collections.abc import Iterable

    from tests.annotate.viewer import TimedMessage

NAMES = ("safe", "near_miss", "collision")
EGO, PARKED, ONCOMING = "ego", "parked", "oncoming"
HALF_LENGTH_M, HALF_WIDTH_M = 2.4, 0.9
Boxes = dict[int, dict[str, Polygon]]


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("measured")
    run(out, *(CASE / f"{name}.csv" for name in NAMES), rules=("ukhc", "criticality"), margins=True)
    (out / ".margins.parquet").rename(out / "margins.parquet")
    return out


def content(timed_messages: Iterable[TimedMessage]) -> list[dict[str, Any]]:
    return [json.loads(said.content) for said in timed_messages]


def margin_topics(path: Path) -> list[str]:
    with path.open("rb") as file:
        summary = SeekingReader(file).get_summary()
    assert summary is not None
    topics = (channel.topic.removeprefix("/drivelint/") for channel in summary.channels.values())
    return sorted(topic for topic in topics if topic.startswith("margins/"))


def rows(out: Path, table: str, drive: str) -> list[dict[str, Any]]:
    return [
        row for row in without_geometry(pq.read_table(out / f"{table}.parquet")).to_pylist() if row["drive_id"] == drive
    ]


def boxes(path: Path) -> Boxes:
    """Return the boxes of all actors by time, from the scene."""
    plain = box(-HALF_LENGTH_M, -HALF_WIDTH_M, HALF_LENGTH_M, HALF_WIDTH_M)
    placed: Boxes = {}
    for said in messages(path, "scene"):
        for entity in said.content.entities:
            pose = entity.cubes[0].pose
            turned = affinity.rotate(plain, yaw(pose), origin=(0, 0), use_radians=True)
            placed.setdefault(said.log_time, {})[entity.id] = affinity.translate(
                turned, pose.position.x, pose.position.y
            )
    return placed


@pytest.mark.ci
@pytest.mark.parametrize("name", NAMES)
def test_margins_are_rows_of_the_margin_table(out: Path, name: str) -> None:
    path = the(out / "annotated", name)
    table: dict[tuple[Any, ...], list[dict[str, Any]]] = {}
    for row in rows(out, "margins", path.stem):
        key = (row["rule_id"], row["profile"], row["ego_id"], row["object_id"], row["t_ns"])
        table.setdefault(key, []).append({k: v for k, v in row.items() if v is not None})
    said = [(topic, row) for topic in margin_topics(path) for row in content(messages(path, topic))]
    assert said
    for topic, row in said:
        assert topic == measures.margin_topic(row["rule_id"])
        key = (row["rule_id"], row.get("profile"), row["ego_id"], row.get("object_id"), row["t_ns"])
        assert row in [{k: v for k, v in one.items() if k in row} for one in table[key]]
        missing = {"observed", "required", "margin", "holds"} - row.keys()
        assert all(not missing & one.keys() for one in table[key]), "left out is what the table does not know"


@pytest.mark.ci
@pytest.mark.parametrize("name", NAMES)
def test_of_several_at_a_step_the_worst_is_said_once(out: Path, name: str) -> None:
    path = the(out / "annotated", name)
    worst: dict[tuple[Any, ...], float] = {}
    for course in rows(out, "courses", path.stem):
        for t, margin in zip(course["t_ns"], course["margin"], strict=True):
            key = (course["rule_id"], course["profile"], t)
            worst[key] = min(worst.get(key, math.inf), math.inf if margin is None else margin)
    said = [row for topic in margin_topics(path) for row in content(messages(path, topic))]
    found = {(row["rule_id"], row.get("profile"), row["t_ns"]): row.get("margin", math.inf) for row in said}
    assert len(found) == len(said)
    assert found == worst
    for finding in rows(out, "findings", path.stem):
        if finding["margin"] is not None:
            assert found[finding["rule_id"], finding["profile"], finding["t_worst_ns"]] <= finding["margin"] <= 0


@pytest.mark.ci
@pytest.mark.parametrize("name", NAMES)
def test_the_distance_to_the_nearest_is_that_of_the_boxes(out: Path, name: str) -> None:
    path = the(out / "annotated", name)
    placed, near = boxes(path), 0
    for row in content(messages(path, "measures")):
        ego, *others = (placed[row["t_ns"]][who] for who in (EGO, PARKED, ONCOMING))
        least = min(map(ego.distance, others))
        if "clearance_m" in row and row["clearance_m"] > 0:
            assert row["clearance_m"] == pytest.approx(least, abs=1e-6)
            assert ego.distance(placed[row["t_ns"]][row["nearest_id"]]) == pytest.approx(least, abs=1e-6)
            near += 1
        else:
            assert least == 0 if "clearance_m" in row else least > 29
    assert near > 50


@pytest.mark.ci
@pytest.mark.parametrize("name", NAMES)
def test_speed_gap_and_required_gap_are_those_of_the_boxes(out: Path, name: str) -> None:
    path = the(out / "annotated", name)
    said = content(messages(path, "measures"))
    placed = boxes(path)
    assert [row["t_ns"] for row in said] == sorted(placed), "one message per step"
    assert all(row["ego_id"] == EGO for row in said)
    for row, then in zip(said[1:], said, strict=False):
        if abs(row.get("accel_mps2", 9.0)) < 0.5:
            way = placed[row["t_ns"]][EGO].centroid.distance(placed[then["t_ns"]][EGO].centroid)
            assert row["speed_mps"] == pytest.approx(way / (row["t_ns"] - then["t_ns"]) * 1e9, abs=0.35)
            assert row["accel_mps2"] == pytest.approx((row["speed_mps"] - then["speed_mps"]) / 0.1, abs=0.01)
    oncoming = [row for row in said if "oncoming_gap_m" in row]
    assert {row["oncoming_id"] for row in oncoming} == {ONCOMING}
    for row in oncoming:
        apart = placed[row["t_ns"]][EGO].centroid.distance(placed[row["t_ns"]][ONCOMING].centroid)
        assert row["oncoming_gap_m"] == pytest.approx(apart - 2 * HALF_LENGTH_M, abs=0.6)
        assert row["oncoming_required_m"] > row["stopping_m"] > 0
    assert not any("oncoming_gap_m" in row for row in said if row["t_ns"] < 7_700_000_000), "no overtake yet"


@pytest.mark.ci
@pytest.mark.parametrize("name", NAMES)
def test_the_time_to_collision_is_that_of_its_rule(out: Path, name: str) -> None:
    path = the(out / "annotated", name)
    said = {(row["t_ns"], row["ttc_id"]): row["ttc_s"] for row in content(messages(path, "measures")) if "ttc_s" in row}
    judged: dict[int, dict[str, float]] = {}
    for row in rows(out, "margins", path.stem):
        # where it is not known whether the two may touch, the rule does not judge the time that it observes
        if row["rule_id"] == "criticality.ttc" and row["observed"] is not None and row["holds"] is not None:
            judged.setdefault(row["t_ns"], {})[row["object_id"]] = row["observed"]
    assert len(said) > 20
    assert {
        (t, who): seconds for t, one in judged.items() for who, seconds in one.items() if seconds == min(one.values())
    } == said


@pytest.mark.ci
def test_what_is_not_known_is_left_out(tmp_path: Path) -> None:
    """Without a map nobody knows who comes the other way in which lane, nor a speed limit."""
    path = the(run(tmp_path, CASE / "collision.csv", map=None), "collision")
    said = content(messages(path, "measures"))
    assert len(said) > 100
    assert not {key for row in said for key in row} & {
        "oncoming_gap_m", "oncoming_required_m", "oncoming_id", "limit_mps"
    }  # fmt: skip
    assert "accel_mps2" not in said[0], "the first step has none before it"


@pytest.mark.slow
def test_of_a_long_drive_every_nth_step_is_measured(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = content(messages(the(run(tmp_path / "a", CASE / "safe.csv"), "safe"), "measures"))
    monkeypatch.setattr(measures, "MAX_WRITTEN_STEPS", 50)
    fewer = content(messages(the(run(tmp_path / "b", CASE / "safe.csv"), "safe"), "measures"))
    assert len(fewer) <= 50
    assert fewer == whole[:: -(-len(whole) // 50)]


@pytest.mark.ci
@pytest.mark.parametrize("name", ["measures", "margin"])
def test_every_message_keeps_its_schema(out: Path, name: str) -> None:
    jsonschema = pytest.importorskip("jsonschema")
    schema = json.loads((folder("schemas") / f"{name}-message.schema.json").read_bytes())
    check = jsonschema.Draft202012Validator(schema)
    path = the(out / "annotated", "collision")
    for topic in ("measures",) if name == "measures" else margin_topics(path):
        for row in content(messages(path, topic)):
            check.validate(row)


def test_a_margin_has_the_columns_of_the_table() -> None:
    schema = json.loads((folder("schemas") / "margin-message.schema.json").read_bytes())
    comments = column_comments("verdict")["margin"]
    assert {key: field["description"] for key, field in schema["properties"].items()} == {
        key: comments[key] for key in schema["properties"]
    }


@pytest.mark.ci
def test_an_event_is_a_finding_from_its_first_to_its_last_failing_step(out: Path) -> None:
    for name in NAMES:
        path = the(out / "annotated", name)
        findings = {row["finding_id"]: row for row in rows(out, "findings", path.stem)}
        for said in messages(path, "events"):
            facts = {pair.key: pair.value for pair in said.content.metadata}
            assert len(facts) == len(said.content.metadata), "Foxglove asks for keys that are unique"
            row = findings.pop(facts["finding_id"])
            start, end = said.content.start_time.ToNanoseconds(), said.content.end_time.ToNanoseconds()
            assert (said.log_time, start, end) == (row["t_start_ns"], row["t_start_ns"], row["t_end_ns"])
            assert {facts[key] for key in ("rule_id", "severity", "reason")} == {
                row[key] for key in ("rule_id", "severity", "reason")
            }
            assert facts.get("profile") == row["profile"]
            if row["margin"] is not None:
                assert float(facts["margin"].split()[0]) == pytest.approx(row["margin"], abs=0.0051)
            assert "certainty" not in facts or row["n_copies"] is not None
        assert not findings


@pytest.mark.ci
def test_every_line_of_a_plot_leads_to_numbers_of_some_drive(out: Path) -> None:
    said: dict[str, list[dict[str, Any]]] = {}
    for path in (the(out / "annotated", name) for name in NAMES):
        for topic in ("measures", *margin_topics(path)):
            said.setdefault(f"/drivelint/{topic}", []).extend(content(messages(path, topic)))
    panels = json.loads((out / "annotated" / LAYOUT_FILE).read_bytes())["configById"]
    lines = [line for key, panel in panels.items() if key.startswith("Plot!") for line in panel["paths"]]
    assert len(lines) > 12
    for line in lines:
        if line["value"] == "0":
            continue
        # a viewer's path: the topic without dots, a filter, a field
        parts = re.fullmatch(r'((?:/[\w-]+)+)(?:\{profile=="([\w-]+)"\})?\.(\w+)', line["value"])
        assert parts is not None, line["value"]
        values = [row[parts[3]] for row in said[parts[1]] if row.get("profile") == parts[2] and parts[3] in row]
        assert values, line["value"]
        assert np.isfinite(values).all()


def test_the_plot_of_margins_shows_the_worst_rules_whatever_the_order() -> None:
    series = [MarginSeries(k % 3, f"pack.r{k}.rule", "", "m") for k in range(30)]
    assert layout_json(series) == layout_json(series[::-1])
    paths = json.loads(layout_json(series))["configById"]["Plot!drivelint-margins"]["paths"]
    assert [path["value"] for path in paths[1:]] == [
        f"/drivelint/margins/pack/{one.rule_id.split('.')[1]}/rule.margin" for one in sorted(series)[:MAX_SERIES]
    ]
    assert {one.severity for one in sorted(series)[:MAX_SERIES]} == {0}


def test_plots_are_configured_as_foxgloves_own_package_does() -> None:
    package = pytest.importorskip("foxglove.layouts", reason="the package foxglove-sdk has no layouts")
    line = {"value": "/a.b", "label": "x", "enabled": True, "timestampMethod": "receiveTime"}
    known = set(package.PlotConfig()._to_dict()) | {"foxglovePanelTitle"}
    known_of_line = set(package.PlotSeries()._to_dict())
    assert line.keys() <= known_of_line
    for key, panel in json.loads(layout_json([MarginSeries(0, "a.b", "p", "m")]))["configById"].items():
        if key.startswith("Plot!"):
            assert panel.keys() <= known
            assert all(path.keys() <= known_of_line for path in panel["paths"])
