"""Finds the reference data beside the checkout; tests that need it skip by name where it is absent."""

from __future__ import annotations

from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
DATA = ROOT.parent / "shared" / "data"


def shared(relative: str) -> Path:
    """Return the path of a reference file, or skip the calling test, naming it."""
    path = DATA / relative
    if not path.exists():
        pytest.skip(f"reference data {relative} is not beside this checkout")
    return path
