"""Outputs: tables, summaries and reports made of one `Result`; one module per target."""

from __future__ import annotations

from typing import Final

NARROW_WIDTH: Final = 96
"""Characters of a terminal below which findings take two lines each, and columns that only repeat are left out."""
