"""A window of an MCAP file is read as the same span of the whole file."""

from __future__ import annotations

from pathlib import Path

import pytest

from drivelint.watch.sources.mcap_file import McapFile
from tests.formats.osi import osi_file, osi_log
from tests.shared_data import ROOT, shared
from tests.watch.sources.windows import assert_window_is_span, drained

SCENES = ("safe", "near-miss", "signal-late", "tunnel")


def watched(path: Path) -> tuple[McapFile, list]:  # type: ignore[type-arg]
    source = McapFile(path, idle_s=0.0)
    return source, drained(source)


@pytest.mark.parametrize("name", SCENES)
def test_fixture(tmp_path: Path, name: str) -> None:
    source, frames = watched(ROOT / "fixtures" / "scenes" / f"{name}.mcap")
    n = len(frames)
    for start in (n // 3, n // 2):
        assert_window_is_span(source, frames, tmp_path, slice(start, start + n // 3))
