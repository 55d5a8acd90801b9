"""Finds contacts in the newest frames, so that a contact is an alarm long before its window is judged.

The frames are read like a window, and the macro of the rules gives the distance of the boxes. A contact is only reported if the actor was
seen apart from the ego before. Another actor may be the ego's trailer, or the ego under a second id: only the window can decide this.
The window with the step of the contact confirms the alarm or withdraws it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.evaluate.sql_fragments import Binding
from drivelint.sql import store
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Mapping

    import duckdb

    from drivelint.catalogue import Rule
    from drivelint.drive.trace import Trace
    from drivelint.result.text import Row

OVERLAP_RULE: Final = "ukhc.no-collision"
JOLT_RULE: Final = "ukhc.contact-signature"
CONTACT_RULES: Final = (OVERLAP_RULE, JOLT_RULE)
"""The rules on contacts, whose alarms can come before a window is judged."""
LEAST_EXAMINED_LOG_SPAN_NS: Final = 1_000_000_000
"""The least length of log that is examined: readers derive values from earlier steps, and boxes must be seen apart before a contact."""
MOST_EXAMINED_DISTANCE_M: Final = 50.0
"""Actors whose centres are farther apart than this along x or y are not examined."""
_JOLT_PARAMS: Final = ("within_m", "tyre_mps2", "jolt_s", "walk_mps")
_UNKNOWN_COLUMNS: Final = ("profile", "t_ref_ns", "lon", "lat", "lanelet_id", "closing_mps")


class ContactFinder:
    """Finds contacts in the newest frames of a log. Memory: the actors that are near an ego.

    `con`: a database with the macros, used by this thread alone. `rules_by_id`: the catalogue's rules. `rule_ids`: the examined rules, a
    part of `CONTACT_RULES`. `params`: rule id -> given parameters.
    """

    def __init__(
        self,
        con: duckdb.DuckDBPyConnection,
        rules_by_id: Mapping[str, Rule],
        rule_ids: tuple[str, ...] = CONTACT_RULES,
        params: Mapping[str, Mapping[str, object]] | None = None,
    ) -> None:
        self._con = con
        self._rules = {rule_id: rules_by_id[rule_id] for rule_id in rule_ids}
        bound = Binding(rules_by_id[JOLT_RULE], 0, (params or {}).get(JOLT_RULE, {}))
        self._values = {"near_m": MOST_EXAMINED_DISTANCE_M, **bound.values(_JOLT_PARAMS)}
        self._statement = statement("watch/contact")
        self._apart: set[tuple[str, str, str]] = set()

    def new_contacts(self, trace: Trace, since_ns: int | None) -> list[Row]:
        """Return the contacts at the steps after `since_ns` (None: at all steps), each as a row of `finding` that lasts one step.

        `trace`: the newest steps and about `LEAST_EXAMINED_LOG_SPAN_NS` before them.
        """
        tables = {f"_{name}": trace.tables[table] for name, table in _TRACE_TABLES.items()}
        with store.registered(self._con, tables):
            pairs = self._con.execute(self._statement, self._values).to_arrow_table().to_pylist()
        self._apart &= {_rule_ego_and_object(pair) for pair in pairs}
        self._apart |= {_rule_ego_and_object(pair) for pair in pairs if pair["is_apart"]}
        return [
            _finding_row(self._rules[pair["rule_id"]], pair, step)
            for pair in pairs
            if pair["rule_id"] in self._rules and _rule_ego_and_object(pair) in self._apart
            for step in pair["steps"] or ()
            if since_ns is None or step["t_ns"] > since_ns
        ]


_TRACE_TABLES: Final = {"state": "actor_state", "actor": "actor", "quality": "quality"}


def _rule_ego_and_object(pair: Row) -> tuple[str, str, str]:
    return pair["rule_id"], pair["ego_id"], pair["object_id"]


def _finding_row(rule: Rule, pair: Row, step: Row) -> Row:
    if rule.id == OVERLAP_RULE:
        reason = f"contact, {-step['clearance_m']:.2f} m deep"
    else:
        reason = (
            f"change of speed of the ego or the other by {step['observed']:.4g} m/s2, {step['clearance_m']:.2f} m apart"
        )
    return {
        **dict.fromkeys(_UNKNOWN_COLUMNS),
        "rule_id": rule.id,
        "severity": rule.severity,
        "ego_id": pair["ego_id"],
        "object_id": pair["object_id"],
        **dict.fromkeys(("t_start_ns", "t_end_ns", "t_worst_ns"), step["t_ns"]),
        **{name: step[name] for name in ("observed", "required", "margin", "x_m", "y_m")},
        "unit": rule.unit,
        "reason": reason,
    }
