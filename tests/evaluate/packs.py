"""Tiny rules written by the tests, and what they say about tiny scenes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from drivelint.casefile import Case, judge_case
from drivelint.casefile.merged_cases import CaseOutcome
from drivelint.catalogue import Rule, read_rule

if TYPE_CHECKING:
    from pathlib import Path

HEADER = {
    "title": '"A rule of a test"',
    "clause": '"none"',
    "hypothesis": '"Does it hold?"',
    "derivation": '"direct"',
    "severity": '"major"',
    "legal": '"must"',
    "status": '"stable"',
}
MEASURE = {"sense": '">"', "unit": '"m"'}
HOLDS = {"sense": '"holds"'}
INVARIANT = {"kind": '"invariant"'}
EXECUTION = {"kind": '"execution"'}
BEFORE = {"kind": '"precondition"', "subtype": '"temporal"', "window_s": "1.0"}
AFTER = {"kind": '"postcondition"', "subtype": '"temporal"', "window_s": "1.0"}
PLACE_BEFORE = {"kind": '"precondition"', "subtype": '"physical"'}

Row = dict[str, Any]


def text(header: dict[str, str], sections: dict[str, str], tables: str = "") -> str:
    """Return a rule file's text: header lines, further TOML (params and the like), sections."""
    lines = [f"{key} = {value}" for key, value in header.items()] + tables.strip().splitlines()
    parts = [f"-- {line}\n" for line in lines]
    parts += [f"\n-- @{name}\n{sql.strip()}\n" for name, sql in sections.items()]
    return "".join(parts)


def invariant(
    condition: str,
    *,
    sense: str = "<=",
    unit: str = "m/s",
    reads: str = '"ego_state"',
    status: str = "draft",
    tables: str = "",
) -> str:
    """Return the text of an invariant that does not gate, with this condition."""
    own = INVARIANT | {"sense": f'"{sense}"', "unit": f'"{unit}"', "reads": f"[{reads}]", "status": f'"{status}"'}
    return text(HEADER | {"severity": '"minor"', "legal": '"should"'} | own, {"condition": condition}, tables)


def write(
    folder: Path, header: dict[str, str], sections: dict[str, str], *, name: str = "rule", tables: str = ""
) -> Rule:
    """Write `pack/<name>.sql` under `folder` and read it back."""
    pack = folder / "pack"
    pack.mkdir(exist_ok=True)
    file = pack / f"{name}.sql"
    file.write_text(text(HEADER | header, sections, tables), encoding="utf-8")
    return read_rule(file)


def verdicts(
    rule: Rule,
    given_tables: dict[str, Any],
    *,
    params: dict[str, Any] | None = None,
    missing_signals: tuple[str, ...] = (),
) -> list[Row]:
    """Return the verdict rows of a scene."""
    return _outcome(
        rule,
        Case(
            name="scene", given_tables=given_tables, expect="pass", params=params or {}, missing_signals=missing_signals
        ),
    ).verdicts


def findings(rule: Rule, given_tables: dict[str, Any]) -> list[Row]:
    """Return the finding rows of a scene."""
    return _outcome(rule, Case(name="scene", given_tables=given_tables, expect="pass")).findings


_LAST: dict[str, CaseOutcome] = {}


def _outcome(rule: Rule, case: Case) -> CaseOutcome:
    """Judge a case, unless it was the last one: many tests look at a scene's verdicts, and then at its findings."""
    key = repr((rule, case))
    if key not in _LAST:
        found = judge_case(rule, case)
        _LAST.clear()
        _LAST[key] = found
    return CaseOutcome(*([dict(row) for row in rows] for rows in _LAST[key]))


def brief(rows: list[Row]) -> list[tuple[str, str]]:
    """Return (verdict, reason code) of each row."""
    return [(row["verdict"], row["reason_code"]) for row in rows]
