"""What is wrong with the file of a library table is told with the file and what to write."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from drivelint.errors import DriveLintError
from drivelint.sql import library

if TYPE_CHECKING:
    from pathlib import Path

FILE = """-- The steps at which the ego stands.
-- lifetime: part
CREATE TABLE standing (
    drive_id VARCHAR NOT NULL,        -- the drive
    t_ns BIGINT NOT NULL              -- the step
);

INSERT INTO standing BY NAME
SELECT drive_id, t_ns FROM ego_state WHERE speed_mps < 0.1
"""


def _parts(missing_part: str) -> str:
    return (
        "write a comment, `-- lifetime: part`, `CREATE TABLE standing (`, `);`, an empty line, "
        f"`INSERT INTO standing BY NAME` and a SELECT; the first that is missing, or not in its place: {missing_part}"
    )


def read(folder: Path, monkeypatch: pytest.MonkeyPatch, change: tuple[str, str]) -> library.LibraryTable:
    """Read a library that has this one file, with a change of its text."""
    (folder / "library" / "motion").mkdir(parents=True)
    (folder / "library" / "motion" / "standing.sql").write_text(FILE.replace(*change), encoding="utf-8")
    monkeypatch.setattr(library, "folder", lambda _: folder)
    library.library_tables.cache_clear()
    try:
        return library.library_tables()["standing"]
    finally:
        library.library_tables.cache_clear()


def test_the_parts_of_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    table = read(tmp_path, monkeypatch, ("", ""))
    assert (table.topic, table.description) == ("motion", "The steps at which the ego stands.")
    assert table.declaration.startswith("-- lifetime: part\nCREATE TABLE standing (\n")
    assert table.select.startswith("SELECT drive_id, t_ns FROM ego_state")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("-- The steps at which the ego stands.\n", ""), _parts("a comment")),
        (("-- lifetime: part\n", ""), _parts("`-- lifetime: part`")),
        (("CREATE TABLE standing", "CREATE TABLE stands"), _parts("`CREATE TABLE standing (`")),
        ((");\n", ")\n"), _parts("`);`")),
        ((");\n\n", ");\n"), _parts("an empty line")),
        (("INSERT INTO standing", "INSERT INTO stands"), _parts("`INSERT INTO standing BY NAME`")),
        ((FILE[FILE.index("SELECT") :], ""), _parts("a SELECT")),
        (("lifetime: part", "lifetime: step"), "lifetime 'step' is none of the library: known are part, map, run; "),
        (("lifetime: part", "lifetime: drive"), "lifetime 'drive' is none of the library: known are part, map, run; "),
        (("        -- the drive", ""), "column drive_id has no comment: write `-- ` and what it is after it"),
        (("              -- the step", ""), "column t_ns has no comment: "),
        (
            ("-- the step", "-- the step {speed}"),
            "column t_ns: 'speed' is no quantity of an actor: known are position, ",
        ),
        (("-- the step", "-- the step {size,class}"), "column t_ns: 'size,class' is no quantity of an actor: "),
    ],
)
def test_what_is_missing_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, change: tuple[str, str], message: str
) -> None:
    with pytest.raises(DriveLintError) as refused:
        read(tmp_path, monkeypatch, change)
    assert str(refused.value).startswith(f"{tmp_path / 'library' / 'motion' / 'standing.sql'}: {message}")
