"""A log that changes while it is read: no verdict is about bytes that nobody hashed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

import drivelint
from drivelint.formats import files, registry
from tests.faults import drives

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.drive.trace import Identity


@pytest.mark.parametrize("name", ["osi-mcap", "osi-file", "canonical", "bag"])
def test_a_log_that_changes_between_hash_and_reading(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    log = drives.WRITERS[name](tmp_path / "bad", drives.drive())
    good = drives.osi_mcap(tmp_path / "good", drives.drive(drives.N + 1))
    file = next(path for path in (log / "b.mcap", log / "actor_state.parquet", log) if path.is_file())
    identify = files.identify

    def identify_then_change(path: Path) -> Identity:
        found = identify(path)
        if path == log:
            file.write_bytes(file.read_bytes())
        return found

    monkeypatch.setattr(registry, "identify", identify_then_change)
    result = drivelint.check([log, good], rules="ukhc.no-collision", ego="0", annotate=False, robustness=False)
    reasons = {row["file_name"]: row["status_reason"] for row in result.drives.arrow().to_pylist()}
    assert (result.exit_code, reasons["good.mcap"]) == (4, None)
    assert reasons[log.name].endswith("the log changed while it was read: check it again when it is complete")
