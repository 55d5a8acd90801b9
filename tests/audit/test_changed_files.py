"""An audit whose files were changed after its end is refused by `report`, `diff` and `what-if`, as a changed result of `check` is."""

from __future__ import annotations

import json
import shutil
from functools import partial
from typing import TYPE_CHECKING

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from drivelint.audit.ask import run_query
from drivelint.audit.run import merge
from drivelint.errors import UsageError
from drivelint.fleet_report.audit_views import open_audits, open_two_audits
from drivelint.report.progress import Silent
from drivelint.result.names import MANIFEST
from tests.audit import fleet
from tests.audit.here import InThisProcess, run_audit

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

pytestmark = pytest.mark.ci


@pytest.fixture(scope="module")
def small_fleet(tmp_path_factory: pytest.TempPathFactory) -> fleet.Fleet:
    return fleet.write(tmp_path_factory.mktemp("fleet"), 8)


@pytest.fixture(scope="module")
def ended(small_fleet: fleet.Fleet, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("ended") / "out"
    run_audit(small_fleet, out)
    return out


@pytest.fixture
def copy(ended: Path, tmp_path: Path) -> Path:
    return tmp_path / shutil.copytree(ended, tmp_path / "out").name


def only_file(out: Path, table: str) -> Path:
    (file,) = (out / "tables" / table).iterdir()
    return file


def without_a_row(out: Path) -> str:
    file = only_file(out, "findings")
    pq.write_table(pq.read_table(file, partitioning=None).slice(1), file)
    return file.name


def of_another_severity(out: Path) -> str:
    rules = pq.read_table(out / "rules.parquet")
    column = rules.column_names.index("severity")
    other = rules.set_column(column, rules.schema.field(column), [["minor"] * rules.num_rows])
    pq.write_table(other, out / "rules.parquet")
    return "rules.parquet"


def by_other_settings(out: Path) -> str:
    file = out / "audit.json"
    file.write_text(json.dumps(json.loads(file.read_text(encoding="utf-8")) | {"fail_on": "never"}), encoding="utf-8")
    return file.name


def with_a_file_more(out: Path) -> str:
    file = only_file(out, "findings")
    shutil.copy(file, file.with_name("0.parquet"))
    return "0.parquet"


def without_a_file(out: Path) -> str:
    file = only_file(out, "verdicts")
    file.unlink()
    return file.name


@pytest.mark.parametrize(
    "change", [without_a_row, of_another_severity, by_other_settings, with_a_file_more, without_a_file]
)
def test_a_changed_file_is_named(ended: Path, copy: Path, change: Callable[[Path], str]) -> None:
    name = change(copy)
    for sides in ((ended, copy), (copy, ended)):
        with (
            pytest.raises(UsageError, match=f"{name}: was changed since drivelint audit wrote it"),
            open_two_audits(*map(str, sides)),
        ):
            pass
    with pytest.raises(UsageError, match=name), open_audits(str(copy)):
        pass


@pytest.mark.parametrize("change", [without_a_row, of_another_severity, with_a_file_more])
def test_sql_answers_from_a_changed_file_and_says_so(ended: Path, copy: Path, change: Callable[[Path], str]) -> None:
    query, warned = "SELECT count(*) AS n FROM findings", list[str]()
    assert json.loads(run_query(str(ended), query, "json", warned.append))[0]["n"] > 0
    assert warned == []
    name = change(copy)
    json.loads(run_query(str(copy), query, "json", warned.append))
    assert [f"{name}: was changed since drivelint audit wrote it" in each for each in warned] == [True]


def test_a_missing_file_is_not_taken_for_another_run(copy: Path) -> None:
    only_file(copy, "findings").unlink()
    with pytest.raises(UsageError, match=r"files\.json lists is missing"):
        run_query(str(copy), "FROM findings", "json")


@pytest.mark.parametrize(
    "change", [without_a_row, of_another_severity, by_other_settings, with_a_file_more, without_a_file]
)
def test_no_run_goes_on_from_a_changed_file(
    small_fleet: fleet.Fleet, copy: Path, change: Callable[[Path], str]
) -> None:
    """Else its end would list the changed file as whole."""
    name = change(copy)
    for shard in (None, (1, 2)):
        with pytest.raises(UsageError, match=f"{name}: was changed since drivelint audit wrote it.*into another --out"):
            run_audit(small_fleet, copy, shard=shard)
    with pytest.raises(UsageError, match=name):
        merge(str(copy), Silent())
    with pytest.raises(UsageError, match=name), open_audits(str(copy)):
        pass


def passed(file: Path) -> None:
    rows = pq.read_table(file, partitioning=None)
    column = rows.column_names.index("verdict")
    pq.write_table(rows.set_column(column, rows.schema.field(column), [["pass"] * rows.num_rows]), file)


def with_a_row_twice(file: Path) -> None:
    rows = pq.read_table(file, partitioning=None)
    pq.write_table(pa.concat_tables([rows, rows.slice(0, 1)]), file)


def of_nobody(file: Path) -> None:
    rows = pq.read_table(file, partitioning=None)
    other = rows.slice(0, 1).set_column(0, rows.schema.field(0), [["0" * 64]])
    pq.write_table(pa.concat_tables([other, rows]), file)


def without_a_sense(file: Path) -> None:
    file.write_bytes(b"PAR1")


@pytest.mark.parametrize("change", [passed, with_a_row_twice, of_nobody, without_a_sense])
def test_no_run_goes_on_from_changed_rows_without_the_list(
    small_fleet: fleet.Fleet, copy: Path, change: Callable[[Path], None]
) -> None:
    (copy / MANIFEST).unlink()
    change(only_file(copy, "verdicts"))
    for again in (partial(run_audit, small_fleet, copy), partial(merge, str(copy), Silent())):
        with pytest.raises(UsageError, match=r"since drivelint audit wrote|did not write.*into another --out"):
            again()
    assert not (copy / MANIFEST).exists()


@pytest.mark.slow
@pytest.mark.parametrize("change", [passed, without_a_sense])
def test_no_run_goes_on_from_changed_rows_that_are_not_packed(
    small_fleet: fleet.Fleet, tmp_path: Path, change: Callable[[Path], None]
) -> None:
    out = tmp_path / "out"
    run_audit(small_fleet, out, shard=(1, 1))
    change(next((out / "batches" / "verdicts").iterdir()))
    for again in (partial(run_audit, small_fleet, out), partial(merge, str(out), Silent())):
        with pytest.raises(UsageError, match="since drivelint audit wrote"):
            again()


def test_an_audit_without_the_list_goes_on_where_its_rows_are_as_written(small_fleet: fleet.Fleet, copy: Path) -> None:
    (copy / MANIFEST).unlink()
    assert run_audit(small_fleet, copy).reused == 8
    assert (copy / MANIFEST).exists()


def test_an_audit_that_is_copied_elsewhere_is_whole(copy: Path) -> None:
    with open_audits(str(copy)) as (_, audit, _):
        assert audit.digest


def test_an_audit_that_goes_on_is_no_changed_one(small_fleet: fleet.Fleet, copy: Path, tmp_path: Path) -> None:
    """Neither after it has got more drives, nor while it has not come to its end."""
    more = fleet.write(tmp_path / "more", 9)
    run_audit(small_fleet, copy, sources=str(more.manifest.parent / "logs"))
    with open_audits(str(copy)) as (con, audit, _):
        assert (audit.digest is not None, con.sql("SELECT count(*) FROM drives").fetchall()) == (True, [(17,)])
    with pytest.raises(ZeroDivisionError):
        run_audit(small_fleet, copy, Dying(), sources=str(fleet.write(tmp_path / "other", 2, seed=1).manifest))
    assert not (copy / MANIFEST).exists()
    with open_audits(str(copy)) as (_, audit, _):
        assert audit.warning


@pytest.mark.slow
def test_a_merged_audit_has_the_list(small_fleet: fleet.Fleet, tmp_path: Path) -> None:
    for part in (1, 2):
        run_audit(small_fleet, tmp_path / "out", shard=(part, 2))
    assert not (tmp_path / "out" / MANIFEST).exists()
    merge(str(tmp_path / "out"), Silent())
    name = without_a_row(tmp_path / "out")
    with pytest.raises(UsageError, match=name), open_audits(str(tmp_path / "out")):
        pass


@pytest.mark.parametrize("names", [(MANIFEST,), (MANIFEST, "summary.json"), ()])
def test_an_ended_audit_without_a_readable_list_is_refused(ended: Path, copy: Path, names: tuple[str, ...]) -> None:
    """Else whoever changes a file takes the list away, too."""
    (copy / MANIFEST).write_text("{}", encoding="utf-8")
    for name in names:
        (copy / name).unlink()
    with (
        pytest.raises(UsageError, match=r"has ended, and files\.json.*give the same audit again"),
        open_audits(str(copy)),
    ):
        pass
    with pytest.raises(UsageError, match="has ended"), open_two_audits(str(ended), str(copy)):
        pass
    with pytest.raises(UsageError, match="has ended"):
        run_query(str(copy), "FROM findings", "json")


@pytest.fixture(scope="module")
def loose(small_fleet: fleet.Fleet, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return an audit that is not packed."""
    out = tmp_path_factory.mktemp("loose") / "out"
    run_audit(small_fleet, out, shard=(1, 1))
    return out


@pytest.fixture
def open_copies(copy: Path, loose: Path, tmp_path: Path) -> tuple[Path, Path]:
    """Return two audits that have not ended: packed, and not packed."""
    for name in (MANIFEST, "summary.json", "parts/ended/all"):
        (copy / name).unlink()
    return copy, tmp_path / shutil.copytree(loose, tmp_path / "loose").name


@pytest.mark.slow
def test_readers_hold_rows_of_an_unfinished_audit_against_its_receipts(open_copies: tuple[Path, Path]) -> None:
    for out in open_copies:
        warned: list[str] = []
        with open_audits(str(out)) as (_, audit, _):
            assert audit.warning
        verdicts = next(each for each in out.rglob("*.parquet") if each.parent.name == "verdicts")
        passed(verdicts)
        with pytest.raises(UsageError, match="since drivelint audit wrote"), open_audits(str(out)):
            pass
        assert run_query(str(out), "FROM verdicts", "json", warned.append)
        assert "since drivelint audit wrote" in warned[0]


def test_a_file_that_was_cut_is_an_error_with_a_sentence(
    ended: Path, open_copies: tuple[Path, Path], tmp_path: Path
) -> None:
    for of in (ended, *open_copies):
        for name in (each.relative_to(of) for each in of.rglob("[!.]*.*") if each.is_file()):
            out = tmp_path / shutil.copytree(of, tmp_path / "cut", dirs_exist_ok=True).name
            (out / name).write_bytes((of / name).read_bytes()[:40])
            with (
                pytest.raises(UsageError, match=r"changed since drivelint|not a receipt|has ended"),
                open_audits(str(out)),
            ):
                raise AssertionError(name)
            shutil.rmtree(out)


class Dying(InThisProcess):
    """An executor that fails before anything is judged."""

    def submit(self, task: object) -> None:
        raise ZeroDivisionError(task)
