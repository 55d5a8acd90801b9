"""A result folder is replaced as one, and holds a whole result or none; what drivelint did not write is never touched."""

from __future__ import annotations

import json
from contextlib import suppress
from pathlib import Path

import pytest

from drivelint.errors import TraceError, UsageError
from drivelint.report.outputs import working_folder, write
from drivelint.result import folder
from drivelint.result.load import load_result
from drivelint.result.names import MANIFEST
from drivelint.result.publishing import OutputError
from tests.report.synthetic import drive, result, verdict

pytestmark = pytest.mark.ci


def write_run(out: Path, *drives: str, overwrite: bool = False, **grown: bytes) -> None:
    """Write what a run of these drives would, each with its annotated log; `grown`: other files that grew during the run."""
    with working_folder(out, overwrite=overwrite) as work:
        assert work is not None
        (work / "annotated").mkdir()
        for name in drives:
            (work / "annotated" / f"{name}.mcap").write_bytes(b"log")
        for name, content in grown.items():
            (work / name.replace("_", ".")).write_bytes(content)
        run = result([verdict("pass", drive_id=name) for name in drives], drives=[drive(name) for name in drives])
        write(run, out, work, overwrite=overwrite)


def names(out: Path) -> set[str]:
    return {path.relative_to(out).as_posix() for path in out.rglob("*") if path.is_file()}


def test_what_an_earlier_run_wrote_and_this_one_does_not_goes(tmp_path: Path) -> None:
    write_run(tmp_path, "a", "b", drivelint_duckdb=b"tables")
    folder.add_file(tmp_path, "report.md", b"of the first run")
    assert {"annotated/a.mcap", "annotated/b.mcap", "drivelint.duckdb", "report.md"} <= names(tmp_path)
    write_run(tmp_path, "b")
    assert not names(tmp_path) & {"annotated/a.mcap", "drivelint.duckdb", "report.md"}
    assert "annotated/b.mcap" in names(tmp_path)
    written = json.loads((tmp_path / MANIFEST).read_text(encoding="utf-8"))["written_by_drivelint"]
    assert {*written, MANIFEST} == names(tmp_path)


def test_foreign_files_stay_whatever_their_folder_is(tmp_path: Path) -> None:
    write_run(tmp_path, "a")
    (tmp_path / "notes.txt").write_text("mine")
    (tmp_path / "annotated" / "notes.txt").write_text("mine")
    with working_folder(tmp_path) as work:
        write(result([verdict("pass")]), tmp_path, work)
    assert {"notes.txt", "annotated/notes.txt"} <= names(tmp_path)
    assert "annotated/a.mcap" not in names(tmp_path)


@pytest.mark.parametrize("name", ["report.html", "annotated/mine.mcap", "files.json"])
def test_a_foreign_file_of_such_a_name_is_not_overwritten_unasked(tmp_path: Path, name: str) -> None:
    (tmp_path / name).parent.mkdir(exist_ok=True)
    (tmp_path / name).write_text("mine")
    if name == MANIFEST:
        (tmp_path / "summary.json").write_text("mine")
    with pytest.raises(UsageError, match="--overwrite"):
        write_run(tmp_path, "a")
    assert (tmp_path / name).read_text() == "mine"
    write_run(tmp_path, "a", overwrite=True)
    assert "annotated/mine.mcap" not in names(tmp_path)
    assert load_result(tmp_path).drives["drive_id"].to_pylist() == ["a"]


def test_a_list_of_files_elsewhere_removes_nothing(tmp_path: Path) -> None:
    out, other = tmp_path / "out", tmp_path / "other.mcap"
    write_run(out, "a")
    other.write_text("mine")
    said = {"written_by_drivelint": ["../other.mcap", "annotated/../../other.mcap", str(other), *names(out)]}
    (out / MANIFEST).write_text(json.dumps(said))
    write_run(out, "b")
    assert other.read_text() == "mine"


REPORTS = {"report.html", "junit.xml", "report.md"}


def interrupted(out: Path) -> None:
    with suppress(KeyboardInterrupt), working_folder(out) as work:
        assert work is not None
        assert not names(out) & REPORTS, "a run that is killed must leave no older report"
        (work / "drivelint.duckdb").write_bytes(b"half")
        raise KeyboardInterrupt


def test_an_earlier_result_is_whole_elsewhere_after_a_run_that_ends_early(tmp_path: Path) -> None:
    write_run(tmp_path, "a")
    folder.add_file(tmp_path, "report.md", b"of the first run")
    (tmp_path / "notes.txt").write_text("mine")
    before = {name: (tmp_path / name).read_bytes() for name in names(tmp_path) - REPORTS - {"notes.txt"}}
    interrupted(tmp_path)
    assert names(tmp_path) == {"notes.txt", *(f"{folder.EARLIER_RESULT_FOLDER}/{name}" for name in before)}
    earlier = tmp_path / folder.EARLIER_RESULT_FOLDER
    assert {name: (earlier / name).read_bytes() for name in names(earlier)} == before
    assert load_result(earlier).drives["drive_id"].to_pylist() == ["a"]
    interrupted(tmp_path)  # once more: the last result stays
    assert load_result(earlier).drives["drive_id"].to_pylist() == ["a"]
    write_run(tmp_path, "b")
    interrupted(tmp_path)
    assert load_result(earlier).drives["drive_id"].to_pylist() == ["b"]
    (earlier / "notes.txt").write_text("mine")
    write_run(tmp_path, "c")
    assert {name for name in names(tmp_path) if name.startswith(folder.EARLIER_RESULT_FOLDER)} == {
        f"{folder.EARLIER_RESULT_FOLDER}/notes.txt"
    }


def test_a_result_that_the_failed_run_wrote_itself_stays(tmp_path: Path) -> None:
    write_run(tmp_path, "a")
    with suppress(TraceError), working_folder(tmp_path) as work:
        write(result([verdict("pass", drive_id="b")], drives=[drive("b")]), tmp_path, work)
        raise TraceError("no drive could be judged")
    assert load_result(tmp_path).drives["drive_id"].to_pylist() == ["b"]
    assert not (tmp_path / folder.EARLIER_RESULT_FOLDER).exists()


def test_what_a_killed_run_left_goes_with_the_next(tmp_path: Path) -> None:
    (tmp_path / ".drivelint.work.1").mkdir()
    (tmp_path / ".drivelint.work.1" / "drivelint.duckdb").write_bytes(b"half")
    write_run(tmp_path, "a")
    assert not [name for name in names(tmp_path) if name.startswith(".")]


def test_a_result_that_a_killed_run_was_to_replace_is_not_read(tmp_path: Path) -> None:
    write_run(tmp_path, "a")
    left = tmp_path / ".drivelint.work.1"
    left.mkdir()
    with pytest.raises(UsageError, match="of an earlier run") as refused:
        load_result(tmp_path)
    assert str(left) in str(refused.value)
    write_run(tmp_path, "b")
    assert load_result(tmp_path).drives["drive_id"].to_pylist() == ["b"]


def test_while_a_run_goes_on_the_result_before_it_can_be_read(tmp_path: Path) -> None:
    write_run(tmp_path, "a")
    with working_folder(tmp_path):
        assert load_result(tmp_path).drives["drive_id"].to_pylist() == ["a"]


def test_two_runs_at_a_time_into_one_folder_are_refused(tmp_path: Path) -> None:
    with working_folder(tmp_path) as work:
        assert work is not None
        (work / "drivelint.duckdb").write_bytes(b"half")
        with pytest.raises(UsageError, match="another check is writing there"):
            write_run(tmp_path, "a")
        assert (work / "drivelint.duckdb").read_bytes() == b"half"
    write_run(tmp_path, "a")


@pytest.mark.parametrize("n", range(1, 60, 4))
def test_a_machine_that_fails_while_files_are_replaced_leaves_no_half_result(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, n: int
) -> None:
    """After any number of renames: the old result, the new one, or what is refused; and the next run makes it whole."""
    write_run(tmp_path, "a", "b")
    done: list[Path] = []
    rename = Path.replace

    def failing(self: Path, target: Path) -> Path:
        done.append(target)
        if len(done) == n:
            raise OSError(5, "Input/output error")
        return rename(self, target)

    monkeypatch.setattr(Path, "replace", failing)
    with suppress(OutputError):
        write_run(tmp_path, "c")
    monkeypatch.setattr(Path, "replace", rename)
    if (tmp_path / "summary.json").exists():
        assert load_result(tmp_path).drives["drive_id"].to_pylist() in (["a", "b"], ["c"])
    else:
        with pytest.raises(UsageError, match=r"summary\.json is missing"):
            load_result(tmp_path)
    write_run(tmp_path, "d")
    assert {name for name in names(tmp_path) if name.startswith("annotated")} == {"annotated/d.mcap"}


def test_an_annotated_log_of_a_drive_without_verdicts_is_not_kept(tmp_path: Path) -> None:
    with working_folder(tmp_path) as work:
        assert work is not None
        (work / "annotated").mkdir()
        (work / "annotated" / "lost.mcap").write_bytes(b"log")
        lost = drive("lost", status="not_judged", status_reason="interrupted")
        write(result([verdict("pass")], drives=[drive(), lost]), tmp_path, work)
    assert "annotated/lost.mcap" not in names(tmp_path)
