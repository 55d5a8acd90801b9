"""What could not be seen must not pass: the case study's logs with things taken away around t0 = 8.3 s, and what is said of them.

What vanishes from a log as it is recorded, in every format, from a folder and from what a log counts, stands in tests/absence.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, TypeAlias

import pyarrow as pa
import pytest
from shapely import Polygon, box
from shapely.affinity import rotate, translate

from drivelint.drive.trace import IngestOptions
from drivelint.engine.batch import Drive
from drivelint.formats import load_map, read_trace
from drivelint.road.map_reader import MapSource
from tests import blinding, scenes
from tests.blinding import EVER, Span
from tests.shared_data import shared

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

    from drivelint.road.map_reader import MapTables

RUNS = ("safe", "near_miss", "collision")
EGO, VBP, OV = "1", "2", "3"
PROFILES = ("relaxed", "nominal", "aggressive", "observed")
SAFE_DISTANCE = "ukhc.r162.safe-distance-ahead"
SPACES_OV = ("ukhc.r126.ds-ov-out-of-av", "ukhc.r126.ds-av-out-of-ov", "ukhc.r126.ds-disjoint")
SPACE_VBP = "ukhc.r126.ds-vbp-out-of-av"
NO_COLLISION = "ukhc.no-collision"
RULES = (
    SAFE_DISTANCE, *SPACES_OV, SPACE_VBP, NO_COLLISION, "ukhc.overtake-zone", "ukhc.r124.speed-limit", "ukhc.r145.off-road",
    "ukhc.r163.cut-in", "ukhc.r163.pull-out-separation",
)  # fmt: skip
"""Those that a test below asks for: to judge the others doubles the time."""
T0 = 8.3
SPANS: dict[str, Span] = {
    "0.3": (8.0, 8.6),
    "0.5": (7.8, 8.8),
    "2": (6.3, 10.3),
    "5": (3.3, 13.3),
    "start": (-1.0, 8.8),
    "long-start": (-1.0, 13.3),
    "end": (7.8, 1e6),
    "long-end": (3.3, 1e6),
    "ever": EVER,
}
FIRST_SPANS = {"0.5", "start", "end", "ever"}
"""Those that the quick tests look at: a short one, two at the ends of the log, and all of it."""
IMPACT_RUNS = {"near_miss", "collision"}
"""In these the speeds show an impact of the ego and the oncoming vehicle, whose boxes stay apart."""
Row = dict[str, Any]


@dataclass(frozen=True)
class Case:
    """One version of one run: what was taken away, from whom, and when."""

    run: str
    change: str
    span: str = ""

    @property
    def name(self) -> str:
        """The drive's id."""
        return f"{self.run}/{self.change}/{self.span}"


Blinding: TypeAlias = "Callable[[Drive, Span], Drive]"


def _of(make: Callable[[Drive, str, Span], Drive], actor_id: str) -> Blinding:
    return lambda drive, span: make(drive, actor_id, span)


BLINDINGS: dict[str, Blinding] = {
    **{f"nulled {actor_id}": _of(blinding.nulled, actor_id) for actor_id in (VBP, OV, EGO)},
    **{f"dropped {actor_id}": _of(blinding.dropped, actor_id) for actor_id in (VBP, OV, EGO)},
    "moved 30 m": lambda drive, span: blinding.move_actor(drive, OV, span, 30.0),
    "moved 400 m": lambda drive, span: blinding.move_actor(drive, OV, span, 400.0),
    "moved VBP": lambda drive, span: blinding.move_actor(drive, VBP, span, 30.0),
    "hole": lambda drive, span: blinding.dropped(drive, None, span),
}
CUTS: dict[str, Span] = {"at t0": (8.3, 1e3), "from t0 on": (8.3, 1e3), "before t0": (8.2, 1e3), "passing": (10.0, 1e3)}
ENDS: dict[str, Span] = {"to t0": (0.0, 8.3), "to 9 s": (0.0, 9.0), "to 13 s": (0.0, 13.0)}

MAY_SPEED_UP = {
    ("near_miss", "to t0", "nominal"), ("near_miss", "to 9 s", "nominal"), ("collision", "to t0", "aggressive"),
}  # fmt: skip
"""Run, end of the log, profile: at full acceleration up to the limit, the distance would have been enough."""


def maps(road: MapTables) -> dict[str, MapTables | None]:
    """Return versions of the map with something lost; the ego runs in 3.0.1 and overtakes in 3.0.-1; 43.0.1 is straight on."""

    def guessed(table: pa.Table) -> pa.Table:
        at = table.schema.get_field_index("handedness_source")
        return table.set_column(at, "handedness_source", pa.array(["default"]))

    return {
        "running lane": blinding.without_lanelet(road, "3.0.1", "no-running"),
        "overtaking lane": blinding.without_lanelet(road, "3.0.-1", "no-overtaking"),
        "lane ahead": blinding.without_lanelet(road, "43.0.1", "no-ahead"),
        "link ahead": blinding.without_links(road, "no-link", "43.0.1"),
        "every link": blinding.without_links(road, "no-links"),
        "handedness": blinding.remade(road, "guessed", environment=guessed),
        "map": None,
    }


class VerdictRows:
    """The verdict rows of every case: those of the quick tests are judged together, and all others when one of them is asked for."""

    def __init__(self) -> None:
        self.by_drive: dict[str, list[Row]] = defaultdict(list)
        self._left = {True, False}

    def of(self, case: Case, *rules: str) -> list[Row]:
        """Return a case's rows of these rules; there is always at least one."""
        first = case.span not in SPANS or case.span in FIRST_SPANS
        if first in self._left:
            names = [name for name in SPANS if (name in FIRST_SPANS) == first]
            for row in scenes.verdict_rows(drives(names), rules=RULES, profiles=PROFILES):
                self.by_drive[row["drive_id"]].append(row)
            # not before: where the reference data are absent, every test skips, not the first alone
            self._left.remove(first)
        rows = [row for row in self.by_drive[case.name] if row["rule_id"] in rules]
        assert {row["rule_id"] for row in rows} == set(rules)
        return rows

    def verdicts_and_reasons(self, case: Case, rule: str) -> set[tuple[str, str]]:
        """Return verdicts and reason codes."""
        return {(row["verdict"], row["reason_code"]) for row in self.of(case, rule)}


@cache
def road(offset: tuple[float, float]) -> MapTables:
    content = shared("overtake_case_study/t_junction.xodr").read_bytes()
    return load_map(MapSource("t_junction.xodr", content), offset=offset)


def whole_run(run: str) -> Drive:
    """Return a run up to the end of its manoeuvre; the rest of the log would only take time."""
    trace = read_trace(shared(f"overtake_case_study/{run}.csv"), IngestOptions(mapping="carla-testbench"))
    return blinding.cut(Drive(trace, road(trace.map_offset or (0, 0))), (0.0, 24.0))


@pytest.fixture(scope="module")
def verdict_rows() -> VerdictRows:
    return VerdictRows()


def spans(*, but: str = "") -> list[Any]:
    """Return the names of the spans but one: those of the quick tests, and others, marked."""
    return [pytest.param(name, marks=[] if name in FIRST_SPANS else pytest.mark.ci) for name in SPANS if name != but]


def drives(names: Collection[str]) -> list[Drive]:
    """Return the cases of these spans, and with the first ones those without a span, as one batch.

    A crowd costs little more than one, and harms nobody (test_laws).
    """
    found: list[Drive] = []

    def add(drive: Drive, case: Case) -> None:
        found.append(blinding.renamed(drive, case.name))

    for run in RUNS:
        whole = whole_run(run)
        assert whole.environment is not None
        for change, make in BLINDINGS.items():
            for name in names:
                span = SPANS[name]
                if span == EVER and (change == "hole" or change.endswith(f" {EGO}")):
                    continue
                add(make(whole, span), Case(run, change, name))
        if not FIRST_SPANS & set(names):
            continue
        add(whole, Case(run, "nothing"))
        for name, span in (CUTS | ENDS).items():
            add(blinding.cut(whole, span), Case(run, "cut", name))
        for defect, environment in maps(whole.environment).items():
            add(blinding.on(whole, environment), Case(run, f"no {defect}"))
            add(blinding.on(blinding.dropped(whole, OV, EVER), environment), Case(run, f"no {defect}, no OV"))
        for range_m in (30.0, 60.0, 200.0):
            add(blinding.ranged(whole, range_m), Case(run, f"range {range_m:.0f}"))
            alone = blinding.dropped(blinding.ranged(whole, range_m), OV, EVER)
            add(alone, Case(run, f"range {range_m:.0f}, no OV"))
    return found


def hit(row: Row) -> bool:
    """Whether a verdict is unknown for an impact that the boxes miss."""
    return row["reason_code"] == "null_value" and "show an impact" in row["reason"]


def touches(row: Row, span: Span) -> bool:
    """Whether a verdict's interval and a span have a moment in common; a hair inside, as spans end on samples."""
    return bool(row["t_start_ns"] / 1e9 <= span[1] + 1e-6 and row["t_end_ns"] / 1e9 >= span[0] - 1e-6)


def boxes_tell(run: str, actor_id: str) -> str:
    """Return the verdict on a collision with an actor whose box is clear of the ego's at every step."""
    return "unknown" if actor_id == OV and run in IMPACT_RUNS else "pass"


@pytest.mark.parametrize("run", RUNS)
def test_with_everything_there_it_does_pass(verdict_rows: VerdictRows, run: str) -> None:
    """Or else the tests below would hold for a checker that never passes anything."""
    case = Case(run, "nothing")
    assert ("pass" in {row["verdict"] for row in verdict_rows.of(case, SAFE_DISTANCE)}) is (run != "collision")
    told = {(row["object_id"], row["verdict"]) for row in verdict_rows.of(case, NO_COLLISION)}
    assert told == {(actor_id, boxes_tell(run, actor_id)) for actor_id in (VBP, OV)}
    assert "pass" in {row["verdict"] for row in verdict_rows.of(case, *SPACES_OV)}


@pytest.mark.parametrize("span", spans(but="ever"))
@pytest.mark.parametrize("change", [f"nulled {OV}", f"dropped {OV}", "moved 30 m", "moved 400 m"])
def test_no_pass_without_the_oncoming_vehicle(verdict_rows: VerdictRows, change: str, span: str) -> None:
    for run in RUNS:
        case = Case(run, change, span)
        rows = verdict_rows.of(case, SAFE_DISTANCE)
        if change.startswith("moved") and span.endswith("start"):
            # it does come onto the road then, and how far it had to go at most is known: that may be too little, never enough
            rows = [row for row in rows if row["verdict"] != "fail"]
        assert {(row["verdict"], row["reason_code"]) for row in rows} == {("unknown", "null_value")}
        for row in rows:
            assert f"actor {OV} " in row["reason"] or "observed pull-out and cut-in angles" in row["reason"], row[
                "reason"
            ]
        for row in verdict_rows.of(case, *SPACES_OV):
            assert row["verdict"] != "pass" or not touches(row, SPANS[span]), row
        for row in verdict_rows.of(case, "ukhc.overtake-zone"):
            assert row["verdict"] != "pass"


@pytest.mark.parametrize("change", [f"nulled {OV}", "moved 30 m", "moved 400 m"])
def test_no_pass_if_it_never_has_a_place_on_the_road(verdict_rows: VerdictRows, change: str) -> None:
    for run in RUNS:
        case = Case(run, change, "ever")
        assert verdict_rows.verdicts_and_reasons(case, SAFE_DISTANCE) == {("unknown", "null_value")}
        assert {row["verdict"] for row in verdict_rows.of(case, *SPACES_OV)} == {"unknown"}


def test_a_vehicle_that_the_log_never_names_is_nobody(verdict_rows: VerdictRows) -> None:
    """With all of its rows gone nothing in the log tells that it was there: ground truth says that nobody came, and so do we."""
    for run in RUNS:
        case = Case(run, f"dropped {OV}", "ever")
        for row in verdict_rows.of(case, SAFE_DISTANCE):
            if row["profile"] != "observed":
                assert row["verdict"] == "pass"
                assert row["object_id"] is None
                assert row["reason"].startswith("no oncoming vehicle within")
        assert verdict_rows.verdicts_and_reasons(case, SPACES_OV[0]) == {("not_applicable", "not_triggered")}


@cache
def distances(run: str, actor_id: str) -> dict[float, float]:
    """Return second -> distance of the boxes of ego and actor, read off the raw states; positions are box centres here."""
    tables = read_trace(shared(f"overtake_case_study/{run}.csv"), IngestOptions(mapping="carla-testbench")).tables
    size = {row["actor_id"]: (row["length_m"] / 2, row["width_m"] / 2) for row in tables["actor"].to_pylist()}

    def outlines(actor: str) -> dict[int, Polygon]:
        """Return its boxes on the ground, by time."""
        flat = box(-size[actor][0], -size[actor][1], *size[actor])
        rows = [row for row in tables["actor_state"].to_pylist() if row["actor_id"] == actor]
        return {r["t_ns"]: translate(rotate(flat, r["yaw_rad"], (0, 0), True), r["x_m"], r["y_m"]) for r in rows}

    ego, other = outlines(EGO), outlines(actor_id)
    return {t / 1e9: ego[t].distance(other[t]) for t in ego.keys() & other.keys()}


def kept_apart(run: str, actor_id: str, span: Span, fresh_s: float = 0.0) -> bool:
    """Whether ego and actor cannot have met in the span: at 60 m/s from where they were seen last or next.

    `fresh_s`: for so long a state without a successor is carried on by its velocity.
    """
    apart = distances(run, actor_id)
    lost = [t for t in apart if span[0] + fresh_s - 1e-6 <= t <= span[1] + 1e-6]
    before = max((t for t in apart if t < min(lost)), default=None)
    after = min((t for t in apart if t > max(lost)), default=None)
    return all(any(edge is not None and apart[edge] > 60 * abs(t - edge) for edge in (before, after)) for t in lost)


@pytest.mark.parametrize("span", spans())
@pytest.mark.parametrize("how", ["nulled", "dropped"])
@pytest.mark.parametrize("actor_id", [VBP, OV])
def test_no_collision_is_not_passed_over_a_blind_spot(
    verdict_rows: VerdictRows, actor_id: str, how: str, span: str
) -> None:
    for run in RUNS:
        rows = verdict_rows.of(Case(run, f"{how} {actor_id}", span), NO_COLLISION)
        own = [row for row in rows if row["object_id"] == actor_id]
        # 2.5 periods after the last sample: two more steps
        apart = kept_apart(run, actor_id, SPANS[span], 0.2 if how == "dropped" else 0.0)
        assert apart or all(row["verdict"] != "pass" for row in own if touches(row, SPANS[span]))
        if apart:
            assert {row["verdict"] for row in own} == {boxes_tell(run, actor_id)}
        elif how == "nulled" or span in {"0.3", "0.5", "2", "5"}:
            assert "unknown" in {row["verdict"] for row in own}
        other = {(row["object_id"], row["verdict"]) for row in rows if row["object_id"] not in {actor_id, None}}
        assert other == {(each, boxes_tell(run, each)) for each in {VBP, OV} - {actor_id}}


def test_a_track_that_ends_near_the_ego_is_unknown_from_there_on(verdict_rows: VerdictRows) -> None:
    for run in RUNS:
        rows = [
            row for row in verdict_rows.of(Case(run, f"dropped {VBP}", "end"), NO_COLLISION) if row["object_id"] == VBP
        ]
        assert [(row["verdict"], row["reason_code"]) for row in rows] == [
            ("pass", "kept"),
            ("unknown", "lost_near_ego"),
        ]
        assert rows[1]["t_start_ns"] / 1e9 == pytest.approx(7.7)


@pytest.mark.parametrize("span", spans())
@pytest.mark.parametrize("how", ["nulled", "dropped"])
def test_no_pass_without_the_vehicle_being_passed(verdict_rows: VerdictRows, how: str, span: str) -> None:
    for run in RUNS:
        case = Case(run, f"{how} {VBP}", span)
        if (how, span) == ("dropped", "ever"):  # nothing in the log tells that there was anybody to pass
            assert verdict_rows.verdicts_and_reasons(case, SAFE_DISTANCE) == {("not_applicable", "not_triggered")}
            continue
        assert verdict_rows.verdicts_and_reasons(case, SAFE_DISTANCE) == {("unknown", "null_value")}
        assert {row["verdict"] for row in verdict_rows.of(case, "ukhc.r163.pull-out-separation")} == {"unknown"}
        for row in verdict_rows.of(case, SPACE_VBP):
            assert row["verdict"] != "pass" or not touches(row, SPANS[span]), row


@pytest.mark.parametrize("span", spans())
def test_a_vehicle_beside_the_road_is_not_being_passed(verdict_rows: VerdictRows, span: str) -> None:
    """The parked one has a position and it is off the lanes: known, so there is no overtake, or not one of it."""
    for run in RUNS:
        assert verdict_rows.verdicts_and_reasons(Case(run, "moved VBP", span), SAFE_DISTANCE) == {
            ("not_applicable", "not_triggered")
        }


@pytest.mark.parametrize("span", spans(but="ever"))
@pytest.mark.parametrize("change", [f"nulled {EGO}", f"dropped {EGO}", "hole"])
def test_no_pass_of_what_the_ego_did_unseen(verdict_rows: VerdictRows, change: str, span: str) -> None:
    """Where the way out of the lane lies in the blind spot, it is not known when or whether it was safe."""
    for run in RUNS:
        case = Case(run, change, span)
        assert "pass" not in {row["verdict"] for row in verdict_rows.of(case, SAFE_DISTANCE, "ukhc.overtake-zone")}
        assert "fail" not in {row["verdict"] for row in verdict_rows.of(case, SAFE_DISTANCE, "ukhc.overtake-zone")}
        assert "pass" not in {row["verdict"] for row in verdict_rows.of(case, "ukhc.r163.pull-out-separation")}
        for row in verdict_rows.of(case, NO_COLLISION, "ukhc.r124.speed-limit", *SPACES_OV, SPACE_VBP):
            within = (SPANS[span][0] + 1e-3, SPANS[span][1] - 1e-3)
            actor_id = row["object_id"]
            apart = row["rule_id"] == NO_COLLISION and actor_id is not None and kept_apart(run, actor_id, SPANS[span])
            assert apart or row["verdict"] != "pass" or not touches(row, within), row
        if span in {"0.3", "0.5", "2"}:
            assert verdict_rows.verdicts_and_reasons(case, SAFE_DISTANCE) == {("unknown", "null_value")}
            assert {row["reason"] for row in verdict_rows.of(case, SAFE_DISTANCE)} == {
                "the log does not show the beginning of the overtake: record the ego from before it"
            }


@pytest.mark.parametrize("span", [each for each in spans() if each.values[0] in {"0.3", "0.5", "2", "5"}])
def test_a_hole_is_a_row_of_its_own(verdict_rows: VerdictRows, span: str) -> None:
    for run in RUNS:
        for rule in (NO_COLLISION, "ukhc.r124.speed-limit"):
            holes = [row for row in verdict_rows.of(Case(run, "hole", span), rule) if row["reason_code"] == "log_hole"]
            assert holes
            assert {row["verdict"] for row in holes} == {"unknown"}
            for row in holes:
                assert row["t_start_ns"] / 1e9 == pytest.approx(SPANS[span][0] - 0.1)
                assert row["t_end_ns"] / 1e9 == pytest.approx(SPANS[span][1] + 0.1)


@pytest.mark.parametrize("run", RUNS)
def test_a_log_that_begins_too_late(verdict_rows: VerdictRows, run: str) -> None:
    for name in ("at t0", "from t0 on", "passing"):
        verdicts = {row["verdict"] for row in verdict_rows.of(Case(run, "cut", name), SAFE_DISTANCE)}
        assert verdicts == {"unknown"}, name
    if run != "collision":  # which is off its lane for most of what is left, so that its registration is in doubt
        rows = verdict_rows.of(Case(run, "cut", "before t0"), SAFE_DISTANCE)
        whole = verdict_rows.of(Case(run, "nothing"), SAFE_DISTANCE)
        assert [row["verdict"] for row in rows] == [row["verdict"] for row in whole]


@pytest.mark.parametrize("run", RUNS)
def test_a_log_that_ends_too_early(verdict_rows: VerdictRows, run: str) -> None:
    """t0 was seen, so its distance stands; what comes later is not claimed: what was driven may be too much already, and never enough.

    While the ego may still speed up, it is not known whether a distance that is too small at its speed at t0 was: see `MAY_SPEED_UP`.
    """
    whole = {row["profile"]: row["verdict"] for row in verdict_rows.of(Case(run, "nothing"), SAFE_DISTANCE)}
    for name, span in ENDS.items():
        rows = {row["profile"]: row for row in verdict_rows.of(Case(run, "cut", name), SAFE_DISTANCE)}
        observed = rows.pop("observed")["verdict"]
        assert rows.keys() == whole.keys() - {"observed"}
        for profile, row in rows.items():
            is_open = (run, name, profile) in MAY_SPEED_UP
            expected = ("unknown", "may_speed_up") if is_open else (whole[profile], None)
            assert (row["verdict"], row["cause_code"]) == expected, (name, profile)
        assert observed == "unknown" or observed == whole["observed"] == "fail"
        for row in verdict_rows.of(Case(run, "cut", name), *SPACES_OV, SPACE_VBP, NO_COLLISION):
            assert row["t_end_ns"] / 1e9 <= span[1] + 1e-6
        cut_in = {row["verdict"] for row in verdict_rows.of(Case(run, "cut", name), "ukhc.r163.cut-in")}
        assert cut_in <= {"unknown", "not_applicable"}


@pytest.mark.parametrize("run", RUNS)
def test_a_lost_lane(verdict_rows: VerdictRows, run: str) -> None:
    for case in (Case(run, "no running lane"), Case(run, "no running lane, no OV")):
        assert verdict_rows.verdicts_and_reasons(case, SAFE_DISTANCE) == {("unknown", "missing_registration")}
        assert {row["verdict"] for row in verdict_rows.of(case, *SPACES_OV, "ukhc.r124.speed-limit")} == {"unknown"}
    for case in (Case(run, "no overtaking lane"), Case(run, "no overtaking lane, no OV")):
        assert {row["verdict"] for row in verdict_rows.of(case, SAFE_DISTANCE, "ukhc.r124.speed-limit")} == {"unknown"}
        for row in verdict_rows.of(case, SAFE_DISTANCE):
            assert "the ego is on a lane" in row["reason"] or "no lane on the overtaking side" in row["reason"]


@pytest.mark.parametrize("defect", ["lane ahead", "link ahead", "every link"])
@pytest.mark.parametrize("run", RUNS)
def test_a_missing_link_never_makes_the_road_longer(verdict_rows: VerdictRows, run: str, defect: str) -> None:
    """The OV is then met on its way onto what is left of the corridor; where nobody is, only as much as is left is known."""
    whole = {row["profile"]: row for row in verdict_rows.of(Case(run, "nothing"), SAFE_DISTANCE)}
    for row in verdict_rows.of(Case(run, f"no {defect}"), SAFE_DISTANCE):
        if row["observed"] is not None:
            assert row["observed"] <= whole[row["profile"]]["observed"] + 0.01
            assert row["observed"] >= whole[row["profile"]]["observed"] - 5
    if defect == "every link":
        for row in verdict_rows.of(Case(run, f"no {defect}, no OV"), SAFE_DISTANCE):
            assert row["verdict"] == "unknown"
            assert row["profile"] == "observed" or row["reason_code"] == "only_a_bound"


@pytest.mark.parametrize("run", RUNS)
def test_without_a_map_or_a_side_of_the_road(verdict_rows: VerdictRows, run: str) -> None:
    for defect, code in (("map", "missing_map"), ("handedness", "missing_handedness")):
        for case in (Case(run, f"no {defect}"), Case(run, f"no {defect}, no OV")):
            for rule in (SAFE_DISTANCE, SPACE_VBP, "ukhc.overtake-zone", *SPACES_OV):
                assert verdict_rows.verdicts_and_reasons(case, rule) == {("unknown", code)}
    assert verdict_rows.verdicts_and_reasons(Case(run, "no map"), "ukhc.r124.speed-limit") == {
        ("unknown", "missing_map")
    }
    assert verdict_rows.verdicts_and_reasons(Case(run, "no map"), "ukhc.r145.off-road") == {("unknown", "missing_map")}
    codes = {"pass": ("pass", "kept"), "unknown": ("unknown", "null_value")}
    told = {codes[boxes_tell(run, actor_id)] for actor_id in (VBP, OV)}
    assert verdict_rows.verdicts_and_reasons(Case(run, "no map"), NO_COLLISION) == told  # boxes and speeds need no map


@pytest.mark.parametrize("run", RUNS)
@pytest.mark.parametrize("range_m", [30, 60, 200])
def test_a_finite_sensor_range(verdict_rows: VerdictRows, run: str, range_m: int) -> None:
    """What came into range later was not seen before; what left it may still be there."""
    case = Case(run, f"range {range_m}")
    whole = {row["profile"]: row for row in verdict_rows.of(Case(run, "nothing"), SAFE_DISTANCE)}
    for row in verdict_rows.of(case, SAFE_DISTANCE):
        seen = whole[row["profile"]]["observed"] is not None and whole[row["profile"]]["observed"] + 4.8 < range_m
        if seen:
            assert row["verdict"] == whole[row["profile"]]["verdict"]
        else:
            assert row["verdict"] == "unknown"
            assert row["observed"] is None or row["observed"] < range_m
    lost = [row for row in verdict_rows.of(case, NO_COLLISION) if row["verdict"] == "unknown"]
    if range_m == 30 and run != "collision":
        assert {row["object_id"] for row in lost} == {VBP, OV}
    assert {row["reason_code"] for row in lost if not hit(row)} <= {"lost_near_ego", "lost_in_range"}
    assert {row["object_id"] for row in lost if hit(row)} == ({OV} if run in IMPACT_RUNS else set())


@pytest.mark.parametrize("run", RUNS)
def test_a_short_sensor_range_cannot_tell_that_nobody_is_coming(verdict_rows: VerdictRows, run: str) -> None:
    """Where it reaches less far than ego and an oncoming vehicle at the limit need to stop, nothing is claimed."""
    for rule in SPACES_OV:
        assert {row["verdict"] for row in verdict_rows.of(Case(run, "range 30, no OV"), rule)} == {"unknown"}
        assert {row["verdict"] for row in verdict_rows.of(Case(run, "range 200, no OV"), rule)} == {"not_applicable"}
    for row in verdict_rows.of(Case(run, "range 30, no OV"), SAFE_DISTANCE):
        assert row["verdict"] == "unknown"


@pytest.mark.ci
def test_a_log_without_indicators_is_named_and_counted() -> None:
    """Of a pack; a rule that somebody asks for by its name is unknown."""
    rows = scenes.verdict_rows([whole_run(run) for run in RUNS], rules=["ukhc"])
    for rule in ("r103.signal-before", "r103.signal-means-go", "exit-sign-signal", "signal-then-leaves"):
        told = [row for row in rows if row["rule_id"] == f"ukhc.{rule}"]
        assert len(told) == len(RUNS)
        for row in told:
            assert (row["verdict"], row["reason_code"]) == ("not_applicable", "unrecorded_indicator")
            assert row["reason"] == "the log has no indicators of the ego"
