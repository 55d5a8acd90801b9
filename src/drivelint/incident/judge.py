"""Judges one drive again with one ego, by the rules of a result, and collects the ego's steps."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import msgspec

from drivelint import catalogue
from drivelint.engine.memory import DEFAULT_MEMORY_BYTES, MemoryLimit
from drivelint.engine.profiles import load_profiles, profile_table
from drivelint.engine.session import JudgingSession
from drivelint.errors import UsageError
from drivelint.result import collect
from drivelint.sql import store
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Sequence

    import duckdb
    import pyarrow as pa

    from drivelint.catalogue import Rule
    from drivelint.engine.batch import Drive
    from drivelint.engine.robustness.copies import MeasurementErrors
    from drivelint.result.request import RunRequest
    from drivelint.result.text import Row

_MARGIN_TOLERANCE: Final = 1e-6


@dataclass(frozen=True)
class EgoRows:
    """The rows of `verdict` and `finding` of one ego, and the rows of `queries/incident/step.sql`."""

    verdicts: Sequence[Row]
    findings: Sequence[Row]
    steps: pa.Table


@dataclass(frozen=True)
class Judge:
    """The rules of a result with the parameters and profiles of its run."""

    rules: Sequence[Rule]
    params: dict[str, dict[str, Any]]
    profiles: pa.Table
    memory: int | None = DEFAULT_MEMORY_BYTES

    @classmethod
    def of_run(cls, run_options: RunRequest, rules_of_run: pa.Table, memory: int | None) -> Judge:
        """Return a judge with the rules in `rules_of_run`, rows of the run's table `rule`.

        Errors: `UsageError` for a rule that is not in the catalogue.
        """
        known_rules = catalogue.load_rules(run_options.rules_dirs)
        is_named = {row["rule_id"]: row["is_named"] for row in rules_of_run.to_pylist()}
        if missing_ids := sorted(is_named.keys() - known_rules.keys()):
            raise UsageError(f"rule {missing_ids[0]} is not in the catalogue any more: check the drives again")
        rules = [
            msgspec.structs.replace(known_rules[rule_id], is_named=is_named[rule_id]) for rule_id in sorted(is_named)
        ]
        own_params = [
            param for param in run_options.params if param.partition("=")[0].strip().rpartition(".")[0] in is_named
        ]
        profiles = profile_table(load_profiles(run_options.rules_dirs), run_options.profiles)
        return cls(rules, catalogue.parse_params(rules, own_params), profiles, memory)

    def judge(
        self, drive: Drive, ego_id: str, object_id: str | None, errors: MeasurementErrors | None = None
    ) -> EgoRows:
        """Judge a drive with one ego. `errors`: the assumed errors of the copies that show how sure findings are; None: no copies."""
        steps: list[pa.Table] = []

        def read_ego_steps(con: duckdb.DuckDBPyConnection, _drives: Sequence[Drive], /, **_part: bool) -> None:
            values = {"ego_id": ego_id, "object_id": object_id}
            steps.append(con.execute(statement("incident/step"), values).to_arrow_table())

        with store.temporary_database(self.memory) as con:
            store.insert(con, "profile", self.profiles)
            memory = MemoryLimit(con, self.memory)
            session = JudgingSession(
                con, self.rules, self.params, None, observers=[read_ego_steps], memory=memory, errors=errors
            )
            session.judge([drive])
            session.judge_copies()
            session.close()
            verdicts, findings = (memory.run_job(job).to_pylist() for job in (collect.verdicts, collect.findings))
        return EgoRows(verdicts, findings, steps[-1])


def matching_finding(findings: Sequence[Row], finding: Row) -> Row | None:
    """Return the finding with the same ego, rule, profile, object, worst step and margin as `finding`; None if there is none."""
    same = ("ego_id", "rule_id", "profile", "object_id", "t_worst_ns")
    for row in findings:
        if all(row[key] == finding[key] for key in same) and _are_margins_close(row["margin"], finding["margin"]):
            return row
    return None


def _are_margins_close(a: float | None, b: float | None) -> bool:
    return a == b if a is None or b is None else abs(a - b) <= _MARGIN_TOLERANCE
