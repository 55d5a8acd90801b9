"""Which files a command line means, and what a drive is called."""

from __future__ import annotations

from pathlib import Path

import pytest

from drivelint.errors import TraceError, UsageError
from drivelint.ingest import expand
from drivelint.report.contract import FILES
from tests.ingest.logs import cars, mapping, read, table


def names(paths: list[Path]) -> list[str]:
    return [path.name for path in paths]


def test_files_globs_and_folders(tmp_path: Path) -> None:
    for name in ("b.csv", "a.mcap", "c.parquet", "notes.txt"):
        (tmp_path / name).write_text("x")
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "d.CSV").write_text("x")
    (tmp_path / "sub" / "e.osi").write_text("x")
    assert names(expand([str(tmp_path)])) == ["a.mcap", "b.csv", "c.parquet", "d.CSV", "e.osi"]
    assert names(expand([str(tmp_path / "*.csv")])) == ["b.csv"]
    assert names(expand([str(tmp_path / "**" / "*.csv"), str(tmp_path / "c.parquet")])) == ["b.csv", "c.parquet"]


def test_what_an_earlier_check_wrote_is_not_searched(tmp_path: Path) -> None:
    """Whoever keeps results beside the logs and checks the folder again must not judge the results."""
    written = [f"{name}.parquet" for name in FILES] + ["margins.parquet", "summary.json", "annotated/a.mcap"]
    for out in (tmp_path, tmp_path / "out"):
        for name in [*written, "a.mcap"]:
            (out / name).parent.mkdir(parents=True, exist_ok=True)
            (out / name).write_text("x")
    (tmp_path / "annotated" / "sub").mkdir()
    (tmp_path / "annotated" / "sub" / "b.mcap").write_text("x")
    found = [tmp_path / "a.mcap", tmp_path / "annotated" / "sub" / "b.mcap", tmp_path / "out" / "a.mcap"]
    assert expand([str(tmp_path)]) == found
    assert expand([str(tmp_path / "annotated" / "a.mcap")]) == [tmp_path / "annotated" / "a.mcap"]
    assert names(expand([str(tmp_path / "annotated")])) == ["a.mcap", "b.mcap"]
    (tmp_path / "summary.json").unlink()
    assert tmp_path / "verdicts.parquet" in expand([str(tmp_path)])


def test_a_folder_that_goes_while_it_is_searched(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def gone(folder: Path, pattern: str) -> list[Path]:
        raise FileNotFoundError(2, "No such file or directory", str(folder / "sub"))

    monkeypatch.setattr(Path, "rglob", gone)
    with pytest.raises(TraceError, match=r"cannot be searched: .*sub: No such file"):
        expand([str(tmp_path)])


def test_each_file_once_in_one_order(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("b.csv", "a.csv"):
        (tmp_path / name).write_text("x")
    (tmp_path / "link.csv").symlink_to(tmp_path / "a.csv")
    monkeypatch.chdir(tmp_path)
    forward = expand(["b.csv", "a.csv", "./a.csv", str(tmp_path / "b.csv")])
    assert names(forward) == ["a.csv", "b.csv"]
    assert len(expand(["link.csv", "a.csv"])) == 1
    assert [p.resolve() for p in expand(["a.csv", "b.csv"])] == [p.resolve() for p in forward]


@pytest.mark.parametrize("name", ["d[1].csv", "d*.csv", "d?.csv", "x=9.csv", "new\nline.csv"])
def test_an_existing_name_is_taken_literally(tmp_path: Path, name: str) -> None:
    for other in (name, "d1.csv"):
        (tmp_path / other).write_text("x")
    assert names(expand([str(tmp_path / name)])) == [name]


def test_a_canonical_folder_is_one_drive(tmp_path: Path) -> None:
    drive = tmp_path / "all" / "drive"
    drive.mkdir(parents=True)
    for name in ("actor_state.parquet", "actor.parquet"):
        (drive / name).write_text("x")
    assert expand([str(drive)]) == [drive]
    assert expand([str(tmp_path / "all")]) == [drive]
    assert expand([str(tmp_path / "*")]) == [drive]


@pytest.mark.parametrize(
    ("text", "kind", "message"),
    [
        ("missing.csv", TraceError, r"missing\.csv: no such file or folder"),
        ("none*.csv", TraceError, r"none\*.csv: no file matches this pattern"),
        (" ", UsageError, "an empty trace name"),
        ("s3://bucket/drive.mcap", UsageError, "URIs cannot be read yet"),
        ("x" * 5000, TraceError, "no such file"),
    ],
)
def test_what_matches_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, text: str, kind: type, message: str
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(kind, match=message):
        expand([text])


def test_a_folder_without_traces(tmp_path: Path) -> None:
    with pytest.raises(TraceError, match="no trace in this folder"):
        expand([str(tmp_path)])


def test_a_drive_is_called_by_stem_and_content(tmp_path: Path) -> None:
    (tmp_path / "sub").mkdir()
    spec = mapping(tmp_path)
    first = read(table(tmp_path / "drive.csv", cars()), mapping=spec)
    moved = read(table(tmp_path / "sub" / "drive.csv", cars()), mapping=spec)
    changed = read(table(tmp_path / "sub" / "drive.csv", cars(21)), mapping=spec)
    assert first.drive_id == moved.drive_id != changed.drive_id
    stem, digest = first.drive_id.rsplit("-", 1)
    row = first.tables["data_log"].to_pylist()[0]
    assert (stem, row["file_name"]) == ("drive", "drive.csv")
    assert row["sha256"].startswith(digest)
    assert len(digest) == 8


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.mcap", b"", r"the file is empty \(0 bytes\)"),
        ("a.mcap", b"<!DOCTYPE html><html>not found", r"not mcap: .*begins b'<!DOCTYPE html>.*at byte 0"),
        ("a.parquet", b"PAR2....", "not parquet"),
        ("a.parquet", b"PAR1 and nothing", "not readable as Parquet"),
        ("a.osi", b"\x10\0\0\0", "not an OSI trace"),
        ("a.csv", b"<html></html>", "no reader for this file"),
        ("a.bag", b"#ROSBAG V2.0\n\0\0", "no reader for this file, which begins with b'#ROSBAG"),
    ],
)
def test_files_that_are_no_trace(tmp_path: Path, name: str, content: bytes, message: str) -> None:
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(TraceError, match=message) as error:
        read(path)
    assert str(error.value).startswith(f"{path}: ")
    assert "\n" not in str(error.value)


def test_a_file_that_went_away(tmp_path: Path) -> None:
    with pytest.raises(TraceError, match="no such file"):
        read(tmp_path / "a.csv")


def test_a_folder_that_is_no_drive(tmp_path: Path) -> None:
    with pytest.raises(TraceError, match=r"without actor_state\.parquet is not a drive"):
        read(tmp_path)
