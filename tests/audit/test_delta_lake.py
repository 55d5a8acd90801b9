"""`--delta`: the Delta tables have the rows of the packed tables, and every version of them is whole."""

from __future__ import annotations

import json
import shutil
import signal
import subprocess
import sys
from functools import partial
from typing import TYPE_CHECKING

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from deltalake import DeltaTable, write_deltalake

from drivelint.audit import delta_lake, merge
from drivelint.audit.delta_lake import DIGEST_KEY, TABLE_NAMES
from drivelint.errors import ExitCode, UsageError
from drivelint.report.progress import Progress, Silent
from drivelint.result.publishing import OutputError
from tests.audit import fleet
from tests.audit.here import run_audit
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.ci

N_DRIVES = 6
_IN_DELTA = (pa.types.is_string, pa.types.is_boolean, pa.types.is_int32, pa.types.is_int64, pa.types.is_float64)
_KILLED = """
import os, signal, sys
from drivelint.audit import delta_lake, merge
from drivelint.report.progress import Silent

wrote = delta_lake.open_store

def killed(where):
    store = wrote(where)
    if where.endswith("/findings"):
        os.kill(os.getpid(), signal.SIGKILL) if sys.argv[3] == "table" else None
        write = store.write
        def half(name, content):
            write(name, content)
            os.kill(os.getpid(), signal.SIGKILL)
        store.write = half
    return store

delta_lake.open_store = killed
merge(sys.argv[1], Silent(), sys.argv[2])
"""


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> fleet.Fleet:
    return fleet.write(tmp_path_factory.mktemp("fleet"), N_DRIVES, seed=1)


@pytest.fixture(scope="module")
def finished(drives: fleet.Fleet, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An audit of all drives but the last, which the tests copy."""
    assert drives.planted, "there are findings"
    out = tmp_path_factory.mktemp("finished") / "out"
    run_audit(drives, out, sources=some(drives, out.parent, N_DRIVES - 1))
    return out


@pytest.fixture
def out(finished: Path, tmp_path: Path) -> Path:
    shutil.copytree(finished, tmp_path / "out")
    return tmp_path / "out"


class Heard(Progress):
    """Keeps the notes."""

    def __init__(self) -> None:
        self.notes: list[str] = []

    def note(self, text: str) -> None:
        self.notes.append(text)


def some(drives: fleet.Fleet, home: Path, n: int) -> str:
    """Write a manifest of the first `n` drives."""
    manifest = home / f"first-{n}.csv"
    logs = sorted((drives.manifest.parent / "logs").iterdir())[:n]
    manifest.write_text("\n".join(["log", *map(str, logs)]) + "\n", encoding="utf-8")
    return str(manifest)


def packed(out: Path, table: str) -> pa.Table:
    files = [out / "rules.parquet"] if table == "rules" else sorted((out / "tables" / table).iterdir())
    return pa.concat_tables(pq.read_table(file, partitioning=None) for file in files)


def rows(of: pa.Table) -> list[str]:
    """Return the rows as text, in an order of their own."""
    return sorted(json.dumps(row, sort_keys=True) for row in of.to_pylist())


def in_delta(lake: Path, table: str, version: int | None = None) -> pa.Table:
    return DeltaTable(str(lake / table), version=version).to_pyarrow_table()


def by_hand(table: Path) -> pa.Table:
    """Read a table by its log alone, as any reader of the protocol's first version would."""
    there: set[str] = set()
    for commit in sorted((table / "_delta_log").glob("*.json")):
        for line in commit.read_text(encoding="utf-8").splitlines():
            action = json.loads(line)
            there |= {action["add"]["path"]} if "add" in action else set()
            there -= {action["remove"]["path"]} if "remove" in action else set()
    return pa.concat_tables(pq.read_table(table / name, partitioning=None) for name in sorted(there))


def holds(out: Path, lake: Path) -> bool:
    """Whether each Delta table has the rows of the packed table."""
    return all(rows(in_delta(lake, table)) == rows(packed(out, table)) for table in TABLE_NAMES)


def versions(lake: Path) -> list[int]:
    return [DeltaTable(str(lake / table)).version() for table in TABLE_NAMES]


def leaves(type_: pa.DataType) -> list[pa.DataType]:
    if pa.types.is_map(type_):
        return [*leaves(type_.key_type), *leaves(type_.item_type)]
    if pa.types.is_list(type_):
        return leaves(type_.value_type)
    if pa.types.is_struct(type_):
        return [leaf for field in type_ for leaf in leaves(field.type)]
    return [type_]


@pytest.mark.slow
@pytest.mark.parametrize("place", ["lake", "a lake of #1, 50 % é"])
def test_two_readers_find_the_rows_and_types_of_the_packed_tables(out: Path, tmp_path: Path, place: str) -> None:
    lake = tmp_path / place
    digest = merge(str(out), Silent(), str(lake)).digest
    assert packed(out, "findings").num_rows > 0
    for table in TABLE_NAMES:
        told = packed(out, table)
        found = in_delta(lake, table)
        assert rows(found) == rows(told) == rows(by_hand(lake / table)), table
        assert found.schema.names == told.schema.names
        assert [leaves(field.type) for field in found.schema] == [leaves(field.type) for field in told.schema]
        about = DeltaTable(str(lake / table))
        assert about.protocol()[:2] == (1, 2), "every reader knows this protocol"
        assert about.count() == told.num_rows
        (commit,) = (lake / table / "_delta_log").iterdir()
        assert digest is not None
        assert f'"{DIGEST_KEY}":"{digest}"' in commit.read_text(encoding="utf-8")


def test_the_packed_tables_have_only_types_that_delta_has(out: Path) -> None:
    """Their files are copied: a type that Delta lacks (unsigned, nanoseconds, enum) would be told wrong."""
    types = {leaf for table in TABLE_NAMES for field in packed(out, table).schema for leaf in leaves(field.type)}
    assert [each for each in types if not any(known(each) for known in _IN_DELTA)] == []


def test_given_again_it_changes_nothing_and_a_grown_audit_adds_to_it(
    drives: fleet.Fleet, out: Path, tmp_path: Path
) -> None:
    lake = tmp_path / "lake"
    merge(str(out), Silent(), str(lake))
    before = sorted((path, path.stat().st_mtime_ns) for path in lake.rglob("*"))
    heard = Heard()
    merge(str(out), heard, str(lake))
    assert heard.notes == [f"{lake}: the Delta tables were up to date"]
    assert sorted((path, path.stat().st_mtime_ns) for path in lake.rglob("*")) == before
    former = {table: rows(in_delta(lake, table)) for table in TABLE_NAMES}
    run_audit(drives, out, sources=some(drives, tmp_path, N_DRIVES), delta=str(lake))
    assert versions(lake) == [1] * len(TABLE_NAMES), "the rules are the same: their commit has only the new digest"
    assert holds(out, lake)
    assert in_delta(lake, "receipts").num_rows == N_DRIVES
    assert {table: rows(in_delta(lake, table, version=0)) for table in TABLE_NAMES} == former
    assert {path for path, _ in before} <= set(lake.rglob("*")), "no file of a former version is gone"


@pytest.mark.slow
def test_what_was_pruned_or_judged_again_is_not_in_the_next_version(
    drives: fleet.Fleet, out: Path, tmp_path: Path
) -> None:
    lake = tmp_path / "lake"
    merge(str(out), Silent(), str(lake))
    home = tmp_path / "logs"
    shutil.copytree(drives.manifest.parent, home)
    here = fleet.Fleet(home / drives.manifest.name, home / drives.road.name, drives.planted)
    fewer = some(here, tmp_path, N_DRIVES - 2)
    run_audit(here, out, sources=fewer, prune=True, delta=str(lake))
    assert holds(out, lake)
    pruned = in_delta(lake, "receipts")
    assert pruned.num_rows == N_DRIVES - 2
    log = home / "logs" / "drive-00000.parquet"
    states = pq.read_table(log, partitioning=None)
    pq.write_table(states.slice(0, states.num_rows - 3), log)
    run_audit(here, out, sources=fewer, delta=str(lake))
    assert holds(out, lake)
    again = in_delta(lake, "receipts")
    assert again.num_rows == N_DRIVES - 2
    assert len(set(again["key"].to_pylist()) - set(pruned["key"].to_pylist())) == 1


@pytest.mark.slow
@pytest.mark.parametrize("when", ["copy", "table"])
def test_killed_in_the_middle_every_table_is_as_before_or_as_after(
    drives: fleet.Fleet, out: Path, tmp_path: Path, when: str
) -> None:
    lake = tmp_path / "lake"
    merge(str(out), Silent(), str(lake))
    former = {table: rows(in_delta(lake, table)) for table in TABLE_NAMES}
    run_audit(drives, out)
    command = [sys.executable, "-c", _KILLED, str(out), str(lake), when]
    assert subprocess.run(command, cwd=ROOT, check=False).returncode == -signal.SIGKILL
    written = TABLE_NAMES.index("findings")
    assert versions(lake) == [1] * written + [0] * (len(TABLE_NAMES) - written)
    for table in TABLE_NAMES[:written]:
        assert rows(in_delta(lake, table)) == rows(packed(out, table))
    for table in TABLE_NAMES[written:]:
        assert rows(in_delta(lake, table)) == former[table]
    assert not holds(out, lake)
    merge(str(out), Silent(), str(lake))
    assert holds(out, lake)


def test_killed_while_it_makes_a_table_there_is_none(out: Path, tmp_path: Path) -> None:
    lake = tmp_path / "lake"
    command = [sys.executable, "-c", _KILLED, str(out), str(lake), "copy"]
    assert subprocess.run(command, cwd=ROOT, check=False).returncode == -signal.SIGKILL
    assert list((lake / "findings").glob("*.parquet")), "the file was copied, the commit was not made"
    assert not DeltaTable.is_deltatable(str(lake / "findings"))
    merge(str(out), Silent(), str(lake))
    assert holds(out, lake)


def test_what_others_did_to_the_rows_is_undone(out: Path, tmp_path: Path) -> None:
    lake = tmp_path / "lake"
    merge(str(out), Silent(), str(lake))
    DeltaTable(str(lake / "verdicts")).delete("verdict = 'fail'")
    assert not holds(out, lake)
    merge(str(out), Silent(), str(lake))
    assert holds(out, lake)


def test_of_an_unfinished_audit_nothing_is_written(drives: fleet.Fleet, tmp_path: Path) -> None:
    out, lake, heard = tmp_path / "out", tmp_path / "lake", Heard()
    for option in ({"shard": (1, 2)}, {"claim": True}):
        with pytest.raises(UsageError, match="when all parts have ended, run drivelint merge --delta"):
            run_audit(drives, out, delta=str(lake), **option)
    assert not out.exists()
    run_audit(drives, out, shard=(1, 2))
    assert merge(str(out), heard, str(lake)).missing_parts == ["2-of-2"]
    assert heard.notes == [f"{lake}: the Delta tables stay as they are: parts of the audit have not ended"]
    assert not lake.exists()
    run_audit(drives, out, shard=(2, 2))
    merge(str(out), Silent(), str(lake))
    assert holds(out, lake)


def test_a_table_of_somebody_else_is_refused_before_anything_is_judged(drives: fleet.Fleet, tmp_path: Path) -> None:
    lake = tmp_path / "lake"
    write_deltalake(str(lake / "drives"), pa.table({"driver": ["Ann"]}))
    with pytest.raises(UsageError, match="drives: has a Delta table that drivelint did not write"):
        run_audit(drives, tmp_path / "out", delta=str(lake))
    assert not (tmp_path / "out").exists()
    assert in_delta(lake, "drives")["driver"].to_pylist() == ["Ann"]


def test_the_table_of_an_audit_by_other_rules_is_refused(out: Path, tmp_path: Path) -> None:
    lake = tmp_path / "lake"
    merge(str(out), Silent(), str(lake))
    told = json.loads((out / "audit.json").read_text(encoding="utf-8"))
    (out / "audit.json").write_text(json.dumps({**told, "run_id": "another"}), encoding="utf-8")
    with pytest.raises(UsageError, match="has a Delta table by other rules, parameters or versions"):
        merge(str(out), Silent(), str(lake))


@pytest.mark.parametrize("within", ["", "tables", "../out/lake/"])
def test_a_place_within_the_audit_is_refused(out: Path, within: str) -> None:
    with pytest.raises(UsageError, match="lies within the audit"):
        merge(str(out), Silent(), f"{out}/{within}")
    merge(str(out), Silent(), f"{out}-2/lake")


def test_a_file_is_no_place_for_tables(drives: fleet.Fleet, tmp_path: Path) -> None:
    (tmp_path / "lake").write_text("a file", encoding="ascii")
    with pytest.raises(UsageError, match="lake: is a file: give a folder for the Delta tables"):
        run_audit(drives, tmp_path / "out", delta=str(tmp_path / "lake"))
    assert not (tmp_path / "out").exists()


def test_without_deltalake_one_line_says_what_to_install(
    drives: fleet.Fleet, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "deltalake", None)
    with pytest.raises(UsageError, match=r"^--delta: deltalake is not installed: pip install 'drivelint\[delta\]'$"):
        run_audit(drives, tmp_path / "out", delta=str(tmp_path / "lake"))
    assert not (tmp_path / "out").exists()


def test_an_answer_that_was_cut_off_is_asked_for_again_and_errors_have_no_colours() -> None:
    asked = []

    def cut(n: int) -> str:
        asked.append(n)
        if len(asked) < n:
            raise OSError("Generic S3 error\n \x1b[31m↳\x1b[0m cut off")
        return "whole"

    assert delta_lake._run_with_retries("lake", partial(cut, 3)) == "whole"
    assert len(asked) == 3
    asked.clear()
    with pytest.raises(
        OutputError, match=r"^lake: the Delta table failed: Generic S3 error ↳ cut off: run the same command again$"
    ):
        delta_lake._run_with_retries("lake", partial(cut, 99))


def test_a_place_that_cannot_be_written_makes_exit_code_75(out: Path, tmp_path: Path) -> None:
    (tmp_path / "lake").mkdir()
    (tmp_path / "lake" / "findings").write_text("no folder", encoding="ascii")
    with pytest.raises(OutputError, match=r"findings: the Delta table failed: .+: run the same command again") as told:
        merge(str(out), Silent(), str(tmp_path / "lake"))
    assert told.value.exit_code == ExitCode.TEMPFAIL
