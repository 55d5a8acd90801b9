"""Scores an examiner's answers: how many findings were true, by rule, severity, ego and data set."""

from __future__ import annotations

import csv
import json
from collections import Counter
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


def table(folder: Path) -> list[str]:
    """Return the lines of the score of a folder's `answers.csv`. A doubtful answer (?) counts as false.

    Errors: `ValueError` where an answer is none of T, F and ?, or answers to a sheet that was not drawn.
    """
    sheets = json.loads((folder / "key.json").read_text(encoding="utf-8"))["sheets"]
    answers = []
    with (folder / "answers.csv").open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            if row["answer"] not in {"T", "F", "?"} or row["number"] not in sheets:
                raise ValueError(
                    f"answers.csv: sheet {row['number']}, answer {row['answer']!r}: give T, F or ? to a sheet"
                )
            answers.append({**sheets[row["number"]], **row})
    certainty = {True: "sure", False: "possible", None: "copies not judged"}
    parts: dict[str, Callable[[dict[str, Any]], str]] = {
        "all": lambda row: "all" if row else "",
        "severity": lambda row: "minor" if row["severity"] == "minor" else "critical and major",
        "certainty": lambda row: certainty[row["sure"]],
        "ego": lambda row: "recorder" if row["recorder"] else "others",
        "data set": lambda row: row["source"],
        "rule": lambda row: row["rule_id"],
    }
    lines = []
    for part, name in parts.items():
        true = Counter(name(row) for row in answers if row["answer"] == "T")
        all_of = Counter(map(name, answers))
        lines += [
            f"{part}: {value}: {true[value]} of {n} true, {true[value] / n:.2f}" for value, n in sorted(all_of.items())
        ]
    faults = Counter(row["fault"] for row in answers if row["answer"] != "T")
    return [*lines, *(f"fault: {fault}: {n}" for fault, n in faults.most_common())]
