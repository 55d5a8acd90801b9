"""No statement about an audit compares all drives, findings or verdicts with all others: an audit may have 100,000 drives."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import pytest

from drivelint.audit.compact import open_database
from drivelint.fleet_report import audit_views
from tests.fleet_report import lake
from tests.fleet_report.command import ran
from tests.sql.explained import Explained, Loop

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


@pytest.mark.ci
@pytest.mark.parametrize(
    "words",
    [("report", "{new}", "--by", "site", "--by", "vehicle"), ("diff", "{base}", "{new}")],
    ids=["report", "diff"],
)
def test_no_statement_compares_all_rows_with_all(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...]
) -> None:
    folders = {
        "base": lake.write(tmp_path / "base", 400).folder,
        "new": lake.write(tmp_path / "new", 400, seed=1).folder,
    }
    found: list[Loop] = []
    looked_at: list[str] = []

    @contextmanager
    def explained() -> Iterator[Any]:
        with open_database() as con:
            yield Explained(con, found, looked_at)

    monkeypatch.setattr(audit_views, "open_database", explained)
    assert ran(*(word.format(**folders) for word in words)).code in {0, 1, 3}
    assert found == []
    assert len(looked_at) > 20
