"""A log that changes while it is read: no verdict is about bytes that nobody hashed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import drivelint
from drivelint.formats import files, registry
from tests.faults import drives

if TYPE_CHECKING:
    from pathlib import Path

    import pytest

    from drivelint.drive.trace import Identity


def test_a_log_that_changes_between_hash_and_reading(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    logs = [
        drives.WRITERS[name](tmp_path / name, drives.drive()) for name in ("osi-mcap", "osi-file", "canonical", "bag")
    ]
    good = drives.osi_mcap(tmp_path / "good", drives.drive(drives.N + 1))
    identify = files.identify

    def identify_then_change(path: Path) -> Identity:
        found = identify(path)
        if path != good:
            file = next(each for each in (path / "b.mcap", path / "actor_state.parquet", path) if each.is_file())
            file.write_bytes(file.read_bytes())
        return found

    monkeypatch.setattr(registry, "identify", identify_then_change)
    result = drivelint.check([*logs, good], rules="ukhc.no-collision", ego="0", annotate=False, robustness=False)
    reasons = {row["file_name"]: row["status_reason"] for row in result.drives.arrow().to_pylist()}
    assert (result.exit_code, reasons.pop("good.mcap")) == (4, None)
    assert reasons.keys() == {log.name for log in logs}
    for reason in reasons.values():
        assert reason.endswith("the log changed while it was read: check it again when it is complete")
