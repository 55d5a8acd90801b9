"""Computes the coverage of a fleet: which rules were decided, and which situations occurred."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from drivelint.fleet.distinct_logs import counted_egos_sql
from drivelint.fleet.situations import SITUATIONS, UNAVAILABLE_SITUATIONS, parameters_of_tag, situation_sql
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Mapping

    import duckdb

STANDINGS: Final = ("decided", "never_decided", "never_triggered", "never_in_force", "not_run")
"""The possible results of a rule in a fleet. never_decided: it applied, or may have applied, but was always unknown. never_triggered: its
occasion never occurred. never_in_force: every drive was in another nation, under other conditions, or without the automated driver."""


@dataclass(frozen=True)
class RuleCoverage:
    """The number of drives in which a rule was decided. Several results of the same log count as one drive.

    A drive in which the rule was decided once and unknown once counts as both.
    """

    rule_id: str
    profile: str | None
    standing: str
    drives: int
    drives_decided: int
    drives_failed: int
    drives_unknown: int
    drives_not_triggered: int
    occasions: int


@dataclass(frozen=True)
class SituationCoverage:
    """What happened at one value of a situation, over all rules. `value` None: drives in which the value is not known.

    If a value has no ego, it did not occur in any drive whose value is known. It may have occurred in a drive whose value is not known.
    `km`, `hours`: all driving, including parts that no rule judged. `occasions`: verdicts that passed or failed.
    """

    situation: str
    value: str | None
    egos: int = 0
    km: float = 0.0
    hours: float = 0.0
    occasions: int = 0
    occasions_failed: int = 0
    occasions_unknown: int = 0
    findings: int = 0


@dataclass(frozen=True)
class Coverage:
    """The rules with their results in the fleet; the situations, including those that never occurred; and the questions that the tables
    cannot answer."""

    rules: tuple[RuleCoverage, ...]
    situations: tuple[SituationCoverage, ...]
    cannot_tell: Mapping[str, str]

    def rules_with_standing(self, standing: str) -> list[RuleCoverage]:
        """Return the rules with a standing, one of `STANDINGS`."""
        return [rule for rule in self.rules if rule.standing == standing]

    def never_occurred(self) -> list[SituationCoverage]:
        """Return the situations in which no drive is known to have been. Situations that are not known for any drive are left out."""
        untold = set(self.situations_never_known())
        return [s for s in self.situations if not s.egos and s.value is not None and s.situation not in untold]

    def situations_never_known(self) -> list[str]:
        """Return the names of situations, such as `weather`, whose value is not known for any drive."""
        known_names = {
            situation.situation for situation in self.situations if situation.egos and situation.value is not None
        }
        return sorted({situation.situation for situation in self.situations} - known_names)


def coverage(con: duckdb.DuckDBPyConnection, *, of: str = "") -> Coverage:
    """Return the coverage of the drives. `of`: prefix of the views' names.

    `rates(con, by=SITUATION)` returns failures of single rules by situation.
    """
    parts = {"subject": counted_egos_sql(of)}
    parts["profiled"] = statement("fleet/profiled", of=of)
    rules = con.execute(statement("fleet/rule_coverage", of=of, **parts)).fetchall()
    situations = [
        situation for name, values in SITUATIONS.items() for situation in _situation_coverage(con, of, name, values)
    ]
    return Coverage(tuple(RuleCoverage(*row) for row in rules), tuple(situations), UNAVAILABLE_SITUATIONS)


def _situation_coverage(
    con: duckdb.DuckDBPyConnection, of: str, name: str, values: tuple[str, ...]
) -> list[SituationCoverage]:
    """Return the coverage of each value of a condition. `name`: the condition, such as `weather`; `values`: its values, in order.

    The last row, without a value, counts the drives in which the condition is not known.
    """
    rows: list[tuple[Any, ...]] = con.execute(
        statement("fleet/situation", of=of, subject=counted_egos_sql(of, value=situation_sql(name))),
        parameters_of_tag(name),
    ).fetchall()
    coverage_by_value = {row[0]: SituationCoverage(name, *row) for row in rows}
    order = dict.fromkeys([*values, *(value for value in coverage_by_value if value is not None)])
    coverages = [coverage_by_value.get(value, SituationCoverage(name, value)) for value in order]
    return [*coverages, coverage_by_value[None]] if None in coverage_by_value else coverages
