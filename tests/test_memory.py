"""Memory does not decide: the results are the same under any limit, and what runs out of memory is judged in another way."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import duckdb
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from drivelint import option_values
from drivelint.engine import batch, margins, set_aside
from drivelint.engine.derive import derive as derived
from drivelint.engine.memory import DEFAULT_MEMORY_BYTES, LEAST_MEMORY_BYTES, MemoryLimit
from drivelint.errors import UsageError
from drivelint.evaluate import evaluate as evaluated
from drivelint.evaluate.evaluation import Evaluation
from drivelint.report.outputs import write
from drivelint.report.progress import Silent
from drivelint.result.evidence import gather as gathered
from drivelint.run import CheckOptions, check
from drivelint.sql import store
from tests.bench import traffic
from tests.shared_data import shared

FIXTURE = Path(__file__).resolve().parents[1] / "fixtures" / "overtake"
TWO_RULES = ("ukhc.no-collision", "ukhc.r162.safe-distance-ahead")
SHORT = duckdb.OutOfMemoryException("could not allocate block of size 256.0 KiB (1.1 GiB/1.1 GiB used)")
AT_COMMIT = duckdb.TransactionException(
    "TransactionContext Error: Failed to commit: failed to pin block of size 256.0 KiB (95.5 MiB/95.3 MiB used)"
)
"""What DuckDB raises where memory runs out as it ends a statement."""


class Notes(Silent):
    """Keeps what the pipeline says."""

    def __init__(self) -> None:
        self.said: list[str] = []

    def note(self, text: str) -> None:
        self.said.append(text)


@pytest.fixture(autouse=True)
def halved(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Return the meetings of the parts that did not fit."""
    found: list[int] = []
    halve = MemoryLimit.halve_parts

    def count_and_halve(self: MemoryLimit, meetings: int) -> None:
        found.append(meetings)
        halve(self, meetings)

    monkeypatch.setattr(MemoryLimit, "halve_parts", count_and_halve)
    return found


def overtakes(*names: str, **options: Any) -> CheckOptions:
    """Return settings for logs of the fixture, each of three vehicles."""
    given: dict[str, Any] = {"rules": TWO_RULES, **options}
    mapping = str(FIXTURE / "mapping.toml")
    return CheckOptions(
        tuple(str(FIXTURE / f"{n}.csv") for n in names), map=FIXTURE / "road.xodr", mapping=mapping, **given
    )


def files(options: CheckOptions, notes: Silent | None = None) -> dict[str, bytes]:
    """Check, write the results, and return every file of them."""
    assert options.out is not None
    write(check(options, notes or Silent()), options.out)
    return {str(f.relative_to(options.out)): f.read_bytes() for f in sorted(options.out.rglob("*")) if f.is_file()}


def same(contents: dict[str, bytes], expected: dict[str, bytes]) -> None:
    assert contents.keys() == expected.keys()
    assert [name for name in contents if contents[name] != expected[name]] == []


@pytest.fixture(scope="module")
def crowd(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """Return a log of 45 vehicles, whose pairs of one part do not fit into the least memory, and its road."""
    folder = tmp_path_factory.mktemp("crowd")
    (folder / "ring.xodr").write_text(traffic.ring(), encoding="utf-8")
    return traffic.write_folder(folder / "crowd", traffic.Shape(40.0, 10, 45)), folder / "ring.xodr"


def crowded(crowd: tuple[Path, Path], **options: Any) -> CheckOptions:
    return CheckOptions((str(crowd[0]),), map=crowd[1], ego="all", **options)


@pytest.mark.slow
def test_any_limit_gives_the_same_files(
    crowd: tuple[Path, Path], tmp_path: Path, halved: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first parts are 20 times as large as usual: those of the usual size do with the least memory."""
    asked: dict[str, Any] = {"rules": ("ukhc",), "margins": True}
    monkeypatch.setattr(batch, "EGO_ACTOR_PAIRS_PER_PART", 20 * batch.EGO_ACTOR_PAIRS_PER_PART)
    usual = files(crowded(crowd, out=tmp_path / "a", memory=None, **asked))
    assert not halved
    for no, limit in enumerate(
        (LEAST_MEMORY_BYTES, 150_000_000, LEAST_MEMORY_BYTES, DEFAULT_MEMORY_BYTES, LEAST_MEMORY_BYTES)
    ):
        same(files(crowded(crowd, out=tmp_path / f"b{no}", memory=limit, **asked)), usual)
    assert halved, "the least memory does not do for as many at once as are tried first"


@pytest.mark.slow
@pytest.mark.parametrize("limit", [512_000_000, DEFAULT_MEMORY_BYTES])
def test_a_real_log_of_many_egos_gives_the_same_files(limit: int, tmp_path: Path) -> None:
    """The log whose checks ended at random (exit code 1, or 4 and out of memory)."""
    asked: dict[str, Any] = {
        "traces": (str(shared("cav_loop/TEST003.csv")),),
        "map": shared("cav_loop/loop_geo_RHD.xodr"),
        "mapping": str(shared("cav_loop/mapping.toml")),
        "handedness": "lht",
        "rules": ("all",),
        "ego": "all",
    }
    wanted = files(CheckOptions(**asked, out=tmp_path / "a", memory=None))
    same(files(CheckOptions(**asked, out=tmp_path / "b", memory=limit)), wanted)


@pytest.mark.slow
def test_what_does_not_fit_is_judged_with_fewer_egos_at_once(tmp_path: Path, halved: list[int]) -> None:
    """For real: the limit is so low that the table of pairs of all egos does not fit."""
    (tmp_path / "ring.xodr").write_text(traffic.ring(), encoding="utf-8")
    log = traffic.write_folder(tmp_path / "crowd", traffic.Shape(5.0, 10, 60))
    asked: dict[str, Any] = {"map": tmp_path / "ring.xodr", "ego": "all", "rules": ("ukhc.no-collision",)}
    short = check(CheckOptions((str(log),), memory=60_000_000, **asked), Silent())
    assert halved
    usual = check(CheckOptions((str(log),), memory=None, **asked), Silent())
    assert short.verdicts.equals(usual.verdicts)
    assert short.findings.equals(usual.findings)
    assert short.drives.equals(usual.drives)


ALL_EGOS: dict[str, Any] = {"ego": "all", "margins": True}
STEPS: dict[str, Callable[..., None]] = {
    "drivelint.engine.session.derive": derived,
    "drivelint.engine.session.evaluate": evaluated,
    "drivelint.run.evidence.gather": gathered,
}


@pytest.fixture(scope="module")
def usual(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """Return the results of a log under the usual limit, which does."""
    return files(overtakes("near_miss", out=tmp_path_factory.mktemp("usual") / "a", **ALL_EGOS))


@pytest.mark.slow
@pytest.mark.parametrize("error", [SHORT, AT_COMMIT], ids=["at once", "at commit"])
@pytest.mark.parametrize(
    ("step", "fits"),
    [*((step, "one ego") for step in STEPS), ("drivelint.engine.session.evaluate", "no limit")],
)
def test_memory_that_does_not_do_is_no_error(
    step: str,
    fits: str,
    usual: dict[str, bytes],
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    *,
    error: duckdb.Error,
    halved: list[int],
) -> None:
    def short(con: duckdb.DuckDBPyConnection, *args: Any, **options: Any) -> None:
        ((n_egos,),) = con.execute(
            "SELECT count(DISTINCT actor_id) FROM actor WHERE is_ego AND actor_id NOT IN (SELECT ego_id FROM deferred_ego)"
        ).fetchall()
        ((limit,),) = con.execute("SELECT current_setting('memory_limit')").fetchall()
        STEPS[step](con, *args, **options)
        if n_egos > 1 or (fits == "no limit" and limit == "1.1 GiB"):
            raise error

    monkeypatch.setattr(step, short)
    notes = Notes()
    same(files(overtakes("near_miss", out=tmp_path / "b", **ALL_EGOS), notes), usual)
    assert halved
    if fits == "one ego":
        assert notes.said == [], "the limit is lifted only where nothing else helps"
    else:
        assert re.fullmatch(
            r"1\.2 GB of memory are not enough \(--memory\): the database may use up to .* GiB", notes.said[0]
        )
        assert len(notes.said) == 1


@pytest.mark.slow
def test_a_batch_that_does_not_fit_is_halved(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    other = tmp_path / "other.csv"
    other.write_text((FIXTURE / "safe.csv").read_text(encoding="utf-8") + "\n", encoding="utf-8")
    asked = overtakes("safe", "near_miss", "collision", str(other.with_suffix("")), rules=TWO_RULES[:1])
    usual = check(asked, Silent())
    sizes: list[int] = []

    def short(con: duckdb.DuckDBPyConnection, *args: Any, **options: Any) -> None:
        sizes.append(con.execute("SELECT count(*) FROM data_log SEMI JOIN actor USING (drive_id)").fetchall()[0][0])
        if sizes[-1] > 2:
            raise SHORT
        evaluated(con, *args, **options)

    monkeypatch.setattr("drivelint.engine.session.evaluate", short)
    notes = Notes()
    again = check(asked, notes)
    assert sizes == [4, 2, 2]
    assert notes.said == []
    assert again.verdicts.equals(usual.verdicts)
    assert again.drives.equals(usual.drives)


@pytest.mark.slow
@pytest.mark.parametrize("error", [SHORT, AT_COMMIT], ids=["at once", "at commit"])
def test_a_rule_that_runs_out_of_memory_is_tried_again(error: duckdb.Error, monkeypatch: pytest.MonkeyPatch) -> None:
    usual = check(overtakes("safe"), Silent())
    rule = Evaluation.judge_rule

    def short(self: Evaluation, binding: Any) -> None:
        ((limit,),) = self.con.execute("SELECT current_setting('memory_limit')").fetchall()
        if binding.rule.id == TWO_RULES[0] and limit == "1.1 GiB":
            raise error
        rule(self, binding)

    monkeypatch.setattr(Evaluation, "judge_rule", short)
    assert check(overtakes("safe"), Silent()).verdicts.equals(usual.verdicts)


@pytest.mark.sample(0, ci=1)
@pytest.mark.parametrize("memory", [DEFAULT_MEMORY_BYTES, None])
def test_a_rule_for_which_no_memory_does_is_an_error_in_the_same_words(
    memory: int | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    rule = Evaluation.judge_rule

    def short(self: Evaluation, binding: Any) -> None:
        if binding.rule.id == TWO_RULES[0]:
            raise SHORT
        rule(self, binding)

    monkeypatch.setattr(Evaluation, "judge_rule", short)
    rows = check(overtakes("safe", memory=memory), Silent()).verdicts.to_pylist()
    mine = [row for row in rows if row["rule_id"] == TWO_RULES[0]]
    assert {row["ego_id"] for row in mine} == {row["ego_id"] for row in rows}
    assert {(row["verdict"], row["reason_code"], row["reason"]) for row in mine} == {
        ("error", "out_of_memory", f"rule {TWO_RULES[0]}: needs more memory than is available")
    }
    assert "error" not in {row["verdict"] for row in rows if row["rule_id"] != TWO_RULES[0]}


@pytest.mark.slow
def test_results_that_do_not_fit_are_read_with_more(monkeypatch: pytest.MonkeyPatch) -> None:
    usual = check(overtakes("safe"), Silent())
    from drivelint.result import collect

    verdicts, calls = collect.verdicts, []

    def short(con: duckdb.DuckDBPyConnection) -> pa.Table:
        calls.append(1)
        if len(calls) == 1:
            raise SHORT
        return verdicts(con)

    monkeypatch.setattr(collect, "verdicts", short)
    notes = Notes()
    assert check(overtakes("safe"), notes).verdicts.equals(usual.verdicts)
    assert len(calls) == 2
    assert len(notes.said) == 1


@pytest.mark.ci
def test_the_memory_limit_is_really_lifted() -> None:
    """What the setting says is not enough: a table that did not fit has to fit in a database that is locked already."""
    large = "CREATE OR REPLACE TEMP TABLE large AS SELECT list(i) AS all FROM range(20_000_000) r(i)"
    with store.connect(memory_limit="100MB") as con:
        con.execute("SET temp_directory=''")
        store.lock_down(con)
        with pytest.raises(duckdb.OutOfMemoryException):
            con.execute(large)
        store.set_and_return_default_memory_limit(con)
        con.execute(large)


@pytest.mark.slow
@pytest.mark.parametrize("full", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_tables_that_are_set_aside_on_disk_give_the_same_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, *, full: bool
) -> None:
    mapped: list[str] = []
    usual = files(overtakes("collision", out=tmp_path / "a"))
    memory_map = pa.memory_map

    def noted(path: str) -> pa.MemoryMappedFile:
        mapped.append(Path(path).name)
        return memory_map(path)

    def no_room(path: str, _mode: str) -> pa.OSFile:
        Path(path).touch()
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(set_aside, "LEAST_SPILLED_TABLE_BYTES", -1)
    monkeypatch.setattr(batch, "LARGE_BATCH_STATES", 0)
    monkeypatch.setattr(pa, "memory_map", noted)
    if full:
        monkeypatch.setattr(pa, "OSFile", no_room)
    same(files(overtakes("collision", out=tmp_path / "b")), usual)
    assert ("actor_state.arrow" in mapped) is not full


@pytest.mark.ci
@pytest.mark.parametrize("lifted", [False, True])
def test_memory_that_is_given_back_changes_no_table_and_no_limit(*, lifted: bool) -> None:
    held = "SELECT sum(memory_usage_bytes) FROM duckdb_memory()"
    with store.temporary_database(200_000_000) as con:
        memory = MemoryLimit(con, 200_000_000)
        if lifted:
            memory.raise_to_machine_limit()
        limit = con.execute("SELECT current_setting('memory_limit')").fetchall()
        con.execute("CREATE TABLE numbers AS SELECT range AS n, hash(range) AS h FROM range(4000000)")
        ((before,),) = con.execute(held).fetchall()
        memory.release_unused_memory()
        ((after,),) = con.execute(held).fetchall()
        assert before > 30_000_000 > after
        assert con.execute("SELECT current_setting('memory_limit')").fetchall() == limit
        assert con.execute("SELECT sum(n), count(DISTINCT h) FROM numbers").fetchall() == [(7999998000000, 4000000)]


def test_the_database_spills_into_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """DuckDB's own choice is a folder where the user is."""
    monkeypatch.chdir(tmp_path)
    with store.temporary_database(LEAST_MEMORY_BYTES) as con:
        store.lock_down(con)
        ((spill,),) = con.execute("SELECT current_setting('temp_directory')").fetchall()
        con.execute("CREATE TABLE large AS SELECT i, hash(i) AS h FROM range(10_000_000) r(i)")
        assert any(Path(spill).iterdir())
        assert not list(tmp_path.iterdir())
    assert not Path(spill).exists()


@pytest.mark.slow
def test_margins_have_the_same_bytes_however_batches_are_cut(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(margins, "ROW_GROUP_ROWS", 100)
    found = []
    for states in (batch.MAX_BATCH_STATES, 1):
        monkeypatch.setattr(batch, "MAX_BATCH_STATES", states)
        result = check(
            overtakes("safe", "near_miss", out=tmp_path / str(states), margins=True, annotate=False), Silent()
        )
        assert result.margins_file is not None
        found.append(result.margins_file.read_bytes())
        groups = pq.ParquetFile(result.margins_file).metadata
        assert [groups.row_group(n).num_rows for n in range(groups.num_row_groups - 1)] == [100] * (
            groups.num_row_groups - 1
        )
        assert groups.num_row_groups > 2
    assert found[0] == found[1]


def test_margins_go_on_where_memory_ran_out() -> None:
    """Once rows come, Arrow's reader says of a database's error only that there was one."""

    class Rows:
        def __init__(self, sent: int) -> None:
            self.sent = sent

        def to_arrow_reader(self, _rows: int) -> Iterator[pa.RecordBatch]:
            yield pa.record_batch({"t_ns": range(self.sent, self.sent + 2)})
            if not self.sent:
                raise OSError("Out of Memory Error: could not allocate block")

    class Connection:
        def execute(self, sql: str, values: list[int] | None = None) -> Any:
            return Rows(values[0]) if values else store_.execute(sql)

    with store.connect(memory_limit="200MB") as store_:
        blocks = margins._sorted_margin_batches(Connection(), MemoryLimit(store_, 200_000_000))  # type: ignore[arg-type]
        assert [t for block in blocks for t in block["t_ns"].to_pylist()] == [0, 1, 2, 3]
        blocks = margins._sorted_margin_batches(Connection(), MemoryLimit(store_, None))  # type: ignore[arg-type]
        with pytest.raises(OSError, match="Out of Memory"):
            list(blocks)


@pytest.mark.parametrize(
    ("text", "n_bytes"),
    [
        (None, DEFAULT_MEMORY_BYTES),
        ("none", None),
        ("512MB", 512_000_000),
        ("1.5 gb", 1_500_000_000),
        ("1GiB", 2**30),
    ],
)
def test_sizes(text: str | None, n_bytes: int | None) -> None:
    assert option_values.parse_memory(text) == n_bytes


@pytest.mark.parametrize("text", ["", "512", "-1GB", "much", "99MB", "0GB", "1 GB 2"])
def test_what_is_no_size_is_refused(text: str) -> None:
    with pytest.raises(UsageError, match="--memory"):
        option_values.parse_memory(text)
