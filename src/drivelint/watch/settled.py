"""Finds verdicts that can be reported before the log's end, and compares them with the verdicts of the whole log."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from drivelint.watch.window import NS_PER_S

if TYPE_CHECKING:
    import pyarrow as pa

    from drivelint.result.text import Row
    from drivelint.watch.judge import JudgedWindow

SETTLE_DELAY_NS: Final = 15 * NS_PER_S
"""The delay from the end of an episode to the report of its verdict: the end of an overtake, which takes seconds, is judged, too."""
IDENTIFYING_VERDICT_COLUMNS: Final = ("rule_id", "ego_id", "profile", "object_id", "t_ref_ns", "t_start_ns")
"""The columns that identify a verdict. Numbers of occurrences and reference points do not: they depend on where the window starts."""
OTHER_REPORTED_VERDICT_COLUMNS: Final = (
    "verdict", "severity", "t_end_ns", "t_worst_ns", "reason_code", "reason", "observed", "required", "margin", "unit", "near_miss",
    "n_expected", "n_judged", "x_m", "y_m", "lanelet_id",
)  # fmt: skip
"""The columns of a message in addition to the key."""
_COMPARED_COLUMNS: Final = tuple(name for name in OTHER_REPORTED_VERDICT_COLUMNS if name != "reason")
Key = tuple[Any, ...]


class SettledVerdicts:
    """The verdicts that were reported before the log's end, each once."""

    def __init__(self) -> None:
        self._said: dict[Key, Row] = {}

    def new_settled_rows(self, window: JudgedWindow, known_from_ns: int) -> list[Row]:
        """Return the verdicts of a window that are settled and were not reported yet.

        `known_from_ns`: the time from which the window has the same data as the whole log. A verdict is not settled if its episode may have
        begun earlier or may continue. Unknown verdicts are reported at the end, since the missing data may still come.
        """
        settled_rows = []
        for key, row in _verdicts_with_unique_key(window.verdicts).items():
            if row["verdict"] not in {"pass", "fail"} or row["t_start_ns"] is None or key in self._said:
                continue
            begin = row["t_start_ns"] if row["t_ref_ns"] is None else min(row["t_start_ns"], row["t_ref_ns"])
            begins_here = begin > known_from_ns or known_from_ns == window.t_start_ns
            if begins_here and row["t_end_ns"] + SETTLE_DELAY_NS < window.t_end_ns:
                self._said[key] = {
                    name: row[name] for name in (*IDENTIFYING_VERDICT_COLUMNS, *OTHER_REPORTED_VERDICT_COLUMNS)
                }
                settled_rows.append(row)
        return settled_rows

    def __len__(self) -> int:
        return len(self._said)

    def late_and_revised_rows(self, verdicts: pa.Table) -> tuple[list[Row], list[Row]]:
        """Return the verdicts of the whole log that were not reported, and those that differ from the report.

        A reported verdict that the whole log does not have is in the second list, with `verdict` None.
        """
        rows = [row for row in verdicts.to_pylist() if row["verdict"] != "not_applicable"]
        there = {_verdict_key(row) for row in rows}
        late = [row for row in rows if _verdict_key(row) not in self._said]
        revised = [
            row
            for row in rows
            if (earlier := self._said.get(_verdict_key(row))) is not None and not _is_same_verdict(earlier, row)
        ]
        absent = [{**row, "verdict": None} for key, row in self._said.items() if key not in there]
        return late, [*revised, *absent]


def _verdicts_with_unique_key(verdicts: pa.Table) -> dict[Key, Row]:
    """Return key -> verdict for all applicable verdicts whose key is unique; overtakes with unknown beginnings may share a key."""
    rows: dict[Key, list[Row]] = {}
    for row in verdicts.to_pylist():
        if row["verdict"] != "not_applicable":
            rows.setdefault(_verdict_key(row), []).append(row)
    return {key: same[0] for key, same in rows.items() if len(same) == 1}


def _verdict_key(row: Row) -> Key:
    return tuple(row[name] for name in IDENTIFYING_VERDICT_COLUMNS)


def _is_same_verdict(earlier: Row, later: Row) -> bool:
    return all(earlier[name] == later[name] for name in _COMPARED_COLUMNS)
