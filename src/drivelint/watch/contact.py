"""Looks at the newest frames for overlapping boxes, so that a contact is an alarm long before its window is judged.

It reads the log as the windows are read, and takes the boxes' distance by the macro of the rules. It says only what needs no more than
that: an actor that was never seen apart from the ego may be its trailer or another id of it, and is left to the window. The window that has
the step confirms the alarm, or withdraws it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.sql import store
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    import duckdb

    from drivelint.catalogue import Rule
    from drivelint.drive.trace import Trace
    from drivelint.result.text import Row

RULE: Final = "ukhc.no-collision"
"""The rule whose alarms come early."""
LOOK_NS: Final = 1_000_000_000
"""So long a look is at least: what a reader takes from the steps before is there, and a box that comes near is seen apart first."""
NEAR_M: Final = 50.0
"""Centres farther from each other along x or y are not looked at."""
_NOT_KNOWN: Final = ("profile", "t_ref_ns", "lon", "lat", "lanelet_id", "closing_mps")


class ContactLook:
    """Finds contacts in the newest frames of a log. Memory: the actors that are near an ego.

    `con`: a database with the macros; it is used by this thread alone.
    """

    def __init__(self, con: duckdb.DuckDBPyConnection, rule: Rule) -> None:
        self._con = con
        self._rule = rule
        self._statement = statement("watch/contact")
        self._apart: set[tuple[str, str]] = set()

    def look(self, trace: Trace, since_ns: int | None) -> list[Row]:
        """Return the contacts of the egos at the steps after `since_ns`, None: at all; each as a row of `finding` that lasts one step.

        `trace`: the newest steps and about `LOOK_NS` before them.
        """
        tables = {"_state": trace.tables["actor_state"], "_actor": trace.tables["actor"]}
        with store.registered(self._con, tables):
            cursor = self._con.execute(self._statement, {"near_m": NEAR_M})
            pairs = cursor.to_arrow_table().to_pylist()
        near = {(pair["ego_id"], pair["object_id"]) for pair in pairs}
        self._apart = (self._apart & near) | {(p["ego_id"], p["object_id"]) for p in pairs if p["is_apart"]}
        return [
            self._finding(pair, step)
            for pair in pairs
            if (pair["ego_id"], pair["object_id"]) in self._apart
            for step in pair["contacts"] or ()
            if since_ns is None or step["t_ns"] > since_ns
        ]

    def _finding(self, pair: Row, step: Row) -> Row:
        depth_m = -step["clearance_m"]
        return {
            **dict.fromkeys(_NOT_KNOWN),
            "rule_id": self._rule.id,
            "severity": self._rule.severity,
            "ego_id": pair["ego_id"],
            "object_id": pair["object_id"],
            **dict.fromkeys(("t_start_ns", "t_end_ns", "t_worst_ns"), step["t_ns"]),
            "observed": step["clearance_m"],
            "required": 0.0,
            "margin": step["clearance_m"],
            "unit": self._rule.unit,
            "x_m": step["x_m"],
            "y_m": step["y_m"],
            "reason": f"contact, {depth_m:.2f} m deep",
        }
