"""Laws: rows depend neither on order, threads and batches nor on the company; and where a scene lies, and when, changes no verdict."""

from __future__ import annotations

import math
import subprocess
import sys
from dataclasses import replace
from functools import cache
from hashlib import sha256
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from drivelint.catalogue import load_rules
from drivelint.drive.finish import with_quality_finding
from drivelint.drive.trace import QualityFinding
from drivelint.engine import batch
from drivelint.evaluate.sql_fragments import Binding
from drivelint.sql import declarations, store
from drivelint.sql.derivations import derivations
from tests import blinding, scenes
from tests.clean.judging import story_drive
from tests.derive.bridge_scenes import bridge, lifted
from tests.derive.exit_scenes import exit_road, leaver
from tests.derive.jointed_road import jointed
from tests.derive.marked import shouldered
from tests.derive.overtake_scene import scene
from tests.derive.trailer_scene import trailer_behind
from tests.scenes import LANE, Actor, derived, drive, moving, road, saying, standing, swing, tee, times, verdict_rows
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    import duckdb

    from drivelint.catalogue import Rule
    from drivelint.engine.batch import Drive

RULES = ("ukhc", "rss", "criticality")
PROFILES = ("relaxed", "nominal", "observed")
Row = dict[str, Any]


@cache
def crowd() -> tuple[Drive, ...]:
    """Return drives that differ in map, side of the road, egos, holes, blind spots and length."""
    found = []
    for hand in ("rht", "lht"):
        way, actors = scene(hand)
        found.append(drive(actors, way.environment, drive_id=f"overtake-{hand}"))
        ego, vbp, ov = actors
        blind = [ego, vbp, ov.without_position((ov.t_s > 7) & (ov.t_s < 9))]
        found.append(drive(blind, way.environment, drive_id=f"blind-{hand}", egos=["ego", "vbp", "ov"]))
        holed = [a.keep((a.t_s < 10) | (a.t_s > 12)) for a in actors]
        found.append(drive(holed, way.environment, drive_id=f"holed-{hand}", sensor_range_m=150.0))
    way, actors = scene(abort=True)
    found.append(drive(actors, way.environment, drive_id="aborted"))
    by_hand = drive(actors, way.environment, drive_id="by-hand")
    found.append(saying(by_hand, [(2.0, "engaged", "on"), (9.0, "engaged", "off")], weather="wet"))
    found.append(drive(actors, None, drive_id="no-map"))
    ego, vbp, ov = actors
    lost = [ego, vbp.keep(vbp.t_s < 9), ov.keep(ov.t_s < 20)]
    found.append(drive(lost, way.environment, drive_id="lost"))
    found.append(drive(lost, way.environment, drive_id="out-of-sight", in_sight=True))
    damaged = drive(lost, way.environment, drive_id="damaged")
    gone = QualityFinding("lost_time", "error", "bytes lost", t_first_ns=3_010_000_000, t_last_ns=3_020_000_000)
    found.append(replace(damaged, trace=with_quality_finding(damaged.trace, gone)))
    jolted = drive(actors, way.environment, drive_id="jolted")
    jolt = ("vbp", "velocity", 8_010_000_000, 8_390_000_000, "velocity_jolt")
    doubt = dict(zip(jolted.trace.tables["doubt"].column_names, ("jolted", *jolt), strict=True))
    found.append(blinding.change_table(jolted, "doubt", lambda none: pa.Table.from_pylist([doubt], schema=none.schema)))
    leaving = exit_road()
    lights = tuple("right" if 7 < t < 15 else "off" for t in leaver(leaving).t_s)
    found.append(drive([replace(leaver(leaving), indicator=lights)], leaving.environment, drive_id="exit"))
    ways = tee()
    t = times(24.0)
    ego = moving("ego", ways["straight"], t, 20 + 3 * t, ways["straight"].ego_d)
    ov = moving("ov", ways["home"], t, 20 + 8 * t, ways["straight"].ego_d)
    found.append(drive([ego, ov.keep(t < 18)], ways["straight"].environment, drive_id="tee"))
    beside = shouldered("rht")
    found.append(drive([moving("ego", beside, t, 20 + 8 * t, -1.5 * LANE)], beside.environment, drive_id="shoulder"))
    halves = jointed("rht")
    s = 5 + 12 * times(33.0)
    actors = [
        moving("ego", halves, times(33.0), s, swing(halves, s, 100, 195)),
        standing("x", halves, times(33.0), 150, halves.ego_d),
    ]
    found.append(drive(actors, halves.environment, drive_id="halves"))
    return (*found, rarely(), crashed(), passing(), passing("late", first_s=10.7), *bridged(), *streets())


def passing(drive_id: str = "passing", first_s: float = 0.0) -> Drive:
    """Return a drive in which the ego moves aside in its lane and passes a car at the kerb, which is in the log from a second on."""
    way = road()
    t = times(12.0)
    aside = np.clip((t - 4.0) / 2.5, 0.0, 1.0)
    ego = moving("ego", way, t, 100 + 10 * t, way.ego_d - np.sign(way.ego_d) * 0.92 * aside * aside * (3 - 2 * aside))
    parked = standing("p", way, t, 200.0, np.sign(way.ego_d) * (LANE - 0.2))
    return drive([ego, parked.keep(t >= first_s)], way.environment, drive_id=drive_id)


def rarely() -> Drive:
    """Return a drive of one sample a second in which another crosses between two of them."""
    way = road()
    t = times(10.0, period=1.0)
    ego = moving("ego", way, t, 100 + 10 * t, way.ego_d)
    over = standing("over", way, t, 155.0, way.ego_d, turned=np.pi / 2)
    crossing = replace(over, y=over.y + 12 * (t - 5.4), vy=np.full(len(t), 12.0))
    return drive([ego, crossing], way.environment, drive_id="rarely")


def crashed() -> Drive:
    """Return a drive in which the ego hits a standing car at 12 m/s and pushes it on at 4 m/s."""
    way = road()
    t = times(10.0)
    before, after = np.minimum(t, 5.0), np.maximum(t - 5.0, 0.0)
    ego = moving("ego", way, t, 100 + 12 * before + 4 * after, way.ego_d)
    return drive([ego, moving("hit", way, t, 164.9 + 4 * after, way.ego_d)], way.environment, drive_id="crashed")


def bridged() -> tuple[Drive, ...]:
    """Return a drive with a trailer under a bridge that somebody crosses, with and without heights, or stays on to the end."""
    low, high = bridge()
    t = times(8.0)
    ego = moving("ego", low, t, 240 + 12 * t, low.ego_d)
    actors = [ego, trailer_behind("trailer", ego, kind="trailer"), moving("over", high, t, 140 + 12 * t, high.ego_d)]
    flat, tall = (drive(actors, low.environment, drive_id=name) for name in ("bridge", "bridge-tall"))
    heights = {"ego": 0.0, "trailer": 0.3, "over": 6.0}
    last = drive([ego, moving("over", high, t, 104 + 12 * t, high.ego_d)], low.environment, drive_id="bridge-last")
    return flat, lifted(tall, heights, 0.01), lifted(last, heights, 0.01)


def streets() -> tuple[Drive, ...]:
    """Return drives with lights, crossings, turns, changes of lane and a cut-in; two of them on one map, and with two egos."""
    turn = story_drive("turn", "gb", ["offside_turn"])
    seen_again = blinding.nulled(blinding.renamed(turn, "turn-again"), "004", (30.0, 34.0))
    both = [with_ego(one, "002") for one in (turn, blinding.dropped(seen_again, None, (50.0, 52.0)))]
    alone = [story_drive(name, "gb", [name]) for name in ("zebra", "light", "motorway")]
    return (*both, *alone, with_ego(story_drive("cut_in", "gb", ["cut_in"]), "002"))


def with_ego(scene: Drive, actor: str) -> Drive:
    """Return the drive with this actor as a further ego."""

    def change(actors: pa.Table) -> pa.Table:
        at = actors.schema.get_field_index("is_ego")
        return actors.set_column(at, "is_ego", pc.or_(actors["is_ego"], pc.equal(actors["actor_id"], actor)))

    return blinding.change_table(scene, "actor", change)


def of_each(rows: Sequence[Row]) -> dict[str, list[Row]]:
    """Return rows by drive."""
    found: dict[str, list[Row]] = {}
    for row in rows:
        found.setdefault(row["drive_id"], []).append(row)
    return found


@cache
def expected() -> tuple[Row, ...]:
    """Return the verdicts of the crowd in one batch and on one thread."""
    return tuple(verdict_rows(crowd(), rules=RULES, profiles=PROFILES))


@pytest.mark.slow
def test_the_crowd_has_something_to_say() -> None:
    """Every verdict but error, and every rule decided somewhere, or the laws below would be about little."""
    assert {row["verdict"] for row in expected()} == {"pass", "fail", "unknown", "not_applicable"}
    decided = {row["rule_id"] for row in expected() if row["verdict"] in {"pass", "fail"}}
    assert len(decided) >= 35, sorted({row["rule_id"] for row in expected()} - decided)


@pytest.mark.slow
def test_alone_or_in_a_crowd() -> None:
    by_drive = of_each(expected())
    assert by_drive.keys() == {one.trace.drive_id for one in crowd()}
    for one in crowd()[2::5]:
        assert verdict_rows([one], rules=RULES, profiles=PROFILES) == by_drive[one.trace.drive_id]


@pytest.mark.slow
def test_order_of_drives_and_of_their_rows() -> None:
    dice = np.random.default_rng(0)
    shuffled = [crowd()[i] for i in dice.permutation(len(crowd()))]
    mixed = []
    for one in shuffled:
        tables = dict(one.trace.tables)
        for table in ("actor_state", "actor"):
            order = dice.permutation(tables[table].num_rows)
            tables[table] = tables[table].take(order)
        mixed.append(replace(one, trace=replace(one.trace, tables=tables)))
    assert verdict_rows(mixed, rules=RULES, profiles=PROFILES) == list(expected())


@pytest.mark.slow
def test_size_of_batches(monkeypatch: pytest.MonkeyPatch) -> None:
    """As many as fit in 10,000 states: two to seven drives. One alone has its own test."""
    monkeypatch.setattr(batch, "MAX_BATCH_STATES", 10_000)
    batches = [[one for one in part if isinstance(one, batch.Drive)] for part in batch.cut_batches(crowd())]
    assert len(crowd()) > len(batches) > 3
    assert verdict_rows(*batches, rules=RULES, profiles=PROFILES) == list(expected())


def prints(con: duckdb.DuckDBPyConnection) -> dict[str, tuple[Any, ...]]:
    """Return for every table how many rows it has and the sum of their hashes, whatever their order."""
    tables = [table for table in declarations.column_comments() if table != "drive"]
    return {t: con.execute(f"SELECT count(*), sum(hash(t)::HUGEINT) FROM {t} t").fetchall()[0] for t in tables}


@pytest.mark.slow
def test_every_derived_row_is_the_same_on_any_threads() -> None:
    first = prints(derived(*crowd()))
    assert all(first[table][0] for table in derivations()), [t for t in derivations() if not first[t][0]]
    with store.connect(threads=2) as con:
        assert prints(derived(*reversed(crowd()), con=con)) == first


def busy(seed: int, n_others: int = 24, steps: int = 13_500) -> Drive:
    """Return a long drive round a ring of 2 km, out into the oncoming lane and back twice a minute, with others on all lanes."""
    way = road(((2000.0, 2 * math.pi / 2000.0),), ring=True, lanes=(1, 2))
    random_ = np.random.default_rng(seed)
    t = times((steps - 1) / 10)
    d = 3.5 * np.clip(1.5 * np.sin(t * math.pi / 15 + seed) - 0.5, 0, 1) - 1.75
    actors: list[Actor] = [moving("ego", way, t, 100 + 12 * t, d)]
    for n in range(n_others):
        lane, sign = ((1.75, -1), (-1.75, 1), (-5.25, 1))[random_.integers(0, 3)]
        s = random_.uniform(0, 2000) + sign * random_.uniform(3, 15) * t
        actors.append(moving(f"{n:02}", way, t, s, lane))
    actors.append(standing("parked", way, t, 700.0, -1.75))
    return drive(actors, way.environment, drive_id=f"busy-{seed}")


@pytest.mark.slow
def test_a_million_states() -> None:
    """Sums and ties vary with threads only at this size (1.6 M rows, not 40,000)."""
    drives = [busy(seed) for seed in range(3)]
    assert sum(one.n_states for one in drives) >= 1_000_000
    found = []
    for threads, batches in ((1, [drives]), (2, [drives[2:], drives[1::-1]])):
        with store.connect(threads=threads) as con:
            verdicts = verdict_rows(*batches, rules=RULES, profiles=PROFILES, con=con)
            found.append((verdicts, scenes.rows(con, "FROM finding ORDER BY finding_id")))
    assert found[0] == found[1]
    verdicts, findings = found[0]
    assert {row["verdict"] for row in verdicts} >= {"pass", "fail", "unknown"}
    assert len(findings) > 100
    assert len({row["finding_id"] for row in findings}) == len(findings)


@pytest.mark.slow
def test_derived_rows_of_a_hundred_thousand_states() -> None:
    one = busy(7, steps=4_500)
    first = prints(derived(one))
    with store.connect(threads=2) as con:
        assert prints(derived(one, con=con)) == first
    assert first["overtake"][0] > 5


@pytest.mark.sample(0, ci=20)
@pytest.mark.parametrize("table", [name for name, d in derivations().items() if d.needs])
def test_a_derivation_that_is_not_run_would_have_had_no_rows(table: str) -> None:
    step, con = derivations()[table], _filled()
    has_rows = f"SELECT count(*) FROM ({step.sql})"
    con.execute(f"BEGIN; DELETE FROM {table}")  # it may leave out what it has already
    assert con.execute(has_rows).fetchall() != [(0,)]
    con.execute("ROLLBACK")
    for empty in sorted(step.needs):
        con.execute(f"BEGIN; DELETE FROM {table}")
        con.execute(f"DELETE FROM {empty}")
        assert con.execute(has_rows).fetchall() == [(0,)], empty
        con.execute("ROLLBACK")


OF_OCCASIONS = {rule.id: rule for rule in load_rules().values() if rule.occasion_needs}


def occasions(rule: Rule) -> int:
    """Return the number of reference points, or of steps to judge, that a rule has in the crowd."""
    con = _filled()
    sql = f"SELECT count(*) FROM ({rule.sections['applies' if rule.kind == 'invariant' else 'reference']})"
    values = Binding(rule, 1, {}).values(con.extract_statements(sql)[0].named_parameters)
    return int(con.execute(sql, values).fetchall()[0][0])


@pytest.mark.ci
@pytest.mark.parametrize("rule_id", OF_OCCASIONS)
def test_a_rule_that_is_not_run_would_have_had_no_occasion(rule_id: str) -> None:
    rule, con = OF_OCCASIONS[rule_id], _filled()
    for empty in sorted(rule.occasion_needs):
        con.execute(f"BEGIN; DELETE FROM {empty}")
        assert occasions(rule) == 0, empty
        con.execute("ROLLBACK")


@pytest.mark.ci
def test_a_rule_that_has_an_occasion_is_run() -> None:
    met = [rule for rule in OF_OCCASIONS.values() if occasions(rule)]
    assert len(met) > 30
    assert [rule.id for rule in met if rule.occasion_needs & store.tables_without_rows(_filled())] == []


@cache
def _filled() -> duckdb.DuckDBPyConnection:
    con = store.connect(threads=1)
    return derived(*crowd(), con=con)


class Elsewhere(NamedTuple):
    """A map and its trace turned and moved, the clock set forward, driven on either side."""

    hand: str
    turn: float = 0.0
    x: float = 0.0
    y: float = 0.0
    t_s: int = 0

    def drive(self, drive_id: str) -> Drive:
        """Return an overtake on a bend there and then."""
        bend = ((150.0, 0.0), (300.0, 1 / 400), (250.0, 0.0))
        way = road(bend, hand=self.hand, start=(self.x, self.y, self.turn))
        t = times(30.0)
        s = 50 + 12 * t
        ego = moving("ego", way, t, s, scenes.swing(way, s, 150, 280))
        vbp = moving("vbp", way, t, 140 + 4 * t, way.ego_d)
        ov = moving("ov", way, t, 560 - 9 * t, way.oncoming_d)
        actors = [replace(a, t_s=a.t_s + self.t_s) for a in (ego, vbp, ov)]
        return drive(actors, way.environment, drive_id=drive_id)


elsewhere = st.builds(
    Elsewhere,
    st.sampled_from(["rht", "lht"]),
    st.floats(-math.pi, math.pi),
    st.floats(-5000, 5000),
    st.floats(-5000, 5000),
    st.integers(0, 2_000_000),
)


@pytest.mark.slow
@settings(max_examples=2)
@given(st.lists(elsewhere, min_size=4, max_size=4))
def test_where_and_when_does_not_matter(moves: list[Elsewhere]) -> None:
    """All of them are judged at once, with both that stay at home."""
    homes = {hand: Elsewhere(hand) for hand in ("rht", "lht")}
    drives = {f"{no}": move for no, move in enumerate(moves)} | homes
    found = of_each(verdict_rows([one.drive(name) for name, one in drives.items()], rules=RULES, profiles=PROFILES))
    for no, move in enumerate(moves):
        as_at_home(found[f"{no}"], found[move.hand], move.t_s)


@pytest.mark.ci
def test_reasons_tell_seconds_of_the_drive_whatever_the_logs_clock() -> None:
    drives = [Elsewhere("rht").drive("now"), Elsewhere("rht", t_s=1_700_000_000).drive("then")]
    found = of_each(verdict_rows(drives, rules=RULES, profiles=PROFILES))
    said = [[row["reason"] for row in found[name]] for name in ("now", "then")]
    assert said[0] == said[1]
    assert sum(" at " in reason for reason in said[0]) > 10


def as_at_home(moved_rows: Sequence[Row], home_rows: Sequence[Row], later_s: int) -> None:
    """Hold that the verdicts are the same, so many seconds later."""
    assert len(moved_rows) == len(home_rows) > 0
    for a, b in zip(moved_rows, home_rows, strict=True):
        for column in (
            "rule_id",
            "profile",
            "object_id",
            "verdict",
            "reason_code",
            "near_miss",
            "n_expected",
            "n_judged",
        ):
            assert a[column] == b[column], (column, a, b)
        for column in ("t_ref_ns", "t_start_ns", "t_end_ns"):
            assert a[column] == (None if b[column] is None else b[column] + later_s * 10**9)
        for column in ("observed", "required", "margin"):
            assert a[column] == (None if b[column] is None else pytest.approx(b[column], abs=2e-3)), (column, a, b)


@pytest.mark.slow
def test_the_file_is_the_same_bytes_for_the_same_set(tmp_path: Path) -> None:
    """Named in another order, from another place, with margins or without: verdicts.parquet and findings.parquet agree."""
    fixture = ROOT / "fixtures" / "overtake"
    logs = [str(fixture / f"{name}.csv") for name in ("safe", "near_miss", "collision")]
    digests = []
    for n, (order, more) in enumerate(((logs, []), (logs[::-1], []), (logs[1:] + logs[:1], ["--margins"]))):
        out = tmp_path / str(n)
        command = [sys.executable, "-m", "drivelint", "check", *order, "--mapping", str(fixture / "mapping.toml")]
        command += ["--map", str(fixture / "road.xodr"), "--rules", "ukhc", "--out", str(out), *more]
        done = subprocess.run(command, capture_output=True, check=False, cwd=tmp_path)
        assert done.returncode == 1, done.stderr.decode()
        files = ("verdicts.parquet", "findings.parquet", "drives.parquet", "rules.parquet")
        digests.append({name: sha256((out / name).read_bytes()).hexdigest() for name in files})
    assert digests[0] == digests[1] == digests[2]
