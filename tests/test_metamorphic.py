"""What may not matter: which side is driven on, where the world lies and when, the rate of the samples, who stands first.

By all stable rules of all packs: the scenes of the library, and the drives with one planted violation of every rule. A change is
made to tables and map text, after whatever made them.
"""

from __future__ import annotations

import math
import re
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from lxml import etree

from drivelint.engine.batch import Drive
from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests.clean.chapters import CHAPTERS
from tests.clean.judging import renamed_drive
from tests.clean.planted import PLANTED
from tests.clean.roads import open_road
from tests.clean.story import Story
from tests.cut_sections import with_sections_cut
from tests.demo import scene as sampling
from tests.demo import scene_drive
from tests.demo.scenes import all_scenes
from tests.scenes import Row, verdict_rows

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from numpy.typing import NDArray

    from drivelint.drive.trace import Trace

STABLE = ("status:stable",)
PROFILES = ("relaxed", "nominal", "aggressive", "observed")
OUTCOME = ("rule_id", "profile", "object_id", "occurrence", "verdict", "reason_code", "near_miss")
TIMES = ("t_ref_ns", "t_start_ns", "t_end_ns")
NUMBERS = ("observed", "required", "margin")
NEVER = 1e6  # two equal speeds close in within years, or never, by their last bits
NO_SHRINKING = (Phase.explicit, Phase.reuse, Phase.generate)  # an example takes seconds, and is small as it is
OTHER_SIDE = {"left": "right", "right": "left"}


class Case(NamedTuple):
    """A log and the text of its map."""

    trace: Trace
    text: str

    def drive(self, name: str) -> Drive:
        """Return it ready for the bench, under a name."""
        return renamed_drive(Drive(self.trace, load_map(MapSource("road.xodr", self.text.encode()))), name)


class Move(NamedTuple):
    """Turned about the origin (rad), then moved (m); the clock set forward (s); rows in an order of this seed."""

    turn: float = 0.0
    x: float = 0.0
    y: float = 0.0
    t_s: int = 0
    seed: int = 0


FAR = Move(1.234, -3210.5, 987.25, 1_234_567, 3)


@cache
def cases() -> dict[str, Case]:
    """Return the scenes of the library, and the drives with a planted violation by the rule that they break."""
    found = {scene.name: Case(scene_drive.drive_of_scene(scene).trace, scene.map_text) for scene in all_scenes()}
    for each in PLANTED:
        if each.chapter:
            story = Story(each.nation)
            open_road(story)
            CHAPTERS[each.chapter](story, **each.change)
            open_road(story)
            found[each.rule] = Case(story.drive(each.rule).trace, story.route.text())
    return found


def sampled(rate_hz: int) -> dict[str, Case]:
    """Return the scenes of the library with so many samples a second."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sampling, "SAMPLE_RATE_HZ", rate_hz)
        return {
            scene.name: Case(scene_drive.drive_of_scene(replace(scene)).trace, scene.map_text) for scene in all_scenes()
        }


def move_case(case: Case, move: Move) -> Case:
    """Return the case elsewhere and at another time, the rows of its tables in another order."""
    cos, sin = math.cos(move.turn), math.sin(move.turn)
    said = case.trace.tables["actor_state"]
    turned = {"yaw_rad": floats(said, "yaw_rad") + move.turn}
    for (x, y), (dx, dy) in {
        ("x_m", "y_m"): (move.x, move.y), ("vx_mps", "vy_mps"): (0.0, 0.0), ("ax_mps2", "ay_mps2"): (0.0, 0.0),
    }.items():  # fmt: skip
        turned[x] = cos * floats(said, x) - sin * floats(said, y) + dx
        turned[y] = sin * floats(said, x) + cos * floats(said, y) + dy
    random = np.random.default_rng(move.seed)
    tables = {}
    for name, table in (case.trace.tables | {"actor_state": replaced(said, turned)}).items():
        times = [c for c in ("t_ns", "t_start_ns", "t_end_ns") if c in table.schema.names]
        later = replaced(table, {c: pc.add(table[c], move.t_s * 10**9) for c in times})
        tables[name] = later.take(random.permutation(table.num_rows))

    def again(geometry: re.Match[str]) -> str:
        x, y, heading = (float(value) for value in geometry.groups())
        x, y = cos * x - sin * y + move.x, sin * x + cos * y + move.y
        return f'x="{x!r}" y="{y!r}" hdg="{heading + move.turn!r}"'

    text = re.sub(r'x="([^"]+)" y="([^"]+)" hdg="([^"]+)"', again, case.text)
    return Case(replace(case.trace, tables=tables), text)


SIGNED = {  # element: attributes that change their sign with the side
    "geometry": ("y", "hdg"), "arc": ("curvature",), "laneOffset": ("a", "b", "c", "d"), "lane": ("id",),
    "signal": ("t", "hOffset"), "object": ("t", "hdg"), "cornerRoad": ("t",), "cornerLocal": ("v",),
    "laneLink": ("from", "to"), "validity": ("fromLane", "toLane"),
}  # fmt: skip
SWAPPED = {"left": "right", "right": "left"}
UNSIGNED = {
    "OpenDRIVE", "header", "road", "link", "type", "speed", "planView", "line", "lanes", "laneSection", "center", "width", "roadMark",
    "predecessor", "successor", "signals", "objects", "outline", "outlines", "junction", "connection", "access", "userData", "priority",
    "controller", "control", "elevationProfile", "elevation", "lateralProfile", "geoReference", "markings", "marking",
} | SIGNED.keys() | SWAPPED.keys()  # fmt: skip


def mirrored_map(text: str) -> str:
    """Return the text of the mirrored map. Errors: `LookupError` for an element of which nobody has thought yet."""
    root = etree.fromstring(text.encode())
    for element in root.iter(etree.Element):
        name = str(element.tag)
        if name not in UNSIGNED:
            raise LookupError(f"<{name}>: say in SIGNED or UNSIGNED how a mirror shows it")
        for attribute in SIGNED.get(name, ()):
            if attribute in element.attrib:
                element.attrib[attribute] = negated(str(element.attrib[attribute]))
        if name in {"predecessor", "successor"} and "id" in element.attrib:  # of a lane: roads have an elementId
            element.attrib["id"] = negated(str(element.attrib["id"]))
        if name == "road" and "rule" in element.attrib:
            element.attrib["rule"] = {"LHT": "RHT", "RHT": "LHT"}[str(element.attrib["rule"])]
    for section in root.iter("laneSection"):
        sides = {str(side.tag): side for side in section if side.tag in SWAPPED}
        for name, side in sides.items():
            side.tag = SWAPPED[name]
            side[:] = reversed(side)
        section[:] = sorted(section, key=lambda side: ("left", "center", "right").index(str(side.tag)))
    return etree.tostring(root, encoding="unicode")


def negated(number: str) -> str:
    if not float(number):
        return number
    return number[1:] if number.startswith("-") else f"-{number}"


def mirrored(case: Case) -> Case:
    """Return the case as a mirror shows it: driven on the other side, bends and turns to the other side."""
    said = case.trace.tables["actor_state"]
    lamps = [OTHER_SIDE.get(lamp, lamp) for lamp in said["indicator"].to_pylist()]
    flipped = {name: -floats(said, name) for name in ("y_m", "yaw_rad", "vy_mps", "ay_mps2")}
    tables = case.trace.tables | {"actor_state": replaced(said, {**flipped, "indicator": lamps})}
    return Case(replace(case.trace, tables=tables), mirrored_map(case.text))


def replaced(table: pa.Table, columns: Mapping[str, object]) -> pa.Table:
    """Return the table with some of its columns replaced; NaN is NULL."""
    for name, values in columns.items():
        field = table.schema.field(name)
        column = values if isinstance(values, pa.ChunkedArray) else pa.array(values, field.type, from_pandas=True)
        table = table.set_column(table.schema.get_field_index(name), field, column)
    return table


def floats(table: pa.Table, name: str) -> NDArray[np.float64]:
    return np.asarray(pc.fill_null(table[name], float("nan")).to_numpy(), np.float64)


def verdicts(cases: Mapping[str, Case]) -> dict[str, list[Row]]:
    """Return the rows of each case."""
    rows: dict[str, list[Row]] = {name: [] for name in cases}
    for row in verdict_rows([case.drive(name) for name, case in cases.items()], rules=STABLE, profiles=PROFILES):
        rows[row["drive_id"]].append(row)
    return rows


def rows_before_and_after(
    before: Mapping[str, Case], after: Mapping[str, Case]
) -> tuple[dict[str, list[Row]], dict[str, list[Row]]]:
    """Return the rows of the cases before and after a change; all are judged at once."""
    first = {f"{name}, before": case for name, case in before.items()}
    rows = verdicts(first | {f"{name}, after": case for name, case in after.items()})
    return {name: rows[f"{name}, before"] for name in before}, {name: rows[f"{name}, after"] for name in after}


def same(before: Mapping[str, list[Row]], after: Mapping[str, list[Row]], later_s: int = 0) -> None:
    """Hold that every row is there again, so many seconds later."""
    for name, rows in before.items():
        for a, b in zip(rows, after[name], strict=True):
            assert [a[c] for c in OUTCOME] == [b[c] for c in OUTCOME], (name, a, b)
            expected = [None if a[c] is None else a[c] + later_s * 10**9 for c in TIMES]
            # a sample exactly on the joint of two lanes is on either, by its last bits: a stretch may begin there a sample sooner or later
            assert [b[c] for c in TIMES] == [
                None if t is None else pytest.approx(t, rel=0, abs=1e8) for t in expected
            ], (name, a, b)
            for column in NUMBERS:
                x, y = (None if row[column] is None else min(row[column], NEVER) for row in (a, b))
                assert y == (None if x is None else pytest.approx(x, abs=2e-3)), (name, a, b)


@pytest.mark.slow
def test_the_world_in_a_mirror_elsewhere_and_later() -> None:
    """All at once: mirrored, turned and moved, its clock set, its rows shuffled. Every other case: all take twice as long."""
    some = dict(list(cases().items())[::2])
    before, after = rows_before_and_after(some, {name: move_case(mirrored(case), FAR) for name, case in some.items()})
    assert {row["verdict"] for rows in before.values() for row in rows} == {"pass", "fail", "unknown", "not_applicable"}
    assert len({row["rule_id"] for rows in before.values() for row in rows if row["verdict"] == "fail"}) > 30
    same(before, after, FAR.t_s)


@pytest.mark.slow
@settings(max_examples=2, deadline=None, phases=NO_SHRINKING)
@given(
    st.builds(
        Move, st.floats(-math.pi, math.pi), st.floats(-1e5, 1e5), st.floats(-1e5, 1e5), st.integers(0, 2_000_000_000),
        st.integers(0, 99),
    ),
    st.deferred(lambda: st.sets(st.sampled_from(sorted(cases())), min_size=3, max_size=3)),  # they take seconds to make
    st.booleans(),
)  # fmt: skip
def test_where_and_when_does_not_matter(move: Move, names: set[str], mirror: bool) -> None:
    some = {name: cases()[name] for name in sorted(names)}
    changed = {name: move_case(mirrored(case) if mirror else case, move) for name, case in some.items()}
    same(*rows_before_and_after(some, changed), move.t_s)


@pytest.mark.slow
def test_lane_sections_cut_in_two_change_no_verdict() -> None:
    """A map cuts its lanes as it likes: by lane sections, and the reader where the type of the road changes. Some of the cases."""
    some = dict(list(cases().items())[::9])
    cut = {name: case._replace(text=with_sections_cut(case.text)) for name, case in some.items()}
    before, after = rows_before_and_after(some, cut)
    assert {row["verdict"] for rows in before.values() for row in rows} == {"pass", "fail", "unknown", "not_applicable"}
    same(before, after)


def every_second_sample(case: Case) -> Case:
    """Return the case with the samples at whole tenths of a second."""
    states = case.trace.tables["actor_state"]
    kept = states.filter(pa.array(states["t_ns"].to_numpy() % 100_000_000 == 0))
    assert 0 < 2 * kept.num_rows - states.num_rows < 10
    return case._replace(trace=replace(case.trace, tables=case.trace.tables | {"actor_state": kept}))


def follows_from_the_samples(rule_id: str, outcome_of_few: tuple[str, ...]) -> bool:
    """Return whether twice the samples may change this verdict: they halve the errors of measures."""
    return rule_id.startswith("comfort.") and outcome_of_few == ("unknown", "within_error")


@pytest.mark.slow
def test_twice_the_samples_change_no_verdict() -> None:
    """The worst one by object: an object that is on course, for three samples not, and on course again has one row or two."""
    cases = sampled(20)
    found = rows_before_and_after({name: every_second_sample(case) for name, case in cases.items()}, cases)
    for name, rows in found[0].items():
        few, many = worst(rows), worst(found[1][name])
        assert few.keys() == many.keys(), name
        changed = [key for key in few if few[key] != many[key]]
        assert [key for key in changed if not follows_from_the_samples(key[0], few[key])] == [], name


def worst(rows: Iterable[Mapping[str, object]]) -> dict[tuple[str, ...], tuple[str, ...]]:
    """Return the worst verdict with its reason's code by rule, profile and object."""
    order = ("error", "fail", "unknown", "pass", "not_applicable")
    said: dict[tuple[str, ...], list[tuple[str, ...]]] = {}
    for row in rows:
        key = tuple(str(row[c]) for c in ("rule_id", "profile", "object_id"))
        said.setdefault(key, []).append((str(row["verdict"]), str(row["reason_code"])))
    return {key: min(each, key=lambda v: (order.index(v[0]), v[1])) for key, each in said.items()}


@pytest.mark.ci
@pytest.mark.parametrize("name", ["overtake-on-bend", "ukhc.r171.stop-sign"])
def test_a_mirror_is_the_road_driven_on_the_other_side(name: str) -> None:
    case = cases()[name]
    maps = [mirrored_map(mirrored_map(case.text)), case.text, mirrored_map(case.text)]
    twice, once, other = (load_map(MapSource("road.xodr", text.encode())) for text in maps)
    for table, rows in once.tables.items():
        own = {"environment_id", "sha256"}.intersection(rows.schema.names)  # what the bytes of the text give
        assert twice.tables[table].drop(own) == rows.drop(own), table
    assert {once.handedness, other.handedness} == {"lht", "rht"}
    lanes = [m.tables["lanelet"].sort_by([("length_m", "ascending")])["length_m"].to_pylist() for m in (once, other)]
    assert lanes[1] == pytest.approx(lanes[0])
