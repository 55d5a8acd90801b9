"""What `audit` prints at its end: how sure contacts are, a touch of two egos once, reasons with their number."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from drivelint.audit.compact import create_views, database
from drivelint.audit.store import LocalFolder
from drivelint.audit.summary import summed
from drivelint.audit.text import summary_text
from drivelint.errors import ExitCode
from tests.audit import fleet
from tests.audit.here import judged

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.audit import AuditSummary


@pytest.fixture
def audited(tmp_path: Path) -> tuple[Path, int]:
    """Return an audit with contacts, and in how many drives."""
    few = fleet.write(tmp_path / "fleet", 12)
    assert len(few.planted) > 1
    judged(few, tmp_path / "out")
    return tmp_path / "out", len(few.planted)


def told(out: Path, *, robust: bool = True) -> tuple[str, AuditSummary]:
    with database() as con:
        create_views(con, LocalFolder(out), out)
        counted = replace(summed(con, 0), robust=robust)
    (line,) = [
        line for line in summary_text(counted, "out", ExitCode.FAILED).splitlines() if line.startswith("findings")
    ]
    return line, counted


def change(out: Path, **columns: object) -> pa.Table:
    """Set columns of the first finding, and let all others stay in 100 of 100 copies."""
    (file,) = (out / "tables" / "findings").iterdir()
    table = pq.read_table(file)
    rows = [row | {"n_copies": 100, "n_stays": 100} for row in table.to_pylist()]
    rows[0] |= columns
    pq.write_table(pa.Table.from_pylist(rows, schema=table.schema), file)
    return table


def test_a_contact_that_is_only_possible_is_not_printed_as_one(audited: tuple[Path, int]) -> None:
    out, n = audited
    change(out, n_stays=30)
    line, _ = told(out)
    assert line == (
        f"findings: {n} critical, 0 major, 0 minor; CONTACT in {n - 1} drive{'s' * (n > 2)}; possible contact in 1 drive; "
        "how sure they are was examined: 1 only possible"
    )


def test_where_nobody_looked_the_line_says_how_to(audited: tuple[Path, int]) -> None:
    out, n = audited
    line, _ = told(out, robust=False)
    assert line.endswith(f"CONTACT in {n} drives; how sure they are was not examined: --robustness")


def test_a_touch_of_two_egos_is_one(audited: tuple[Path, int]) -> None:
    out, n = audited
    (file,) = (out / "tables" / "findings").iterdir()
    table = pq.read_table(file)
    first = table.slice(0, 1).to_pylist()[0]
    other = first | {"ego_id": first["object_id"], "object_id": first["ego_id"], "finding_id": "other"}
    later = other | {"t_start_ns": first["t_end_ns"] + 1, "t_end_ns": first["t_end_ns"] + 2, "finding_id": "later"}
    for added, expected in (([other], n), ([other, later], n + 1)):
        pq.write_table(pa.concat_tables([table, pa.Table.from_pylist(added, schema=table.schema)]), file)
        assert told(out)[1].findings == {"critical": expected}


def test_the_surest_finding_of_a_touch_counts(audited: tuple[Path, int]) -> None:
    out, n = audited
    change(out, n_stays=30)
    (file,) = (out / "tables" / "findings").iterdir()
    table = pq.read_table(file)
    first = table.slice(0, 1).to_pylist()[0]
    other = first | {"ego_id": first["object_id"], "object_id": first["ego_id"], "finding_id": "other", "n_stays": 99}
    pq.write_table(pa.concat_tables([table, pa.Table.from_pylist([other], schema=table.schema)]), file)
    counted = told(out)[1]
    assert (counted.findings, counted.possible, counted.contacts, counted.contacts_possible) == (
        {"critical": n},
        0,
        n,
        0,
    )


def test_one_reason_of_many_drives_is_told_once_with_its_number(tmp_path: Path) -> None:
    few = fleet.write(tmp_path / "fleet", 4)
    text = few.manifest.read_text(encoding="utf-8").splitlines()
    text = [f"{text[0]},map", *(f"{line},nowhere.xodr" for line in text[1:])]
    few.manifest.write_text("\n".join(text) + "\n", encoding="utf-8")
    lines = summary_text(judged(few, tmp_path / "out"), "out", ExitCode.NOT_JUDGED).splitlines()
    assert sum("nowhere.xodr" in line for line in lines) == 1
    assert any(line.startswith("  refused (4 drives): ") for line in lines)


def test_copies_are_told(tmp_path: Path) -> None:
    few = fleet.write(tmp_path / "fleet", 3)
    logs = sorted((tmp_path / "fleet" / "logs").iterdir())
    logs[1].write_bytes(logs[0].read_bytes())
    counted = judged(few, tmp_path / "out")
    assert "3 judged, 1 with the content of another one, counted again" in summary_text(counted, "out", ExitCode.OK)
