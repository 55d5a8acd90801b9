"""Says verdicts whose windows have closed, and holds them against those of the whole log."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from drivelint.watch.window import S

if TYPE_CHECKING:
    import pyarrow as pa

    from drivelint.result.text import Row
    from drivelint.watch.judge import JudgedWindow

SETTLE_NS: Final = 15 * S
"""So long after the end of what is judged a verdict is said: an overtake is judged by how it ended, too, and that takes seconds."""
KEY: Final = ("rule_id", "ego_id", "profile", "object_id", "t_ref_ns", "t_start_ns")
"""What two verdicts of a log must have in common to be one; numbers of occurrences and reference points count from the log's beginning."""
SAID: Final = (
    "verdict", "severity", "t_end_ns", "t_worst_ns", "reason_code", "reason", "observed", "required", "margin", "unit", "near_miss",
    "n_expected", "n_judged", "x_m", "y_m", "lanelet_id",
)  # fmt: skip
"""What is said of it beside its key."""
_COMPARED: Final = tuple(name for name in SAID if name != "reason")
Key = tuple[Any, ...]


class SettledVerdicts:
    """The verdicts that were said before the log's end, each once."""

    def __init__(self) -> None:
        self._said: dict[Key, Row] = {}

    def take(self, window: JudgedWindow, known_from_ns: int) -> list[Row]:
        """Return the verdicts of a window that have settled in it and were not said yet.

        `known_from_ns`: from then on the window knows all that the whole log does. An episode that may have begun before has no verdict
        yet, nor has one that may go on. An unknown is said at the end: what is missing may still come.
        """
        found = []
        for row in window.verdicts.to_pylist():
            key = _key(row)
            if row["verdict"] not in {"pass", "fail"} or key in self._said:
                continue
            begin = row["t_start_ns"] if row["t_ref_ns"] is None else min(row["t_start_ns"], row["t_ref_ns"])
            begins_here = begin > known_from_ns or known_from_ns == window.t_start_ns
            if begins_here and row["t_end_ns"] + SETTLE_NS < window.t_end_ns:
                self._said[key] = row
                found.append(row)
        return found

    def __len__(self) -> int:
        return len(self._said)

    def hold_against(self, verdicts: pa.Table) -> tuple[list[Row], list[Row]]:
        """Return the verdicts of the whole log that were not said, and those that were said otherwise.

        A verdict that was said and that the whole log does not have is among the latter, as it was said, its verdict None.
        """
        rows = {_key(row): row for row in verdicts.to_pylist() if row["verdict"] != "not_applicable"}
        other = [row for key, row in rows.items() if key in self._said and not _same(self._said[key], row)]
        gone = [{**row, "verdict": None} for key, row in self._said.items() if key not in rows]
        return [row for key, row in rows.items() if key not in self._said], [*other, *gone]


def _key(row: Row) -> Key:
    return tuple(row[name] for name in KEY)


def _same(one: Row, other: Row) -> bool:
    return all(one[name] == other[name] for name in _COMPARED)
