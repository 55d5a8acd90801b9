"""Result files: complete or absent, the same bytes for the same rows."""

from __future__ import annotations

from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from drivelint.errors import ExitCode, UsageError
from drivelint.report.outputs import write
from drivelint.result import publishing
from drivelint.result.files import parquet_bytes
from drivelint.result.load import load_result
from drivelint.result.names import TABLE_OF_FILE
from drivelint.result.publishing import OutputError, publish
from drivelint.result.schemas import OUTPUT_VERSION
from tests.report.synthetic import finding, result, table, verdict

NAMES = {f"{name}.parquet" for name in TABLE_OF_FILE} | {"report.html", "summary.json", "junit.xml", "files.json"}


def rows(n: int) -> pa.Table:
    return table("verdict", [verdict("pass", occurrence=k, margin=k / 7) for k in range(n)])


def test_chunks_and_foreign_metadata_do_not_show_in_the_bytes() -> None:
    whole = rows(300)
    pieces = pa.concat_tables([whole.slice(0, 7), whole.slice(7, 200), whole.slice(207)])
    large = whole.set_column(2, "rule_id", whole["rule_id"].cast(pa.large_string()))
    expected = parquet_bytes(whole, "verdict")
    assert parquet_bytes(pieces, "verdict") == expected
    assert parquet_bytes(large.replace_schema_metadata({"pandas": "{}"}), "verdict") == expected
    assert parquet_bytes(whole.slice(1), "verdict") != expected


def test_what_is_written_is_what_is_read() -> None:
    read = pq.read_table(pa.BufferReader(parquet_bytes(rows(5), "verdict")))
    assert read.to_pylist() == rows(5).to_pylist()


@pytest.mark.parametrize("name", sorted(TABLE_OF_FILE.values()))
def test_every_column_carries_its_description(name: str) -> None:
    schema = pq.read_schema(pa.BufferReader(parquet_bytes(table(name, []), name)))
    assert all(field.metadata[b"comment"] for field in schema)
    assert schema.metadata[b"drivelint.output_schema"] == str(OUTPUT_VERSION).encode()


def test_a_result_writes_every_file_and_nothing_else(tmp_path: Path) -> None:
    run = result([verdict("fail")], [finding()])
    write(run, tmp_path / "a" / "deep")
    write(run, tmp_path / "b")
    assert {path.name for path in (tmp_path / "b").iterdir()} == NAMES
    for name in NAMES:
        assert (tmp_path / "a" / "deep" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


def test_margins_are_taken_over_and_an_earlier_runs_go(tmp_path: Path) -> None:
    finished = tmp_path / "work.parquet"
    finished.write_bytes(b"margins")
    write(result([verdict("pass")], margins_file=finished), tmp_path / "out")
    assert (tmp_path / "out" / "margins.parquet").read_bytes() == b"margins"
    assert not finished.exists()
    write(result([verdict("pass")]), tmp_path / "out")
    assert not (tmp_path / "out" / "margins.parquet").exists()


def test_a_folder_that_cannot_be_written_is_one_clear_error(tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("a file")
    with pytest.raises(OutputError, match=r"taken.*cannot write") as caught:
        write(result([verdict("pass")]), tmp_path / "taken")
    assert caught.value.exit_code is ExitCode.TEMPFAIL


def test_a_full_disk_leaves_the_earlier_results_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    publish(tmp_path, {"one": b"old", "two": b"old"}, {})
    synced: list[Path] = []

    def disk_full_at_the_second(path: Path) -> None:
        synced.append(path)
        if len(synced) == 2:
            raise OSError(28, "No space left on device")

    monkeypatch.setattr(publishing, "_sync_to_disk", disk_full_at_the_second)
    with pytest.raises(OutputError, match="No space left"):
        publish(tmp_path, {"one": b"new", "two": b"new"}, {})
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == {"one": b"old", "two": b"old"}


def test_a_folder_of_other_columns_says_what_to_do(tmp_path: Path) -> None:
    write(result([verdict("fail")], [finding()]), tmp_path)
    file = tmp_path / "courses.parquet"
    pq.write_table(pq.read_table(file).drop_columns(["occurrence"]), file)
    with pytest.raises(UsageError, match=r"occurrence.*check the drives again"):
        load_result(tmp_path)


def test_no_thread_of_arrow_holds_a_file_of_python(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """If one does while the interpreter ends, as after an error, the process aborts with exit code 134."""
    write(result([verdict("fail")], [finding()]), tmp_path)
    read, given = pq.read_table, set()

    def noted(source: object, **options: bool) -> pa.Table:
        given.add(type(source))
        return read(source, **options)

    monkeypatch.setattr(pq, "read_table", noted)
    load_result(tmp_path)
    assert given == {pa.BufferReader}
