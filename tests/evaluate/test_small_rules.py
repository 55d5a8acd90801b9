"""What small rules say of small scenes: the files of `tests/evaluate/small_rules`.

A file has rules by name and cases. `rule` names one of them, and `with` changes it: lines of its header, its sections, and of its
condition the further `columns`, the condition `where` of its rows, and what it is in `union` with; `reference table` is the line of the
header. `given` is as in the cases of rules; a table of the ego's steps without times has ten steps a second. `verdicts` and `findings`
are all rows, in order: "pass kept" is a verdict and its reason code; a mapping has the columns that matter. `_s` in a name: seconds;
`reason has` and `reason begins` hold of a part of the reason; `findings` of a verdict are the numbers of its findings; `all of: 20`: so
many rows like the one. A case with `scenes` has several.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import pytest
import yaml

from tests.evaluate.packs import Row, findings, verdicts, write

if TYPE_CHECKING:
    from drivelint.catalogue import Rule

FILES: Final = sorted((Path(__file__).parent / "small_rules").glob("*.yml"))
SECTIONS: Final = ("applies", "reference", "anchor", "condition")
MARKS: Final = {"ci": [pytest.mark.ci], "quick": []}
CASES: Final = [
    pytest.param(found["rules"][case["rule"]] | case.get("with", {}), case, id=case["name"], marks=MARKS[case.get("run", "quick")])
    for found in (yaml.safe_load(file.read_text(encoding="utf-8")) for file in FILES)
    for case in found["cases"]
]  # fmt: skip


@pytest.mark.sample(len(CASES))
@pytest.mark.parametrize(("text", "case"), CASES)
def test_a_small_rule_says(text: dict[str, Any], case: dict[str, Any], tmp_path: Path) -> None:
    rule = small_rule(tmp_path, text)
    for scene in case.get("scenes", [case]):
        given = {table: with_times(table, rows) for table, rows in scene["given"].items()}
        asked: dict[str, Any] = {"missing_signals": tuple(scene.get("missing", ())), "params": scene.get("params")}
        failed = findings(rule, given) if "verdicts" not in scene or "findings" in str(scene) else []
        assert scene.keys() & {"verdicts", "findings"}
        if "verdicts" in scene:
            assert_rows(
                verdicts(rule, given, **asked),
                scene["verdicts"] * scene.get("all of", 1),
                [row["finding_id"] for row in failed],
            )
        if "findings" in scene:
            assert_rows(failed, scene["findings"], [])
            ids = {row["finding_id"] for row in failed}
            assert len(ids) == len(failed)
            assert all(re.fullmatch("[0-9a-f]{16}", name) for name in ids)


def small_rule(folder: Path, text: dict[str, Any]) -> Rule:
    """Write the rule of a case."""
    sections = {name: text[name] for name in SECTIONS if text.get(name)}
    if "columns" in text:
        sections["condition"] = sections["condition"].replace(" FROM", f", {text['columns']} FROM", 1)
    if "where" in text:
        sections["condition"] += f" WHERE {text['where']}"
    if "union" in text:
        sections["condition"] += f" UNION ALL {text['union']}"
    own = {*SECTIONS, "columns", "where", "union", "tables"}
    header = {key.removesuffix(" table"): json.dumps(value) for key, value in text.items() if key not in own and value}
    if "merge_gap_s" in text:
        header["merge_gap_s"] = str(text["merge_gap_s"])
    return write(folder, header, sections, tables=text.get("tables", ""))


def with_times(table: str, rows: Any) -> Any:
    """Return a block with times, if it is one of the ego's steps that has none."""
    if table not in {"ego_state", "ego_condition"} or not isinstance(rows, dict) or "t_s" in rows:
        return rows
    n = max(len(value) for value in rows.values() if isinstance(value, list))
    return {"t_s": [i / 10 for i in range(n)], **rows}


def assert_rows(rows: list[Row], expected: list[Any], ids: list[str]) -> None:
    """Hold that these are the rows, by the columns that are named."""
    assert len(rows) == len(expected), rows
    for row, wanted in zip(rows, expected, strict=True):
        if isinstance(wanted, str):
            names = ("verdict", "reason_code")[: len(wanted.split())]
            assert " ".join(row[name] for name in names) == wanted, row
            continue
        for name, value in wanted.items():
            if name == "reason has":
                assert all(part in row["reason"] for part in ([value] if isinstance(value, str) else value)), row[
                    "reason"
                ]
            elif name == "reason begins":
                assert row["reason"].startswith(value), row["reason"]
            elif name == "findings":
                assert row["finding_ids"] == [ids[number] for number in value], row
            elif name.endswith("_s"):
                assert row[f"{name[:-2]}_ns"] == round(value * 1e9), (name, row)
            else:
                assert row[name] == (pytest.approx(value) if isinstance(value, float) else value), (name, row)
