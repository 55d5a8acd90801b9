"""The pipeline around the verdicts: batches, drives that cannot be judged, the kept database, maps of another place."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import duckdb
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq
import pytest

from drivelint.convert import ConvertRequest, convert
from drivelint.drive.trace import IngestOptions
from drivelint.engine import batch
from drivelint.errors import MapError, TraceError, UsageError
from drivelint.evaluate import evaluate as plain
from drivelint.formats import read_trace
from drivelint.report.outputs import write
from drivelint.report.progress import Silent
from drivelint.result import evidence
from drivelint.run import CheckOptions, check
from drivelint.sql import declarations

OMEGA = {"x": "x_m", "y": "y_m", "yaw": "yaw_rad", "vel_x": "vx_mps", "vel_y": "vy_mps"}
EGOS = ("ego", "once", "oncoming", "parked")
# where anybody judged at the same time ever was, the corridor is looked at: more cells of it are kept, nobody else is in them
TABLES = [table for table in declarations.column_comments() if table not in ("drive", "rule", "_corridor_cell")]
TWO_RULES = ("ukhc.no-collision", "ukhc.r162.safe-distance-ahead")  # where it is not the rules that matter
FIXTURE = Path(__file__).resolve().parents[1] / "fixtures" / "overtake"


def settings(*traces: Path, **options: Any) -> CheckOptions:
    given: dict[str, Any] = {
        "map": FIXTURE / "road.xodr",
        "mapping": str(FIXTURE / "mapping.toml"),
        "rules": ("ukhc",),
        "robustness": False,  # tests/engine has those of copies
        **options,
    }
    return CheckOptions(traces=tuple(str(t) for t in traces), **given)


def logs() -> list[Path]:
    return [FIXTURE / f"{name}.csv" for name in ("safe", "near_miss", "collision")]


class Notes(Silent):
    """Keeps what the pipeline says."""

    def __init__(self) -> None:
        self.said: list[str] = []

    def note(self, text: str) -> None:
        self.said.append(text)


@pytest.mark.slow
def test_batches_of_one_drive_give_the_same_rows(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = check(settings(*logs(), robustness=True), Silent())
    monkeypatch.setattr(batch, "MAX_BATCH_STATES", 1)
    single = check(settings(*reversed(logs()), robustness=True), Silent())
    assert whole.verdicts.equals(single.verdicts)
    assert whole.findings.equals(single.findings)
    assert whole.drives.equals(single.drives)


@pytest.fixture(scope="module")
def ragged(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a log whose three cars are sampled at 10, 10 and 2 Hz, with a fourth that is there once."""
    path = tmp_path_factory.mktemp("ragged") / "ragged.csv"
    head, *rows = (FIXTURE / "near_miss.csv").read_text("utf-8").splitlines()
    kept = [row for i, row in enumerate(rows) if ",oncoming," not in row or (i // 3) % 5 == 0]
    once = kept[len(kept) // 2].split(",")
    once[1], once[4] = "once", "5.25"
    path.write_text("\n".join([head, *kept, ",".join(once)]) + "\n", encoding="utf-8")
    return path


@pytest.mark.slow
def test_tracks_are_the_same_wherever_the_egos_are_cut(
    ragged: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What is a hole in a track depends on the clocks of all egos of the drive."""
    found = []
    for room in (batch.EGO_ACTOR_PAIRS_PER_PART, 1):
        monkeypatch.setattr(batch, "EGO_ACTOR_PAIRS_PER_PART", room)
        monkeypatch.setattr(evidence, "SCENES_PER_STATEMENT", room)
        found.append(check(settings(ragged, ego="all", rules=TWO_RULES, out=tmp_path / str(room)), Silent()).tracks)
    assert found[0].num_rows == 4
    assert found[0].equals(found[1])


@pytest.mark.slow
def test_where_the_egos_are_cut_does_not_show(ragged: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every file of the results has the same bytes, and every table of the kept database the same rows."""
    found = []
    for room in (batch.EGO_ACTOR_PAIRS_PER_PART, 1, 1100):
        monkeypatch.setattr(batch, "EGO_ACTOR_PAIRS_PER_PART", room)
        monkeypatch.setattr(evidence, "SCENES_PER_STATEMENT", room)
        out = tmp_path / str(room)
        asked = settings(ragged, ego="all", out=out, keep_db=True, margins=True, rules=("all",))
        result = check(asked, Silent())
        assert result.drives["n_egos"].to_pylist() == [4]
        write(result, out)
        files = {str(f.relative_to(out)): f.read_bytes() for f in sorted(out.rglob("*")) if f.is_file()}
        files.pop("drivelint.duckdb")
        with duckdb.connect(str(out / "drivelint.duckdb"), read_only=True) as con:
            rows = {t: con.execute(f"SELECT count(*), sum(hash(t)::HUGEINT) FROM {t} t").fetchone() for t in TABLES}
        found.append((files, rows))
    (whole, all_rows), *others = found
    assert any(name.startswith("annotated/ragged") for name in whole)
    for cut, cut_rows in others:
        assert whole.keys() == cut.keys()
        assert [name for name in whole if whole[name] != cut[name]] == []
        assert {t: (all_rows[t], cut_rows[t]) for t in TABLES if all_rows[t] != cut_rows[t]} == {}


def test_parts_of_a_drive_hold_its_egos_once(ragged: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    drive = batch.Drive(read_trace(ragged, IngestOptions(mapping=str(FIXTURE / "mapping.toml"), ego="all")), None)
    steps = {name: sum(a == name for a in drive.trace.tables["actor_state"]["actor_id"].to_pylist()) for name in EGOS}
    assert drive.pairs_by_ego.keys() == set(EGOS)
    assert drive.pairs_by_ego["once"] == 4  # its only step, and the four that are there then
    assert drive.pairs_by_ego["ego"] == 3 * steps["ego"] + 1
    assert drive.size_in_states_or_pairs == sum(drive.pairs_by_ego.values())
    for room in (1, 1100, 10**9):
        monkeypatch.setattr(batch, "EGO_ACTOR_PAIRS_PER_PART", room)
        judged = [sorted(set(EGOS) - set(resting)) for resting in batch.egos_to_skip_by_part([drive])]
        assert [ego for part in judged for ego in part] == sorted(EGOS)
        assert all(len(part) == 1 or sum(drive.pairs_by_ego[e] for e in part) <= room for part in judged)
    assert batch.egos_to_skip_by_part([drive, drive]) == [[]]


@pytest.mark.slow
def test_a_drive_of_which_a_part_fails_leaves_nothing(
    ragged: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(batch, "EGO_ACTOR_PAIRS_PER_PART", 1)
    monkeypatch.setattr(batch, "MAX_BATCH_STATES", 1)
    calls = []

    def third(con: duckdb.DuckDBPyConnection, *args: Any, **options: Any) -> None:
        calls.append(1)
        if len(calls) == 3:
            raise duckdb.Error("the engine choked")
        plain(con, *args, **options)

    monkeypatch.setattr("drivelint.engine.session.evaluate", third)
    asked = settings(ragged, FIXTURE / "safe.csv", ego="all", out=tmp_path, keep_db=True, rules=TWO_RULES)
    result = check(asked, Silent())
    assert len(calls) == 3 + 3
    assert dict(zip(*(result.drives[c].to_pylist() for c in ("file_name", "status")), strict=True)) == {
        "ragged.csv": "not_judged",
        "safe.csv": "judged",
    }
    assert {name.split("-")[0] for name in result.verdicts["drive_id"].to_pylist()} == {"safe"}
    with duckdb.connect(str(tmp_path / "drivelint.duckdb"), read_only=True) as con:
        for table in ("actor_state", "step", "pair", "verdict", "exposure"):
            (n,) = con.execute(f"SELECT count(*) FROM {table} WHERE drive_id LIKE 'ragged%'").fetchall()[0]
            assert n == 0, table


@pytest.mark.ci
def test_a_drive_that_cannot_be_read_harms_no_other(tmp_path: Path) -> None:
    broken = tmp_path / "broken.csv"
    broken.write_text("<html>404</html>\n", encoding="utf-8")
    alone = check(settings(FIXTURE / "safe.csv", rules=TWO_RULES), Silent())
    notes = Notes()
    both = check(settings(broken, FIXTURE / "safe.csv", rules=TWO_RULES), notes)
    assert both.verdicts.equals(alone.verdicts)
    by_name = {row["file_name"]: row for row in both.drives.to_pylist()}
    assert by_name["broken.csv"]["status"] == "not_judged"
    assert "broken.csv" in by_name["broken.csv"]["status_reason"]
    assert by_name["safe.csv"]["status"] == "judged"
    assert sum("not judged" in line for line in notes.said) == 1


@pytest.mark.ci
def test_a_drive_that_the_engine_chokes_on_harms_no_other(monkeypatch: pytest.MonkeyPatch) -> None:
    from drivelint.engine.derive import derive

    def choking(con: duckdb.DuckDBPyConnection, *args: Any, **options: Any) -> None:
        if con.execute(
            "SELECT count(*) FROM actor_state s JOIN data_log l USING (drive_id) WHERE l.file_name = 'safe.csv'"
        ).fetchall()[0][0]:
            raise duckdb.OutOfMemoryException("no more")
        derive(con, *args, **options)

    monkeypatch.setattr("drivelint.engine.session.derive", choking)
    result = check(settings(*logs(), rules=TWO_RULES), Silent())
    status = {row["file_name"]: (row["status"], row["status_reason"]) for row in result.drives.to_pylist()}
    assert status["safe.csv"][0] == "not_judged"
    assert "more memory" in status["safe.csv"][1]
    assert {name for name, (s, _) in status.items() if s == "judged"} == {"near_miss.csv", "collision.csv"}
    judged = {row["drive_id"].rsplit("-", 1)[0] for row in result.verdicts.to_pylist()}
    assert judged == {"near_miss", "collision"}


def test_the_same_log_twice_is_judged_once(tmp_path: Path) -> None:
    copy = tmp_path / "safe.csv"
    shutil.copy(FIXTURE / "safe.csv", copy)
    notes = Notes()
    result = check(settings(FIXTURE / "safe.csv", copy, rules=TWO_RULES), notes)
    assert result.drives.num_rows == 1
    assert any("judged once" in line for line in notes.said)


def test_none_judged_is_an_error_of_its_own(tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / f"{name}.csv").write_text(f"nothing,{name}\n", encoding="utf-8")
    with pytest.raises(TraceError, match="none of 2 logs"):
        check(settings(tmp_path / "a.csv", tmp_path / "b.csv"), Silent())


@pytest.mark.parametrize(
    ("offset", "message"), [((5000.0, 0.0), "its lanes lie in"), ((0.0, 30.0), "is on a lane or other area")]
)
def test_a_map_of_another_place_is_refused(offset: tuple[float, float], message: str) -> None:
    with pytest.raises(MapError, match=r"^map road\.xodr is of another place than safe\.csv: .*" + message):
        check(settings(FIXTURE / "safe.csv", map_offset=offset), Silent())


@pytest.mark.sample(0, ci=2)
@pytest.mark.parametrize(
    ("road", "message"),
    [
        (lambda _: b"road works", "is not XML"),
        (lambda text: text[:1000], "not well-formed"),
        (
            lambda text: text.replace(b'<geometry s="0', b'<geometry s="nan').replace(b"<width", b"<w"),
            "no lane that can be built",
        ),
        (lambda text: text.replace(b' x="', b' x="70'), "of another place"),
        (lambda text: text.replace(b'rule="LHT"', b'rule="RHT"'), "runs against its lanes"),
    ],
)
def test_a_map_of_the_log_itself_that_cannot_be_used_leaves_the_other_rules(
    tmp_path: Path, road: Any, message: str
) -> None:
    order = ConvertRequest(
        str(FIXTURE / "safe.csv"), "parquet", tmp_path / "d", mapping=str(FIXTURE / "mapping.toml"), ego="ego"
    )
    folder = convert(order).path
    (folder / "map.xodr").write_bytes(road((FIXTURE / "road.xodr").read_bytes()))
    result = check(settings(folder, map=None, mapping=None, rules=TWO_RULES), Silent())
    judged = {row["rule_id"]: row for row in result.verdicts.to_pylist()}
    assert judged["ukhc.no-collision"]["verdict"] == "pass"
    assert judged["ukhc.r162.safe-distance-ahead"]["verdict"] == "unknown"
    assert judged["ukhc.r162.safe-distance-ahead"]["reason_code"] == "missing_map"
    assert judged["ukhc.r162.safe-distance-ahead"]["reason"].startswith("the log's own map is not used: ")
    assert message in judged["ukhc.r162.safe-distance-ahead"]["reason"]
    assert [row["map_name"] for row in result.drives.to_pylist()] == [None]
    again = convert(ConvertRequest(str(folder), "mcap", tmp_path / "again"))
    assert any("the log's own map" in note for note in again.notes)


@pytest.mark.slow
def test_the_map_and_the_host_that_an_omega_prime_table_holds(tmp_path: Path) -> None:
    """Without --map and --ego the distance ahead is that of the CSV with both."""
    rows = read_trace(FIXTURE / "near_miss.csv", IngestOptions(mapping=str(FIXTURE / "mapping.toml")))
    states = rows.tables["actor_state"]
    ids = {"ego": 3, "parked": 7, "oncoming": 0}
    same = {"length": 4.8, "width": 1.8, "height": 1.5, "z": 0.0, "acc_x": 0.0, "acc_y": 0.0, "type": 2, "subtype": 4}
    table = pa.table(
        {
            "total_nanos": states["t_ns"],
            "idx": [ids[name] for name in states["actor_id"].to_pylist()],
            **{name: states[ours] for name, ours in OMEGA.items()},
            **{name: [value] * states.num_rows for name, value in same.items()},
        }
    )
    log = tmp_path / "omega.parquet"
    metadata = {"host_vehicle_idx": "3", "xodr": (FIXTURE / "road.xodr").read_text("utf-8"), "xodr_name": "road"}
    pq.write_table(table.replace_schema_metadata(metadata), log)
    found = []
    for asked in (settings(FIXTURE / "near_miss.csv"), settings(log, map=None, mapping=None)):
        result = check(asked, Silent())
        rule = pc.equal(result.verdicts["rule_id"], "ukhc.r162.safe-distance-ahead")
        judged = result.verdicts.filter(rule).sort_by("profile").to_pylist()
        assert [row["profile"] for row in judged] == ["nominal", "observed"]
        found.append(
            [(row["verdict"], row["t_ref_ns"], round(row["observed"], 6), round(row["required"], 6)) for row in judged]
        )
        assert result.drives["handedness"].to_pylist() == ["lht"]
    assert found[0] == found[1]
    assert result.drives["map_name"].to_pylist() == ["embedded"]
    assert result.verdicts["ego_id"].unique().to_pylist() == ["3"]


@pytest.mark.slow
def test_objects_at_half_the_rate_change_no_verdict(tmp_path: Path) -> None:
    """They move evenly: at the ego's steps they are where they were."""
    head, *rows = (FIXTURE / "near_miss.csv").read_text("utf-8").splitlines()
    thin = [row for row in rows if ",ego," in row or round(float(row.split(",")[0]) * 10) % 2 == 1]
    assert len(rows) - len(thin) > 100
    log = tmp_path / "near_miss.csv"
    log.write_text("\n".join([head, *thin]) + "\n", encoding="utf-8")
    columns = ["rule_id", "profile", "object_id", "occurrence", "t_ref_ns", "verdict", "reason_code"]
    every, half = (check(settings(path), Silent()) for path in (FIXTURE / "near_miss.csv", log))
    assert every.verdicts.select(columns).equals(half.verdicts.select(columns))
    assert {"pass", "fail"} <= set(every.verdicts["verdict"].to_pylist())
    (found,) = half.drives["quality"].to_pylist()
    assert "aligned" in {row["check_id"] for row in found}


@pytest.mark.slow
def test_a_map_whose_lanes_run_the_other_way_is_refused() -> None:
    """Everybody drives against their lane, both ways: read so, the ego would overtake all along, and nothing be said of it."""
    side = check(settings(FIXTURE / "near_miss.csv"), Silent()).drives["handedness"][0].as_py()
    other = "lht" if side == "rht" else "rht"
    with pytest.raises(
        MapError, match=rf"near_miss.csv runs against its lanes, on road \S+ both ways: .*\({other} by option\)"
    ):
        check(settings(FIXTURE / "near_miss.csv", handedness=other), Silent())
    check(settings(FIXTURE / "near_miss.csv", handedness=side), Silent())


@pytest.mark.slow
def test_one_vehicle_against_its_lane_is_a_doubt(tmp_path: Path) -> None:
    log = tmp_path / "alone.csv"
    head, *rows = (FIXTURE / "near_miss.csv").read_text("utf-8").splitlines()
    log.write_text("\n".join([head, *(row for row in rows if row.split(",")[1] == "oncoming")]) + "\n", "utf-8")
    said = {}
    for hand in ("lht", "rht"):
        (found,) = check(settings(log, handedness=hand, ego="oncoming"), Silent()).drives["quality"].to_pylist()
        said[hand] = [q["severity"] for q in found if "headings examined" in q["message"]]
    assert said == {"lht": [], "rht": ["warning"]}


@pytest.mark.slow
@pytest.mark.sample(1, ci=3)
@pytest.mark.parametrize(("moved_m", "distance"), [(0.0, None), (-0.6, None), (0.8, "0.80 m"), (-1.1, "1.10 m")])
def test_a_map_moved_by_less_than_half_a_lane_is_warned_of(moved_m: float, distance: str | None) -> None:
    """The ego of the fixture keeps to the middle of its lane."""
    result = check(settings(FIXTURE / "safe.csv", map_offset=(0.0, moved_m), rules=TWO_RULES), Silent())
    (drive,) = result.drives.to_pylist()
    found = [(q["severity"], q["message"]) for q in drive["quality"] if q["check_id"] == "aside_of_lane"]
    assert len(found) == (distance is not None)
    assert all(
        severity == "warning" and words.startswith(f"ego keeps {distance} beside the middle")
        for severity, words in found
    )
    assert not drive["lossy"]


@pytest.mark.ci
def test_a_map_beside_the_drive_makes_map_rules_unknown_not_failed() -> None:
    result = check(settings(FIXTURE / "safe.csv", map_offset=(0.0, 4.5)), Silent())
    rows = {row["rule_id"]: row for row in result.verdicts.to_pylist()}
    for rule in ("ukhc.r162.safe-distance-ahead", "ukhc.r145.off-road", "ukhc.r124.speed-limit"):
        assert rows[rule]["verdict"] == "unknown"
        assert rows[rule]["reason_code"] == "missing_registration"
    assert rows["ukhc.no-collision"]["verdict"] == "pass"


@pytest.mark.slow
def test_kept_database_has_every_stage(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(batch, "MAX_BATCH_STATES", 1)  # several batches, and two maps that take turns
    result = check(settings(*logs(), out=tmp_path, keep_db=True, margins=True), Silent())
    with duckdb.connect(str(tmp_path / "drivelint.duckdb"), read_only=True) as con:
        count = {
            t: con.execute(f"SELECT count(*) FROM {t}").fetchall()[0][0]
            for t in declarations.column_comments()
            if t not in ("drive", "rule")
        }
        assert con.execute("SELECT count(DISTINCT drive_id) FROM actor_state").fetchall() == [(3,)]
        assert (
            con.execute("SELECT count(*), count(DISTINCT (lanelet_id, k)) FROM lane_point").fetchall()[0]
            == (count["lane_point"],) * 2
        )
        commented = con.execute(
            "SELECT count(*) FROM duckdb_columns() WHERE table_name = 'verdict' AND comment IS NULL"
        ).fetchall()
    for table in ("actor_state", "lanelet", "lane_point", "ego_state", "pair", "overtake", "overtake_sda", "oncoming"):
        assert count[table] > 0, table
    assert count["verdict"] == result.verdicts.num_rows
    assert count["finding"] == result.findings.num_rows
    assert count["margin"] > result.verdicts.num_rows
    assert commented == [(0,)]


def test_files_need_a_folder() -> None:
    with pytest.raises(UsageError, match="--out"):
        check(settings(FIXTURE / "safe.csv", margins=True), Silent())
