"""The outputs of a run: tables, summaries and reports of one `Result`, in one module per target."""

from __future__ import annotations

from typing import Final

NARROW_BELOW_COLUMNS: Final = 96
"""In a terminal with fewer columns, a finding takes two lines, and tables omit less important columns."""
