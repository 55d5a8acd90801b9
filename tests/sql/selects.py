"""The SELECTs in the statements of `queries` that Python runs by name, and in those that it makes of rules."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING

import duckdb

from drivelint import catalogue
from drivelint.evaluate.evaluation import Evaluation, PlanRecorder
from drivelint.evaluate.sql_fragments import Binding
from drivelint.resources import folder
from drivelint.sql import store
from drivelint.sql.statements import statement, statement_texts

if TYPE_CHECKING:
    from drivelint.catalogue import Rule

OTHER_FOLDERS = {"assertions", "library", "macros", "skeletons", "statement_macros"}
PARTS = sorted(path.name for path in folder("queries").iterdir() if path.is_dir() and path.name not in OTHER_FOLDERS)
"""The folders of statements that Python runs by name."""

_INCOMPLETE = re.compile(r"\{\w+\}|^\s*-- [Pp]art of", re.MULTILINE)
_COMMENTS = re.compile(r"\A(?:\s*--.*\n)*\s*")
_INTO = re.compile(
    r"(?:CREATE OR REPLACE TEMP (?:TABLE|VIEW) \w+ AS|INSERT INTO \w+(?: BY NAME)?"
    r"|CREATE OR REPLACE MACRO \w+\(\w+\) AS TABLE)\s"
)


def select(sql: str) -> str | None:
    """Return the SELECT of a statement that returns, makes or fills a table; None: it has none."""
    text = _COMMENTS.sub("", sql.strip().rstrip(";"))
    text = _COMMENTS.sub("", _INTO.sub("", text, count=1) if _INTO.match(text) else text)
    return text if re.match(r"(WITH|SELECT|FROM)\b", text) else None


@cache
def fixed() -> dict[str, str]:
    """Return name -> SELECT of the statements that are the same for all rules."""
    found: dict[str, str] = {}
    for part in PARTS:
        for name, text in statement_texts(part).items():
            for each in duckdb.extract_statements(text) if not _INCOMPLETE.search(text) else ():
                if sql := select(each.query):
                    found[f"{part}/{name}" + (f" {len(found)}" if f"{part}/{name}" in found else "")] = sql
    for places in ("drives", "findings"):
        update = statement(
            "earth/position", places=statement(f"earth/places_of_{places}"), table="finding", key="rowid"
        )
        found[f"earth/position of {places}"] = f"FROM {update.split('FROM', 1)[1].rpartition('WHERE')[0]}"
    return found


@dataclass
class _Recorder(PlanRecorder):
    """An evaluation that runs all alternatives and keeps the text of every statement, without its plan."""

    texts: list[str] = field(default_factory=list, init=False)

    def _execute(self, sql: str, binding: Binding) -> int:
        self.texts.append(sql)
        return Evaluation._execute(self, sql, binding)


def _shape(rule: Rule) -> str:
    """Return what decides which statements a rule has, and with which joins."""
    return repr((
        rule.kind, rule.subtype, rule.per_object, rule.per_profile, rule.combine, rule.quantifier, rule.has_column("ref_id"),
        bool(rule.exempt_after_s), bool(rule.applies.restricted_conditions), sorted(rule.columns.get("applies", ())),
    ))  # fmt: skip


def of_rules() -> dict[str, str]:
    """Return name -> SELECT of the statements of one rule of each shape."""
    found: dict[str, str] = {}
    with store.connect(threads=1) as con:
        for rule in {_shape(rule): rule for rule in catalogue.load_rules(()).values()}.values():
            for margins in (False, True):
                binding = Binding(rule, 0, {})
                with store.cursor(con) as cursor:
                    run = _Recorder(cursor, [binding], margins=margins)
                    run.prepare()
                    run.judge_rule(binding)
                    run.aggregate_pending_steps()
                for no, sql in enumerate(run.texts):
                    if text := select(sql):
                        found[f"{rule.id}, statement {no} {'with' if margins else 'without'} margins"] = text
    return found
