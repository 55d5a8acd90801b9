"""Limits of rules that report progress. This is a separate module so that printing an earlier result does not import the database."""

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


class ReportingRuleLimits(RuleLimits):
    """Limits of rules that also report to the user how many rules a batch has been judged by."""

    def __init__(self, progress: Progress, n_rules: int, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self._progress, self._n_rules, self._n_drives = progress, n_rules, 0
        self._begun: set[str] = set()

    def begin_batch(self, n_drives: int) -> None:
        """Report that judging a batch of `n_drives` drives begins, with the derivation of tables."""
        self._n_drives = n_drives
        self._begun.clear()
        self._progress.doing(f"judging {plural(n_drives, 'drive')}: deriving tables")

    @contextmanager
    def limit_statements(self, con: duckdb.DuckDBPyConnection, rule_id: str, *, alone: bool) -> Iterator[RunningRule]:
        """Report the rule, then do as `RuleLimits.limit_statements`."""
        self._begun.add(rule_id)
        n = len(self._begun)
        activity = f"judging {plural(self._n_drives, 'drive')}: rule {n} of {self._n_rules}"
        self._progress.doing(activity, self._n_drives * n / (self._n_rules + 1))
        with super().limit_statements(con, rule_id, alone=alone) as running_rule:
            yield running_rule
