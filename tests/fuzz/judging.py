"""Damaged traces that could be read are judged: no rule may fail on them, and what the whole file shows may not pass."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Any, Final

import drivelint
from drivelint.errors import DriveLintError
from tests.fuzz.outcome import of_error
from tests.fuzz.sources import SCENES

if TYPE_CHECKING:
    from pathlib import Path

    from tests.fuzz.traces import DamagedTrace

    Row = dict[str, Any]

RULES: Final = ("ukhc.no-collision", "ukhc.r162.safe-distance-ahead")
ROAD: Final = SCENES / "two-lane-road.xodr"


def judge(paths: list[Path], options: dict[str, Any]) -> tuple[list[Row], dict[str, list[Row]]]:
    """Judge logs with few rules on one road; return the rows of the drives, and the verdicts of each."""
    result = drivelint.check(
        paths, rules=list(RULES), map=ROAD, annotate=False, robustness=False, rule_timeout=20, **options
    )
    verdicts: dict[str, list[Row]] = defaultdict(list)
    for row in result.verdicts.arrow().to_pylist():
        verdicts[row["drive_id"]].append(row)
    return result.drives.arrow().to_pylist(), verdicts


def problems(cases: dict[int, DamagedTrace], whole: list[Row]) -> dict[int, tuple[str, str]]:
    """Judge the cases of one source; return number -> outcome and detail of those that show a bug. `whole`: the whole file's verdicts."""
    source = next(iter(cases.values())).source
    numbers = {str(case.path): number for number, case in cases.items()}
    found: dict[int, tuple[str, str]] = {}
    try:
        drives, verdicts = judge([case.path for case in cases.values()], source.options)
    except DriveLintError as error:
        if len(cases) == 1:
            outcome, detail = of_error(error)
            return {} if outcome == "refused" else dict.fromkeys(cases, (outcome, detail))
        return {n: told for number, case in cases.items() for n, told in problems({number: case}, whole).items()}
    except Exception as error:  # noqa: BLE001 - what escapes is what is looked for
        return dict.fromkeys(cases, of_error(error))
    names = {path.rpartition("/")[2]: number for path, number in numbers.items()}
    for drive in drives:
        number = names[drive["file_name"]]
        reason = drive["status_reason"] or ""
        if "internal error" in reason:
            found[number] = ("crash", reason[:400])
        rows = verdicts[drive["drive_id"]]
        if failed := [row for row in rows if row["verdict"] == "error"]:
            found[number] = (
                "rule error",
                f"{failed[0]['rule_id']}: {failed[0]['reason_code']}: {failed[0]['reason']}"[:400],
            )
        if (
            source.protected
            and cases[number].is_lossy
            and not cases[number].is_unprotected
            and (wrong := contradiction(rows, whole))
        ):
            found[number] = ("wrong verdict", wrong)
    return found


def contradiction(rows: list[Row], whole: list[Row]) -> str | None:
    """Return a pass over a moment at which the whole file fails, or a failure where it does not; None: there is neither."""
    failures = [row for row in whole if row["verdict"] == "fail"]
    for row in rows:
        alike = [
            each for each in failures if (each["rule_id"], each["object_id"]) == (row["rule_id"], row["object_id"])
        ]
        if row["verdict"] == "pass":
            for each in alike:
                if row["t_start_ns"] <= each["t_worst_ns"] <= row["t_end_ns"]:
                    return f"pass of {row['rule_id']} over {row['t_start_ns']}..{row['t_end_ns']}, fails at {each['t_worst_ns']}"
        elif row["verdict"] == "fail" and not any(
            each["t_start_ns"] <= row["t_worst_ns"] <= each["t_end_ns"] for each in alike
        ):
            return f"fail of {row['rule_id']} at {row['t_worst_ns']}, where the whole file has none"
    return None
