"""Reports by how many rules a batch was judged. This is a module of its own, so that printing an earlier result loads no database."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from drivelint.evaluate.limits import RuleLimits
from drivelint.phrases import plural

if TYPE_CHECKING:
    from collections.abc import Iterator

    import duckdb

    from drivelint.evaluate.limits import RunningRule
    from drivelint.report.progress import Progress


class ToldLimits(RuleLimits):
    """Limits of rules that also report by how many rules a batch was judged, so that a person sees the progress."""

    def __init__(self, progress: Progress, n_rules: int, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self._progress, self._n_rules, self._n_drives = progress, n_rules, 0
        self._begun: set[str] = set()

    def begin(self, n_drives: int) -> None:
        """Report that a batch of so many drives is judged; at first, tables are derived."""
        self._n_drives = n_drives
        self._begun.clear()
        self._progress.doing(f"judging {plural(n_drives, 'drive')}: deriving tables")

    @contextmanager
    def hold(self, con: duckdb.DuckDBPyConnection, rule_id: str, *, alone: bool) -> Iterator[RunningRule]:
        """See `RuleLimits.hold`."""
        self._begun.add(rule_id)
        n = len(self._begun)
        what = f"judging {plural(self._n_drives, 'drive')}: rule {n} of {self._n_rules}"
        self._progress.doing(what, self._n_drives * n / (self._n_rules + 1))
        with super().hold(con, rule_id, alone=alone) as held:
            yield held
