"""`drivelint audit`: the rows of `check`, kept, resumed, and the same whoever judged them."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import TYPE_CHECKING

import pyarrow.compute as pc
import pyarrow.parquet as pq
import pytest

from drivelint import run
from drivelint.audit import AuditRequest, JudgeSettings, audit, identity, merge, worker
from drivelint.audit import run as audit_run
from drivelint.audit.ask import run_query
from drivelint.audit.compact import compact
from drivelint.audit.driver import MOST_ATTEMPTS_PER_DRIVE, divide_into_tasks
from drivelint.audit.executors import TaskOutcome
from drivelint.audit.lock import lock_results
from drivelint.audit.model import AuditDrive
from drivelint.audit.store import LocalFolder
from drivelint.audit.text import summary_text
from drivelint.drive.trace import DriveInput
from drivelint.engine.memory import MemoryLimit
from drivelint.errors import ExitCode, UsageError
from drivelint.fleet_report import gated
from drivelint.fleet_report.audit_views import open_audits
from drivelint.report import junit
from drivelint.report.progress import Silent
from drivelint.result.model import exit_status
from tests.audit import fleet
from tests.audit.here import SETTINGS, InThisProcess, run_audit
from tests.audit.kills import audit_with_kills

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.audit import AuditSummary

N_DRIVES = 12


@pytest.fixture(scope="module")
def undisturbed(drives: fleet.Fleet, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, AuditSummary]:
    out = tmp_path_factory.mktemp("undisturbed") / "audit"
    return out, run_audit(drives, out)


def query_rows(out: Path, query: str) -> list[dict[str, object]]:
    found: list[dict[str, object]] = json.loads(run_query(str(out), query, "json"))
    return found


def test_the_planted_contacts_and_only_they_are_found(
    drives: fleet.Fleet, undisturbed: tuple[Path, AuditSummary]
) -> None:
    out, counted = undisturbed
    found = query_rows(out, "SELECT DISTINCT d.file_name AS name FROM findings f JOIN drives d USING (key)")
    assert {row["name"] for row in found} == drives.planted
    assert (counted.n_drives, counted.n_judged, counted.reused) == (N_DRIVES, N_DRIVES, 0)
    assert counted.failed == {"critical": len(drives.planted)}
    assert counted.exit_code("critical", strict=False) == ExitCode.FAILED


@pytest.mark.ci
def test_the_rows_are_those_of_check(
    drives: fleet.Fleet, undisturbed: tuple[Path, AuditSummary], tmp_path: Path
) -> None:
    logs = (str(drives.manifest.parent / "logs"),)
    options = run.CheckOptions(traces=logs, map=drives.road, rules=(fleet.RULE,), annotate=False, robustness=False)
    result = run.check(options, Silent())
    out, _ = undisturbed
    for table, rows in (("verdicts", result.verdicts), ("findings", result.findings), ("drives", result.drives)):
        (file,) = (out / "tables" / table).iterdir()
        own = pq.read_table(file).select(rows.column_names)
        names = ["drive_id"] if table == "drives" else ["drive_id", "rule_id", "occurrence"]
        order = [(name, "ascending") for name in names]
        assert own.sort_by(order).to_pylist() == rows.sort_by(order).to_pylist()
    same = gated.audit_result(str(out))
    assert exit_status(same) == exit_status(result)
    assert junit.render(same) == junit.render(result)


@pytest.mark.slow
def test_copies_are_judged_where_asked(tmp_path: Path) -> None:
    few = fleet.write(tmp_path / "fleet", 6, seed=3)
    assert few.planted
    logs = (str(few.manifest.parent / "logs"),)
    result = run.check(run.CheckOptions(traces=logs, map=few.road, rules=(fleet.RULE,), annotate=False), Silent())
    told = {row["drive_id"]: (row["n_copies"], row["n_stays"]) for row in result.findings.to_pylist()}
    asking = replace(SETTINGS, robustness=True)
    request = AuditRequest(sources=(str(few.manifest),), map=few.road, out=str(tmp_path / "out"), settings=asking)
    audit(request, Silent(), InThisProcess())
    rows = query_rows(tmp_path / "out", "SELECT drive_id, n_copies, n_stays FROM findings")
    assert {row["drive_id"]: (row["n_copies"], row["n_stays"]) for row in rows} == told
    assert all(n_copies for n_copies, _ in told.values())


def test_tags_of_the_manifest_are_in_the_table_of_drives(undisturbed: tuple[Path, AuditSummary]) -> None:
    found = query_rows(
        undisturbed[0], "SELECT tags['release'] AS r, count(*) AS n FROM drives GROUP BY ALL ORDER BY ALL"
    )
    assert found == [{"r": "v0", "n": N_DRIVES // 2}, {"r": "v1", "n": N_DRIVES // 2}]


def test_a_second_run_reuses_every_result(drives: fleet.Fleet, undisturbed: tuple[Path, AuditSummary]) -> None:
    out, first = undisturbed
    executor = InThisProcess()
    again = run_audit(drives, out, executor)
    assert (again.reused, again.digest) == (N_DRIVES, first.digest)
    assert not executor.tasks


@pytest.mark.slow
def test_a_log_that_changed_is_judged_again(tmp_path: Path) -> None:
    few = fleet.write(tmp_path / "fleet", 4)
    run_audit(few, tmp_path / "out")
    log = next((tmp_path / "fleet" / "logs").iterdir())
    rows = pq.read_table(log)
    pq.write_table(rows.slice(0, rows.num_rows - 1), log)
    again = run_audit(few, tmp_path / "out")
    assert (again.reused, again.n_drives) == (3, 4)


@pytest.mark.slow
@pytest.mark.parametrize("workers", [pytest.param(1, marks=pytest.mark.slow), 2])
def test_processes_give_the_same_tables(
    drives: fleet.Fleet, undisturbed: tuple[Path, AuditSummary], tmp_path: Path, workers: int
) -> None:
    request = AuditRequest(
        sources=(str(drives.manifest),), map=drives.road, out=str(tmp_path / "out"), settings=SETTINGS, workers=workers
    )
    assert audit(request, Silent()).digest == undisturbed[1].digest


@pytest.mark.slow
def test_a_worker_that_gives_memory_back_after_each_task_gives_the_same_tables(
    drives: fleet.Fleet, undisturbed: tuple[Path, AuditSummary], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    released: list[MemoryLimit] = []
    release = MemoryLimit.release_unused_memory
    monkeypatch.setattr(worker, "TASKS_PER_RELEASE", 1)

    def noted(memory: MemoryLimit) -> None:
        released.append(memory)
        release(memory)

    monkeypatch.setattr(MemoryLimit, "release_unused_memory", noted)
    assert run_audit(drives, tmp_path / "out", InThisProcess()).digest == undisturbed[1].digest
    assert len(released) > 1


@pytest.mark.slow
def test_shards_give_the_same_tables(
    drives: fleet.Fleet, undisturbed: tuple[Path, AuditSummary], tmp_path: Path
) -> None:
    parts = [run_audit(drives, tmp_path / "out", shard=(n, 3)) for n in (1, 2, 3)]
    assert sum(part.n_drives for part in parts) == N_DRIVES
    assert all(0 < part.n_drives < N_DRIVES for part in parts)
    assert {part.digest for part in parts} == {None}
    assert merge(str(tmp_path / "out"), Silent()).digest == undisturbed[1].digest


@pytest.mark.ci
def test_kills_lose_nothing_and_double_nothing(
    drives: fleet.Fleet, undisturbed: tuple[Path, AuditSummary], tmp_path: Path
) -> None:
    command = drives.command(tmp_path / "out", "--memory", "200MB")
    code, killed = audit_with_kills(command, n_kills=4, seconds=2.0)
    assert killed > 0
    assert code == ExitCode.FAILED
    summary = json.loads((tmp_path / "out" / "summary.json").read_text(encoding="utf-8"))
    assert (summary["n_drives"], summary["quarantined"]) == (N_DRIVES, 0)
    assert summary["digest"] == undisturbed[1].digest
    out = tmp_path / "out"
    left = {path.relative_to(out).as_posix() for path in out.rglob("*") if path.is_file()}
    parts = {"parts/begun/all", "parts/ended/all"}
    files = {".lock", "audit.json", "files.json", "rules.parquet", "summary.json"}
    assert {name for name in left if not name.startswith("tables/")} == parts | files


@pytest.mark.slow
def test_a_batch_that_another_audit_takes_for_a_rest_is_written_again(
    drives: fleet.Fleet, undisturbed: tuple[Path, AuditSummary], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A worker of a lost cluster may have written a batch, and not yet its receipts, when the audit is given again."""
    create = LocalFolder.create
    batches: list[str] = []

    def create_after_another_began(results: LocalFolder, name: str, content: bytes) -> bool:
        if name.startswith("receipts/") and not batches:
            batches.extend(results.names("batches"))
            compact(results)
            assert not list(results.names("batches"))
        return create(results, name, content)

    monkeypatch.setattr(LocalFolder, "create", create_after_another_began)
    counted = run_audit(drives, tmp_path / "out")
    assert len(batches) == len(worker.TABLES)
    assert (counted.n_drives, counted.digest) == (N_DRIVES, undisturbed[1].digest)


def test_the_first_tasks_are_small_so_that_an_early_interrupt_keeps_something() -> None:
    drives = [AuditDrive(f"{n:03}.mcap", DriveInput()) for n in range(100)]
    cut = [
        len(task.drives)
        for task in divide_into_tasks(drives, "", "run", SETTINGS, group_size=100, max_drives=30, n_small=2)
    ]
    assert cut == [8, 8, 30, 30, 24]


@pytest.mark.slow
def test_a_drive_over_which_workers_die_is_quarantined_and_the_others_are_judged(
    drives: fleet.Fleet, tmp_path: Path
) -> None:
    executor = InThisProcess(poison="drive-00003")
    counted = run_audit(drives, tmp_path / "out", executor)
    assert (counted.n_judged, counted.quarantined) == (N_DRIVES - 1, 1)
    assert len(executor.lost_sizes) == MOST_ATTEMPTS_PER_DRIVE
    assert executor.lost_sizes[1:] == [1] * (MOST_ATTEMPTS_PER_DRIVE - 1)
    (row,) = query_rows(tmp_path / "out", "SELECT status, status_reason FROM drives WHERE status <> 'judged'")
    assert row["status"] == "not_judged"
    assert "3 workers died on this drive: the worker died" in str(row["status_reason"])
    assert counted.exit_code("never", strict=False) == ExitCode.NOT_JUDGED


@pytest.mark.slow
def test_a_drive_that_takes_too_long_is_quarantined(drives: fleet.Fleet, tmp_path: Path) -> None:
    one = drives.manifest.parent / "logs" / "drive-00000.parquet"
    request = AuditRequest(
        sources=(str(one),),
        map=drives.road,
        out=str(tmp_path / "out"),
        settings=SETTINGS,
        workers=1,
        drive_timeout_s=0.01,
    )
    counted = audit(request, Silent())
    assert (counted.n_drives, counted.quarantined) == (1, 1)


@pytest.mark.slow
def test_a_bad_log_is_refused_and_tried_again_when_asked(tmp_path: Path) -> None:
    few = fleet.write(tmp_path / "fleet", 4)
    log = tmp_path / "fleet" / "logs" / "drive-00001.parquet"
    whole = log.read_bytes()
    log.write_bytes(whole[: len(whole) // 2])
    first = run_audit(few, tmp_path / "out")
    assert (first.n_judged, first.n_refused) == (3, 1)
    assert run_audit(few, tmp_path / "out").reused == 4
    again = run_audit(few, tmp_path / "out", retry_errors=True)
    assert (again.n_refused, again.reused) == (1, 3)
    log.write_bytes(whole)
    mended = run_audit(few, tmp_path / "out", retry_errors=True)
    assert (mended.n_judged, mended.n_refused, mended.n_drives) == (4, 0, 4)


@pytest.mark.slow
def test_copies_of_another_name_are_drives_of_their_own_as_in_check(tmp_path: Path) -> None:
    few = fleet.write(tmp_path / "fleet", 3)
    logs = sorted((tmp_path / "fleet" / "logs").iterdir())
    logs[1].write_bytes(logs[0].read_bytes())
    assert run_audit(few, tmp_path / "out").n_drives == 3
    assert run_audit(few, tmp_path / "out").reused == 3


@pytest.mark.slow
def test_a_log_of_the_name_and_content_of_another_is_judged_once_and_counted(tmp_path: Path) -> None:
    few = fleet.write(tmp_path / "fleet", 3)
    logs = tmp_path / "fleet" / "logs"
    (logs / "again").mkdir()
    (logs / "again" / "drive-00000.parquet").write_bytes((logs / "drive-00000.parquet").read_bytes())
    for n_reused in (0, 3):
        counted = run_audit(few, tmp_path / "out", sources=str(logs))
        assert (counted.n_drives, counted.n_asked) == (3, 4)
        assert counted.reused >= n_reused
        assert "1 log with the same name, content and tags as another" in summary_text(counted, "out", ExitCode.OK)


def tags_in(out: Path) -> list[dict[str, str]]:
    """Return the tags of the drives of an audit."""
    files = sorted((out / "tables" / "drives").iterdir())
    rows = [row for file in files for row in pq.read_table(file, partitioning=None).to_pylist()]
    return sorted((dict(row["tags"]) for row in rows), key=str)


@pytest.mark.slow
def test_a_copy_of_the_same_name_keeps_its_tags(tmp_path: Path) -> None:
    few = fleet.write(tmp_path / "fleet", 1)
    log = few.manifest.parent / "logs" / "drive-00000.parquet"
    for folder in ("again", "once more"):
        (log.parent / folder).mkdir()
        (log.parent / folder / log.name).write_bytes(log.read_bytes())
    rows = (
        f"logs/{folder}{log.name},{release}" for folder, release in (("", "a"), ("again/", "b"), ("once more/", "a"))
    )
    few.manifest.write_text("\n".join(["log,release", *rows]), encoding="utf-8")
    for _ in range(2):
        counted = run_audit(few, tmp_path / "out")
        assert tags_in(tmp_path / "out") == [{"release": "a"}, {"release": "b"}]
        assert (counted.n_drives, counted.copies, counted.n_asked) == (2, 1, 3)
        assert "1 log with the same name, content and tags as another log" in summary_text(counted, "out", ExitCode.OK)


@pytest.mark.slow
def test_a_tag_that_has_changed_is_taken(tmp_path: Path) -> None:
    few = fleet.write(tmp_path / "fleet", 2)
    run_audit(few, tmp_path / "out")
    text = few.manifest.read_text(encoding="utf-8")
    few.manifest.write_text(text.replace("york", "bath"), encoding="utf-8")
    counted = run_audit(few, tmp_path / "out")
    assert [each["site"] for each in tags_in(tmp_path / "out")] == ["leeds", "bath"]
    assert (counted.n_drives, counted.reused) == (2, 1)


@pytest.mark.slow
def test_a_renamed_log_is_judged_again_and_the_old_result_can_be_pruned(tmp_path: Path) -> None:
    few = fleet.write(tmp_path / "fleet", 2)
    logs = tmp_path / "fleet" / "logs"
    run_audit(few, tmp_path / "out", sources=str(logs))
    (logs / "drive-00000.parquet").rename(logs / "renamed.parquet")
    counted = run_audit(few, tmp_path / "out", sources=str(logs))
    assert (counted.n_drives, counted.n_asked, counted.n_absent) == (3, 2, 1)
    assert "1 result of earlier runs" in summary_text(counted, "out", ExitCode.OK)
    pruned = run_audit(few, tmp_path / "out", sources=str(logs), prune=True)
    assert (pruned.n_drives, pruned.n_asked, pruned.n_absent, pruned.reused) == (2, 2, 0, 2)


@pytest.mark.slow
def test_merge_without_a_shard_says_which_is_missing(drives: fleet.Fleet, tmp_path: Path) -> None:
    run_audit(drives, tmp_path / "out", shard=(1, 3))
    run_audit(drives, tmp_path / "out", shard=(3, 3))
    partial = merge(str(tmp_path / "out"), Silent())
    assert partial.missing_parts == ["2-of-3"]
    assert partial.exit_code("never", strict=False) == ExitCode.NOT_JUDGED
    assert "INCOMPLETE: these parts have not ended: 2-of-3" in summary_text(partial, "out", ExitCode.NOT_JUDGED)
    run_audit(drives, tmp_path / "out", shard=(2, 3))
    assert merge(str(tmp_path / "out"), Silent()).missing_parts == []
    assert run_audit(drives, tmp_path / "out", shard=(2, 3)).reused > 0


@pytest.mark.slow
def test_drives_that_their_map_does_not_fit_are_no_success(tmp_path: Path) -> None:
    few = fleet.write(tmp_path / "fleet", 4)
    assert run_audit(few, tmp_path / "whole").exit_code("never", strict=False) == ExitCode.OK
    log = few.manifest.parent / "logs" / "drive-00001.parquet"
    states = pq.read_table(log, partitioning=None)
    beside = pc.if_else(states["is_ego"], pc.add(states["y_m"], 60.0), states["y_m"])
    pq.write_table(states.set_column(states.schema.get_field_index("y_m"), "y_m", beside), log)
    told = run_audit(few, tmp_path / "out")
    assert (told.n_judged, told.off_map) == (4, 1)
    assert told.exit_code("never", strict=False) == ExitCode.NOT_JUDGED
    assert "4 judged, 1 with a map that does not fit" in summary_text(told, "out", ExitCode.NOT_JUDGED)


@pytest.mark.slow
def test_a_shard_that_is_given_again_after_a_merge_says_what_it_said_before(tmp_path: Path) -> None:
    few = fleet.write(tmp_path / "fleet", 12)
    (tmp_path / "fleet" / "logs" / "drive-00001.parquet").write_bytes(b"PAR1")
    first = run_audit(few, tmp_path / "out", shard=(1, 1))
    assert (first.n_refused, first.failed) == (1, {"critical": len(few.planted - {"drive-00001.parquet"})})
    merge(str(tmp_path / "out"), Silent())
    again = run_audit(few, tmp_path / "out", shard=(1, 1))
    assert (again.n_judged, again.n_refused, again.failed) == (first.n_judged, first.n_refused, first.failed)
    assert again.exit_code("critical", strict=False) == first.exit_code("critical", strict=False) == ExitCode.FAILED


@pytest.mark.slow
def test_an_audit_that_did_not_end_does_not_look_whole_after_a_merge(tmp_path: Path) -> None:
    few = fleet.write(tmp_path / "fleet", 20)

    class Stopped(InThisProcess):
        def wait(self) -> list[TaskOutcome]:
            if len(self.tasks) < 2:
                raise KeyboardInterrupt
            return super().wait()

    for shard in (None, (1, 2)):
        out = tmp_path / f"out{shard}"
        with pytest.raises(KeyboardInterrupt):
            run_audit(few, out, Stopped(), shard=shard)
        partial = merge(str(out), Silent())
        assert partial.missing_parts
        assert partial.exit_code("never", strict=False) == ExitCode.NOT_JUDGED
        with open_audits(str(out)) as (_, found, _):
            assert "has not ended" in found.warning


@pytest.mark.slow
def test_what_takes_results_out_is_refused_with_shards(drives: fleet.Fleet, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="--retry-errors and --prune"):
        run_audit(drives, tmp_path / "out", shard=(1, 2), retry_errors=True)
    few = fleet.write(tmp_path / "fleet", 3)
    run_audit(few, tmp_path / "few", shard=(1, 1))
    merge(str(tmp_path / "few"), Silent())
    log = tmp_path / "fleet" / "logs" / "drive-00000.parquet"
    rows = pq.read_table(log)
    pq.write_table(rows.slice(0, rows.num_rows - 1), log)
    with pytest.raises(UsageError, match="1 log changed since"):
        run_audit(few, tmp_path / "few", shard=(1, 1))


@pytest.mark.slow
def test_two_audits_do_not_pack_one_place_at_once(drives: fleet.Fleet, tmp_path: Path) -> None:
    with (
        lock_results(LocalFolder(tmp_path / "out"), shared=False),
        pytest.raises(UsageError, match="another audit is running"),
    ):
        run_audit(drives, tmp_path / "out")
    with lock_results(LocalFolder(tmp_path / "out"), shared=True):
        run_audit(drives, tmp_path / "out", shard=(1, 2))
        with pytest.raises(UsageError, match="another audit is running"):
            merge(str(tmp_path / "out"), Silent())


@pytest.mark.slow
def test_the_summary_names_contacts_broken_rules_and_what_was_not_judged(tmp_path: Path) -> None:
    few = fleet.write(tmp_path / "fleet", 12)
    log = tmp_path / "fleet" / "logs" / "drive-00001.parquet"
    log.write_bytes(b"PAR1")
    text = summary_text(run_audit(few, tmp_path / "out"), "out", ExitCode.FAILED)
    n = len(few.planted - {log.name})
    assert n > 1
    assert f"findings: {n} critical, 0 major, 0 minor; CONTACT in {n} drives; certainty: not examined" in text
    assert f"critical {fleet.RULE}: {n} finding" in text
    assert "not judged: 1 drive" in text
    assert "refused: " in text
    assert "exit 1" in text


def test_other_rules_are_refused_in_the_same_folder(
    drives: fleet.Fleet, undisturbed: tuple[Path, AuditSummary]
) -> None:
    request = AuditRequest(
        sources=(str(drives.manifest),),
        map=drives.road,
        out=str(undisturbed[0]),
        settings=JudgeSettings(rules=("rss",)),
    )
    with pytest.raises(UsageError, match="other rules, parameters or profiles"):
        audit(request, Silent(), InThisProcess())


def test_other_versions_are_refused_in_the_same_folder(
    drives: fleet.Fleet, undisturbed: tuple[Path, AuditSummary], monkeypatch: pytest.MonkeyPatch
) -> None:
    other = {**identity.versions(), "duckdb": "0.0.1"}
    for module in (identity, audit_run):
        monkeypatch.setattr(module, "versions", lambda: other)
    with pytest.raises(UsageError, match="made with other versions of duckdb: choose another --out"):
        run_audit(drives, undisturbed[0])


@pytest.mark.parametrize(
    "query",
    [
        "SELECT 1; SELECT 2",
        "CREATE TABLE x (a INT)",
        "FROM '/etc/hostname'",
        "SELECT * FROM read_text('/etc/hostname')",
    ],
)
def test_sql_reads_nothing_else_and_changes_nothing(undisturbed: tuple[Path, AuditSummary], query: str) -> None:
    with pytest.raises(UsageError):
        run_query(str(undisturbed[0]), query, "json")


def test_two_logs_of_one_drive_have_rows_of_their_own_key(undisturbed: tuple[Path, AuditSummary]) -> None:
    out, _ = undisturbed
    (file,) = (out / "tables" / "drives").iterdir()
    keys = pq.read_table(file)["key"]
    assert pc.count_distinct(keys).as_py() == len(keys) == N_DRIVES
